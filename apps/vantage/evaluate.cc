// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "command.h"
#include "evaluate_masks.h"
#include "evaluate_tracks.h"

namespace vantage::app {

Command EvaluateCommand() {
  return {.name = "evaluate",
          .summary = "Measure results against the truth",
          .define = [](CLI::App& app) -> Action {
            app.require_subcommand(1);
            CLI::App* tracks = app.add_subcommand(
                "tracks",
                "CLEAR MOT, identity, detection and HOTA measures. Both files are Vantage's CSV or "
                "MOTChallenge's text; frames of the latter, counted from 1, are lowered by one");
            CLI::App* masks = app.add_subcommand(
                "masks",
                "Masks of what moves against labelled truth: the change-detection measures");
            for (CLI::App* kind : {tracks, masks})
              kind->fallthrough();  // the flags of every command
            const Action evaluate_tracks = DefineEvaluateTracks(*tracks);
            const Action evaluate_masks = DefineEvaluateMasks(*masks);
            return [masks, evaluate_tracks, evaluate_masks](const CommonFlags& common) {
              return masks->parsed() ? evaluate_masks(common) : evaluate_tracks(common);
            };
          }};
}

}  // namespace vantage::app
