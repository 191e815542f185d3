// A stake thinner than what is asked of a thing near by is seen from afar, and not lost on the way.
#include <cmath>

#include <gtest/gtest.h>

#include "nav/sense/chain.hpp"
#include "scene.hpp"

namespace roverd::nav::sense {
namespace {

constexpr double kStep_rad = 0.5 * base::kPi / 180.0;
constexpr double kScannerAhead_m = 0.45;
constexpr double kSpeed_mps = 1.0;
const base::Mount kScanner{.x_m = kScannerAhead_m, .z_m = 0.3};

struct Stake {
  double x_m = 5.0;
  double y_m = 0.0;
  double thick_m = 0.012;
};

/// A scanner with a beam each half degree, which drives towards a stake before a far round wall.
struct Approach {
  double rate_hz = 50.0;
  double spot_rad = 0.0;  ///< half of a beam's width; half of the step: each stake meets one
  double noise_m = 0.0;

  Pose2 body(const Stake& s, double t) const {  // 4 m from the scanner at one second
    return {s.x_m - 4.0 - kScannerAhead_m + kSpeed_mps * (t - 1.0), 0.0, 0.0};
  }

  base::Sight scan(const Stake& s, double t, std::mt19937& random) const {
    base::Sight sight;
    sight.sensor = "eye";
    sight.stamp = at(t);
    sight.half_step_rad = static_cast<float>(0.5 * kStep_rad);
    std::normal_distribution<double> noise(0.0, std::max(noise_m, 1e-9));
    for (int i = -270; i <= 270; ++i) {
      const double after_s = 0.75 / rate_hz * (i + 270) / 540.0;
      const double bearing = i * kStep_rad;
      const Pose2 from = body(s, t + after_s);
      const Vec2 to{s.x_m - from.x_m - kScannerAhead_m, s.y_m};
      const double along = to.x * std::cos(bearing) + to.y * std::sin(bearing);
      const double beside = std::abs(to.y * std::cos(bearing) - to.x * std::sin(bearing));
      const double half = 0.5 * s.thick_m;
      const bool met = along > 0.0 && beside <= half + spot_rad * along;
      const double range =
          met ? along - std::sqrt(std::max(0.0, half * half - beside * beside)) + noise(random)
              : 7.0;
      base::SightPoint p;
      p.x_m = static_cast<float>(range * std::cos(bearing));
      p.y_m = static_cast<float>(range * std::sin(bearing));
      p.after_s = static_cast<float>(after_s);
      p.echo = base::Echo::Hit;
      sight.points.push_back(p);
    }
    return sight;
  }
};

struct Seen {
  double first_m = 0.0;  ///< of the first scan that had it in the grid; 0: none
  int lost = 0;          ///< scans after that one which had it not
};

/// @param around in cells: how far from the stake's own cell it may be
Seen drive(const Approach& way, const Stake& stake, double from_m, int around) {
  SensorSetup eye;
  eye.name = "eye";
  eye.mount = kScanner;
  eye.planar = true;
  eye.health.rate_hz = way.rate_hz;
  auto chain = Chain::of({}, {eye}, Footprint::box(1.0, 0.8, 0.5), at(0.0));
  EXPECT_TRUE(chain.has_value());
  std::mt19937 random(7);
  Seen out;
  for (double t = 1.0; t < 1.0 + 3.6 / kSpeed_mps; t += 1.0 / way.rate_hz) {
    const double away_m = 4.0 - kSpeed_mps * (t - 1.0);
    const auto history = driven(t + 0.05, [&](double when) { return way.body(stake, when); });
    EXPECT_TRUE(chain->take(way.scan(stake, t, random), history, at(t + 0.04)).has_value());
    if (away_m > from_m) continue;
    bool there = false;
    for (int dx = -around; dx <= around; ++dx) {
      for (int dy = -around; dy <= around; ++dy) {
        const Known k =
            chain->grid().at(stake.x_m + 0.05 * dx, stake.y_m + 0.05 * dy, at(t + 0.04));
        there |= k == Known::Occupied;
      }
    }
    if (there && out.first_m == 0.0) out.first_m = away_m;
    if (!there && out.first_m != 0.0) ++out.lost;
  }
  return out;
}

//   4 m ───────────────▶ 0.4 m  ·      beams that touch each other, as the real ones do
TEST(ThinTest, AStakeThatEveryScanMeetsIsBelievedFromAfarAndNeverLost) {
  for (const double thick_m : {0.012, 0.02}) {
    for (const double rate_hz : {25.0, 50.0}) {
      for (const double y_m : {0.025, 0.027, 0.131, 0.375}) {
        const Seen s = drive({rate_hz, 0.5 * kStep_rad}, {5.026, y_m, thick_m}, 4.0, 0);
        EXPECT_GT(s.first_m, 2.0) << thick_m << " m at " << rate_hz << " Hz, left " << y_m;
        EXPECT_EQ(s.lost, 0) << thick_m << " m at " << rate_hz << " Hz, left " << y_m;
      }
    }
  }
}

//   Echoes that lie a cell before it or behind it, now and then: it stays where it was found.
TEST(ThinTest, AStakeAtTheEdgeOfACellIsNotLostToTheNoiseOfTheRange) {
  for (const double thick_m : {0.012, 0.02}) {
    for (const double x_m : {5.002, 5.012, 5.026}) {
      const Seen s = drive({50.0, 0.5 * kStep_rad, 0.012}, {x_m, 0.131, thick_m}, 4.0, 1);
      EXPECT_GT(s.first_m, 2.0) << thick_m << " m at " << x_m;
      EXPECT_EQ(s.lost, 0) << thick_m << " m at " << x_m;
    }
  }
}

//   Beams without any width meet 1.2 cm for certain within 1.37 m, and 2 cm within 2.29 m.
TEST(ThinTest, OfBeamsAsThinAsLinesItIsSeenFromWhereOneOfThemMustMeetIt) {
  for (const double rate_hz : {25.0, 50.0}) {
    for (const double y_m : {0.027, 0.131, 0.375}) {
      const Seen stake = drive({rate_hz}, {5.026, y_m, 0.012}, 1.25, 0);
      EXPECT_GT(stake.first_m, 1.2) << rate_hz << " Hz, left " << y_m;
      EXPECT_EQ(stake.lost, 0) << rate_hz << " Hz, left " << y_m;
      const Seen pole = drive({rate_hz}, {5.026, y_m, 0.02}, 2.1, 0);
      EXPECT_GT(pole.first_m, 2.0) << rate_hz << " Hz, left " << y_m;
      EXPECT_EQ(pole.lost, 0) << rate_hz << " Hz, left " << y_m;
    }
  }
}

}  // namespace
}  // namespace roverd::nav::sense
