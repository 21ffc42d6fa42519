// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/film.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "vantage/base/parallel.h"
#include "vantage/base/stopwatch.h"
#include "vantage/simulation/ground_light.h"
#include "vantage/simulation/moving.h"
#include "vantage/simulation/solid.h"
#include "vantage/simulation/stage_check.h"
#include "vantage/simulation/view.h"
#include "vantage/simulation/world.h"

namespace vantage::simulation {

using internal::FrameLight;
using internal::GroupShares;
using internal::Moving;
using internal::View;

struct Film::State {
  internal::Device device;  // outlives everything made from it
  internal::FixedWorld world;
  std::vector<View> views;
  std::optional<internal::GroundLight> ground;
  Moving moving;
  std::vector<float> gains;  // of the last frame; empty before the first
  FilmReport report;
};

Film::Film(std::unique_ptr<State> state) : state_(std::move(state)) {}
Film::Film(Film&&) noexcept = default;
Film& Film::operator=(Film&&) noexcept = default;
Film::~Film() = default;

const FilmReport& Film::report() const { return state_->report; }

Result<Film> Film::Create(const Stage& stage, std::uint64_t seed, int threads,
                          const RunControl& control) {
  VANTAGE_RETURN_IF_ERROR(internal::CheckStage(stage));
  Stopwatch watch;
  auto state = std::make_unique<State>();
  VANTAGE_ASSIGN_OR_RETURN(state->device, internal::MakeDevice(threads));
  VANTAGE_ASSIGN_OR_RETURN(state->world, internal::FixedWorld::Create(state->device.get(), stage));
  const auto cameras = static_cast<std::int64_t>(stage.cameras.size());
  Eigen::AlignedBox2f seen;
  for (std::int64_t i = 0; i < cameras; ++i) {
    if (control.Stopped()) return Cancelled();
    control.Report(i, cameras);
    state->views.emplace_back(state->world, stage.cameras[static_cast<std::size_t>(i)], seed,
                              static_cast<int>(i), threads);
    seen.extend(state->views.back().SeenGround());
  }
  state->ground.emplace(state->world, seen);
  for (View& view : state->views) view.Connect(*state->ground);
  control.Report(cameras, cameras);
  watch.LapInto(state->report.setup_secs);
  return Film(std::move(state));
}

Result<std::vector<Shot>> Film::Shoot(FrameIndex frame, int threads) {
  State& state = *state_;
  const Stage& stage = state.world.stage();
  if (frame < 0 || frame >= stage.frames) {
    return Fail("frame {} is not one of the stage's {}, counted from 0", frame, stage.frames);
  }
  Stopwatch watch;
  std::vector<Thing> things = stage.script->At(frame);
  VANTAGE_RETURN_IF_ERROR(internal::CheckThings(stage, frame, things));
  const std::vector<float> gains = stage.script->Gains(frame);
  VANTAGE_RETURN_IF_ERROR(internal::CheckGains(stage, frame, gains));

  VANTAGE_ASSIGN_OR_RETURN(state.moving, Moving::Prepare(state.device.get(), state.world,
                                                         std::move(things), state.moving));
  state.ground->Update(state.world, state.moving, threads);
  FrameLight light{state.world, state.moving, *state.ground, {}, gains != state.gains};
  std::copy(gains.begin(), gains.end(), light.gains.begin());
  state.gains = gains;

  std::vector<View>& views = state.views;
  const auto cameras = static_cast<std::int64_t>(views.size());
  const auto count = static_cast<std::int64_t>(state.moving.size());
  ParallelFor(threads, cameras,
              [&](std::int64_t i) { views[static_cast<std::size_t>(i)].BeginFrame(light); });
  ParallelFor(threads, cameras * count, [&](std::int64_t i) {
    views[static_cast<std::size_t>(i / count)].See(light, static_cast<std::size_t>(i % count));
  });
  ParallelFor(threads, cameras,
              [&](std::int64_t i) { views[static_cast<std::size_t>(i)].Arrange(light); });

  std::vector<Shot> shots(views.size());
  struct TileRow {
    std::size_t view;
    int row;
    std::int64_t traced;
  };
  std::vector<TileRow> rows;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const ImageSize size = stage.cameras[i].camera.size();
    shots[i].picture.create(size.height, size.width, CV_8UC3);
    shots[i].mask = views[i].Mask(state.moving);
    shots[i].sightings = views[i].Sightings(state.moving);
    for (int row = 0; row < views[i].tile_rows(); ++row) rows.push_back({i, row, 0});
    state.report.pixels += static_cast<double>(size.width) * size.height;
  }
  ParallelFor(threads, static_cast<std::int64_t>(rows.size()), [&](std::int64_t i) {
    TileRow& row = rows[static_cast<std::size_t>(i)];
    row.traced = views[row.view].ComposeRow(light, row.row);
    views[row.view].ReadOut(frame, row.row, shots[row.view].picture);
  });
  for (const TileRow& row : rows) state.report.pixels_traced += static_cast<double>(row.traced);
  state.report.shots += cameras;
  watch.LapInto(state.report.trace_secs);
  return shots;
}

}  // namespace vantage::simulation
