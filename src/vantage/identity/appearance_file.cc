// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/identity/appearance_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "vantage/occupancy/hdf5_handles.h"
#include "vantage/occupancy/map_parts.h"
#include "vantage/occupancy/map_reader.h"

namespace vantage {
namespace fs = std::filesystem;
namespace {

using hdf5::Dataset;
using hdf5::File;
using hdf5::Properties;
using hdf5::QuietErrors;
using hdf5::Space;
using Group = hdf5::Handle<H5Gclose>;

constexpr const char* kGroup = "/appearances";
constexpr int kMaxCamera = 10'000;
// Scenes have at most 1000 frames per second; what is far beyond is no number of frames.
constexpr double kMinFramesPerSecond = 1e-6;
constexpr double kMaxFramesPerSecond = 1e6;

constexpr hsize_t kChunkEntries = 4096;

/// A dataset of the group, and where its values are in an Appearance.
struct Column {
  const char* name;
  H5T_class_t type_class;
  hid_t file_type, memory_type;
  std::size_t value_bytes, offset_bytes;
  hsize_t width;  // values an entry

  int rank() const { return width == 1 ? 1 : 2; }
};

std::array<Column, 4> Columns() {
  return {Column{"/appearances/frame", H5T_INTEGER, H5T_STD_I64LE, H5T_NATIVE_INT64,
                 sizeof(std::int64_t), offsetof(Appearance, frame), 1},
          Column{"/appearances/cell", H5T_INTEGER, H5T_STD_I32LE, H5T_NATIVE_INT32,
                 sizeof(CellIndex), offsetof(Appearance, cell), 1},
          Column{"/appearances/camera", H5T_INTEGER, H5T_STD_I32LE, H5T_NATIVE_INT32, sizeof(int),
                 offsetof(Appearance, camera), 1},
          Column{"/appearances/colors", H5T_FLOAT, H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, sizeof(float),
                 offsetof(Appearance, colors), BandColors().size()}};
}
static_assert(sizeof(CellIndex) == 4 && sizeof(int) == 4 && sizeof(Appearance) % 8 == 0);

/// The values of a column in an array of appearances, which HDF5 sees as a table of such values.
Space InMemory(const Column& column, hsize_t entries) {
  const std::array size = {entries, static_cast<hsize_t>(sizeof(Appearance) / column.value_bytes)};
  const std::array start = {hsize_t{0},
                            static_cast<hsize_t>(column.offset_bytes / column.value_bytes)};
  const std::array count = {entries, column.width};
  Space space(H5Screate_simple(2, size.data(), nullptr));
  H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
  return space;
}

bool WriteColumn(hid_t file, const Column& column, const Appearances& appearances) {
  const auto entries = static_cast<hsize_t>(appearances.size());
  const std::array size = {entries, column.width};
  const std::array chunk = {std::min(entries, kChunkEntries), column.width};
  const Space space(H5Screate_simple(column.rank(), size.data(), nullptr));
  const Properties layout =
      hdf5::CompressedProperties(std::span(chunk).first(static_cast<std::size_t>(column.rank())));
  if (!layout.valid()) return false;
  Dataset dataset(H5Dcreate2(file, column.name, column.file_type, space.get(), H5P_DEFAULT,
                             layout.get(), H5P_DEFAULT));
  return dataset.valid() &&
         H5Dwrite(dataset.get(), column.memory_type, InMemory(column, entries).get(), H5S_ALL,
                  H5P_DEFAULT, appearances.data()) >= 0 &&
         dataset.Close();
}

bool WriteGroup(hid_t file, const Appearances& appearances) {
  const Properties properties(H5Pcreate(H5P_GROUP_CREATE));
  H5Pset_obj_track_times(properties.get(), false);
  Group group(H5Gcreate2(file, kGroup, H5P_DEFAULT, properties.get(), H5P_DEFAULT));
  return group.valid() &&
         std::ranges::all_of(
             Columns(),
             [&](const Column& column) { return WriteColumn(file, column, appearances); }) &&
         group.Close();
}

/// What appearances in a file must be whose maps have so many cells and frames.
Status Check(const fs::path& path, const Appearances& appearances, CellIndex cells,
             std::int64_t frames) {
  const std::string name = path.string();
  std::int64_t frame = 0;
  for (std::size_t i = 0; i < appearances.size(); ++i) {
    const Appearance& seen = appearances[i];
    if (seen.frame < 0 || seen.frame >= frames) {
      return Fail("{}: {}/frame is {} in entry {}; there are {} maps", name, kGroup, seen.frame, i,
                  frames);
    }
    if (seen.frame < frame) {
      return Fail("{}: {}/frame is {} in entry {} after {}; it must ascend", name, kGroup,
                  seen.frame, i, frame);
    }
    frame = seen.frame;
    if (seen.cell < 0 || seen.cell >= cells) {
      return Fail("{}: {}/cell is {} in entry {}; there are {} cells", name, kGroup, seen.cell, i,
                  cells);
    }
    if (seen.camera < 0 || seen.camera > kMaxCamera) {
      return Fail("{}: {}/camera is {} in entry {}; it must be between 0 and {}", name, kGroup,
                  seen.camera, i, kMaxCamera);
    }
    for (const float color : seen.colors) {
      if (!std::isnan(color) && !(color >= 0 && color <= 255)) {
        return Fail("{}: {}/colors is {} in entry {}; it must be between 0 and 255, or NaN", name,
                    kGroup, color, i);
      }
    }
  }
  return {};
}

/// The group's datasets in the order of Columns(), all of as many entries.
struct Parts {
  std::vector<Dataset> datasets;
  std::size_t entries = 0;
};

Result<Parts> OpenGroup(const MapParts& file) {
  Parts parts;
  for (const Column& column : Columns()) {
    VANTAGE_ASSIGN_OR_RETURN(MapParts::Part part,
                             file.OpenDataset(column.name, column.rank(), column.type_class));
    auto& [dataset, size] = part;
    if (parts.datasets.empty()) parts.entries = static_cast<std::size_t>(size[0]);
    if (size[0] != parts.entries || size[1] != column.width) {
      return Fail("{}: {} is {} x {}; it must be {} x {}", file.path().string(), column.name,
                  size[0], size[1], parts.entries, column.width);
    }
    parts.datasets.push_back(std::move(dataset));
  }
  return parts;
}

/// Whether the file has a group of colours at all.
Result<bool> HasGroup(const MapParts& file) {
  const htri_t exists = H5Lexists(file.file(), kGroup, H5P_DEFAULT);
  if (exists == 0) return false;
  // Soft and external links could lead anywhere.
  H5L_info_t link;
  if (exists < 0 || H5Lget_info(file.file(), kGroup, &link, H5P_DEFAULT) < 0 ||
      link.type != H5L_TYPE_HARD) {
    return Fail("{}: {} is not a group of this file", file.path().string(), kGroup);
  }
  return true;
}

Result<Appearances> ReadGroup(const fs::path& path) {
  const std::lock_guard lock(hdf5::mutex);
  const QuietErrors quiet;
  VANTAGE_ASSIGN_OR_RETURN(const MapParts file, MapParts::Open(path));
  VANTAGE_ASSIGN_OR_RETURN(const bool has_group, HasGroup(file));
  if (!has_group) return Appearances();
  VANTAGE_ASSIGN_OR_RETURN(const Parts parts, OpenGroup(file));
  Appearances appearances(parts.entries);
  if (appearances.empty()) return appearances;
  const std::array columns = Columns();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Column& column = columns[i];
    if (H5Dread(parts.datasets[i].get(), column.memory_type, InMemory(column, parts.entries).get(),
                H5S_ALL, H5P_DEFAULT, appearances.data()) < 0) {
      return Fail("{}: {} cannot be read; the file is damaged", path.string(), column.name);
    }
  }
  return appearances;
}

}  // namespace

Status AddAppearances(const fs::path& maps_file, const Appearances& appearances) {
  if (appearances.empty()) return {};
  {
    VANTAGE_ASSIGN_OR_RETURN(const MapReader maps, MapReader::Open(maps_file));
    VANTAGE_RETURN_IF_ERROR(
        Check(maps_file, appearances, maps.header().grid.count(), maps.frame_count()));
  }
  const std::lock_guard lock(hdf5::mutex);
  const QuietErrors quiet;
  errno = 0;
  File file(H5Fopen(maps_file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
  if (file.valid() && H5Lexists(file.get(), kGroup, H5P_DEFAULT) > 0) {
    return Fail("{}: has {} already", maps_file.string(), kGroup);
  }
  if (!file.valid() || !WriteGroup(file.get(), appearances) ||
      H5Fflush(file.get(), H5F_SCOPE_LOCAL) < 0 || !file.Close()) {
    const std::string reason = errno == 0 ? "HDF5 failed" : std::strerror(errno);
    return Fail("{}: {} cannot be written: {}", maps_file.string(), kGroup, reason);
  }
  return {};
}

Result<Appearances> ReadAppearances(const fs::path& maps_file, const OccupancyMaps& maps) {
  VANTAGE_ASSIGN_OR_RETURN(Appearances appearances, ReadGroup(maps_file));
  if (appearances.empty()) return appearances;
  VANTAGE_RETURN_IF_ERROR(Check(maps_file, appearances, maps.grid.count(), maps.frame_count()));
  if (!(maps.frames_per_second >= kMinFramesPerSecond &&
        maps.frames_per_second <= kMaxFramesPerSecond)) {
    return Fail("{}: frames_per_second is {}; for {} it must be between {} and {}",
                maps_file.string(), maps.frames_per_second, kGroup, kMinFramesPerSecond,
                kMaxFramesPerSecond);
  }
  return appearances;
}

}  // namespace vantage
