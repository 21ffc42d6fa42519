// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/chart.h"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <pugixml.hpp>
#include <sstream>

namespace vantage {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

pugi::xml_document Parsed(const std::string& svg) {
  pugi::xml_document document;
  const pugi::xml_parse_result result = document.load_string(svg.c_str());
  EXPECT_TRUE(result) << result.description() << "\n" << svg;
  return document;
}

/// The bars, which say their figures, apart from the legend.
std::vector<pugi::xml_node> Bars(const pugi::xml_document& document) {
  std::vector<pugi::xml_node> bars;
  for (const auto& found : document.select_nodes("//rect[title]")) bars.push_back(found.node());
  return bars;
}

std::vector<std::pair<double, double>> Points(const pugi::xml_node& line) {
  std::vector<std::pair<double, double>> points;
  std::istringstream text(line.attribute("points").value());
  char comma = 0;
  for (double x = 0, y = 0; text >> x >> comma >> y;) points.emplace_back(x, y);
  return points;
}

TEST(BarChart, HeightsAreTheValues) {
  const pugi::xml_document document = Parsed(ToSvg(BarChart{
      .title = "F1", .groups = {"a", "b"}, .series = {{"one", {0.25, 1}}, {"two", {kNan, 0.5}}}}));
  const std::vector<pugi::xml_node> bars = Bars(document);
  ASSERT_EQ(bars.size(), 3u);
  const auto height = [&](std::size_t i) { return bars[i].attribute("height").as_double(); };
  EXPECT_NEAR(height(0) / height(1), 0.25, 1e-3);  // a one, b one, b two
  EXPECT_NEAR(height(2) / height(1), 0.5, 1e-3);
  EXPECT_STREQ(bars[0].child("title").text().get(), "a, one: 0.2500");
  EXPECT_LT(bars[0].attribute("x").as_double(), bars[1].attribute("x").as_double());
  EXPECT_LT(bars[1].attribute("x").as_double(), bars[2].attribute("x").as_double());
  EXPECT_NE(std::string(bars[1].attribute("fill").value()), bars[2].attribute("fill").value());
}

TEST(BarChart, NamesAreEscaped) {
  const std::string svg =
      ToSvg(BarChart{.title = "<a>\"", .groups = {"<b>"}, .series = {{"<c> & \"d\"", {0.5}}}});
  EXPECT_THAT(svg, Not(HasSubstr("<b>")));
  Parsed(svg);
}

TEST(LineChart, PointsAreWhereTheyBelong) {
  const pugi::xml_document document = Parsed(
      ToSvg(LineChart{.title = "t",
                      .x_label = "frame",
                      .series = {{"a", {{100, 0}, {150, 50}, {200, 100}}}, {"b", {{100, 100}}}},
                      .marks = {{150, "<here>"}, {900, "outside"}}}));
  const auto lines = document.select_nodes("//polyline");
  ASSERT_EQ(lines.size(), 2u);
  const auto points = Points(lines[0].node());
  ASSERT_EQ(points.size(), 3u);
  EXPECT_NEAR(points[1].first, (points[0].first + points[2].first) / 2, 0.11);
  EXPECT_NEAR(points[1].second, (points[0].second + points[2].second) / 2, 0.11);
  EXPECT_GT(points[0].second, points[2].second);  // y goes down in SVG
  EXPECT_EQ(Points(lines[1].node())[0].second, points[2].second);
  EXPECT_EQ(document.select_nodes("//text[.='<here>']").size(), 1u);
  EXPECT_EQ(document.select_nodes("//text[.='outside']").size(), 0u);
}

TEST(LineChart, NothingToDraw) {
  Parsed(ToSvg(LineChart{.title = "t", .x_label = "x"}));
  Parsed(ToSvg(LineChart{.title = "t", .x_label = "x", .series = {{"a", {}}}}));
  Parsed(ToSvg(LineChart{.title = "t", .x_label = "x", .series = {{"a", {{7, 0}}}}}));
}

RC_GTEST_PROP(LineChart, StaysInsideItsBox, (const std::vector<unsigned>& values)) {
  LineChart chart{.title = "t", .x_label = "x", .series = {{"a", {}}}};
  for (const unsigned value : values) {
    chart.series[0].points.emplace_back(chart.series[0].points.size(), value);
  }
  const std::string svg = ToSvg(chart);
  RC_ASSERT(svg.find("nan") == std::string::npos && svg.find("inf") == std::string::npos);
  pugi::xml_document document;
  RC_ASSERT(document.load_string(svg.c_str()));
  const auto points = Points(document.select_node("//polyline").node());
  RC_ASSERT(points.size() == values.size());
  for (const auto& [x, y] : points) RC_ASSERT(x >= 0 && x <= 480 && y >= 0 && y <= 260);
}

}  // namespace
}  // namespace vantage
