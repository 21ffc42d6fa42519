// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/pipeline/rehearsal.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "vantage/base/stopwatch.h"
#include "vantage/pipeline/flow.h"

namespace vantage {
namespace {

constexpr std::int64_t kQueue = 4;  // samples that wait for the next stage
// Without a rehearsal: so much is gone over, and measured at this interval.
constexpr double kUnrehearsed_s = 15;
constexpr double kMeasured_s = 0.5;

/// What the first pass does.
struct Pass {
  RehearsalPlan plan;
  /// The cameras learn by it; otherwise they judge their frames as they will in the recording.
  bool rehearses = false;
  /// Samples whose masks are measured: this one, and every so many.
  std::int64_t first_measured = 0;
  std::int64_t measured_every = 1;
};

Pass PlanPass(const MaskStream& stream, const BackgroundOptions& options, double rate) {
  const std::optional<std::int64_t> frames = stream.frame_count();
  if (!stream.learns()) return {.plan = SampleBeginning({}, frames, rate)};  // masks as they are
  const RehearsalPlan plan = PlanRehearsal(options.rehearsal, frames, rate);
  if (plan.samples > 0) {
    return {.plan = plan, .rehearses = true, .first_measured = plan.samples / 4};
  }
  // A background that begins with the first frame needs every frame.
  const auto most = static_cast<std::int64_t>(kUnrehearsed_s * rate);
  return {.plan = {.interval = 1, .samples = std::min(frames.value_or(most), most)},
          .measured_every = std::max<std::int64_t>(1, std::lround(kMeasured_s * rate))};
}

/// The samples go through a chain as the recording's frames do: every camera in a lane of its own,
/// in order.
Status GoOver(MaskStream& stream, const Pass& pass, PersonSizeMeter* meter, int threads,
              const RunControl& control) {
  using Pictures = std::vector<cv::Mat>;
  const auto cameras = static_cast<std::size_t>(stream.cameras());
  Ring<Pictures> pictures(kQueue, Pictures(cameras));
  Ring<Pictures> masks(kQueue, Pictures(cameras));
  const auto read = [&](std::int64_t sample, int camera) -> Result<bool> {
    if (sample == pass.plan.samples) return false;
    if (sample > 0) VANTAGE_RETURN_IF_ERROR(stream.Skip(camera, pass.plan.interval - 1));
    return stream.Read(camera, sample * pass.plan.interval,
                       pictures[sample][static_cast<std::size_t>(camera)]);
  };
  const auto learn = [&](std::int64_t sample, int camera) -> Result<bool> {
    const auto index = static_cast<std::size_t>(camera);
    const cv::Mat& picture = pictures[sample][index];
    cv::Mat& mask = masks[sample][index];
    VANTAGE_RETURN_IF_ERROR(pass.rehearses ? stream.Rehearse(camera, picture, mask)
                                           : stream.Subtract(camera, picture, {}, mask));
    return true;
  };
  const auto measure = [&](std::int64_t sample, int) -> Result<bool> {
    const std::int64_t since = sample - pass.first_measured;
    if (meter != nullptr && since >= 0 && since % pass.measured_every == 0) {
      VANTAGE_RETURN_IF_ERROR(meter->Add(masks[sample]));
    }
    return true;
  };
  const std::vector<FlowStage> chain = {{.lanes = stream.cameras(), .queue = kQueue, .work = read},
                                        {.lanes = stream.cameras(), .queue = kQueue, .work = learn},
                                        {.work = measure}};
  const auto flow = RunFlow(chain, threads, control);
  return flow ? Status() : tl::unexpected(flow.error());
}

}  // namespace

Result<Rehearsed> Rehearse(const Scene& scene, const BackgroundOptions& options, int threads,
                           const RunControl& control) {
  const Stopwatch stopwatch;
  VANTAGE_ASSIGN_OR_RETURN(MaskStream stream, MaskStream::Create(scene, options, threads));
  const Pass pass = PlanPass(stream, options, scene.frames_per_second);
  std::optional<PersonSizeMeter> meter;
  if (!scene.person.IsGiven()) {
    std::vector<Camera> cameras;
    for (const SceneCamera& camera : scene.cameras) cameras.push_back(camera.camera);
    meter.emplace(std::move(cameras), scene.area, scene.person.shape);
  }
  std::optional<PersonSizeReport> measured;
  if (pass.rehearses || meter) {
    VANTAGE_RETURN_IF_ERROR(GoOver(stream, pass, meter ? &*meter : nullptr, threads, control));
    if (meter) measured = meter->Report();
    VANTAGE_RETURN_IF_ERROR(stream.Rewind(scene, options, pass.rehearses));
  }
  PersonReport person = ResolvePerson(scene, std::move(measured));
  return Rehearsed{
      .stream = std::move(stream), .person = std::move(person), .seconds = stopwatch.Seconds()};
}

}  // namespace vantage
