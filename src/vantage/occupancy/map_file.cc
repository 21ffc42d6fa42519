// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/map_file.h"

#include <hdf5.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <mutex>
#include <utility>

#include "vantage/base/file.h"

namespace vantage {
namespace fs = std::filesystem;
namespace {

constexpr hsize_t kMaxCells = 4'000'000;
constexpr hsize_t kMaxFrames = 100'000'000;
constexpr hsize_t kMaxChunkValues = 64'000'000;
constexpr unsigned kDeflateLevel = 4;

/// HDF5 as Debian builds it is not thread-safe.
std::mutex hdf5_mutex;

/// Keeps HDF5 from printing its own errors, and restores the caller's setting.
class QuietErrors {
 public:
  QuietErrors() {
    // A damaged file can leave objects that HDF5 cannot close; its clean-up at exit would then
    // print "infinite loop closing library". Everything written here is closed, and checked, before
    // that.
    static const herr_t no_clean_up = H5dont_atexit();
    static_cast<void>(no_clean_up);
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~QuietErrors() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

/// Owns an HDF5 identifier.
template <herr_t (*kClose)(hid_t)>
class Handle {
 public:
  explicit Handle(hid_t id) : id_(id) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)) {}
  Handle& operator=(Handle&&) = delete;
  ~Handle() { Close(); }
  bool Close() { return id_ < 0 || kClose(std::exchange(id_, H5I_INVALID_HID)) >= 0; }
  bool valid() const { return id_ >= 0; }
  hid_t get() const { return id_; }

 private:
  hid_t id_;
};
using File = Handle<H5Fclose>;
using Dataset = Handle<H5Dclose>;
using Space = Handle<H5Sclose>;
using Type = Handle<H5Tclose>;
using Attribute = Handle<H5Aclose>;
using Properties = Handle<H5Pclose>;

Status CheckMaps(const fs::path& path, const OccupancyMaps& maps) {
  const std::string name = path.string();
  const GroundGrid& grid = maps.grid;
  const auto cells = static_cast<std::size_t>(grid.count());
  if (!std::isfinite(grid.min_x_m) || !std::isfinite(grid.min_y_m)) {
    return Fail("{}: min_x_m or min_y_m is not finite", name);
  }
  if (!std::isfinite(grid.cell_m) || grid.cell_m <= 0) {
    return Fail("{}: cell_m is {}; it must be above 0", name, grid.cell_m);
  }
  if (!std::isfinite(maps.frames_per_second) || maps.frames_per_second < 0) {
    return Fail("{}: frames_per_second is {}; it must be at least 0", name, maps.frames_per_second);
  }
  for (const auto* flags : {&maps.in_area, &maps.visible}) {
    const char* what = flags == &maps.in_area ? "in_area" : "visible";
    if (flags->size() != cells) {
      return Fail("{}: {} has {} cells; the grid has {}", name, what, flags->size(), cells);
    }
    for (std::size_t i = 0; i < cells; ++i) {
      if ((*flags)[i] > 1) {
        return Fail("{}: {} is {} at cell {}; it must be 0 or 1", name, what, (*flags)[i], i);
      }
    }
  }
  if (maps.values.size() % cells != 0) {
    return Fail("{}: {} values are not whole maps of {} cells", name, maps.values.size(), cells);
  }
  for (std::size_t i = 0; i < maps.values.size(); ++i) {
    if (!(maps.values[i] >= 0 && maps.values[i] <= 1)) {
      return Fail("{}: /occupancy is {} in map {} at cell {}; it must be between 0 and 1", name,
                  maps.values[i], i / cells, i % cells);
    }
  }
  return {};
}

template <class T>
bool WriteAttribute(hid_t object, const char* name, hid_t type, T value) {
  const Space scalar(H5Screate(H5S_SCALAR));
  const Attribute attribute(H5Acreate2(object, name, type, scalar.get(), H5P_DEFAULT, H5P_DEFAULT));
  return attribute.valid() && H5Awrite(attribute.get(), type, &value) >= 0;
}

/// Properties of a new dataset without the time of its making: equal maps give equal bytes.
Properties DatasetProperties() {
  Properties properties(H5Pcreate(H5P_DATASET_CREATE));
  H5Pset_obj_track_times(properties.get(), false);
  return properties;
}

bool WriteFlags(hid_t file, const char* name, const GroundGrid& grid,
                const std::vector<std::uint8_t>& flags) {
  const std::array size = {static_cast<hsize_t>(grid.rows), static_cast<hsize_t>(grid.columns)};
  const Space space(H5Screate_simple(2, size.data(), nullptr));
  const Properties properties = DatasetProperties();
  const Dataset dataset(H5Dcreate2(file, name, H5T_STD_U8LE, space.get(), H5P_DEFAULT,
                                   properties.get(), H5P_DEFAULT));
  return dataset.valid() && H5Dwrite(dataset.get(), H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                                     flags.data()) >= 0;
}

bool WriteContent(const fs::path& path, const OccupancyMaps& maps) {
  File file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  if (!file.valid()) return false;
  const auto rows = static_cast<hsize_t>(maps.grid.rows);
  const auto columns = static_cast<hsize_t>(maps.grid.columns);
  const std::array size = {static_cast<hsize_t>(maps.frame_count()), rows, columns};
  const std::array max_size = {static_cast<hsize_t>(H5S_UNLIMITED), rows, columns};
  const std::array chunk = {hsize_t{1}, rows, columns};
  const Space space(H5Screate_simple(3, size.data(), max_size.data()));
  const Properties layout = DatasetProperties();
  if (H5Pset_chunk(layout.get(), 3, chunk.data()) < 0 || H5Pset_shuffle(layout.get()) < 0 ||
      H5Pset_deflate(layout.get(), kDeflateLevel) < 0) {
    return false;
  }
  Dataset dataset(H5Dcreate2(file.get(), "/occupancy", H5T_IEEE_F32LE, space.get(), H5P_DEFAULT,
                             layout.get(), H5P_DEFAULT));
  return dataset.valid() &&
         H5Dwrite(dataset.get(), H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                  maps.values.data()) >= 0 &&
         WriteAttribute(dataset.get(), "min_x_m", H5T_NATIVE_DOUBLE, maps.grid.min_x_m) &&
         WriteAttribute(dataset.get(), "min_y_m", H5T_NATIVE_DOUBLE, maps.grid.min_y_m) &&
         WriteAttribute(dataset.get(), "cell_m", H5T_NATIVE_DOUBLE, maps.grid.cell_m) &&
         WriteAttribute(dataset.get(), "frames_per_second", H5T_NATIVE_DOUBLE,
                        maps.frames_per_second) &&
         WriteAttribute(dataset.get(), "first_frame", H5T_NATIVE_INT64, maps.first_frame) &&
         WriteFlags(file.get(), "/in_area", maps.grid, maps.in_area) &&
         WriteFlags(file.get(), "/visible", maps.grid, maps.visible) && dataset.Close() &&
         H5Fflush(file.get(), H5F_SCOPE_LOCAL) >= 0 && file.Close();
}

/// Reads the parts of one file; every message begins with its name.
class Reader {
 public:
  Reader(const fs::path& path, hid_t file) : path_(path.string()), file_(file) {}

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
    VANTAGE_RETURN_IF_ERROR(Read(name, dataset, H5T_NATIVE_UINT8, flags.data()));
    return flags;
  }

  Status Read(const char* name, const Dataset& dataset, hid_t memory_type, void* values) const {
    if (H5Dread(dataset.get(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0) {
      return Fail("{}: {} cannot be read; the file is damaged", path_, name);
    }
    return {};
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

Result<OccupancyMaps> ReadContent(const fs::path& path, hid_t file) {
  const Reader reader(path, file);
  VANTAGE_ASSIGN_OR_RETURN(const auto opened, reader.Open("/occupancy", 3, H5T_FLOAT));
  const auto& [dataset, size] = opened;
  if (size[1] < 1 || size[2] < 1) return Fail("{}: /occupancy has no cells", path.string());
  OccupancyMaps maps;
  maps.grid.rows = static_cast<int>(size[1]);
  maps.grid.columns = static_cast<int>(size[2]);
  VANTAGE_ASSIGN_OR_RETURN(maps.grid.min_x_m,
                           reader.Scalar<double>(dataset, "min_x_m", H5T_NATIVE_DOUBLE));
  VANTAGE_ASSIGN_OR_RETURN(maps.grid.min_y_m,
                           reader.Scalar<double>(dataset, "min_y_m", H5T_NATIVE_DOUBLE));
  VANTAGE_ASSIGN_OR_RETURN(maps.grid.cell_m,
                           reader.Scalar<double>(dataset, "cell_m", H5T_NATIVE_DOUBLE));
  VANTAGE_ASSIGN_OR_RETURN(maps.frames_per_second,
                           reader.Scalar<double>(dataset, "frames_per_second", H5T_NATIVE_DOUBLE));
  VANTAGE_ASSIGN_OR_RETURN(maps.first_frame,
                           reader.Scalar<std::int64_t>(dataset, "first_frame", H5T_NATIVE_INT64));
  VANTAGE_ASSIGN_OR_RETURN(maps.in_area, reader.Flags("/in_area", maps.grid));
  VANTAGE_ASSIGN_OR_RETURN(maps.visible, reader.Flags("/visible", maps.grid));
  maps.values.resize(size[0] * size[1] * size[2]);
  VANTAGE_RETURN_IF_ERROR(reader.Read("/occupancy", dataset, H5T_NATIVE_FLOAT, maps.values.data()));
  VANTAGE_RETURN_IF_ERROR(CheckMaps(path, maps));
  return maps;
}

}  // namespace

Status WriteMaps(const fs::path& path, const OccupancyMaps& maps) {
  if (maps.grid.rows < 1 || maps.grid.columns < 1) {
    return Fail("{}: the maps have no cells", path.string());
  }
  VANTAGE_RETURN_IF_ERROR(CheckMaps(path, maps));
  VANTAGE_ASSIGN_OR_RETURN(StagedFile staged, StagedFile::Create(path));
  const std::lock_guard lock(hdf5_mutex);
  const QuietErrors quiet;
  errno = 0;
  if (!WriteContent(staged.temporary(), maps)) {
    const std::string reason = errno == 0 ? "HDF5 failed" : std::strerror(errno);
    return Fail("{}: cannot be written: {}", path.string(), reason);
  }
  return staged.Commit();
}

Result<OccupancyMaps> ReadMaps(const fs::path& path) {
  std::error_code code;
  if (!fs::exists(path, code)) return Fail("{}: no such file", path.string());
  if (!fs::is_regular_file(path, code)) {
    return Fail("{}: is not a regular file; a file of occupancy maps is needed", path.string());
  }
  const std::lock_guard lock(hdf5_mutex);
  const QuietErrors quiet;
  const File file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
  if (!file.valid()) {
    return Fail(
        "{}: cannot be opened as HDF5; not a file of occupancy maps, truncated, or not "
        "readable",
        path.string());
  }
  return ReadContent(path, file.get());
}

}  // namespace vantage
