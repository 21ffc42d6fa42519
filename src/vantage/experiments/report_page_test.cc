// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/report_page.h"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include <pugixml.hpp>

namespace vantage {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::string kHostile = "<script>alert(\"x\")</script> & 'y' \xff\x01";

/// The page as XML: every tag closed, every text escaped.
pugi::xml_document Parsed(const ReportPage& page) {
  pugi::xml_document document;
  const std::string html = page.Html();
  const pugi::xml_parse_result result =
      document.load_string(html.c_str(), pugi::parse_default | pugi::parse_ws_pcdata_single);
  EXPECT_TRUE(result) << result.description() << " at " << html.substr(result.offset, 80);
  return document;
}

TEST(EscapeMarkup, WhatMarkupMeans) {
  EXPECT_EQ(EscapeMarkup("a < b && c > \"d\" 'e'"),
            "a &lt; b &amp;&amp; c &gt; &quot;d&quot; &#39;e&#39;");
  EXPECT_EQ(EscapeMarkup(""), "");
  EXPECT_EQ(EscapeMarkup("tab\t, line\n"), "tab\t, line\n");
}

TEST(EscapeMarkup, KeepsUtf8AndReplacesTheRest) {
  const std::string good = "L\u00edn\u00e9a \u4e2d \U0001F600";
  EXPECT_EQ(EscapeMarkup(good), good);
  const std::string unknown = "\uFFFD";
  for (const char* bad : {"\xff", "\x80", "\x01", "\x7f\x1b", "\xc0\xaf", "\xe0\x80\x80",
                          "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xe4\xb8", "\xc2\x85"}) {
    const std::string escaped = EscapeMarkup(bad);
    EXPECT_THAT(escaped, HasSubstr(unknown)) << escaped;
  }
  EXPECT_EQ(EscapeMarkup(std::string_view("a\0b", 3)), "a" + unknown + "b");
}

RC_GTEST_PROP(EscapeMarkup, AnyBytesMakeAValidPage, (const std::string& text)) {
  ReportPage page(text);
  page.Paragraph(text);
  pugi::xml_document document;
  RC_ASSERT(document.load_string(page.Html().c_str()));
  const std::string escaped = EscapeMarkup(text);
  RC_ASSERT(escaped.find_first_of("<>\"'") == std::string::npos);
}

TEST(ReportPage, HoldsWhatItIsGivenEscaped) {
  ReportPage page(kHostile);
  page.Heading(kHostile);
  page.Subheading(kHostile);
  page.Paragraph(kHostile);
  page.List({kHostile, "second"});
  page.List({});
  page.Table(
      {.header = {"name", kHostile}, .rows = {{"a", "1"}, {kHostile, "2"}}, .caption = kHostile});
  page.Figure({"<svg><g/></svg>"}, kHostile);
  EXPECT_THAT(page.Html(), Not(HasSubstr("<script")));
  const pugi::xml_document document = Parsed(page);
  const pugi::xml_node body = document.child("html").child("body");
  const std::string shown = "<script>alert(\"x\")</script> & 'y' \uFFFD\uFFFD";
  EXPECT_EQ(document.child("html").child("head").child("title").text().get(), shown);
  for (const char* tag : {"h1", "h2", "h3", "p"}) {
    EXPECT_EQ(body.child(tag).text().get(), shown) << tag;
  }
  EXPECT_EQ(body.child("ul").child("li").text().get(), shown);
  EXPECT_EQ(body.select_nodes("ul").size(), 1u);
  EXPECT_EQ(body.select_nodes("table/tbody/tr").size(), 2u);
  EXPECT_EQ(body.select_nodes("table/tbody/tr/td").size(), 4u);
  EXPECT_EQ(body.select_nodes("table/thead/tr/th").size(), 2u);
  EXPECT_EQ(body.child("table").child("caption").text().get(), shown);
  EXPECT_EQ(body.select_nodes("figure/div/svg/g").size(), 1u);
  EXPECT_EQ(body.child("figure").child("figcaption").text().get(), shown);
}

TEST(ReportPage, StandsAlone) {
  ReportPage page("title");
  page.Paragraph("text");
  const std::string html = page.Html();
  for (const char* outside : {"<script", "<link", "<img", "src=", "href=", "url(", "@import"}) {
    EXPECT_THAT(html, Not(HasSubstr(outside)));
  }
}

TEST(ReportPage, PicturesAndSections) {
  ReportPage section(kHostile);
  section.Pictures({.columns = {"one", kHostile},
                    .rows = {{.name = kHostile, .pictures = {"data:image/png;base64,AA==", ""}}},
                    .caption = kHostile});
  ReportPage page("whole");
  page.Append(section);
  const pugi::xml_document document = Parsed(page);
  const pugi::xml_node body = document.child("html").child("body");
  EXPECT_STREQ(body.child("h2").text().get(), "<script>alert(\"x\")</script> & 'y' \uFFFD\uFFFD");
  const pugi::xml_node table = body.child("figure").child("table");
  EXPECT_EQ(std::string(table.child("tbody")
                            .child("tr")
                            .find_node([](const pugi::xml_node& node) {
                              return std::string(node.name()) == "img";
                            })
                            .attribute("src")
                            .value()),
            "data:image/png;base64,AA==");
  const auto cells = table.child("tbody").child("tr").children("td");
  EXPECT_EQ(std::distance(cells.begin(), cells.end()), 3);
}

}  // namespace
}  // namespace vantage
