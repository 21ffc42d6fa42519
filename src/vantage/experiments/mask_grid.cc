// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/mask_grid.h"

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <utility>

#include "vantage/experiments/picture_uri.h"
#include "vantage/metrics/mask_measures.h"
#include "vantage/video/sequence.h"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

/// A row under way.
struct ActiveRow {
  MaskGridRow plan;
  BackgroundSubtractor subtractor;
  cv::Mat mask = {};
  std::vector<std::pair<FrameIndex, std::int64_t>> foreground = {};  ///< pixels a frame
  std::vector<std::string> backgrounds = {}, masks = {};             ///< data URIs, one a column
};

Result<std::vector<ActiveRow>> Start(const std::vector<MaskGridRow>& plans, ImageSize size) {
  std::vector<ActiveRow> rows;
  for (const MaskGridRow& plan : plans) {
    VANTAGE_ASSIGN_OR_RETURN(BackgroundSubtractor subtractor,
                             BackgroundSubtractor::Create(size, plan.options));
    rows.push_back({.plan = plan, .subtractor = std::move(subtractor)});
  }
  return rows;
}

Status Advance(const LabelledFrame& frame, ActiveRow& row) {
  VANTAGE_RETURN_IF_ERROR(row.subtractor.Apply(frame.bgr, row.mask, 1));
  std::int64_t pixels = cv::countNonZero(row.mask);
  if (!frame.labels.empty()) {
    VANTAGE_ASSIGN_OR_RETURN(const MaskCounts counts, CountMask(frame.labels, row.mask));
    pixels = counts.false_positives;
  }
  row.foreground.emplace_back(frame.frame, pixels);
  return {};
}

Status Draw(const LabelledFrame& frame, int width_px, ActiveRow& row) {
  if (row.plan.background) {
    const cv::Mat behind =
        row.subtractor.method().BackgroundImage({0, 0, frame.bgr.cols, frame.bgr.rows});
    std::string uri;
    if (!behind.empty()) {
      VANTAGE_ASSIGN_OR_RETURN(uri, PictureUri(behind, PictureFormat::kJpeg, width_px));
    }
    row.backgrounds.push_back(std::move(uri));
  }
  VANTAGE_ASSIGN_OR_RETURN(
      std::string uri, PictureUri(DrawMask(row.mask, frame.labels), PictureFormat::kPng, width_px));
  row.masks.push_back(std::move(uri));
  return {};
}

}  // namespace

cv::Mat DrawMask(const cv::Mat& mask, const cv::Mat& labels) {
  cv::Mat picture = cv::Mat::zeros(mask.size(), CV_8UC3);
  const cv::Mat foreground = mask >= 128;
  picture.setTo(cv::Scalar(255, 255, 255), foreground);
  if (labels.empty()) return picture;
  picture.setTo(cv::Scalar(40, 40, 230), foreground & (labels != TruthLabel::kMoving));
  picture.setTo(cv::Scalar(240, 120, 30), ~foreground & (labels == TruthLabel::kMoving));
  const cv::Mat unknown = (labels == TruthLabel::kOutside) | (labels == TruthLabel::kUnknown);
  picture.setTo(cv::Scalar(90, 90, 90), unknown);
  return picture;
}

Result<Json> DrawMaskGrid(LabelledSequence sequence, const MaskGridPlan& plan,
                          const RunControl& control) {
  VANTAGE_ASSIGN_OR_RETURN(std::vector<ActiveRow> rows, Start(plan.rows, sequence.size()));
  Json columns = Json::array(), pictures = Json::array();
  LabelledFrame frame;
  for (FrameIndex index = 0;; ++index) {
    if (control.Stopped()) return Cancelled();
    VANTAGE_ASSIGN_OR_RETURN(const bool more, sequence.Next(frame));
    if (!more) break;
    for (ActiveRow& row : rows) VANTAGE_RETURN_IF_ERROR(Advance(frame, row));
    if (std::ranges::count(plan.columns, index) == 0) continue;
    columns.push_back(fmt::format("frame {}", frame.frame));
    VANTAGE_ASSIGN_OR_RETURN(std::string uri,
                             PictureUri(frame.bgr, PictureFormat::kJpeg, plan.width_px));
    pictures.push_back(std::move(uri));
    for (ActiveRow& row : rows) VANTAGE_RETURN_IF_ERROR(Draw(frame, plan.width_px, row));
  }
  if (columns.empty()) return Fail("the sequence ends before the first frame to be shown");
  Json drawn = Json::array({{{"name", "picture"}, {"pictures", std::move(pictures)}}});
  Json foreground = Json::array();
  for (ActiveRow& row : rows) {
    if (row.plan.background) {
      drawn.push_back({{"name", row.plan.name + ": background"}, {"pictures", row.backgrounds}});
    }
    drawn.push_back({{"name", row.plan.name}, {"pictures", row.masks}});
    foreground.push_back({{"name", row.plan.name}, {"frames", row.foreground}});
  }
  return Json{{"columns", std::move(columns)},
              {"rows", std::move(drawn)},
              {"foreground", std::move(foreground)}};
}

}  // namespace vantage
