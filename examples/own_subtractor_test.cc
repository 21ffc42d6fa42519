// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "vantage/background/test_scene.h"
#include "vantage/base/file.h"
#include "vantage/base/test_support.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using testing::LeavingPerson;
using testing::TemporaryFolder;

/// Runs the example as a user does; its exit status.
int RunExample(const std::filesystem::path& input, const TemporaryFolder& folder) {
  const std::string command =
      fmt::format("'{}' '{}' >'{}' 2>'{}'", VANTAGE_OWN_SUBTRACTOR, input.string(),
                  (folder / "out").string(), (folder / "err").string());
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

struct Line {
  int foreground_px, ghosts_px;
};

TEST(OwnSubtractor, ItsGhostsGoAndThePersonStays) {
  const TemporaryFolder folder;
  const LeavingPerson scene;
  const std::filesystem::path input = folder / "input";
  std::filesystem::create_directory(input);
  constexpr int kFrames = 75;
  for (int t = 0; t < kFrames; ++t) {
    const std::string name = (input / fmt::format("{:06}.png", t)).string();
    ASSERT_TRUE(cv::imwrite(name, scene.FrameAt(t)));
  }
  ASSERT_EQ(RunExample(input, folder), 0) << ReadTextFile(folder / "err").value_or("");
  std::ifstream out(folder / "out");
  std::vector<Line> lines;
  for (Line line{}; out >> line.foreground_px >> line.ghosts_px;) lines.push_back(line);
  ASSERT_EQ(lines.size(), kFrames);

  const int person_px = LeavingPerson::kStart.area();
  EXPECT_LT(lines[20].foreground_px, 0.05 * person_px) << "standing there from the first frame";
  EXPECT_GT(lines[26].foreground_px, 1.9 * person_px) << "person and ghost";
  int ghosts_px = 0;
  for (const Line& line : lines) ghosts_px += line.ghosts_px;
  EXPECT_NEAR(ghosts_px, person_px, 0.1 * person_px);
  for (int t = 45; t < kFrames; ++t) {
    EXPECT_NEAR(lines[static_cast<std::size_t>(t)].foreground_px, person_px, 0.1 * person_px) << t;
  }
}

TEST(OwnSubtractor, SaysWhatIsWrongWithItsInput) {
  const TemporaryFolder folder;
  EXPECT_EQ(RunExample(folder / "nothing", folder), 1);
  EXPECT_THAT(ReadTextFile(folder / "err").value_or(""), HasSubstr("nothing"));
}

}  // namespace
}  // namespace vantage
