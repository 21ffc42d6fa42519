// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/pipeline/rehearsal.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "vantage/base/stopwatch.h"
#include "vantage/pipeline/flow.h"

namespace vantage {
namespace {

constexpr std::int64_t kQueue = 4;  // samples that wait for the next stage

/// The sampled frames go through a chain as those of the recording do: every camera in a lane of
/// its own, its samples in order.
Status GoOver(MaskStream& stream, const RehearsalPlan& plan, PersonSizeMeter* meter,
              std::int64_t first_measured, int threads, const RunControl& control) {
  using Pictures = std::vector<cv::Mat>;
  const auto cameras = static_cast<std::size_t>(stream.cameras());
  Ring<Pictures> pictures(kQueue, Pictures(cameras));
  Ring<Pictures> masks(kQueue, Pictures(cameras));
  const FlowStage reading{.lanes = stream.cameras(),
                          .queue = kQueue,
                          .work = [&](std::int64_t sample, int camera) -> Result<bool> {
                            if (sample == plan.samples) return false;
                            if (sample > 0)
                              VANTAGE_RETURN_IF_ERROR(stream.Skip(camera, plan.interval - 1));
                            return stream.Read(camera, sample * plan.interval,
                                               pictures[sample][static_cast<std::size_t>(camera)]);
                          }};
  const FlowStage learning{.lanes = stream.cameras(),
                           .queue = kQueue,
                           .work = [&](std::int64_t sample, int camera) -> Result<bool> {
                             const auto index = static_cast<std::size_t>(camera);
                             VANTAGE_RETURN_IF_ERROR(stream.Rehearse(
                                 camera, pictures[sample][index], masks[sample][index]));
                             return true;
                           }};
  const FlowStage measuring{.work = [&](std::int64_t sample, int) -> Result<bool> {
    if (meter != nullptr && sample >= first_measured) {
      VANTAGE_RETURN_IF_ERROR(meter->Add(masks[sample]));
    }
    return true;
  }};
  const auto flow = RunFlow(std::vector{reading, learning, measuring}, threads, control);
  return flow ? Status() : tl::unexpected(flow.error());
}

}  // namespace

Result<Rehearsed> Rehearse(const Scene& scene, const BackgroundOptions& options, int threads,
                           const RunControl& control) {
  const Stopwatch stopwatch;
  VANTAGE_ASSIGN_OR_RETURN(MaskStream stream, MaskStream::Create(scene, options, threads));
  const bool learns =
      std::ranges::any_of(stream.subtractors(), [](const auto& camera) { return !!camera; });
  const bool keeps = learns && options.rehearsal.rehearsal_secs > 0;
  std::optional<PersonSizeMeter> meter;
  if (!scene.person.IsGiven()) {
    std::vector<Camera> cameras;
    for (const SceneCamera& camera : scene.cameras) cameras.push_back(camera.camera);
    meter.emplace(std::move(cameras), scene.area, scene.person.shape);
  }
  std::optional<PersonSizeReport> measured;
  if (keeps || meter) {
    const RehearsalPlan plan = PlanRehearsal(keeps ? options.rehearsal : RehearsalOptions(),
                                             stream.frame_count(), scene.frames_per_second);
    VANTAGE_RETURN_IF_ERROR(GoOver(stream, plan, meter ? &*meter : nullptr,
                                   learns ? plan.samples / 4 : 0, threads, control));
    if (meter) measured = meter->Report();
    VANTAGE_RETURN_IF_ERROR(stream.Rewind(scene, options, keeps));
  }
  PersonReport person = ResolvePerson(scene, std::move(measured));
  return Rehearsed{
      .stream = std::move(stream), .person = std::move(person), .seconds = stopwatch.Seconds()};
}

}  // namespace vantage
