#!/usr/bin/env bash
# Installs the Debian bookworm packages that Vantage needs and that are missing; does nothing,
# in under a second and without root, when all are there.
set -euo pipefail

packages=(
  # toolchain
  g++ cmake ninja-build ccache pkg-config
  # library
  libopencv-dev libeigen3-dev libtbb-dev libhdf5-dev libfmt-dev libexpected-dev
  libtomlplusplus-dev libpugixml-dev nlohmann-json3-dev libssl-dev libhwy-dev libembree-dev
  # program
  libcli11-dev libspdlog-dev
  # tests: test libraries and the independent minimum-cost-flow solver
  libgtest-dev libgmock-dev librapidcheck-dev liblemon-dev
  # benchmarks: harness and the peer for background subtraction
  libbenchmark-dev libopencv-contrib-dev
  # the recording that the demo tracks (vtest.avi: PETS 2009 S2.L1 View_001)
  opencv-doc
)
case "${1-}" in
  "") ;;
  --lint) packages+=(clang-format clang-tidy) ;;
  *) echo "usage: scripts/install-deps.sh [--lint]" >&2; exit 2 ;;
esac

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$status" = installed ] || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

echo "Installing Debian packages: ${missing[*]}"
as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "These packages are missing and only root can install them: ${missing[*]}" >&2
    echo "Ask an administrator to run scripts/install-deps.sh, then try again." >&2
    exit 1
  fi
  as_root=(sudo)
fi
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get install -y -qq --no-install-recommends "${missing[@]}"
