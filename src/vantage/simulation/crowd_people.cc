// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/crowd_people.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>

#include "vantage/base/file.h"
#include "vantage/base/text.h"

namespace vantage::simulation {
namespace {

namespace fs = std::filesystem;

constexpr double kFileFramesPerSecond = 10;
constexpr int kColumns = 480;
constexpr int kRows = 1440;
constexpr double kCell = 0.025;                   // m
const Eigen::Vector2d kFirstCell = {-3.0, -9.0};  // m
/// Higher ids are for the parts of people that the annotation confuses.
constexpr int kMaxPerson = 10'000;
constexpr int kMaxFrame = 100'000'000;

/// The frame in a file's name, eight digits.
bool ParseFrame(const fs::path& path, int& frame) {
  const std::string stem = path.stem().string();
  return path.extension() == ".json" && stem.size() == 8 && ParseNumber(stem, frame) &&
         frame >= 0 && frame <= kMaxFrame;
}

Result<int> WholeNumber(const nlohmann::json& entry, const char* field, int limit,
                        const std::string& name) {
  const auto found = entry.find(field);
  if (found == entry.end() || !found->is_number_integer() || found->get<double>() < 0 ||
      found->get<double>() >= limit) {
    return Fail("{}: {} must be a whole number from 0 to {} in each entry", name, field, limit - 1);
  }
  return found->get<int>();
}

Status ReadFrame(const fs::path& path, int frame, std::map<int, std::vector<Waypoint>>& people) {
  const std::string name = path.string();
  VANTAGE_ASSIGN_OR_RETURN(const std::string text, ReadTextFile(path, std::size_t{1} << 24));
  const nlohmann::json entries = nlohmann::json::parse(text, nullptr, false);
  if (entries.is_discarded()) return Fail("{}: not valid JSON; fetch the file again", name);
  if (!entries.is_array()) {
    return Fail("{}: a list of entries with personID and positionID is needed", name);
  }
  std::set<int> seen;
  for (const nlohmann::json& entry : entries) {
    if (!entry.is_object()) {
      return Fail("{}: each entry must be an object with personID and positionID", name);
    }
    VANTAGE_ASSIGN_OR_RETURN(const int person, WholeNumber(entry, "personID", kMaxPerson, name));
    VANTAGE_ASSIGN_OR_RETURN(const int position,
                             WholeNumber(entry, "positionID", kColumns * kRows, name));
    if (!seen.insert(person).second) {
      return Fail("{}: personID {} is there twice; one entry a person is allowed", name, person);
    }
    people[person + 1].push_back(
        {frame / kFileFramesPerSecond,
         kFirstCell + kCell * Eigen::Vector2d(position % kColumns, position / kColumns)});
  }
  return {};
}

}  // namespace

Result<std::map<int, std::vector<Waypoint>>> ReadCrowdPeople(const fs::path& folder) {
  const fs::path annotations = folder / "annotations_positions";
  std::error_code code;
  fs::directory_iterator files(annotations, code);
  if (code) {
    return Fail("{}: no such folder; give the folder of WILDTRACK that has annotations_positions/",
                annotations.string());
  }
  std::map<int, fs::path> by_frame;
  for (; files != fs::directory_iterator(); files.increment(code)) {
    int frame = 0;
    if (ParseFrame(files->path(), frame)) by_frame[frame] = files->path();
  }
  if (by_frame.empty()) {
    return Fail("{}: no file named like 00000000.json, 00000005.json ... in it",
                annotations.string());
  }
  std::map<int, std::vector<Waypoint>> people;
  for (const auto& [frame, path] : by_frame) {
    VANTAGE_RETURN_IF_ERROR(ReadFrame(path, frame, people));
  }
  return people;
}

}  // namespace vantage::simulation
