// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
// `vantage evaluate tracks` as a user runs it.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include "test_program.h"
#include "vantage/base/file.h"
#include "vantage/base/test_support.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using testing::Entries;
using testing::ExpectOneLine;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Outcome;
using testing::RunProgram;
using testing::TemporaryFolder;

/// Person 1 stands at (1, 1) and person 2 at (6, 2) in frames 0 to 9. The tracker follows 1 as 7,
/// then as 8 from frame 4 on, 0.5 m beside; 2 as 9 but for frames 3 and 4; and sees somebody at
/// (20, 2) in frame 0.
struct Scene {
  TemporaryFolder folder;
  std::string truth = (folder / "truth.csv").string();
  std::string results = (folder / "results.csv").string();

  Scene() {
    std::string truth_text = "frame,id,x,y\n";
    std::string result_text = "frame,id,x,y\n0,5,20,2\n";
    for (int frame = 0; frame < 10; ++frame) {
      truth_text += fmt::format("{0},1,1,1\n{0},2,6,2\n", frame);
      result_text += fmt::format("{},{},1,1.5\n", frame, frame < 4 ? 7 : 8);
      if (frame != 3 && frame != 4) result_text += fmt::format("{},9,6,2\n", frame);
    }
    Write("truth.csv", truth_text);
    Write("results.csv", result_text);
  }
  void Write(const std::string& name, const std::string& text) const {
    EXPECT_TRUE(WriteTextFile(folder / name, text));
  }
  Outcome Run(const std::string& more = "") const { return RunOn(truth, results, more); }
  static Outcome RunOn(const std::string& truth_file, const std::string& result_file,
                       const std::string& more = "") {
    return RunProgram(
        fmt::format("evaluate tracks --truth '{}' '{}' {}", truth_file, result_file, more));
  }
};

nlohmann::json Json(const Outcome& outcome) {
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return nlohmann::json::parse(outcome.out, nullptr, false);
}

TEST(EvaluateTracksProgram, FiguresStandBesideTheirDefinitions) {
  const Scene scene;
  const Outcome table = scene.Run("--per-object");
  ASSERT_EQ(table.status, 0) << table.err;
  EXPECT_EQ(table.err, "");
  for (const char* line : {
           "match              positions nearer than 1 m\n",
           "mota                 0.8000  1 - (FN + FP + IDSW) / GT\n",
           "motp                 0.2778  mean distance in metres of the matches, lower is better",
           "motp_similarity      0.7222  mean 1 - distance / threshold of the matches, higher is",
           "moda                 0.8500  1 - (FN + FP) / GT, every frame assigned for itself\n",
           "hota ",
           "deta ",
           "assa ",
           "loca ",
           "tracks of the truth\n",
           "tracks of the results\n",
           "   1      0     9         10       10       0         2  0.5000         8     6        "
           " 1",
       }) {
    EXPECT_THAT(table.out, HasSubstr(line));
  }
  EXPECT_THAT(table.out, HasSubstr("note               " + scene.results +
                                   ":12: 1 of 4 tracks have gaps; the longest, 2 frames, ends"));
  EXPECT_THAT(table.out, Not(HasSubstr("warning")));
  EXPECT_THAT(scene.Run().out, Not(HasSubstr("tracks of the")));
}

TEST(EvaluateTracksProgram, JsonHoldsEverything) {
  const Scene scene;
  const auto json = Json(scene.Run("--json --per-object --threshold 0.8"));
  EXPECT_EQ(json["truth"], scene.truth);
  EXPECT_EQ(json["space"], "ground");
  EXPECT_EQ(json["options"]["threshold"], 0.8);
  EXPECT_TRUE(json["area_m"].is_null());
  EXPECT_EQ(json["misses"], 2);
  EXPECT_EQ(json["false_positives"], 1);
  EXPECT_EQ(json["switches"], 1);
  for (const auto& [name, definition] : json["definitions"].items()) {
    EXPECT_TRUE(json.contains(name)) << name;
    EXPECT_FALSE(definition.get<std::string>().empty()) << name;
  }
  ASSERT_EQ(json["hota_by_threshold"].size(), 19u);
  EXPECT_EQ(json["hota_by_threshold"][9]["alpha"], 0.5);
  const auto& person = json["truth_objects"][0];
  EXPECT_EQ(person["switches"], 1);
  EXPECT_EQ(person["identity"], 8);
  EXPECT_EQ(person["spans"], nlohmann::json::parse(R"([
    {"first_frame": 0, "last_frame": 3, "result": 7},
    {"first_frame": 4, "last_frame": 9, "result": 8}])"));
  EXPECT_TRUE(json["truth_objects"][1]["spans"][1]["result"].is_null());
  EXPECT_EQ(json["result_objects"][0]["false_positives"], 1);
  EXPECT_TRUE(json["result_objects"][0]["motp"].is_null());
  EXPECT_EQ(json["notes"].size(), 1u);
  EXPECT_FALSE(Json(scene.Run("--json")).contains("truth_objects"));
}

TEST(EvaluateTracksProgram, TruthAgainstItselfIsPerfect) {
  const Scene scene;
  const auto json = Json(Scene::RunOn(scene.truth, scene.truth, "--json"));
  for (const char* name : {"mota", "motp_similarity", "precision", "recall", "idf1", "idp", "idr",
                           "moda", "modp", "hota", "deta", "assa", "loca"}) {
    EXPECT_DOUBLE_EQ(json[name], 1) << name;
  }
  EXPECT_EQ(json["motp"], 0);
  EXPECT_TRUE(json["warnings"].empty());
  EXPECT_TRUE(json["notes"].empty());
}

TEST(EvaluateTracksProgram, OnlyTheAreaCounts) {
  const Scene scene;
  const auto rectangle = Json(scene.Run("--json --area 10,3,0,0"));
  EXPECT_EQ(rectangle["false_positives"], 0);
  EXPECT_EQ(rectangle["area_m"].size(), 4u);
  // Person 2 is beyond the slanting side.
  const auto triangle = Json(scene.Run("--json --area 0,0,6,0,0,6"));
  EXPECT_EQ(triangle["truth_positions"], 10);
  EXPECT_EQ(triangle["misses"], 0);
  for (const char* area : {"1,2,3", "1,2,3,x", "1,2", "1,2,3,4,5", "''"}) {
    ExpectOneLine(scene.Run(fmt::format("--area={}", area)), area[0] == '\'' ? 2 : 1, "--area");
  }
  ExpectOneLine(scene.Run("--area 0,0,nan,4"), 1, "--area");
  ExpectOneLine(scene.Run("--area 0,0,4,4,4,0,0,4"), 1, "--area");
  ExpectOneLine(scene.Run("--area 50,50,60,60"), 1, "no position inside the area");
}

TEST(EvaluateTracksProgram, MistakesInTheFilesAreSaid) {
  const Scene scene;
  std::string centimetres = "frame,id,x,y\n";
  std::string later = "frame,id,x,y\n";
  std::string far = "frame,id,x,y\n";
  for (int frame = 0; frame < 10; ++frame) {
    centimetres += fmt::format("{0},1,100,100\n{0},2,600,200\n", frame);
    later += fmt::format("{0},1,1,1\n{0},2,6,2\n", frame + 10);
    far += fmt::format("{},1,{},1\n", frame, frame == 6 ? 5000 : 1);
  }
  scene.Write("centimetres.csv", centimetres);
  scene.Write("later.csv", later);
  scene.Write("far.csv", far);
  scene.Write("twice.csv", "frame,id,x,y\n0,1,1,1\n0,2,6,2\n0,1,1,1\n");
  scene.Write("nan.csv", "frame,id,x,y\n0,1,1,1\n1,1,nan,1\n");
  const auto warning = [&](const std::string& name) -> std::string {
    const auto json = Json(Scene::RunOn(scene.truth, (scene.folder / name).string(), "--json"));
    EXPECT_EQ(json["warnings"].size(), 1u) << json["warnings"];
    return json["warnings"].empty() ? "" : json["warnings"][0].get<std::string>();
  };
  EXPECT_THAT(warning("centimetres.csv"),
              HasSubstr("centimetres.csv: coordinates are 100 times those of the truth, as if they "
                        "were in centimetres; both must be in metres"));
  EXPECT_THAT(Scene::RunOn(scene.truth, (scene.folder / "centimetres.csv").string()).out,
              ::testing::StartsWith("warning "));
  EXPECT_THAT(warning("far.csv"), HasSubstr("far.csv:8: 1 positions lie more than 1000 m from"));
  const auto json =
      Json(Scene::RunOn(scene.truth, (scene.folder / "later.csv").string(), "--json"));
  EXPECT_THAT(json["warnings"][0].get<std::string>(),
              HasSubstr("later.csv: frame numbers lowered by 10 would fit the truth better"));
  ExpectOneLine(Scene::RunOn(scene.truth, (scene.folder / "twice.csv").string()), 1,
                "twice.csv:4: id 1 comes twice in this frame, first in line 2");
  ExpectOneLine(Scene::RunOn(scene.truth, (scene.folder / "nan.csv").string()), 1,
                "nan.csv:3: x is 'nan'");
}

TEST(EvaluateTracksProgram, MotChallengeTextIsTheSameAsOurs) {
  const Scene scene;
  std::string text;
  for (int frame = 1; frame <= 10; ++frame) {
    text += fmt::format("{0},1,10,10,5,9,1,1,1,0\n{0},2,60,20,5,9,1,6,2,0\n", frame);
  }
  scene.Write("truth.txt", text);
  auto ours = Json(scene.Run("--json"));
  const std::string mot = (scene.folder / "truth.txt").string();
  auto theirs = Json(Scene::RunOn(mot, scene.results, "--json"));
  EXPECT_EQ(theirs["truth"], mot);
  theirs["truth"] = ours["truth"];
  EXPECT_EQ(ours, theirs);
  const auto boxes = Json(Scene::RunOn(mot, mot, "--json --boxes"));
  EXPECT_EQ(boxes["space"], "boxes");
  EXPECT_DOUBLE_EQ(boxes["hota"], 1);
  EXPECT_THAT(boxes["definitions"]["motp"].get<std::string>(), HasSubstr("1 - IoU"));
}

TEST(EvaluateTracksProgram, CountsOfEveryFrame) {
  const Scene scene;
  const std::string counts = (scene.folder / "counts.csv").string();
  ASSERT_EQ(scene.Run("--save-counts '" + counts + "'").status, 0);
  const std::string text = ReadTextFile(counts).value_or("");
  EXPECT_THAT(text, ::testing::StartsWith(
                        "frame,truth,results,matches,misses,false_positives,switches,motp\n"
                        "0,2,3,2,0,1,0,0.2500\n1,2,2,2,0,0,0,0.2500\n"));
  EXPECT_THAT(text, HasSubstr("\n4,2,1,1,1,0,1,0.5000\n"));
}

std::vector<std::pair<double, double>> Points(const pugi::xml_node& polyline) {
  std::vector<std::pair<double, double>> points;
  std::istringstream text(polyline.attribute("points").as_string());
  double x = 0, y = 0;
  for (char comma = 0; text >> x >> comma >> y;) points.emplace_back(x, y);
  return points;
}

TEST(EvaluateTracksProgram, ThePageStandsAloneAndItsChartsShowTheFigures) {
  const Scene scene;
  const std::string page = (scene.folder / "page.html").string();
  ASSERT_EQ(scene.Run("--plot '" + page + "'").status, 0);
  const std::string html = ReadTextFile(page).value_or("");
  for (const char* outside : {"<script", "src=", "href=", "@import", "url("}) {
    EXPECT_THAT(html, Not(HasSubstr(outside)));
  }
  EXPECT_THAT(html, HasSubstr("<td>mota</td><td>0.8000</td>"));
  EXPECT_THAT(html, HasSubstr("results.csv:12: 1 of 4 tracks have gaps"));

  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(html.c_str(), pugi::parse_default | pugi::parse_doctype));
  std::vector<pugi::xml_node> charts;
  for (const auto& found : document.select_nodes("//svg")) charts.push_back(found.node());
  ASSERT_EQ(charts.size(), 6u);  // four over time, HOTA, who was matched to whom

  // Ten frames over the width; errors of at most 1, so that a miss reaches the top.
  const auto lines = charts[1].select_nodes("polyline");
  ASSERT_EQ(lines.size(), 2u);
  const auto misses = Points(lines[0].node());
  ASSERT_EQ(misses.size(), 10u);
  const double zero = misses[0].second;
  EXPECT_LT(misses[3].second, zero);
  EXPECT_EQ(misses[3].second, misses[4].second);
  EXPECT_EQ(misses[5].second, zero);
  EXPECT_EQ(Points(lines[1].node())[0].second, misses[3].second);  // one false positive
  EXPECT_EQ(Points(charts[4].select_nodes("polyline")[0].node()).size(), 19u);

  // Of person 1 a bar of 4 frames and one of 6 with a tick between; of person 2 bars of 3 and 5
  // frames and a thin line of 2 between.
  std::vector<std::pair<double, double>> spans;  // x, width
  for (const auto& found : charts[5].select_nodes("rect")) {
    spans.emplace_back(found.node().attribute("x").as_double(),
                       found.node().attribute("width").as_double());
  }
  ASSERT_EQ(spans.size(), 6u);
  const double frame = spans[0].second / 4;
  EXPECT_NEAR(spans[1].second, 6 * frame, 0.1);
  EXPECT_NEAR(spans[1].first, spans[0].first + 4 * frame, 0.1);
  EXPECT_NEAR(spans[2].first, spans[1].first, 1.01);  // the tick
  EXPECT_NEAR(spans[3].second, 3 * frame, 0.1);
  EXPECT_NEAR(spans[4].first + spans[4].second, spans[1].first + spans[1].second, 0.1);
  EXPECT_NEAR(spans[5].first, spans[0].first + 3 * frame, 0.1);
  EXPECT_NEAR(spans[5].second, 2 * frame, 0.1);
  EXPECT_STREQ(charts[5].select_node("rect[6]/title").node().text().as_string(),
               "2, frames 3 to 4: missed");
}

TEST(EvaluateTracksProgram, PagesOfOddInput) {
  const Scene scene;
  scene.Write("empty.csv", "frame,id,x,y\n");
  scene.Write("one.csv", "frame,id,x,y\n5,1,0,0\n");
  scene.Write("<&>.csv", "frame,id,x,y\n5,1,0,0\n");
  std::string crowd = "frame,id,x,y\n";
  for (int id = 0; id < 150; ++id) crowd += fmt::format("0,{},{},0\n", id, 3 * id);
  scene.Write("crowd.csv", crowd);
  for (const auto& [truth, results] : {std::pair{"one.csv", "empty.csv"},
                                       {"one.csv", "one.csv"},
                                       {"one.csv", "<&>.csv"},
                                       {"crowd.csv", "crowd.csv"}}) {
    const std::string page = (scene.folder / "page.html").string();
    const Outcome outcome =
        Scene::RunOn((scene.folder / truth).string(), (scene.folder / results).string(),
                     "--plot '" + page + "'");
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const std::string html = ReadTextFile(page).value_or("");
    pugi::xml_document document;
    EXPECT_TRUE(document.load_string(html.c_str(), pugi::parse_default | pugi::parse_doctype));
    EXPECT_THAT(html, Not(HasSubstr("=\"nan")));
    EXPECT_THAT(html, Not(HasSubstr("=\"-nan")));
    EXPECT_THAT(html, Not(HasSubstr("=\"inf")));
    const bool crowded = std::string(truth) == "crowd.csv";
    EXPECT_EQ(html.find("the 100 of 150 with") != std::string::npos, crowded);
  }
}

TEST(EvaluateTracksProgram, OutputsDoNotReplaceInputs) {
  const Scene scene;
  const std::string before = ReadTextFile(scene.truth).value_or("");
  ExpectOneLine(scene.Run("--plot '" + scene.truth + "'"), 1, "is read here");
  ExpectOneLine(scene.Run("--save-counts '" + scene.results + "'"), 1, "is read here");
  const std::string out = (scene.folder / "out").string();
  ExpectOneLine(scene.Run(fmt::format("--save-counts '{0}' --plot '{0}'", out)), 1,
                "needs a file of its own");
  ExpectOneLine(Scene::RunOn(scene.truth, out, "--plot '" + out + ".html'"), 1, "no such file");
  EXPECT_EQ(ReadTextFile(scene.truth).value_or(""), before);
  EXPECT_THAT(Entries(scene.folder.path()), ::testing::ElementsAre("results.csv", "truth.csv"));
}

}  // namespace
}  // namespace vantage
