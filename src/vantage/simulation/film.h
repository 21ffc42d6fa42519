// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "vantage/base/result.h"
#include "vantage/base/run_control.h"
#include "vantage/simulation/stage.h"

namespace vantage::simulation {

/// One thing in the picture of one camera.
struct Sighting {
  int id = 0;
  /// Pixels that it would cover if nothing stood in front of it, and those of them that show it.
  /// Only pixels in the picture count; a pixel is what the ray through its centre meets.
  std::int64_t pixels = 0;
  std::int64_t visible_pixels = 0;
  cv::Rect box;  ///< around all of `pixels`, hidden ones too
};

struct Shot {
  cv::Mat picture;                  ///< CV_8UC3 blue green red, as the sensor gives it
  cv::Mat mask;                     ///< CV_8UC1: 255 where foreground is seen at the pixel's centre
  std::vector<Sighting> sightings;  ///< people and foreground objects with pixels > 0, by id
};

struct FilmReport {
  std::int64_t shots = 0;    ///< pictures of all cameras
  double pixels = 0;         ///< of these pictures
  double pixels_traced = 0;  ///< of them traced anew
  double setup_secs = 0;     ///< wall-clock: what never changes, once
  double trace_secs = 0;
};

/// Films a stage by ray tracing (Embree). What never changes is traced once, with many rays a
/// pixel; then only tiles of a picture that something which moved touches: itself, its shadow, its
/// reflection. The pictures are functions of stage, seed and frame: neither the number of threads
/// nor the frames asked for before change a bit.
class Film {
 public:
  /// Fails when the stage is inconsistent (an index of a material out of range, numbers that are
  /// not finite, no camera) or Embree cannot be set up. The stage must outlive the film.
  static Result<Film> Create(const Stage& stage, std::uint64_t seed, int threads,
                             const RunControl& control = {});
  Film(Film&&) noexcept;
  Film& operator=(Film&&) noexcept;
  ~Film();

  /// Pictures and truth of all cameras at one frame. Fast when frames are asked for in order.
  Result<std::vector<Shot>> Shoot(FrameIndex frame, int threads);

  const FilmReport& report() const;

 private:
  struct State;
  explicit Film(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace vantage::simulation
