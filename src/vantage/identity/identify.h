// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "vantage/base/options.h"
#include "vantage/base/result.h"
#include "vantage/base/run_control.h"
#include "vantage/identity/appearance.h"
#include "vantage/identity/exchange.h"
#include "vantage/linking/link_maps.h"
#include "vantage/occupancy/maps.h"

namespace vantage {

/// Who leaves a meeting as whom (table [identity]). Chosen on simulated floorball (seed 1) and PETS
/// 2009's View_001; neither cares for any of them within a factor of 1.5. Checked on another seed
/// of floorball and on simulated campus.
struct IdentityOptions {
  /// Colours decide. Otherwise linking does, which knows no person from another.
  bool appearance = true;
  /// Time between two looks at people's colours, 0 < interval_secs <= 60. For LookInterval alone:
  /// IdentifyPeople finds it in the appearances.
  double interval_secs = 0.2;
  /// Two people who come nearer to each other than this may be taken for each other, m, > 0.
  double distance_m = 1.2;
  /// Looks at a person within this time count as one, s, > 0: light and posture hardly change.
  double independent_secs = 2;
  /// People are exchanged when it makes what was seen of them e^margin times as likely, > 0.
  double margin = 5;
};
void VisitOptions(IdentityOptions& options, OptionVisitor& visitor);

/// Frames between two looks, at least 1.
std::int64_t LookInterval(const IdentityOptions& options, double frames_per_second);

struct IdentityReport {
  std::int64_t appearances = 0;  ///< colours of a person in a view
  std::int64_t meetings = 0;     ///< moments at which two people may have been exchanged
  /// What was decided otherwise than by linking, in this order; a meeting may occur again.
  std::vector<Exchange> exchanges;
  /// False: too few people or looks to learn what tells people apart; everything stays.
  bool learnt = false;
  double seconds = 0;
};

struct Identified {
  std::vector<LinkedPath> paths;
  IdentityReport report;
};

/// Preserves identities by appearance. Linking keeps people apart where they are apart; where they
/// are together nothing in the maps says who is who. Here the paths of linking are cut where people
/// meet, and put together anew so that the colours along each are most likely to be of one person
/// (PersonModel, ExchangePaths); the cells in which people are do not change. What tells people
/// apart is then learnt anew from the new paths, until nothing changes any more.
///
/// `appearances` are of cells near the paths (FindPeaks of the same maps); frames of paths and
/// appearances count from the first map. Fails on options out of range only.
Result<Identified> IdentifyPeople(std::vector<LinkedPath> paths, const OccupancyMaps& maps,
                                  const Appearances& appearances, const IdentityOptions& options,
                                  const RunControl& control = {});

/// The same for what LinkMaps found: its tracks are made anew from the identified paths wherever
/// one changed; its paths stay the optimum.
Result<IdentityReport> IdentifyTracks(const OccupancyMaps& maps, const Appearances& appearances,
                                      const IdentityOptions& options, const TrackOptions& tracks,
                                      LinkMapsResult& linked, const RunControl& control = {});

}  // namespace vantage
