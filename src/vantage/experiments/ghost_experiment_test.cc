// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/ghost_experiment.h"

#include <gmock/gmock.h>

#include <atomic>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <set>
#include <tuple>

#include "vantage/base/test_support.h"
#include "vantage/experiments/test_ghost_sequence.h"
#include "vantage/video/open.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using testing::GhostSequence;
using ::testing::HasSubstr;
using testing::MessageOf;
using testing::TemporaryFolder;

constexpr int kBegin = 3;
constexpr int kFirst = 40;
constexpr int kLast = 75;

/// A folder of data with one sequence, "set/one".
class GhostExperiment : public ::testing::Test {
 protected:
  GhostExperiment() { sequence_.Write(folder_.path() / "set/one"); }
  static GhostCase Case(const std::string& name = "one") {
    return {.name = name,
            .sequence = "set/" + name,
            .span = {.begin = kBegin, .first = kFirst, .last = kLast},
            .ghost = true,
            .check = 60,
            .note = ""};
  }
  static GhostVariant Variant(const std::string& name) {
    for (const GhostVariant& variant : StandardGhostVariants()) {
      if (variant.name == name) return variant;
    }
    ADD_FAILURE() << name;
    return {};
  }
  Result<GhostCaseResult> Run(const std::vector<GhostVariant>& variants) const {
    return RunGhostCase(Case(), folder_.path() / "set/one", variants);
  }
  std::string Failure() const { return MessageOf(Run({Variant("none")})); }

  TemporaryFolder folder_;
  GhostSequence sequence_;
};

TEST(StandardGhosts, EveryVariantOnceAndValid) {
  std::set<std::tuple<std::string, int, int, double>> seen;
  int mixtures = 0;
  for (const GhostVariant& variant : StandardGhostVariants()) {
    const MixtureOptions& o = variant.options.mixture;
    EXPECT_TRUE(Validate(variant.options)) << variant.name;
    EXPECT_TRUE(
        seen.emplace(variant.name, static_cast<int>(o.color), static_cast<int>(o.rate), o.alpha)
            .second)
        << variant.name;
    mixtures += variant.options.method == MethodKind::kMixture ? 1 : 0;
  }
  // None, five criteria judged in two ways, the rival.
  EXPECT_EQ(mixtures, 12 * 2 * 2 * 2);
  EXPECT_EQ(seen.size(), 12u * 8 + 4);
  EXPECT_EQ(StandardGhostVariants(true).size(), 12u * 4 + 4);
  std::set<std::string> names;
  for (const GhostCase& one : StandardGhostCases()) {
    EXPECT_TRUE(names.insert(one.name).second);
    EXPECT_LE(one.span.first, one.span.last);
    EXPECT_NE(one.preset.empty(), one.sequence.empty());
    EXPECT_FALSE(one.figures.empty());
    for (const auto& window : {one.under_mover, one.over_edges, one.hidden}) {
      EXPECT_TRUE(!window || window->first < window->last) << one.name;
    }
    // The simulated forecourt was built with all of the thesis's weak spots.
    EXPECT_EQ(one.name == "ghosts", one.under_mover && one.over_edges && one.hidden);
  }
}

TEST(StandardGhosts, ThePeersAreBareAndOursIsTheDefault) {
  for (const GhostVariant& variant : StandardGhostVariants()) {
    if (variant.name != "mog2" && variant.name != "knn") continue;
    EXPECT_EQ(variant.options.ghosts.rule.criterion, GhostCriterion::kNone);
    EXPECT_FALSE(variant.options.disturbances.enabled);
    EXPECT_EQ(variant.options.cleanup.min_area_px, 0);
  }
  const MixtureOptions defaults;
  bool found = false;
  for (const GhostVariant& variant : StandardGhostVariants()) {
    const MixtureOptions& o = variant.options.mixture;
    if (variant.name == DefaultVariantName() && o.color == defaults.color &&
        o.rate == defaults.rate && o.alpha == defaults.alpha) {
      found = true;
      EXPECT_EQ(variant.options.ghosts.rule.threshold(), CriterionOptions().threshold());
      EXPECT_EQ(variant.options.ghosts.judgement, GhostOptions().judgement);
    }
  }
  EXPECT_TRUE(found);
}

TEST_F(GhostExperiment, EqualsADirectComputation) {
  const std::vector<GhostVariant> variants = {Variant("none"), Variant("fep"), Variant("fep-plain"),
                                              Variant("mog2")};
  const Result<GhostCaseResult> result = Run(variants);
  ASSERT_TRUE(result) << MessageOf(result);
  const GhostCaseResult& in = *result;
  EXPECT_EQ(in.frames_shown, kLast - kBegin + 1);
  EXPECT_TRUE(in.roi);
  for (std::size_t v = 0; v < variants.size(); ++v) {
    const auto source = OpenInput(folder_.path() / "set/one").value();
    auto subtractor =
        BackgroundSubtractor::Create(source->info().size, variants[v].options).value();
    MaskCounts sum;
    std::int64_t peak = -1, at_check = -1;
    cv::Mat frame, mask;
    for (int index = 0; index <= kLast; ++index) {
      ASSERT_TRUE(source->Read(frame).value());
      if (index < kBegin) continue;
      ASSERT_TRUE(subtractor.Apply(frame, mask, 1));
      if (index < kFirst) continue;
      const MaskCounts counts = CountMask(sequence_.Truth(index), mask, sequence_.Region()).value();
      sum += counts;
      peak = std::max(peak, counts.false_positives);
      if (index == 60) at_check = counts.false_positives;
    }
    const GhostRun& run = in.runs[v];
    EXPECT_EQ(run.counts, sum) << variants[v].name;
    EXPECT_EQ(run.measures.f1, MeasureMasks(sum).f1);
    EXPECT_EQ(run.Peak().counts.false_positives, peak);
    EXPECT_EQ(run.FalsePositivesAt(60), at_check);
    EXPECT_EQ(run.FalsePositivesAt(kFirst - 1), std::nullopt);
  }
}

TEST_F(GhostExperiment, TheGhostGoes) {
  const std::vector<GhostVariant> variants = {Variant("none"), Variant("fep"), Variant("standing")};
  Result<GhostCaseResult> result = Run(variants);
  ASSERT_TRUE(result) << MessageOf(result);
  const GhostResults results{.variants = variants, .cases = {*std::move(result)}};
  const GhostCaseResult& in = results.cases[0];
  const MixtureOptions defaults;
  const GhostRun* none = results.Find(in, "none", defaults.color, defaults.rate, defaults.alpha);
  const GhostRun* fep = results.Find(in, "fep", defaults.color, defaults.rate, defaults.alpha);
  const GhostRun* standing =
      results.Find(in, "standing", defaults.color, defaults.rate, defaults.alpha);
  ASSERT_TRUE(none != nullptr && fep != nullptr && standing != nullptr);
  EXPECT_GT(fep->measures.f1, none->measures.f1 + 0.1);
  EXPECT_GT(fep->ghosts_px, 100);
  EXPECT_GT(standing->ghosts_px, 100);
  EXPECT_GT(standing->measures.f1, none->measures.f1 + 0.05);
  EXPECT_EQ(results.Find(in, "fep", defaults.color, defaults.rate, 0.3), nullptr);
  EXPECT_EQ(results.Find(in, "cb", defaults.color, defaults.rate, defaults.alpha), nullptr);
}

/// An object that is put down and stays, with edges all around: the rival takes it for a ghost, FEP
/// does not.
TEST_F(GhostExperiment, TheRivalTakesWhatIsPutDown) {
  const fs::path one = folder_.path() / "set/one";
  const cv::Rect object(70, 30, 20, 25);
  for (int frame = 0; frame < GhostSequence::kFrames; ++frame) {
    cv::Mat picture = GhostSequence::Picture(200 + frame);  // the box is away
    cv::Mat truth = cv::Mat::zeros(picture.size(), CV_8UC1);
    if (frame >= 30) {
      picture(object) = cv::Scalar(20, 220, 40);
      truth(object) = TruthLabel::kMoving;
    }
    GhostSequence::WritePicture(one / fmt::format("input/in{:06}.png", frame + 1), picture);
    GhostSequence::WritePicture(one / fmt::format("groundtruth/gt{:06}.png", frame + 1), truth);
  }
  std::vector<GhostVariant> variants = {Variant("fep"), Variant("standing")};
  // The modified rate would take it for background so early.
  for (GhostVariant& variant : variants) variant.options.mixture.rate = LearningRate::kOriginal;
  const Result<GhostCaseResult> result = Run(variants);
  ASSERT_TRUE(result) << MessageOf(result);
  EXPECT_GT(result->runs[0].measures.recall, 0.9);
  EXPECT_LT(result->runs[1].measures.recall, 0.75);
  EXPECT_EQ(result->runs[0].ghosts_px, 0);
}

TEST_F(GhostExperiment, KeptResultsAreTheSame) {
  const Result<GhostCaseResult> result = Run({Variant("none"), Variant("fep")});
  ASSERT_TRUE(result) << MessageOf(result);
  const auto json = nlohmann::ordered_json::parse(JsonOf(*result).dump());
  const Result<GhostCaseResult> kept = GhostCaseResultOf(json, result->used);
  ASSERT_TRUE(kept) << MessageOf(kept);
  EXPECT_EQ(kept->size, result->size);
  EXPECT_EQ(kept->frames_shown, result->frames_shown);
  EXPECT_EQ(kept->frames_without_truth, result->frames_without_truth);
  EXPECT_EQ(kept->roi, result->roi);
  EXPECT_EQ(kept->notes, result->notes);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(kept->runs[i].counts, result->runs[i].counts);
    EXPECT_EQ(kept->runs[i].measures.f1, result->runs[i].measures.f1);
    EXPECT_EQ(kept->runs[i].Peak().frame, result->runs[i].Peak().frame);
    EXPECT_EQ(kept->runs[i].ghosts_px, result->runs[i].ghosts_px);
  }
  for (const char* member : {"width", "notes", "runs"}) {
    nlohmann::ordered_json broken = json;
    broken.erase(member);
    EXPECT_THAT(MessageOf(GhostCaseResultOf(broken, result->used)), HasSubstr(member));
    broken[member] = nlohmann::ordered_json::object({{"a", "b"}});
    EXPECT_FALSE(GhostCaseResultOf(broken, result->used));
  }
  nlohmann::ordered_json broken = json;
  broken["runs"][1]["frames"] = nlohmann::ordered_json::array();
  EXPECT_FALSE(GhostCaseResultOf(broken, result->used));
}

TEST_F(GhostExperiment, ReportsProgressAndStops) {
  std::int64_t last = 0;
  std::atomic<bool> stop{false};
  const RunControl control{.progress = [&](std::int64_t done, std::int64_t) { last = done; },
                           .stop = &stop};
  const fs::path one = folder_.path() / "set/one";
  ASSERT_TRUE(RunGhostCase(Case(), one, {Variant("none")}, control));
  EXPECT_EQ(last, kLast - kBegin + 1);
  stop = true;
  EXPECT_THAT(MessageOf(RunGhostCase(Case(), one, {Variant("none")}, control)),
              HasSubstr("interrupted"));
}

TEST_F(GhostExperiment, NoFrameThatCounts) {
  GhostCase late = Case();
  late.span = {.first = 1000, .last = 1001};
  EXPECT_THAT(MessageOf(RunGhostCase(late, folder_.path() / "set/one", {Variant("none")})),
              HasSubstr("no truth that counts in frames 1000 to 1001"));
  EXPECT_THAT(MessageOf(RunGhostCase(Case(), folder_ / "none", {Variant("none")})),
              HasSubstr("is no sequence"));
}

TEST_F(GhostExperiment, BrokenSequences) {
  const fs::path one = folder_.path() / "set/one";
  fs::resize_file(one / "input/in000050.png", 60);
  EXPECT_THAT(Failure(), HasSubstr("in000050.png"));
  sequence_.Write(one);
  fs::resize_file(one / "groundtruth/gt000050.png", 60);
  EXPECT_THAT(Failure(), HasSubstr("gt000050.png"));
  sequence_.Write(one);
  GhostSequence::WritePicture(one / "groundtruth/gt000050.png",
                              cv::Mat(sequence_.Truth(49).size(), CV_8UC1, cv::Scalar(77)));
  EXPECT_THAT(Failure(), HasSubstr("frame 49: pixel (0, 4) has the label 77"));
  sequence_.Write(one);
  std::ofstream(one / "temporalROI.txt") << "nan";
  EXPECT_THAT(Failure(), HasSubstr("temporalROI.txt"));
  fs::remove_all(one / "groundtruth");
  EXPECT_THAT(Failure(), HasSubstr("is no sequence"));
}

TEST_F(GhostExperiment, PicturesOfAnotherSizeThanTheirTruth) {
  const fs::path one = folder_.path() / "set/one";
  for (const auto& entry : fs::directory_iterator(one / "input")) {
    GhostSequence::WritePicture(entry.path(), cv::Mat::zeros(20, 30, CV_8UC3));
  }
  EXPECT_THAT(Failure(), HasSubstr("the pictures have 30 x 20 px, the truth"));
}

TEST_F(GhostExperiment, OptionsOutOfRange) {
  GhostVariant wrong = Variant("none");
  wrong.options.mixture.alpha = 2;
  EXPECT_THAT(MessageOf(Run({wrong})), HasSubstr("alpha is 2"));
}

}  // namespace
}  // namespace vantage
