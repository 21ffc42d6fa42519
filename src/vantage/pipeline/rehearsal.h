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
/// quarter apart, which come from a background that had hardly begun. Where too few people are seen
/// the lengths of PersonOptions are used, the width with CellAllowance_m.
///
/// Where there is to be no rehearsal people are measured all the same: in samples of masks that are
/// delivered ready, otherwise in every half second of the first 15 s, all of whose frames are
/// judged for that and forgotten. Where there is neither anything to learn nor to measure, nothing
/// is read. The sources are opened once more for what follows. What comes out does not depend on
/// `threads`. Fails as the sources do.
Result<Rehearsed> Rehearse(const Scene& scene, const BackgroundOptions& options, int threads,
                           const RunControl& control = {});

}  // namespace vantage
