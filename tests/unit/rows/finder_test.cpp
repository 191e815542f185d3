// What the finder makes of scans whose truth is known exactly.

#include "nav/rows/finder.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "nav/behave/row_drive.hpp"
#include "nav/rows/rays.hpp"

namespace roverd::nav::rows::tests {
namespace {

constexpr double kSeen_m = 7.0;

/// A scan from a body at `pose` of two lines of points y = ±half along x of O; nothing from
/// gap_from to gap_to, nor behind end.
struct Lane {
  double half_m = 1.0;
  double gap_from_m = 1e9;
  double gap_to_m = -1e9;
  double end_m = 1e9;
  bool left = true;
  bool right = true;

  RowScan scan(double at_s, const Pose2& pose) const {
    RowScan out;
    out.stamp = base::Time{base::from_seconds(at_s)};
    out.pose = pose;
    out.reach_m.fill(static_cast<float>(kSeen_m + 1.0));  // an open field
    const Pose2 in = sense::inverse(pose);
    for (double x = std::floor(pose.x_m - 5.0); x < pose.x_m + kSeen_m; x += 0.05) {
      if (x < 0.0 || x > end_m || (x > gap_from_m && x < gap_to_m)) continue;
      for (const double side : {1.0, -1.0}) {
        if ((side > 0.0 && !left) || (side < 0.0 && !right)) continue;
        const Pose2 p = in * Pose2{x + 0.01, side * half_m, 0.0};
        const double far_m = std::hypot(p.x_m, p.y_m);
        if (far_m > kSeen_m) continue;
        out.points.push_back({static_cast<float>(p.x_m), static_cast<float>(p.y_m)});
        const auto i = static_cast<std::size_t>(
            std::floor(base::deg_from_rad(std::atan2(p.y_m, p.x_m)) + 180.0));
        out.reach_m[i % 360] = static_cast<float>(far_m);
      }
    }
    return out;
  }
};

/// Drives straight along x of O, 0.1 m from scan to scan.
std::optional<RowView> drive(RowFinder& finder, const Lane& lane, double from_m, double to_m,
                             double y_m = 0.0, double yaw_rad = 0.0) {
  double t = from_m;
  for (double x = from_m; x <= to_m; x += 0.1, t += 0.1) {
    finder.see(lane.scan(100.0 + t, {x, y_m, yaw_rad}));
  }
  return finder.view();
}

TEST(RowFinder, TellsOffsetDirectionAndWidth) {
  RowFinder finder({}, {});
  const auto view = drive(finder, {}, 1.0, 4.0, 0.12, base::rad_from_deg(3.0));
  ASSERT_TRUE(view);
  EXPECT_NEAR(beside_line(*view, {4.0, 0.12, 0.0}).d_m, 0.12, 0.01);
  EXPECT_NEAR(view->line.yaw_rad, 0.0, base::rad_from_deg(0.5));
  EXPECT_NEAR(view->width_m, 2.0, 0.02);
  EXPECT_NEAR(view->curvature_1pm, 0.0, 0.002);
  EXPECT_LT(view->sigma_m(0.0), 0.05);
  EXPECT_LT(view->sigma_m(0.0), view->sigma_m(6.0)) << "far ahead it is less sure";
  EXPECT_FALSE(view->to_end_m);
}

TEST(RowFinder, SeesNoEndInAGapOfTwoMetres) {
  RowFinder finder({}, {});
  Lane lane;
  lane.gap_from_m = 6.0;
  lane.gap_to_m = 8.0;
  for (double x = 1.0; x < 9.0; x += 0.1) {
    finder.see(lane.scan(100.0 + x, {x, 0.0, 0.0}));
    if (x < 2.0) continue;
    ASSERT_TRUE(finder.view()) << x;
    EXPECT_FALSE(finder.view()->to_end_m) << x;
  }
}

TEST(RowFinder, SeesTheEndFromInsideTheRow) {
  RowFinder finder({}, {});
  Lane lane;
  lane.end_m = 8.0;
  const auto view = drive(finder, lane, 1.0, 6.5);
  ASSERT_TRUE(view && view->to_end_m);
  const Along at = beside_line(*view, {6.5, 0.0, 0.0});
  EXPECT_NEAR(*view->to_end_m - at.s_m, 1.5, 0.15);
}

TEST(RowFinder, TakesAnEndBackWherePlantsAppearBehindIt) {
  RowFinder finder({}, {});
  Lane lane;
  lane.end_m = 8.0;
  ASSERT_TRUE(drive(finder, lane, 1.0, 6.5)->to_end_m);
  lane.end_m = 1e9;  // they were hidden
  const auto view = drive(finder, lane, 6.6, 8.0);
  ASSERT_TRUE(view);
  EXPECT_FALSE(view->to_end_m);
}

TEST(RowFinder, TakesWhatIsNotSeenForNoEnd) {
  RowFinder finder({}, {});
  Lane lane;
  lane.end_m = 8.0;
  for (double x = 1.0; x < 7.5; x += 0.1) {
    RowScan scan = lane.scan(100.0 + x, {x, 0.0, 0.0});
    scan.reach_m.fill(0.0F);  // no ray says that it went through anywhere
    finder.see(scan);
  }
  ASSERT_TRUE(finder.view());
  EXPECT_FALSE(finder.view()->to_end_m);
}

TEST(RowFinder, KnowsTheMiddleByOneSideAndTheWidthItHasLearned) {
  RowFinder finder({}, {});
  Lane lane;
  ASSERT_TRUE(drive(finder, lane, 1.0, 4.0));
  const double sure_m = finder.view()->sigma_m(0.0);
  lane.left = false;
  const auto view = drive(finder, lane, 4.1, 14.5, 0.1);
  ASSERT_TRUE(view);
  EXPECT_NEAR(beside_line(*view, {14.5, 0.1, 0.0}).d_m, 0.1, 0.05);
  EXPECT_GT(view->sigma_m(0.0), sure_m);
  EXPECT_EQ(view->left, 0);
}

TEST(RowFinder, GivesARowUpThatIsNotSeenForThreeMetres) {
  RowFinder finder({}, {});
  Lane lane;
  ASSERT_TRUE(drive(finder, lane, 1.0, 5.0));
  lane.left = lane.right = false;
  EXPECT_FALSE(drive(finder, lane, 5.1, 14.0));
}

// As parameters are changed while it drives: such a pair would make it blind to every row.
TEST(RowParams, HeightsAndWidthsThatLeaveNothingBetweenThemAreRefused) {
  EXPECT_TRUE(check(RowParams{}));
  RowParams p;
  p.high_m = p.low_m;
  const auto flat = check(p);
  ASSERT_FALSE(flat);
  EXPECT_EQ(flat.error().fields.at(0).pointer, "low_m");
  p = {};
  p.width_min_m = 4.5;
  EXPECT_FALSE(check(p));
}

TEST(RowFinder, TakesOnePlantForNoRow) {
  RowFinder finder({}, {});
  Lane lane;
  lane.gap_from_m = 0.4;
  lane.gap_to_m = 1e9;
  EXPECT_FALSE(drive(finder, lane, -1.0, 3.0));
}

// The lane is at once so much narrower that it cannot be the same one.
TEST(RowFinder, IsNoLongerSureOfALineThatIsContradicted) {
  RowFinder finder({}, {});
  const auto before = drive(finder, {}, 0.0, 8.0);
  ASSERT_TRUE(before);
  Lane other;
  other.half_m = 0.68;
  double worst_m = 0.0;
  double t = 8.1;
  for (double x = 8.1; x < 12.0 && finder.view(); x += 0.1, t += 0.1) {
    finder.see(other.scan(100.0 + t, {x, 0.0, 0.0}));
    if (finder.view()) worst_m = std::max(worst_m, finder.view()->sigma_m(0.0));
  }
  EXPECT_GT(worst_m, 0.16);
}

TEST(RowFinder, TakesALaneThatIsTooNarrowForNoRow) {
  const auto width_m = [](double least_m) {
    RowParams params;
    params.width_min_m = least_m;
    RowFinder finder(params, {});
    const auto view = drive(finder, Lane{.half_m = 0.5}, 0.0, 3.0);
    return view ? view->width_m : 0.0;
  };
  EXPECT_NEAR(width_m(0.8), 1.0, 0.05);
  EXPECT_EQ(width_m(1.3), 0.0);
}

TEST(RowFinder, StandsForeignPoints) {
  RowFinder finder({}, {});
  RowScan scan;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  scan.points = {{nan, 1.0F}, {inf, inf}, {1e30F, -1e30F}, {0.0F, 0.0F}};
  for (int i = 0; i < 20; ++i) {
    scan.stamp = base::Time{base::from_seconds(i)};
    finder.see(scan);
  }
  EXPECT_FALSE(finder.view());
}

sense::Ray ray(double deg, double range_m) {
  const bool endless = range_m > 3.0;
  return {static_cast<float>(base::rad_from_deg(deg)), static_cast<float>(endless ? 4.0 : range_m),
          endless};
}

RowScan fan(double left_m, double right_m) {
  RowScan scan;
  scan.reach_m.fill(static_cast<float>(kSeen_m));
  for (int deg = -34; deg <= 34; ++deg) {
    const double range_m = deg < -20 ? right_m : deg > 20 ? left_m : 5.0;
    scan.rays.push_back(ray(deg, range_m));
  }
  return scan;
}

/// Of an eye 0.8 m above the ground, as the chain judges it.
sense::Reduced cloud(std::initializer_list<sense::Voxel> voxels) {
  sense::Reduced out;
  out.origin_m = {0.0F, 0.0F, 0.8F};
  out.voxels = voxels;
  out.counts.points = 100;
  return out;
}
sense::Voxel voxel(double x_m, double z_m, sense::Kind kind) {
  return {float(x_m), 0.0F, float(z_m), 1, kind, 0};
}

// A lidar that vouches for nothing where no echo comes back: what it sees is the ground.
TEST(RowScan, ARayToTheGroundWentThroughAtTheHeightOfPlants) {
  RowScan scan;
  // Down by 0.8 m over 4 m: at 3.5 m it is 0.1 m high, as low as plants are looked for.
  scan_of(cloud({voxel(4.0, 0.0, sense::Kind::Ground)}), {}, scan);
  EXPECT_NEAR(scan.reach_to(1.0, 0.0), 3.5, 1e-3);
  EXPECT_EQ(scan.reach_to(-1.0, 0.0), 0.0);
  EXPECT_TRUE(scan.points.empty());
  // Into a crown 2.2 m high, 4 m off: it leaves the height of plants, 1.5 m, half way.
  scan_of(cloud({voxel(4.0, 2.2, sense::Kind::Overhang)}), {}, scan);
  EXPECT_NEAR(scan.reach_to(1.0, 0.0), 2.0, 1e-3);
  scan_of(cloud({voxel(4.0, 0.5, sense::Kind::Obstacle)}), {}, scan);
  EXPECT_NEAR(scan.reach_to(1.0, 0.0), 4.0, 1e-3);
  EXPECT_EQ(scan.points.size(), 1u);
}

TEST(RowScan, WhoSeesGroundIsNotBlindHoweverMuchSkyThereIs) {
  RowScan scan;
  sense::Reduced open = cloud({});
  open.counts.unknown = 60;
  scan_of(open, {}, scan);
  EXPECT_TRUE(scan.blind);
  for (int i = 0; i < 20; ++i)
    open.voxels.push_back(voxel(2.0 + 0.1 * i, 0.0, sense::Kind::Ground));
  scan_of(open, {}, scan);
  EXPECT_FALSE(scan.blind);
}

TEST(Rays, SteerToTheMiddleBetweenTheFiveOutermost) {
  const RowView even = view_by_rays(fan(2.0, 2.0), {}, {});
  EXPECT_NEAR(even.line.yaw_rad, 0.0, 1e-6);
  EXPECT_EQ(even.left, 5);
  // Nearer to the right: to the left. Mean aside (2.4 − 2.0)/2 · sin 32° over 2.2 cos 32° ahead.
  const RowView off = view_by_rays(fan(2.4, 2.0), {}, {});
  EXPECT_NEAR(off.line.yaw_rad, std::atan(0.2 * std::sin(0.5585) / (2.2 * std::cos(0.5585))), 2e-3);
  EXPECT_FALSE(off.to_end_m);
}

TEST(Rays, DoNotCountBeyondThreeMetresAndEndWhereTenAreEndless) {
  const RowView left = view_by_rays(fan(2.0, 3.5), {}, {});
  EXPECT_EQ(left.right, 0);
  EXPECT_FALSE(left.to_end_m);
  const RowView none = view_by_rays(fan(3.5, 3.5), {}, {});
  ASSERT_TRUE(none.to_end_m);
  EXPECT_EQ(*none.to_end_m, 0.0);
}

TEST(Rays, NobodyLookedIsNoEnd) {
  RowScan scan = fan(3.5, 3.5);
  scan.reach_m.fill(0.0F);
  EXPECT_FALSE(view_by_rays(scan, {}, {}).to_end_m);
}

TEST(Rays, TheMiddleOfTwoSidesIsSurerThanOne) {
  const RowDriveParams drive;
  EXPECT_LT(view_by_rays(fan(2.0, 2.0), {}, {}).sigma_m(1.5), 0.7 * drive.unsure_m);
  EXPECT_GT(view_by_rays(fan(2.0, 3.5), {}, {}).sigma_m(1.5), drive.unsure_m);
}

// In the open no row is seen at all; an end comes only after 2 m of one.
TEST(Rays, EndOnlyARowThatWasMet) {
  RowOrder order;
  order.seeing = Seeing::Rays;
  RowFinder finder({}, order);
  double x_m = 0.0;
  const auto go = [&](double to_m, double side_m) {
    for (; x_m < to_m; x_m += 0.1) {
      RowScan scan = fan(side_m, side_m);
      scan.stamp = base::Time{base::from_seconds(x_m)};
      scan.pose.x_m = x_m;
      finder.see(scan);
    }
  };
  go(3.0, 3.5);
  EXPECT_FALSE(finder.view());
  go(4.0, 2.0);
  go(5.0, 3.5);  // a bush by the way
  ASSERT_TRUE(finder.view());
  EXPECT_FALSE(finder.view()->to_end_m);
  go(7.0, 2.0);
  EXPECT_FALSE(finder.view()->to_end_m);
  go(7.2, 3.5);
  EXPECT_TRUE(finder.view()->to_end_m);
}

}  // namespace
}  // namespace roverd::nav::rows::tests
