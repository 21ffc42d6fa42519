// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <filesystem>
#include <utility>

#include "vantage/base/result.h"
#include "vantage/occupancy/hdf5_handles.h"

/// Internal to the library: the datasets of a file of occupancy maps (map_file.h) that nobody
/// vouches for.

namespace vantage {

/// A file of maps opened for reading. Every message begins with its name. Whoever makes, uses or
/// destroys one holds hdf5::mutex and keeps HDF5 quiet (hdf5::QuietErrors).
class MapParts {
 public:
  /// Fails on what is missing, no regular file or not HDF5.
  static Result<MapParts> Open(const std::filesystem::path& path);

  /// A dataset and its size; axes that it lacks count as 1.
  using Part = std::pair<hdf5::Dataset, std::array<hsize_t, 3>>;

  /// Opens a dataset of the given rank (1 to 3) and class (H5T_FLOAT or H5T_INTEGER). Fails unless
  /// it lies in the file itself, stores what it declares, and is of a size that anybody needs: at
  /// most 100,000,000 entries along the first axis, each of at most 4,000,000 values.
  Result<Part> OpenDataset(const char* name, int rank, H5T_class_t type_class) const;

  const std::filesystem::path& path() const { return path_; }
  hid_t file() const { return file_.get(); }

 private:
  MapParts(std::filesystem::path path, hdf5::File file)
      : path_(std::move(path)), file_(std::move(file)) {}
  Status CheckStorage(const char* name, const hdf5::Dataset& dataset,
                      const std::array<hsize_t, 3>& size, std::size_t value_bytes) const;

  std::filesystem::path path_;
  hdf5::File file_;
};

}  // namespace vantage
