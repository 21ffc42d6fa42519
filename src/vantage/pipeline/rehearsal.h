// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include "vantage/background/subtractor.h"
#include "vantage/base/result.h"
#include "vantage/base/run_control.h"
#include "vantage/pipeline/mask_stream.h"
#include "vantage/pipeline/person.h"
#include "vantage/scene/scene.h"

namespace vantage {

/// A recording that is ready for its first frame to be judged.
struct Rehearsed {
  MaskStream stream;
  PersonReport person;
  double seconds = 0;
};

/// Opens the sources of a scene and goes over the beginning of the recording once, in samples
/// (PlanRehearsal): cameras that deliver colour learn their background, and the lengths of a person
/// that the scene leaves open are measured in the masks (PersonSizeMeter), those of the first
/// quarter apart where they come from a background that had hardly begun. Where too few people are
/// seen the lengths of PersonOptions are used, the width with CellAllowance_m.
///
/// With options.rehearsal.rehearsal_secs of 0 people are measured all the same, in the default's
/// samples, and what the cameras learnt by that is forgotten. Where there is neither anything to
/// learn nor to measure, nothing is read. The sources are opened a second time for what follows.
/// What comes out does not depend on `threads`. Fails as the sources do.
Result<Rehearsed> Rehearse(const Scene& scene, const BackgroundOptions& options, int threads,
                           const RunControl& control = {});

}  // namespace vantage
