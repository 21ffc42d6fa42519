// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "vantage/base/result.h"

namespace vantage {

/// Reads a whole text file. Fails when it is missing, not a regular file, unreadable or larger than
/// `limit_bytes` (hostile or mistaken input).
Result<std::string> ReadTextFile(const std::filesystem::path& path,
                                 std::size_t limit_bytes = std::size_t{1} << 30);

/// Writes a file whole or not at all: into a sibling first, flushed to disk, then renamed over
/// `path`. Parent directories are made.
Status WriteTextFile(const std::filesystem::path& path, std::string_view text);

/// True when `path` is `folder` or lies in it, through symbolic links too; neither need exist.
bool IsInside(const std::filesystem::path& path, const std::filesystem::path& folder);

/// SHA-256 of a file's bytes in lower-case hexadecimal, as `sha256sum` prints it.
Result<std::string> Sha256OfFile(const std::filesystem::path& path);

/// An output that other code writes step by step: give `temporary()` to that code, then `Commit()`
/// renames it to its final name. Without a commit the destructor removes it, so that no partial
/// output is ever left under the final name. The temporary keeps the extension of the final name
/// (libraries choose formats by it).
class StagedFile {
 public:
  /// Fails when the folder cannot be made or written to, or when `final_path` is a folder.
  static Result<StagedFile> Create(const std::filesystem::path& final_path);
  StagedFile(StagedFile&& other) noexcept;
  StagedFile& operator=(StagedFile&& other) noexcept;
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;
  ~StagedFile();

  const std::filesystem::path& temporary() const { return temporary_; }
  const std::filesystem::path& final_path() const { return final_; }
  Status Commit();

 private:
  StagedFile() = default;
  void Discard();
  std::filesystem::path temporary_, final_;
};

/// The same for a folder of outputs (e.g. masks, one picture a frame). `final_path` may exist only
/// if it is empty or `replace` says that its earlier content may go.
class StagedDirectory {
 public:
  static Result<StagedDirectory> Create(const std::filesystem::path& final_path, bool replace);
  StagedDirectory(StagedDirectory&& other) noexcept;
  StagedDirectory& operator=(StagedDirectory&& other) noexcept;
  StagedDirectory(const StagedDirectory&) = delete;
  StagedDirectory& operator=(const StagedDirectory&) = delete;
  ~StagedDirectory();

  const std::filesystem::path& temporary() const { return temporary_; }
  Status Commit();

 private:
  StagedDirectory() = default;
  void Discard();
  std::filesystem::path temporary_, final_;
};

}  // namespace vantage
