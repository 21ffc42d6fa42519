// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <memory>

#include "command.h"

namespace vantage::app {
namespace {

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

class FlagVisitor final : public OptionVisitor {
 public:
  FlagVisitor(CLI::App& app, std::string prefix, std::string group,
              std::function<void(OptionVisitor&)> visit)
      : app_(app), prefix_(std::move(prefix)), group_(std::move(group)), visit_(std::move(visit)) {}

  void Flag(const OptionInfo& info, bool& value) override {
    const std::string name = FlagName(prefix_, info.name);
    app_.add_flag(fmt::format("{},!--no-{}", name, name.substr(2)), value, Help(info, ""))
        ->capture_default_str()
        ->group(group_);
  }
  void Number(const OptionInfo& info, int& value, const Range& range) override {
    AddNumber(info, value, range);
  }
  void Number(const OptionInfo& info, double& value, const Range& range) override {
    AddNumber(info, value, range);
  }

 protected:
  void ChoiceIndex(const OptionInfo& info, int& index,
                   const std::vector<std::string_view>& names) override;

 private:
  template <class T>
  void AddNumber(const OptionInfo& info, T& value, const Range& range) {
    app_.add_option(FlagName(prefix_, info.name), value, Help(info, range.Text()))
        ->check(CLI::Validator(
            [range](std::string& text) -> std::string {
              double number = 0;
              if (!CLI::detail::lexical_cast(text, number)) return "not a number: " + text;
              return range.Contains(number) ? "" : fmt::format("{} must be {}", text, range.Text());
            },
            ""))
        ->capture_default_str()
        ->group(group_);
  }

  CLI::App& app_;
  std::string prefix_, group_;
  std::function<void(OptionVisitor&)> visit_;
};

/// Sets one choice by name when its flag is given: the field itself is only reachable by a visit.
class ChoiceSetter final : public OptionVisitor {
 public:
  ChoiceSetter(std::string_view name, std::string_view value) : name_(name), value_(value) {}
  void Flag(const OptionInfo&, bool&) override {}
  void Number(const OptionInfo&, int&, const Range&) override {}
  void Number(const OptionInfo&, double&, const Range&) override {}

 protected:
  void ChoiceIndex(const OptionInfo& info, int& index,
                   const std::vector<std::string_view>& names) override {
    if (info.name != name_) return;
    index = static_cast<int>(std::find(names.begin(), names.end(), value_) - names.begin());
  }

 private:
  std::string name_, value_;
};

void FlagVisitor::ChoiceIndex(const OptionInfo& info, int& index,
                              const std::vector<std::string_view>& names) {
  std::vector<std::string> texts(names.begin(), names.end());
  const std::string current = index >= 0 ? texts[static_cast<size_t>(index)] : "";
  app_.add_option_function<std::string>(
          FlagName(prefix_, info.name),
          [visit = visit_, name = std::string(info.name)](const std::string& value) {
            ChoiceSetter setter(name, value);
            visit(setter);
          },
          Help(info, ""))
      ->check(CLI::IsMember(texts))
      ->default_str(current)
      ->group(group_);
}

}  // namespace

void AddOptionFlags(CLI::App& app, const std::function<void(OptionVisitor&)>& visit,
                    const std::string& prefix, const std::string& group) {
  FlagVisitor visitor(app, prefix, group, visit);
  visit(visitor);
}

}  // namespace vantage::app
