// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// `text` as it must stand in HTML and SVG, in content and in quoted attributes. What is not UTF-8
/// and control characters become U+FFFD, so that a page stays valid whatever a file is called.
std::string EscapeMarkup(std::string_view text);

struct PageTable {
  std::vector<std::string> header;
  /// As many cells as the header has. The first column holds names, the others figures, which
  /// stand at the right.
  std::vector<std::vector<std::string>> rows = {};
  std::string caption = {};
  /// Whether the other columns hold words too.
  bool words = false;
};

/// Pictures in rows under headings.
struct PictureGrid {
  std::vector<std::string> columns = {};  ///< one heading a column; empty: no headings
  struct Row {
    std::string name;
    std::vector<std::string> pictures;  ///< data URIs (picture_uri.h); empty: none there
  };
  std::vector<Row> rows = {};
  std::string caption = {};
};

/// A page that stands alone: one file without scripts or anything from outside, for screens and for
/// print. All text is escaped here; charts come as the SVG of chart.h. The markup is XML too.
class ReportPage {
 public:
  explicit ReportPage(std::string_view title);

  void Heading(std::string_view text);
  void Subheading(std::string_view text);
  void Paragraph(std::string_view text);
  void List(const std::vector<std::string>& items);
  void Table(const PageTable& table);
  /// Charts beside each other as far as they fit, under one caption.
  void Figure(const std::vector<std::string>& charts, std::string_view caption);

  void Pictures(const PictureGrid& grid);
  /// The content of another page; its title becomes a heading.
  void Append(const ReportPage& section);

  std::string Html() const;

 private:
  std::string title_;
  std::string body_;
};

}  // namespace vantage
