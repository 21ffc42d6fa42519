// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/map_reader.h"

#include <gmock/gmock.h>
#include <hdf5.h>

#include <array>
#include <fstream>
#include <random>

#include "vantage/base/file.h"
#include "vantage/base/test_support.h"
#include "vantage/occupancy/map_file.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::MessageOf;
using testing::TemporaryFolder;

OccupancyMaps SomeMaps(int frames) {
  OccupancyMaps maps;
  maps.grid = {-3.25, 2.5, 0.3, 9, 6};
  maps.first_frame = 41;
  maps.frames_per_second = 6.97;
  maps.in_area.assign(54, 1);
  maps.visible.assign(54, 1);
  std::mt19937 random(3);
  for (int i = 0; i < frames * 54; ++i) {
    maps.values.push_back(std::uniform_real_distribution<float>(0, 1)(random));
  }
  return maps;
}

/// The maps' values stored anew, in chunks of the given size.
void StoreInChunks(const fs::path& path, const OccupancyMaps& maps,
                   const std::array<hsize_t, 3>& chunk) {
  ASSERT_TRUE(WriteMaps(path, maps));
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t ours = H5Dopen2(file, "/occupancy", H5P_DEFAULT);
  const hid_t space = H5Dget_space(ours);
  const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_chunk(layout, 3, chunk.data());
  H5Pset_deflate(layout, 4);
  const hid_t theirs =
      H5Dcreate2(file, "/new", H5T_IEEE_F64LE, space, H5P_DEFAULT, layout, H5P_DEFAULT);
  H5Dwrite(theirs, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, maps.values.data());
  for (const char* name : {"min_x_m", "min_y_m", "cell_m", "frames_per_second"}) {
    const hid_t from = H5Aopen(ours, name, H5P_DEFAULT);
    double value = 0;
    H5Aread(from, H5T_NATIVE_DOUBLE, &value);
    const hid_t scalar = H5Screate(H5S_SCALAR);
    const hid_t to = H5Acreate2(theirs, name, H5T_NATIVE_DOUBLE, scalar, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(to, H5T_NATIVE_DOUBLE, &value);
    H5Aclose(to);
    H5Sclose(scalar);
    H5Aclose(from);
  }
  const hid_t scalar = H5Screate(H5S_SCALAR);
  const hid_t first =
      H5Acreate2(theirs, "first_frame", H5T_NATIVE_INT64, scalar, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(first, H5T_NATIVE_INT64, &maps.first_frame);
  H5Aclose(first);
  H5Sclose(scalar);
  H5Dclose(theirs);
  H5Pclose(layout);
  H5Sclose(space);
  H5Dclose(ours);
  H5Ldelete(file, "/occupancy", H5P_DEFAULT);
  H5Lmove(file, "/new", file, "/occupancy", H5P_DEFAULT, H5P_DEFAULT);
  H5Fclose(file);
}

TEST(MapReader, PiecesAreThoseOfTheWhole) {
  const TemporaryFolder folder;
  const OccupancyMaps maps = SomeMaps(23);
  ASSERT_TRUE(WriteMaps(folder / "ours.h5", maps));
  // Chunks of several maps, and maps of several chunks.
  StoreInChunks(folder / "theirs.h5", maps, {5, 4, 4});
  for (const char* name : {"ours.h5", "theirs.h5"}) {
    const auto reader = MapReader::Open(folder / name);
    ASSERT_TRUE(reader) << MessageOf(reader);
    EXPECT_EQ(reader->frame_count(), 23);
    const OccupancyMaps& header = reader->header();
    EXPECT_EQ(header.grid, maps.grid);
    EXPECT_EQ(header.first_frame, 41);
    EXPECT_EQ(header.frames_per_second, 6.97);
    EXPECT_EQ(header.in_area, maps.in_area);
    EXPECT_TRUE(header.values.empty());
    std::vector<float> map(54);
    for (const std::int64_t frame : {0, 1, 22, 7, 6}) {
      ASSERT_TRUE(reader->Read(frame, map));
      EXPECT_TRUE(std::ranges::equal(map, maps.Frame(frame))) << name << frame;
    }
    std::vector<float> three(3 * 54);
    ASSERT_TRUE(reader->Read(9, three));
    EXPECT_TRUE(std::ranges::equal(three, std::span(maps.values).subspan(9 * 54, 3 * 54)));
    EXPECT_TRUE(reader->Read(23, {}));
  }
}

TEST(MapReader, RefusesWhatTheFileDoesNotHave) {
  const TemporaryFolder folder;
  ASSERT_TRUE(WriteMaps(folder / "maps.h5", SomeMaps(3)));
  const auto reader = MapReader::Open(folder / "maps.h5");
  ASSERT_TRUE(reader);
  std::vector<float> map(54);
  for (const std::int64_t frame : {std::int64_t{-1}, std::int64_t{3}, std::int64_t{1} << 62}) {
    EXPECT_THAT(MessageOf(reader->Read(frame, map)), HasSubstr("the file has 3 maps of 54 cells"));
  }
  map.pop_back();
  EXPECT_THAT(MessageOf(reader->Read(0, map)), HasSubstr("53 values"));
}

TEST(MapReader, NamesTheMapWhoseValuesAreWrong) {
  const TemporaryFolder folder;
  ASSERT_TRUE(WriteMaps(folder / "maps.h5", SomeMaps(6)));
  const hid_t file = H5Fopen((folder / "maps.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t dataset = H5Dopen2(file, "/occupancy", H5P_DEFAULT);
  std::vector<float> values = SomeMaps(6).values;
  values[4 * 54 + 7] = 2;
  H5Dwrite(dataset, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Dclose(dataset);
  H5Fclose(file);
  const auto reader = MapReader::Open(folder / "maps.h5");
  ASSERT_TRUE(reader) << MessageOf(reader);
  std::vector<float> map(54);
  EXPECT_TRUE(reader->Read(3, map));
  EXPECT_THAT(MessageOf(reader->Read(4, map)),
              HasSubstr("maps.h5: /occupancy is 2 in map 4 at cell 7"));
  EXPECT_TRUE(reader->Read(5, map)) << "the reader is as good as before";
}

TEST(MapReader, DamagedPiecesAreErrors) {
  const TemporaryFolder folder;
  const fs::path path = folder / "maps.h5";
  ASSERT_TRUE(WriteMaps(path, SomeMaps(40)));
  const std::string bytes = *ReadTextFile(path);
  // All chunks overwritten, some or all of the structure kept.
  int opened = 0;
  for (std::size_t from = bytes.size() / 8; from < bytes.size(); from += bytes.size() / 16) {
    std::string damaged = bytes;
    for (std::size_t i = from; i < from + bytes.size() / 4 && i < bytes.size(); ++i) {
      damaged[i] = static_cast<char>(damaged[i] ^ 0x5a);
    }
    ASSERT_TRUE(WriteTextFile(path, damaged));
    const auto reader = MapReader::Open(path);
    if (!reader) continue;
    ++opened;
    int refused = 0;
    std::vector<float> map(54);
    for (std::int64_t frame = 0; frame < reader->frame_count(); ++frame) {
      refused += !reader->Read(frame, map);
    }
    EXPECT_GT(refused, 0) << from;
  }
  EXPECT_GT(opened, 0);
}

TEST(MapReader, MovesLikeAValue) {
  const TemporaryFolder folder;
  ASSERT_TRUE(WriteMaps(folder / "a.h5", SomeMaps(2)));
  ASSERT_TRUE(WriteMaps(folder / "b.h5", SomeMaps(5)));
  auto a = MapReader::Open(folder / "a.h5");
  auto b = MapReader::Open(folder / "b.h5");
  ASSERT_TRUE(a && b);
  *a = std::move(*b);
  const MapReader last = std::move(*a);
  EXPECT_EQ(last.frame_count(), 5);
  std::vector<float> map(54);
  EXPECT_TRUE(last.Read(4, map));
}

}  // namespace
}  // namespace vantage
