// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/base/result.h"

/// Reading of text files made of lines and fields.

namespace vantage {

/// Without spaces, tabs and carriage returns at both ends.
inline std::string_view Trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

/// The fields of a line between separators, each trimmed; at least one.
inline std::vector<std::string_view> Fields(std::string_view line, char separator = ',') {
  std::vector<std::string_view> fields;
  for (std::size_t at = 0;;) {
    const std::size_t end = std::min(line.find(separator, at), line.size());
    fields.push_back(Trimmed(line.substr(at, end - at)));
    if (end == line.size()) return fields;
    at = end + 1;
  }
}

/// True when the whole of `text` is a number of this type; "nan" and "inf" are, for floating point.
template <class Number>
bool ParseNumber(std::string_view text, Number& value) {
  const auto [stop, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  return code == std::errc() && stop == text.data() + text.size();
}

/// Calls `visit(line, number)` for each line, trimmed, numbered from 1, up to the first error.
template <class Visit>
Status ForEachLine(std::string_view text, const Visit& visit) {
  std::size_t number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    VANTAGE_RETURN_IF_ERROR(Status(visit(Trimmed(text.substr(at, end - at)), ++number)));
    at = end + 1;
  }
  return {};
}

}  // namespace vantage
