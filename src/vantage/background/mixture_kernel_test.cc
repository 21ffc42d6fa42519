// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/mixture_kernel.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "vantage/background/color.h"
#include "vantage/background/mixture.h"
#include "vantage/background/mixture_oracle.h"
#include "vantage/background/test_frames.h"
#include "vantage/background/test_targets.h"
#include "vantage/base/test_support.h"
#include "vantage/video/open.h"

namespace vantage {
namespace {

using testing::FlickeringFrames;
using testing::HighwayTargets;
using testing::MessageOf;
using testing::PlainMixtureModel;

/// From Debian's package opencv-doc: PETS 2009 S2.L1 View_001, 768x576.
constexpr const char* kVideo = "/usr/share/doc/opencv-doc/examples/data/vtest.avi";

bool Same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

TEST(MixtureKernel, EveryTargetCanBeChosen) {
  HighwayTargets targets;
  std::set<std::string> names;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    targets.Choose(i);
    names.insert(MixtureInstructionSet());
  }
  EXPECT_EQ(names.size(), targets.size());
  EXPECT_GE(names.size(), 2U);
}

TEST(MixtureKernel, MeansBecomeTheLevelsTheyCameFromOnEveryTarget) {
  constexpr int kPixels = GaussianBlock::kPixels;
  HighwayTargets targets;
  for (int b = 0; b < 256; b += 3) {
    for (int g = 0; g < 256; g += 5) {
      for (int r = 0; r < 256; r += kPixels) {
        std::vector<std::uint8_t> bgr;
        for (int i = 0; i < kPixels; ++i) {
          for (const int level : {b, g, r + i}) bgr.push_back(static_cast<std::uint8_t>(level));
        }
        for (const bool luv : {true, false}) {
          std::vector<float> colors(3 * kPixels);
          (luv ? LuvFromBgr : FloatFromBgr)(bgr.data(), colors.data(), kPixels);
          GaussianBlock block = {};
          for (int i = 0; i < kPixels; ++i) {
            for (int c = 0; c < 3; ++c) {
              block.mean(i)[c * kPixels] = colors[static_cast<std::size_t>(3 * i + c)];
            }
          }
          std::vector<std::uint8_t> back(3 * kPixels);
          targets.Choose(static_cast<std::size_t>(b + g + r) % targets.size());
          MeansAsBgr(block, luv, back.data());
          ASSERT_EQ(bgr, back);
        }
      }
    }
  }
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
  HighwayTargets targets;
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

cv::Mat RandomPixels(ImageSize size, unsigned percent, std::mt19937& random) {
  cv::Mat pixels(size.height, size.width, CV_8UC1);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      pixels.ptr(y)[x] = static_cast<uchar>(random() % 100 < percent ? 1 + random() % 255 : 0);
    }
  }
  return pixels;
}

TEST(MixtureKernel, AnySizeAndOptionsGiveTheSameBitsOnEveryTargetAndThePlainMasks) {
  const std::vector<ImageSize> sizes = {{1, 1},  {17, 3},  {16, 9},  {15, 2},
                                        {33, 8}, {130, 4}, {129, 1}, {5, 21}};
  const std::vector<double> alphas = {0.005, 0.03, 0.5, 1, 0.01, 0.002, 0.2, 0.03};
  std::mt19937 random(5);
  HighwayTargets targets;
  int different = 0;
  int foreground = 0;
  for (int k = 1; k <= 8; ++k) {
    const ImageSize size = sizes[static_cast<std::size_t>(k - 1)];
    MixtureOptions options;
    options.gaussians = k;
    options.color = k % 2 == 0 ? ColorSpace::kLuv : ColorSpace::kRgb;
    options.rate = k % 4 < 2 ? LearningRate::kModified : LearningRate::kOriginal;
    options.alpha = alphas[static_cast<std::size_t>(k - 1)];
    PlainMixtureModel plain(size, options);
    std::vector<MixtureModel> models;
    for (std::size_t i = 0; i <= targets.size(); ++i) {
      models.push_back(MixtureModel::Create(size, options).value());
    }
    cv::Mat expected, mask, other;
    int t = 0;
    for (const cv::Mat& frame : FlickeringFrames(size, 120, static_cast<unsigned>(k))) {
      const cv::Mat held = t % 3 == 0 ? cv::Mat() : RandomPixels(size, 40, random);
      const cv::Mat ghosts = RandomPixels(size, t % 10 == 9 ? 20 : 0, random);
      plain.Apply(frame, expected, held);
      plain.Absorb(ghosts);
      for (std::size_t i = 0; i < models.size(); ++i) {  // the last: the best target, 2 threads
        if (i < targets.size()) {
          targets.Choose(i);
        } else {
          targets.ChooseBest();
        }
        const int threads = i < targets.size() ? 1 : 2;
        ASSERT_TRUE(models[i].Apply(frame, i == 0 ? mask : other, threads, held));
        ASSERT_TRUE(models[i].Absorb(ghosts));
        if (i == 0) continue;
        ASSERT_TRUE(Same(mask, other)) << "K = " << k << ", frame " << t;
      }
      different += cv::countNonZero(mask != expected);
      foreground += cv::countNonZero(expected);
      ++t;
    }
    for (const MixtureModel& model : models) {
      EXPECT_TRUE(Same(models[0].BackgroundImage(), model.BackgroundImage())) << k;
    }
    EXPECT_LE(cv::norm(plain.BackgroundImage(), models[0].BackgroundImage(), cv::NORM_INF), 1) << k;
  }
  EXPECT_GT(foreground, 5000);
  EXPECT_LE(different, 0.005 * foreground);
}

INSTANTIATE_TEST_SUITE_P(Colors, MixtureOnVideo,
                         ::testing::Values(ColorSpace::kLuv, ColorSpace::kRgb));

}  // namespace
}  // namespace vantage
