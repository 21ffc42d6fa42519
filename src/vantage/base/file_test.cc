// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/base/file.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>

#include "vantage/base/test_support.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using testing::MessageOf;
using testing::TemporaryFolder;

std::ptrdiff_t EntriesIn(const std::filesystem::path& folder) {
  return std::distance(std::filesystem::directory_iterator(folder), {});
}

TEST(IsInside, ByPlaceNotByName) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "a/b");
  std::filesystem::create_directory_symlink(folder / "a", folder / "link");
  EXPECT_TRUE(IsInside(folder / "a/b", folder / "a"));
  EXPECT_TRUE(IsInside(folder / "a", folder / "a/"));
  EXPECT_TRUE(IsInside(folder / "link/b", folder / "a"));
  EXPECT_TRUE(IsInside(folder / "a/none", folder / "a"));
  EXPECT_FALSE(IsInside(folder / "a", folder / "a/b"));
  EXPECT_FALSE(IsInside(folder / "ab", folder / "a"));
  EXPECT_FALSE(IsInside(folder / "a/../c", folder / "a"));
}

TEST(File, TextComesBackAsWritten) {
  const TemporaryFolder folder;
  const auto path = folder / "a/b/text.csv";
  ASSERT_TRUE(WriteTextFile(path, "one\ntwo\n"));
  EXPECT_EQ(ReadTextFile(path).value(), "one\ntwo\n");
  ASSERT_TRUE(WriteTextFile(path, "three"));
  EXPECT_EQ(ReadTextFile(path).value(), "three");
  EXPECT_EQ(EntriesIn(folder / "a/b"), 1) << "no temporary stays behind";
}

TEST(File, ReadErrorsNameTheFile) {
  const TemporaryFolder folder;
  EXPECT_THAT(MessageOf(ReadTextFile(folder / "absent")), HasSubstr("absent: no such file"));
  EXPECT_THAT(MessageOf(ReadTextFile(folder.path())), HasSubstr("is a folder"));
  EXPECT_THAT(MessageOf(ReadTextFile("/dev/zero")), HasSubstr("a regular file is needed"));
  ASSERT_TRUE(WriteTextFile(folder / "long", std::string(100, 'x')));
  EXPECT_THAT(MessageOf(ReadTextFile(folder / "long", 99)), HasSubstr("larger than 99 bytes"));
}

TEST(File, FullDiskLeavesNothing) {
  std::error_code code;
  if (!std::filesystem::exists("/dev/full", code)) GTEST_SKIP() << "no /dev/full here";
  EXPECT_THAT(MessageOf(WriteTextFile("/dev/full/x", "text")), HasSubstr("folder"));
}

TEST(File, Sha256MatchesThePublishedVector) {
  const TemporaryFolder folder;
  ASSERT_TRUE(WriteTextFile(folder / "abc", "abc"));  // FIPS 180-2, appendix B.1
  EXPECT_EQ(Sha256OfFile(folder / "abc").value(),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(StagedFile, WithoutCommitTheFinalNameNeverAppears) {
  const TemporaryFolder folder;
  {
    auto staged = StagedFile::Create(folder / "out.mp4");
    ASSERT_TRUE(staged);
    EXPECT_EQ(staged->temporary().extension(), ".mp4");
    std::ofstream(staged->temporary()) << "half";
    EXPECT_EQ(EntriesIn(folder.path()), 1);
  }
  EXPECT_EQ(EntriesIn(folder.path()), 0);
}

TEST(StagedFile, CommitOfNothingWrittenFails) {
  const TemporaryFolder folder;
  auto staged = StagedFile::Create(folder / "out.mp4");
  ASSERT_TRUE(staged);
  EXPECT_FALSE(staged->Commit());
}

TEST(StagedDirectory, KeepsEarlierFilesUnlessAskedToReplace) {
  const TemporaryFolder folder;
  ASSERT_TRUE(WriteTextFile(folder / "masks/old.png", "old"));
  EXPECT_THAT(MessageOf(StagedDirectory::Create(folder / "masks", false)),
              HasSubstr("already holds files"));
  {
    auto abandoned = StagedDirectory::Create(folder / "masks", true);
    ASSERT_TRUE(abandoned);
  }
  EXPECT_TRUE(std::filesystem::exists(folder / "masks/old.png"));
  auto staged = StagedDirectory::Create(folder / "masks", true);
  ASSERT_TRUE(staged);
  std::ofstream(staged->temporary() / "new.png") << "new";
  ASSERT_TRUE(staged->Commit());
  EXPECT_TRUE(std::filesystem::exists(folder / "masks/new.png"));
  EXPECT_FALSE(std::filesystem::exists(folder / "masks/old.png"));
  EXPECT_EQ(EntriesIn(folder.path()), 1);
}

TEST(StagedDirectory, NameMayEndInASlash) {
  const TemporaryFolder folder;
  for (const bool replace : {false, true}) {
    auto staged = StagedDirectory::Create(folder / "masks/", replace);
    ASSERT_TRUE(staged) << MessageOf(staged);
    std::ofstream(staged->temporary() / "new.png") << "new";
    const Status committed = staged->Commit();
    EXPECT_TRUE(committed) << MessageOf(committed);
    EXPECT_EQ(EntriesIn(folder / "masks"), 1);
    EXPECT_EQ(EntriesIn(folder.path()), 1);
  }
}

}  // namespace
}  // namespace vantage
