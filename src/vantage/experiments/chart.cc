// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "vantage/experiments/report_page.h"

namespace vantage {
namespace {

// In units of the SVG's view box.
constexpr double kWidth = 480;
constexpr double kHeight = 260;
constexpr double kLeft = 52;
constexpr double kRight = kWidth - 8;
constexpr double kTop = 46;  // title and legend above
constexpr double kBottom = kHeight - 36;
constexpr double kLetter = 6.4;  // mean width of a letter of the legend

struct Style {
  const char* color;
  const char* dashes;
};
// Two pairs of a dark and a light hue, from the palette of Okabe and Ito; then others.
constexpr std::array<Style, 8> kStyles = {{{"#0072b2", "none"},
                                           {"#7cc4ee", "7 3"},
                                           {"#c24e00", "2 3"},
                                           {"#f4b183", "9 3 2 3"},
                                           {"#007a5e", "5 5"},
                                           {"#8ad6bf", "1 2"},
                                           {"#5b2a86", "12 4"},
                                           {"#999999", "4 2"}}};

const Style& StyleOf(std::size_t series) { return kStyles[series % kStyles.size()]; }

/// 1, 2 or 5 times a power of ten, about a fifth of `range`.
double TickStep(double range) {
  const double raw = range / 5;
  const double power = std::pow(10, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= raw * 0.999) return factor * power;
  }
  return 10 * power;
}

/// A linear axis from values to places in the view box.
struct Axis {
  double low, high, from, to;
  double At(double value) const {
    return from + (value - low) / std::max(high - low, 1e-300) * (to - from);
  }
};

std::string Text(double x, double y, std::string_view anchor, std::string_view text,
                 std::string_view more = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y,
                     anchor, more, EscapeMarkup(text));
}

std::string Line(double x1, double y1, double x2, double y2, std::string_view style) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", x1, y1,
                     x2, y2, style);
}

std::string Open(std::string_view title) {
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" role=\"img\" "
             "aria-label=\"{}\" font-family=\"system-ui, sans-serif\" font-size=\"11\" "
             "fill=\"#1a1a1a\">\n",
             kWidth, kHeight, EscapeMarkup(title)) +
         Text(kLeft, 14, "start", title, " font-weight=\"bold\"");
}

/// Grid and figures of the y axis.
std::string YAxis(const Axis& y) {
  std::string svg;
  const double step = TickStep(y.high - y.low);
  for (int i = 0; y.low + i * step <= y.high * 1.0001; ++i) {
    const double value = y.low + i * step;
    svg += Line(kLeft, y.At(value), kRight, y.At(value), "stroke=\"#ddd\"");
    svg += Text(kLeft - 5, y.At(value) + 4, "end", fmt::format("{:.10g}", value));
  }
  return svg;
}

/// Names of series beside samples of their bars or lines, in a row under the title.
template <class Series, class Sample>
std::string Legend(const std::vector<Series>& series, const Sample& sample) {
  std::string svg;
  double x = kLeft;
  for (std::size_t i = 0; i < series.size(); ++i) {
    svg += sample(i, x);
    svg += Text(x + 24, 34, "start", series[i].name);
    x += 36 + kLetter * static_cast<double>(series[i].name.size());
  }
  return svg;
}

}  // namespace

std::string ToSvg(const BarChart& chart) {
  double highest = 0;
  for (const BarSeries& series : chart.series) {
    for (const double value : series.values) {
      if (std::isfinite(value)) highest = std::max(highest, value);
    }
  }
  // Shares are drawn to 1, so that charts compare.
  const Axis y{.low = 0, .high = std::max(highest, 1.0), .from = kBottom, .to = kTop};
  std::string svg = Open(chart.title) + YAxis(y);
  svg += Legend(chart.series, [](std::size_t i, double x) {
    return fmt::format("<rect x=\"{:.1f}\" y=\"25\" width=\"18\" height=\"10\" fill=\"{}\"/>\n", x,
                       StyleOf(i).color);
  });
  const double group_width = (kRight - kLeft) / static_cast<double>(chart.groups.size());
  const double bar_width = 0.84 * group_width / static_cast<double>(chart.series.size());
  // Names that are wider than their groups stand on two lines by turns.
  constexpr double kLetter_px = 6;
  const bool crowded = std::ranges::any_of(chart.groups, [&](const std::string& name) {
    return kLetter_px * static_cast<double>(name.size()) > group_width;
  });
  for (std::size_t g = 0; g < chart.groups.size(); ++g) {
    const double left = kLeft + static_cast<double>(g) * group_width;
    const double below = crowded && g % 2 == 1 ? 29 : 15;
    const double half_name = kLetter_px / 2 * static_cast<double>(chart.groups[g].size());
    const double middle = std::min(left + group_width / 2, kWidth - half_name);
    svg += Text(middle, kBottom + below, "middle", chart.groups[g]);
    for (std::size_t s = 0; s < chart.series.size(); ++s) {
      const double value = chart.series[s].values[g];
      if (!std::isfinite(value)) continue;
      svg += fmt::format(
          "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\"><title>"
          "{}, {}: {:.4f}</title></rect>\n",
          left + 0.08 * group_width + static_cast<double>(s) * bar_width, y.At(value),
          0.94 * bar_width, kBottom - y.At(value), StyleOf(s).color, EscapeMarkup(chart.groups[g]),
          EscapeMarkup(chart.series[s].name), value);
    }
  }
  return svg + Line(kLeft, kBottom, kRight, kBottom, "stroke=\"#555\"") + "</svg>\n";
}

std::string ToSvg(const LineChart& chart) {
  double first = std::numeric_limits<double>::infinity();
  double last = -first;
  double highest = 0;
  for (const LineSeries& series : chart.series) {
    for (const auto& [x, y] : series.points) {
      first = std::min(first, x);
      last = std::max(last, x);
      highest = std::max(highest, y);
    }
  }
  if (first > last) first = last = 0;  // no point at all
  const Axis x{
      .low = first, .high = std::max(last, first + chart.x_step), .from = kLeft, .to = kRight};
  const Axis y{.low = 0, .high = highest > 0 ? highest : 1, .from = kBottom, .to = kTop};
  std::string svg = Open(chart.title) + YAxis(y);
  const double step = std::max(chart.x_step, TickStep(x.high - x.low));
  const double first_tick = std::ceil(x.low / step) * step;
  for (int i = 0; first_tick + i * step <= x.high; ++i) {
    const double value = first_tick + i * step;
    svg += Line(x.At(value), kBottom, x.At(value), kBottom + 4, "stroke=\"#555\"");
    svg += Text(x.At(value), kBottom + 16, "middle", fmt::format("{:.10g}", value));
  }
  svg += Text((kLeft + kRight) / 2, kHeight - 6, "middle", chart.x_label);
  for (const auto& [place, meaning] : chart.marks) {
    if (place < x.low || place > x.high) continue;
    svg +=
        Line(x.At(place), kTop, x.At(place), kBottom, "stroke=\"#555\" stroke-dasharray=\"2 2\"");
    svg += Text(x.At(place) + 4, kTop + 10, "start", meaning);
  }
  const auto style = [](std::size_t i) {
    return fmt::format("fill=\"none\" stroke-width=\"1.8\" stroke=\"{}\" stroke-dasharray=\"{}\"",
                       StyleOf(2 * i).color, StyleOf(i).dashes);
  };
  svg += Legend(chart.series,
                [&](std::size_t i, double at) { return Line(at, 30, at + 20, 30, style(i)); });
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    std::string points;
    for (const auto& [px, py] : chart.series[i].points) {
      points += fmt::format("{}{:.1f},{:.1f}", points.empty() ? "" : " ", x.At(px), y.At(py));
    }
    svg += fmt::format("<polyline points=\"{}\" {}/>\n", points, style(i));
  }
  return svg + Line(kLeft, kBottom, kRight, kBottom, "stroke=\"#555\"") + "</svg>\n";
}

}  // namespace vantage
