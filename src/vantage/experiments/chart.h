// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

/// Charts as SVG elements for a ReportPage. Series tell apart by lightness and by dashes too, for
/// print without colour. Pointing at a bar shows its figure.

namespace vantage {

struct BarSeries {
  std::string name;
  std::vector<double> values = {};  ///< one a group; NaN: no bar
};

/// Bars of several series side by side in named groups, over an axis that begins at 0.
struct BarChart {
  std::string title;
  std::vector<std::string> groups = {};
  std::vector<BarSeries> series = {};
};
std::string ToSvg(const BarChart& chart);

struct LineSeries {
  std::string name;
  std::vector<std::pair<double, double>> points = {};  ///< x ascending; y at least 0
};

struct LineChart {
  std::string title;
  std::string x_label;
  std::vector<LineSeries> series = {};
  /// Vertical lines across the chart with what they mark.
  std::vector<std::pair<double, std::string>> marks = {};
  double x_step = 1;  ///< the least distance of two figures on the x axis, > 0
};
std::string ToSvg(const LineChart& chart);

}  // namespace vantage
