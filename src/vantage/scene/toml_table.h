// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "vantage/base/options.h"
#include "vantage/base/result.h"

/// Internal to the scene module: TOML with errors of one form,
///   "file:line: key: what is wrong; what is allowed".

namespace vantage::internal {

struct TomlValue;
using TomlArray = std::vector<TomlValue>;
using TomlEntries = std::map<std::string, TomlValue, std::less<>>;
/// A TOML date or time; no key of ours takes one.
struct TomlDate {};

struct TomlValue {
  std::variant<bool, std::int64_t, double, std::string, TomlDate, TomlArray, TomlEntries> value;
  int line = 0;
};

/// Parses a file's text; the result holds TomlEntries.
Result<TomlValue> ParseToml(const std::string& file, std::string_view text);

/// The allowed name most like `name` (at most two edits away), for "did you mean".
std::optional<std::string> NearestName(std::string_view name,
                                       const std::vector<std::string_view>& allowed);

/// Typed, checked access to one table. Refers to its file's name and value: both must outlive it.
class TableReader {
 public:
  /// `path` is the table's key as in messages, empty for the whole file.
  TableReader(const std::string& file, std::string path, const TomlValue& table);

  /// Fails on a key that is not among these, naming them.
  Status AllowOnly(const std::vector<std::string_view>& keys) const;

  bool Has(std::string_view key) const { return Find(key) != nullptr; }
  bool HasText(std::string_view key) const;
  Result<double> Number(std::string_view key, const Range& range, std::string_view unit = "") const;
  /// A number within `range`, or the text `word`, which gives nullopt.
  Result<std::optional<double>> NumberOr(std::string_view key, std::string_view word,
                                         const Range& range, std::string_view unit = "") const;
  Result<std::int64_t> Integer(std::string_view key, std::int64_t low, std::int64_t high) const;
  Result<bool> Flag(std::string_view key) const;
  /// Not empty.
  Result<std::string> Text(std::string_view key) const;
  /// An array of numbers, as many as one of `counts` says; any number of them when it is empty.
  Result<std::vector<double>> Numbers(std::string_view key,
                                      std::initializer_list<std::size_t> counts) const;
  /// An array of pairs of numbers, or of triples and so on, in row order.
  Result<std::vector<std::vector<double>>> Rows(std::string_view key, std::size_t columns) const;
  /// An array of arrays of pairs of numbers.
  Result<std::vector<std::vector<std::vector<double>>>> ListOfRows(std::string_view key,
                                                                   std::size_t columns) const;
  Result<TableReader> Table(std::string_view key) const;
  /// An array of tables ([[key]]).
  Result<std::vector<TableReader>> Tables(std::string_view key) const;

  /// Sets every option that the table gives; fails on keys that are no options.
  Status Bind(const std::function<void(OptionVisitor&)>& visit) const;

  /// An error at a key (at the table itself when it is absent): "file:line: path.key: message".
  tl::unexpected<Error> FailAt(std::string_view key, std::string_view message) const;

 private:
  const TomlValue* Find(std::string_view key) const;
  Result<const TomlValue*> Need(std::string_view key) const;
  std::string PathOf(std::string_view key) const;
  Result<std::vector<double>> NumbersOf(std::string_view key, const TomlValue& value) const;
  Result<std::vector<std::vector<double>>> RowsOf(std::string_view key, const TomlValue& value,
                                                  std::size_t columns) const;

  const std::string* file_;
  std::string path_;
  const TomlEntries* entries_;
  int line_;
};

}  // namespace vantage::internal
