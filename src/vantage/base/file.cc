// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/base/file.h"

#include <fcntl.h>
#include <openssl/evp.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
#include <utility>

namespace vantage {
namespace fs = std::filesystem;
namespace {

std::string Reason() { return std::strerror(errno); }

Status CheckReadable(const fs::path& path) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (!fs::exists(status)) return Fail("{}: no such file", path.string());
  if (fs::is_directory(status)) return Fail("{}: is a folder; a file is needed", path.string());
  // A pipe could block for ever, a device never end.
  if (!fs::is_regular_file(status)) {
    return Fail("{}: is a pipe or a device; a regular file is needed", path.string());
  }
  return {};
}

fs::path ParentOf(const fs::path& path) {
  const fs::path parent = path.parent_path();
  return parent.empty() ? fs::path(".") : parent;
}

Status MakeFolder(const fs::path& folder) {
  std::error_code code;
  fs::create_directories(folder, code);
  if (code) return Fail("{}: cannot make this folder: {}", folder.string(), code.message());
  if (!fs::is_directory(folder, code)) {
    return Fail("{}: is a file; a folder is needed", folder.string());
  }
  if (::access(folder.c_str(), W_OK) != 0) {
    return Fail("{}: cannot write into this folder: {}", folder.string(), Reason());
  }
  return {};
}

/// A hidden sibling of `path`, unique to this process and call, with the same extension.
fs::path SiblingOf(const fs::path& path) {
  static std::atomic<unsigned> counter{0};
  return ParentOf(path) / fmt::format(".{}.{}-{}.partial{}", path.stem().string(), ::getpid(),
                                      counter.fetch_add(1), path.extension().string());
}

Status SyncToDisk(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return Fail("{}: cannot be written: {}", path.string(), Reason());
  const int failed = ::fsync(descriptor);
  const std::string reason = Reason();
  ::close(descriptor);
  if (failed != 0) return Fail("{}: cannot be written: {}", path.string(), reason);
  return {};
}

}  // namespace

Result<std::string> ReadTextFile(const fs::path& path, std::size_t limit_bytes) {
  VANTAGE_RETURN_IF_ERROR(CheckReadable(path));
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return Fail("{}: cannot be opened: {}", path.string(), Reason());
  std::string text;
  std::array<char, 1 << 16> block;
  while (stream.read(block.data(), block.size()) || stream.gcount() > 0) {
    text.append(block.data(), static_cast<std::size_t>(stream.gcount()));
    if (text.size() > limit_bytes) {
      return Fail("{}: larger than {} bytes; not a file of this kind", path.string(), limit_bytes);
    }
  }
  if (stream.bad()) return Fail("{}: cannot be read: {}", path.string(), Reason());
  return text;
}

Status WriteTextFile(const fs::path& path, std::string_view text) {
  VANTAGE_ASSIGN_OR_RETURN(StagedFile staged, StagedFile::Create(path));
  {
    std::ofstream stream(staged.temporary(), std::ios::binary);
    stream.write(text.data(), static_cast<std::streamsize>(text.size()));
    stream.flush();
    if (!stream) return Fail("{}: cannot be written: {}", path.string(), Reason());
  }
  return staged.Commit();
}

bool IsInside(const fs::path& path, const fs::path& folder) {
  std::error_code code;
  const fs::path inner = fs::weakly_canonical(path, code);
  fs::path outer = fs::weakly_canonical(folder, code);
  if (!outer.has_filename()) outer = outer.parent_path();  // named with a slash at the end
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

Result<std::string> Sha256OfFile(const fs::path& path) {
  VANTAGE_RETURN_IF_ERROR(CheckReadable(path));
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return Fail("{}: cannot be opened: {}", path.string(), Reason());
  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(),
                                                                        &EVP_MD_CTX_free);
  if (!context || EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) != 1) {
    return Fail("SHA-256 is not available in this build of OpenSSL");
  }
  std::array<char, 1 << 16> block;
  while (stream.read(block.data(), block.size()) || stream.gcount() > 0) {
    EVP_DigestUpdate(context.get(), block.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) return Fail("{}: cannot be read: {}", path.string(), Reason());
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest;
  unsigned length = 0;
  EVP_DigestFinal_ex(context.get(), digest.data(), &length);
  return fmt::format("{:02x}", fmt::join(digest.data(), digest.data() + length, ""));
}

Result<StagedFile> StagedFile::Create(const fs::path& final_path) {
  if (final_path.empty()) return Fail("the name of the output file is empty");
  std::error_code code;
  if (fs::is_directory(final_path, code)) {
    return Fail("{}: is a folder; name a file to write", final_path.string());
  }
  VANTAGE_RETURN_IF_ERROR(MakeFolder(ParentOf(final_path)));
  StagedFile staged;
  staged.final_ = final_path;
  staged.temporary_ = SiblingOf(final_path);
  return staged;
}

StagedFile::StagedFile(StagedFile&& other) noexcept
    : temporary_(std::exchange(other.temporary_, {})), final_(std::exchange(other.final_, {})) {}

StagedFile& StagedFile::operator=(StagedFile&& other) noexcept {
  if (this != &other) {
    Discard();
    temporary_ = std::exchange(other.temporary_, {});
    final_ = std::exchange(other.final_, {});
  }
  return *this;
}

StagedFile::~StagedFile() { Discard(); }

void StagedFile::Discard() {
  if (temporary_.empty()) return;
  std::error_code code;
  fs::remove(temporary_, code);
  temporary_.clear();
}

Status StagedFile::Commit() {
  VANTAGE_RETURN_IF_ERROR(SyncToDisk(temporary_));
  std::error_code code;
  fs::rename(temporary_, final_, code);
  if (code) return Fail("{}: cannot be written: {}", final_.string(), code.message());
  temporary_.clear();
  return {};
}

Result<StagedDirectory> StagedDirectory::Create(const fs::path& path, bool replace) {
  if (path.empty()) return Fail("the name of the output folder is empty");
  // Named with a slash at the end, its parent would be itself.
  const fs::path final_path = path.has_filename() ? path : path.parent_path();
  std::error_code code;
  if (fs::exists(final_path, code)) {
    if (!fs::is_directory(final_path, code)) {
      return Fail("{}: is a file; name a folder to write", final_path.string());
    }
    if (!replace && !fs::is_empty(final_path, code)) {
      return Fail("{}: already holds files; name an empty or new folder, or ask to replace it",
                  final_path.string());
    }
  }
  VANTAGE_RETURN_IF_ERROR(MakeFolder(ParentOf(final_path)));
  StagedDirectory staged;
  staged.final_ = final_path;
  staged.temporary_ = SiblingOf(final_path);
  fs::create_directory(staged.temporary_, code);
  if (code) return Fail("{}: cannot be made: {}", final_path.string(), code.message());
  return staged;
}

StagedDirectory::StagedDirectory(StagedDirectory&& other) noexcept
    : temporary_(std::exchange(other.temporary_, {})), final_(std::exchange(other.final_, {})) {}

StagedDirectory& StagedDirectory::operator=(StagedDirectory&& other) noexcept {
  if (this != &other) {
    Discard();
    temporary_ = std::exchange(other.temporary_, {});
    final_ = std::exchange(other.final_, {});
  }
  return *this;
}

StagedDirectory::~StagedDirectory() { Discard(); }

void StagedDirectory::Discard() {
  if (temporary_.empty()) return;
  std::error_code code;
  fs::remove_all(temporary_, code);
  temporary_.clear();
}

Status StagedDirectory::Commit() {
  std::error_code code;
  fs::path old;
  if (fs::exists(final_, code)) {
    // The earlier folder steps aside and goes only when the new one stands in its place.
    old = SiblingOf(final_);
    fs::rename(final_, old, code);
    if (code) return Fail("{}: cannot be replaced: {}", final_.string(), code.message());
  }
  fs::rename(temporary_, final_, code);
  if (code) {
    const std::string reason = code.message();
    if (!old.empty()) fs::rename(old, final_, code);
    return Fail("{}: cannot be written: {}", final_.string(), reason);
  }
  temporary_.clear();
  if (!old.empty()) fs::remove_all(old, code);
  return {};
}

}  // namespace vantage
