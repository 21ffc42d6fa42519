// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/ghosts.h"

#include <algorithm>
#include <cstdlib>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace vantage {
namespace {

/// The largest difference of a channel, levels.
int Change(const std::uint8_t* before, const cv::Vec3b& now) {
  int change = 0;
  for (int c = 0; c < 3; ++c) change = std::max(change, std::abs(before[c] - now[c]));
  return change;
}

/// Fills gaps between pixels that stand still with what else is foreground there.
cv::Mat Closed(const cv::Mat& still, const cv::Mat& foreground, int join_px) {
  const int radius_px = join_px / 2;
  if (radius_px == 0) return still;
  cv::Mat closed;
  cv::morphologyEx(
      still, closed, cv::MORPH_CLOSE,
      cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * radius_px + 1, 2 * radius_px + 1}));
  return closed & foreground;
}

/// Moves a component found in a window of the picture to the picture; its own window grows as far
/// as `outer` goes.
Component InPicture(const Component& found, const cv::Rect& outer) {
  Component moved = found;
  moved.box += outer.tl();
  moved.window += outer.tl();
  return moved;
}

/// Specks of the rest of `foreground` that touch `ghosts` (both CV_8UC1 of one size) and are
/// smaller than what is judged go with them.
void TakeSpecks(const cv::Mat& foreground, int min_area_px, cv::Mat& ghosts) {
  const cv::Mat near = Grown(ghosts, 1);
  for (const Component& speck : FindComponents(foreground & ~ghosts, {})) {
    if (speck.area_px >= min_area_px) continue;
    if (cv::countNonZero(near(speck.window) & speck.pixels) == 0) continue;
    ghosts(speck.window).setTo(255, speck.pixels);
  }
}

}  // namespace

void VisitOptions(GhostOptions& o, OptionVisitor& v) {
  VisitOptions(o.rule, v);
  v.Choice({"ghost_judgement", "",
            "what is judged: what stands still, piece by piece; or plainly every component"},
           o.judgement, {{"still", GhostJudgement::kStill}, {"plain", GhostJudgement::kPlain}});
  v.Number({"ghost_min_area", "px", "smaller components are not judged"}, o.min_area_px,
           Range::AtLeast(1));
  v.Number({"ghost_still_frames", "frames", "time after which a pixel stands still"},
           o.still_frames, Range::Between(1, 250));
  v.Number({"ghost_still_levels", "levels", "change within which a pixel stands still"},
           o.still_levels, Range::Between(0, 255));
  v.Number({"ghost_whole_share", "", "still share above which a component is judged whole"},
           o.whole_share, Range::AboveUpTo(0, 1));
  v.Number({"ghost_join", "px", "foreground no further apart is judged together"}, o.join_px,
           Range::Between(1, 50));
  v.Number({"ghost_free_share", "", "least share of a border away from other foreground"},
           o.free_share, Range::Between(0, 1));
  v.Number({"ghost_agree_frames", "frames", "frames in a row that must agree on a ghost"},
           o.agree_frames, Range::Between(1, 250));
}

GhostDetector::GhostDetector(ImageSize size, const GhostOptions& options)
    : size_(size),
      options_(options),
      // Around the regions, the gradient looks one pixel further and its maxima another one.
      margin_px_(options.rule.border_px + options.rule.ring_px + 2) {
  if (options.rule.criterion != GhostCriterion::kNone &&
      options.judgement == GhostJudgement::kStill) {
    history_.resize(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
  }
}

Result<GhostDetector> GhostDetector::Create(ImageSize size, const GhostOptions& options) {
  VANTAGE_RETURN_IF_ERROR(ValidateOptions(options, "background"));
  if (size.width < 1 || size.height < 1) {
    return Fail("ghosts: frames of {}x{} px; each side must be at least 1 px", size.width,
                size.height);
  }
  return GhostDetector(size, options);
}

Status GhostDetector::CheckSizes(const cv::Mat& bgr, const cv::Mat& mask) const {
  const cv::Size size(size_.width, size_.height);
  if (mask.type() == CV_8UC1 && bgr.type() == CV_8UC3 && bgr.size() == size &&
      mask.size() == size) {
    return {};
  }
  return Fail(
      "ghosts: the mask is {}x{} px of type {} and the frame {}x{} px of type {}; they must be "
      "{}x{} px of types CV_8UC1 and CV_8UC3",
      mask.cols, mask.rows, cv::typeToString(mask.type()), bgr.cols, bgr.rows,
      cv::typeToString(bgr.type()), size.width, size.height);
}

/// The component's pixels that stand still, 255 in a picture of its window's size.
cv::Mat GhostDetector::UpdateStillness(const cv::Mat& bgr, const Component& component) {
  const cv::Rect& window = component.window;
  cv::Mat still = cv::Mat::zeros(window.size(), CV_8UC1);
  const auto now = static_cast<std::uint16_t>(frame_);
  const auto before = static_cast<std::uint16_t>(frame_ - 1);
  for (int y = 0; y < window.height; ++y) {
    const std::uint8_t* inside = component.pixels.ptr(y);
    const auto* color = bgr.ptr<cv::Vec3b>(window.y + y, window.x);
    History* row = &history_[Index(window.x, window.y + y)];
    for (int x = 0; x < window.width; ++x) {
      if (inside[x] == 0) continue;
      History& pixel = row[x];
      if (pixel.frame == before && Change(pixel.color, color[x]) <= options_.still_levels) {
        if (pixel.still < 255) ++pixel.still;
      } else {
        std::copy_n(color[x].val, 3, pixel.color);
        pixel.still = 0;
      }
      if (pixel.frame != before || !pixel.voted) pixel.votes = 0;
      pixel.voted = false;
      pixel.frame = now;
      if (pixel.still >= options_.still_frames) still.at<std::uint8_t>(y, x) = 255;
    }
  }
  return still;
}

/// Foreground beside the piece, and what was until it faded into the background where it stood: it
/// has kept its colour since. 255 in a picture of the piece's window's size.
cv::Mat GhostDetector::OthersBeside(const cv::Mat& bgr, const cv::Mat& mask,
                                    const Component& piece) const {
  const cv::Rect& window = piece.window;
  cv::Mat others = mask(window) & ~piece.pixels;
  for (int y = 0; y < window.height; ++y) {
    const std::uint8_t* foreground = mask.ptr(window.y + y, window.x);
    const auto* color = bgr.ptr<cv::Vec3b>(window.y + y, window.x);
    const History* row = &history_[Index(window.x, window.y + y)];
    std::uint8_t* out = others.ptr(y);
    for (int x = 0; x < window.width; ++x) {
      if (foreground[x] == 0 && row[x].still >= options_.still_frames &&
          Change(row[x].color, color[x]) <= options_.still_levels) {
        out[x] = 255;
      }
    }
  }
  return others;
}

Status GhostDetector::JudgePiece(const cv::Mat& bgr, const BackgroundPicture& background,
                                 Component piece, const cv::Mat& others,
                                 GhostVerdict& verdict) const {
  const CriterionOptions& rule = options_.rule;
  const BorderRegions border = BorderOf(piece, rule.border_px, rule.ring_px, others);
  JudgedComponent judged{.component = std::move(piece), .free_share = border.free_share};
  judged.decided = others.empty() || border.free_share >= std::max(options_.free_share, 1e-9);
  if (judged.decided) {
    cv::Mat behind;
    if (NeedsBackground(rule.criterion)) {
      const cv::Rect& window = judged.component.window;
      if (background) behind = background(window);
      if (behind.empty()) {
        return Fail(
            "ghosts: rule {} compares with the background picture, which this background "
            "algorithm does not have; choose epd or cb",
            NameOf(rule.criterion));
      }
      VANTAGE_RETURN_IF_ERROR(CheckBackgroundPicture("ghosts", behind, window.size()));
    }
    judged.value = CriterionValue(bgr(judged.component.window), behind, border, rule);
    judged.ghost = judged.value <= rule.threshold();
  }
  verdict.judged.push_back(std::move(judged));
  return {};
}

/// Counts the frame's vote for each pixel of a ghost; true when some of them are ghosts by now,
/// which become 255 in `ghosts`.
bool GhostDetector::Vote(const JudgedComponent& piece, cv::Mat& ghosts) {
  const cv::Rect& window = piece.component.window;
  bool any = false;
  for (int y = 0; y < window.height; ++y) {
    const std::uint8_t* inside = piece.component.pixels.ptr(y);
    std::uint8_t* out = ghosts.ptr(window.y + y, window.x);
    History* row = &history_[Index(window.x, window.y + y)];
    for (int x = 0; x < window.width; ++x) {
      if (inside[x] == 0) continue;
      History& pixel = row[x];
      if (pixel.votes < 255) ++pixel.votes;
      pixel.voted = true;
      if (pixel.votes < options_.agree_frames) continue;
      pixel.still = 0;  // absorbed, not faded
      out[x] = 255;
      any = true;
    }
  }
  return any;
}

Result<GhostVerdict> GhostDetector::Judge(const cv::Mat& bgr, const cv::Mat& mask,
                                          const BackgroundPicture& background) {
  VANTAGE_RETURN_IF_ERROR(CheckSizes(bgr, mask));
  GhostVerdict verdict;
  if (options_.rule.criterion == GhostCriterion::kNone) return verdict;
  const bool plain = options_.judgement == GhostJudgement::kPlain;
  const ComponentRule together{.reach_px = plain ? 1 : options_.join_px,
                               .min_area_px = options_.min_area_px,
                               .margin_px = margin_px_};
  std::vector<Component> components = FindComponents(mask, together);
  cv::Mat ghosts = cv::Mat::zeros(components.empty() ? cv::Size() : mask.size(), CV_8UC1);
  for (Component& component : components) {
    const cv::Rect window = component.window;
    const std::size_t first = verdict.judged.size();
    if (plain) {
      VANTAGE_RETURN_IF_ERROR(JudgePiece(bgr, background, std::move(component), {}, verdict));
      const JudgedComponent& judged = verdict.judged.back();
      if (judged.ghost) ghosts(window).setTo(255, judged.component.pixels);
      continue;
    }
    const cv::Mat foreground = mask(window);
    const cv::Mat still = UpdateStillness(bgr, component);
    const int still_px = cv::countNonZero(still);
    if (still_px >= options_.whole_share * component.area_px) {
      const cv::Mat others = OthersBeside(bgr, mask, component);
      VANTAGE_RETURN_IF_ERROR(JudgePiece(bgr, background, std::move(component), others, verdict));
    } else if (still_px >= options_.min_area_px) {
      const ComponentRule apart{.min_area_px = options_.min_area_px, .margin_px = margin_px_};
      const cv::Mat pieces = Closed(still, component.pixels, options_.join_px);
      for (const Component& piece : FindComponents(pieces, apart)) {
        Component moved = InPicture(piece, window);
        const cv::Mat others = OthersBeside(bgr, mask, moved);
        VANTAGE_RETURN_IF_ERROR(JudgePiece(bgr, background, std::move(moved), others, verdict));
      }
    }
    bool any = false;
    for (std::size_t i = first; i < verdict.judged.size(); ++i) {
      if (verdict.judged[i].ghost) any |= Vote(verdict.judged[i], ghosts);
    }
    if (any) {
      cv::Mat here = ghosts(window);
      TakeSpecks(foreground, options_.min_area_px, here);
    }
  }
  verdict.ghosts_px = cv::countNonZero(ghosts);
  if (verdict.ghosts_px > 0) verdict.ghosts = std::move(ghosts);
  ++frame_;
  return verdict;
}

}  // namespace vantage
