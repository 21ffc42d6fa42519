// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/map_reader.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "vantage/occupancy/hdf5_handles.h"
#include "vantage/occupancy/map_checks.h"

namespace vantage {
namespace fs = std::filesystem;
namespace {

using hdf5::Attribute;
using hdf5::Dataset;
using hdf5::File;
using hdf5::Properties;
using hdf5::QuietErrors;
using hdf5::Space;
using hdf5::Type;

constexpr hsize_t kMaxCells = 4'000'000;
constexpr hsize_t kMaxFrames = 100'000'000;
constexpr hsize_t kMaxChunkValues = 64'000'000;
constexpr std::size_t kMaxCacheBytes = 256'000'000;

/// Reads the parts of one file; every message begins with its name.
class PartReader {
 public:
  PartReader(const fs::path& path, hid_t file) : path_(path.string()), file_(file) {}

  /// Opens a dataset of the given rank and class, and checks that it stores itself what it
  /// declares.
  Result<std::pair<Dataset, std::array<hsize_t, 3>>> Open(const char* name, int rank,
                                                          H5T_class_t type_class) const {
    // Soft and external links could lead anywhere.
    H5L_info_t link;
    if (H5Lget_info(file_, name, &link, H5P_DEFAULT) < 0 || link.type != H5L_TYPE_HARD) {
      return Fail("{}: no dataset {}; not a file of occupancy maps", path_, name);
    }
    Dataset dataset(H5Dopen2(file_, name, H5P_DEFAULT));
    if (!dataset.valid()) return Fail("{}: {} cannot be opened as a dataset", path_, name);
    const Type type(H5Dget_type(dataset.get()));
    if (H5Tget_class(type.get()) != type_class || H5Tget_size(type.get()) > 8) {
      return Fail("{}: {} is not of {}", path_, name,
                  type_class == H5T_FLOAT ? "floating-point numbers" : "integers");
    }
    const Space space(H5Dget_space(dataset.get()));
    std::array<hsize_t, 3> size = {1, 1, 1};
    if (H5Sget_simple_extent_ndims(space.get()) != rank ||
        H5Sget_simple_extent_dims(space.get(), size.data(), nullptr) != rank) {
      return Fail("{}: {} must have {} dimensions", path_, name, rank);
    }
    VANTAGE_RETURN_IF_ERROR(CheckStorage(name, dataset, size, H5Tget_size(type.get())));
    return std::pair(std::move(dataset), size);
  }

  template <class T>
  Result<T> Scalar(const Dataset& dataset, const char* name, hid_t memory_type) const {
    const Attribute attribute(H5Aopen(dataset.get(), name, H5P_DEFAULT));
    if (!attribute.valid()) return Fail("{}: /occupancy lacks the attribute {}", path_, name);
    const Type type(H5Aget_type(attribute.get()));
    const Space space(H5Aget_space(attribute.get()));
    const H5T_class_t type_class = H5Tget_class(type.get());
    T value{};
    if ((type_class != H5T_FLOAT && type_class != H5T_INTEGER) ||
        H5Sget_simple_extent_npoints(space.get()) != 1 ||
        H5Aread(attribute.get(), memory_type, &value) < 0) {
      return Fail("{}: the attribute {} of /occupancy is not one number", path_, name);
    }
    return value;
  }

  Result<std::vector<std::uint8_t>> Flags(const char* name, const GroundGrid& grid) const {
    VANTAGE_ASSIGN_OR_RETURN(const auto opened, Open(name, 2, H5T_INTEGER));
    const auto& [dataset, size] = opened;
    if (size[0] != static_cast<hsize_t>(grid.rows) ||
        size[1] != static_cast<hsize_t>(grid.columns)) {
      return Fail("{}: {} has {} x {} cells; /occupancy has {} x {}", path_, name, size[0], size[1],
                  grid.rows, grid.columns);
    }
    std::vector<std::uint8_t> flags(static_cast<std::size_t>(grid.count()));
    if (H5Dread(dataset.get(), H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL, H5P_DEFAULT, flags.data()) < 0) {
      return Fail("{}: {} cannot be read; the file is damaged", path_, name);
    }
    return flags;
  }

 private:
  /// A few bytes can declare a dataset of any size, or one that lies in other files.
  Status CheckStorage(const char* name, const Dataset& dataset, const std::array<hsize_t, 3>& size,
                      std::size_t value_bytes) const {
    if (size[0] > kMaxFrames || size[1] > kMaxCells || size[2] > kMaxCells ||
        size[1] * size[2] > kMaxCells) {
      return Fail("{}: {} is {} x {} x {}; more than {} frames or {} cells", path_, name, size[0],
                  size[1], size[2], kMaxFrames, kMaxCells);
    }
    const Properties layout(H5Dget_create_plist(dataset.get()));
    const H5D_layout_t kind = H5Pget_layout(layout.get());
    if (kind == H5D_VIRTUAL || H5Pget_external_count(layout.get()) != 0) {
      return Fail("{}: {} lies in other files; it must lie in this one", path_, name);
    }
    const int filters = H5Pget_nfilters(layout.get());
    for (int i = 0; i < filters; ++i) {
      unsigned flags = 0;
      std::size_t parameters = 0;
      const H5Z_filter_t filter = H5Pget_filter2(layout.get(), static_cast<unsigned>(i), &flags,
                                                 &parameters, nullptr, 0, nullptr, nullptr);
      if (filter != H5Z_FILTER_SHUFFLE && filter != H5Z_FILTER_DEFLATE &&
          filter != H5Z_FILTER_FLETCHER32) {
        return Fail("{}: {} uses an unknown filter; only shuffle and deflate are read", path_,
                    name);
      }
    }
    if (kind == H5D_CHUNKED) {
      std::array<hsize_t, 3> chunk = {1, 1, 1};
      H5Pget_chunk(layout.get(), 3, chunk.data());
      hsize_t chunk_values = 1;
      for (const hsize_t side : chunk) {
        chunk_values = side > kMaxChunkValues ? kMaxChunkValues + 1 : chunk_values * side;
        if (chunk_values > kMaxChunkValues) {
          return Fail("{}: a chunk of {} has more than {} values", path_, name, kMaxChunkValues);
        }
      }
    }
    constexpr hsize_t kMaxDeflateRatio = 1100;  // zlib's bound is 1032
    const hsize_t bytes = size[0] * size[1] * size[2] * value_bytes;
    const hsize_t stored = H5Dget_storage_size(dataset.get());
    if (bytes / kMaxDeflateRatio > stored) {
      return Fail("{}: {} declares {} bytes but stores only {}; the file is incomplete", path_,
                  name, bytes, stored);
    }
    return {};
  }

  std::string path_;
  hid_t file_;
};

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
  Content(fs::path path_, File file_, Dataset dataset_)
      : path(std::move(path_)), file(std::move(file_)), dataset(std::move(dataset_)) {}

  fs::path path;
  File file;
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
  std::error_code code;
  if (!fs::exists(path, code)) return Fail("{}: no such file", path.string());
  if (!fs::is_regular_file(path, code)) {
    return Fail("{}: is not a regular file; a file of occupancy maps is needed", path.string());
  }
  const std::lock_guard lock(hdf5::mutex);
  const QuietErrors quiet;
  File file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
  if (!file.valid()) {
    return Fail(
        "{}: cannot be opened as HDF5; not a file of occupancy maps, truncated, or not "
        "readable",
        path.string());
  }
  const PartReader parts(path, file.get());
  VANTAGE_ASSIGN_OR_RETURN(auto opened, parts.Open("/occupancy", 3, H5T_FLOAT));
  auto& [dataset, size] = opened;
  if (size[1] < 1 || size[2] < 1) return Fail("{}: /occupancy has no cells", path.string());
  OccupancyMaps maps;
  maps.grid.rows = static_cast<int>(size[1]);
  maps.grid.columns = static_cast<int>(size[2]);
  VANTAGE_ASSIGN_OR_RETURN(maps.grid.min_x_m,
                           parts.Scalar<double>(dataset, "min_x_m", H5T_NATIVE_DOUBLE));
  VANTAGE_ASSIGN_OR_RETURN(maps.grid.min_y_m,
                           parts.Scalar<double>(dataset, "min_y_m", H5T_NATIVE_DOUBLE));
  VANTAGE_ASSIGN_OR_RETURN(maps.grid.cell_m,
                           parts.Scalar<double>(dataset, "cell_m", H5T_NATIVE_DOUBLE));
  VANTAGE_ASSIGN_OR_RETURN(maps.frames_per_second,
                           parts.Scalar<double>(dataset, "frames_per_second", H5T_NATIVE_DOUBLE));
  VANTAGE_ASSIGN_OR_RETURN(maps.first_frame,
                           parts.Scalar<std::int64_t>(dataset, "first_frame", H5T_NATIVE_INT64));
  VANTAGE_ASSIGN_OR_RETURN(maps.in_area, parts.Flags("/in_area", maps.grid));
  VANTAGE_ASSIGN_OR_RETURN(maps.visible, parts.Flags("/visible", maps.grid));
  VANTAGE_RETURN_IF_ERROR(CheckMapHeader(path, maps));
  Dataset cached = WithCache(file.get(), std::move(dataset), size);
  auto content = std::make_unique<Content>(path, std::move(file), std::move(cached));
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
                content_->path.string(), values.size(), first, content_->frames, cells);
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
      return Fail("{}: /occupancy cannot be read; the file is damaged", content_->path.string());
    }
  }
  return CheckMapValues(content_->path, values, cells, first);
}

}  // namespace vantage
