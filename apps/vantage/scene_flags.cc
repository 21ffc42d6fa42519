// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "scene_flags.h"

namespace vantage::app {

CLI::Option* SceneFlags::DefineUpToOccupancy(CLI::App& app, const std::string& occupancy_prefix) {
  CLI::Option* scene = app.add_option("scene", scene_, "Scene file (TOML)");
  app.add_option("--data", data_,
                 "Folder that paths in the scene are relative to; default: the scene's own");
  grid_ = AddOptionFlags(app, GridOptions{}, "", "Grid");
  person_ = AddOptionFlags(app, PersonSpec{}, "person-", "Person");
  background_ = AddOptionFlags(app, BackgroundOptions{}, "background-", "Background");
  hold_ = AddOptionFlags(app, HoldOptions{}, "hold-", "Hold");
  occupancy_ = AddOptionFlags(app, OccupancyOptions{}, occupancy_prefix, "Occupancy");
  return scene;
}

CLI::Option* SceneFlags::DefineForTracking(CLI::App& app) {
  CLI::Option* scene = DefineUpToOccupancy(app, "occupancy-");
  linking_ = AddOptionFlags(app, LinkingOptions{}, "linking-", "Linking");
  identity_ = AddOptionFlags(app, IdentityOptions{}, "identity-", "Identity");
  tracks_ = AddOptionFlags(app, TrackOptions{}, "tracks-", "Tracks");
  return scene;
}

CLI::Option* SceneFlags::DefineForOccupancy(CLI::App& app) { return DefineUpToOccupancy(app, ""); }

Result<SceneSetup> SceneFlags::Load() const {
  SceneSetup setup;
  setup.data = data_;
  VANTAGE_ASSIGN_OR_RETURN(setup.scene, LoadScene(scene_, data_));
  VANTAGE_RETURN_IF_ERROR(BindStages(setup.scene, setup.options));
  grid_.ApplyTo(setup.scene.grid);
  person_.ApplyTo(setup.scene.person);
  background_.ApplyTo(setup.options.background);
  hold_.ApplyTo(setup.options.hold);
  occupancy_.ApplyTo(setup.options.occupancy);
  linking_.ApplyTo(setup.options.linking);
  identity_.ApplyTo(setup.options.identity);
  tracks_.ApplyTo(setup.options.tracks);
  return setup;
}

}  // namespace vantage::app
