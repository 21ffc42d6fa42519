// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/ghost_experiment.h"

#include <gmock/gmock.h>

#include <atomic>
#include <fstream>
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
using ::testing::IsEmpty;
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
            .begin = kBegin,
            .first = kFirst,
            .last = kLast,
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
  Result<GhostResults> Run(const std::vector<GhostVariant>& variants, int threads = 2,
                           const std::vector<GhostCase>& cases = {Case()}) const {
    return RunGhostExperiment(folder_.path(), cases, variants, threads);
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
  EXPECT_EQ(mixtures, 7 * 2 * 2 * 2);
  EXPECT_EQ(seen.size(), 60u);
  std::set<std::string> names;
  for (const GhostCase& one : StandardGhostCases()) {
    EXPECT_TRUE(names.insert(one.name).second);
    EXPECT_LE(one.first, one.last);
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
  const Result<GhostResults> results = Run(variants);
  ASSERT_TRUE(results) << MessageOf(results);
  ASSERT_EQ(results->cases.size(), 1u);
  const GhostCaseResult& in = results->cases[0];
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
    EXPECT_EQ(run.report.frames, kLast - kBegin + 1);
  }
}

TEST_F(GhostExperiment, TheGhostGoes) {
  const Result<GhostResults> results = Run({Variant("none"), Variant("fep")});
  ASSERT_TRUE(results) << MessageOf(results);
  const GhostCaseResult& in = results->cases[0];
  const MixtureOptions defaults;
  const GhostRun* none = results->Find(in, "none", defaults.color, defaults.rate, defaults.alpha);
  const GhostRun* fep = results->Find(in, "fep", defaults.color, defaults.rate, defaults.alpha);
  ASSERT_TRUE(none != nullptr && fep != nullptr);
  EXPECT_GT(fep->measures.f1, none->measures.f1 + 0.1);
  EXPECT_GT(fep->report.ghosts_px, 100);
  EXPECT_EQ(results->Find(in, "fep", defaults.color, defaults.rate, 0.3), nullptr);
  EXPECT_EQ(results->Find(in, "cb", defaults.color, defaults.rate, defaults.alpha), nullptr);
}

TEST_F(GhostExperiment, SameFiguresWhateverTheThreadCount) {
  const std::vector<GhostVariant> variants = StandardGhostVariants();
  const Result<GhostResults> one = Run(variants, 1);
  const Result<GhostResults> three = Run(variants, 3);
  ASSERT_TRUE(one && three);
  for (std::size_t v = 0; v < variants.size(); ++v) {
    EXPECT_EQ(one->cases[0].runs[v].counts, three->cases[0].runs[v].counts) << variants[v].name;
  }
}

TEST_F(GhostExperiment, WhatIsAbsentIsSkippedAndSaid) {
  GhostCase late = Case();
  late.name = "late";
  late.first = 1000;
  late.last = 1001;
  const auto results = Run({Variant("none")}, 1, {Case("two"), Case(), late});
  ASSERT_TRUE(results) << MessageOf(results);
  EXPECT_EQ(results->cases.size(), 1u);
  ASSERT_EQ(results->skipped.size(), 2u);
  EXPECT_THAT(results->skipped[0], HasSubstr("set/two is not there"));
  EXPECT_THAT(results->skipped[1], HasSubstr("no truth that counts in frames 1000 to 1001"));

  EXPECT_THAT(MessageOf(Run({Variant("none")}, 1, {Case("two"), Case("three")})),
              HasSubstr("holds none of the sequences set/three, set/two"));
  EXPECT_THAT(MessageOf(Run({Variant("none")}, 1, {late})), HasSubstr("no truth that counts"));
  EXPECT_THAT(MessageOf(RunGhostExperiment(folder_ / "none", {Case()}, {Variant("none")}, 1)),
              HasSubstr("none: no such folder"));
}

TEST_F(GhostExperiment, ReportsProgressAndStops) {
  std::int64_t last = 0, total = 0;
  std::atomic<bool> stop{false};
  RunControl control{.progress =
                         [&](std::int64_t done, std::int64_t of) {
                           EXPECT_GT(done, last);
                           last = done;
                           total = of;
                         },
                     .stop = &stop};
  ASSERT_TRUE(
      RunGhostExperiment(folder_.path(), {Case()}, {Variant("none"), Variant("fep")}, 2, control));
  EXPECT_EQ(last, total);
  EXPECT_EQ(total, 2 * (kLast - kBegin + 1));
  stop = true;
  EXPECT_THAT(MessageOf(RunGhostExperiment(folder_.path(), {Case()}, {Variant("none")}, 2,
                                           {.progress = {}, .stop = &stop})),
              HasSubstr("interrupted"));
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
  EXPECT_THAT(Failure(), HasSubstr("gt000050.png"));
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
  EXPECT_FALSE(Run({}));
}

}  // namespace
}  // namespace vantage
