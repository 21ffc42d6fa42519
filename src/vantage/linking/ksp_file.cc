// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/ksp_file.h"

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>

#include "vantage/base/file.h"
#include "vantage/base/text.h"

namespace vantage {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t kMaxSide = 32768;
constexpr std::int64_t kMaxNodes = std::int64_t{1} << 27;  // as LinkPaths takes
constexpr std::int64_t kMaxDepth = 10;
constexpr std::int64_t kMaxFrame = 1'000'000'000;
constexpr std::int64_t kMaxPaths = 1'000'000'000;
constexpr int kMaxDigits = 20;

/// Words of a line: separated by blanks and by `separators`.
std::vector<std::string_view> Words(std::string_view line, std::string_view separators = " \t\r") {
  std::vector<std::string_view> words;
  std::size_t at = line.find_first_not_of(separators);
  while (at != std::string_view::npos) {
    const std::size_t end = std::min(line.find_first_of(separators, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(separators, end);
  }
  return words;
}

/// The field of a frame's number in a file name, as printf has it: %d, %6d or %06d.
struct NumberField {
  std::size_t end = 0;  ///< one beyond its 'd'
  int width = 0;
  bool zeros = false;
};

/// The field that begins with the '%' at `begin`; false when there is none.
bool ReadField(std::string_view format, std::size_t begin, NumberField& field) {
  std::size_t at = begin + 1;
  field.zeros = at < format.size() && format[at] == '0';
  while (at < format.size() && format[at] >= '0' && format[at] <= '9') {
    field.width = std::min(10 * field.width + (format[at] - '0'), kMaxDigits + 1);
    ++at;
  }
  field.end = at + 1;
  return at < format.size() && format[at] == 'd' && field.width <= kMaxDigits;
}

class Parser {
 public:
  explicit Parser(const fs::path& path) { file_.path = path; }

  Result<KspFile> Parse(std::string_view text) {
    VANTAGE_RETURN_IF_ERROR(ForEachLine(text, [this](std::string_view line, std::size_t number) {
      line_ = number;
      words_ = Words(line);
      return words_.empty() || words_[0].starts_with('#') ? Status() : Line(line);
    }));
    VANTAGE_RETURN_IF_ERROR(CheckComplete());
    return std::move(file_);
  }

 private:
  template <class... Args>
  tl::unexpected<Error> FailHere(fmt::format_string<Args...> format, Args&&... args) const {
    return Fail("{}:{}: {}", file_.path.string(), line_,
                fmt::format(format, std::forward<Args>(args)...));
  }

  Status Line(std::string_view line) {
    const std::string_view keyword = words_[0];
    if (keyword == "ACCESS_POINTS") return AccessPoints(line.substr(keyword.size()));
    if (!given_.insert(std::string(keyword)).second) {
      return FailHere("{} is given a second time", keyword);
    }
    if (keyword == "GRID") return Grid();
    if (keyword == "FRAMES") return Frames();
    if (keyword == "DEPTH") return Single("the depth", 0, kMaxDepth, file_.depth);
    if (keyword == "MAX_TRAJ") return Single("the number of paths", 1, kMaxPaths, file_.max_paths);
    if (keyword == "INPUT_FORMAT") return InputFormat();
    return FailHere(
        "unknown keyword '{}'; there are GRID, FRAMES, ACCESS_POINTS, DEPTH, MAX_TRAJ and "
        "INPUT_FORMAT",
        keyword);
  }

  Status Arguments(std::size_t count) const {
    if (words_.size() == count + 1) return {};
    return FailHere("{} has {} values; it needs {}", words_[0], words_.size() - 1, count);
  }

  template <class T>
  Status Whole(std::string_view text, const char* name, std::int64_t low, std::int64_t high,
               T& value) const {
    std::int64_t number = 0;
    if (!ParseNumber(text, number) || number < low || number > high) {
      return FailHere("{} of {} is '{}'; it must be a whole number from {} to {}", name, words_[0],
                      text, low, high);
    }
    value = static_cast<T>(number);
    return {};
  }

  template <class T>
  Status Single(const char* name, std::int64_t low, std::int64_t high, T& value) const {
    VANTAGE_RETURN_IF_ERROR(Arguments(1));
    return Whole(words_[1], name, low, high, value);
  }

  Status Grid() {
    VANTAGE_RETURN_IF_ERROR(Arguments(2));
    VANTAGE_RETURN_IF_ERROR(Whole(words_[1], "the width", 1, kMaxSide, file_.columns));
    return Whole(words_[2], "the height", 1, kMaxSide, file_.rows);
  }

  Status Frames() {
    VANTAGE_RETURN_IF_ERROR(Arguments(2));
    VANTAGE_RETURN_IF_ERROR(Whole(words_[1], "the first frame", 0, kMaxFrame, file_.first_frame));
    return Whole(words_[2], "the last frame", file_.first_frame, kMaxFrame, file_.last_frame);
  }

  /// May precede GRID and be repeated: the cells add up.
  Status AccessPoints(std::string_view list) {
    const std::vector<std::string_view> cells = Words(list, " \t\r,");
    if (cells.empty()) return FailHere("ACCESS_POINTS names no cell; leave the line out");
    for (const std::string_view cell : cells) {
      CellIndex index = 0;
      VANTAGE_RETURN_IF_ERROR(Whole(cell, "a cell", 0, kMaxNodes, index));
      file_.access_points.push_back(index);
      if (index >= largest_access_point_) {
        largest_access_point_ = index;
        line_of_largest_ = line_;
      }
    }
    return {};
  }

  Status InputFormat() {
    VANTAGE_RETURN_IF_ERROR(Arguments(1));
    file_.input_format = words_[1];
    const std::string_view format = file_.input_format;
    int fields = 0;
    for (std::size_t at = format.find('%'); at != std::string_view::npos;) {
      NumberField field;
      if (format.substr(at, 2) == "%%") {
        field.end = at + 2;
      } else if (ReadField(format, at, field)) {
        ++fields;
      } else {
        return FailHere("INPUT_FORMAT has a '%' that begins neither %d, %06d nor %%");
      }
      at = format.find('%', field.end);
    }
    if (fields == 1) return {};
    return FailHere("INPUT_FORMAT has {} fields %d; it needs one, for the frame", fields);
  }

  Status CheckComplete() const {
    for (const char* keyword : {"GRID", "FRAMES", "INPUT_FORMAT"}) {
      if (!given_.contains(keyword)) {
        return Fail("{}: no {} line; a configuration of the KSP program has one",
                    file_.path.string(), keyword);
      }
    }
    if (largest_access_point_ >= file_.cell_count()) {
      return Fail("{}:{}: cell {} of ACCESS_POINTS is outside the grid; cells are 0 to {}",
                  file_.path.string(), line_of_largest_, largest_access_point_,
                  file_.cell_count() - 1);
    }
    if (file_.frame_count() > kMaxNodes / file_.cell_count()) {
      return Fail("{}: {} frames of {} x {} cells are more than 2^27 nodes; lower FRAMES",
                  file_.path.string(), file_.frame_count(), file_.columns, file_.rows);
    }
    return {};
  }

  KspFile file_;
  std::size_t line_ = 0;
  std::vector<std::string_view> words_;
  std::set<std::string> given_;
  CellIndex largest_access_point_ = -1;
  std::size_t line_of_largest_ = 0;
};

/// Appends the probabilities of one frame.
Status ReadFrame(const fs::path& path, const KspFile& file, std::vector<float>& maps) {
  VANTAGE_ASSIGN_OR_RETURN(const std::string text, ReadTextFile(path));
  std::int64_t cells = 0;
  VANTAGE_RETURN_IF_ERROR(
      ForEachLine(text, [&](std::string_view line, std::size_t number) -> Status {
        const std::vector<std::string_view> words = Words(line);
        if (words.empty()) return {};
        const auto fail = [&](const std::string& what) {
          return Fail("{}:{}: {}", path.string(), number, what);
        };
        if (++cells > file.cell_count()) {
          return fail(fmt::format("more lines than the {} cells of GRID in {}", file.cell_count(),
                                  file.path.string()));
        }
        std::int64_t index = 0;
        if (words.size() != 2 || !ParseNumber(words[0], index)) {
          return fail("must have the number of a cell and its probability");
        }
        double probability = 0;
        if (!ParseNumber(words[1], probability) || !(probability >= 0 && probability <= 1)) {
          return fail(
              fmt::format("the probability is '{}'; it must be a number from 0 to 1", words[1]));
        }
        maps.push_back(static_cast<float>(probability));
        return {};
      }));
  if (cells == file.cell_count()) return {};
  return Fail("{}: has {} lines; it needs one for each of the {} cells of GRID in {}",
              path.string(), cells, file.cell_count(), file.path.string());
}

}  // namespace

fs::path KspFile::InputPath(std::int64_t frame) const {
  std::string name;
  for (std::size_t at = 0; at < input_format.size();) {
    NumberField field;
    if (input_format[at] != '%') {
      name += input_format[at++];
    } else if (ReadField(input_format, at, field)) {
      name += field.zeros ? fmt::format("{:0{}}", frame, field.width)
                          : fmt::format("{:{}}", frame, field.width);
      at = field.end;
    } else {
      name += '%';
      at += 2;
    }
  }
  return path.parent_path() / name;
}

Result<KspFile> ReadKspFile(const fs::path& path) {
  VANTAGE_ASSIGN_OR_RETURN(const std::string text, ReadTextFile(path));
  return Parser(path).Parse(text);
}

Result<std::vector<float>> ReadKspMaps(const KspFile& file, const RunControl& control) {
  std::vector<float> maps;
  for (std::int64_t frame = file.first_frame; frame <= file.last_frame; ++frame) {
    if (control.Stopped()) return Cancelled();
    VANTAGE_RETURN_IF_ERROR(ReadFrame(file.InputPath(frame), file, maps));
  }
  return maps;
}

}  // namespace vantage
