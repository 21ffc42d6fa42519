// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/pom_file.h"

#include <algorithm>
#include <optional>
#include <type_traits>
#include <utility>

#include "vantage/base/file.h"
#include "vantage/base/text.h"

namespace vantage {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t kMaxSide = 32768;
constexpr std::int64_t kMaxCameras = 1024;
constexpr std::int64_t kMaxCells = 4'000'000;
constexpr std::int64_t kMaxRectangles = 20'000'000;
constexpr std::int64_t kMaxNumber = 1'000'000'000;
constexpr std::int64_t kMaxFrames = 10'000'000;

/// Words of a line: separated by blanks, tabs or commas, or in double quotes.
std::vector<std::string_view> Words(std::string_view line) {
  constexpr std::string_view kBlanks = " \t,\r";
  std::vector<std::string_view> words;
  std::size_t at = line.find_first_not_of(kBlanks);
  while (at != std::string_view::npos) {
    const bool quoted = line[at] == '"';
    if (quoted) ++at;
    const std::size_t end =
        std::min(quoted ? line.find('"', at) : line.find_first_of(kBlanks, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kBlanks, std::min(end + (quoted ? 1 : 0), line.size()));
  }
  return words;
}

/// The format with %c and %f replaced by camera and frame, without padding.
std::string Expand(std::string_view format, int camera, std::int64_t frame) {
  std::string name;
  for (std::size_t i = 0; i < format.size(); ++i) {
    const std::string_view field = format.substr(i, 2);
    if (field == "%c" || field == "%f") {
      name += std::to_string(field == "%c" ? camera : frame);
      ++i;
    } else {
      name += format[i];
    }
  }
  return name;
}

class Parser {
 public:
  explicit Parser(const fs::path& path) { file_.path = path; }

  Result<PomFile> Parse(std::string_view text) {
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      const std::string_view line = text.substr(0, end);
      text.remove_prefix(std::min(end + 1, text.size()));
      ++line_;
      words_ = Words(line);
      if (words_.empty() || words_[0].starts_with('#')) continue;
      VANTAGE_RETURN_IF_ERROR(Line());
    }
    VANTAGE_RETURN_IF_ERROR(CheckComplete());
    return std::move(file_);
  }

 private:
  template <class... Args>
  tl::unexpected<Error> FailHere(fmt::format_string<Args...> format, Args&&... args) const {
    return Fail("{}:{}: {}", file_.path.string(), line_,
                fmt::format(format, std::forward<Args>(args)...));
  }

  Status Line() {
    const std::string_view keyword = words_[0];
    OccupancyOptions& o = file_.options;
    if (keyword == "PROCESS") return Process();
    if (!file_.frames.empty()) {
      return FailHere("{} comes after PROCESS; put PROCESS last", keyword);
    }
    if (keyword == "ROOM") return Room();
    if (keyword == "CAMERA") return CameraLine();
    if (keyword == "RECTANGLE") return Rectangle();
    if (keyword == "INPUT_VIEW_FORMAT") return Format(file_.input_format, "cf");
    if (keyword == "RESULT_FORMAT") return Format(file_.result_format, "f");
    if (keyword == "RESULT_VIEW_FORMAT" || keyword == "CONVERGENCE_VIEW_FORMAT") {
      std::string left_out;
      return Format(left_out, "cfi");
    }
    if (keyword == "PRIOR") return Option(o.prior);
    if (keyword == "SIGMA_IMAGE_DENSITY") return Option(o.variance);
    if (keyword == "SMOOTHING_COEFFICIENT") return Option(o.smoothing);
    if (keyword == "MAX_NB_SOLVER_ITERATIONS") return Option(o.max_iterations);
    if (keyword == "ERROR_MAX") return Option(o.tolerance);
    if (keyword == "NB_STABLE_ERROR_FOR_CONVERGENCE") return Option(o.stable_iterations);
    if (keyword == "PROBA_IGNORED") return Option(o.ignored);
    return FailHere("unknown keyword '{}'", keyword);
  }

  Status Arguments(std::size_t count) const {
    if (words_.size() == count + 1) return {};
    return FailHere("{} has {} values; it needs {}", words_[0], words_.size() - 1, count);
  }

  template <class T>
  Status Number(std::size_t word, const char* name, T& value) const {
    const std::string_view text = words_[word];
    if (ParseNumber(text, value)) return {};
    return FailHere("{} of {} is '{}'; it must be {}", name, words_[0], text,
                    std::is_integral_v<T> ? "a whole number" : "a number");
  }

  Status Whole(std::size_t word, const char* name, std::int64_t low, std::int64_t high,
               std::int64_t& value) const {
    VANTAGE_RETURN_IF_ERROR(Number(word, name, value));
    if (value >= low && value <= high) return {};
    return FailHere("{} of {} is {}; it must be between {} and {}", name, words_[0], value, low,
                    high);
  }

  template <class T>
  Status Option(T& value) {
    VANTAGE_RETURN_IF_ERROR(Arguments(1));
    VANTAGE_RETURN_IF_ERROR(Number(1, "the value", value));
    if (Status status = ValidateOptions(file_.options, "occupancy"); !status) {
      return FailHere("{}: {}", words_[0], status.error().message);
    }
    return {};
  }

  Status Format(std::string& format, std::string_view fields) {
    VANTAGE_RETURN_IF_ERROR(Arguments(1));
    format = words_[1];
    for (std::size_t at = format.find('%'); at != std::string::npos;
         at = format.find('%', at + 1)) {
      if (at + 1 == format.size() || fields.find(format[at + 1]) == std::string_view::npos) {
        return FailHere("{} has a '%' that is not followed by one of '{}'", words_[0], fields);
      }
    }
    return {};
  }

  Status Room() {
    VANTAGE_RETURN_IF_ERROR(Arguments(4));
    if (cells_ != 0) return FailHere("ROOM is given a second time");
    std::int64_t width = 0, height = 0, cameras = 0;
    const bool sizes_follow = words_[1] == "-1" && words_[2] == "-1";
    if (!sizes_follow) {
      VANTAGE_RETURN_IF_ERROR(Whole(1, "the width", 1, kMaxSide, width));
      VANTAGE_RETURN_IF_ERROR(Whole(2, "the height", 1, kMaxSide, height));
    }
    VANTAGE_RETURN_IF_ERROR(Whole(3, "the number of cameras", 1, kMaxCameras, cameras));
    VANTAGE_RETURN_IF_ERROR(Whole(4, "the number of cells", 1, kMaxCells, cells_));
    if (cameras * cells_ > kMaxRectangles) {
      return FailHere("{} cameras times {} cells are more than {} rectangles", cameras, cells_,
                      kMaxRectangles);
    }
    cameras_ = static_cast<std::size_t>(cameras);
    for (int c = 0; !sizes_follow && c < cameras; ++c) {
      AddCamera(c, {static_cast<int>(width), static_cast<int>(height)});
    }
    sizes_follow_ = sizes_follow;
    return {};
  }

  void AddCamera(int number, ImageSize size) {
    file_.camera_numbers.push_back(number);
    file_.views.push_back({size, size, std::vector<cv::Rect>(static_cast<std::size_t>(cells_))});
  }

  Status CameraLine() {
    VANTAGE_RETURN_IF_ERROR(Arguments(3));
    if (!sizes_follow_) return FailHere("CAMERA needs ROOM -1 -1 cameras cells before it");
    if (file_.views.size() == cameras_) return FailHere("ROOM announces {} cameras only", cameras_);
    std::int64_t number = 0, width = 0, height = 0;
    VANTAGE_RETURN_IF_ERROR(Whole(1, "the number", 0, kMaxNumber, number));
    VANTAGE_RETURN_IF_ERROR(Whole(2, "the width", 1, kMaxSide, width));
    VANTAGE_RETURN_IF_ERROR(Whole(3, "the height", 1, kMaxSide, height));
    if (CameraOf(number)) return FailHere("camera {} is given a second time", number);
    AddCamera(static_cast<int>(number), {static_cast<int>(width), static_cast<int>(height)});
    return {};
  }

  std::optional<std::size_t> CameraOf(std::int64_t number) const {
    const auto& numbers = file_.camera_numbers;
    const auto found = std::find(numbers.begin(), numbers.end(), number);
    if (found == numbers.end()) return std::nullopt;
    return static_cast<std::size_t>(found - numbers.begin());
  }

  Status Rectangle() {
    if (cells_ == 0) return FailHere("RECTANGLE comes before ROOM");
    const bool not_visible = words_.size() == 4 && words_[3] == "notvisible";
    if (!not_visible) VANTAGE_RETURN_IF_ERROR(Arguments(6));
    std::int64_t number = 0, cell = 0;
    VANTAGE_RETURN_IF_ERROR(Number(1, "the camera", number));
    VANTAGE_RETURN_IF_ERROR(Whole(2, "the cell", 0, cells_ - 1, cell));
    const auto camera = CameraOf(number);
    if (!camera) return FailHere("there is no camera {}", number);
    CameraView& view = file_.views[*camera];
    cv::Rect& rectangle = view.rectangles[static_cast<std::size_t>(cell)];
    rectangle = cv::Rect();
    if (not_visible) return {};
    std::int64_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    VANTAGE_RETURN_IF_ERROR(Whole(3, "xmin", 0, view.size.width - 1, x0));
    VANTAGE_RETURN_IF_ERROR(Whole(4, "ymin", 0, view.size.height - 1, y0));
    VANTAGE_RETURN_IF_ERROR(Whole(5, "xmax", x0, view.size.width - 1, x1));
    VANTAGE_RETURN_IF_ERROR(Whole(6, "ymax", y0, view.size.height - 1, y1));
    rectangle = cv::Rect(static_cast<int>(x0), static_cast<int>(y0), static_cast<int>(x1 - x0 + 1),
                         static_cast<int>(y1 - y0 + 1));
    return {};
  }

  Status Process() {
    VANTAGE_RETURN_IF_ERROR(Arguments(2));
    PomFile::Frames frames;
    VANTAGE_RETURN_IF_ERROR(Whole(1, "the first frame", 0, kMaxNumber, frames.first));
    VANTAGE_RETURN_IF_ERROR(Whole(2, "the number of frames", 1, frames_left_, frames.count));
    frames_left_ -= frames.count;
    file_.frames.push_back(frames);
    return {};
  }

  Status CheckComplete() const {
    const std::string name = file_.path.string();
    if (cells_ == 0) return Fail("{}: no ROOM line; not a configuration of the POM program", name);
    if (file_.views.size() != cameras_) {
      return Fail("{}: ROOM announces {} cameras; {} have a CAMERA line", name, cameras_,
                  file_.views.size());
    }
    if (file_.input_format.empty()) return Fail("{}: no INPUT_VIEW_FORMAT line", name);
    if (file_.result_format.empty()) {
      return Fail("{}: no RESULT_FORMAT line; nothing would be written", name);
    }
    if (file_.frames.empty()) return Fail("{}: no PROCESS line; nothing would be done", name);
    const bool one_frame = file_.frames.size() == 1 && file_.frames[0].count == 1;
    if (!one_frame && file_.result_format.find("%f") == std::string::npos) {
      return Fail("{}: RESULT_FORMAT has no %f; each frame would overwrite the one before", name);
    }
    return {};
  }

  PomFile file_;
  int line_ = 0;
  std::vector<std::string_view> words_;
  bool sizes_follow_ = false;
  std::size_t cameras_ = 0;
  std::int64_t cells_ = 0;
  std::int64_t frames_left_ = kMaxFrames;
};

}  // namespace

fs::path PomFile::InputPath(std::size_t camera, std::int64_t frame) const {
  return path.parent_path() / Expand(input_format, camera_numbers[camera], frame);
}

fs::path PomFile::ResultPath(std::int64_t frame, const fs::path& folder) const {
  const fs::path name = Expand(result_format, 0, frame);
  return folder.empty() ? path.parent_path() / name : folder / name.relative_path();
}

Result<PomFile> ReadPomFile(const fs::path& path) {
  VANTAGE_ASSIGN_OR_RETURN(const std::string text, ReadTextFile(path));
  return Parser(path).Parse(text);
}

}  // namespace vantage
