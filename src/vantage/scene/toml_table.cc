// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/scene/toml_table.h"

#include <toml++/toml.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace vantage::internal {
namespace {

TomlValue Convert(const toml::node& node) {
  TomlValue value;
  value.line = static_cast<int>(node.source().begin.line);
  if (const auto* table = node.as_table()) {
    TomlEntries entries;
    for (const auto& [key, child] : *table) {
      TomlValue converted = Convert(child);
      converted.line = static_cast<int>(key.source().begin.line);
      entries.emplace(std::string(key.str()), std::move(converted));
    }
    value.value = std::move(entries);
  } else if (const auto* array = node.as_array()) {
    TomlArray values;
    for (const toml::node& child : *array) values.push_back(Convert(child));
    value.value = std::move(values);
  } else if (const auto* text = node.as_string()) {
    value.value = text->get();
  } else if (const auto* integer = node.as_integer()) {
    value.value = integer->get();
  } else if (const auto* number = node.as_floating_point()) {
    value.value = number->get();
  } else if (const auto* flag = node.as_boolean()) {
    value.value = flag->get();
  } else {
    value.value = TomlDate();
  }
  return value;
}

/// A value as a message shows it: "is 3", "is a table".
std::string Shown(const TomlValue& value) {
  struct Show {
    std::string operator()(bool flag) const { return flag ? "true" : "false"; }
    std::string operator()(std::int64_t number) const { return fmt::format("{}", number); }
    std::string operator()(double number) const { return fmt::format("{}", number); }
    std::string operator()(const std::string& text) const {
      return text.size() <= 60 ? fmt::format("\"{}\"", text)
                               : fmt::format("a text of {} characters", text.size());
    }
    std::string operator()(const TomlDate&) const { return "a date or time"; }
    std::string operator()(const TomlArray& array) const {
      return fmt::format("an array of {}", array.size());
    }
    std::string operator()(const TomlEntries&) const { return "a table"; }
  };
  return std::visit(Show(), value.value);
}

std::string WithUnit(std::string rule, std::string_view unit) {
  return unit.empty() ? rule : fmt::format("{} {}", rule, unit);
}

std::optional<double> AsNumber(const TomlValue& value) {
  if (const auto* number = std::get_if<double>(&value.value)) return *number;
  if (const auto* integer = std::get_if<std::int64_t>(&value.value)) {
    return static_cast<double>(*integer);
  }
  return std::nullopt;
}

/// Levenshtein's distance.
std::size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

/// Collects the names of the options, and sets those that the table gives.
class OptionBinder final : public OptionVisitor {
 public:
  explicit OptionBinder(const TableReader& table) : table_(table) {}

  void Flag(const OptionInfo& info, bool& value) override {
    Set(info, value, [&] { return table_.Flag(info.name); });
  }
  void Number(const OptionInfo& info, int& value, const Range& range) override {
    Set(info, value, [&]() -> Result<int> {
      VANTAGE_ASSIGN_OR_RETURN(const int number, Whole(info));
      VANTAGE_RETURN_IF_ERROR(table_.Number(info.name, range, info.unit));
      return number;
    });
  }
  void Number(const OptionInfo& info, double& value, const Range& range) override {
    Set(info, value, [&] { return table_.Number(info.name, range, info.unit); });
  }
  void NumberOr(const OptionInfo& info, std::optional<int>& value, std::string_view word,
                const Range& range) override {
    Set(info, value, [&]() -> Result<std::optional<int>> {
      VANTAGE_ASSIGN_OR_RETURN(const std::optional<double> number,
                               table_.NumberOr(info.name, word, range, info.unit));
      if (!number) return std::nullopt;
      return Whole(info);
    });
  }
  void NumberOr(const OptionInfo& info, std::optional<double>& value, std::string_view word,
                const Range& range) override {
    Set(info, value, [&] { return table_.NumberOr(info.name, word, range, info.unit); });
  }

  std::vector<std::string_view> names;
  Status status;

 protected:
  void ChoiceIndex(const OptionInfo& info, int& index,
                   const std::vector<std::string_view>& choices) override {
    Set(info, index, [&]() -> Result<int> {
      VANTAGE_ASSIGN_OR_RETURN(const std::string text, table_.Text(info.name));
      const auto found = std::find(choices.begin(), choices.end(), text);
      if (found != choices.end()) return static_cast<int>(found - choices.begin());
      return table_.FailAt(info.name, fmt::format("is \"{}\"; it must be one of {}", text,
                                                  fmt::join(choices, ", ")));
    });
  }

 private:
  Result<int> Whole(const OptionInfo& info) const {
    VANTAGE_ASSIGN_OR_RETURN(const std::int64_t number,
                             table_.Integer(info.name, std::numeric_limits<int>::min(),
                                            std::numeric_limits<int>::max()));
    return static_cast<int>(number);
  }
  template <class T, class Read>
  void Set(const OptionInfo& info, T& value, const Read& read) {
    names.push_back(info.name);
    if (!status || !table_.Has(info.name)) return;
    Result<T> result = read();
    if (result)
      value = *result;
    else
      status = tl::unexpected<Error>(result.error());
  }
  const TableReader& table_;
};

}  // namespace

Result<TomlValue> ParseToml(const std::string& file, std::string_view text) {
  try {
    return Convert(toml::parse(text, file));
  } catch (const toml::parse_error& error) {
    std::string description(error.description());
    std::replace(description.begin(), description.end(), '\n', ' ');
    return Fail("{}:{}: not valid TOML: {}", file, error.source().begin.line, description);
  }
}

std::optional<std::string> NearestName(std::string_view name,
                                       const std::vector<std::string_view>& allowed) {
  std::optional<std::string> nearest;
  std::size_t least = 3;
  for (const std::string_view candidate : allowed) {
    const std::size_t distance = EditDistance(name.substr(0, 64), candidate);
    if (distance < least && distance < candidate.size()) {
      least = distance;
      nearest = std::string(candidate);
    }
  }
  return nearest;
}

TableReader::TableReader(const std::string& file, std::string path, const TomlValue& table)
    : file_(&file),
      path_(std::move(path)),
      entries_(&std::get<TomlEntries>(table.value)),
      line_(table.line) {}

const TomlValue* TableReader::Find(std::string_view key) const {
  const auto found = entries_->find(key);
  return found == entries_->end() ? nullptr : &found->second;
}

std::string TableReader::PathOf(std::string_view key) const {
  if (key.empty()) return path_;
  return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
}

tl::unexpected<Error> TableReader::FailAt(std::string_view key, std::string_view message) const {
  const TomlValue* value = Find(key);
  return Fail("{}:{}: {}: {}", *file_, std::max(1, value != nullptr ? value->line : line_),
              PathOf(key), message);
}

bool TableReader::HasText(std::string_view key) const {
  const TomlValue* value = Find(key);
  return value != nullptr && std::holds_alternative<std::string>(value->value);
}

Result<const TomlValue*> TableReader::Need(std::string_view key) const {
  const TomlValue* value = Find(key);
  if (value == nullptr) return FailAt(key, "is missing");
  return value;
}

Status TableReader::AllowOnly(const std::vector<std::string_view>& keys) const {
  for (const auto& [key, value] : *entries_) {
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    const auto nearest = NearestName(key, keys);
    return FailAt(key, fmt::format("unknown key{}; allowed are {}",
                                   nearest ? fmt::format(", did you mean {}?", *nearest) : "",
                                   fmt::join(keys, ", ")));
  }
  return {};
}

Result<double> TableReader::Number(std::string_view key, const Range& range,
                                   std::string_view unit) const {
  VANTAGE_ASSIGN_OR_RETURN(const TomlValue* const value, Need(key));
  const auto number = AsNumber(*value);
  if (!number || !range.Contains(*number)) {
    const std::string rule = WithUnit(range.Text(), unit);
    const bool says_number = number || rule.starts_with("a finite number");
    return FailAt(key, fmt::format("is {}; it must be {}{}", Shown(*value),
                                   says_number ? "" : "a number, ", rule));
  }
  return *number;
}

Result<std::optional<double>> TableReader::NumberOr(std::string_view key, std::string_view word,
                                                    const Range& range,
                                                    std::string_view unit) const {
  VANTAGE_ASSIGN_OR_RETURN(const TomlValue* const value, Need(key));
  const auto* text = std::get_if<std::string>(&value->value);
  if (text != nullptr && *text == word) return std::nullopt;
  const Result<double> number = Number(key, range, unit);
  if (number) return *number;
  return Fail("{}, or \"{}\"", number.error().message, word);
}

Result<std::int64_t> TableReader::Integer(std::string_view key, std::int64_t low,
                                          std::int64_t high) const {
  VANTAGE_ASSIGN_OR_RETURN(const TomlValue* const value, Need(key));
  const auto* number = std::get_if<std::int64_t>(&value->value);
  if (number == nullptr || *number < low || *number > high) {
    return FailAt(key, fmt::format("is {}; it must be a whole number from {} to {}", Shown(*value),
                                   low, high));
  }
  return *number;
}

Result<bool> TableReader::Flag(std::string_view key) const {
  VANTAGE_ASSIGN_OR_RETURN(const TomlValue* const value, Need(key));
  if (const auto* flag = std::get_if<bool>(&value->value)) return *flag;
  return FailAt(key, fmt::format("is {}; it must be true or false", Shown(*value)));
}

Result<std::string> TableReader::Text(std::string_view key) const {
  VANTAGE_ASSIGN_OR_RETURN(const TomlValue* const value, Need(key));
  const auto* text = std::get_if<std::string>(&value->value);
  if (text != nullptr && !text->empty()) return *text;
  return FailAt(key,
                fmt::format("is {}; it must be a text in quotes that is not empty", Shown(*value)));
}

Result<std::vector<double>> TableReader::NumbersOf(std::string_view key,
                                                   const TomlValue& value) const {
  const auto* array = std::get_if<TomlArray>(&value.value);
  std::vector<double> numbers;
  for (std::size_t i = 0; array != nullptr && i < array->size(); ++i) {
    const auto number = AsNumber((*array)[i]);
    if (!number || !std::isfinite(*number)) {
      return FailAt(key,
                    fmt::format("holds {}; its values must be finite numbers", Shown((*array)[i])));
    }
    numbers.push_back(*number);
  }
  if (array == nullptr) {
    return FailAt(key, fmt::format("is or holds {}; it must be an array of numbers", Shown(value)));
  }
  return numbers;
}

Result<std::vector<double>> TableReader::Numbers(std::string_view key,
                                                 std::initializer_list<std::size_t> counts) const {
  VANTAGE_ASSIGN_OR_RETURN(const TomlValue* const value, Need(key));
  VANTAGE_ASSIGN_OR_RETURN(std::vector<double> numbers, NumbersOf(key, *value));
  if (counts.size() > 0 &&
      std::find(counts.begin(), counts.end(), numbers.size()) == counts.end()) {
    return FailAt(key, fmt::format("has {} numbers; it must have {}", numbers.size(),
                                   fmt::join(counts, " or ")));
  }
  return numbers;
}

Result<std::vector<std::vector<double>>> TableReader::RowsOf(std::string_view key,
                                                             const TomlValue& value,
                                                             std::size_t columns) const {
  const auto* array = std::get_if<TomlArray>(&value.value);
  if (array == nullptr) {
    return FailAt(key, fmt::format("is or holds {}; it must be an array of rows of {} numbers",
                                   Shown(value), columns));
  }
  std::vector<std::vector<double>> rows;
  for (const TomlValue& row : *array) {
    VANTAGE_ASSIGN_OR_RETURN(std::vector<double> numbers, NumbersOf(key, row));
    if (numbers.size() != columns) {
      return FailAt(key, fmt::format("row {} has {} numbers; each row must have {}",
                                     rows.size() + 1, numbers.size(), columns));
    }
    rows.push_back(std::move(numbers));
  }
  return rows;
}

Result<std::vector<std::vector<double>>> TableReader::Rows(std::string_view key,
                                                           std::size_t columns) const {
  VANTAGE_ASSIGN_OR_RETURN(const TomlValue* const value, Need(key));
  return RowsOf(key, *value, columns);
}

Result<std::vector<std::vector<std::vector<double>>>> TableReader::ListOfRows(
    std::string_view key, std::size_t columns) const {
  VANTAGE_ASSIGN_OR_RETURN(const TomlValue* const value, Need(key));
  const auto* array = std::get_if<TomlArray>(&value->value);
  if (array == nullptr) {
    return FailAt(key, fmt::format("is {}; it must be an array of arrays of rows of {} numbers",
                                   Shown(*value), columns));
  }
  std::vector<std::vector<std::vector<double>>> list;
  for (const TomlValue& item : *array) {
    VANTAGE_ASSIGN_OR_RETURN(auto rows, RowsOf(key, item, columns));
    list.push_back(std::move(rows));
  }
  return list;
}

Result<TableReader> TableReader::Table(std::string_view key) const {
  VANTAGE_ASSIGN_OR_RETURN(const TomlValue* const value, Need(key));
  if (std::holds_alternative<TomlEntries>(value->value))
    return TableReader(*file_, PathOf(key), *value);
  return FailAt(key, fmt::format("is {}; it must be a table", Shown(*value)));
}

Result<std::vector<TableReader>> TableReader::Tables(std::string_view key) const {
  VANTAGE_ASSIGN_OR_RETURN(const TomlValue* const value, Need(key));
  const auto* array = std::get_if<TomlArray>(&value->value);
  std::vector<TableReader> tables;
  for (std::size_t i = 0; array != nullptr && i < array->size(); ++i) {
    if (!std::holds_alternative<TomlEntries>((*array)[i].value)) break;
    tables.emplace_back(*file_, fmt::format("{}[{}]", PathOf(key), i), (*array)[i]);
  }
  if (array == nullptr || tables.size() != array->size() || tables.empty()) {
    return FailAt(key, fmt::format("is {}; it must be one or more tables [[{}]]", Shown(*value),
                                   PathOf(key)));
  }
  return tables;
}

Status TableReader::Bind(const std::function<void(OptionVisitor&)>& visit) const {
  OptionBinder binder(*this);
  visit(binder);
  VANTAGE_RETURN_IF_ERROR(AllowOnly(binder.names));
  return binder.status;
}

}  // namespace vantage::internal
