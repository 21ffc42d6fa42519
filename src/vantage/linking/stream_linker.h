// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "vantage/base/ids.h"
#include "vantage/base/result.h"
#include "vantage/linking/linker.h"

namespace vantage {

/// Number of a path in a stream, counted from 1; given out once and never changed.
using PathId = std::int64_t;

struct StreamPosition {
  PathId path = 0;
  CellIndex cell = 0;
  friend bool operator==(const StreamPosition&, const StreamPosition&) = default;
};

/// LinkingOptions::inside_cost where nothing else is said.
inline constexpr double kInsideCostOfStreams = 45;

/// Where all paths are in one frame; by path id.
struct StreamFrame {
  std::int64_t frame = 0;
  std::vector<StreamPosition> positions;
  friend bool operator==(const StreamFrame&, const StreamFrame&) = default;
};

/// The grid of a stream; spans as in LinkingProblem, copied.
struct StreamGrid {
  int columns = 0;
  int rows = 0;
  std::span<const std::uint8_t> access;
  std::span<const std::uint8_t> obstacle;
  /// Needed, > 0, unless LinkingOptions::depth is given.
  double cell_m = 0;
  double frames_per_second = 0;
};

struct StreamReport {
  std::int64_t frames = 0;        ///< added
  std::int64_t final_frames = 0;  ///< whose positions are final
  std::int64_t paths = 0;         ///< ids given out
  /// Of the final positions, births and ends; after Finish the cost of the whole answer, which
  /// LinkPaths' optimum bounds from below.
  double cost = 0;
};

/// Links a stream with a fixed lag in bounded memory: the positions of a frame are final once
/// `lag_frames` >= 1 further frames are known. At every moment the paths through the frames that
/// are not final are the exact optimum among all that continue the final ones, where a path that
/// reaches the newest frame has not paid for its end yet (half of the birth cost: nobody knows
/// whether it ends there). With a lag of the whole recording the answer is that of LinkPaths, given
/// the same inside_cost. A frame costs time in proportion to what changes in the last frames.
class StreamLinker {
 public:
  /// Fails on options out of range, sizes that do not fit, lag_frames < 1, and options.max_paths >
  /// 0 (a cap counts the paths of a whole recording).
  static Result<StreamLinker> Create(const StreamGrid& grid, const LinkingOptions& options,
                                     std::int64_t lag_frames);
  StreamLinker(StreamLinker&&) noexcept;
  StreamLinker& operator=(StreamLinker&&) noexcept;
  ~StreamLinker();

  /// Adds the next frame's columns * rows probabilities. Returns the frame that is final now, if
  /// any. Fails, changing nothing, on a wrong size and on probabilities that are NaN or outside [0,
  /// 1]; and when memory is at its end, after which nothing may be called.
  Result<std::optional<StreamFrame>> Add(std::span<const float> probability);

  /// The paths in the frames that are not final, as far as is known now, the oldest frame first. A
  /// path that has no final position yet has the id that it would get now.
  std::vector<StreamFrame> Tentative() const;

  /// Ends the stream: the frames that were not final, the oldest first. Add must not follow.
  std::vector<StreamFrame> Finish();

  const StreamReport& report() const;

 private:
  class State;
  explicit StreamLinker(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace vantage
