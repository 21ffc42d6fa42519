// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fuzz/driver.h"
#include "vantage/background/subtractor.h"
#include "vantage/base/test_support.h"
#include "vantage/video/open.h"

/// The background stage under random options, frames, held pixels and files. Whatever a camera or a
/// caller may give is either processed into a proper mask or refused with one line.

namespace vantage::fuzz {
namespace {

/// Sets some options, anywhere within their ranges; or one of them out of its range.
class RandomOptions final : public OptionVisitor {
 public:
  RandomOptions(Random& random, bool hostile)
      : random_(random), hostile_(hostile), changed_share_(0.1 * random.Int(0, 4)) {}

  void Flag(const OptionInfo&, bool& value) override {
    if (random_.Chance(changed_share_)) value = !value;
  }
  void Number(const OptionInfo&, int& value, const Range& range) override {
    if (hostile_ && std::isfinite(range.low)) {
      value = static_cast<int>(range.low) - 1;
      hostile_ = false;
      broken = true;
      return;
    }
    double number = value;
    Change(number, range, 1);
    value = static_cast<int>(std::lround(number));
  }
  void Number(const OptionInfo&, double& value, const Range& range) override {
    if (hostile_ && random_.Chance(0.1)) {
      value = random_.Chance(0.5) ? std::numeric_limits<double>::quiet_NaN()
                                  : -std::numeric_limits<double>::infinity();
      hostile_ = false;
      broken = true;
      return;
    }
    Change(value, range, 1e-6);
  }
  void NumberOr(const OptionInfo& info, std::optional<int>& value, std::string_view,
                const Range& range) override {
    ChangeOr(info, value, range);
  }
  void NumberOr(const OptionInfo& info, std::optional<double>& value, std::string_view,
                const Range& range) override {
    ChangeOr(info, value, range);
  }
  bool broken = false;

 protected:
  void ChoiceIndex(const OptionInfo&, int& index,
                   const std::vector<std::string_view>& names) override {
    if (random_.Chance(0.7)) index = random_.Int(0, static_cast<int>(names.size()) - 1);
  }

 private:
  template <class T>
  void ChangeOr(const OptionInfo& info, std::optional<T>& value, const Range& range) {
    T number = value.value_or(T{1});
    Number(info, number, range);
    value.reset();
    if (broken || random_.Chance(0.7)) value = number;
  }

  /// A bound, another size of the same order, or anywhere in the range.
  void Change(double& value, const Range& range, double step) {
    if (!random_.Chance(changed_share_)) return;
    const double low = std::isfinite(range.low) ? range.low + (range.low_open ? step : 0) : -1000;
    const double high =
        std::isfinite(range.high) ? range.high - (range.high_open ? step : 0) : low + 1000;
    switch (random_.Int(0, 3)) {
      case 0:
        value = low;
        break;
      case 1:
        value = high;
        break;
      case 2:
        value = std::clamp(value * std::exp2(random_.Real(-3, 3)), low, high);
        break;
      default:
        value = random_.Real(low, high);
    }
  }

  Random& random_;
  bool hostile_;
  double changed_share_;
};

ImageSize RandomSize(Random& random) {
  switch (random.Int(0, 7)) {
    case 0:
      return {1, 1};
    case 1:
      return {random.Int(1, 9), random.Int(1, 9)};
    case 2:
      return {random.Int(1, 200), 1};
    case 3:
      return {1, random.Int(1, 200)};
    default:
      return {random.Int(2, 120), random.Int(2, 90)};
  }
}

cv::Mat RandomMatrix(cv::Size size, int type, Random& random) {
  cv::Mat matrix(size, type);
  cv::RNG(random.Seed())
      .fill(matrix, cv::RNG::UNIFORM, 0, CV_MAT_DEPTH(type) == CV_8U ? 256 : 60000);
  return matrix;
}

/// A camera to which everything happens, all the time or now and then.
class Camera {
 public:
  Camera(ImageSize size, Random& random)
      : random_(random),
        size_(size.width, size.height),
        background_(RandomMatrix(size_, CV_8UC3, random)) {
    if (random.Chance(0.7)) cv::blur(background_, background_, {7, 7});
    if (random.Chance(0.2)) background_.setTo(cv::Scalar::all(random.Int(0, 255)));
    noise_ = random.Chance(0.3) ? 0 : random.Real(0, 6);
    if (random.Chance(0.5)) restless_ = 0.1;
    for (int i = random.Int(0, 4); i > 0; --i) {
      blobs_.push_back({RandomPlace(), {random.Int(-4, 4), random.Int(-4, 4)}, RandomColor()});
    }
  }

  cv::Mat Next() {
    if (random_.Chance(0.08 * restless_)) what_ = static_cast<What>(random_.Int(0, 5));
    if (random_.Chance(0.03 * restless_)) light_ = random_.Chance(0.5) ? 1 : random_.Real(0, 3);
    if (random_.Chance(0.04 * restless_)) background_ = Shifted(background_);
    if (what_ == What::kFrozen && !last_.empty()) return last_;
    if (what_ == What::kNoise) return last_ = RandomMatrix(size_, CV_8UC3, random_);
    if (what_ == What::kOneColor) return last_ = cv::Mat(size_, CV_8UC3, RandomColor());
    cv::Mat frame = background_.clone();
    for (Blob& blob : blobs_) {
      if (random_.Chance(0.05)) blob.speed = {random_.Int(-4, 4), random_.Int(-4, 4)};
      if (random_.Chance(0.01)) blob.place = RandomPlace();
      blob.place += blob.speed;
      const cv::Rect seen = blob.place & cv::Rect({}, size_);
      if (seen.empty()) blob.place = RandomPlace();
      frame(seen).setTo(blob.color);
    }
    if (noise_ > 0) {
      cv::Mat noise(size_, CV_8UC3);
      cv::RNG(random_.Seed()).fill(noise, cv::RNG::NORMAL, 20, noise_);
      frame = frame + noise - cv::Scalar::all(20);
    }
    return last_ = what_ == What::kBlack ? cv::Mat(frame * 0.02) : cv::Mat(frame * light_);
  }

 private:
  enum class What { kScene, kPerhapsScene, kNoise, kOneColor, kFrozen, kBlack };
  struct Blob {
    cv::Rect place;
    cv::Point speed;
    cv::Scalar color;
  };
  cv::Rect RandomPlace() {
    return {random_.Int(0, size_.width - 1), random_.Int(0, size_.height - 1),
            random_.Int(1, size_.width), random_.Int(1, size_.height)};
  }
  cv::Scalar RandomColor() {
    return {random_.Real(0, 255), random_.Real(0, 255), random_.Real(0, 255)};
  }
  cv::Mat Shifted(const cv::Mat& picture) {
    cv::Mat moved;
    const cv::Matx23d by(1, 0, random_.Real(-20, 20), 0, 1, random_.Real(-20, 20));
    cv::warpAffine(picture, moved, by, size_, cv::INTER_LINEAR, cv::BORDER_REFLECT);
    return moved;
  }

  Random& random_;
  cv::Size size_;
  cv::Mat background_, last_;
  What what_ = What::kScene;
  double noise_ = 0;
  double light_ = 1;
  double restless_ = 1;
  std::vector<Blob> blobs_;
};

void RequireOk(const Status& status) {
  Require(status.has_value(), status ? "" : "refused: " + status.error().message);
}

void RequireRefused(const Status& status, const std::string& what) {
  Require(!status, what + " was not refused");
  const std::string& message = status.error().message;
  Require(!message.empty() && message.find('\n') == std::string::npos, "not one line: " + message);
}

void RequireMask(const cv::Mat& mask, cv::Size size) {
  Require(mask.type() == CV_8UC1 && mask.size() == size, "the mask has another size or type");
  Require(cv::countNonZero((mask != 0) & (mask != 255)) == 0, "the mask is not 0 or 255");
}

/// What the subtractor says about its last frame.
void RequireSound(const BackgroundSubtractor& subtractor, cv::Size size, const cv::Mat& held) {
  const GhostVerdict& verdict = subtractor.verdict();
  for (const JudgedComponent& one : verdict.judged) {
    Require(std::isfinite(one.value) && one.value >= 0, "a value is not finite");
    Require(one.free_share >= 0 && one.free_share <= 1, "a share is outside 0..1");
    Require((one.component.window & cv::Rect({}, size)) == one.component.window &&
                one.component.pixels.size() == one.component.window.size() &&
                cv::countNonZero(one.component.pixels) == one.component.area_px,
            "a component does not fit");
  }
  Require(verdict.ghosts.empty() == (verdict.ghosts_px == 0), "ghosts and their number differ");
  if (!verdict.ghosts.empty()) {
    Require(cv::countNonZero(verdict.ghosts) == verdict.ghosts_px, "ghosts_px is not the count");
    Require(held.empty() || cv::countNonZero(verdict.ghosts & (held != 0)) == 0,
            "held pixels are absorbed");
  }
  const BackgroundReport& report = subtractor.report();
  Require(report.unreliable <= report.frames && report.ghost_frames <= report.frames,
          "the report counts more frames than there were");
  for (const DisturbanceEvent& event : report.disturbances.events) {
    Require(std::isfinite(event.factor) && std::isfinite(event.length_px) && event.frame >= 0 &&
                event.frame < report.frames && event.frames >= 1,
            "an event is absurd");
  }
}

/// A frame, or held pixels, that must be refused.
void ApplyWrong(BackgroundSubtractor& subtractor, cv::Size size, Random& random) {
  cv::Mat mask, held;
  cv::Mat frame = RandomMatrix(size, CV_8UC3, random);
  const int types[] = {CV_8UC1, CV_16UC1, CV_16UC3, CV_8UC4, CV_32FC3};
  switch (random.Int(0, 3)) {
    case 0:
      frame = RandomMatrix(size, types[random.Int(0, 4)], random);
      break;
    case 1:
      frame = RandomMatrix({size.width + random.Int(1, 3), size.height}, CV_8UC3, random);
      break;
    case 2:
      frame.release();
      break;
    default:
      held = RandomMatrix({size.width, size.height + 1}, CV_8UC1, random);
  }
  const std::int64_t frames = subtractor.report().frames;
  RequireRefused(subtractor.Apply(frame, mask, 1, held), "a wrong frame");
  Require(subtractor.report().frames == frames, "a refused frame was counted");
}

/// Some pixels held, or an empty matrix.
cv::Mat RandomHeld(cv::Size size, Random& random) {
  if (random.Chance(0.6)) return {};
  cv::Mat held = cv::Mat::zeros(size, CV_8UC1);
  const cv::Point at(random.Int(0, size.width - 1), random.Int(0, size.height - 1));
  held(cv::Rect(at, cv::Size(size.width - at.x, size.height - at.y))) = random.Int(1, 255);
  return held;
}

BackgroundOptions OptionsWithin(Random& random) {
  for (;;) {
    BackgroundOptions options;
    RandomOptions change(random, false);
    VisitOptions(options, change);
    if (Validate(options)) return options;  // rules that join two options remain
  }
}

void RefuseBrokenOptions(Random& random) {
  BackgroundOptions options;
  RandomOptions change(random, true);
  VisitOptions(options, change);
  if (!change.broken) return;
  const auto made = BackgroundSubtractor::Create({8, 8}, options);
  RequireRefused(made ? Status() : tl::unexpected(made.error()), "an option out of its range");
}

/// The same stream to two subtractors that differ in their thread counts.
void RunStream(Random& random) {
  const ImageSize size = RandomSize(random);
  const cv::Size frame_size(size.width, size.height);
  const BackgroundOptions options = OptionsWithin(random);
  const double frames_per_second = random.Chance(0.3) ? 25 : std::exp2(random.Real(-3, 8));
  auto one = BackgroundSubtractor::Create(size, options, frames_per_second);
  auto other = BackgroundSubtractor::Create(size, options, frames_per_second);
  Require(one && other, one ? "" : one.error().message);
  Camera camera(size, random);
  for (int frames = random.Int(1, 200); frames > 0; --frames) {
    if (random.Chance(0.03)) ApplyWrong(*one, frame_size, random);
    cv::Mat frame = camera.Next();
    if (random.Chance(0.1)) {  // rows apart in memory
      cv::Mat wider;
      cv::copyMakeBorder(frame, wider, 1, 2, 3, 4, cv::BORDER_CONSTANT);
      frame = wider(cv::Rect({3, 1}, frame_size));
    }
    const cv::Mat held = RandomHeld(frame_size, random);
    cv::Mat mask, same;
    RequireOk(one->Apply(frame, mask, 1, held));
    RequireOk(other->Apply(frame, same, random.Int(2, 4), held));
    RequireMask(mask, frame_size);
    RequireMask(same, frame_size);
    Require(cv::norm(mask, same, cv::NORM_INF) == 0, "threads change the mask");
    RequireSound(*one, frame_size, held);
    const cv::Rect part(random.Int(0, size.width - 1), random.Int(0, size.height - 1), 1, 1);
    if (one->reliable()) {
      const cv::Mat behind = one->method().BackgroundImage(part);
      Require(behind.type() == CV_8UC3 && behind.size() == part.size(), "no background picture");
    }
  }
}

/// One picture; what may be wrong with it makes the folder unreadable from there on.
bool WritePicture(const std::filesystem::path& path, cv::Size size, bool first, Random& random) {
  const int types[] = {CV_8UC3, CV_8UC3, CV_8UC1, CV_16UC1, CV_16UC3, CV_8UC4, CV_16UC4};
  const int harm = random.Chance(0.03) ? random.Int(first ? 2 : 1, 4) : 0;  // 1: another size
  if (harm == 1) size.width += 1;
  Require(cv::imwrite(path.string(), RandomMatrix(size, types[random.Int(0, 6)], random)),
          "cannot write pictures");
  const auto bytes = static_cast<int>(std::filesystem::file_size(path));
  if (harm == 2) std::filesystem::resize_file(path, 0);
  if (harm == 3)
    std::filesystem::resize_file(path, static_cast<unsigned>(random.Int(1, bytes / 2)));
  if (harm == 4) std::ofstream(path) << "no picture";
  return harm == 0;
}

void RunFiles(Random& random) {
  const testing::TemporaryFolder folder;
  const ImageSize size = RandomSize(random);
  const int count = random.Int(1, 12);
  int good = 0;
  bool all_good = true;
  for (int i = 0; i < count; ++i) {
    all_good &= WritePicture(folder / fmt::format("{:04}.png", i), {size.width, size.height},
                             i == 0, random);
    if (all_good) ++good;
  }
  const std::filesystem::path input = random.Chance(0.5) ? folder.path() : folder / "%04d.png";
  auto source = OpenInput(input);
  if (!source) {
    RequireRefused(tl::unexpected(source.error()), "input");
    return Require(good < count, "refused: " + source.error().message);
  }
  const ImageSize opened = (*source)->info().size;
  auto subtractor = BackgroundSubtractor::Create(opened, OptionsWithin(random));
  Require(subtractor.has_value(), "no subtractor");
  cv::Mat frame, mask;
  int read = 0;
  for (;;) {
    const auto more = (*source)->Read(frame);
    if (!more) {
      RequireRefused(tl::unexpected(more.error()), "picture");
      return Require(!all_good, "refused: " + more.error().message);
    }
    if (!*more) break;
    ++read;
    RequireOk(subtractor->Apply(frame, mask, 1));
    RequireMask(mask, {opened.width, opened.height});
  }
  Require(all_good && read == count, "harmed pictures were read, or some left out");
}

void Round(std::uint64_t seed) {
  Random random(seed);
  const int kind = random.Int(0, 19);
  if (kind == 0) {
    RefuseBrokenOptions(random);
  } else if (kind < 5) {
    RunFiles(random);
  } else {
    RunStream(random);
  }
}

}  // namespace
}  // namespace vantage::fuzz

int main(int argc, char** argv) { return vantage::fuzz::Drive(argc, argv, vantage::fuzz::Round); }
