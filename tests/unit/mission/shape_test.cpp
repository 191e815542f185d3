// Operations on the figure: exact on the ellipsoid, and the opposite one gives the start back.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "base/geo.hpp"
#include "mission/edit/operations.hpp"
#include "plans.hpp"

namespace roverd::mission {
namespace {

constexpr double kMillimetre = 0.001;

/// Random figures of `size_m` across, anywhere but within some metres of the poles.
class Figures {
 public:
  explicit Figures(std::uint32_t seed) : random_(seed) {}

  double number(double min, double max) {
    return std::uniform_real_distribution<double>(min, max)(random_);
  }

  Plan next(double size_m) {
    const LatLon centre{number(-80.0, 80.0), number(-180.0, 180.0)};
    Plan plan;
    plan.name = "figure";
    plan.home = Home{near(centre, size_m), std::nullopt};
    const int count = 3 + static_cast<int>(number(0.0, 20.0));
    for (int i = 0; i < count; ++i) {
      Waypoint waypoint;
      waypoint.at = near(centre, size_m);
      plan.items.emplace_back(waypoint);
    }
    plan.items.emplace_back(Local{number(-size_m, size_m) / 2, 7.0, number(0.0, 359.0)});
    plan.items.emplace_back(TurnBy{std::nullopt, number(0.0, 359.0)});
    plan.items.emplace_back(TurnBy{number(-180.0, 180.0), std::nullopt});
    plan.items.emplace_back(Move{number(-5.0, 5.0)});
    plan.items.emplace_back(Row{.side = RowSide::Left});
    plan.items.emplace_back(Landmarks{"cone", 0.7});
    return plan;
  }

 private:
  LatLon near(LatLon centre, double size_m) {
    return base::destination(centre, number(0.0, 360.0), number(0.0, size_m / 2));
  }
  std::mt19937 random_;
};

LatLon at(const Plan& plan, std::size_t i) {
  return std::get<Waypoint>(plan.items.at(i)).at;
}

double heading_gap(double a, double b) {
  return std::abs(std::remainder(a - b, 360.0));
}

/// Farthest that an item stands from where it stood, metres; other values count as they are.
double gap_m(const Plan& a, const Plan& b) {
  if (a.items.size() != b.items.size() || a.home != b.home) return 1e9;
  double most = 0.0;
  for (std::size_t i = 0; i < a.items.size(); ++i) {
    if (const auto* p = std::get_if<Waypoint>(&a.items[i])) {
      most = std::max(most, base::distance_bearing(p->at, at(b, i)).distance_m);
    } else if (const auto* q = std::get_if<Local>(&a.items[i])) {
      const auto& r = std::get<Local>(b.items[i]);
      most = std::max({most, std::hypot(q->east_m - r.east_m, q->north_m - r.north_m),
                       heading_gap(*q->heading_deg, *r.heading_deg)});
    } else if (const auto* t = std::get_if<TurnBy>(&a.items[i]); t && t->heading_deg) {
      most =
          std::max(most, heading_gap(*t->heading_deg, *std::get<TurnBy>(b.items[i]).heading_deg));
    } else if (const auto* m = std::get_if<Move>(&a.items[i])) {
      most = std::max(most, std::abs(m->forward_m - std::get<Move>(b.items[i]).forward_m));
    } else if (a.items[i] != b.items[i]) {
      return 1e9;
    }
  }
  return most;
}

Plan done(Plan plan, const Operation& operation) {
  auto result = perform(std::move(plan), operation);
  EXPECT_TRUE(result) << result.error().detail;
  return result ? std::move(result->plan) : Plan{};
}

TEST(ShapeOperations, OffsetMovesEveryPointByTheDistanceAndKeepsTheFigure) {
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    Figures figures(seed);
    const Plan plan = figures.next(1000.0);
    const double way_m = figures.number(0.0, 1000.0);
    const double bearing_rad = figures.number(0.0, 6.28);
    const base::EnuPoint by{way_m * std::sin(bearing_rad), way_m * std::cos(bearing_rad)};
    const Plan moved = done(plan, Offset{by, std::nullopt});
    EXPECT_EQ(moved.home, plan.home);
    for (std::size_t i = 0; i + 1 < plan.items.size(); ++i) {
      if (!std::holds_alternative<Waypoint>(plan.items[i + 1])) break;
      EXPECT_NEAR(base::distance_bearing(at(plan, i), at(moved, i)).distance_m, way_m, kMillimetre);
      EXPECT_NEAR(base::distance_bearing(at(plan, i), at(plan, i + 1)).distance_m,
                  base::distance_bearing(at(moved, i), at(moved, i + 1)).distance_m, kMillimetre);
    }
    EXPECT_LT(gap_m(plan, done(moved, Offset{{-by.east_m, -by.north_m}, std::nullopt})),
              kMillimetre)
        << seed;
  }
}

TEST(ShapeOperations, AnOffsetIsUndoneByItsOppositeAtAnyLatitude) {
  for (const double lat : {0.0, 58.0, 85.0, 89.0, 89.9, 89.99, -89.9}) {
    // Given a figure of up to 2 km that has no symmetry,
    Plan plan;
    plan.name = "figure";
    for (int i = 0; i < 12; ++i) {
      Waypoint waypoint;
      const LatLon middle{lat, 179.9};
      waypoint.at = base::destination(middle, 37.0 * i, i < 6 ? 60.0 * i : 1000.0 - 50.0 * i);
      plan.items.emplace_back(waypoint);
    }
    for (const double way_m : {0.5, 300.0, 1500.0}) {
      for (double bearing_deg = 0.0; bearing_deg < 360.0; bearing_deg += 45.0) {
        const double rad = bearing_deg * std::acos(-1.0) / 180.0;
        const base::EnuPoint by{way_m * std::sin(rad), way_m * std::cos(rad)};
        // (across the pole there is no way that a direction names: it is refused)
        if (std::abs(lat) > 89.95 && way_m > 1000.0) {
          if (!perform(plan, Offset{by, std::nullopt})) continue;
        }
        // when it is moved and moved back,
        const Plan moved = done(plan, Offset{by, std::nullopt});
        const Plan back = done(moved, Offset{{-by.east_m, -by.north_m}, std::nullopt});
        // then it went as far as it was told to, and is where it was.
        for (std::size_t i = 0; i < plan.items.size(); ++i) {
          EXPECT_NEAR(base::distance_bearing(at(plan, i), at(moved, i)).distance_m, way_m,
                      kMillimetre);
        }
        EXPECT_LT(gap_m(plan, back), kMillimetre) << lat << ' ' << way_m << ' ' << bearing_deg;
      }
    }
  }
  // So near to the pole nobody can go 9 km to the east.
  Plan plan;
  plan.name = "pole";
  plan.items.emplace_back(waypoint_at(89.999, 0.0));
  const auto lost = perform(plan, Offset{{9000.0, 0.0}, {}});
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.error().fields.at(0).pointer, "/op");
}

TEST(ShapeOperations, OffsetOfADriftedFrameAgreesWithTheGeodesic) {
  // Given a mission at 58° north and the frame's shift of a day, 3 m,
  Plan plan;
  plan.name = "field";
  for (const double way_m : {0.0, 150.0, 300.0}) {
    Waypoint waypoint;
    waypoint.at = base::destination({58.378, 26.729}, 70.0, way_m);
    plan.items.emplace_back(waypoint);
  }
  // when it is moved 3 m to 60°, then each point lies where the geodesic leads.
  const double rad = 60.0 * std::acos(-1.0) / 180.0;
  const auto moved = perform(plan, Offset{{3.0 * std::sin(rad), 3.0 * std::cos(rad)}, {}});
  ASSERT_TRUE(moved);
  EXPECT_EQ(moved->what, "moved all items 1.5 m north, 2.598 m east");
  for (std::size_t i = 0; i < plan.items.size(); ++i) {
    const LatLon expected = base::destination(at(plan, i), 60.0, 3.0);
    EXPECT_LT(base::distance_bearing(expected, at(moved->plan, i)).distance_m, kMillimetre);
  }
  // One item alone, or a run:
  const Plan one = done(plan, Offset{{0.0, 10.0}, Numbers{2, 2}});
  EXPECT_EQ(at(one, 0), at(plan, 0));
  EXPECT_EQ(at(one, 2), at(plan, 2));
  EXPECT_NEAR(base::distance_bearing(at(plan, 1), at(one, 1)).distance_m, 10.0, 1e-6);
}

TEST(ShapeOperations, AnOffsetTakesThePlacesWithItBesideWhichRowsAndWallsEnd) {
  Plan plan;
  plan.name = "block";
  const Until until{58.001, 26.0, std::nullopt};
  plan.items = {waypoint_at(58.0, 26.0), Row{.until = until},
                Wall{.distance_m = 0.9, .until = until},
                Row{.until = {std::nullopt, std::nullopt, "gate"}}};
  const Plan moved = done(plan, Offset{{3.0, 4.0}, {}});
  const LatLon expected =
      base::destination({58.001, 26.0}, base::deg_from_rad(std::atan2(3.0, 4.0)), 5.0);
  const auto off_m = [&](const Until& at) {
    return base::distance_bearing(expected, {at.lat.value(), at.lon.value()}).distance_m;
  };
  EXPECT_LT(off_m(std::get<Row>(moved.items[1]).until), kMillimetre);
  EXPECT_LT(off_m(std::get<Wall>(moved.items[2]).until), kMillimetre);
  EXPECT_EQ(moved.items[3], plan.items[3]) << "a known place lies where it lies";
  // A run of rows alone is moved, too.
  const Plan rows = done(plan, Offset{{3.0, 4.0}, Numbers{2, 2}});
  EXPECT_LT(off_m(std::get<Row>(rows.items[1]).until), kMillimetre);
  EXPECT_EQ(rows.items[2], plan.items[2]);
}

TEST(ShapeOperations, AligningPutsOneItemOnItsAnchorAndKeepsTheFigure) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    Figures figures(seed);
    const Plan plan = figures.next(500.0);
    const LatLon anchor = base::destination(at(plan, 1), figures.number(0.0, 360.0), 3.0);
    const auto aligned = perform(plan, Align{{2, anchor}, std::nullopt});
    ASSERT_TRUE(aligned) << aligned.error().detail;
    EXPECT_EQ(aligned->plan.home, plan.home);
    EXPECT_LT(base::distance_bearing(at(aligned->plan, 1), anchor).distance_m, kMillimetre);
    EXPECT_NEAR(base::distance_bearing(at(aligned->plan, 0), at(aligned->plan, 2)).distance_m,
                base::distance_bearing(at(plan, 0), at(plan, 2)).distance_m, kMillimetre);
  }
}

TEST(ShapeOperations, AligningByTwoItemsTurnsTheFigureToo) {
  //   3 ┌ · · · · 2'        a leg to the east that the day's frame shows to the north-east
  //     1 ─────── 2
  Plan plan;
  plan.name = "field";
  const LatLon start{58.378, 26.729};
  for (const double way_m : {0.0, 100.0}) {
    Waypoint waypoint;
    waypoint.at = base::destination(start, 90.0, way_m);
    plan.items.emplace_back(waypoint);
  }
  plan.items.emplace_back(TurnBy{std::nullopt, 350.0});
  const LatLon first = base::destination(start, 10.0, 2.0);
  const LatLon second = base::destination(first, 60.0, 100.25);

  const auto aligned = perform(plan, Align{{1, first}, Anchor{2, second}});

  ASSERT_TRUE(aligned) << aligned.error().detail;
  EXPECT_LT(base::distance_bearing(at(aligned->plan, 0), first).distance_m, kMillimetre);
  EXPECT_NEAR(base::distance_bearing(at(aligned->plan, 1), second).distance_m, 0.25, 0.002);
  EXPECT_NEAR(*std::get<TurnBy>(aligned->plan.items[2]).heading_deg, 320.0, 0.01);
  EXPECT_NE(aligned->what.find("turned by -30"), std::string::npos) << aligned->what;
  EXPECT_NE(aligned->what.find("item 2 is 0.25 m from its place"), std::string::npos);

  EXPECT_EQ(perform(plan, Align{{7, first}, {}}).error().fields.at(0).pointer, "/item");
  EXPECT_EQ(perform(plan, Align{{3, first}, {}}).error().fields.at(0).pointer, "/item");
  EXPECT_EQ(perform(plan, Align{{1, first}, Anchor{1, first}}).error().fields.at(0).pointer,
            "/second");
  EXPECT_EQ(perform(plan, Align{{1, {0.0, 0.0}}, {}}).error().fields.at(0).pointer, "/item");
}

TEST(ShapeOperations, TurningAndScalingBackGivesTheStart) {
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    Figures figures(seed);
    const Plan plan = figures.next(1000.0);
    const double factor = figures.number(0.2, 3.0);
    const double turn_deg = figures.number(-400.0, 400.0);
    const About abouts[] = {Middle{}, Centroid{}, AtHome{}, at(plan, 0)};
    for (const About& about : abouts) {
      const auto there = perform(plan, ScaleRotate{factor, turn_deg, about});
      ASSERT_TRUE(there) << there.error().detail;
      EXPECT_EQ(there->plan.home, plan.home);
      // Distances grow by the factor, directions turn by the angle.
      const auto before = base::distance_bearing(at(plan, 0), at(plan, 1));
      const auto now = base::distance_bearing(at(there->plan, 0), at(there->plan, 1));
      EXPECT_NEAR(now.distance_m, factor * before.distance_m, kMillimetre);
      const auto back =
          perform(there->plan, ScaleRotate{1.0 / factor, -turn_deg, there->about.value()});
      EXPECT_LT(gap_m(plan, back->plan), kMillimetre) << seed;
    }
    const Plan turned = done(plan, ScaleRotate{1.0, turn_deg, Centroid{}});
    EXPECT_LT(gap_m(plan, done(turned, ScaleRotate{1.0, -turn_deg, Centroid{}})), kMillimetre);
  }
}

TEST(ShapeOperations, TurningIsClockwise) {
  //   2          1 → 2 to the north becomes 1 → 2 to the east
  //   1  1 2
  Plan plan;
  plan.name = "line";
  plan.items = {waypoint_at(58.0, 26.0), waypoint_at(58.001, 26.0), TurnBy{std::nullopt, 350.0}};
  const auto turned = perform(plan, ScaleRotate{1.0, 90.0, LatLon{58.0, 26.0}});
  const auto way = base::distance_bearing(at(turned->plan, 0), at(turned->plan, 1));
  EXPECT_NEAR(way.bearing_deg, 90.0, 1e-6);
  EXPECT_NEAR(*std::get<TurnBy>(turned->plan.items[2]).heading_deg, 80.0, 1e-9);
  EXPECT_EQ(turned->what, "turned by 90 deg about a given point");
}

TEST(ShapeOperations, MirroringTwiceAboutTheSameAxisGivesTheStart) {
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    Figures figures(seed);
    const Plan plan = figures.next(1000.0);
    const double axis_deg = figures.number(-720.0, 720.0);
    const auto there = perform(plan, Mirror{axis_deg, Middle{}});
    ASSERT_TRUE(there) << there.error().detail;
    EXPECT_EQ(there->plan.home, plan.home);
    EXPECT_NE(there->plan.items.back(), plan.items.back());  // the cone is on the other side
    const auto back = perform(there->plan, Mirror{axis_deg, there->about.value()});
    EXPECT_LT(gap_m(plan, back->plan), kMillimetre) << seed;
  }
}

TEST(ShapeOperations, AMirrorAboutNorthChangesEastAndWest) {
  Plan plan;
  plan.name = "line";
  plan.items = {waypoint_at(58.0, 26.0),
                waypoint_at(58.0, 26.001),
                TurnBy{-30.0, std::nullopt},
                Row{.side = RowSide::Left},
                Landmarks{.name = "any", .side = Side::Left},
                Landmarks{"any", 0.7}};
  const Plan mirrored = done(plan, Mirror{0.0, LatLon{58.0, 26.0}});
  EXPECT_NEAR(at(mirrored, 1).lon, 25.999, 1e-9);
  EXPECT_NEAR(at(mirrored, 1).lat, 58.0, 1e-9);
  EXPECT_EQ(mirrored.items[2], Item(TurnBy{30.0, std::nullopt}));
  EXPECT_EQ(mirrored.items[3], Item(Row{.side = RowSide::Right}));
  EXPECT_EQ(mirrored.items[4], Item(Landmarks{.name = "any", .side = Side::Right}));
  EXPECT_EQ(mirrored.items[5], Item(Landmarks{"any", -0.7}));
}

TEST(ShapeOperations, TheMiddleIsThatOfTheExtremes) {
  Plan plan;
  plan.name = "triangle across the date line";
  plan.items = {waypoint_at(10.0, 179.999), waypoint_at(10.001, -179.999),
                waypoint_at(10.0, 180.0)};
  const auto done = perform(plan, Mirror{0.0, Middle{}});
  ASSERT_TRUE(done) << done.error().detail;
  EXPECT_NEAR(done->about->lat, 10.0005, 1e-12);
  EXPECT_NEAR(std::abs(done->about->lon), 180.0, 1e-9);
}

TEST(ShapeOperations, WhatCannotBeIsRefusedByName) {
  const auto pointer = [](const Plan& plan, const Operation& operation) {
    const auto result = perform(plan, operation);
    return result || result.error().fields.empty() ? "" : result.error().fields.at(0).pointer;
  };
  Plan plan;
  plan.name = "p";
  plan.items = {waypoint_at(58.0, 26.0), waypoint_at(58.0, 26.01)};
  EXPECT_EQ(pointer(plan, ScaleRotate{0.0, 1.0, Middle{}}), "/factor");
  EXPECT_EQ(pointer(plan, ScaleRotate{std::nan(""), 1.0, Middle{}}), "/factor");
  EXPECT_EQ(pointer(plan, ScaleRotate{100.0, 1.0, Middle{}}), "/factor");
  EXPECT_EQ(pointer(plan, ScaleRotate{1.0, 1.0, AtHome{}}), "/about");
  EXPECT_EQ(pointer(plan, ScaleRotate{1.0, 1.0, LatLon{0.0, 0.0}}), "/about");
  EXPECT_EQ(pointer(plan, ScaleRotate{1.0, 1.0, LatLon{-58.0, -154.0}}), "/about");
  EXPECT_EQ(pointer(plan, Offset{{1e308, 0.0}, {}}), "/distance_m");
  EXPECT_EQ(pointer(plan, Offset{{1.0, 0.0}, Numbers{1, 3}}), "/last");
  plan.items = {Local{1.0, 2.0, {}}};
  EXPECT_EQ(pointer(plan, Mirror{0.0, Middle{}}), "/op");
  EXPECT_EQ(done(plan, Offset{{1.0, 0.0}, {}}).items[0], Item(Local{2.0, 2.0, {}}));
}

}  // namespace
}  // namespace roverd::mission
