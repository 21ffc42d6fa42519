// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/rendering/composition.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "vantage/base/test_support.h"
#include "vantage/rendering/palette.h"
#include "vantage/rendering/test_scene.h"

namespace vantage {
namespace {

using testing::CornerScene;
using ::testing::HasSubstr;
using testing::MessageOf;

Tracks StandingAt(int id, double x_m, double y_m, FrameIndex last) {
  Track track{TrackId{id}, {}};
  for (FrameIndex frame = 0; frame <= last; ++frame)
    track.points.push_back({frame, x_m, y_m, false});
  return {track};
}

TEST(LayOut, PartsFillAnEvenFrameWithoutOverlap) {
  const std::vector<ImageSize> kinds = {{768, 576}, {1920, 1080}, {720, 576}, {480, 640}, {64, 16}};
  for (int height_px : {240, 360, 719, 720, 1080, 2160}) {
    for (std::size_t count = 1; count <= 12; ++count) {
      for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
        std::vector<ImageSize> views;
        for (std::size_t i = 0; i < count; ++i)
          views.push_back(kinds[(kind + i / 2) % kinds.size()]);
        const Layout layout = LayOut(views, height_px);
        EXPECT_EQ(layout.frame.width % 2, 0);
        EXPECT_EQ(layout.frame.height % 2, 0);
        EXPECT_LE(layout.frame.height, height_px + 1);
        std::vector<cv::Rect> parts = layout.views;
        ASSERT_EQ(parts.size(), count);
        for (std::size_t i = 0; i < count; ++i) {
          // Own proportions, to a pixel.
          const double width = 1.0 * parts[i].height * views[i].width / views[i].height;
          EXPECT_NEAR(parts[i].width, width, 1);
        }
        parts.push_back(layout.plan);
        parts.push_back(layout.caption);
        for (std::size_t i = 0; i < parts.size(); ++i) {
          EXPECT_EQ(parts[i] & cv::Rect({0, 0}, layout.frame), parts[i]);
          EXPECT_GT(parts[i].area(), 0);
          for (std::size_t j = 0; j < i; ++j) EXPECT_EQ((parts[i] & parts[j]).area(), 0);
        }
        EXPECT_GE(layout.plan.width, layout.frame.width / 4);
      }
    }
  }
}

TEST(LayOut, OneViewIsLargeBesideThePlan) {
  const Layout layout = LayOut({{768, 576}}, 720);
  EXPECT_EQ(layout.frame.width, 1280);
  EXPECT_GT(layout.views[0].width, 800);
  EXPECT_GT(layout.plan.width, 350);
  EXPECT_GT(layout.plan.x, layout.views[0].br().x);
}

TEST(Composition, DrawsThePersonInEveryViewAndOnThePlan) {
  const Scene scene = CornerScene({{640, 480}, {640, 360}, {720, 576}});
  const Composition composition(scene, {});
  std::vector<cv::Mat> pictures;
  for (const SceneCamera& camera : scene.cameras) {
    pictures.emplace_back(camera.camera.size().height, camera.camera.size().width, CV_8UC3,
                          cv::Scalar(90, 90, 90));
  }
  const cv::Mat without = composition.Draw({}, 5, pictures);
  const cv::Mat with = composition.Draw(StandingAt(4, 0.5, 0.2, 9), 5, pictures);
  EXPECT_EQ(with.type(), CV_8UC3);
  EXPECT_EQ(with.size(), composition.size());
  for (std::size_t i = 0; i < 3; ++i) {
    const cv::Rect& view = composition.layout().views[i];
    const Camera scaled = scene.cameras[i].camera.Scaled({view.width, view.height}).value();
    const PixelBox box = PersonBox(scaled, {0.5, 0.2}, scene.person.OrDefault()).value();
    cv::Mat changed;
    cv::absdiff(with(view), without(view), changed);
    EXPECT_GT(cv::norm(changed.at<cv::Vec3b>(static_cast<int>((box.min_y + box.max_y) / 2),
                                             static_cast<int>(std::lround(box.min_x)))),
              60);
    EXPECT_EQ(cv::norm(changed.at<cv::Vec3b>(view.height - 2, 2)), 0);
  }
  EXPECT_GT(cv::norm(with(composition.layout().plan), without(composition.layout().plan)), 100);
  // The count in the caption.
  EXPECT_GT(cv::norm(with(composition.layout().caption), without(composition.layout().caption)), 1);
}

TEST(Composition, ShowsTheVideoUnlessAskedNotTo) {
  const Scene scene = CornerScene({{640, 480}});
  const cv::Mat white(480, 640, CV_8UC3, cv::Scalar(255, 255, 255));
  const Tracks tracks = StandingAt(1, 0, 0, 9);
  const Composition shown(scene, {});
  const cv::Rect view = shown.layout().views[0];
  EXPECT_GT(cv::mean(shown.Draw(tracks, 0, {white})(view))[0], 230);
  const Composition hidden(scene, {.picture = false});
  const cv::Mat frame = hidden.Draw(tracks, 0, {white});
  EXPECT_LT(cv::mean(frame(view))[0], 90);
  EXPECT_EQ(cv::norm(frame, hidden.Draw(tracks, 0, {}), cv::NORM_INF), 0);  // not even looked at
}

TEST(Composition, ShowsMasksAndMissingPictures) {
  const Scene scene = CornerScene({{640, 480}, {640, 480}});
  const Composition composition(scene, {});
  cv::Mat mask(240, 320, CV_8UC1, cv::Scalar(0));
  mask(cv::Rect(20, 160, 60, 60)).setTo(255);
  const cv::Mat with_mask = composition.Draw({}, 0, {mask, cv::Mat()});
  const cv::Mat with_none = composition.Draw({}, 0, {cv::Mat(), cv::Mat()});
  const cv::Rect view = composition.layout().views[0];
  const cv::Point inside(view.x + view.width * 50 / 320, view.y + view.height * 190 / 240);
  EXPECT_GT(with_mask.at<cv::Vec3b>(inside)[0], with_none.at<cv::Vec3b>(inside)[0] + 40);
}

TEST(Composition, EqualInputGivesEqualFrames) {
  const Scene scene = CornerScene({{640, 480}});
  const Tracks tracks = StandingAt(1, 0, 0, 9);
  const cv::Mat picture(480, 640, CV_8UC3, cv::Scalar(10, 200, 100));
  const cv::Mat first = Composition(scene, {}).Draw(tracks, 3, {picture});
  const cv::Mat second = Composition(scene, {}).Draw(tracks, 3, {picture});
  EXPECT_EQ(cv::norm(first, second, cv::NORM_INF), 0);
  EXPECT_EQ(picture.at<cv::Vec3b>(0, 0), cv::Vec3b(10, 200, 100));  // the input stays as it is
}

TEST(RenderOptions, AreChecked) {
  EXPECT_TRUE(ValidateOptions(RenderOptions{}, "render"));
  EXPECT_THAT(MessageOf(ValidateOptions(RenderOptions{.trail_secs = -1}, "render")),
              HasSubstr("render.trail"));
  EXPECT_THAT(MessageOf(ValidateOptions(RenderOptions{.height_px = 100}, "render")),
              HasSubstr("render.height"));
}

}  // namespace
}  // namespace vantage
