// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/extension.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "vantage/base/stopwatch.h"

namespace vantage {
namespace {

// People half a metre wide look the same from places this near to each other.
constexpr double kFinest_m = 0.2;

double Area(const PixelBox& box) {
  return std::max(box.width(), 0.0) * std::max(box.height(), 0.0);
}

PixelBox Intersection(const PixelBox& a, const PixelBox& b) {
  return {std::max(a.min_x, b.min_x), std::max(a.min_y, b.min_y), std::min(a.max_x, b.max_x),
          std::min(a.max_y, b.max_y)};
}

/// The part of a person that is in the picture; nothing where there is none.
std::optional<PixelBox> VisibleBox(const Camera& camera, const Eigen::Vector2d& foot_m,
                                   const PersonOptions& person) {
  const std::optional<PixelBox> box = PersonBox(camera, foot_m, person);
  if (!box) return std::nullopt;
  const PixelBox picture{-0.5, -0.5, camera.size().width - 0.5, camera.size().height - 0.5};
  const PixelBox visible = Intersection(*box, picture);
  if (!(visible.width() > 0 && visible.height() > 0)) return std::nullopt;
  return visible;
}

/// The area and everything that may become its extension.
struct Surroundings {
  GroundGrid grid;
  int around = 0;                     // cells on each side of the area
  std::vector<std::uint8_t> inside;   // per cell
  std::vector<std::uint8_t> visible;  // per cell: some camera speaks for it

  /// Cell at step `along` of the line that is `distance` cells (0: next to the area) beyond `side`.
  CellIndex OnLine(std::size_t side, int distance, int along) const {
    switch (side) {
      case 0:
        return grid.Index(around - 1 - distance, along);
      case 1:
        return grid.Index(grid.columns - around + distance, along);
      case 2:
        return grid.Index(along, around - 1 - distance);
      default:
        return grid.Index(along, grid.rows - around + distance);
    }
  }
  int LineLength(std::size_t side) const { return side < 2 ? grid.rows : grid.columns; }

  template <class Predicate>
  bool AnyOnLine(std::size_t side, int distance, Predicate predicate) const {
    for (int along = 0; along < LineLength(side); ++along) {
      if (predicate(OnLine(side, distance, along))) return true;
    }
    return false;
  }
};

/// The rectangles of the cells inside that a camera speaks for, as far as somebody outside can
/// cover them: the border. Seen from outside, whatever is deeper inside along the same line of
/// sight is covered less, before the area as well as behind it.
class Border {
 public:
  Border(const Camera& camera, const CameraView& view, const Surroundings& around,
         const PersonOptions& person) {
    const GroundGrid& grid = around.grid;
    const auto spoken_for_inside = [&](int column, int row) {
      if (column < 0 || row < 0 || column >= grid.columns || row >= grid.rows) return false;
      const auto cell = static_cast<std::size_t>(grid.Index(column, row));
      return around.inside[cell] != 0 && !view.rectangles[cell].empty();
    };
    for (CellIndex cell = 0; cell < grid.count(); ++cell) {
      const int column = grid.Column(cell), row = grid.Row(cell);
      if (!spoken_for_inside(column, row)) continue;
      bool surrounded = true;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          surrounded = surrounded && spoken_for_inside(column + dx, row + dy);
        }
      }
      if (surrounded) continue;
      if (const auto box = VisibleBox(camera, grid.Center(cell), person)) boxes_.push_back(*box);
    }
    std::sort(boxes_.begin(), boxes_.end(), [](const PixelBox& a, const PixelBox& b) {
      return a.min_x + a.max_x < b.min_x + b.max_x;
    });
  }

  /// True when `box` covers at least this share of some rectangle.
  bool IsCovered(const PixelBox& box, double share) const {
    // A rectangle of width w is covered over at least w s, so that w <= width / s, and its centre
    // is no farther than w (1/2 - s) outside of the box.
    const double margin = box.width() * std::max(0.5 / share - 1, 0.0);
    const auto first = std::lower_bound(
        boxes_.begin(), boxes_.end(), 2 * (box.min_x - margin),
        [](const PixelBox& inside, double sum) { return inside.min_x + inside.max_x < sum; });
    for (auto inside = first; inside != boxes_.end(); ++inside) {
      if (inside->min_x + inside->max_x > 2 * (box.max_x + margin)) return false;
      if (Area(Intersection(*inside, box)) >= share * Area(*inside)) return true;
    }
    return false;
  }

 private:
  std::vector<PixelBox> boxes_;  // by their centres' x
};

/// How many cells beyond `side` this camera needs.
int CellsNeeded(const Camera& camera, const Border& border, const Surroundings& around,
                std::size_t side, const PersonOptions& person, double share) {
  for (int distance = around.around - 1; distance >= 0; --distance) {
    if (around.AnyOnLine(side, distance, [&](CellIndex cell) {
          if (around.visible[static_cast<std::size_t>(cell)] == 0) return false;
          const auto box = VisibleBox(camera, around.grid.Center(cell), person);
          return box && border.IsCovered(*box, share);
        })) {
      return distance + 1;
    }
  }
  return 0;
}

ExtensionReason ReasonOf(const Surroundings& around, std::size_t side, int cells) {
  if (cells == around.around) return ExtensionReason::kBounded;
  for (int distance = cells; distance < around.around; ++distance) {
    if (around.AnyOnLine(side, distance, [&](CellIndex cell) {
          return around.visible[static_cast<std::size_t>(cell)] != 0;
        })) {
      return cells > 0 ? ExtensionReason::kCovers : ExtensionReason::kNone;
    }
  }
  return ExtensionReason::kUnseen;
}

}  // namespace

std::string_view TextOf(ExtensionReason reason) {
  switch (reason) {
    case ExtensionReason::kGiven:
      return "given";
    case ExtensionReason::kCovers:
      return "covered inside cells from there";
    case ExtensionReason::kBounded:
      return "bounded by max_extension";
    case ExtensionReason::kUnseen:
      return "nobody is seen farther";
    case ExtensionReason::kNone:
      return "nobody outside covers a cell inside";
  }
  return "";
}

std::string_view NameOf(ExtensionReason reason) {
  switch (reason) {
    case ExtensionReason::kGiven:
      return "given";
    case ExtensionReason::kCovers:
      return "covers";
    case ExtensionReason::kBounded:
      return "bounded";
    case ExtensionReason::kUnseen:
      return "unseen";
    case ExtensionReason::kNone:
      return "none";
  }
  return "";
}

Result<ExtensionReport> ChooseExtension(const Polygon& area, const GridOptions& options,
                                        std::span<const Camera> cameras,
                                        const PersonOptions& person, Visibility visibility) {
  VANTAGE_RETURN_IF_ERROR(ValidateOptions(options, "grid"));
  VANTAGE_RETURN_IF_ERROR(ValidateOptions(person, "person"));
  ExtensionReport report;
  if (options.extension_m) {
    for (ExtensionSide& side : report.sides) side.extension_m = *options.extension_m;
    return report;
  }
  if (cameras.empty()) return Fail("grid.extension is auto without any camera; give metres");
  const Stopwatch stopwatch;
  const double cell_m =
      options.cell_m * std::max(1.0, std::floor(kFinest_m / options.cell_m + 1e-9));
  Surroundings around;
  around.around = static_cast<int>(std::floor(options.max_extension_m / cell_m + 1e-9));
  VANTAGE_ASSIGN_OR_RETURN(
      around.grid, GroundGrid::Cover(area, cell_m, Extension::Uniform(around.around * cell_m)));
  around.inside.resize(static_cast<std::size_t>(around.grid.count()));
  for (CellIndex cell = 0; cell < around.grid.count(); ++cell) {
    around.inside[static_cast<std::size_t>(cell)] = area.Contains(around.grid.Center(cell));
  }
  std::vector<CameraView> views;
  for (const Camera& camera : cameras) {
    VANTAGE_ASSIGN_OR_RETURN(CameraView view,
                             BuildView(camera, around.grid, person, visibility, 1));
    views.push_back(std::move(view));
  }
  around.visible = VisibleCells(views);
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    const Border border(cameras[c], views[c], around, person);
    for (std::size_t s = 0; s < report.sides.size(); ++s) {
      ExtensionSide& side = report.sides[s];
      const int cells = CellsNeeded(cameras[c], border, around, s, person, options.covering_share);
      side.cameras_m.push_back(cells * cell_m);
      if (side.cameras_m.back() > side.extension_m) {
        side.extension_m = side.cameras_m.back();
        side.camera = c;
      }
    }
  }
  for (std::size_t s = 0; s < report.sides.size(); ++s) {
    const long cells = std::lround(report.sides[s].extension_m / cell_m);
    report.sides[s].reason = ReasonOf(around, s, static_cast<int>(cells));
  }
  report.seconds = stopwatch.Seconds();
  return report;
}

}  // namespace vantage
