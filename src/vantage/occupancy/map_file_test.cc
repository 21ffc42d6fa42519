// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/map_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <random>

#include "vantage/base/file.h"
#include "vantage/base/test_support.h"

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

OccupancyMaps SomeMaps(int frames) {
  OccupancyMaps maps;
  maps.grid = {-3.25, 2.5, 0.3, 7, 5};
  maps.first_frame = 41;
  maps.frames_per_second = 6.97;
  std::mt19937 random(3);
  for (CellIndex i = 0; i < maps.grid.count(); ++i) {
    maps.in_area.push_back(random() % 2);
    maps.visible.push_back(random() % 2);
  }
  for (int i = 0; i < frames * maps.grid.count(); ++i) {
    maps.values.push_back(std::uniform_real_distribution<float>(0, 1)(random));
  }
  return maps;
}

/// Changes a good file through HDF5 itself, then reads it.
template <class Change>
std::string MessageAfter(Change change) {
  const TemporaryFolder folder;
  const fs::path path = folder / "maps.h5";
  EXPECT_TRUE(WriteMaps(path, SomeMaps(3)));
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  change(file);
  H5Fclose(file);
  const auto maps = ReadMaps(path);
  EXPECT_FALSE(maps);
  EXPECT_THAT(MessageOf(maps), HasSubstr(path.string()));
  return MessageOf(maps);
}

/// Puts a dataset of the given size and type in place of another.
void Replace(hid_t file, const char* name, std::vector<hsize_t> size, hid_t type) {
  H5Ldelete(file, name, H5P_DEFAULT);
  const hid_t space = H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr);
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  std::vector<hsize_t> chunk(size.size(), 1);
  H5Pset_chunk(properties, static_cast<int>(chunk.size()), chunk.data());
  H5Dclose(H5Dcreate2(file, name, type, space, H5P_DEFAULT, properties, H5P_DEFAULT));
  H5Pclose(properties);
  H5Sclose(space);
}

void SetAttribute(hid_t file, const char* name, double value) {
  H5Adelete_by_name(file, "/occupancy", name, H5P_DEFAULT);
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t attribute = H5Acreate_by_name(file, "/occupancy", name, H5T_NATIVE_DOUBLE, space,
                                            H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(attribute, H5T_NATIVE_DOUBLE, &value);
  H5Aclose(attribute);
  H5Sclose(space);
}

TEST(MapFile, RoundTrip) {
  const TemporaryFolder folder;
  const fs::path path = folder / "deep/maps.h5";
  for (const int frames : {0, 1, 12}) {
    const OccupancyMaps maps = SomeMaps(frames);
    ASSERT_EQ(MessageOf(WriteMaps(path, maps)), "");
    const Result<OccupancyMaps> read = ReadMaps(path);
    ASSERT_EQ(MessageOf(read), "");
    EXPECT_EQ(read->grid, maps.grid);
    EXPECT_EQ(read->first_frame, maps.first_frame);
    EXPECT_EQ(read->frames_per_second, maps.frames_per_second);
    EXPECT_EQ(read->in_area, maps.in_area);
    EXPECT_EQ(read->visible, maps.visible);
    EXPECT_EQ(read->values, maps.values);
  }
}

TEST(MapFile, UniformMapsAreNotTakenForIncomplete) {
  const TemporaryFolder folder;
  OccupancyMaps maps;
  maps.grid = {0, 0, 0.1, 1000, 1000};
  maps.in_area.assign(1000000, 1);
  maps.visible.assign(1000000, 1);
  maps.values.assign(3000000, 0.01F);
  ASSERT_TRUE(WriteMaps(folder / "maps.h5", maps));
  EXPECT_LT(fs::file_size(folder / "maps.h5"), 3000000U);  // compressed
  EXPECT_EQ(ReadMaps(folder / "maps.h5")->values, maps.values);
}

TEST(MapFile, TruncatedAndForeignFilesAreRefused) {
  const TemporaryFolder folder;
  const fs::path path = folder / "maps.h5";
  EXPECT_THAT(MessageOf(ReadMaps(path)), HasSubstr("maps.h5: no such file"));
  EXPECT_THAT(MessageOf(ReadMaps(folder.path())), HasSubstr("not a regular file"));
  ASSERT_TRUE(WriteMaps(path, SomeMaps(20)));
  const std::string bytes = *ReadTextFile(path);
  for (std::size_t length = 0; length < bytes.size(); length += bytes.size() / 40 + 1) {
    const fs::path cut = folder / "cut.h5";
    ASSERT_TRUE(WriteTextFile(cut, bytes.substr(0, length)));
    const auto maps = ReadMaps(cut);
    EXPECT_FALSE(maps) << length;
    EXPECT_THAT(MessageOf(maps), HasSubstr("cut.h5: ")) << length;
  }
}

TEST(MapFileDeathTest, DamagedBytesNeverCrashTheReader) {
  const TemporaryFolder folder;
  ASSERT_TRUE(WriteMaps(folder / "maps.h5", SomeMaps(4)));
  const std::string bytes = *ReadTextFile(folder / "maps.h5");
  // In a process of its own: HDF5 itself loses some memory on damaged files.
  const auto read_damaged = [&] {
    std::mt19937 random(8);
    int refused = 0;
    for (int round = 0; round < 200; ++round) {
      std::string damaged = bytes;
      for (int k = 0; k < 8; ++k) damaged[random() % damaged.size()] = static_cast<char>(random());
      std::ofstream(folder / "damaged.h5", std::ios::binary) << damaged;
      refused += !ReadMaps(folder / "damaged.h5");
    }
    std::_Exit(refused > 20 ? 0 : 1);
  };
  EXPECT_EXIT(read_damaged(), ::testing::ExitedWithCode(0), "");
}

TEST(MapFile, MissingPartsAreNamed) {
  EXPECT_THAT(MessageAfter([](hid_t file) { H5Ldelete(file, "/occupancy", H5P_DEFAULT); }),
              HasSubstr("no dataset /occupancy"));
  EXPECT_THAT(MessageAfter([](hid_t file) { H5Ldelete(file, "/in_area", H5P_DEFAULT); }),
              HasSubstr("no dataset /in_area"));
  for (const char* name : {"min_x_m", "min_y_m", "cell_m", "frames_per_second", "first_frame"}) {
    EXPECT_THAT(MessageAfter([name](hid_t file) {
                  H5Adelete_by_name(file, "/occupancy", name, H5P_DEFAULT);
                }),
                HasSubstr(name));
  }
}

TEST(MapFile, WrongShapesAndTypesAreNamed) {
  EXPECT_THAT(MessageAfter([](hid_t f) {
                Replace(f, "/occupancy", {5, 7}, H5T_IEEE_F32LE);
              }),
              HasSubstr("/occupancy must have 3 dimensions"));
  EXPECT_THAT(MessageAfter([](hid_t f) {
                Replace(f, "/occupancy", {1, 5, 7}, H5T_STD_I32LE);
              }),
              HasSubstr("not of floating-point numbers"));
  EXPECT_THAT(MessageAfter([](hid_t f) {
                Replace(f, "/visible", {7, 5}, H5T_STD_U8LE);
              }),
              AllOf(HasSubstr("/visible"), HasSubstr("5 x 7")));
  EXPECT_THAT(MessageAfter([](hid_t f) {
                Replace(f, "/visible", {5, 7}, H5T_IEEE_F32LE);
              }),
              HasSubstr("not of integers"));
}

TEST(MapFile, AbsurdSizesAreRefusedBeforeMemoryIsTaken) {
  EXPECT_THAT(MessageAfter([](hid_t f) {
                Replace(f, "/occupancy", {1000000, 1000, 1000}, H5T_IEEE_F32LE);
              }),
              HasSubstr("declares 4000000000000 bytes but stores only 0"));
  EXPECT_THAT(MessageAfter([](hid_t f) {
                Replace(f, "/occupancy", {1, hsize_t{1} << 62, 4}, H5T_IEEE_F32LE);
              }),
              HasSubstr("more than"));
}

TEST(MapFile, AbsurdNumbersAreRefused) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(MessageAfter([](hid_t f) { SetAttribute(f, "cell_m", -1); }),
              HasSubstr("cell_m is -1"));
  EXPECT_THAT(MessageAfter([](hid_t f) { SetAttribute(f, "min_x_m", kNan); }),
              HasSubstr("min_x_m"));
  EXPECT_THAT(MessageAfter([](hid_t f) { SetAttribute(f, "frames_per_second", kNan); }),
              HasSubstr("frames_per_second is nan"));
  EXPECT_THAT(MessageAfter([](hid_t f) {
                const hid_t dataset = H5Dopen2(f, "/occupancy", H5P_DEFAULT);
                std::vector<float> values(105, 0.5F);
                values[40] = std::nanf("");
                H5Dwrite(dataset, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
                H5Dclose(dataset);
              }),
              HasSubstr("/occupancy is nan in map 1 at cell 5"));
}

TEST(MapFile, PartsInOtherFilesAreRefused) {
  EXPECT_THAT(MessageAfter([](hid_t f) {
                H5Ldelete(f, "/visible", H5P_DEFAULT);
                H5Lcreate_external("/etc/passwd", "/x", f, "/visible", H5P_DEFAULT, H5P_DEFAULT);
              }),
              HasSubstr("no dataset /visible"));
}

TEST(MapFile, InconsistentMapsAreNotWritten) {
  const TemporaryFolder folder;
  const fs::path path = folder / "maps.h5";
  OccupancyMaps maps = SomeMaps(2);
  maps.values.pop_back();
  EXPECT_THAT(MessageOf(WriteMaps(path, maps)), HasSubstr("not whole maps"));
  maps = SomeMaps(2);
  maps.visible.clear();
  EXPECT_THAT(MessageOf(WriteMaps(path, maps)), HasSubstr("visible has 0 cells"));
  maps = SomeMaps(2);
  maps.values[0] = 1.5F;
  EXPECT_THAT(MessageOf(WriteMaps(path, maps)), HasSubstr("is 1.5 in map 0 at cell 0"));
  EXPECT_THAT(MessageOf(WriteMaps(path, {})), HasSubstr("no cells"));
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(MapFile, UnwritableOutputLeavesNothing) {
  EXPECT_THAT(MessageOf(WriteMaps("/proc/nowhere/maps.h5", SomeMaps(1))), HasSubstr("/proc/"));
  if (fs::exists("/dev/full")) {
    EXPECT_FALSE(WriteMaps("/dev/full/maps.h5", SomeMaps(1)));
  }
}

}  // namespace
}  // namespace vantage
