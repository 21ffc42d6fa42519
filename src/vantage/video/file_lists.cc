// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/video/file_lists.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>

#include "vantage/video/picture.h"

namespace vantage::internal {
namespace {

namespace fs = std::filesystem;

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

struct Pattern {
  std::string prefix, suffix;
  int width = 0;  ///< 0: no leading zeros

  std::string Name(std::int64_t number) const {
    return fmt::format("{}{:0{}}{}", prefix, number, width, suffix);
  }
};

Result<Pattern> ParsePattern(const fs::path& path) {
  const auto wrong = [&] {
    return Fail(
        "{}: not a pattern of numbered pictures; its last part must hold one %d or %0Nd "
        "(N from 1 to 18) and no other '%', e.g. frames/%06d.png",
        path.string());
  };
  const std::string name = path.filename().string();
  const std::size_t percent = name.find('%');
  if (percent == std::string::npos || path.parent_path().string().find('%') != std::string::npos) {
    return wrong();
  }
  Pattern pattern{.prefix = name.substr(0, percent), .suffix = ""};
  std::size_t at = percent + 1;
  if (at < name.size() && name[at] == '0') {
    const char* end = name.data() + name.size();
    const auto [stop, code] = std::from_chars(name.data() + at, end, pattern.width);
    if (code != std::errc() || pattern.width < 1 || pattern.width > 18) return wrong();
    at = static_cast<std::size_t>(stop - name.data());
  }
  if (at >= name.size() || name[at] != 'd') return wrong();
  pattern.suffix = name.substr(at + 1);
  if (pattern.suffix.find('%') != std::string::npos) return wrong();
  return pattern;
}

/// Number of a file that the pattern makes.
std::optional<std::int64_t> NumberOf(const Pattern& pattern, const std::string& name) {
  const std::size_t fixed = pattern.prefix.size() + pattern.suffix.size();
  if (name.size() <= fixed || !name.starts_with(pattern.prefix) ||
      !name.ends_with(pattern.suffix)) {
    return std::nullopt;
  }
  const char* begin = name.data() + pattern.prefix.size();
  const char* end = name.data() + name.size() - pattern.suffix.size();
  std::int64_t number = 0;
  const auto [stop, code] = std::from_chars(begin, end, number);
  if (code != std::errc() || stop != end || number < 0 || pattern.Name(number) != name) {
    return std::nullopt;
  }
  return number;
}

Result<std::vector<std::string>> NamesIn(const fs::path& folder) {
  std::error_code code;
  std::vector<std::string> names;
  fs::directory_iterator files(folder, code);
  for (; !code && files != fs::directory_iterator(); files.increment(code)) {
    names.push_back(files->path().filename().string());
  }
  if (code) return Fail("{}: this folder cannot be read: {}", folder.string(), code.message());
  return names;
}

/// Order by name with runs of digits by value; equal values by length, so that the order is total.
bool NaturalLess(std::string_view a, std::string_view b) {
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (!IsDigit(a[i]) || !IsDigit(b[j])) {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
      continue;
    }
    const auto run = [](std::string_view text, std::size_t& at) {
      while (at < text.size() && text[at] == '0') ++at;
      const std::size_t start = at;
      while (at < text.size() && IsDigit(text[at])) ++at;
      return text.substr(start, at - start);
    };
    const std::string_view number_a = run(a, i);
    const std::string_view number_b = run(b, j);
    if (number_a.size() != number_b.size()) return number_a.size() < number_b.size();
    if (number_a != number_b) return number_a < number_b;
  }
  if ((a.size() - i) != (b.size() - j)) return a.size() - i < b.size() - j;
  return a < b;
}

}  // namespace

Result<std::vector<fs::path>> ListNumbered(const fs::path& path) {
  VANTAGE_ASSIGN_OR_RETURN(const Pattern pattern, ParsePattern(path));
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  VANTAGE_ASSIGN_OR_RETURN(const std::vector<std::string> names, NamesIn(folder));
  std::vector<std::int64_t> numbers;
  for (const std::string& name : names) {
    if (const auto number = NumberOf(pattern, name)) numbers.push_back(*number);
  }
  if (numbers.empty()) return Fail("{}: no file has a name of this pattern", path.string());
  std::sort(numbers.begin(), numbers.end());
  std::vector<fs::path> files;
  for (const std::int64_t number : numbers) {
    const std::int64_t expected = numbers.front() + static_cast<std::int64_t>(files.size());
    if (number != expected) {
      return Fail(
          "{}: is missing; the pictures are numbered from {} to {} and none may be left out",
          (folder / pattern.Name(expected)).string(), numbers.front(), numbers.back());
    }
    files.push_back(folder / pattern.Name(number));
  }
  return files;
}

Result<std::vector<fs::path>> ListPictures(const fs::path& folder) {
  VANTAGE_ASSIGN_OR_RETURN(std::vector<std::string> names, NamesIn(folder));
  std::erase_if(names, [](const std::string& name) {
    return name.starts_with('.') || !HasPictureExtension(name);
  });
  if (names.empty()) {
    return Fail("{}: no picture in this folder (.png .jpg .jpeg .bmp .pgm .ppm)", folder.string());
  }
  std::sort(names.begin(), names.end(), NaturalLess);
  std::vector<fs::path> files;
  for (const std::string& name : names) files.push_back(folder / name);
  return files;
}

}  // namespace vantage::internal
