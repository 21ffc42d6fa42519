// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "vantage/simulation/hash.h"

namespace vantage::simulation::internal {
namespace {

using Eigen::Vector3f;

int TilesFor(int pixels) { return (pixels + kTile_px - 1) / kTile_px; }

std::uint64_t PatternKey(int x, int y) { return Hash(0x7468696eU, x, y); }

}  // namespace

View::View(const FixedWorld& world, const StageCamera& camera, std::uint64_t seed, int index,
           int threads)
    : camera_(&camera),
      rays_(camera.camera),
      fixed_(world, rays_, threads),
      sensor_(camera, seed, index),
      tile_columns_(TilesFor(rays_.width())),
      tile_rows_(TilesFor(rays_.height())) {
  const std::size_t pixels = Pixel(0, rays_.height());
  front_.resize(pixels);
  mirrored_front_.resize(pixels);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    front_[pixel].t_m = fixed_.At(pixel).t_m;
    mirrored_front_[pixel].t_m = fixed_.At(pixel).mirror_t_m;
  }
  fixed_codes_.resize(pixels);
  codes_.resize(pixels);
  const auto tiles = static_cast<std::size_t>(tile_columns_) * static_cast<std::size_t>(tile_rows_);
  ground_tiles_.resize(tiles);
  tile_keys_.assign(tiles, 0);
  tile_changed_.assign(tiles, 0);
}

cv::Rect View::TilePixels(int column, int row) const {
  return cv::Rect(column * kTile_px, row * kTile_px, kTile_px, kTile_px) &
         cv::Rect(0, 0, rays_.width(), rays_.height());
}

Eigen::AlignedBox2f View::SeenGround() const {
  Eigen::AlignedBox2f seen;
  for (int y = 0; y < rays_.height(); ++y) {
    for (int x = 0; x < rays_.width(); ++x) {
      const FixedPoint& point = fixed_.At(Pixel(x, y));
      if (!point.ground) continue;
      const Ray ray = rays_.Through(x, y);
      seen.extend(Eigen::Vector2f((ray.origin_m + point.t_m * ray.direction).head<2>()));
    }
  }
  return seen;
}

void View::Connect(const GroundLight& ground) {
  for (int row = 0; row < tile_rows_; ++row) {
    for (int column = 0; column < tile_columns_; ++column) {
      std::vector<std::uint32_t>& tiles =
          ground_tiles_[static_cast<std::size_t>(row * tile_columns_ + column)];
      const cv::Rect pixels = TilePixels(column, row);
      for (int y = pixels.y; y < pixels.y + pixels.height; ++y) {
        for (int x = pixels.x; x < pixels.x + pixels.width; ++x) {
          const FixedPoint& point = fixed_.At(Pixel(x, y));
          if (!point.ground) continue;
          const Ray ray = rays_.Through(x, y);
          const auto tile = ground.TileAt((ray.origin_m + point.t_m * ray.direction).head<2>());
          if (tile) tiles.push_back(*tile);
        }
      }
      std::sort(tiles.begin(), tiles.end());
      tiles.erase(std::unique(tiles.begin(), tiles.end()), tiles.end());
    }
  }
}

void View::BeginFrame(const FrameLight& frame) {
  const auto clear = [&](const cv::Rect& box, std::vector<Front>& fronts, auto t_of) {
    for (int y = box.y; y < box.y + box.height; ++y) {
      for (int x = box.x; x < box.x + box.width; ++x) {
        fronts[Pixel(x, y)] = {t_of(fixed_.At(Pixel(x, y))), -1};
      }
    }
  };
  for (const ThingSights& last : sights_) {
    clear(last.direct.box, front_, [](const FixedPoint& point) { return point.t_m; });
    clear(last.mirrored.box, mirrored_front_,
          [](const FixedPoint& point) { return point.mirror_t_m; });
  }
  std::vector<ThingSights> last;
  last.swap(sights_);
  sights_.resize(frame.moving.size());
  std::size_t before = 0;
  for (std::size_t i = 0; i < frame.moving.size(); ++i) {
    const int id = frame.moving[i].thing.id;
    while (before < last.size() && last[before].id < id) ++before;
    if (before < last.size() && last[before].id == id && last[before].key == frame.moving[i].key) {
      sights_[i] = std::move(last[before]);
    } else {
      sights_[i].id = id;
      sights_[i].key = frame.moving[i].key;
    }
  }
}

void View::See(const FrameLight& frame, std::size_t thing) {
  ThingSights& sights = sights_[thing];
  if (sights.done && !frame.gains_changed) return;
  if (!sights.done) {
    sights.direct = SeeThing(camera_->camera, rays_, frame.moving[thing]);
    sights.mirrored =
        SeeThingMirrored(camera_->camera, rays_, frame.world, fixed_, frame.moving[thing]);
    sights.done = true;
  }
  const cv::Rect& area = sights.mirrored.area;
  sights.mirrored_light.assign(sights.mirrored.hits.size(), Vector3f::Zero());
  for (std::size_t i = 0; i < sights.mirrored.hits.size(); ++i) {
    const Hit& hit = sights.mirrored.hits[i];
    if (!hit.Exists()) continue;
    const auto at = static_cast<int>(i);
    const Ray ray =
        fixed_.MirroredRay(frame.world, rays_, area.x + at % area.width, area.y + at / area.width);
    sights.mirrored_light[i] = frame.moving.Radiance(
        frame.world, thing, hit, ray.origin_m + hit.t_m * ray.direction, ray.direction,
        frame.moving.OpenLightAt(frame.world, thing, hit), frame.gains);
  }
}

void View::Arrange(const FrameLight& frame) {
  visible_.assign(sights_.size(), 0);
  const auto place = [&](const Sight& sight, std::size_t thing, std::vector<Front>& fronts) {
    for (int y = sight.box.y; y < sight.box.y + sight.box.height; ++y) {
      for (int x = sight.box.x; x < sight.box.x + sight.box.width; ++x) {
        const Hit& hit = sight.At(x, y);
        Front& front = fronts[Pixel(x, y)];
        if (hit.t_m < front.t_m) front = {hit.t_m, static_cast<std::int16_t>(thing)};
      }
    }
  };
  std::vector<std::uint64_t> keys(tile_keys_.size(), 0);
  const cv::Rect picture(0, 0, rays_.width(), rays_.height());
  const auto touch = [&](cv::Rect box, std::uint64_t key) {
    if (box.empty()) return;
    // Pixels beside the thing show some of it, too.
    box = cv::Rect(box.x - 1, box.y - 1, box.width + 2, box.height + 2) & picture;
    for (int row = box.y / kTile_px; row <= (box.br().y - 1) / kTile_px; ++row) {
      for (int column = box.x / kTile_px; column <= (box.br().x - 1) / kTile_px; ++column) {
        std::uint64_t& tile = keys[static_cast<std::size_t>(row * tile_columns_ + column)];
        tile = Hash(tile, key);
      }
    }
  };
  for (std::size_t i = 0; i < sights_.size(); ++i) {
    place(sights_[i].direct, i, front_);
    place(sights_[i].mirrored, i, mirrored_front_);
    touch(sights_[i].direct.box, frame.moving.LitKey(i));
    touch(sights_[i].mirrored.box, ~frame.moving[i].key);
  }
  for (std::size_t i = 0; i < sights_.size(); ++i) {
    const cv::Rect& box = sights_[i].direct.box;
    for (int y = box.y; y < box.y + box.height; ++y) {
      for (int x = box.x; x < box.x + box.width; ++x) {
        if (front_[Pixel(x, y)].thing == static_cast<std::int16_t>(i)) ++visible_[i];
      }
    }
  }
  for (std::size_t tile = 0; tile < keys.size(); ++tile) {
    for (const std::uint32_t ground : ground_tiles_[tile]) {
      const std::uint64_t key = frame.ground.Key(ground);
      if (key != 0) keys[tile] = Hash(keys[tile], ground, key);
    }
    tile_changed_[tile] = frame.gains_changed || keys[tile] != tile_keys_[tile] ? 1 : 0;
  }
  tile_keys_ = std::move(keys);
}

std::int64_t View::ComposeRow(const FrameLight& frame, int tile_row) {
  std::int64_t traced = 0;
  for (int column = 0; column < tile_columns_; ++column) {
    const auto tile = static_cast<std::size_t>(tile_row * tile_columns_ + column);
    if (tile_changed_[tile] == 0) continue;
    const cv::Rect pixels = TilePixels(column, tile_row);
    for (int y = pixels.y; y < pixels.y + pixels.height; ++y) {
      const std::size_t begin = Pixel(pixels.x, y);
      for (int x = pixels.x; frame.gains_changed && x < pixels.x + pixels.width; ++x) {
        const std::size_t pixel = Pixel(x, y);
        fixed_codes_[pixel] = sensor_.Expose(
            fixed_.Diffuse(pixel, frame.gains) + fixed_.Mirrored(pixel, frame.gains), x, y);
      }
      std::copy_n(fixed_codes_.begin() + static_cast<std::ptrdiff_t>(begin), pixels.width,
                  codes_.begin() + static_cast<std::ptrdiff_t>(begin));
    }
    if (tile_keys_[tile] == 0) continue;
    ComposeTile(frame, pixels);
    traced += pixels.area();
  }
  return traced;
}

void View::ComposeTile(const FrameLight& frame, const cv::Rect& pixels) {
  for (int y = pixels.y; y < pixels.y + pixels.height; ++y) {
    for (int x = pixels.x; x < pixels.x + pixels.width; ++x) {
      const std::size_t pixel = Pixel(x, y);
      if (IsEdge(x, y)) {
        codes_[pixel] = sensor_.Expose(EdgeRadiance(frame, x, y), x, y);
      } else if (front_[pixel].thing >= 0) {
        codes_[pixel] = sensor_.Expose(FrontRadiance(frame, x, y), x, y);
      } else if (fixed_.At(pixel).ground) {
        const GroupShares shares = GroundShares(frame, x, y);
        const bool shaded =
            std::any_of(shares.begin(), shares.end(), [](float share) { return share != 1; });
        if (shaded || IsMirroring(x, y)) {
          codes_[pixel] = sensor_.Expose(Background(frame, x, y), x, y);
        }
      }
    }
  }
}

GroupShares View::GroundShares(const FrameLight& frame, int x, int y) const {
  const Ray ray = rays_.Through(x, y);
  return frame.ground.At((ray.origin_m + fixed_.At(Pixel(x, y)).t_m * ray.direction).head<2>());
}

bool View::IsMirroring(int x, int y) const {
  if (fixed_.At(Pixel(x, y)).mirror_t_m <= 0) return false;
  for (int ny = std::max(0, y - 1); ny <= std::min(rays_.height() - 1, y + 1); ++ny) {
    for (int nx = std::max(0, x - 1); nx <= std::min(rays_.width() - 1, x + 1); ++nx) {
      if (mirrored_front_[Pixel(nx, ny)].thing >= 0) return true;
    }
  }
  return false;
}

bool View::IsEdge(int x, int y) const {
  if (!rays_.Exists(x, y)) return false;
  const std::int16_t thing = front_[Pixel(x, y)].thing;
  return (x > 0 && front_[Pixel(x - 1, y)].thing != thing) ||
         (y > 0 && front_[Pixel(x, y - 1)].thing != thing) ||
         (x + 1 < rays_.width() && front_[Pixel(x + 1, y)].thing != thing) ||
         (y + 1 < rays_.height() && front_[Pixel(x, y + 1)].thing != thing);
}

Vector3f View::Background(const FrameLight& frame, int x, int y) const {
  const std::size_t pixel = Pixel(x, y);
  const FixedPoint& point = fixed_.At(pixel);
  if (!point.ground) {
    return fixed_.Diffuse(pixel, frame.gains) + fixed_.Mirrored(pixel, frame.gains);
  }
  GroupShares weights = GroundShares(frame, x, y);
  for (std::size_t group = 0; group < weights.size(); ++group) {
    weights[group] *= frame.gains[group];
  }
  const Vector3f diffuse = fixed_.Diffuse(pixel, weights);
  if (!IsMirroring(x, y)) return diffuse + fixed_.Mirrored(pixel, frame.gains);
  // Rough ground mirrors a spread of directions: those of the pixels around, each with its own.
  Vector3f sum(0, 0, 0);
  int count = 0;
  for (int ny = std::max(0, y - 1); ny <= std::min(rays_.height() - 1, y + 1); ++ny) {
    for (int nx = std::max(0, x - 1); nx <= std::min(rays_.width() - 1, x + 1); ++nx) {
      if (fixed_.At(Pixel(nx, ny)).mirror_t_m <= 0) continue;
      sum += MirroredLight(frame, nx, ny);
      ++count;
    }
  }
  return diffuse + point.mirror_share / static_cast<float>(count) * sum;
}

Vector3f View::MirroredLight(const FrameLight& frame, int x, int y) const {
  const std::size_t pixel = Pixel(x, y);
  const int thing = mirrored_front_[pixel].thing;
  if (thing < 0) return fixed_.Mirrored(pixel, frame.gains) / fixed_.At(pixel).mirror_share;
  const ThingSights& sights = sights_[static_cast<std::size_t>(thing)];
  return sights.mirrored_light[sights.mirrored.Index(x, y)];
}

Vector3f View::FrontRadiance(const FrameLight& frame, int x, int y) const {
  const auto thing = static_cast<std::size_t>(front_[Pixel(x, y)].thing);
  const Hit& hit = sights_[thing].direct.At(x, y);
  const Ray ray = rays_.Through(x, y);
  const Vector3f point = ray.origin_m + hit.t_m * ray.direction;
  const GroupShares light = frame.moving.LightAt(frame.world, thing, hit, point, PatternKey(x, y));
  return frame.moving.Radiance(frame.world, thing, hit, point, ray.direction, light, frame.gains);
}

Vector3f View::EdgeRadiance(const FrameLight& frame, int x, int y) const {
  // The things around, each lit once for the pixel.
  struct Candidate {
    std::size_t thing;
    bool lit;
    GroupShares light;
  };
  std::array<Candidate, 9> candidates;
  std::size_t count = 0;
  for (int ny = std::max(0, y - 1); ny <= std::min(rays_.height() - 1, y + 1); ++ny) {
    for (int nx = std::max(0, x - 1); nx <= std::min(rays_.width() - 1, x + 1); ++nx) {
      const int thing = front_[Pixel(nx, ny)].thing;
      if (thing < 0) continue;
      const auto index = static_cast<std::size_t>(thing);
      const Candidate* begin = candidates.data();
      if (std::none_of(begin, begin + count,
                       [&](const Candidate& known) { return known.thing == index; })) {
        candidates[count++] = {index, false, {}};
      }
    }
  }
  constexpr std::array<std::array<float, 2>, 4> kOffsets = {
      {{-0.125F, -0.375F}, {0.375F, -0.125F}, {0.125F, 0.375F}, {-0.375F, 0.125F}}};
  Vector3f sum(0, 0, 0);
  int open = 0;
  for (const auto& offset : kOffsets) {
    const Ray ray = rays_.Through(x, y, offset[0], offset[1]);
    Hit nearest;
    nearest.t_m = fixed_.At(Pixel(x, y)).t_m;
    Candidate* owner = nullptr;
    for (std::size_t i = 0; i < count; ++i) {
      const Hit hit = frame.moving[candidates[i].thing].solid.Trace(ray);
      if (hit.t_m < nearest.t_m) {
        nearest = hit;
        owner = &candidates[i];
      }
    }
    if (owner == nullptr) {
      ++open;
      continue;
    }
    const Vector3f point = ray.origin_m + nearest.t_m * ray.direction;
    if (!owner->lit) {
      owner->light =
          frame.moving.LightAt(frame.world, owner->thing, nearest, point, PatternKey(x, y));
      owner->lit = true;
    }
    sum += frame.moving.Radiance(frame.world, owner->thing, nearest, point, ray.direction,
                                 owner->light, frame.gains);
  }
  if (open > 0) sum += static_cast<float>(open) * Background(frame, x, y);
  return sum / static_cast<float>(kOffsets.size());
}

void View::ReadOut(FrameIndex frame, int tile_row, cv::Mat& picture) const {
  sensor_.ReadOut(codes_, frame, tile_row * kTile_px,
                  std::min(rays_.height(), (tile_row + 1) * kTile_px), picture);
}

cv::Mat View::Mask(const Moving& moving) const {
  cv::Mat mask = cv::Mat::zeros(rays_.height(), rays_.width(), CV_8UC1);
  for (std::size_t i = 0; i < sights_.size(); ++i) {
    const Thing& thing = moving[i].thing;
    if (!IsForeground(thing)) continue;
    const cv::Rect& box = sights_[i].direct.box;
    for (int y = box.y; y < box.y + box.height; ++y) {
      for (int x = box.x; x < box.x + box.width; ++x) {
        if (front_[Pixel(x, y)].thing == static_cast<std::int16_t>(i)) {
          mask.at<std::uint8_t>(y, x) = 255;
        }
      }
    }
  }
  return mask;
}

std::vector<Sighting> View::Sightings(const Moving& moving) const {
  std::vector<Sighting> sightings;
  for (std::size_t i = 0; i < sights_.size(); ++i) {
    const Sight& sight = sights_[i].direct;
    if (!IsForeground(moving[i].thing) || sight.pixels == 0) continue;
    sightings.push_back({moving[i].thing.id, sight.pixels, visible_[i], sight.box});
  }
  return sightings;
}

}  // namespace vantage::simulation::internal
