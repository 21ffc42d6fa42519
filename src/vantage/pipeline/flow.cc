// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/pipeline/flow.h"

#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

#include <algorithm>
#include <limits>
#include <mutex>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>

#include "vantage/base/stopwatch.h"

namespace vantage {
namespace {

constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

/// One frame in one lane of a stage.
struct Piece {
  std::size_t stage = 0;
  int lane = 0;
  std::int64_t frame = 0;
};

/// How far a lane is.
struct LaneState {
  std::int64_t begun = 0;     ///< frames begun: they begin in order
  std::int64_t finished = 0;  ///< frames 0 to finished - 1 are
  std::set<std::int64_t> finished_beyond;
};

class Flow {
 public:
  Flow(std::span<const FlowStage> stages, int threads, const RunControl& control)
      : stages_(stages), threads_(std::max(threads, 1)), control_(control) {
    for (const FlowStage& stage : stages)
      lanes_.emplace_back(static_cast<std::size_t>(stage.lanes));
    report_.stage_secs.resize(stages.size());
  }

  Result<FlowReport> Run() {
    const Stopwatch stopwatch;
    if (threads_ == 1) {
      Work();
    } else {
      tbb::task_arena arena(threads_);
      arena.execute([this] { workers_.run_and_wait([this] { Work(); }); });
    }
    if (cancelled_) return Cancelled();
    if (error_) return tl::unexpected(*error_);
    report_.frames = Finished(stages_.size() - 1);
    report_.wall_secs = stopwatch.Seconds();
    report_.idle_secs = std::max(
        0.0, report_.wall_secs * threads_ -
                 std::accumulate(report_.stage_secs.begin(), report_.stage_secs.end(), 0.0));
    return std::move(report_);
  }

 private:
  /// Does pieces of work until none can be begun. Nobody waits for one: a worker leaves, and the
  /// one who finishes what others needed hires anew. So oneTBB's threads are free for loops inside
  /// of the pieces, and never more of them run than there are.
  void Work() {
    std::unique_lock lock(mutex_);
    --hired_;
    while (std::optional<Piece> piece = Next()) {
      LaneState& lane = lanes_[piece->stage][static_cast<std::size_t>(piece->lane)];
      ++lane.begun;
      ++working_;
      Hire(CountReady(threads_));
      lock.unlock();
      double secs = 0;
      Stopwatch stopwatch;
      const Result<bool> result = stages_[piece->stage].work(piece->frame, piece->lane);
      stopwatch.LapInto(secs);
      lock.lock();
      --working_;
      report_.stage_secs[piece->stage] += secs;
      if (!result || !*result) {
        End(*piece, result);
      } else if (piece->frame == lane.finished) {
        ++lane.finished;
        while (lane.finished_beyond.erase(lane.finished) > 0) ++lane.finished;
      } else {
        lane.finished_beyond.insert(piece->frame);
      }
    }
  }

  /// Workers for `ready` pieces, less those who are on their way.
  void Hire(int ready) {
    while (threads_ > 1 && hired_ < ready && hired_ + working_ < threads_) {
      ++hired_;
      workers_.run([this] { Work(); });
    }
  }

  /// What can be begun: as far along the chain as possible, so that queues stay short, and there
  /// the earliest frame.
  std::optional<Piece> Next() {
    if (control_.Stopped()) cancelled_ = true;
    if (cancelled_) return std::nullopt;
    for (std::size_t stage = stages_.size(); stage-- > 0;) {
      std::optional<Piece> best;
      for (int lane = 0; lane < stages_[stage].lanes; ++lane) {
        const Piece piece{stage, lane, lanes_[stage][static_cast<std::size_t>(lane)].begun};
        if ((!best || piece.frame < best->frame) && CanBegin(piece)) best = piece;
      }
      if (best) return best;
    }
    return std::nullopt;
  }

  /// Lanes that can begin a frame, at most `most`.
  int CountReady(int most) const {
    int ready = 0;
    for (std::size_t stage = 0; stage < stages_.size(); ++stage) {
      for (int lane = 0; lane < stages_[stage].lanes && ready < most; ++lane) {
        const LaneState& state = lanes_[stage][static_cast<std::size_t>(lane)];
        // Of a lane without order a second frame may be ready, too; who begins the first hires
        // for it.
        if (CanBegin({stage, lane, state.begun})) ++ready;
      }
    }
    return ready;
  }

  bool CanBegin(const Piece& piece) const {
    const auto [index, lane, frame] = piece;
    const FlowStage& stage = stages_[index];
    if (std::tuple(frame, index) > std::tuple(end_frame_, end_stage_)) return false;
    const LaneState& state = lanes_[index][static_cast<std::size_t>(lane)];
    if (stage.in_order && state.begun != state.finished) return false;
    if (index > 0 && frame >= FinishedFor(index - 1, piece)) return false;
    if (index + 1 < stages_.size() && frame >= FinishedFor(index + 1, piece) + stage.queue) {
      return false;
    }
    return !stage.returned || stage.returned(frame) <= Finished(stages_.size() - 1);
  }

  /// Frames that all lanes of a stage have finished.
  std::int64_t Finished(std::size_t stage) const {
    std::int64_t finished = kNever;
    for (const LaneState& lane : lanes_[stage]) finished = std::min(finished, lane.finished);
    return finished;
  }

  /// Frames that a neighbouring stage has finished as far as this piece's lane is concerned.
  std::int64_t FinishedFor(std::size_t neighbour, const Piece& piece) const {
    return stages_[neighbour].lanes == stages_[piece.stage].lanes
               ? lanes_[neighbour][static_cast<std::size_t>(piece.lane)].finished
               : Finished(neighbour);
  }

  /// An error or the end of the recording; an earlier one replaces a later one.
  void End(const Piece& piece, const Result<bool>& result) {
    const std::tuple place(piece.frame, piece.stage);
    const std::tuple end(end_frame_, end_stage_);
    if (place > end) return;
    if (place < end) {
      std::tie(end_frame_, end_stage_) = place;
      error_.reset();
      error_lane_ = std::numeric_limits<int>::max();
    }
    if (result || piece.lane > error_lane_) return;
    error_ = result.error();
    error_lane_ = piece.lane;
  }

  std::span<const FlowStage> stages_;
  int threads_;
  const RunControl& control_;
  tbb::task_group workers_;

  std::mutex mutex_;  // guards what follows
  std::vector<std::vector<LaneState>> lanes_;
  int hired_ = 1;    // workers who have not begun; the first is Run's
  int working_ = 0;  // pieces under way
  std::int64_t end_frame_ = kNever;
  std::size_t end_stage_ = 0;
  std::optional<Error> error_;
  int error_lane_ = 0;
  bool cancelled_ = false;
  FlowReport report_;
};

}  // namespace

Result<FlowReport> RunFlow(std::span<const FlowStage> stages, int threads,
                           const RunControl& control) {
  return Flow(stages, threads, control).Run();
}

}  // namespace vantage
