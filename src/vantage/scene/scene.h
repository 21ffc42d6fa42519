// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/base/options.h"
#include "vantage/base/result.h"
#include "vantage/geometry/camera.h"
#include "vantage/geometry/person.h"
#include "vantage/geometry/polygon.h"
#include "vantage/video/frame_source.h"

namespace vantage {

/// Where a camera's pictures come from: exactly one of the four kinds.
struct SourceSpec {
  enum class Kind { kVideo, kPictures, kMasks, kDetections };
  Kind kind = Kind::kVideo;
  /// A video or CSV file; numbered pictures as a pattern with one %d or %0Nd ("view1/%06d.png"), or
  /// a folder of pictures; masks may be any of these but CSV.
  std::filesystem::path path;
  /// Detections only: size of the pictures that the boxes were found in; unless the scene says
  /// otherwise, that of the calibration.
  ImageSize size;
  /// Detections only: boxes with a lower score are left out.
  double min_score = 0.5;
  /// Frame of the source that belongs to frame 0 of the scene: may be negative (the camera started
  /// late: its first frames are missing).
  std::int64_t offset_frames = 0;
};

struct SceneCamera {
  std::string name;
  SourceSpec source;
  Camera camera;
  /// CV_8UC1 of camera.size(): not 0 where the camera sees something in front of the people (a
  /// post, a sign), so that the pixel says nothing of them. Empty: it sees people everywhere.
  cv::Mat blind = {};
};

/// Grid and extension of the area (table [grid]).
struct GridOptions {
  /// Side of a cell in metres, 0.02 <= cell <= 10.
  double cell_m = 0.3;
  /// The grid grows by this much around the area, 0 <= extension <= 100; none: `auto`, on each side
  /// by as much as people outside need who cover cells inside (occupancy/extension.h),
  std::optional<double> extension_m = std::nullopt;
  /// but at most by this, 0 <= max_extension <= 100.
  double max_extension_m = 4;
  /// Who hides less than this share of somebody inside needs no cell, 0.01 <= covering_share <= 1.
  double covering_share = 0.25;
};
void VisitOptions(GridOptions& options, OptionVisitor& visitor);

/// Opens the pictures or masks of one camera (not moved by its offset: MultiCameraReader does
/// that).
Result<std::unique_ptr<FrameSource>> OpenSource(const SourceSpec& source);

/// The options tables of the stages ([background], [hold], [occupancy], [linking], [tracks]) as
/// read; the pipeline binds them to the stages' own options, so that the scene does not depend on
/// the stages.
class StageTables {
 public:
  StageTables();
  ~StageTables();
  StageTables(StageTables&&) noexcept;
  StageTables& operator=(StageTables&&) noexcept;

  /// Sets every field that the table `name` gives. Fails, with file and line, on unknown keys,
  /// wrong types and values out of range; the options may then be set in part. An absent table
  /// leaves them as they are.
  template <class Options>
  Status Bind(std::string_view name, Options& options) const {
    return BindWith(name, [&](OptionVisitor& visitor) { VisitOptions(options, visitor); });
  }

  /// True when the scene file has the table `name`.
  bool Has(std::string_view name) const;
  /// Names of the tables that the scene file has, in alphabetical order.
  std::vector<std::string> given() const;

  struct Content;
  explicit StageTables(std::unique_ptr<Content> content);

 private:
  Status BindWith(std::string_view name, const std::function<void(OptionVisitor&)>& visit) const;
  std::unique_ptr<Content> content_;
};

/// A scene: cameras and the ground that they watch. One camera is a valid scene.
struct Scene {
  std::filesystem::path file;  ///< as given by the caller
  std::string name;
  double frames_per_second = 0;
  /// Frames to process: [first_frame, first_frame + frame_count); none: to the end.
  std::int64_t first_frame = 0;
  std::optional<std::int64_t> frame_count;
  Polygon area;
  /// Places where people come and go inside the area; empty: only the border of what is seen.
  std::vector<Polygon> doors;
  /// The same as a list: the cells that these points lie in.
  std::vector<Eigen::Vector2d> entrances_m;
  /// Places where nobody can stand.
  std::vector<Polygon> obstacles;
  GridOptions grid;
  PersonSpec person;
  std::vector<SceneCamera> cameras;
  StageTables stages;
  /// Every file that the scene was read from (itself and calibrations), for the record of a run.
  std::vector<std::filesystem::path> inputs;
};

/// Reads a scene file. Paths in it are relative to `data_folder`, or to the scene's own folder when
/// that is empty. Errors name file, line and key and say what is allowed; unknown keys are errors.
Result<Scene> LoadScene(const std::filesystem::path& path,
                        const std::filesystem::path& data_folder = {});

}  // namespace vantage
