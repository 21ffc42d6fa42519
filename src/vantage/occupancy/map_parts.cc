// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/map_parts.h"

namespace vantage {
namespace fs = std::filesystem;
namespace {

using hdf5::Dataset;
using hdf5::File;
using hdf5::Properties;
using hdf5::Space;
using hdf5::Type;

constexpr hsize_t kMaxEntries = 100'000'000;
constexpr hsize_t kMaxValues = 4'000'000;
constexpr hsize_t kMaxChunkValues = 64'000'000;

}  // namespace

Result<MapParts> MapParts::Open(const fs::path& path) {
  std::error_code code;
  if (!fs::exists(path, code)) return Fail("{}: no such file", path.string());
  if (!fs::is_regular_file(path, code)) {
    return Fail("{}: is not a regular file; a file of occupancy maps is needed", path.string());
  }
  File file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
  if (!file.valid()) {
    return Fail(
        "{}: cannot be opened as HDF5; not a file of occupancy maps, truncated, or not "
        "readable",
        path.string());
  }
  return MapParts(path, std::move(file));
}

Result<MapParts::Part> MapParts::OpenDataset(const char* name, int rank,
                                             H5T_class_t type_class) const {
  // Soft and external links could lead anywhere.
  H5L_info_t link;
  if (H5Lget_info(file_.get(), name, &link, H5P_DEFAULT) < 0 || link.type != H5L_TYPE_HARD) {
    return Fail("{}: no dataset {}; not a whole file of occupancy maps", path_.string(), name);
  }
  Dataset dataset(H5Dopen2(file_.get(), name, H5P_DEFAULT));
  if (!dataset.valid()) return Fail("{}: {} cannot be opened as a dataset", path_.string(), name);
  const Type type(H5Dget_type(dataset.get()));
  if (H5Tget_class(type.get()) != type_class || H5Tget_size(type.get()) > 8) {
    return Fail("{}: {} is not of {}", path_.string(), name,
                type_class == H5T_FLOAT ? "floating-point numbers" : "integers");
  }
  const Space space(H5Dget_space(dataset.get()));
  std::array<hsize_t, 3> size = {1, 1, 1};
  if (H5Sget_simple_extent_ndims(space.get()) != rank ||
      H5Sget_simple_extent_dims(space.get(), size.data(), nullptr) != rank) {
    return Fail("{}: {} must have {} dimensions", path_.string(), name, rank);
  }
  VANTAGE_RETURN_IF_ERROR(CheckStorage(name, dataset, size, H5Tget_size(type.get())));
  return std::pair(std::move(dataset), size);
}

/// A few bytes can declare a dataset of any size, or one that lies in other files.
Status MapParts::CheckStorage(const char* name, const Dataset& dataset,
                              const std::array<hsize_t, 3>& size, std::size_t value_bytes) const {
  if (size[0] > kMaxEntries || size[1] > kMaxValues || size[2] > kMaxValues ||
      size[1] * size[2] > kMaxValues) {
    return Fail("{}: {} is {} x {} x {}; more than {} entries or {} values in each", path_.string(),
                name, size[0], size[1], size[2], kMaxEntries, kMaxValues);
  }
  const Properties layout(H5Dget_create_plist(dataset.get()));
  const H5D_layout_t kind = H5Pget_layout(layout.get());
  if (kind == H5D_VIRTUAL || H5Pget_external_count(layout.get()) != 0) {
    return Fail("{}: {} lies in other files; it must lie in this one", path_.string(), name);
  }
  const int filters = H5Pget_nfilters(layout.get());
  for (int i = 0; i < filters; ++i) {
    unsigned flags = 0;
    std::size_t parameters = 0;
    const H5Z_filter_t filter = H5Pget_filter2(layout.get(), static_cast<unsigned>(i), &flags,
                                               &parameters, nullptr, 0, nullptr, nullptr);
    if (filter != H5Z_FILTER_SHUFFLE && filter != H5Z_FILTER_DEFLATE &&
        filter != H5Z_FILTER_FLETCHER32) {
      return Fail("{}: {} uses an unknown filter; only shuffle and deflate are read",
                  path_.string(), name);
    }
  }
  if (kind == H5D_CHUNKED) {
    std::array<hsize_t, 3> chunk = {1, 1, 1};
    H5Pget_chunk(layout.get(), 3, chunk.data());
    hsize_t chunk_values = 1;
    for (const hsize_t side : chunk) {
      chunk_values = side > kMaxChunkValues ? kMaxChunkValues + 1 : chunk_values * side;
      if (chunk_values > kMaxChunkValues) {
        return Fail("{}: a chunk of {} has more than {} values", path_.string(), name,
                    kMaxChunkValues);
      }
    }
  }
  constexpr hsize_t kMaxDeflateRatio = 1100;  // zlib's bound is 1032
  const hsize_t bytes = size[0] * size[1] * size[2] * value_bytes;
  const hsize_t stored = H5Dget_storage_size(dataset.get());
  if (bytes / kMaxDeflateRatio > stored) {
    return Fail("{}: {} declares {} bytes but stores only {}; the file is incomplete",
                path_.string(), name, bytes, stored);
  }
  return {};
}

}  // namespace vantage
