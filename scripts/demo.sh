#!/usr/bin/env bash
# The main job on a real recording: PETS 2009 S2.L1 View_001, which Debian's opencv-doc ships.
#   scripts/demo.sh BUILD_FOLDER
set -euo pipefail
cd "$(dirname "$0")/.."
build=${1:?usage: scripts/demo.sh BUILD_FOLDER}
out=$build/demo
data=/usr/share/doc/opencv-doc/examples/data

if [ ! -f "$data/vtest.avi" ]; then
  # Slim systems drop /usr/share/doc when they install: take the recording out of the package itself.
  data=$build/demo-data
  if [ ! -f "$data/vtest.avi" ]; then
    echo "Unpacking vtest.avi from Debian's package opencv-doc"
    unpacked=$(mktemp -d "$PWD/$build/opencv-doc.XXXXXX")
    trap 'rm -rf "$unpacked"' EXIT
    (cd "$unpacked" && apt-get download -qq opencv-doc && dpkg-deb -x opencv-doc_*.deb .)
    mkdir -p "$data"
    mv "$unpacked/usr/share/doc/opencv-doc/examples/data/vtest.avi" "$data/"
  fi
fi

"$build/bin/vantage" track examples/pets2009/scene.toml --data "$data" -o "$out"
"$build/bin/vantage" render "$out" -o "$out/demo.mp4"
echo
echo "Results in $out:"
echo "  demo.mp4      the camera's view with boxes, numbers and trails beside the plan of the ground"
echo "  tracks.csv    frame, id, x, y in metres"
echo "  summary.json  what was run on what, counts, seconds per stage"
