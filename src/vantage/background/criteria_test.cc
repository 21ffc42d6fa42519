// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/criteria.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "vantage/background/edges.h"
#include "vantage/base/test_support.h"

namespace vantage {
namespace {

using testing::MessageOf;

constexpr GhostCriterion kRules[] = {GhostCriterion::kFep, GhostCriterion::kFer,
                                     GhostCriterion::kNb, GhostCriterion::kEpd,
                                     GhostCriterion::kCb};
const cv::Size kSize(32, 20);
const cv::Scalar kDark = cv::Scalar::all(20);
const cv::Scalar kBright = cv::Scalar::all(120);

double ValueOf(GhostCriterion criterion, const cv::Mat& bgr, const cv::Mat& background,
               const BorderRegions& border) {
  return CriterionValue(bgr, background, border, {.criterion = criterion});
}

/// Stripes: every column where the level changes has one edge pixel a row, just left of it.
cv::Mat Stripes(const std::vector<int>& columns) {
  cv::Mat picture(kSize, CV_8UC3, kDark);
  bool bright = false;
  for (const int column : columns) {
    bright = !bright;
    picture.colRange(column, kSize.width) = bright ? kBright : kDark;
  }
  return picture;
}

cv::Mat Columns(int begin, int end) {
  cv::Mat region = cv::Mat::zeros(kSize, CV_8UC1);
  region.colRange(begin, end) = 255;
  return region;
}

/// C' 16 columns wide, of which C_tb are 4, and C_ob 8 columns beside it; no rings for CB.
BorderRegions Border() {
  return {.true_border = Columns(6, 10),
          .expanded = Columns(0, 16),
          .expansion = Columns(0, 6) | Columns(10, 16),
          .outer = Columns(20, 28),
          .inside = Columns(0, 0),
          .outside = Columns(0, 0)};
}

TEST(Criteria, FepIsTheShareOfNewEdgesOfTheExpandedBorder) {  // eq. 10
  const cv::Mat frame = Stripes({4, 9});
  EXPECT_DOUBLE_EQ(ValueOf(GhostCriterion::kFep, frame, Stripes({}), Border()), 40.0 / 320);
  EXPECT_DOUBLE_EQ(ValueOf(GhostCriterion::kFep, frame, Stripes({9}), Border()), 20.0 / 320);
  EXPECT_EQ(ValueOf(GhostCriterion::kFep, frame, frame, Border()), 0);
  EXPECT_EQ(ValueOf(GhostCriterion::kFep, Stripes({}), frame, Border()), 0);
}

TEST(Criteria, FerIsTheShareOfNewEdgesTimesTheirExcess) {  // eq. 11
  const cv::Mat frame = Stripes({4, 9, 14});
  EXPECT_DOUBLE_EQ(ValueOf(GhostCriterion::kFer, frame, Stripes({9}), Border()),
                   40.0 / 60 * (40.0 / 20));
  EXPECT_DOUBLE_EQ(ValueOf(GhostCriterion::kFer, frame, Stripes({4, 9}), Border()), 20.0 / 60 * 1);
  EXPECT_EQ(ValueOf(GhostCriterion::kFer, frame, frame, Border()), 0);
  // |E_B| = 0, |E_I| = 0, both: 0 counts as 1.
  EXPECT_DOUBLE_EQ(ValueOf(GhostCriterion::kFer, frame, Stripes({}), Border()), 60.0);
  EXPECT_EQ(ValueOf(GhostCriterion::kFer, Stripes({}), frame, Border()), 0);
  EXPECT_EQ(ValueOf(GhostCriterion::kFer, Stripes({}), Stripes({}), Border()), 0);
}

TEST(Criteria, NbComparesNewAndOldEdgesOnTheTrueBorder) {  // eq. 12
  BorderRegions border = Border();
  border.true_border = Columns(2, 10);
  // The last stripe of each lies outside C_tb.
  const cv::Mat frame = Stripes({4, 7, 14});
  EXPECT_DOUBLE_EQ(ValueOf(GhostCriterion::kNb, frame, Stripes({10, 13}), border), 40.0 / 20);
  EXPECT_DOUBLE_EQ(ValueOf(GhostCriterion::kNb, frame, Stripes({4, 7}), border), 0);
  EXPECT_DOUBLE_EQ(ValueOf(GhostCriterion::kNb, frame, Stripes({13}), border), 40.0)
      << "no edge of the background there counts as one";
  EXPECT_EQ(ValueOf(GhostCriterion::kNb, Stripes({14}), Stripes({13}), border), 0);
}

TEST(Criteria, EpdComparesDensitiesWithoutABackground) {  // eq. 13
  const cv::Mat none;
  EXPECT_DOUBLE_EQ(ValueOf(GhostCriterion::kEpd, Stripes({9, 12, 24}), none, Border()),
                   (40.0 / 320) / (20.0 / 160));
  EXPECT_DOUBLE_EQ(ValueOf(GhostCriterion::kEpd, Stripes({9}), none, Border()),
                   (20.0 / 320) / (1.0 / 160))
      << "no edge around counts as one";
  EXPECT_EQ(ValueOf(GhostCriterion::kEpd, Stripes({24}), none, Border()), 0);
  EXPECT_EQ(ValueOf(GhostCriterion::kEpd, Stripes({}), none, Border()), 0);
  BorderRegions border = Border();
  border.outer = Columns(0, 0);
  EXPECT_EQ(ValueOf(GhostCriterion::kEpd, Stripes({9}), none, border), 0) << "no C_ob";
}

/// eq. 14 by OpenCV.
double Likeness(const cv::Mat& bgr, const cv::Mat& a, const cv::Mat& b, int bins) {
  const auto histogram = [&](const cv::Mat& region) {
    const int channels[] = {0, 1, 2};
    const int sizes[] = {bins, bins, bins};
    const float levels[] = {0, 256};
    const float* ranges[] = {levels, levels, levels};
    cv::Mat counts;
    cv::calcHist(&bgr, 1, channels, region, counts, 3, sizes, ranges);
    return cv::Mat(counts / cv::sum(counts)[0]);
  };
  return cv::compareHist(histogram(a), histogram(b), cv::HISTCMP_CORREL);
}

TEST(Criteria, CbComparesTheColoursOfBothSidesWithTheBorders) {  // eq. 16
  cv::RNG random(3);
  for (int round = 0; round < 40; ++round) {
    cv::Mat picture(kSize, CV_8UC3), noise(kSize, CV_8UC3);
    for (int x = 0; x < kSize.width; ++x) {
      picture.col(x) = cv::Scalar::all(x < 8 + round % 5 ? 60 + round : 150);
    }
    random.fill(noise, cv::RNG::NORMAL, 20, 2 + round);
    picture += noise;
    const CriterionOptions options{.criterion = GhostCriterion::kCb, .cb_bins = 2 + round % 9};
    const BorderRegions border{.true_border = Columns(9, 12),
                               .expanded = Columns(8, 13),
                               .expansion = Columns(8, 9) | Columns(12, 13),
                               .outer = Columns(0, 0),
                               .inside = Columns(3, 9),
                               .outside = Columns(12, 18)};
    const double inside = Likeness(picture, border.inside, border.true_border, options.cb_bins);
    const double outside = Likeness(picture, border.outside, border.true_border, options.cb_bins);
    if (std::abs(inside) < 0.01) continue;  // see below
    EXPECT_NEAR(CriterionValue(picture, {}, border, options), std::abs(outside / inside - 1),
                1e-4 * (1 + std::abs(outside / inside)));
  }
}

TEST(Criteria, CbHasAnAnswerWithoutLikenessOrPixels) {
  BorderRegions border = Border();
  border.inside = Columns(2, 6);
  border.outside = Columns(10, 14);
  cv::Mat picture(kSize, CV_8UC3, kBright);
  EXPECT_EQ(ValueOf(GhostCriterion::kCb, picture, {}, border), 0) << "all alike";
  picture.colRange(2, 6) = kDark;
  picture.colRange(10, 14) = kDark;
  // Both sides differ from the border alike.
  const double neither = ValueOf(GhostCriterion::kCb, picture, {}, border);
  EXPECT_TRUE(std::isfinite(neither));
  EXPECT_GE(neither, 0);
  // Every colour as often: a flat histogram is like none.
  cv::Mat flat(kSize, CV_8UC3, kDark);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 4; ++x) {
      const int bin = y % 8;
      flat.at<cv::Vec3b>(y, 2 + x) =
          cv::Vec3b(bin & 1 ? 200 : 20, bin & 2 ? 200 : 20, bin & 4 ? 200 : 20);
    }
  }
  border.inside = border.inside.clone();
  border.inside.rowRange(16, kSize.height) = 0;
  const CriterionOptions two_bins{.criterion = GhostCriterion::kCb, .cb_bins = 2};
  // |1 / 0.001 - 1|: the likeness to the inside is kept from 0.
  EXPECT_NEAR(CriterionValue(flat, {}, border, two_bins), 999, 1e-6);
  for (cv::Mat BorderRegions::*region :
       {&BorderRegions::true_border, &BorderRegions::inside, &BorderRegions::outside}) {
    BorderRegions without = border;
    without.*region = Columns(0, 0);
    EXPECT_EQ(ValueOf(GhostCriterion::kCb, picture, {}, without), 0);
  }
}

/// The equations with edges from edges.h (tested there), on pictures with edges everywhere.
TEST(Criteria, AreTheEquationsOnAnyPicture) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    cv::RNG random(seed);
    cv::Mat frame(40, 50, CV_8UC3), background(40, 50, CV_8UC3);
    random.fill(frame, cv::RNG::UNIFORM, 0, 256);
    random.fill(background, cv::RNG::UNIFORM, 0, 256);
    cv::GaussianBlur(frame, frame, {}, 1.5);
    cv::GaussianBlur(background, background, {}, 1.5);
    cv::Mat mask = cv::Mat::zeros(frame.size(), CV_8UC1);
    cv::ellipse(mask, {25, 20}, {random.uniform(4, 14), random.uniform(4, 12)}, 30, 0, 360, 255,
                cv::FILLED);
    const CriterionOptions options;
    const Component component = FindComponents(mask, {.margin_px = 100}).front();
    const BorderRegions border = BorderOf(component, options.border_px, options.ring_px);
    const auto count = [](const cv::Mat& pixels) {
      return static_cast<double>(cv::countNonZero(pixels));
    };
    const LumaGradient of_frame = GradientOf(frame);
    const LumaGradient of_background = GradientOf(background);
    const double upper = EdgeThreshold(&of_frame, &of_background, border.expanded);
    const cv::Mat e_i = CannyEdges(of_frame, border.expanded, upper);
    const cv::Mat e_b = CannyEdges(of_background, border.expanded, upper);
    const cv::Mat e_f = e_i & ~e_b;
    ASSERT_GT(count(e_f & border.true_border), 0);
    ASSERT_GT(count(e_b & border.true_border), 0);
    EXPECT_DOUBLE_EQ(ValueOf(GhostCriterion::kFep, frame, background, border),
                     count(e_f) / count(border.expanded));
    EXPECT_DOUBLE_EQ(ValueOf(GhostCriterion::kFer, frame, background, border),
                     count(e_f) / count(e_i) * std::max(count(e_f) / count(e_b), 1.0));
    EXPECT_DOUBLE_EQ(ValueOf(GhostCriterion::kNb, frame, background, border),
                     count(e_f & border.true_border) / count(e_b & border.true_border));
    const cv::Mat around = border.expanded | border.outer;
    const cv::Mat e = CannyEdges(of_frame, around, EdgeThreshold(&of_frame, nullptr, around));
    ASSERT_GT(count(e & border.outer), 0);
    EXPECT_DOUBLE_EQ(ValueOf(GhostCriterion::kEpd, frame, {}, border),
                     count(e & border.expanded) / count(border.expanded) /
                         (count(e & border.outer) / count(border.outer)));
  }
}

TEST(Criteria, WithoutABorderNothingSpeaksForAnObject) {
  const cv::Mat frame = Stripes({4, 9});
  const cv::Mat none = Columns(0, 0);
  const BorderRegions border{none, none, none, none, none, none};
  for (const GhostCriterion rule : kRules) {
    EXPECT_EQ(ValueOf(rule, frame, Stripes({}), border), 0) << NameOf(rule);
  }
  EXPECT_EQ(ValueOf(GhostCriterion::kNone, frame, Stripes({}), Border()), 0);
}

TEST(Criteria, HaveNamesThresholdsAndNeeds) {
  CriterionOptions options{.fep_threshold = 1,
                           .fer_threshold = 2,
                           .nb_threshold = 3,
                           .epd_threshold = 4,
                           .cb_threshold = 5};
  const char* const names[] = {"fep", "fer", "nb", "epd", "cb"};
  for (int i = 0; i < 5; ++i) {
    options.criterion = kRules[i];
    EXPECT_EQ(NameOf(kRules[i]), names[i]);
    EXPECT_EQ(options.threshold(), i + 1);
    EXPECT_EQ(NeedsBackground(kRules[i]), i < 3) << names[i];
  }
  EXPECT_FALSE(NeedsBackground(GhostCriterion::kNone));
  EXPECT_EQ(NameOf(GhostCriterion::kNone), "none");
  EXPECT_TRUE(ValidateOptions(options, "background"));
  options.cb_bins = 65;
  EXPECT_EQ(MessageOf(ValidateOptions(options, "background")),
            "background.cb_bins is 65; it must be between 2 and 64");
  options.cb_bins = 8;
  options.fep_threshold = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(MessageOf(ValidateOptions(options, "background")),
            "background.fep_threshold is nan; it must be at least 0");
}

}  // namespace
}  // namespace vantage
