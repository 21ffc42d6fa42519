// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/map_reader.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "vantage/occupancy/hdf5_handles.h"
#include "vantage/occupancy/map_checks.h"
#include "vantage/occupancy/map_parts.h"

namespace vantage {
namespace fs = std::filesystem;
namespace {

using hdf5::Attribute;
using hdf5::Dataset;
using hdf5::Properties;
using hdf5::QuietErrors;
using hdf5::Space;
using hdf5::Type;

constexpr std::size_t kMaxCacheBytes = 256'000'000;

template <class T>
Result<T> Scalar(const fs::path& path, const Dataset& dataset, const char* name,
                 hid_t memory_type) {
  const Attribute attribute(H5Aopen(dataset.get(), name, H5P_DEFAULT));
  if (!attribute.valid()) {
    return Fail("{}: /occupancy lacks the attribute {}", path.string(), name);
  }
  const Type type(H5Aget_type(attribute.get()));
  const Space space(H5Aget_space(attribute.get()));
  const H5T_class_t type_class = H5Tget_class(type.get());
  T value{};
  if ((type_class != H5T_FLOAT && type_class != H5T_INTEGER) ||
      H5Sget_simple_extent_npoints(space.get()) != 1 ||
      H5Aread(attribute.get(), memory_type, &value) < 0) {
    return Fail("{}: the attribute {} of /occupancy is not one number", path.string(), name);
  }
  return value;
}

Result<double> Double(const fs::path& path, const Dataset& dataset, const char* name) {
  return Scalar<double>(path, dataset, name, H5T_NATIVE_DOUBLE);
}

Result<std::vector<std::uint8_t>> Flags(const MapParts& parts, const char* name,
                                        const GroundGrid& grid) {
  VANTAGE_ASSIGN_OR_RETURN(const auto opened, parts.OpenDataset(name, 2, H5T_INTEGER));
  const auto& [dataset, size] = opened;
  if (size[0] != static_cast<hsize_t>(grid.rows) || size[1] != static_cast<hsize_t>(grid.columns)) {
    return Fail("{}: {} has {} x {} cells; /occupancy has {} x {}", parts.path().string(), name,
                size[0], size[1], grid.rows, grid.columns);
  }
  std::vector<std::uint8_t> flags(static_cast<std::size_t>(grid.count()));
  if (H5Dread(dataset.get(), H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL, H5P_DEFAULT, flags.data()) < 0) {
    return Fail("{}: {} cannot be read; the file is damaged", parts.path().string(), name);
  }
  return flags;
}

/// The same dataset, with a cache for all chunks that hold part of one map: a chunk of many maps is
/// then unpacked once, not once for each of them.
Dataset WithCache(hid_t file, Dataset dataset, const std::array<hsize_t, 3>& size) {
  const Properties layout(H5Dget_create_plist(dataset.get()));
  if (H5Pget_layout(layout.get()) != H5D_CHUNKED) return dataset;
  const Type type(H5Dget_type(dataset.get()));
  std::array<hsize_t, 3> chunk = {1, 1, 1};
  H5Pget_chunk(layout.get(), 3, chunk.data());
  const auto across = [&](std::size_t axis) {
    return (size[axis] - 1) / std::max<hsize_t>(chunk[axis], 1) + 1;
  };
  const hsize_t chunks = across(1) * across(2);
  const hsize_t chunk_bytes = chunk[0] * chunk[1] * chunk[2] * H5Tget_size(type.get());
  const auto bytes =
      static_cast<std::size_t>(std::min<hsize_t>(chunk_bytes, kMaxCacheBytes / chunks) * chunks);
  const Properties access(H5Pcreate(H5P_DATASET_ACCESS));
  H5Pset_chunk_cache(access.get(), H5D_CHUNK_CACHE_NSLOTS_DEFAULT, bytes, 1.0);
  dataset.Close();
  return Dataset(H5Dopen2(file, "/occupancy", access.get()));
}

}  // namespace

struct MapReader::Content {
  Content(MapParts parts_, Dataset dataset_)
      : parts(std::move(parts_)), dataset(std::move(dataset_)) {}

  MapParts parts;
  Dataset dataset;  // /occupancy; closed before the file
  OccupancyMaps header;
  std::int64_t frames = 0;
};

MapReader::MapReader(std::unique_ptr<Content> content) : content_(std::move(content)) {}
MapReader::MapReader(MapReader&&) noexcept = default;

MapReader& MapReader::operator=(MapReader&& other) noexcept {
  std::swap(content_, other.content_);
  return *this;
}

MapReader::~MapReader() {
  if (!content_) return;
  const std::lock_guard lock(hdf5::mutex);
  const QuietErrors quiet;
  content_.reset();
}

const OccupancyMaps& MapReader::header() const { return content_->header; }
std::int64_t MapReader::frame_count() const { return content_->frames; }

Result<MapReader> MapReader::Open(const fs::path& path) {
  const std::lock_guard lock(hdf5::mutex);
  const QuietErrors quiet;
  VANTAGE_ASSIGN_OR_RETURN(MapParts parts, MapParts::Open(path));
  VANTAGE_ASSIGN_OR_RETURN(auto opened, parts.OpenDataset("/occupancy", 3, H5T_FLOAT));
  auto& [dataset, size] = opened;
  if (size[1] < 1 || size[2] < 1) return Fail("{}: /occupancy has no cells", path.string());
  OccupancyMaps maps;
  maps.grid.rows = static_cast<int>(size[1]);
  maps.grid.columns = static_cast<int>(size[2]);
  VANTAGE_ASSIGN_OR_RETURN(maps.grid.min_x_m, Double(path, dataset, "min_x_m"));
  VANTAGE_ASSIGN_OR_RETURN(maps.grid.min_y_m, Double(path, dataset, "min_y_m"));
  VANTAGE_ASSIGN_OR_RETURN(maps.grid.cell_m, Double(path, dataset, "cell_m"));
  VANTAGE_ASSIGN_OR_RETURN(maps.frames_per_second, Double(path, dataset, "frames_per_second"));
  VANTAGE_ASSIGN_OR_RETURN(maps.first_frame,
                           Scalar<std::int64_t>(path, dataset, "first_frame", H5T_NATIVE_INT64));
  VANTAGE_ASSIGN_OR_RETURN(maps.in_area, Flags(parts, "/in_area", maps.grid));
  VANTAGE_ASSIGN_OR_RETURN(maps.visible, Flags(parts, "/visible", maps.grid));
  VANTAGE_RETURN_IF_ERROR(CheckMapHeader(path, maps));
  Dataset cached = WithCache(parts.file(), std::move(dataset), size);
  auto content = std::make_unique<Content>(std::move(parts), std::move(cached));
  content->header = std::move(maps);
  content->frames = static_cast<std::int64_t>(size[0]);
  return MapReader(std::move(content));
}

Status MapReader::Read(std::int64_t first, std::span<float> values) const {
  const GroundGrid& grid = content_->header.grid;
  const auto cells = static_cast<std::size_t>(grid.count());
  const auto frames = static_cast<std::int64_t>(values.size() / cells);
  if (first < 0 || values.size() % cells != 0 || first > content_->frames - frames) {
    return Fail("{}: {} values from map {} on asked for; the file has {} maps of {} cells",
                content_->parts.path().string(), values.size(), first, content_->frames, cells);
  }
  if (values.empty()) return {};
  {
    const std::lock_guard lock(hdf5::mutex);
    const QuietErrors quiet;
    const std::array start = {static_cast<hsize_t>(first), hsize_t{0}, hsize_t{0}};
    const std::array count = {static_cast<hsize_t>(frames), static_cast<hsize_t>(grid.rows),
                              static_cast<hsize_t>(grid.columns)};
    const Space in_file(H5Dget_space(content_->dataset.get()));
    const Space in_memory(H5Screate_simple(3, count.data(), nullptr));
    if (H5Sselect_hyperslab(in_file.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(),
                            nullptr) < 0 ||
        H5Dread(content_->dataset.get(), H5T_NATIVE_FLOAT, in_memory.get(), in_file.get(),
                H5P_DEFAULT, values.data()) < 0) {
      return Fail("{}: /occupancy cannot be read; the file is damaged",
                  content_->parts.path().string());
    }
  }
  return CheckMapValues(content_->parts.path(), values, cells, first);
}

}  // namespace vantage
