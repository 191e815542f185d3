// From what a scanner saw to a place on the earth: anchors, starts, taps, and being carried away.

#include "nav/place/whereabouts.hpp"

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "shed.hpp"

namespace roverd::nav::place {
namespace {

using base::PlacePhase;

constexpr base::LatLon kShedAt{58.378, 26.729};
constexpr base::Mount kMount{.z_m = 0.3};
const double kTurned_rad = base::rad_from_deg(30.0);

/// A robot in the shed: its odometry has an origin of its own, and never jumps.
class Walk {
 public:
  explicit Walk(Pose2 from) : at(from) {}

  Pose2 at;  ///< X_MB, the truth
  double time_s = 100.0;
  std::vector<tests::Segment> walls = tests::shed();
  Whereabouts where{};

  static std::shared_ptr<const MapInUse> map(std::optional<MapAnchor> anchor,
                                             std::uint32_t number = 7) {
    return std::make_shared<const MapInUse>(
        MapInUse{"shed", number, tests::field_of(tests::shed(), 12.0, 8.0), nullptr, anchor});
  }
  const Pose2& odometry() const { return odometry_; }
  base::Time now() const { return base::Time{} + base::from_seconds(time_s); }
  /// Drives on by this step and looks. @return what was told
  std::optional<base::PlaceState> step(double ahead_m, double turn_rad,
                                       const std::optional<Believed>& believed = {},
                                       const std::string& sensor = "front") {
    time_s += 0.1;
    const Pose2 moved = sense::along(ahead_m / 0.1, turn_rad / 0.1, 0.1);
    at = at * moved;
    odometry_ = odometry_ * moved;
    where.moved({.stamp = now(), .pose = odometry_});
    base::Sight sight;
    sight.sensor = sensor;
    sight.stamp = now();
    for (int i = -135; i <= 135; ++i) {
      const double angle = base::rad_from_deg(i);
      const double range = tests::range_m(walls, at.x_m, at.y_m, at.yaw_rad + angle);
      base::SightPoint p;
      p.x_m = static_cast<float>(range * std::cos(angle));
      p.y_m = static_cast<float>(range * std::sin(angle));
      p.echo = range > 0.0 ? base::Echo::Hit : base::Echo::Unknown;
      sight.points.push_back(p);
    }
    return where.see(sight, kMount, believed);
  }
  /// Where that is on the earth, by an anchor at kShedAt that is turned by kTurned_rad.
  base::LatLon global() const {
    const double c = std::cos(kTurned_rad);
    const double s = std::sin(kTurned_rad);
    return base::LocalFrame(1, kShedAt)
        .to_global({c * at.x_m - s * at.y_m, s * at.x_m + c * at.y_m});
  }
  Believed by_satellites(double sigma_m, double yaw_sigma_rad = 0.02) const {
    return {now(),   global(),      base::wrap_rad(at.yaw_rad + kTurned_rad),
            sigma_m, yaw_sigma_rad, true};
  }

 private:
  Pose2 odometry_{5.0, -3.0, 1.0};
};

double apart_m(base::LatLon a, base::LatLon b) {
  return base::distance_bearing(a, b).distance_m;
}

TEST(Whereabouts, TellsThePlaceOnTheEarthOfATapByTheAnchor) {
  Walk w({2.5, 3.0, 0.1});
  EXPECT_FALSE(w.step(0.0, 0.0)) << "no map is in use";
  const auto begun = w.where.use(Walk::map(MapAnchor{kShedAt, kTurned_rad, 0.2}), w.now());
  EXPECT_EQ(begun.phase, PlacePhase::Searching);
  EXPECT_EQ(begun.map, "shed");
  // Given: a tap 0.4 m and 10 degrees off.
  const base::LatLon tap = base::destination(w.global(), 70.0, 0.4);
  ASSERT_TRUE(w.where.told({tap, w.at.yaw_rad + kTurned_rad + 0.17}));
  const auto told = w.step(0.0, 0.0);
  ASSERT_TRUE(told && told->fix);
  EXPECT_EQ(told->phase, PlacePhase::Known);
  EXPECT_LT(apart_m(told->fix->at, w.global()), 0.04);
  EXPECT_NEAR(base::angle_diff_rad(told->fix->yaw_rad, w.at.yaw_rad + kTurned_rad), 0.0, 0.02);
  EXPECT_NEAR(told->in_map->x_m, w.at.x_m, 0.04);
  EXPECT_EQ(told->fix->map, 7u);
  EXPECT_EQ(told->fix->anchor_sigma_m, 0.2);
  ASSERT_TRUE(told->lies);
  EXPECT_EQ(told->lies->at, kShedAt);
  EXPECT_EQ(told->lies->yaw_rad, kTurned_rad);
  EXPECT_EQ(told->stamp, w.now());
  EXPECT_GT(*told->sigma_m, 0.01);
  EXPECT_LT(*told->sigma_m, 0.1);
}

TEST(Whereabouts, FindsItselfAtOnceInAMapThatWasChangedALittle) {
  for (const bool same_place : {true, false}) {
    Walk w({2.5, 3.0, 0.1});
    w.where.use(Walk::map(MapAnchor{kShedAt, kTurned_rad, 0.2}), w.now());
    ASSERT_TRUE(w.where.told({w.global(), w.at.yaw_rad + kTurned_rad}));
    ASSERT_TRUE(w.step(0.0, 0.0)->fix);
    (void)w.step(0.05, 0.05);
    // When the map is taken anew, as after an edit, and the robot drives on meanwhile.
    w.where.moved({.stamp = w.now() + base::from_seconds(0.05), .pose = w.odometry()});
    const auto begun =
        w.where.use(Walk::map(MapAnchor{kShedAt, kTurned_rad, 0.2}), w.now(), same_place);
    EXPECT_EQ(begun.phase, PlacePhase::Searching);
    const auto told = w.step(0.05, 0.0);
    ASSERT_TRUE(told);
    EXPECT_EQ(told->fix.has_value(), same_place);
    if (told->fix) {
      EXPECT_LT(apart_m(told->fix->at, w.global()), 0.04);
    }
  }
}

TEST(Whereabouts, TellsHowTheMapLies) {
  Walk w({2.5, 3.0, 0.1});
  w.where.use(Walk::map(MapAnchor{kShedAt, kTurned_rad, 0.2}), w.now());
  ASSERT_TRUE(w.where.anchor());
  EXPECT_EQ(w.where.anchor()->yaw_rad, kTurned_rad);
  w.where.use(Walk::map({}), w.now());
  EXPECT_FALSE(w.where.anchor());
}

TEST(Whereabouts, BeginsWhereSatellitesSeeTheRobotWithoutASearch) {
  Walk w({2.5, 3.0, 0.1});
  w.where.use(Walk::map(MapAnchor{kShedAt, kTurned_rad, 0.1}), w.now());
  const auto told = w.step(0.0, 0.0, w.by_satellites(0.4));
  ASSERT_TRUE(told && told->fix);
  EXPECT_LT(apart_m(told->fix->at, w.global()), 0.04);
}

TEST(Whereabouts, SearchesOnWhereSatellitesSeeItAtAPlaceThatDoesNotFit) {
  Walk w({2.5, 3.0, 0.1});
  w.where.use(Walk::map(MapAnchor{kShedAt, kTurned_rad, 0.1}), w.now());
  std::optional<base::PlaceState> told;
  for (int i = 0; i < 40 && !(told && told->fix); ++i) {
    Believed wrong = w.by_satellites(0.4);
    wrong.at = base::destination(wrong.at, 90.0, 30.0);  // beside a wall of glass
    told = w.step(0.03, 0.03, wrong);
  }
  ASSERT_TRUE(told && told->fix) << "within 1.2 m";
  EXPECT_LT(apart_m(told->fix->at, w.global()), 0.1);
}

TEST(Whereabouts, LaysAMapWithoutAnAnchorWhereTheSatellitesSeeTheRobot) {
  Walk w({2.5, 3.0, 0.1});
  w.where.use(Walk::map({}), w.now());
  EXPECT_FALSE(w.where.told({kShedAt, 0.0})) << "nobody knows where the map lies";
  // Found by driving; meanwhile the satellites say where that is.
  std::optional<base::PlaceState> told;
  for (int i = 0; i < 20 && !(told && told->fix); ++i)
    told = w.step(0.15, 0.02, w.by_satellites(0.3));
  ASSERT_TRUE(told && told->fix);
  EXPECT_EQ(told->fix->anchor_sigma_m, 0.3);
  EXPECT_EQ(told->fix->anchor_yaw_sigma_rad, 0.02);
  // In the dark it goes on from there.
  for (int i = 0; i < 10; ++i) {
    told = w.step(0.1, 0.03);
    ASSERT_TRUE(told && told->fix) << i;
    EXPECT_LT(apart_m(told->fix->at, w.global()), 0.12) << i;
  }
  // A little of it is changed there: it lies where it lay, and what was learned of that holds.
  const base::PlaceFix before = *told->fix;
  w.where.use(Walk::map({}, 8), w.now(), true);
  told = w.step(0.1, 0.03);
  ASSERT_TRUE(told && told->fix);
  EXPECT_LT(apart_m(told->fix->at, w.global()), 0.12);
  EXPECT_EQ(told->fix->anchor, before.anchor);
  EXPECT_EQ(told->fix->map, before.map);
  EXPECT_NE(told->fix->found, before.found) << "by another look";
  // Somebody says where it lies: all is new.
  w.where.use(Walk::map(MapAnchor{kShedAt, kTurned_rad, 0.1}, 9), w.now(), true);
  told = w.step(0.1, 0.03);
  ASSERT_TRUE(told && told->fix);
  EXPECT_EQ(told->fix->anchor, kShedAt);
  EXPECT_EQ(told->fix->map, 9u);
}

TEST(Whereabouts, LaysNoMapByAHeadingThatIsNotSure) {
  Walk w({2.5, 3.0, 0.1});
  w.where.use(Walk::map({}), w.now());
  std::optional<base::PlaceState> told;
  for (int i = 0; i < 20; ++i) told = w.step(0.15, 0.02, w.by_satellites(0.3, 0.1));
  ASSERT_TRUE(told && told->in_map);
  EXPECT_FALSE(told->fix);
  told = w.step(0.15, 0.02, w.by_satellites(0.3, 0.02));
  ASSERT_TRUE(told && told->fix) << "as soon as it is";
}

TEST(Whereabouts, SaysThatAMapLiesNowhereWithoutAnchorAndSatellites) {
  Walk w({2.5, 3.0, 0.1});
  w.where.use(Walk::map({}), w.now());
  std::optional<base::PlaceState> told;
  for (int i = 0; i < 20 && !(told && told->in_map); ++i) told = w.step(0.15, 0.02);
  ASSERT_TRUE(told && told->in_map) << "but where in it the robot is";
  EXPECT_NEAR(told->in_map->x_m, w.at.x_m, 0.06);
  EXPECT_FALSE(told->fix);
  EXPECT_NE(told->reason.find("no anchor"), std::string::npos);
}

//   Indoors, with a map of which nobody has said where it lies: a person says where the robot is.
TEST(Whereabouts, LaysAMapWhereAPersonSaysThatTheRobotStands) {
  for (const bool before_it_is_found : {true, false}) {
    Walk w({2.5, 3.0, 0.1});
    w.where.use(Walk::map({}), w.now());
    const auto believed = [&w] {
      auto b = w.by_satellites(0.6, 0.17);
      b.by_satellites = false;
      return b;
    };
    std::optional<base::PlaceState> told = w.step(0.0, 0.0);
    ASSERT_TRUE(told);
    EXPECT_EQ(told->phase, PlacePhase::Searching);
    EXPECT_NE(told->reason.find("a tap does not help before"), std::string::npos) << told->reason;
    if (before_it_is_found) {
      // When: it is said while the place in the map is not known, which is told.
      EXPECT_FALSE(w.where.told({w.global(), w.at.yaw_rad + kTurned_rad}));
      told = w.step(0.0, 0.0, believed());
      ASSERT_TRUE(told && !told->fix);
      EXPECT_NE(told->reason.find("counts once it is found there"), std::string::npos)
          << told->reason;
    }
    for (int i = 0; i < 20 && !(told && told->in_map); ++i) told = w.step(0.15, 0.02, believed());
    ASSERT_TRUE(told && told->in_map);
    if (!before_it_is_found) {
      // When: it is said afterwards.
      EXPECT_FALSE(told->fix) << "what the robot believes is nobody's word";
      EXPECT_FALSE(w.where.told({w.global(), w.at.yaw_rad + kTurned_rad}));
      told = w.step(0.1, 0.0, believed());
    }
    // Then: it lies such that both are one.
    ASSERT_TRUE(told && told->fix);
    EXPECT_EQ(told->reason, "");
    ASSERT_TRUE(told->lies);
    EXPECT_LT(apart_m(told->lies->at, kShedAt), 0.12);
    EXPECT_NEAR(told->lies->yaw_rad, kTurned_rad, 0.03);
    EXPECT_EQ(told->fix->anchor_sigma_m, 0.6);
    EXPECT_EQ(told->fix->anchor_yaw_sigma_rad, 0.17) << "as sure as the word";
    EXPECT_TRUE(told->fix->north_said);
    // And: another map is laid by another word.
    w.where.use(Walk::map({}, 8), w.now());
    for (int i = 0; i < 20; ++i) told = w.step(0.1, 0.02, believed());
    ASSERT_TRUE(told && told->in_map);
    EXPECT_FALSE(told->fix);
  }
}

TEST(Whereabouts, LaysNoMapByAWordThatIsNotWholeOrLongAgo) {
  struct Case {
    bool both;
    double sigma_m;
    double yaw_sigma_rad;
  };
  for (const Case& c : {Case{false, 0.6, 0.17}, Case{true, 4.0, 0.17}, Case{true, 0.6, 0.5}}) {
    Walk w({2.5, 3.0, 0.1});
    w.where.use(Walk::map({}), w.now());
    auto believed = w.by_satellites(c.sigma_m, c.yaw_sigma_rad);
    EXPECT_FALSE(w.where.told({w.global(), w.at.yaw_rad + kTurned_rad, c.both}));
    std::optional<base::PlaceState> told;
    for (int i = 0; i < 20; ++i) {
      believed = w.by_satellites(c.sigma_m, c.yaw_sigma_rad);
      believed.by_satellites = false;
      told = w.step(0.1, 0.02, believed);
    }
    ASSERT_TRUE(told && told->in_map);
    EXPECT_FALSE(told->lies);
    EXPECT_NE(told->reason.find("say where the robot stands"), std::string::npos) << told->reason;
  }
}

TEST(Whereabouts, LaysAMapByAWordAlsoWhereSatellitesAreTooBadForIt) {
  Walk w({2.5, 3.0, 0.1});
  w.where.use(Walk::map({}), w.now());
  EXPECT_FALSE(w.where.told({w.global(), w.at.yaw_rad + kTurned_rad}));
  std::optional<base::PlaceState> told;
  for (int i = 0; i < 20; ++i) told = w.step(0.1, 0.02, w.by_satellites(1.2, 0.15));
  ASSERT_TRUE(told && told->lies);
  EXPECT_EQ(told->fix->anchor_yaw_sigma_rad, 0.15);
}

TEST(Whereabouts, LaysAMapAnewThatLayByAWordOnceSatellitesAreSure) {
  Walk w({2.5, 3.0, 0.1});
  w.where.use(Walk::map({}), w.now());
  // Given: a word that is 10 degrees off.
  const auto believed = [&w] {
    auto b = w.by_satellites(0.6, 0.17);
    b.yaw_rad += 0.17;
    b.by_satellites = false;
    return b;
  };
  EXPECT_FALSE(w.where.told({w.global(), w.at.yaw_rad + kTurned_rad + 0.17}));
  std::optional<base::PlaceState> told;
  for (int i = 0; i < 20; ++i) told = w.step(0.1, 0.02, believed());
  ASSERT_TRUE(told && told->lies);
  EXPECT_NEAR(told->lies->yaw_rad, kTurned_rad + 0.17, 0.03);
  const std::uint32_t number = told->fix->map;
  // When: satellites see it, not sure of the heading at first.
  told = w.step(0.1, 0.02, w.by_satellites(0.3, 0.1));
  ASSERT_TRUE(told && told->fix);
  EXPECT_EQ(told->fix->map, number);
  told = w.step(0.1, 0.02, w.by_satellites(0.3));
  // Then: it lies by them, as another map does.
  ASSERT_TRUE(told && told->fix);
  EXPECT_NEAR(told->lies->yaw_rad, kTurned_rad, 0.03);
  EXPECT_LT(apart_m(told->fix->at, w.global()), 0.12);
  EXPECT_NE(told->fix->map, number);
  EXPECT_FALSE(told->fix->north_said);
  EXPECT_EQ(told->fix->anchor_yaw_sigma_rad, 0.02);
}

TEST(Whereabouts, TakesTheLocalMapsOriginForTheMapsWhereNothingElseIsKnown) {
  Walk w({2.5, 3.0, 0.1});
  WhereaboutsParams params;
  params.local_origin = kShedAt;
  w.where = Whereabouts(params);
  w.where.use(Walk::map({}), w.now());
  const base::LocalFrame frame(1, kShedAt);
  w.step(0.0, 0.0);
  ASSERT_TRUE(w.where.told({frame.to_global({2.6, 3.1}), 0.1}));
  const auto told = w.step(0.0, 0.0);
  ASSERT_TRUE(told && told->fix);
  EXPECT_LT(apart_m(told->fix->at, frame.to_global({w.at.x_m, w.at.y_m})), 0.04);
}

TEST(Whereabouts, IsLostWithinThreeMetresOfBeingCarriedAway) {
  Walk w({2.0, 3.0, 0.0});
  w.where.use(Walk::map(MapAnchor{kShedAt, kTurned_rad, 0.1}), w.now());
  w.where.told({w.global(), w.at.yaw_rad + kTurned_rad});
  for (int i = 0; i < 5; ++i) w.step(0.1, 0.0);
  w.at = {9.4, 6.4, -0.5};
  double driven_m = 0.0;
  std::optional<base::PlaceState> told;
  while (driven_m < 3.0) {
    told = w.step(0.1, 0.05);
    driven_m += 0.1;
    ASSERT_TRUE(told);
    EXPECT_FALSE(told->fix) << driven_m;
    if (told->phase == PlacePhase::Lost) break;
  }
  EXPECT_EQ(told->phase, PlacePhase::Lost);
  EXPECT_NE(told->reason.find("drive by hand"), std::string::npos);
}

TEST(Whereabouts, CallsNoPlaceKnownThatNothingFits) {
  Walk w({2.5, 3.0, 0.1});
  w.walls = tests::other_building();
  w.where.use(Walk::map(MapAnchor{kShedAt, kTurned_rad, 0.1}), w.now());
  ASSERT_TRUE(w.where.told({w.global(), w.at.yaw_rad + kTurned_rad}));
  for (int i = 0; i < 20; ++i) {
    const auto told = w.step(0.02, 0.0);
    ASSERT_TRUE(told);
    EXPECT_NE(told->phase, PlacePhase::Known) << i;
    EXPECT_FALSE(told->in_map) << i;
  }
}

TEST(Whereabouts, LooksThroughOneSensorAndTenTimesASecond) {
  Walk w({2.5, 3.0, 0.1});
  w.where.use(Walk::map(MapAnchor{kShedAt, kTurned_rad, 0.1}), w.now());
  w.where.told({w.global(), w.at.yaw_rad + kTurned_rad});
  ASSERT_TRUE(w.step(0.0, 0.0));
  EXPECT_FALSE(w.step(0.0, 0.0, {}, "rear"));
  ASSERT_TRUE(w.step(0.0, 0.0)) << "the first one again";
  w.time_s -= 0.08;
  EXPECT_FALSE(w.step(0.0, 0.0)) << "too soon";
  // Where it falls silent, the other one takes its place.
  bool taken = false;
  for (int i = 0; i < 15; ++i) taken = w.step(0.0, 0.0, {}, "rear").has_value() || taken;
  EXPECT_TRUE(taken);
}

TEST(Whereabouts, TellsOnceThatNoMapIsInUse) {
  Walk w({2.5, 3.0, 0.1});
  w.where.use(Walk::map(MapAnchor{kShedAt, 0.0, 0.1}), w.now());
  const auto off = w.where.use(nullptr, w.now());
  EXPECT_EQ(off.phase, PlacePhase::Off);
  EXPECT_TRUE(off.map.empty());
  EXPECT_FALSE(w.step(0.0, 0.0));
}

/// Two sensors, the worse one is heard first: it is looked through until the better one comes, and
/// again a second after that one fell silent.
TEST(Whereabouts, TheBestSensorThatIsHeardIsLookedThrough) {
  Walk walk({2.5, 3.0, 0.1});
  WhereaboutsParams params;
  params.eyes = {"front", "top"};
  walk.where = Whereabouts(params);
  (void)walk.where.use(Walk::map(MapAnchor{kShedAt, kTurned_rad, 0.05}), walk.now());
  EXPECT_TRUE(walk.step(0.05, 0.0, {}, "top"));
  EXPECT_TRUE(walk.step(0.05, 0.0, {}, "front")) << "at once: it is the better one";
  EXPECT_FALSE(walk.step(0.05, 0.0, {}, "top"));
  for (int i = 0; i < 8; ++i) EXPECT_FALSE(walk.step(0.05, 0.0, {}, "top")) << i;
  EXPECT_TRUE(walk.step(0.05, 0.0, {}, "top")) << "a second later";
  EXPECT_TRUE(walk.step(0.05, 0.0, {}, "front"));
}

}  // namespace
}  // namespace roverd::nav::place
