// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/mixture.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <opencv2/core.hpp>

#include "vantage/background/color.h"
#include "vantage/background/test_frames.h"
#include "vantage/base/test_support.h"

namespace vantage {
namespace {

using testing::Flat;
using testing::FlickeringFrames;
using ::testing::HasSubstr;
using testing::MessageOf;

/// One pixel's mixture step by step as the text has it: sorted anew in each step, N counted out.
/// Weights are compared as floats: under the modified rate the first ones are often equal but for
/// rounding.
class PlainMixture {
 public:
  explicit PlainMixture(const MixtureOptions& options) : o_(options) {}

  bool Step(const std::array<float, 3>& color) {
    const double rate =
        o_.rate == LearningRate::kModified ? std::max(o_.alpha, 1.0 / (1 + t_)) : o_.alpha;
    const auto alpha = static_cast<float>(rate);
    const auto initial = static_cast<float>(o_.sigma().initial * o_.sigma().initial);
    if (t_++ == 0) {
      all_.push_back({color, initial, 1});
      return true;
    }
    std::stable_sort(all_.begin(), all_.end(), [](const One& a, const One& b) {
      return static_cast<float>(a.weight * a.weight / a.variance) >
             static_cast<float>(b.weight * b.weight / b.variance);
    });
    std::ptrdiff_t n = 0;
    for (double sum = 0; static_cast<float>(sum) <= static_cast<float>(o_.background_share); ++n) {
      if (n == std::ssize(all_)) break;
      sum += all_[static_cast<std::size_t>(n)].weight;
    }
    const auto squared = [&](const One& g) {
      float sum = 0;
      for (std::size_t c = 0; c < 3; ++c) sum += (color[c] - g.mean[c]) * (color[c] - g.mean[c]);
      return sum;
    };
    const auto reach = static_cast<float>(o_.match_sigmas * o_.match_sigmas);
    const auto match = std::find_if(all_.begin(), all_.end(),
                                    [&](const One& g) { return squared(g) < reach * g.variance; });
    const bool background = match != all_.end() && match - all_.begin() < n;
    for (One& g : all_) g.weight = (1 - rate) * g.weight;
    if (match != all_.end()) {
      const float distance = squared(*match);
      match->weight += rate;
      for (std::size_t c = 0; c < 3; ++c) {
        match->mean[c] = (1 - alpha) * match->mean[c] + alpha * color[c];
      }
      match->variance = std::max((1 - alpha) * match->variance + alpha * distance,
                                 static_cast<float>(o_.sigma().min * o_.sigma().min));
      return background;
    }
    if (std::ssize(all_) == o_.gaussians) all_.pop_back();
    all_.push_back({color, initial, std::max(o_.initial_weight, rate)});
    double total = 0;
    for (const One& g : all_) total += g.weight;
    for (One& g : all_) g.weight /= total;
    return false;
  }

 private:
  struct One {
    std::array<float, 3> mean;
    float variance;
    double weight;
  };
  MixtureOptions o_;
  std::vector<One> all_;
  int t_ = 0;
};

struct Setting {
  ColorSpace color;
  LearningRate rate;
  int gaussians;
};

class MixtureReference : public ::testing::TestWithParam<Setting> {};

TEST_P(MixtureReference, MasksEqualThoseOfThePlainOne) {
  MixtureOptions options;
  options.color = GetParam().color;
  options.rate = GetParam().rate;
  options.gaussians = GetParam().gaussians;
  options.alpha = 0.03;
  const ImageSize size{31, 19};
  const std::vector<cv::Mat> frames = FlickeringFrames(size, 80, 7);
  auto model = MixtureModel::Create(size, options);
  ASSERT_TRUE(model) << MessageOf(model);
  std::vector<PlainMixture> plain(31 * 19, PlainMixture(options));
  int different = 0;
  int foreground = 0;
  cv::Mat mask;
  for (const cv::Mat& frame : frames) {
    std::vector<float> colors(31 * 19 * 3);
    const bool luv = options.color == ColorSpace::kLuv;
    (luv ? LuvFromBgr : FloatFromBgr)(frame.data, colors.data(), 31 * 19);
    ASSERT_TRUE(model->Apply(frame, mask, 1));
    for (int i = 0; i < size.width * size.height; ++i) {
      const float* color = &colors[static_cast<std::size_t>(3 * i)];
      const bool background =
          plain[static_cast<std::size_t>(i)].Step({color[0], color[1], color[2]});
      foreground += background ? 0 : 1;
      different += background != (mask.data[i] == 0) ? 1 : 0;
    }
  }
  EXPECT_GT(foreground, 1000);
  EXPECT_EQ(different, 0);
}

INSTANTIATE_TEST_SUITE_P(Settings, MixtureReference,
                         ::testing::Values(Setting{ColorSpace::kLuv, LearningRate::kModified, 3},
                                           Setting{ColorSpace::kLuv, LearningRate::kOriginal, 3},
                                           Setting{ColorSpace::kRgb, LearningRate::kModified, 3},
                                           Setting{ColorSpace::kRgb, LearningRate::kOriginal, 3},
                                           Setting{ColorSpace::kRgb, LearningRate::kOriginal, 1},
                                           Setting{ColorSpace::kLuv, LearningRate::kModified, 8}));

TEST(Mixture, ThreadCountDoesNotChangeABit) {
  const ImageSize size{45, 67};
  const std::vector<cv::Mat> frames = FlickeringFrames(size, 30, 3);
  std::vector<cv::Mat> masks, backgrounds;
  for (const int threads : {1, 2, 5}) {
    auto model = MixtureModel::Create(size, {});
    ASSERT_TRUE(model);
    cv::Mat all, mask;
    for (const cv::Mat& frame : frames) {
      ASSERT_TRUE(model->Apply(frame, mask, threads));
      all.push_back(mask);
    }
    masks.push_back(all);
    backgrounds.push_back(model->BackgroundImage());
  }
  for (std::size_t i = 1; i < masks.size(); ++i) {
    EXPECT_EQ(cv::norm(masks[0], masks[i], cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(backgrounds[0], backgrounds[i], cv::NORM_INF), 0);
  }
}

TEST(Mixture, WhatStopsIsAbsorbedWhenAlphaSays) {
  MixtureOptions options;
  options.rate = LearningRate::kOriginal;
  options.alpha = 0.02;
  auto model = MixtureModel::Create({1, 1}, options);
  ASSERT_TRUE(model);
  cv::Mat mask;
  for (int t = 0; t < 300; ++t) ASSERT_TRUE(model->Apply(Flat({1, 1}, {90, 90, 90}), mask, 1));
  // The floor's weight, 1, falls to (1 - alpha) / (1 - alpha + initial weight) when the new
  // Gaussian enters, then by 1 - alpha a frame; at T the newcomer counts as background.
  const double entered = 0.98 / (0.98 + options.initial_weight);
  const int expected = 1 + static_cast<int>(std::ceil(std::log(options.background_share / entered) /
                                                      std::log(1 - options.alpha)));
  int foreground = 0;
  for (mask = 255; mask.data[0] == 255 || foreground == 0;) {
    ASSERT_TRUE(model->Apply(Flat({1, 1}, {200, 180, 90}), mask, 1));
    if (mask.data[0] == 255) ++foreground;
    ASSERT_LT(foreground, 100);
  }
  EXPECT_EQ(foreground, expected);
}

TEST(Mixture, ASlowRateStillLearns) {
  MixtureOptions options;
  options.color = ColorSpace::kRgb;
  options.rate = LearningRate::kOriginal;
  options.alpha = 0.0005;
  auto model = MixtureModel::Create({1, 1}, options);
  ASSERT_TRUE(model);
  cv::Mat mask;
  ASSERT_TRUE(model->Apply(Flat({1, 1}, cv::Scalar::all(100)), mask, 1));
  for (int t = 0; t < 3000; ++t) {
    ASSERT_TRUE(model->Apply(Flat({1, 1}, cv::Scalar::all(110)), mask, 1));
  }
  EXPECT_EQ(model->BackgroundImage().data[0], 108);  // 110 - 10 exp(-1.5)
  for (int t = 0; t < 30000; ++t) {
    ASSERT_TRUE(model->Apply(Flat({1, 1}, cv::Scalar::all(110)), mask, 1));
  }
  EXPECT_EQ(model->BackgroundImage().data[0], 110);
  int foreground = 0;
  for (mask = 255; mask.data[0] == 255 && foreground < 2000; ++foreground) {
    ASSERT_TRUE(model->Apply(Flat({1, 1}, {200, 180, 90}), mask, 1));
  }
  EXPECT_NEAR(foreground, std::log(0.5 * 1.05) / std::log(1 - 0.0005), 3);
}

TEST(Mixture, ModifiedRateAveragesTheFirstFramesAndOriginalDoesNot) {
  MixtureOptions options;
  options.color = ColorSpace::kRgb;
  for (const LearningRate rate : {LearningRate::kModified, LearningRate::kOriginal}) {
    options.rate = rate;
    auto model = MixtureModel::Create({1, 1}, options);
    ASSERT_TRUE(model);
    cv::Mat mask;
    for (const int level : {100, 120, 120, 120}) {
      ASSERT_TRUE(model->Apply(Flat({1, 1}, cv::Scalar::all(level)), mask, 1));
    }
    // Means 115, and 100 moved towards 120 by 0.005 three times.
    EXPECT_EQ(model->BackgroundImage().data[0], rate == LearningRate::kModified ? 115 : 100);
  }
}

TEST(Mixture, BackgroundImageIsTheCommonColour) {
  for (const ColorSpace color : {ColorSpace::kLuv, ColorSpace::kRgb}) {
    MixtureOptions options;
    options.color = color;
    auto model = MixtureModel::Create({4, 3}, options);
    ASSERT_TRUE(model);
    EXPECT_EQ(cv::norm(model->BackgroundImage(), cv::NORM_INF), 0);
    cv::Mat mask;
    for (int t = 0; t < 60; ++t) {
      const cv::Scalar bgr = t % 5 == 4 ? cv::Scalar(250, 10, 200) : cv::Scalar(30, 140, 77);
      ASSERT_TRUE(model->Apply(Flat({4, 3}, bgr), mask, 1));
    }
    EXPECT_EQ(cv::norm(model->BackgroundImage(), Flat({4, 3}, {30, 140, 77}), cv::NORM_INF), 0);
    EXPECT_EQ(model->BackgroundImage({2, 1, 9, 9}).size(), cv::Size(2, 2));
  }
}

TEST(Mixture, AbsorbedPixelsAreBackgroundInTheNextFrame) {
  const ImageSize size{40, 30};
  for (const double share : {0.3, 0.7, 0.95}) {
    for (const ColorSpace color : {ColorSpace::kLuv, ColorSpace::kRgb}) {
      MixtureOptions options;
      options.color = color;
      options.background_share = share;
      options.absorb_weight = std::max(1 / share - 1, 0.01);  // the least that is allowed
      auto model = MixtureModel::Create(size, options);
      ASSERT_TRUE(model) << MessageOf(model);
      const std::vector<cv::Mat> frames = FlickeringFrames(size, 41, 11);
      cv::Mat mask;
      for (const cv::Mat& frame : frames) ASSERT_TRUE(model->Apply(frame, mask, 1));
      ASSERT_GT(cv::countNonZero(mask), 20);
      cv::Mat left = mask.clone();
      left.colRange(20, 40) = 0;
      ASSERT_TRUE(model->Absorb(left));
      cv::Mat next;
      ASSERT_TRUE(model->Apply(frames.back(), next, 1));
      EXPECT_EQ(cv::countNonZero(next & left), 0);
      if (share == 0.7) {
        EXPECT_GT(cv::countNonZero(next.colRange(20, 40)), 5) << "others stay";
      }
    }
  }
}

TEST(Mixture, RefusesWrongFramesAndStaysAsItWas) {
  auto model = MixtureModel::Create({8, 6}, {});
  ASSERT_TRUE(model);
  cv::Mat mask;
  EXPECT_EQ(MessageOf(model->Apply(cv::Mat(), mask, 1)), "background: frame 0 is empty");
  ASSERT_TRUE(model->Apply(Flat({8, 6}, {1, 2, 3}), mask, 1));
  EXPECT_EQ(MessageOf(model->Apply(Flat({8, 7}, {1, 2, 3}), mask, 1)),
            "background: frame 1 is 8x7 px of type CV_8UC3; it must be 8x6 px of 8-bit BGR "
            "(CV_8UC3)");
  for (const int type : {CV_8UC1, CV_8UC4, CV_16UC3, CV_32FC3}) {
    EXPECT_THAT(MessageOf(model->Apply(cv::Mat(6, 8, type), mask, 1)), HasSubstr("8-bit BGR"));
  }
  EXPECT_EQ(model->frames(), 1);
  EXPECT_THAT(MessageOf(model->Absorb(cv::Mat(6, 7, CV_8UC1))), HasSubstr("8x6 px"));
  for (const cv::Mat& held : {cv::Mat(6, 7, CV_8UC1), cv::Mat(6, 8, CV_8UC3)}) {
    EXPECT_THAT(MessageOf(model->Apply(Flat({8, 6}, {1, 2, 3}), mask, 1, held)),
                HasSubstr("the held pixels are"));
  }
  EXPECT_EQ(model->frames(), 1);
}

TEST(Mixture, TakesViewsOfLargerPicturesAndItsOwnFrameAsMask) {
  auto model = MixtureModel::Create({5, 4}, {});
  ASSERT_TRUE(model);
  cv::Mat large = Flat({9, 9}, {10, 200, 30});
  cv::Mat mask;
  ASSERT_TRUE(model->Apply(large({2, 3, 5, 4}), mask, 1));
  cv::Mat same = Flat({5, 4}, {10, 200, 30});
  ASSERT_TRUE(model->Apply(same, same, 2));
  EXPECT_EQ(same.type(), CV_8UC1);
  EXPECT_EQ(cv::countNonZero(same), 0);
}

TEST(Mixture, OptionsAreChecked) {
  const auto message = [](auto change) {
    MixtureOptions options;
    change(options);
    return MessageOf(MixtureModel::Create({4, 4}, options));
  };
  EXPECT_EQ(message([](MixtureOptions&) {}), "");
  EXPECT_EQ(message([](MixtureOptions& o) { o.gaussians = 9; }),
            "background.gaussians is 9; it must be between 1 and 8");
  EXPECT_EQ(message([](MixtureOptions& o) { o.alpha = 0; }),
            "background.alpha is 0; it must be above 0 and at most 1");
  EXPECT_EQ(message([](MixtureOptions& o) { o.absorb_weight = 0.2; }),
            "background.absorb_weight is 0.2; it must be at least 1 / background_share - 1 = 1");
  EXPECT_EQ(message([](MixtureOptions& o) { o.luv.initial = 1; }),
            "background.luv_initial_sigma is 1; it must be at least luv_min_sigma = 5");
  EXPECT_THAT(message([](MixtureOptions& o) { o.match_sigmas = std::nan(""); }),
              HasSubstr("match_sigmas is nan"));
  EXPECT_EQ(MessageOf(MixtureModel::Create({0, 5}, {})),
            "background: frames of 0x5 px; each side must be between 1 and 16384 px");
  EXPECT_THAT(MessageOf(MixtureModel::Create({5, std::numeric_limits<int>::max()}, {})),
              HasSubstr("each side"));
}

}  // namespace
}  // namespace vantage
