// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/mixture_kernel.h"

#include <gmock/gmock.h>
#include <hwy/highway.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "vantage/background/mixture.h"
#include "vantage/background/mixture_oracle.h"
#include "vantage/base/test_support.h"
#include "vantage/video/open.h"

namespace vantage {
namespace {

using testing::MessageOf;
using testing::PlainMixtureModel;

/// From Debian's package opencv-doc: PETS 2009 S2.L1 View_001, 768x576.
constexpr const char* kVideo = "/usr/share/doc/opencv-doc/examples/data/vtest.avi";

/// Every instruction set that this machine has, one after the other; the best again at the end.
class EachTarget {
 public:
  explicit EachTarget() : targets_(hwy::SupportedAndGeneratedTargets()) {}
  ~EachTarget() { Use(0); }
  EachTarget(const EachTarget&) = delete;
  EachTarget& operator=(const EachTarget&) = delete;
  std::size_t size() const { return targets_.size(); }
  void Choose(std::size_t i) { Use(targets_[i]); }
  void ChooseBest() { Use(0); }

 private:
  static void Use(std::int64_t targets) {
    hwy::SetSupportedTargetsForTest(targets);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
  std::vector<std::int64_t> targets_;
};

bool Same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

TEST(MixtureKernel, EveryTargetCanBeChosen) {
  EachTarget targets;
  std::set<std::string> names;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    targets.Choose(i);
    names.insert(MixtureInstructionSet());
  }
  EXPECT_EQ(names.size(), targets.size());
  EXPECT_GE(names.size(), 2U);
}

/// One instruction set's model of a part of the frames, placed so that its blocks of 16 pixels are
/// other ones than those of the whole.
struct PartModel {
  cv::Rect part;
  MixtureModel model;
};

class MixtureOnVideo : public ::testing::TestWithParam<ColorSpace> {};

TEST_P(MixtureOnVideo, EveryTargetGivesTheMasksOfThePlainModel) {
  if (!std::filesystem::exists(kVideo)) GTEST_SKIP() << "vtest.avi of opencv-doc is not here";
  constexpr int kFrames = 300;
  const auto source = OpenVideo(kVideo);
  ASSERT_TRUE(source) << MessageOf(source);
  MixtureOptions options;
  options.color = GetParam();
  const ImageSize size{768, 576};
  PlainMixtureModel plain(size, options);
  MixtureModel model = MixtureModel::Create(size, options).value();
  MixtureModel threaded = MixtureModel::Create(size, options).value();
  EachTarget targets;
  std::vector<PartModel> parts;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const cv::Rect part(250 + static_cast<int>(i), 150, 211, 160);
    parts.push_back({part, MixtureModel::Create({part.width, part.height}, options).value()});
  }
  cv::Mat frame, mask, expected, other;
  double worst = 0;
  double total = 0;
  for (int t = 0; t < kFrames; ++t) {
    ASSERT_TRUE((*source)->Read(frame).value_or(false));
    targets.ChooseBest();
    ASSERT_TRUE(model.Apply(frame, mask, 1));
    ASSERT_TRUE(threaded.Apply(frame, other, 2));
    ASSERT_TRUE(Same(mask, other)) << t;
    plain.Apply(frame, expected);
    const double foreground = std::max(1.0, 1.0 * cv::countNonZero(expected));
    const double share = cv::countNonZero(mask != expected) / foreground;
    worst = std::max(worst, share);
    total += foreground;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      targets.Choose(i);
      ASSERT_TRUE(parts[i].model.Apply(frame(parts[i].part), other, 1));
      ASSERT_TRUE(Same(mask(parts[i].part), other)) << t << " " << MixtureInstructionSet();
    }
  }
  EXPECT_GT(total / kFrames, 3000) << "people walk there";
  RecordProperty("worst_difference", std::to_string(worst));
  EXPECT_LE(worst, 0.005);

  for (std::size_t i = 0; i < parts.size(); ++i) {
    EXPECT_TRUE(Same(model.BackgroundImage(parts[i].part), parts[i].model.BackgroundImage()));
  }
}

INSTANTIATE_TEST_SUITE_P(Colors, MixtureOnVideo,
                         ::testing::Values(ColorSpace::kLuv, ColorSpace::kRgb));

}  // namespace
}  // namespace vantage
