// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/report_page.h"

#include <fmt/format.h>

#include <cstddef>

namespace vantage {
namespace {

constexpr std::string_view kUnknown = "\xEF\xBF\xBD";  // U+FFFD

constexpr std::string_view kStyle = R"(
body { font: 15px/1.45 system-ui, sans-serif; color: #1a1a1a; max-width: 1240px;
  margin: 2em auto; padding: 0 1.2em; }
h1 { font-size: 1.7em; } h2 { margin-top: 2em; border-bottom: 1px solid #bbb; }
table { border-collapse: collapse; margin: 1em 0; font-variant-numeric: tabular-nums; }
caption { caption-side: top; text-align: left; padding-bottom: .3em; color: #444; }
th, td { padding: .15em .6em; border-bottom: 1px solid #ddd; text-align: right; }
th:first-child, td:first-child, table.words th, table.words td { text-align: left; }
thead th { border-bottom: 1px solid #555; vertical-align: bottom; }
table.pictures td { padding: .15em; border: 0; vertical-align: middle; }
table.pictures img { display: block; max-width: 100%; }
figure { margin: 1em 0; } figcaption { color: #444; }
.charts { display: flex; flex-wrap: wrap; gap: .6em; } .charts svg { flex: 1 1 360px; max-width: 620px; }
@media print { body { font-size: 9pt; max-width: none; margin: 0; } h2, h3 { break-after: avoid; }
  figure, tr { break-inside: avoid; } .charts svg { flex-basis: 30%; } }
)";

/// Length of the UTF-8 sequence that `text` begins with; 0 where it is none that a page may hold.
std::size_t SequenceLength(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  if (first < 0x80) return first >= 0x20 || first == '\n' || first == '\t' ? 1 : 0;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < length) return 0;
  unsigned code = first & (0xFFu >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0u) != 0x80u) return 0;
    code = code << 6 | (byte(i) & 0x3Fu);
  }
  const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  const bool control = code < 0xA0;
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  const bool noncharacter = (code & 0xFFFEu) == 0xFFFEu;
  return overlong || control || surrogate || noncharacter || code > 0x10FFFF ? 0 : length;
}

}  // namespace

std::string EscapeMarkup(std::string_view text) {
  std::string escaped;
  escaped.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = SequenceLength(text);
    if (length == 0) {
      escaped += kUnknown;
    } else if (text[0] == '&') {
      escaped += "&amp;";
    } else if (text[0] == '<') {
      escaped += "&lt;";
    } else if (text[0] == '>') {
      escaped += "&gt;";
    } else if (text[0] == '"') {
      escaped += "&quot;";
    } else if (text[0] == '\'') {
      escaped += "&#39;";
    } else {
      escaped += text.substr(0, length);
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return escaped;
}

ReportPage::ReportPage(std::string_view title) : title_(EscapeMarkup(title)) {}

void ReportPage::Heading(std::string_view text) {
  body_ += fmt::format("<h2>{}</h2>\n", EscapeMarkup(text));
}

void ReportPage::Subheading(std::string_view text) {
  body_ += fmt::format("<h3>{}</h3>\n", EscapeMarkup(text));
}

void ReportPage::Paragraph(std::string_view text) {
  body_ += fmt::format("<p>{}</p>\n", EscapeMarkup(text));
}

void ReportPage::List(const std::vector<std::string>& items) {
  if (items.empty()) return;
  body_ += "<ul>\n";
  for (const std::string& item : items) body_ += fmt::format("<li>{}</li>\n", EscapeMarkup(item));
  body_ += "</ul>\n";
}

void ReportPage::Table(const PageTable& table) {
  body_ += table.words ? "<table class=\"words\">\n" : "<table>\n";
  if (!table.caption.empty()) {
    body_ += fmt::format("<caption>{}</caption>\n", EscapeMarkup(table.caption));
  }
  body_ += "<thead><tr>";
  for (const std::string& cell : table.header) {
    body_ += fmt::format("<th>{}</th>", EscapeMarkup(cell));
  }
  body_ += "</tr></thead>\n<tbody>\n";
  for (const std::vector<std::string>& row : table.rows) {
    body_ += "<tr>";
    for (const std::string& cell : row) body_ += fmt::format("<td>{}</td>", EscapeMarkup(cell));
    body_ += "</tr>\n";
  }
  body_ += "</tbody>\n</table>\n";
}

void ReportPage::Figure(const std::vector<std::string>& charts, std::string_view caption) {
  body_ += fmt::format("<figure>\n<div class=\"charts\">\n{}</div>\n<figcaption>{}</figcaption>\n",
                       fmt::join(charts, ""), EscapeMarkup(caption));
  body_ += "</figure>\n";
}

void ReportPage::Pictures(const PictureGrid& grid) {
  body_ += "<figure>\n<table class=\"pictures\">\n";
  if (!grid.columns.empty()) {
    body_ += "<thead><tr><th></th>";
    for (const std::string& column : grid.columns) {
      body_ += fmt::format("<th>{}</th>", EscapeMarkup(column));
    }
    body_ += "</tr></thead>\n";
  }
  body_ += "<tbody>\n";
  for (const PictureGrid::Row& row : grid.rows) {
    body_ += fmt::format("<tr><td>{}</td>", EscapeMarkup(row.name));
    for (std::size_t i = 0; i < row.pictures.size(); ++i) {
      const std::string name =
          i < grid.columns.size() ? row.name + " " + grid.columns[i] : row.name;
      body_ += row.pictures[i].empty()
                   ? "<td></td>"
                   : fmt::format("<td><img src=\"{}\" alt=\"{}\"/></td>",
                                 EscapeMarkup(row.pictures[i]), EscapeMarkup(name));
    }
    body_ += "</tr>\n";
  }
  body_ += fmt::format("</tbody>\n</table>\n<figcaption>{}</figcaption>\n</figure>\n",
                       EscapeMarkup(grid.caption));
}

void ReportPage::Append(const ReportPage& section) {
  body_ += fmt::format("<h2>{}</h2>\n{}", section.title_, section.body_);
}

std::string ReportPage::Html() const {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
      "<title>{0}</title>\n<style>{1}</style>\n</head>\n<body>\n<h1>{0}</h1>\n{2}</body>\n</"
      "html>\n",
      title_, kStyle, body_);
}

}  // namespace vantage
