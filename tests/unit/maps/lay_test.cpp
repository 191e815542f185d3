// Where a driven map lies, by what the satellites said on the way.

#include "maps/lay.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "base/angle.hpp"

namespace {

using namespace roverd;

constexpr base::LatLon kOrigin{58.378, 26.729};

/// A round of 10 m x 6 m about (20, 5) in a map whose x axis has a heading, as satellites that are
/// off by (east_m, north_m) see it.
std::vector<maps::SeenAt> round(double heading_deg, double east_m, double north_m, double sigma_m) {
  const double yaw = base::yaw_from_heading(heading_deg);
  const base::LocalFrame frame(1, kOrigin);
  std::vector<maps::SeenAt> out;
  for (int i = 0; i < 40; ++i) {
    const double a = i * base::kPi / 20.0;
    const maps::Corner p{20.0 + 5.0 * std::cos(a), 5.0 + 3.0 * std::sin(a)};
    const base::EnuPoint at{std::cos(yaw) * p.x_m - std::sin(yaw) * p.y_m + east_m,
                            std::sin(yaw) * p.x_m + std::cos(yaw) * p.y_m + north_m};
    out.push_back({p, frame.to_global(at), sigma_m});
  }
  return out;
}

TEST(Laid, IsWhereTheSatellitesSawTheRobot) {
  for (const double heading_deg : {0.0, 90.0, 215.5}) {
    const auto anchor = maps::laid(round(heading_deg, 0.0, 0.0, 0.02));
    ASSERT_TRUE(anchor);
    EXPECT_LT(base::distance_bearing(anchor->at, kOrigin).distance_m, 1e-3);
    EXPECT_NEAR(std::remainder(anchor->heading_deg - heading_deg, 360.0), 0.0, 1e-3);
    // 2 cm over 4.1 m are 0.28 degrees; these over the 20.6 m from the origin are 10 cm.
    EXPECT_NEAR(anchor->heading_accuracy_deg, 0.278, 0.01);
    EXPECT_NEAR(anchor->accuracy_m, 0.102, 0.005);
  }
}

TEST(Laid, IsNoSurerThanWhatIsLeft) {
  auto seen = round(90.0, 0.0, 0.0, 0.02);
  for (std::size_t i = 0; i < seen.size(); ++i) {  // to and fro by 0.5 m
    seen[i].at = base::destination(seen[i].at, i % 2 == 0 ? 0.0 : 180.0, 0.5);
  }
  const auto anchor = maps::laid(seen);
  ASSERT_TRUE(anchor);
  EXPECT_GT(anchor->accuracy_m, 0.5);
  EXPECT_GT(anchor->heading_accuracy_deg, 5.0);
}

TEST(Laid, IsNotToldOfTooLittle) {
  const auto seen = round(90.0, 0.0, 0.0, 0.02);
  EXPECT_FALSE(maps::laid({}));
  EXPECT_FALSE(maps::laid(std::vector(seen.begin(), seen.begin() + 7)));
  EXPECT_FALSE(maps::laid(std::vector<maps::SeenAt>(50, seen.front())));  // it stood there
  EXPECT_FALSE(maps::laid(round(90.0, 0.0, 0.0, 8.0)));                   // not worth a word
}

}  // namespace
