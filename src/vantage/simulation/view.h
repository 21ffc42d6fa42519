// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "vantage/simulation/film.h"
#include "vantage/simulation/fixed_view.h"
#include "vantage/simulation/ground_light.h"
#include "vantage/simulation/lens.h"
#include "vantage/simulation/moving.h"
#include "vantage/simulation/sensor.h"
#include "vantage/simulation/sight.h"
#include "vantage/simulation/world.h"

/// Internal to the simulation module: one camera's picture from frame to frame.

namespace vantage::simulation::internal {

/// Side of the tiles that a picture is brought up to date by.
inline constexpr int kTile_px = 16;

/// What a frame is made of, the same for all cameras.
struct FrameLight {
  const FixedWorld& world;
  const Moving& moving;
  const GroundLight& ground;
  GroupShares gains;
  bool gains_changed;  ///< since the frame before
};

/// The steps of a frame, in order: BeginFrame, SeeThing for each thing, Arrange, ComposeRows for
/// all rows of tiles, ReadOut. Those by thing or row may run in parallel.
class View {
 public:
  View(const FixedWorld& world, const StageCamera& camera, std::uint64_t seed, int index,
       int threads);

  /// The part of the ground that this camera sees.
  Eigen::AlignedBox2f SeenGround() const;
  /// Notes which tiles of the ground's light map each tile of the picture needs.
  void Connect(const GroundLight& ground);

  /// Takes over the sights of things that stayed.
  void BeginFrame(const FrameLight& frame);
  void See(const FrameLight& frame, std::size_t thing);
  /// Finds what each pixel shows and which tiles changed.
  void Arrange(const FrameLight& frame);
  /// Pixels traced anew in a row of tiles.
  std::int64_t ComposeRow(const FrameLight& frame, int tile_row);
  int tile_rows() const { return tile_rows_; }
  void ReadOut(FrameIndex frame, int tile_row, cv::Mat& picture) const;

  /// The truth of the frame.
  cv::Mat Mask(const Moving& moving) const;
  std::vector<Sighting> Sightings(const Moving& moving) const;

 private:
  /// The nearest thing of a pixel.
  struct Front {
    float t_m = 0;            ///< of it, else of the fixed world
    std::int16_t thing = -1;  ///< none
  };
  struct ThingSights {
    int id = 0;
    std::uint64_t key = 0;
    bool done = false;
    Sight direct;
    Sight mirrored;
    std::vector<Eigen::Vector3f> mirrored_light;  ///< radiance at the hits of `mirrored`
  };

  std::size_t Pixel(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(rays_.width()) +
           static_cast<std::size_t>(x);
  }
  cv::Rect TilePixels(int column, int row) const;
  void ComposeTile(const FrameLight& frame, const cv::Rect& pixels);
  bool IsEdge(int x, int y) const;
  GroupShares GroundShares(const FrameLight& frame, int x, int y) const;
  /// Whether a moving thing is mirrored at the pixel or beside it.
  bool IsMirroring(int x, int y) const;
  /// Radiance that comes to the mirror from where it looks.
  Eigen::Vector3f MirroredLight(const FrameLight& frame, int x, int y) const;
  Eigen::Vector3f Background(const FrameLight& frame, int x, int y) const;
  Eigen::Vector3f EdgeRadiance(const FrameLight& frame, int x, int y) const;
  Eigen::Vector3f FrontRadiance(const FrameLight& frame, int x, int y) const;

  const StageCamera* camera_;
  PixelRays rays_;
  FixedView fixed_;
  Sensor sensor_;
  int tile_columns_;
  int tile_rows_;
  std::vector<std::vector<std::uint32_t>> ground_tiles_;  // that each tile of the picture shows

  std::vector<ThingSights> sights_;  // of the frame's things
  std::vector<Front> front_;
  std::vector<Front> mirrored_front_;
  std::vector<std::int64_t> visible_;  // pixels of each thing
  std::vector<std::uint64_t> tile_keys_;
  std::vector<std::uint8_t> tile_changed_;
  std::vector<LightCode> fixed_codes_;  // of the fixed world in the frame's light
  std::vector<LightCode> codes_;
};

}  // namespace vantage::simulation::internal
