// Areas a robot must stay in and out of.
//
//        north 100 ┌─────────────────┐
//                  │   ┌───┐ 60      │
//                  │   │ × │         │
//                  │   └───┘ 40      │
//                0 └─────────────────┘
//                  0  40  60        100 east

#include "mission/fence/fence.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace roverd::mission {
namespace {

using base::EnuPoint;
using base::LatLon;

const base::LocalFrame kFrame(1, {58.0, 26.0});
constexpr double kExact_m = 0.001;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

FenceArea polygon(AreaKind kind, const std::vector<EnuPoint>& corners) {
  FencePolygon out;
  for (const EnuPoint p : corners) out.points.push_back(kFrame.to_global(p));
  return {kind, out};
}
FenceArea square(AreaKind kind, double west, double south, double east, double north) {
  return polygon(kind, {{west, south}, {east, south}, {east, north}, {west, north}});
}
FenceArea circle(AreaKind kind, EnuPoint center, double radius_m) {
  return {kind, FenceCircle{kFrame.to_global(center), radius_m}};
}
CompiledFence compiled(std::vector<FenceArea> areas) {
  const Fence fence{"field", std::move(areas), {}};
  EXPECT_TRUE(check_fence(fence).has_value());
  return {fence, kFrame};
}

TEST(Fence, WithoutOneEverythingIsAllowed) {
  const CompiledFence fence;

  EXPECT_TRUE(fence.empty());
  EXPECT_TRUE(fence.contains({1e6, -1e6}));
  EXPECT_EQ(fence.clearance_m(EnuPoint{5.0, 5.0}), kInfinite);
  EXPECT_FALSE(fence.crosses({0.0, 0.0}, {1000.0, 0.0}));
}

TEST(Fence, AFieldWithAPondLeavesTheGroundBetween) {
  const auto fence = compiled(
      {square(AreaKind::Inclusion, 0, 0, 100, 100), square(AreaKind::Exclusion, 40, 40, 60, 60)});

  EXPECT_TRUE(fence.contains({10.0, 50.0}));
  EXPECT_FALSE(fence.contains({50.0, 50.0}));
  EXPECT_FALSE(fence.contains({-1.0, 50.0}));
  EXPECT_NEAR(fence.clearance_m({10.0, 50.0}), 10.0, kExact_m);
  EXPECT_NEAR(fence.clearance_m({33.0, 50.0}), 7.0, kExact_m);
  EXPECT_NEAR(fence.clearance_m({48.0, 50.0}), -8.0, kExact_m);
  EXPECT_NEAR(fence.clearance_m({-3.0, -4.0}), -5.0, kExact_m);
  EXPECT_TRUE(fence.crosses({10.0, 50.0}, {90.0, 50.0}));
  EXPECT_NEAR(*fence.first_crossing_m({10.0, 50.0}, {90.0, 50.0}), 30.0, kExact_m);
  EXPECT_FALSE(fence.crosses({10.0, 10.0}, {90.0, 10.0}));
  EXPECT_NEAR(fence.clearance_m({10.0, 30.0}, {90.0, 30.0}), 10.0, kExact_m);
  EXPECT_NEAR(fence.clearance_m({10.0, 50.0}, {90.0, 50.0}), 0.0, kExact_m);
}

TEST(Fence, TwoFieldsThatTouchAreOne) {
  const auto fence = compiled(
      {square(AreaKind::Inclusion, 0, 0, 50, 100), square(AreaKind::Inclusion, 50, 0, 100, 100)});

  // given a way over the line between them, nothing is met
  EXPECT_FALSE(fence.crosses({10.0, 50.0}, {90.0, 50.0}));
  EXPECT_NEAR(fence.clearance_m({49.0, 50.0}), 49.0, 0.01);
}

TEST(Fence, TwoFieldsThatOverlapAreOne) {
  const auto fence = compiled(
      {square(AreaKind::Inclusion, 0, 0, 60, 100), square(AreaKind::Inclusion, 50, 20, 120, 80)});

  EXPECT_FALSE(fence.crosses({10.0, 50.0}, {110.0, 50.0}));
  EXPECT_TRUE(fence.crosses({10.0, 95.0}, {110.0, 75.0}));
  EXPECT_NEAR(fence.clearance_m({55.0, 50.0}), std::hypot(5.0, 30.0), 0.01);
}

TEST(Fence, ExclusionsAloneForbidOnlyThemselves) {
  const auto fence = compiled({circle(AreaKind::Exclusion, {0.0, 0.0}, 20.0)});

  EXPECT_TRUE(fence.contains({5000.0, 0.0}));
  EXPECT_NEAR(fence.clearance_m({50.0, 0.0}), 30.0, 0.011);
  EXPECT_NEAR(fence.clearance_m({3.0, 0.0}), -17.0, 0.011);
}

TEST(Fence, CirclesAreWithinACentimetreAndOnTheSafeSide) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> angle(0.0, 6.28318);
  for (const double radius_m : {0.5, 5.0, 300.0, 9000.0}) {
    const auto in = compiled({circle(AreaKind::Inclusion, {3.0, 4.0}, radius_m)});
    const auto out = compiled({circle(AreaKind::Exclusion, {3.0, 4.0}, radius_m)});
    for (int i = 0; i < 200; ++i) {
      const double a = angle(random);
      const auto at = [&](double r_m) {
        return EnuPoint{3.0 + r_m * std::cos(a), 4.0 + r_m * std::sin(a)};
      };
      EXPECT_FALSE(in.contains(at(radius_m * 1.000001 + 1e-6)));
      EXPECT_TRUE(in.contains(at(radius_m - 0.0101)));
      EXPECT_FALSE(out.contains(at(radius_m * 0.999999 - 1e-6)));
      EXPECT_TRUE(out.contains(at(radius_m + 0.0101)));
    }
  }
}

TEST(Fence, ClearanceAndInsideAgreeEverywhere) {
  // A concave field, a second one over its border, a hole over both.
  const auto fence = compiled(
      {polygon(AreaKind::Inclusion, {{0, 0}, {100, 0}, {100, 100}, {50, 30}, {0, 100}}),
       square(AreaKind::Inclusion, 90, 40, 150, 60), circle(AreaKind::Exclusion, {95, 50}, 8)});
  std::mt19937 random(11);
  std::uniform_real_distribution<double> east(-50.0, 200.0);
  std::uniform_real_distribution<double> north(-50.0, 150.0);
  for (int i = 0; i < 5000; ++i) {
    const EnuPoint a{east(random), north(random)};
    const EnuPoint b{east(random), north(random)};
    const double at_a = fence.clearance_m(a);
    EXPECT_EQ(at_a > 0.0, fence.contains(a));
    // The clearance is the radius of a disc without a limit.
    EXPECT_LE(std::abs(at_a - fence.clearance_m(b)), base::distance_m(a, b) + 1e-6)
        << (at_a > 0.0) << fence.contains(b);
    if (!fence.crosses(a, b)) {
      EXPECT_EQ(fence.contains(a), fence.contains(b));
    }
  }
}

TEST(Fence, AFieldFarAwayAllowsNothingHere) {
  const base::LocalFrame elsewhere(2, {-33.0, 151.0});
  Fence fence{"field", {square(AreaKind::Inclusion, 0, 0, 100, 100)}, {}};

  const CompiledFence far(fence, elsewhere);

  EXPECT_FALSE(far.empty());
  EXPECT_FALSE(far.contains({0.0, 0.0}));
  EXPECT_EQ(far.clearance_m(EnuPoint{0.0, 0.0}), -kInfinite);
}

TEST(Fence, WhatIsNoNumberIsNotAllowed) {
  const auto fence = compiled({square(AreaKind::Inclusion, 0, 0, 100, 100)});
  const EnuPoint bad{std::numeric_limits<double>::quiet_NaN(), 1.0};

  EXPECT_FALSE(fence.contains(bad));
  EXPECT_EQ(fence.clearance_m(bad), -kInfinite);
  EXPECT_TRUE(fence.crosses({1.0, 1.0}, bad));
}

std::string refused_at(const Fence& fence) {
  const auto result = check_fence(fence);
  return result || result.error().fields.empty() ? "" : result.error().fields.front().pointer;
}
std::string refused_at(FenceArea area) {
  return refused_at(Fence{"field", {std::move(area)}, {}});
}

TEST(FenceCheck, NamesWhatCannotBe) {
  const auto in = AreaKind::Inclusion;
  const double nan = std::numeric_limits<double>::quiet_NaN();

  EXPECT_EQ(refused_at(Fence{"nothing", {}, {}}), "/areas");
  EXPECT_EQ(refused_at(Fence{" ", {square(in, 0, 0, 1, 1)}, {}}), "/name");
  EXPECT_EQ(refused_at(polygon(in, {{0, 0}, {10, 0}})), "/areas/0/polygon");
  EXPECT_EQ(refused_at({in, FencePolygon{{{nan, 0}, {1, 1}, {0, 1}}}}), "/areas/0/polygon/0/lat");
  EXPECT_EQ(refused_at({in, FencePolygon{{{0, 0}, {1e308, 1}, {0, 1}}}}), "/areas/0/polygon/1/lat");
  EXPECT_EQ(refused_at({in, FenceCircle{{0, 0}, 0.0}}), "/areas/0/circle/radius_m");
  EXPECT_EQ(refused_at({in, FenceCircle{{0, 0}, 10'001.0}}), "/areas/0/circle/radius_m");
  EXPECT_EQ(refused_at({in, FenceCircle{{0, 181.0}, 1.0}}), "/areas/0/circle/lon");
  EXPECT_EQ(refused_at(polygon(in, {{0, 0}, {10, 0}, {30'000, 5}})), "/areas/0/polygon/2");
  EXPECT_EQ(refused_at(Fence{"r", {}, {{{91.0, 0.0}, {}}}}), "/rally/0/lat");
  EXPECT_EQ(refused_at(Fence{"r", {}, {{{1.0, 0.0}, 1e5}}}), "/rally/0/alt_m");
  EXPECT_EQ(refused_at(Fence{"r", {}, {{{1.0, 0.0}, 20.0}}}), "");
}

TEST(FenceCheck, RefusesAFigureThatCrossesItself) {
  const auto in = AreaKind::Inclusion;

  // the hourglass, a spike, a corner on a side, a repeated corner, a line
  EXPECT_EQ(refused_at(polygon(in, {{0, 0}, {10, 10}, {10, 0}, {0, 10}})), "/areas/0/polygon");
  EXPECT_EQ(refused_at(polygon(in, {{0, 0}, {10, 0}, {20, 0}, {10, 0}, {10, 10}})),
            "/areas/0/polygon");
  EXPECT_EQ(refused_at(polygon(in, {{0, 0}, {10, 0}, {10, 10}, {5, 0}, {0, 10}})),
            "/areas/0/polygon");
  EXPECT_EQ(refused_at(polygon(in, {{0, 0}, {10, 0}, {10, 0}, {10, 10}})), "/areas/0/polygon/2");
  EXPECT_EQ(refused_at(polygon(in, {{0, 0}, {10, 0}, {10, 10}, {0, 0}})), "/areas/0/polygon/0");
  EXPECT_EQ(refused_at(polygon(in, {{0, 0}, {10, 10}, {20, 20}})), "/areas/0/polygon");
  EXPECT_EQ(refused_at(square(in, 0, 0, 5, 5)), "");
}

TEST(FenceCheck, RefusesMoreThanThereCanBe) {
  Fence fence{"many", {}, {}};
  for (std::size_t i = 0; i <= kMaxAreas; ++i) {
    fence.areas.push_back(square(AreaKind::Exclusion, 0, 0, 1, 1));
  }

  const auto refused = check_fence(fence);

  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, base::Code::TooLarge);
}

}  // namespace
}  // namespace roverd::mission
