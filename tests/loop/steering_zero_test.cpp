// A steered vehicle whose wheels stand three degrees off when they are told to stand straight, and
// whose controller tells nothing: only its way over ground shows the error.

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "ackermann/driver.hpp"
#include "base/angle.hpp"
#include "link/memory.hpp"
#include "robot/robot.hpp"

namespace roverd::loop {
namespace {

using base::Time;
using std::chrono::milliseconds;

constexpr double kWheelbase_m = 1.3;

robot::Config uku() {
  robot::Config c;
  c.vehicle.kinematics = "ackermann";
  c.vehicle.wheelbase_m = kWheelbase_m;
  c.vehicle.max_steering_deg = 40.0;
  c.vehicle.max_steering_rate_dps = 40.0;
  c.vehicle.max_speed_mps = 1.4;
  c.safety.radio_required = false;
  c.track.lookahead_min_m = 2.5;
  c.track.lookahead_time_s = 1.3;
  c.track.lookahead_max_m = 6.5;
  c.estimate.yaw_scale = 1.0;
  return c;
}

/// Bicycle with a steering actuator of limited speed, 5 Hz RTK, no feedback.
class Atv {
 public:
  explicit Atv(double zero_error_rad, const ackermann::Params& params = {})
      : robot(uku()),
        zero_error_rad_(zero_error_rad),
        driver_(
            "ackermann", params,
            [this] { return base::Result<std::unique_ptr<link::ByteLink>>(std::move(wire_.a)); },
            [this](const base::Measurement& m) { robot.measurements().put(m); }) {
    wire_.b->set_immediate([this] { return now_; });
    wire_.b->on_bytes = [this](base::Bytes b, Time) { told_ = ackermann::decode(b).message; };
    EXPECT_TRUE(wire_.b->open());
    side_->set_immediate([this] { return now_; });
    robot.send = [this](const base::DriveCommand& c, Time t) { driver_.send(c, t); };
    driver_.start(now_);
  }

  void tick() {
    for (int i = 0; i < 2; ++i) {
      now_ += milliseconds(10);
      move(0.01);
      driver_.tick(now_);
      wire_.b->deliver(now_);
    }
    if (++ticks_ % 10 == 0) fix();
    robot.tick(now_, base::WallTime{now_.time_since_epoch()});
    std::vector<robot::PendingReply> replies;
    robot.replies().take(replies);
    for (auto& r : replies) {
      if (r.reply) r.reply(std::move(r.result));
    }
    std::vector<base::Event> events;
    robot.events().take(events);
  }
  template <class Done>
  bool run_until(Done done, double limit_s) {
    for (int i = 0; i < limit_s * 50.0; ++i) {
      tick();
      if (done()) return true;
    }
    return false;
  }
  base::Result<void> ask(robot::Command command) {
    base::Result<void> answer = base::fail(base::Code::Unavailable, "no answer came");
    robot.request(std::move(command), now_ + std::chrono::seconds(1),
                  [&answer](base::Result<void> r) { answer = std::move(r); });
    tick();
    return answer;
  }
  /// Straight north.
  void drive(double way_m) {
    mission::Plan plan;
    plan.name = "straight";
    plan.settings.speed_mps = 1.2;
    for (const double north_m : {10.0, way_m}) {
      mission::Waypoint w;
      w.at = frame_.to_global({0.0, north_m});
      plan.items.emplace_back(w);
    }
    ASSERT_TRUE(run_until([&] { return robot.snapshot()->ready_to_arm; }, 30.0));
    ASSERT_TRUE(ask(robot::Arm{}));
    const auto compiled = robot.compile({"m1", 1, plan});
    ASSERT_TRUE(compiled);
    ASSERT_TRUE(ask(robot::LoadMission{*compiled}));
    const auto started = ask(robot::StartMission{"m1", 1});
    ASSERT_TRUE(started) << started.error().detail;
  }

  robot::Robot robot;
  base::EnuPoint at;
  double yaw_rad = base::kPi / 2.0;

 private:
  void move(double dt_s) {
    constexpr double kWheelRate_radps = 0.7;
    const double most = kWheelRate_radps * dt_s;
    wheel_rad_ += std::clamp(told_.wheel_rad + zero_error_rad_ - wheel_rad_, -most, most);
    const bool drives = told_.mode == ackermann::DriveMode::Autonomous;
    speed_mps_ += ((drives ? told_.speed_mps : 0.0) - speed_mps_) * dt_s / 0.2;
    yaw_rad = base::wrap_rad(yaw_rad + speed_mps_ * std::tan(wheel_rad_) / kWheelbase_m * dt_s);
    at.east_m += speed_mps_ * std::cos(yaw_rad) * dt_s;
    at.north_m += speed_mps_ * std::sin(yaw_rad) * dt_s;
  }
  void fix() {
    std::normal_distribution<double> noise(0.0, 0.01);
    base::GnssFix f;
    f.stamp = now_;
    f.fix = base::FixType::RtkFixed;
    f.position = frame_.to_global({at.east_m + noise(random_), at.north_m + noise(random_)});
    f.satellites = 20;
    f.sigma_east_m = f.sigma_north_m = 0.015;
    robot.measurements().put(f);
    robot.measurements().put(base::GnssVelocity{now_, speed_mps_ * std::cos(yaw_rad),
                                                speed_mps_ * std::sin(yaw_rad), 0.05});
  }

  const double zero_error_rad_;
  const base::LocalFrame frame_{9, {58.378, 26.729}};
  std::mt19937 random_{7};
  Time now_{};
  int ticks_ = 0;
  double speed_mps_ = 0.0;
  double wheel_rad_ = 0.0;
  ackermann::Message told_;
  link::MemoryBytePair wire_ = link::memory_byte_pair();
  link::MemoryByteLink* side_ = wire_.a.get();
  ackermann::Driver driver_;
};

class SteeringZeroLoop : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Loop, SteeringZeroLoop, testing::Values(-3.0, 3.0));

//   │ ╮         the offset of the first metres goes away, and stays away
//   │ ╰╮ ▲ ──▶ │
TEST_P(SteeringZeroLoop, IsLearnedFromTheWayAloneAndTheOffsetGoesAway) {
  const double error_rad = base::rad_from_deg(GetParam());
  ackermann::Params params;
  params.assumed_delay_s = 0.0;  // this one has none
  Atv atv(error_rad, params);
  atv.drive(90.0);
  ASSERT_TRUE(atv.run_until([&] { return atv.at.north_m > 40.0; }, 120.0));
  double worst_m = 0.0;
  double sum_m = 0.0;
  int n = 0;
  ASSERT_TRUE(atv.run_until(
      [&] {
        worst_m = std::max(worst_m, std::abs(atv.at.east_m));
        sum_m += atv.at.east_m;
        ++n;
        return atv.at.north_m > 80.0;
      },
      90.0));
  EXPECT_LT(std::abs(sum_m / n), 0.01) << "beside the straight";
  EXPECT_LT(worst_m, 0.05);
  // What was learned is told: the bend of a vehicle that is told to go straight
  EXPECT_NEAR(atv.robot.snapshot()->estimator.pull_1pm, std::tan(error_rad) / kWheelbase_m, 0.01);
}

TEST(SteeringZeroParameter, AsAParameterLeavesNothingToLearn) {
  ackermann::Params params;
  params.zero_rad = -base::rad_from_deg(3.0);
  params.assumed_delay_s = 0.0;  // this one has none
  Atv atv(base::rad_from_deg(3.0), params);
  atv.drive(60.0);
  double worst_m = 0.0;
  ASSERT_TRUE(atv.run_until(
      [&] {
        if (atv.at.north_m > 5.0) worst_m = std::max(worst_m, std::abs(atv.at.east_m));
        return atv.at.north_m > 50.0;
      },
      120.0));
  EXPECT_LT(worst_m, 0.12);
  EXPECT_NEAR(atv.robot.snapshot()->estimator.pull_1pm, 0.0, 0.01);
}

}  // namespace
}  // namespace roverd::loop
