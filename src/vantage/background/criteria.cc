// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/criteria.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "vantage/background/edges.h"

namespace vantage {
namespace {

/// a / b, a count in the denominator being at least 1.
double Ratio(double a, double b) { return a / std::max(b, 1.0); }

int CountOf(const cv::Mat& edges, const cv::Mat& region) {
  return cv::countNonZero(edges & region);
}

/// The edges by which FEP, FER and NB decide.
struct Edges {
  cv::Mat image;       ///< E_I
  cv::Mat background;  ///< E_B
  cv::Mat foreground;  ///< E_F = E_I and not E_B (eq. 9)
};

Edges EdgesOf(const cv::Mat& bgr, const cv::Mat& background, const cv::Mat& region) {
  const LumaGradient image_gradient = GradientOf(bgr);
  const LumaGradient background_gradient = GradientOf(background);
  const double upper = EdgeThreshold(&image_gradient, &background_gradient, region);
  Edges edges;
  edges.image = CannyEdges(image_gradient, region, upper);
  edges.background = CannyEdges(background_gradient, region, upper);
  edges.foreground = edges.image & ~edges.background;
  return edges;
}

/// eq. 10: |E_F| / |C'|
double Fep(const cv::Mat& bgr, const cv::Mat& background, const BorderRegions& border) {
  const Edges edges = EdgesOf(bgr, background, border.expanded);
  return Ratio(cv::countNonZero(edges.foreground), cv::countNonZero(border.expanded));
}

/// eq. 11: |E_F| / |E_I| max(|E_F| / |E_B|, 1)
double Fer(const cv::Mat& bgr, const cv::Mat& background, const BorderRegions& border) {
  const Edges edges = EdgesOf(bgr, background, border.expanded);
  const double foreground = cv::countNonZero(edges.foreground);
  return Ratio(foreground, cv::countNonZero(edges.image)) *
         std::max(Ratio(foreground, cv::countNonZero(edges.background)), 1.0);
}

/// eq. 12: edges of the foreground over those of the background, on the true border
double Nb(const cv::Mat& bgr, const cv::Mat& background, const BorderRegions& border) {
  const Edges edges = EdgesOf(bgr, background, border.expanded);
  return Ratio(CountOf(edges.foreground, border.true_border),
               CountOf(edges.background, border.true_border));
}

/// eq. 13: (|E_C'| / |C'|) / (|E_ob| / |C_ob|)
double Epd(const cv::Mat& bgr, const BorderRegions& border) {
  const int outer_px = cv::countNonZero(border.outer);
  if (outer_px == 0) return 0;
  const LumaGradient gradient = GradientOf(bgr);
  const cv::Mat both = border.expanded | border.outer;
  const cv::Mat edges = CannyEdges(gradient, both, EdgeThreshold(&gradient, nullptr, both));
  const double at_border =
      Ratio(CountOf(edges, border.expanded), cv::countNonZero(border.expanded));
  const double around = std::max(CountOf(edges, border.outer), 1) / static_cast<double>(outer_px);
  return at_border / around;
}

/// Shares of the colours inside the region; empty where the region is.
std::vector<double> ColorHistogram(const cv::Mat& bgr, const cv::Mat& region, int bins) {
  const auto levels = static_cast<std::size_t>(bins);
  std::vector<double> histogram(levels * levels * levels, 0.0);
  int total = 0;
  for (int y = 0; y < region.rows; ++y) {
    for (int x = 0; x < region.cols; ++x) {
      if (region.at<std::uint8_t>(y, x) == 0) continue;
      const auto& color = bgr.at<cv::Vec3b>(y, x);
      const auto bin = [&](int channel) { return color[channel] * levels / 256; };
      ++histogram[(bin(0) * levels + bin(1)) * levels + bin(2)];
      ++total;
    }
  }
  if (total == 0) return {};
  for (double& share : histogram) share /= total;
  return histogram;
}

/// eq. 14: correlation of two histograms, -1..1; 0 where one of them is flat.
double Correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const double mean = 1.0 / static_cast<double>(a.size());
  double ab = 0;
  double aa = 0;
  double bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - mean) * (b[i] - mean);
    aa += (a[i] - mean) * (a[i] - mean);
    bb += (b[i] - mean) * (b[i] - mean);
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

/// eq. 16: | s(H_oc, H_tb) / s(H_ic, H_tb) - 1 |
double Cb(const cv::Mat& bgr, const BorderRegions& border, int bins) {
  const std::vector<double> at_border = ColorHistogram(bgr, border.true_border, bins);
  const std::vector<double> inside = ColorHistogram(bgr, border.inside, bins);
  const std::vector<double> outside = ColorHistogram(bgr, border.outside, bins);
  if (at_border.empty() || inside.empty() || outside.empty()) return 0;
  const double like_inside = Correlation(inside, at_border);
  // Nearly no likeness in the denominator: kept from 0, the sign as it is.
  constexpr double kLeast = 1e-3;
  const double divisor =
      std::abs(like_inside) >= kLeast ? like_inside : std::copysign(kLeast, like_inside);
  return std::abs(Correlation(outside, at_border) / divisor - 1);
}

}  // namespace

std::string_view NameOf(GhostCriterion criterion) {
  switch (criterion) {
    case GhostCriterion::kNone:
      return "none";
    case GhostCriterion::kFep:
      return "fep";
    case GhostCriterion::kFer:
      return "fer";
    case GhostCriterion::kNb:
      return "nb";
    case GhostCriterion::kEpd:
      return "epd";
    case GhostCriterion::kCb:
      return "cb";
  }
  return "";
}

bool NeedsBackground(GhostCriterion criterion) {
  return criterion == GhostCriterion::kFep || criterion == GhostCriterion::kFer ||
         criterion == GhostCriterion::kNb;
}

double CriterionOptions::threshold() const {
  switch (criterion) {
    case GhostCriterion::kNone:
      return 0;
    case GhostCriterion::kFep:
      return fep_threshold;
    case GhostCriterion::kFer:
      return fer_threshold;
    case GhostCriterion::kNb:
      return nb_threshold;
    case GhostCriterion::kEpd:
      return epd_threshold;
    case GhostCriterion::kCb:
      return cb_threshold;
  }
  return 0;
}

void VisitOptions(CriterionOptions& o, OptionVisitor& v) {
  v.Choice({"ghosts", "", "rule by which ghosts are told from objects"}, o.criterion,
           {{"none", GhostCriterion::kNone},
            {"fep", GhostCriterion::kFep},
            {"fer", GhostCriterion::kFer},
            {"nb", GhostCriterion::kNb},
            {"epd", GhostCriterion::kEpd},
            {"cb", GhostCriterion::kCb}});
  v.Number({"fep_threshold", "", "value of rule fep above which a component is an object"},
           o.fep_threshold, Range::AtLeast(0));
  v.Number({"fer_threshold", "", "the same of rule fer"}, o.fer_threshold, Range::AtLeast(0));
  v.Number({"nb_threshold", "", "the same of rule nb"}, o.nb_threshold, Range::AtLeast(0));
  v.Number({"epd_threshold", "", "the same of rule epd"}, o.epd_threshold, Range::AtLeast(0));
  v.Number({"cb_threshold", "", "the same of rule cb"}, o.cb_threshold, Range::AtLeast(0));
  v.Number({"ghost_border", "px", "reach of the border's region on both sides of the border"},
           o.border_px, Range::Between(1, 20));
  v.Number({"ghost_ring", "px", "width of the rings beside the border, rules epd and cb"},
           o.ring_px, Range::Between(1, 50));
  v.Number({"cb_bins", "", "bins of each colour channel, rule cb"}, o.cb_bins,
           Range::Between(2, 64));
}

double CriterionValue(const cv::Mat& bgr, const cv::Mat& background, const BorderRegions& border,
                      const CriterionOptions& options) {
  if (cv::countNonZero(border.expanded) == 0) return 0;
  switch (options.criterion) {
    case GhostCriterion::kNone:
      return 0;
    case GhostCriterion::kFep:
      return Fep(bgr, background, border);
    case GhostCriterion::kFer:
      return Fer(bgr, background, border);
    case GhostCriterion::kNb:
      return Nb(bgr, background, border);
    case GhostCriterion::kEpd:
      return Epd(bgr, border);
    case GhostCriterion::kCb:
      return Cb(bgr, border, options.cb_bins);
  }
  return 0;
}

}  // namespace vantage
