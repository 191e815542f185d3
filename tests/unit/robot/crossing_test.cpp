// People cross before a robot that looks with a scanner: its guard and its eyes, closed by a plain
// plant. Without foresight the same people are run into: that is what it is for.

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <random>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "robot/guard/guard.hpp"
#include "robot/guard/lookout.hpp"

namespace roverd::robot {
namespace {

constexpr double kTick_s = 0.02;
constexpr double kDecel_mps2 = 0.6;
constexpr double kPersonDeep_m = 0.15;  // half
constexpr double kPersonWide_m = 0.22;

base::Time moment(double s) {
  return base::Time{} + base::from_seconds(100.0 + s);
}

struct Person {
  double x_m = 5.0;
  double y_m = -4.0;
  double vx_mps = 0.0;
  double vy_mps = 1.0;
  nav::sense::Vec2 at(double t) const { return {x_m + vx_mps * t, y_m + vy_mps * t}; }
};

/// Metres from a place to him along a direction; empty: it passes him by.
std::optional<double> met(nav::sense::Vec2 from, double cosine, double sine,
                          nav::sense::Vec2 person) {
  double in = 0.0;
  double out = 1e9;
  const auto slab = [&](double low, double high, double d) {
    if (std::abs(d) < 1e-12) return low <= 0.0 && high >= 0.0;
    in = std::max(in, std::min(low / d, high / d));
    out = std::min(out, std::max(low / d, high / d));
    return true;
  };
  const nav::sense::Vec2 to = person - from;
  const bool both = slab(to.x - kPersonWide_m, to.x + kPersonWide_m, cosine) &&
                    slab(to.y - kPersonDeep_m, to.y + kPersonDeep_m, sine);
  if (!both || in > out) return std::nullopt;
  return in;
}

/// One drive straight ahead, 12 s, and somebody on his way.
class Crossing {
 public:
  Crossing(const Person& person, double speed_mps, double foresee_s, double turn_part = 1.0)
      : person_(person), speed_mps_(speed_mps), lookout_(eyes()) {
    nav::sense::ProtectParams params;
    params.foresee_s = foresee_s;
    params.turn_part = turn_part;
    guard_.set(params, {}, false);
  }

  struct Told {
    bool touched = false;  ///< while the robot moved
    bool stopped = false;
    double way_m = 0.0;
  };
  Told drive() {
    Told out;
    for (double t = 0.0; t < 12.0; t += kTick_s) {
      now_s_ = t;
      const auto odometry = guard_.move({v_mps_, 0.0}, moment(t));
      lookout_.moved(odometry);
      if (ticks_++ % 2 == 0) scan();
      if (auto picture = lookout_.picture(moment(t))) (void)guard_.take(std::move(picture));
      const bool waits = guard_.stops() && !guard_.may_go_on(moment(t));
      const double wanted =
          waits ? 0.0 : guard_.judge({speed_mps_, 0.0}, true, moment(t)).linear_mps;
      (void)guard_.decide(true, moment(t));
      out.stopped = out.stopped || guard_.stops();
      v_mps_ = std::clamp(wanted, v_mps_ - kDecel_mps2 * kTick_s, v_mps_ + 1.0 * kTick_s);
      x_m_ += v_mps_ * kTick_s;
      const nav::sense::Vec2 off = person_.at(t) - nav::sense::Vec2{x_m_, 0.0};
      if (v_mps_ > 0.02 && guard_.body().distance_m(off) < kPersonDeep_m) out.touched = true;
    }
    out.way_m = x_m_;
    return out;
  }

 private:
  static Lookout eyes() {
    nav::sense::SensorSetup eye;
    eye.name = "front";
    eye.mount.x_m = 0.5;
    eye.mount.z_m = 0.3;
    eye.planar = true;
    eye.health.rate_hz = 25.0;
    return {*nav::sense::Chain::of({}, {eye}, footprint_of({}), moment(0.0)), {"sick"}, 7.0};
  }

  void scan() {
    auto sight = std::make_shared<base::Sight>();
    sight->sensor = "front";
    sight->stamp = moment(now_s_);
    sight->count = static_cast<std::uint64_t>(ticks_);
    sight->half_step_rad = 0.0044F;
    sight->clear_to_m = 8.0F;
    const nav::sense::Vec2 from{x_m_ + 0.5, 0.0};
    for (int i = -270; i <= 270; ++i) {
      const double bearing = base::rad_from_deg(0.5 * i);
      const double c = std::cos(bearing);
      const double s = std::sin(bearing);
      const auto hit = met(from, c, s, person_.at(now_s_));
      const bool near = hit && *hit < 8.0;
      const double r = near ? *hit + noise_(random_) : 8.0;
      sight->points.push_back({static_cast<float>(r * c), static_cast<float>(r * s), 0.0F, 0.0F, 0,
                               0, near ? base::Echo::Hit : base::Echo::Clear});
    }
    lookout_.see(std::move(sight), moment(now_s_));
  }

  Person person_;
  double speed_mps_;
  Lookout lookout_;
  Guard guard_;
  std::mt19937 random_{5};
  std::normal_distribution<double> noise_{0.0, 0.01};
  double now_s_ = 0.0;
  double v_mps_ = 0.0;
  double x_m_ = 0.0;
  int ticks_ = 0;
};

/// He is on the robot's way when it would be there, or half a second before or after.
Person who_meets(std::mt19937& random, double speed_mps) {
  std::uniform_real_distribution<double> of(0.0, 1.0);
  Person p;
  const double angle = base::rad_from_deg(60.0 + 60.0 * of(random));
  const double his_mps = 0.5 + 1.5 * of(random);
  const double meets_s = 4.0 + of(random) - 0.5;
  const double x_m = speed_mps * (4.0 - 0.5 * speed_mps) + 0.3;  // it takes a while to be so fast
  p.vx_mps = his_mps * std::cos(angle);
  p.vy_mps = his_mps * std::sin(angle);
  p.x_m = x_m - p.vx_mps * meets_s;
  p.y_m = -p.vy_mps * meets_s;
  if (of(random) < 0.5) {
    p.y_m = -p.y_m;
    p.vy_mps = -p.vy_mps;
  }
  return p;
}

TEST(Crossing, WhoeverCrossesIsNotRunIntoAndWithoutForesightHeIs) {
  std::mt19937 random(11);
  const double speeds[] = {0.5, 1.0, 1.3};
  constexpr int kPeople = 15;
  constexpr int kBlindly = 6;
  int blindly = 0;
  int arrived = 0;
  for (int i = 0; i < kPeople; ++i) {
    const double speed_mps = speeds[i % 3];
    const Person person = who_meets(random, speed_mps);
    const auto told = Crossing(person, speed_mps, 3.0).drive();
    EXPECT_FALSE(told.touched) << "number " << i << " at " << speed_mps << " m/s: " << person.x_m
                               << " " << person.y_m << " " << person.vx_mps << " " << person.vy_mps;
    arrived += told.way_m > speed_mps * 4.0 ? 1 : 0;
    if (i < kBlindly) blindly += Crossing(person, speed_mps, 0.0).drive().touched ? 1 : 0;
  }
  EXPECT_GE(blindly, kBlindly / 2) << "else they do not cross";
  EXPECT_GE(arrived, kPeople * 8 / 10) << "it goes on behind them";
}

TEST(Crossing, WhoWalksBesideOrAwayHoldsNobody) {
  for (const Person& p :
       {Person{4.0, 2.5, 0.0, 1.0}, Person{9.0, -3.0, -1.0, -0.3}, Person{3.0, 0.0, 1.6, 0.0}}) {
    const auto told = Crossing(p, 1.0, 3.0).drive();
    EXPECT_FALSE(told.stopped) << p.x_m << " " << p.y_m;
    EXPECT_GT(told.way_m, 10.5) << p.x_m << " " << p.y_m;
  }
}

//   He is overtaken, 1.1 m beside the body, and may turn: it goes by him, slower.
TEST(Crossing, WhoIsOvertakenCloselySlowsAndHoldsNobody) {
  const Person beside{3.0, 1.6, 0.8, 0.0};
  const auto told = Crossing(beside, 1.0, 3.0).drive();
  EXPECT_FALSE(told.stopped);
  EXPECT_GT(told.way_m, 10.0);
  const auto trusts = Crossing(beside, 1.0, 3.0, 0.0).drive();
  EXPECT_GT(trusts.way_m, told.way_m + 0.3) << "nobody turns";
  EXPECT_GT(trusts.way_m, 10.5);
}

}  // namespace
}  // namespace roverd::robot
