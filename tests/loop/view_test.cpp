// The drawn view, looked at by the finder of tags: where it sees a tag is where the world says that
// it stands.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "nav/tags/finder.hpp"
#include "sim/world/painter.hpp"
#include "unit/sim/world_scene.hpp"

namespace roverd::sim::world {
namespace {

constexpr double kTurn = std::numbers::pi / 180.0;
constexpr int kColumns = 640;
constexpr int kRows = 480;
constexpr double kFov_rad = 70.0 * kTurn;

/// At (x, y), its middle so high, looking into that direction (counter-clockwise from east).
Thing tag_at(Vec2 at, double yaw_rad, int id, double height_m = 0.6, double size_m = 0.16) {
  Thing t = thing(Kind::Tag, {at});
  t.yaw_rad = yaw_rad;
  t.height_m = height_m;
  t.length_m = size_m;
  t.id = id;
  return t;
}

struct View {
  explicit View(World world) : scene(std::move(world)), moment(scene.at(0.0)) {}
  const std::vector<std::uint8_t>& from(const Pose& camera) {
    painter.expose(scene, moment, Frame(camera));
    return painter.develop(1, 0.0);
  }
  std::vector<nav::tags::Tag> tags_from(const Pose& camera, double size_m = 0.16) {
    const double f = kColumns / 2.0 / std::tan(kFov_rad / 2.0);
    nav::tags::TagParams params;
    params.size_m = size_m;
    return nav::tags::Finder()
        .find({kColumns, kRows, kColumns, from(camera)}, {f, f, kColumns / 2.0, kRows / 2.0},
              params)
        .value();
  }
  Scene scene;
  Moment moment;
  Painter painter{kColumns, kRows, kFov_rad};
};

TEST(Painter, ATagIsFoundWhereItStands) {
  // The tag looks west at a camera that looks east, from many places before it.
  View view(world_of({tag_at({3.0, 0.2}, std::numbers::pi, 42)}));
  for (const double x : {0.5, 1.2, 1.9, 2.4}) {
    for (const double y : {-0.5, 0.0, 0.6}) {
      const Pose camera{.x_m = x,
                        .y_m = y,
                        .z_m = 0.5,
                        .pitch_rad = 3.0 * kTurn,
                        .yaw_rad = std::atan2(0.2 - y, 3.0 - x) + 5.0 * kTurn};
      const auto tags = view.tags_from(camera);
      ASSERT_EQ(tags.size(), 1U) << x << " " << y;
      EXPECT_EQ(tags[0].id, 42);
      const auto& p = tags[0].place;
      const Vec3 at = Frame(camera) * Vec3{p.x(), p.y(), p.z()};
      EXPECT_NEAR(at.x, 3.0, 0.02) << x << " " << y;
      EXPECT_NEAR(at.y, 0.2, 0.02) << x << " " << y;
      EXPECT_NEAR(at.z, 0.6, 0.02) << x << " " << y;
    }
  }
}

TEST(Painter, ATurnedTagIsSeenAsTurned) {
  for (const double turned_deg : {-35.0, -20.0, 25.0, 40.0}) {
    View view(world_of({tag_at({1.0, 0.0}, std::numbers::pi + turned_deg * kTurn, 7, 0.5)}));
    const auto tags = view.tags_from({.z_m = 0.5});
    ASSERT_EQ(tags.size(), 1U) << turned_deg;
    // Into it: the third axis of the tag, in S.
    const Eigen::Vector3d into = tags[0].rotation.col(2);
    EXPECT_NEAR(std::atan2(into.y(), into.x()) / kTurn, turned_deg, 1.0);
    EXPECT_NEAR(into.z(), 0.0, 0.02);
  }
}

TEST(Painter, WhatStandsBeforeATagHidesItAndItsBackIsWhite) {
  const Thing tag = tag_at({3.0, 0.0}, std::numbers::pi, 3);
  const Pose camera{.z_m = 0.6};
  EXPECT_EQ(View(world_of({tag})).tags_from(camera).size(), 1U);
  EXPECT_TRUE(View(world_of({tag, box({2.0, 0.0}, 0.3, 1.0, 1.5)})).tags_from(camera).empty());
  EXPECT_TRUE(View(world_of({tag_at({3.0, 0.0}, 0.0, 3)})).tags_from(camera).empty());
}

TEST(Painter, NearThingsCoverFarOnesAndTheSkyIsAboveTheGround) {
  Thing near = box({2.0, 0.0}, 0.4, 0.4, 1.0);
  near.reflect = 0.0;
  Thing far = box({6.0, 0.0}, 3.0, 3.0, 3.0);
  far.reflect = 1.0;
  View view(world_of({near, far}));
  const auto& grey = view.from({.z_m = 0.5});
  const auto at = [&](int u, int v) {
    return int{grey[static_cast<std::size_t>(v * kColumns + u)]};
  };
  const int dark = at(320, 240);
  EXPECT_LT(dark, 90) << "the near one";
  EXPECT_GT(at(440, 240), dark + 60) << "the far one beside it";
  EXPECT_GT(at(10, 20), 190) << "sky";
  EXPECT_LT(at(10, 470), 150) << "ground";
}

TEST(Painter, OfTwoTagsInALineTheNearerOneCoversTheFarOne) {
  const Thing far = tag_at({3.0, 0.0}, std::numbers::pi, 3, 0.6, 0.2);
  const Thing near = tag_at({2.0, 0.0}, std::numbers::pi, 4, 0.6, 0.2);
  for (const World& world : {world_of({far, near}), world_of({near, far})}) {
    const auto tags = View(world).tags_from({.z_m = 0.6}, 0.2);
    ASSERT_EQ(tags.size(), 1U);
    EXPECT_EQ(tags[0].id, 4);
  }
}

TEST(Painter, WhatMovesWhileTheShutterIsOpenIsBlurredAndLiesInTheMiddle) {
  View view(world_of({tag_at({2.0, 0.0}, std::numbers::pi, 3)}));
  // The camera turns by 0.5 degrees: 4 pixels.
  for (const double turned_deg : {0.0, 0.125, 0.25, 0.375, 0.5}) {
    view.painter.expose(view.scene, view.moment,
                        Frame(Pose{.z_m = 0.6, .yaw_rad = turned_deg * kTurn}));
  }
  const std::vector<std::uint8_t> blurred = view.painter.develop(1, 0.0);
  const double f = kColumns / 2.0 / std::tan(kFov_rad / 2.0);
  const auto tags = nav::tags::Finder().find({kColumns, kRows, kColumns, blurred},
                                             {f, f, kColumns / 2.0, kRows / 2.0}, {});
  ASSERT_TRUE(tags);
  ASSERT_EQ(tags->size(), 1U);
  EXPECT_NEAR(std::atan2(tags->front().place.y(), tags->front().place.x()) / kTurn, -0.25, 0.05);
  const auto sharp = view.tags_from({.z_m = 0.6});
  EXPECT_LT(tags->front().margin, 0.9 * sharp.at(0).margin);
}

TEST(Painter, GlareTakesItsShareOfTheContrast) {
  View view(world_of({tag_at({2.0, 0.0}, std::numbers::pi, 3)}));
  const auto span_of = [&](double glare) {
    view.painter.expose(view.scene, view.moment, Frame(Pose{.z_m = 0.6}));
    const auto& grey = view.painter.develop(1, glare);
    const auto [low, high] = std::ranges::minmax(grey);
    return static_cast<double>(high - low);
  };
  EXPECT_NEAR(span_of(0.75), 0.25 * span_of(0.0), 8.0);
}

TEST(Painter, TheSameMomentIsTheSamePictureButForItsNoise) {
  View view(world_of({tag_at({3.0, 0.0}, std::numbers::pi, 3)}));
  const auto scene_at = [&](std::uint64_t number) {
    view.painter.expose(view.scene, view.moment, Frame(Pose{.z_m = 0.5}));
    return view.painter.develop(number, 0.0);
  };
  const auto first = scene_at(1);
  EXPECT_EQ(scene_at(1), first);
  EXPECT_NE(scene_at(2), first) << "a camera that works never gives the same picture twice";
}

}  // namespace
}  // namespace roverd::sim::world
