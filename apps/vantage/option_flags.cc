// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "command.h"

namespace vantage::app {
namespace {

using FlagMap = std::map<std::string, CLI::Option*, std::less<>>;

std::string FlagName(const std::string& prefix, std::string_view name) {
  std::string flag = "--" + prefix + std::string(name);
  std::replace(flag.begin(), flag.end(), '_', '-');
  return flag;
}

std::string Help(const OptionInfo& info, const std::string& rule) {
  std::string help(info.help);
  if (!info.unit.empty()) help += fmt::format(" [{}]", info.unit);
  if (!rule.empty()) help += "; " + rule;
  return help;
}

class FlagAdder final : public OptionVisitor {
 public:
  FlagAdder(CLI::App& app, std::string prefix, std::string group, FlagMap& flags)
      : app_(app), prefix_(std::move(prefix)), group_(std::move(group)), flags_(flags) {}

  void Flag(const OptionInfo& info, bool& value) override {
    const std::string name = FlagName(prefix_, info.name);
    CLI::Option* option = app_.add_flag(fmt::format("{},!--no-{}", name, name.substr(2)));
    Keep(info, option, Help(info, ""), value ? "on" : "off");
  }
  void Number(const OptionInfo& info, int& value, const Range& range) override {
    AddNumber<int>(info, fmt::to_string(value), range);
  }
  void Number(const OptionInfo& info, double& value, const Range& range) override {
    AddNumber<double>(info, fmt::to_string(value), range);
  }
  void NumberOr(const OptionInfo& info, std::optional<int>& value, std::string_view word,
                const Range& range) override {
    AddNumber<int>(info, value ? fmt::to_string(*value) : std::string(word), range, word);
  }
  void NumberOr(const OptionInfo& info, std::optional<double>& value, std::string_view word,
                const Range& range) override {
    AddNumber<double>(info, value ? fmt::to_string(*value) : std::string(word), range, word);
  }

 protected:
  void ChoiceIndex(const OptionInfo& info, int& index,
                   const std::vector<std::string_view>& names) override {
    const std::vector<std::string> texts(names.begin(), names.end());
    CLI::Option* option = AddValue(info, "TEXT");
    option->check(CLI::IsMember(texts));
    Keep(info, option, Help(info, ""), index >= 0 ? texts[static_cast<std::size_t>(index)] : "");
  }

 private:
  /// `word` is what may stand in place of the number; empty: nothing may.
  template <class T>
  void AddNumber(const OptionInfo& info, const std::string& standard, const Range& range,
                 std::string_view word = "") {
    CLI::Option* option = AddValue(info, word.empty() ? "NUMBER" : fmt::format("NUMBER|{}", word));
    const std::string rule =
        word.empty() ? range.Text() : fmt::format("{}, or {}", range.Text(), word);
    option->check([range, rule, word = std::string(word)](const std::string& text) -> std::string {
      if (!word.empty() && text == word) return "";
      T number{};
      if (!CLI::detail::lexical_cast(text, number)) {
        return word.empty() ? fmt::format("'{}' is not a number", text)
                            : fmt::format("'{}' is neither a number nor {}", text, word);
      }
      if (range.Contains(static_cast<double>(number))) return "";
      return fmt::format("is {}; it must be {}", text, rule);
    });
    Keep(info, option, Help(info, rule), standard);
  }

  /// An option of one value that CLI11 only keeps: FlagSetter reads it.
  CLI::Option* AddValue(const OptionInfo& info, const std::string& type) {
    CLI::Option* option =
        app_.add_option(FlagName(prefix_, info.name), [](const CLI::results_t&) { return true; });
    return option->type_name(type)->type_size(1)->expected(1);
  }

  void Keep(const OptionInfo& info, CLI::Option* option, const std::string& help,
            const std::string& standard) {
    option->group(group_)->description(help)->default_str(standard);
    flags_[std::string(info.name)] = option;
  }

  CLI::App& app_;
  std::string prefix_, group_;
  FlagMap& flags_;
};

class FlagSetter final : public OptionVisitor {
 public:
  explicit FlagSetter(const FlagMap& flags) : flags_(flags) {}

  void Flag(const OptionInfo& info, bool& value) override { Set(info, value); }
  void Number(const OptionInfo& info, int& value, const Range&) override { Set(info, value); }
  void Number(const OptionInfo& info, double& value, const Range&) override { Set(info, value); }
  void NumberOr(const OptionInfo& info, std::optional<int>& value, std::string_view word,
                const Range&) override {
    SetOr(info, value, word);
  }
  void NumberOr(const OptionInfo& info, std::optional<double>& value, std::string_view word,
                const Range&) override {
    SetOr(info, value, word);
  }

 protected:
  void ChoiceIndex(const OptionInfo& info, int& index,
                   const std::vector<std::string_view>& names) override {
    std::string text;
    Set(info, text);
    if (!text.empty()) {
      index = static_cast<int>(std::find(names.begin(), names.end(), text) - names.begin());
    }
  }

 private:
  template <class T>
  void Set(const OptionInfo& info, T& value) const {
    const auto flag = flags_.find(info.name);
    if (flag != flags_.end() && flag->second->count() > 0) value = flag->second->as<T>();
  }
  template <class T>
  void SetOr(const OptionInfo& info, std::optional<T>& value, std::string_view word) const {
    std::string text;
    Set(info, text);
    if (text == word) {
      value.reset();
    } else if (!text.empty()) {
      T number{};
      Set(info, number);
      value = number;
    }
  }
  const FlagMap& flags_;
};

}  // namespace

OptionFlags OptionFlags::Add(CLI::App& app, const Visit& visit, const std::string& prefix,
                             const std::string& group) {
  OptionFlags flags;
  FlagAdder adder(app, prefix, group, flags.flags_);
  visit(adder);
  return flags;
}

std::string OptionFlags::AnyGiven() const {
  for (const auto& [name, flag] : flags_) {
    if (flag->count() > 0) return flag->get_name();
  }
  return "";
}

void OptionFlags::Apply(const Visit& visit) const {
  FlagSetter setter(flags_);
  visit(setter);
}

}  // namespace vantage::app
