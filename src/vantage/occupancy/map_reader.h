// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "vantage/base/result.h"
#include "vantage/occupancy/maps.h"

namespace vantage {

/// Reads a file of occupancy maps (map_file.h) piece by piece, in the memory of the pieces asked
/// for and of one layer of the file's own chunks (of at most 256 MB).
class MapReader {
 public:
  /// Reads and checks everything but the values. Fails on files that are not HDF5, are truncated,
  /// lack a part, or have parts of another rank, type or size than they should or that store less
  /// than they declare.
  static Result<MapReader> Open(const std::filesystem::path& path);
  MapReader(MapReader&&) noexcept;
  MapReader& operator=(MapReader&&) noexcept;
  ~MapReader();

  /// Grid, first frame, frame rate, area and visibility; without values.
  const OccupancyMaps& header() const;
  std::int64_t frame_count() const;

  /// Fills `values` with whole maps, the first of them being number `first` (from 0). Fails where
  /// the file ends before that, on damaged files and on values outside [0, 1].
  Status Read(std::int64_t first, std::span<float> values) const;

 private:
  struct Content;
  explicit MapReader(std::unique_ptr<Content> content);
  std::unique_ptr<Content> content_;
};

}  // namespace vantage
