// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <hdf5.h>

#include <mutex>
#include <span>
#include <utility>

/// Internal to the library: HDF5's identifiers as values that close themselves.

namespace vantage::hdf5 {

/// HDF5 as Debian builds it is not thread-safe: every use of it, closing included, holds this.
inline std::mutex mutex;

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

/// Properties of a new dataset without the time of its making: equal content gives equal bytes.
inline Properties DatasetProperties() {
  Properties properties(H5Pcreate(H5P_DATASET_CREATE));
  H5Pset_obj_track_times(properties.get(), false);
  return properties;
}

/// The same of one that is stored compressed, in chunks of this size. Not valid when HDF5 fails.
inline Properties CompressedProperties(std::span<const hsize_t> chunk) {
  constexpr unsigned kDeflateLevel = 4;
  Properties properties = DatasetProperties();
  if (H5Pset_chunk(properties.get(), static_cast<int>(chunk.size()), chunk.data()) < 0 ||
      H5Pset_shuffle(properties.get()) < 0 || H5Pset_deflate(properties.get(), kDeflateLevel) < 0) {
    properties.Close();
  }
  return properties;
}

}  // namespace vantage::hdf5
