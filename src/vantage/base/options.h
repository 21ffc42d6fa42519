// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vantage/base/result.h"

/// One list per options struct serves everything that must know its fields: validation, TOML
/// tables, command-line flags with their help, and the record of a run. A stage writes, beside its
/// struct,
///
///   void VisitOptions(MixtureOptions& options, OptionVisitor& visitor);
///
/// and calls `visitor.Number(...)`, `visitor.NumberOr(...)`, `visitor.Choice(...)` or
/// `visitor.Flag(...)` once per field.

namespace vantage {

/// The inequality that a number must satisfy. Values that are not finite never do.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;
  bool high_open = false;

  static Range AtLeast(double low) { return {.low = low}; }
  static Range Above(double low) { return {.low = low, .low_open = true}; }
  static Range Between(double low, double high) { return {.low = low, .high = high}; }
  /// low < value <= high
  static Range AboveUpTo(double low, double high) {
    return {.low = low, .high = high, .low_open = true};
  }
  /// low < value < high
  static Range Inside(double low, double high) {
    return {.low = low, .high = high, .low_open = true, .high_open = true};
  }

  bool Contains(double value) const;
  /// E.g. "at least 0", "above 0 and at most 1".
  std::string Text() const;
};

struct OptionInfo {
  std::string_view name;  ///< snake_case, as in the TOML table
  std::string_view unit;  ///< "m", "px", "s", "frames"; empty for pure numbers
  std::string_view help;  ///< one line, no full stop
};

class OptionVisitor {
 public:
  virtual ~OptionVisitor() = default;

  virtual void Flag(const OptionInfo& info, bool& value) = 0;
  virtual void Number(const OptionInfo& info, int& value, const Range& range) = 0;
  virtual void Number(const OptionInfo& info, double& value, const Range& range) = 0;
  /// A number that may also be said by a word, which stands for nullopt: "auto" for what is found
  /// from the data. The word must not be a number. Every value that is a number keeps to `range`.
  virtual void NumberOr(const OptionInfo& info, std::optional<int>& value, std::string_view word,
                        const Range& range) = 0;
  virtual void NumberOr(const OptionInfo& info, std::optional<double>& value, std::string_view word,
                        const Range& range) = 0;

  /// An enum by the names that users type.
  template <class Enum>
  void Choice(const OptionInfo& info, Enum& value,
              std::initializer_list<std::pair<std::string_view, Enum>> names) {
    std::vector<std::string_view> texts;
    int index = -1;
    for (const auto& [text, candidate] : names) {
      if (candidate == value) index = static_cast<int>(texts.size());
      texts.push_back(text);
    }
    ChoiceIndex(info, index, texts);
    if (index >= 0 && index < static_cast<int>(texts.size()))
      value = (names.begin() + index)->second;
  }

 protected:
  /// `index` into `names`, -1 when the current value has no name; a visitor may change it.
  virtual void ChoiceIndex(const OptionInfo& info, int& index,
                           const std::vector<std::string_view>& names) = 0;
};

namespace internal {
class OptionValidator final : public OptionVisitor {
 public:
  explicit OptionValidator(std::string_view prefix) : prefix_(prefix) {}
  void Flag(const OptionInfo&, bool&) override {}
  void Number(const OptionInfo& info, int& value, const Range& range) override;
  void Number(const OptionInfo& info, double& value, const Range& range) override;
  void NumberOr(const OptionInfo& info, std::optional<int>& value, std::string_view word,
                const Range& range) override;
  void NumberOr(const OptionInfo& info, std::optional<double>& value, std::string_view word,
                const Range& range) override;
  Status status;

 protected:
  void ChoiceIndex(const OptionInfo& info, int& index,
                   const std::vector<std::string_view>& names) override;

 private:
  std::string prefix_;
};

class OptionRecorder final : public OptionVisitor {
 public:
  explicit OptionRecorder(nlohmann::ordered_json& json) : json_(json) {}
  void Flag(const OptionInfo& info, bool& value) override;
  void Number(const OptionInfo& info, int& value, const Range& range) override;
  void Number(const OptionInfo& info, double& value, const Range& range) override;
  void NumberOr(const OptionInfo& info, std::optional<int>& value, std::string_view word,
                const Range& range) override;
  void NumberOr(const OptionInfo& info, std::optional<double>& value, std::string_view word,
                const Range& range) override;

 protected:
  void ChoiceIndex(const OptionInfo& info, int& index,
                   const std::vector<std::string_view>& names) override;

 private:
  nlohmann::ordered_json& json_;
};
}  // namespace internal

/// Checks every field; the message names field, value and rule,
/// e.g. "background.gaussians is 9; it must be between 1 and 8".
template <class Options>
Status ValidateOptions(const Options& options, std::string_view prefix) {
  Options copy = options;
  internal::OptionValidator validator(prefix);
  VisitOptions(copy, validator);
  return validator.status;
}

/// Writes every field into `json` (an object).
template <class Options>
void RecordOptions(const Options& options, nlohmann::ordered_json& json) {
  Options copy = options;
  internal::OptionRecorder recorder(json);
  VisitOptions(copy, recorder);
}

}  // namespace vantage
