// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "vantage/base/result.h"
#include "vantage/geometry/camera.h"
#include "vantage/geometry/grid.h"
#include "vantage/geometry/person.h"
#include "vantage/geometry/polygon.h"
#include "vantage/occupancy/views.h"
#include "vantage/scene/scene.h"

/// How far the grid must go beyond the area (thesis 4.4.2, its second proposal).
///
/// Somebody outside who covers, in some picture, part of where a person inside would be seen raises
/// the cell inside, unless a cell outside explains the silhouette. The grid must therefore hold
/// every place outside from which that can happen.
///
/// How far away that is depends on the angle at which the camera looks down. A camera H above the
/// ground looks at a border cell D away from its foot. People are h high. Somebody d *behind* the
/// border has the feet where the camera sees the height z = H d / (D + d) of the person at the
/// border, and covers the share 1 - z / h of that person above it. This is at least s while
///
///   d <= D (1 - s) h / (H - (1 - s) h),
///
/// the shadow that a lamp at the camera would cast of a person (1 - s) h high; about
/// (1 - s) h / tan(a) when the camera looks down at the angle a. (A little less: whoever stands
/// farther away is also narrower, by D / (D + d).) Somebody d *before* the border has
/// the head where the camera sees the height z = H - (H - h) D / (D - d), and covers the share
/// z / h below it:
///
///   d <= D (1 - s) h / (H - s h).
///
/// A camera no higher than (1 - s) h has no such limit, one straight above hardly needs any
/// extension. Lenses, pictures that end, areas that are no rectangles and people beside the line of
/// sight are not in these formulas; so the choice is made with the rectangles themselves.

namespace vantage {

/// Why the grid goes as far beyond a side of the area as it does.
enum class ExtensionReason {
  kGiven,    ///< the scene or the user says so
  kCovers,   ///< from there somebody covers a cell inside, from farther away nobody does
  kBounded,  ///< max_extension: from farther away somebody may
  kUnseen,   ///< nobody is seen farther away
  kNone,     ///< nobody outside covers a cell inside
};
/// E.g. "bounded by max_extension".
std::string_view TextOf(ExtensionReason reason);
/// E.g. "bounded", for files.
std::string_view NameOf(ExtensionReason reason);

/// One side of the area.
struct ExtensionSide {
  double extension_m = 0;
  ExtensionReason reason = ExtensionReason::kGiven;
  /// The camera that needs the most, the first of several; none when no camera needs any.
  std::optional<std::size_t> camera;
  /// What each camera needs for itself, metres; empty when given.
  std::vector<double> cameras_m;
};

struct ExtensionReport {
  /// In the order min_x, max_x, min_y, max_y.
  std::array<ExtensionSide, 4> sides;
  double seconds = 0;

  Extension extension() const {
    return {sides[0].extension_m, sides[1].extension_m, sides[2].extension_m, sides[3].extension_m};
  }
};
inline constexpr std::array<std::string_view, 4> kSideNames = {"min_x", "max_x", "min_y", "max_y"};

/// The extension that `grid` gives, or what the cameras (of the sizes of their masks) need: the
/// smallest rectangle of cells that holds the area and all cells within max_extension of it that
/// some camera speaks for and where somebody covers, in the picture of one, at least the share
/// `covering_share` of the rectangle of a cell inside that this camera speaks for. Cells smaller
/// than 0.1 m are taken together for this, in squares of at most 0.2 m. Fails as GroundGrid::Cover
/// does, and when an option breaks its rule.
Result<ExtensionReport> ChooseExtension(const Polygon& area, const GridOptions& grid,
                                        std::span<const Camera> cameras,
                                        const PersonOptions& person, Visibility visibility);

}  // namespace vantage
