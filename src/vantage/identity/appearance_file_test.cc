// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/identity/appearance_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "vantage/base/file.h"
#include "vantage/base/test_support.h"
#include "vantage/occupancy/map_file.h"

#ifdef __SANITIZE_ADDRESS__
/// HDF5 asks for absurd amounts of memory when a file is damaged and copes with getting none; the
/// address sanitizer would end the program instead.
extern "C" const char* __asan_default_options() { return "allocator_may_return_null=1"; }
#endif

namespace vantage {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::MessageOf;
using testing::TemporaryFolder;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr const char* kColumns[] = {"/appearances/frame", "/appearances/cell",
                                    "/appearances/camera", "/appearances/colors"};

/// 20 maps of 7 x 5 cells.
OccupancyMaps SomeMaps() {
  OccupancyMaps maps;
  maps.grid = {-3.25, 2.5, 0.3, 7, 5};
  maps.first_frame = 41;
  maps.frames_per_second = 6.97;
  maps.in_area.assign(35, 1);
  maps.visible.assign(35, 1);
  maps.values.assign(20 * 35, 0.25F);
  return maps;
}

/// As many in each of the 20 frames; a quarter of the colours is hidden.
Appearances SomeAppearances(int in_each_frame) {
  std::mt19937 random(5);
  Appearances appearances;
  for (int i = 0; i < 20 * in_each_frame; ++i) {
    Appearance seen{.frame = i / in_each_frame,
                    .cell = static_cast<CellIndex>(random() % 35),
                    .camera = static_cast<int>(random() % 4)};
    for (float& color : seen.colors) {
      color = random() % 4 == 0 ? kNan : static_cast<float>(random() % 256);
    }
    appearances.push_back(seen);
  }
  appearances.back().camera = 10'000;
  return appearances;
}

void ExpectSame(const Appearances& read, const Appearances& written) {
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    ASSERT_EQ(read[i].frame, written[i].frame) << i;
    ASSERT_EQ(read[i].cell, written[i].cell) << i;
    ASSERT_EQ(read[i].camera, written[i].camera) << i;
    for (std::size_t k = 0; k < read[i].colors.size(); ++k) {
      const float color = written[i].colors[k];
      ASSERT_TRUE(std::isnan(color) ? std::isnan(read[i].colors[k]) : read[i].colors[k] == color)
          << i << " " << k;
    }
  }
}

/// Changes a good file through HDF5 itself, then reads its colours.
template <class Change>
std::string MessageAfter(Change change) {
  const TemporaryFolder folder;
  const fs::path path = folder / "maps.h5";
  EXPECT_TRUE(WriteMaps(path, SomeMaps()));
  EXPECT_TRUE(AddAppearances(path, SomeAppearances(2)));
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  change(file);
  H5Fclose(file);
  const auto appearances = ReadAppearances(path, SomeMaps());
  EXPECT_FALSE(appearances);
  EXPECT_THAT(MessageOf(appearances), HasSubstr(path.string() + ": "));
  EXPECT_EQ(MessageOf(appearances).find('\n'), std::string::npos);
  EXPECT_TRUE(ReadMaps(path)) << "the maps are as good as before";
  return MessageOf(appearances);
}

/// Puts a dataset of the given size and type in place of another; `change` may set its layout.
template <class Change>
void Replace(hid_t file, const char* name, std::vector<hsize_t> size, hid_t type, Change change) {
  if (H5Lexists(file, name, H5P_DEFAULT) > 0) H5Ldelete(file, name, H5P_DEFAULT);
  const hid_t space = H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr);
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  change(properties);
  H5Dclose(H5Dcreate2(file, name, type, space, H5P_DEFAULT, properties, H5P_DEFAULT));
  H5Pclose(properties);
  H5Sclose(space);
}
void Replace(hid_t file, const char* name, const std::vector<hsize_t>& size, hid_t type) {
  Replace(file, name, size, type, [&](hid_t properties) {
    const std::vector<hsize_t> chunk(size.size(), 1);
    H5Pset_chunk(properties, static_cast<int>(chunk.size()), chunk.data());
  });
}

/// Sets entry 7 of a column (of the first of its values).
template <class T>
std::string MessageWith(const char* name, hid_t type, T value) {
  return MessageAfter([&](hid_t file) {
    const hid_t dataset = H5Dopen2(file, name, H5P_DEFAULT);
    const hid_t space = H5Dget_space(dataset);
    const std::vector<hsize_t> at = {7, 0};
    H5Sselect_elements(space, H5S_SELECT_SET, 1, at.data());
    const hid_t scalar = H5Screate(H5S_SCALAR);
    H5Dwrite(dataset, type, scalar, space, H5P_DEFAULT, &value);
    H5Sclose(scalar);
    H5Sclose(space);
    H5Dclose(dataset);
  });
}

TEST(AppearanceFile, RoundTrip) {
  const TemporaryFolder folder;
  const fs::path path = folder / "maps.h5";
  for (const int in_each_frame : {1, 3, 300}) {  // one chunk and several
    const Appearances appearances = SomeAppearances(in_each_frame);
    ASSERT_TRUE(WriteMaps(path, SomeMaps()));
    ASSERT_EQ(MessageOf(AddAppearances(path, appearances)), "");
    const auto read = ReadAppearances(path, SomeMaps());
    ASSERT_TRUE(read) << MessageOf(read);
    ExpectSame(*read, appearances);
    const auto maps = ReadMaps(path);
    ASSERT_TRUE(maps) << MessageOf(maps);
    EXPECT_EQ(maps->values, SomeMaps().values);
  }
}

TEST(AppearanceFile, AFileWithoutColoursHasNone) {
  const TemporaryFolder folder;
  const fs::path path = folder / "maps.h5";
  ASSERT_TRUE(WriteMaps(path, SomeMaps()));
  const std::string bytes = *ReadTextFile(path);
  auto read = ReadAppearances(path, SomeMaps());
  ASSERT_TRUE(read) << MessageOf(read);
  EXPECT_TRUE(read->empty());
  ASSERT_TRUE(AddAppearances(path, {}));
  EXPECT_EQ(*ReadTextFile(path), bytes);

  // Another program may write a group without entries.
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  H5Gclose(H5Gcreate2(file, "/appearances", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  const auto none = [](hid_t) {};
  for (const char* name : {kColumns[0], kColumns[1], kColumns[2]}) {
    Replace(file, name, {0}, H5T_STD_I32LE, none);
  }
  Replace(file, kColumns[3], {0, 18}, H5T_IEEE_F32LE, none);
  H5Fclose(file);
  read = ReadAppearances(path, SomeMaps());
  ASSERT_TRUE(read) << MessageOf(read);
  EXPECT_TRUE(read->empty());
}

TEST(AppearanceFile, EqualContentGivesEqualBytes) {
  const TemporaryFolder folder;
  for (const char* name : {"a.h5", "b.h5"}) {
    ASSERT_TRUE(WriteMaps(folder / name, SomeMaps()));
    ASSERT_TRUE(AddAppearances(folder / name, SomeAppearances(300)));
  }
  EXPECT_EQ(*ReadTextFile(folder / "a.h5"), *ReadTextFile(folder / "b.h5"));
  // Which a time of making would spoil at the next second.
  const hid_t file = H5Fopen((folder / "a.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  for (const char* name : kColumns) {
    const hid_t dataset = H5Dopen2(file, name, H5P_DEFAULT);
    H5O_info_t info;
    ASSERT_GE(H5Oget_info2(dataset, &info, H5O_INFO_TIME), 0);
    EXPECT_EQ(info.ctime, 0) << name;
    EXPECT_EQ(info.mtime, 0) << name;
    const hid_t layout = H5Dget_create_plist(dataset);
    EXPECT_EQ(H5Pget_layout(layout), H5D_CHUNKED) << name;
    EXPECT_EQ(H5Pget_nfilters(layout), 2) << name;
    H5Pclose(layout);
    H5Dclose(dataset);
  }
  H5Fclose(file);
}

TEST(AppearanceFile, WhatCannotBeReadIsNotWritten) {
  const TemporaryFolder folder;
  const fs::path path = folder / "maps.h5";
  EXPECT_THAT(MessageOf(AddAppearances(path, SomeAppearances(1))), HasSubstr("no such file"));
  ASSERT_TRUE(WriteTextFile(path, "neither this nor that"));
  EXPECT_THAT(MessageOf(AddAppearances(path, SomeAppearances(1))), HasSubstr("maps.h5: cannot be"));
  ASSERT_TRUE(WriteMaps(path, SomeMaps()));
  const std::string bytes = *ReadTextFile(path);
  Appearances appearances = SomeAppearances(1);
  appearances[3].cell = 35;
  EXPECT_THAT(MessageOf(AddAppearances(path, appearances)),
              HasSubstr("/appearances/cell is 35 in entry 3; there are 35 cells"));
  EXPECT_EQ(*ReadTextFile(path), bytes);
  ASSERT_TRUE(AddAppearances(path, SomeAppearances(1)));
  EXPECT_THAT(MessageOf(AddAppearances(path, SomeAppearances(1))),
              HasSubstr("maps.h5: has /appearances already"));
  EXPECT_TRUE(ReadAppearances(path, SomeMaps()));
}

TEST(AppearanceFile, MissingPartsAreNamed) {
  for (const char* name : kColumns) {
    EXPECT_THAT(MessageAfter([name](hid_t f) { H5Ldelete(f, name, H5P_DEFAULT); }),
                HasSubstr(std::string("no dataset ") + name));
  }
}

TEST(AppearanceFile, LinksAndOtherFilesAreRefused) {
  EXPECT_THAT(MessageAfter([](hid_t f) {
                H5Lmove(f, "/appearances", f, "/elsewhere", H5P_DEFAULT, H5P_DEFAULT);
                H5Lcreate_soft("/elsewhere", f, "/appearances", H5P_DEFAULT, H5P_DEFAULT);
              }),
              HasSubstr("/appearances is not a group of this file"));
  EXPECT_THAT(MessageAfter([](hid_t f) {
                H5Ldelete(f, "/appearances", H5P_DEFAULT);
                H5Lcreate_external("/etc/passwd", "/x", f, "/appearances", H5P_DEFAULT,
                                   H5P_DEFAULT);
              }),
              HasSubstr("/appearances is not a group of this file"));
  EXPECT_THAT(MessageAfter([](hid_t f) {
                H5Ldelete(f, "/appearances", H5P_DEFAULT);
                Replace(f, "/appearances", {40}, H5T_STD_I32LE, [](hid_t) {});
              }),
              HasSubstr("no dataset /appearances/frame"));
  EXPECT_THAT(MessageAfter([](hid_t f) {
                H5Lmove(f, kColumns[1], f, "/elsewhere", H5P_DEFAULT, H5P_DEFAULT);
                H5Lcreate_soft("/elsewhere", f, kColumns[1], H5P_DEFAULT, H5P_DEFAULT);
              }),
              HasSubstr("no dataset /appearances/cell"));
  EXPECT_THAT(MessageAfter([](hid_t f) {
                Replace(f, kColumns[2], {40}, H5T_STD_I32LE,
                        [](hid_t layout) { H5Pset_external(layout, "/etc/passwd", 0, 160); });
              }),
              HasSubstr("/appearances/camera lies in other files"));
}

TEST(AppearanceFile, WrongShapesAndTypesAreNamed) {
  EXPECT_THAT(MessageAfter([](hid_t f) { Replace(f, kColumns[0], {40}, H5T_IEEE_F64LE); }),
              HasSubstr("/appearances/frame is not of integers"));
  EXPECT_THAT(MessageAfter([](hid_t f) {
                Replace(f, kColumns[3], {40, 18}, H5T_STD_I32LE);
              }),
              HasSubstr("/appearances/colors is not of floating-point numbers"));
  EXPECT_THAT(MessageAfter([](hid_t f) {
                Replace(f, kColumns[1], {40, 1}, H5T_STD_I32LE);
              }),
              HasSubstr("/appearances/cell must have 1 dimensions"));
  EXPECT_THAT(MessageAfter([](hid_t f) { Replace(f, kColumns[3], {720}, H5T_IEEE_F32LE); }),
              HasSubstr("/appearances/colors must have 2 dimensions"));
  EXPECT_THAT(MessageAfter([](hid_t f) {
                Replace(f, kColumns[3], {40, 17}, H5T_IEEE_F32LE,
                        [](hid_t layout) { H5Pset_alloc_time(layout, H5D_ALLOC_TIME_EARLY); });
              }),
              HasSubstr("/appearances/colors is 40 x 17; it must be 40 x 18"));
  EXPECT_THAT(MessageAfter([](hid_t f) { Replace(f, kColumns[2], {39}, H5T_STD_I32LE); }),
              HasSubstr("/appearances/camera is 39 x 1; it must be 40 x 1"));
  EXPECT_THAT(MessageAfter([](hid_t f) { Replace(f, kColumns[0], {41}, H5T_STD_I64LE); }),
              HasSubstr("/appearances/cell is 40 x 1; it must be 41 x 1"));
}

TEST(AppearanceFile, UnknownFiltersAreRefused) {
  EXPECT_THAT(MessageAfter([](hid_t f) {
                Replace(f, kColumns[1], {40}, H5T_STD_I32LE, [](hid_t layout) {
                  const hsize_t chunk = 40;
                  H5Pset_chunk(layout, 1, &chunk);
                  H5Pset_scaleoffset(layout, H5Z_SO_INT, H5Z_SO_INT_MINBITS_DEFAULT);
                });
              }),
              HasSubstr("/appearances/cell uses an unknown filter"));
}

TEST(AppearanceFile, AbsurdSizesAreRefusedBeforeMemoryIsTaken) {
  EXPECT_THAT(MessageAfter([](hid_t f) { Replace(f, kColumns[0], {90000000}, H5T_STD_I64LE); }),
              HasSubstr("/appearances/frame declares 720000000 bytes but stores only 0"));
  EXPECT_THAT(
      MessageAfter([](hid_t f) { Replace(f, kColumns[0], {hsize_t{1} << 40}, H5T_STD_I64LE); }),
      AllOf(HasSubstr("/appearances/frame is 1099511627776"), HasSubstr("more than")));
  EXPECT_THAT(MessageAfter([](hid_t f) {
                Replace(f, kColumns[3], {40, hsize_t{1} << 40}, H5T_IEEE_F32LE);
              }),
              HasSubstr("/appearances/colors is 40 x 1099511627776"));
}

TEST(AppearanceFile, AbsurdValuesAreRefused) {
  const auto frame = [](std::int64_t value) {
    return MessageWith(kColumns[0], H5T_NATIVE_INT64, value);
  };
  EXPECT_THAT(frame(-1), HasSubstr("/appearances/frame is -1 in entry 7; there are 20 maps"));
  EXPECT_THAT(frame(20), HasSubstr("/appearances/frame is 20 in entry 7; there are 20 maps"));
  EXPECT_THAT(frame(2), HasSubstr("/appearances/frame is 2 in entry 7 after 3; it must ascend"));
  EXPECT_THAT(frame(5), HasSubstr("/appearances/frame is 4 in entry 8 after 5; it must ascend"));
  const auto cell = [](int value) { return MessageWith(kColumns[1], H5T_NATIVE_INT, value); };
  EXPECT_THAT(cell(-1), HasSubstr("/appearances/cell is -1 in entry 7; there are 35 cells"));
  EXPECT_THAT(cell(35), HasSubstr("/appearances/cell is 35 in entry 7; there are 35 cells"));
  const auto camera = [](int value) { return MessageWith(kColumns[2], H5T_NATIVE_INT, value); };
  EXPECT_THAT(camera(-1), HasSubstr("/appearances/camera is -1 in entry 7; it must be between 0"));
  EXPECT_THAT(camera(10'001), HasSubstr("/appearances/camera is 10001 in entry 7"));
  const auto color = [](float value) { return MessageWith(kColumns[3], H5T_NATIVE_FLOAT, value); };
  EXPECT_THAT(color(-0.5F), HasSubstr("/appearances/colors is -0.5 in entry 7; it must be"));
  EXPECT_THAT(color(255.5F), HasSubstr("/appearances/colors is 255.5 in entry 7"));
  EXPECT_THAT(color(std::numeric_limits<float>::infinity()),
              HasSubstr("/appearances/colors is inf"));
}

TEST(AppearanceFile, IntegersOfOtherSizesAreReadWhereTheyFit) {
  // What does not fit is outside, too.
  EXPECT_THAT(MessageAfter([](hid_t f) {
                Replace(f, kColumns[1], {40}, H5T_STD_I64LE, [](hid_t layout) {
                  const std::int64_t value = (std::int64_t{1} << 32) + 3;  // not cell 3
                  H5Pset_fill_value(layout, H5T_NATIVE_INT64, &value);
                  H5Pset_fill_time(layout, H5D_FILL_TIME_ALLOC);
                  H5Pset_alloc_time(layout, H5D_ALLOC_TIME_EARLY);
                });
              }),
              HasSubstr("/appearances/cell is 2147483647 in entry 0"));
}

TEST(AppearanceFile, MapsThatDoNotBelongAreNoticed) {
  const TemporaryFolder folder;
  const fs::path path = folder / "maps.h5";
  ASSERT_TRUE(WriteMaps(path, SomeMaps()));
  ASSERT_TRUE(AddAppearances(path, SomeAppearances(2)));
  OccupancyMaps maps = SomeMaps();
  maps.values.resize(19 * 35);
  EXPECT_THAT(MessageOf(ReadAppearances(path, maps)), HasSubstr("there are 19 maps"));
  for (const double rate : {0.0, 1e-300, 1e300}) {
    maps = SomeMaps();
    maps.frames_per_second = rate;
    EXPECT_THAT(MessageOf(ReadAppearances(path, maps)), HasSubstr("maps.h5: frames_per_second is"));
  }
}

TEST(AppearanceFileDeathTest, DamagedBytesNeverCrashTheReader) {
  const TemporaryFolder folder;
  ASSERT_TRUE(WriteMaps(folder / "maps.h5", SomeMaps()));
  const std::size_t without = fs::file_size(folder / "maps.h5");
  ASSERT_TRUE(AddAppearances(folder / "maps.h5", SomeAppearances(3)));
  const std::string bytes = *ReadTextFile(folder / "maps.h5");
  ASSERT_GT(bytes.size(), without);
  // In a process of its own: HDF5 itself loses some memory on damaged files.
  const auto read_damaged = [&] {
    std::mt19937 random(8);
    int refused = 0;
    for (int round = 0; round < 200; ++round) {
      std::string damaged = bytes;
      for (int k = 0; k < 8; ++k) {
        damaged[without + random() % (bytes.size() - without)] = static_cast<char>(random());
      }
      std::ofstream(folder / "damaged.h5", std::ios::binary) << damaged;
      refused += !ReadAppearances(folder / "damaged.h5", SomeMaps());
    }
    std::_Exit(refused > 20 ? 0 : 1);
  };
  EXPECT_EXIT(read_damaged(), ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace vantage
