// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/base/options.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace vantage {

bool Range::Contains(double value) const {
  if (!std::isfinite(value)) return false;
  if (low_open ? value <= low : value < low) return false;
  return high_open ? value < high : value <= high;
}

std::string Range::Text() const {
  const bool has_low = std::isfinite(low);
  const bool has_high = std::isfinite(high);
  if (has_low && has_high && !low_open && !high_open) {
    return fmt::format("between {} and {}", low, high);
  }
  std::string text;
  if (has_low) text = fmt::format("{} {}", low_open ? "above" : "at least", low);
  if (has_high) {
    text +=
        fmt::format("{}{} {}", text.empty() ? "" : " and ", high_open ? "below" : "at most", high);
  }
  return text.empty() ? "a finite number" : text;
}

namespace internal {
namespace {

std::string Field(const std::string& prefix, std::string_view name) {
  return prefix.empty() ? std::string(name) : fmt::format("{}.{}", prefix, name);
}

std::string RuleText(const Range& range, std::string_view unit) {
  return unit.empty() ? range.Text() : fmt::format("{} {}", range.Text(), unit);
}

}  // namespace

void OptionValidator::Number(const OptionInfo& info, int& value, const Range& range) {
  if (status && !range.Contains(value)) {
    status = Fail("{} is {}; it must be {}", Field(prefix_, info.name), value,
                  RuleText(range, info.unit));
  }
}

void OptionValidator::Number(const OptionInfo& info, double& value, const Range& range) {
  if (status && !range.Contains(value)) {
    status = Fail("{} is {}; it must be {}", Field(prefix_, info.name), value,
                  RuleText(range, info.unit));
  }
}

void OptionValidator::NumberOr(const OptionInfo& info, std::optional<int>& value,
                               std::string_view word, const Range& range) {
  std::optional<double> number = value;
  NumberOr(info, number, word, range);
}

void OptionValidator::NumberOr(const OptionInfo& info, std::optional<double>& value,
                               std::string_view word, const Range& range) {
  if (status && value && !range.Contains(*value)) {
    status = Fail("{} is {}; it must be {}, or \"{}\"", Field(prefix_, info.name), *value,
                  RuleText(range, info.unit), word);
  }
}

void OptionValidator::ChoiceIndex(const OptionInfo& info, int& index,
                                  const std::vector<std::string_view>& names) {
  if (status && index < 0) {
    status = Fail("{} has no valid value; it must be one of {}", Field(prefix_, info.name),
                  fmt::join(names, ", "));
  }
}

void OptionRecorder::Flag(const OptionInfo& info, bool& value) {
  json_[std::string(info.name)] = value;
}
void OptionRecorder::Number(const OptionInfo& info, int& value, const Range&) {
  json_[std::string(info.name)] = value;
}
void OptionRecorder::Number(const OptionInfo& info, double& value, const Range&) {
  json_[std::string(info.name)] = value;
}
void OptionRecorder::NumberOr(const OptionInfo& info, std::optional<int>& value,
                              std::string_view word, const Range& range) {
  if (value)
    Number(info, *value, range);
  else
    json_[std::string(info.name)] = word;
}
void OptionRecorder::NumberOr(const OptionInfo& info, std::optional<double>& value,
                              std::string_view word, const Range& range) {
  if (value)
    Number(info, *value, range);
  else
    json_[std::string(info.name)] = word;
}
void OptionRecorder::ChoiceIndex(const OptionInfo& info, int& index,
                                 const std::vector<std::string_view>& names) {
  if (index >= 0) json_[std::string(info.name)] = names[static_cast<size_t>(index)];
}

}  // namespace internal
}  // namespace vantage
