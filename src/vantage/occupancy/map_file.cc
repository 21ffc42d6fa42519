// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/map_file.h"

#include <array>
#include <cerrno>
#include <cstring>

#include "vantage/base/file.h"
#include "vantage/occupancy/hdf5_handles.h"
#include "vantage/occupancy/map_checks.h"
#include "vantage/occupancy/map_reader.h"

namespace vantage {
namespace fs = std::filesystem;
namespace {

using hdf5::Attribute;
using hdf5::Dataset;
using hdf5::File;
using hdf5::Properties;
using hdf5::QuietErrors;
using hdf5::Space;

template <class T>
bool WriteAttribute(hid_t object, const char* name, hid_t type, T value) {
  const Space scalar(H5Screate(H5S_SCALAR));
  const Attribute attribute(H5Acreate2(object, name, type, scalar.get(), H5P_DEFAULT, H5P_DEFAULT));
  return attribute.valid() && H5Awrite(attribute.get(), type, &value) >= 0;
}

bool WriteFlags(hid_t file, const char* name, const GroundGrid& grid,
                const std::vector<std::uint8_t>& flags) {
  const std::array size = {static_cast<hsize_t>(grid.rows), static_cast<hsize_t>(grid.columns)};
  const Space space(H5Screate_simple(2, size.data(), nullptr));
  const Properties properties = hdf5::DatasetProperties();
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
  const Properties layout = hdf5::CompressedProperties(chunk);
  if (!layout.valid()) return false;
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

}  // namespace

Status WriteMaps(const fs::path& path, const OccupancyMaps& maps) {
  if (maps.grid.rows < 1 || maps.grid.columns < 1) {
    return Fail("{}: the maps have no cells", path.string());
  }
  VANTAGE_RETURN_IF_ERROR(CheckMapHeader(path, maps));
  VANTAGE_RETURN_IF_ERROR(
      CheckMapValues(path, maps.values, static_cast<std::size_t>(maps.grid.count()), 0));
  VANTAGE_ASSIGN_OR_RETURN(StagedFile staged, StagedFile::Create(path));
  const std::lock_guard lock(hdf5::mutex);
  const QuietErrors quiet;
  errno = 0;
  if (!WriteContent(staged.temporary(), maps)) {
    const std::string reason = errno == 0 ? "HDF5 failed" : std::strerror(errno);
    return Fail("{}: cannot be written: {}", path.string(), reason);
  }
  return staged.Commit();
}

Result<OccupancyMaps> ReadMaps(const fs::path& path) {
  VANTAGE_ASSIGN_OR_RETURN(const MapReader reader, MapReader::Open(path));
  OccupancyMaps maps = reader.header();
  maps.values.resize(static_cast<std::size_t>(reader.frame_count() * maps.grid.count()));
  VANTAGE_RETURN_IF_ERROR(reader.Read(0, maps.values));
  return maps;
}

}  // namespace vantage
