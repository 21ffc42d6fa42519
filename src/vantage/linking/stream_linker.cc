// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/stream_linker.h"

#include <algorithm>
#include <deque>
#include <limits>
#include <new>
#include <unordered_map>
#include <utility>

#include "vantage/linking/flow_solver.h"
#include "vantage/linking/network.h"

namespace vantage {

using linking::Node;
using linking::NodeId;

namespace {

tl::unexpected<Error> NotEnoughMemory() {
  return Fail("linking: not enough memory for the stream; use larger cells or a shorter lag");
}

}  // namespace

class StreamLinker::State {
 public:
  State(linking::Network network, std::int64_t lag_frames)
      : network_(std::move(network)),
        lag_frames_(lag_frames),
        solver_(network_, linking::kNoSweeps) {
    solver_.OpenEnd();
  }

  Result<std::optional<StreamFrame>> Add(std::span<const float> probability) {
    if (report_.frames == std::numeric_limits<std::int32_t>::max()) {
      return Fail("linking: a stream has at most 2^31 - 1 frames; begin a new one");
    }
    VANTAGE_RETURN_IF_ERROR(linking::CheckFrame(network_, probability, report_.frames));
    maps_.emplace_back(probability.begin(), probability.end());
    solver_.AddFrame(maps_.back());
    solver_.Settle({});
    ++report_.frames;
    if (report_.frames <= lag_frames_) return std::optional<StreamFrame>();
    return std::optional(MakeFirstFrameFinal());
  }

  std::vector<StreamFrame> Tentative() const {
    std::vector<StreamFrame> frames;
    Numbering numbering = numbering_;
    for (std::int64_t frame = report_.final_frames; frame < report_.frames; ++frame) {
      frames.push_back(PositionsIn(frame, numbering));
    }
    return frames;
  }

  std::vector<StreamFrame> Finish() {
    std::vector<StreamFrame> frames;
    if (report_.final_frames < report_.frames) {
      solver_.CloseEnd();
      solver_.Settle({});
    }
    while (report_.final_frames < report_.frames) frames.push_back(MakeFirstFrameFinal());
    return frames;
  }

  const StreamReport& report() const { return report_; }

 private:
  /// The ids of the paths that go on into a frame, by their nodes there, and the last id given.
  struct Numbering {
    std::unordered_map<NodeId, PathId> ids;
    PathId last = 0;
  };

  /// The paths in a frame; carries `numbering` on to the frame after it.
  StreamFrame PositionsIn(std::int64_t frame, Numbering& numbering) const {
    std::vector<std::pair<CellIndex, NodeId>> nodes;
    solver_.nodes().ForEach(frame, [&](NodeId id) {
      const Node& node = solver_.nodes()[id];
      if (!node.Carries()) return;
      nodes.emplace_back(static_cast<CellIndex>(network_.Cell(node.column, node.row)), id);
    });
    std::sort(nodes.begin(), nodes.end());
    StreamFrame result = {.frame = frame, .positions = {}};
    std::unordered_map<NodeId, PathId> next;
    for (const auto& [cell, id] : nodes) {
      const Node& node = solver_.nodes()[id];
      const PathId path =
          node.link[linking::kIn] == linking::kToEdge ? ++numbering.last : numbering.ids.at(id);
      if (linking::IsNode(node.link[linking::kOut])) next.emplace(node.link[linking::kOut], path);
      result.positions.push_back({path, cell});
    }
    numbering.ids = std::move(next);
    std::sort(result.positions.begin(), result.positions.end(),
              [](const StreamPosition& a, const StreamPosition& b) { return a.path < b.path; });
    return result;
  }

  StreamFrame MakeFirstFrameFinal() {
    StreamFrame frame = PositionsIn(report_.final_frames, numbering_);
    cost_ += solver_.FrameCost(report_.final_frames);
    solver_.DropFrame();
    maps_.pop_front();
    ++report_.final_frames;
    report_.paths = numbering_.last;
    report_.cost = static_cast<double>(cost_) / linking::kUnitsPerCost;
    return frame;
  }

  const linking::Network network_;
  const std::int64_t lag_frames_;
  linking::FlowSolver solver_;
  std::deque<std::vector<float>> maps_;  // of the frames that are not final
  Numbering numbering_;
  linking::Cost cost_ = 0;
  StreamReport report_;
};

Result<StreamLinker> StreamLinker::Create(const StreamGrid& grid, const LinkingOptions& options,
                                          std::int64_t lag_frames) {
  if (lag_frames < 1) {
    return Fail("linking: the lag is {} frames; it must be at least 1", lag_frames);
  }
  if (options.max_paths > 0) {
    return Fail(
        "linking.max_paths is {}, and the paths of a stream are not known at once; leave it at 0",
        options.max_paths);
  }
  LinkingOptions stream_options = options;
  stream_options.inside_cost = options.inside_cost.value_or(kInsideCostOfStreams);
  try {
    VANTAGE_ASSIGN_OR_RETURN(linking::Network network, linking::MakeNetwork(grid, stream_options));
    return StreamLinker(std::make_unique<State>(std::move(network), lag_frames));
  } catch (const std::bad_alloc&) {
    return NotEnoughMemory();
  }
}

StreamLinker::StreamLinker(std::unique_ptr<State> state) : state_(std::move(state)) {}
StreamLinker::StreamLinker(StreamLinker&&) noexcept = default;
StreamLinker& StreamLinker::operator=(StreamLinker&&) noexcept = default;
StreamLinker::~StreamLinker() = default;

Result<std::optional<StreamFrame>> StreamLinker::Add(std::span<const float> probability) {
  try {
    return state_->Add(probability);
  } catch (const std::bad_alloc&) {
    return NotEnoughMemory();
  }
}
std::vector<StreamFrame> StreamLinker::Tentative() const { return state_->Tentative(); }
std::vector<StreamFrame> StreamLinker::Finish() { return state_->Finish(); }
const StreamReport& StreamLinker::report() const { return state_->report(); }

}  // namespace vantage
