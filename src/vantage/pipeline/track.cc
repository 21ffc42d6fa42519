// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/pipeline/track.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "vantage/base/stopwatch.h"
#include "vantage/linking/access.h"
#include "vantage/occupancy/peaks.h"
#include "vantage/pipeline/flow.h"
#include "vantage/pipeline/ground.h"
#include "vantage/pipeline/mask_stream.h"
#include "vantage/pipeline/recent_tracks.h"
#include "vantage/pipeline/rehearsal.h"

namespace vantage {
namespace {

/// The way back from the tracker to the masks: the tracks of the last moments name what the next
/// frames hold.
class Feedback {
 public:
  /// None when nothing is to be held, or no camera learns a background.
  static Result<std::optional<Feedback>> Create(const Scene& scene, const PersonOptions& person,
                                                const StageOptions& options,
                                                const MaskStream& stream,
                                                const OccupancyMaps& like) {
    VANTAGE_ASSIGN_OR_RETURN(std::vector<Polygon> doors,
                             DoorsAndEntrances(like.grid, scene.doors, scene.entrances_m));
    if (!options.hold.standing || !stream.learns()) return std::nullopt;
    LinkingOptions linking = options.linking;
    linking.max_paths = 0;  // counts the paths of a whole recording
    std::vector<Camera> cameras;
    for (const SceneCamera& camera : scene.cameras) cameras.push_back(camera.camera);
    VANTAGE_ASSIGN_OR_RETURN(
        OccupiedRegions occupied,
        OccupiedRegions::Create(std::move(cameras), person, options.hold, scene.frames_per_second));
    VANTAGE_ASSIGN_OR_RETURN(RecentTracks recent,
                             RecentTracks::Create(like, occupied.window_frames(), linking,
                                                  options.tracks, doors, scene.obstacles));
    return Feedback(std::move(occupied), std::move(recent));
  }

  /// Frames whose maps must be known before frame t is judged. In the time of a few frames nothing
  /// fades.
  static std::int64_t FramesNeeded(std::int64_t frame) {
    return frame - frame % OccupiedRegions::kFramesBetween;
  }

  const cv::Mat& held(int camera) const {
    return occupied_.held()[static_cast<std::size_t>(camera)];
  }

  /// The mask that a camera has just made.
  void Judge(int camera, const cv::Mat& mask, const MaskStream& stream) {
    const auto index = static_cast<std::size_t>(camera);
    const auto& subtractor = stream.subtractors()[index];
    if (subtractor && !mask.empty()) occupied_.Judge(index, mask, subtractor->verdict());
  }

  /// The map of the frame that follows.
  Status Add(std::span<const float> map) {
    maps_.insert(maps_.end(), map.begin(), map.end());
    if (++frames_ % OccupiedRegions::kFramesBetween != 0) return {};
    VANTAGE_RETURN_IF_ERROR(recent_.Add(maps_));
    maps_.clear();
    VANTAGE_ASSIGN_OR_RETURN(const Tracks tracks, recent_.Link());
    occupied_.Name(tracks, recent_.next_frame());
    return {};
  }

  HoldReport report() const { return occupied_.report(); }

 private:
  Feedback(OccupiedRegions occupied, RecentTracks recent)
      : occupied_(std::move(occupied)), recent_(std::move(recent)) {}
  OccupiedRegions occupied_;
  RecentTracks recent_;
  std::vector<float> maps_;  // of the frames since tracks were last looked for
  std::int64_t frames_ = 0;
};

/// Frames whose masks wait to be solved, and whose maps wait to be collected.
constexpr std::int64_t kMaskQueue = 8;
constexpr std::int64_t kMapQueue = 8;

/// The chain from pictures to maps: reading, background, occupancy, collecting. What a stage
/// touches belongs to it alone, or waits in a queue, or is the way back, whose parts are touched by
/// a camera's background and by collecting in turns.
class MapChain {
 public:
  MapChain(const OccupancySolver& solver, bool warm_start, const AppearanceSampler& sampler,
           std::int64_t frames_between_looks, MaskStream& stream, std::optional<Feedback>& feedback,
           const MaskSink& mask_sink, MapsResult& result)
      : solver_(solver),
        warm_start_(warm_start),
        sampler_(sampler),
        stream_(stream),
        stages_(stream, kMaskQueue + kMapQueue, frames_between_looks),
        solved_(kMapQueue + 1),
        feedback_(feedback),
        mask_sink_(mask_sink),
        result_(result) {}

  Status Run(int threads, const RunControl& control) {
    FlowStage background =
        feedback_ ? stages_.Background(
                        kMaskQueue,
                        [this](int camera) -> const cv::Mat& { return feedback_->held(camera); },
                        [this](int camera, const cv::Mat& mask) {
                          feedback_->Judge(camera, mask, stream_);
                        })
                  : stages_.Background(kMaskQueue);
    if (feedback_) background.returned = Feedback::FramesNeeded;
    // With a warm start frames are not independent of each other.
    const FlowStage occupancy{.in_order = warm_start_,
                              .queue = kMapQueue,
                              .work = [this](std::int64_t frame, int) { return Solve(frame); }};
    const FlowStage collecting{.work = [&](std::int64_t frame, int) -> Result<bool> {
      VANTAGE_RETURN_IF_ERROR(Collect(frame));
      control.Report(frame + 1, stream_.frame_count().value_or(0));
      return true;
    }};
    VANTAGE_ASSIGN_OR_RETURN(
        const FlowReport flow,
        RunFlow(std::vector{stages_.Reading(), background, occupancy, collecting}, threads,
                control));
    MapsReport& report = result_.report;
    report.frames = flow.frames;
    report.mean_iterations = static_cast<double>(iterations_) /
                             static_cast<double>(std::max<std::int64_t>(report.frames, 1));
    report.read_secs = flow.stage_secs[0];
    report.background_secs = flow.stage_secs[1];
    report.occupancy_secs = flow.stage_secs[2];
    report.hold_secs = flow.stage_secs[3];
    report.idle_secs = flow.idle_secs;
    report.wall_secs = flow.wall_secs;
    return {};
  }

 private:
  struct Solved {
    std::vector<float> map;
    Appearances appearances;
    SolveReport report;
  };

  Result<bool> Solve(std::int64_t frame) {
    Solved& solved = solved_[frame];
    solved.map.resize(solver_.cell_count());
    const bool follows = warm_start_ && frame > 0;
    VANTAGE_ASSIGN_OR_RETURN(solved.report,
                             solver_.Solve(stages_.masks[frame], solved.map,
                                           follows ? std::span<const float>(solved_[frame - 1].map)
                                                   : std::span<const float>()));
    solved.appearances.clear();
    if (stages_.KeepsPictures(frame)) VANTAGE_RETURN_IF_ERROR(Look(frame, solved));
    return true;
  }

  /// The colours of the people whom the map of a frame shows.
  Status Look(std::int64_t frame, Solved& solved) {
    VANTAGE_ASSIGN_OR_RETURN(const std::vector<Peak> people,
                             FindPeaks(result_.maps.grid, solved.map, PeakOptions()));
    std::vector<cv::Mat>& pictures = stages_.pictures[frame];
    sampler_.Look(frame, pictures, stages_.masks[frame], people, solved.appearances);
    for (cv::Mat& picture : pictures) picture.release();
    return {};
  }

  Status Collect(std::int64_t frame) {
    const Solved& solved = solved_[frame];
    MapsReport& report = result_.report;
    if (mask_sink_) {
      VANTAGE_RETURN_IF_ERROR(mask_sink_(result_.maps.first_frame + frame, stages_.masks[frame]));
    }
    std::vector<float>& values = result_.maps.values;
    values.insert(values.end(), solved.map.begin(), solved.map.end());
    result_.appearances.insert(result_.appearances.end(), solved.appearances.begin(),
                               solved.appearances.end());
    iterations_ += solved.report.iterations;
    report.frames_not_converged += solved.report.converged ? 0 : 1;
    report.pictures_missing += solved.report.cameras_left_out;
    return feedback_ ? feedback_->Add(solved.map) : Status();
  }

  const OccupancySolver& solver_;
  bool warm_start_;
  const AppearanceSampler& sampler_;
  MaskStream& stream_;
  MaskStages stages_;
  Ring<Solved> solved_;  // one more than wait: a warm start reads the one before
  std::optional<Feedback>& feedback_;
  const MaskSink& mask_sink_;
  MapsResult& result_;
  std::int64_t iterations_ = 0;
};

}  // namespace

Status BindStages(const Scene& scene, StageOptions& options) {
  VANTAGE_RETURN_IF_ERROR(scene.stages.Bind("background", options.background));
  VANTAGE_RETURN_IF_ERROR(scene.stages.Bind("hold", options.hold));
  VANTAGE_RETURN_IF_ERROR(scene.stages.Bind("occupancy", options.occupancy));
  VANTAGE_RETURN_IF_ERROR(scene.stages.Bind("linking", options.linking));
  VANTAGE_RETURN_IF_ERROR(scene.stages.Bind("identity", options.identity));
  return scene.stages.Bind("tracks", options.tracks);
}

Result<MapsResult> ComputeMaps(const Scene& scene, const StageOptions& options, int threads,
                               const RunControl& control, const MaskSink& mask_sink) {
  VANTAGE_ASSIGN_OR_RETURN(Rehearsed rehearsed,
                           Rehearse(scene, options.background, threads, control));
  MaskStream& stream = rehearsed.stream;
  VANTAGE_ASSIGN_OR_RETURN(Ground ground,
                           LayOutGround(scene, rehearsed.person.used, options.occupancy));
  VANTAGE_ASSIGN_OR_RETURN(const OccupancySolver solver,
                           OccupancySolver::Create(ground.views, options.occupancy));

  MapsResult result;
  OccupancyMaps& maps = result.maps;
  MapsReport& report = result.report;
  report.rehearsal_secs = rehearsed.seconds;
  report.person = std::move(rehearsed.person);
  report.area_cells = ground.AreaCells();
  report.unseen_area_cells = ground.UnseenAreaCells();
  report.extension = ground.extension;
  maps.grid = ground.grid;
  maps.first_frame = scene.first_frame;
  maps.frames_per_second = scene.frames_per_second;
  maps.in_area = std::move(ground.in_area);
  maps.visible = std::move(ground.visible);

  VANTAGE_ASSIGN_OR_RETURN(std::optional<Feedback> feedback,
                           Feedback::Create(scene, report.person.used, options, stream, maps));

  std::vector<AppearanceSampler::View> looks;
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    looks.push_back(
        {.camera = scene.cameras[i].camera, .informative = ground.views[i].informative});
  }
  const AppearanceSampler sampler(std::move(looks), report.person.used);
  const bool looks_at_people = options.identity.appearance && stream.learns();
  MapChain chain(solver, options.occupancy.warm_start, sampler,
                 looks_at_people ? LookInterval(options.identity, scene.frames_per_second) : 0,
                 stream, feedback, mask_sink, result);
  VANTAGE_RETURN_IF_ERROR(chain.Run(threads, control));
  if (report.frames == 0) {
    return Fail("{}: no frame to process: the cameras have no picture at frame {} or after it",
                scene.file.string(), scene.first_frame);
  }
  for (const auto& subtractor : stream.subtractors()) {
    report.background.push_back(subtractor ? subtractor->report() : BackgroundReport{});
  }
  if (feedback) report.hold = feedback->report();
  return result;
}

Result<TrackingResult> TrackPeople(const Scene& scene, const StageOptions& options, int threads,
                                   const RunControl& control, const MaskSink& mask_sink) {
  const Stopwatch stopwatch;
  VANTAGE_ASSIGN_OR_RETURN(MapsResult mapped,
                           ComputeMaps(scene, options, threads, control, mask_sink));
  VANTAGE_ASSIGN_OR_RETURN(const std::vector<Polygon> doors,
                           DoorsAndEntrances(mapped.maps.grid, scene.doors, scene.entrances_m));
  VANTAGE_ASSIGN_OR_RETURN(
      LinkMapsResult linked,
      LinkMaps(mapped.maps, options.linking, options.tracks, doors, scene.obstacles, control));
  TrackingResult result;
  VANTAGE_ASSIGN_OR_RETURN(result.report.identity,
                           IdentifyTracks(mapped.maps, mapped.appearances, options.identity,
                                          options.tracks, linked, control));
  result.tracks = std::move(linked.tracks);
  result.maps = std::move(mapped.maps);
  result.appearances = std::move(mapped.appearances);
  result.report.maps = std::move(mapped.report);
  result.report.linking = linked.report;
  result.report.total_secs = stopwatch.Seconds();
  return result;
}

}  // namespace vantage
