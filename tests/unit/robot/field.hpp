#pragma once
// A robot with hand-made measurements: everything is well unless a test says otherwise.

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "robot/robot.hpp"

namespace roverd::robot {

using base::ExecutionState;
using base::Mode;

inline const base::LocalFrame kFrame{9, {58.378, 26.729}};

inline mission::Plan plan_of(const std::vector<base::EnuPoint>& points) {
  mission::Plan plan;
  plan.name = "field";
  for (const base::EnuPoint& p : points) {
    mission::Waypoint w;
    w.at = kFrame.to_global(p);
    plan.items.emplace_back(w);
  }
  return plan;
}

class Field {
 public:
  explicit Field(const Config& config = {}) : robot(config) {
    robot.send = [this](const base::DriveCommand& c, Time) {
      if (send_throws) throw std::runtime_error("the wire is cut");
      command = c;
      ++sends;
    };
    robot.wake = [this] { ++wakes; };
  }

  Robot robot;
  base::DriveCommand command;
  int sends = 0;
  bool send_throws = false;
  int wakes = 0;
  std::vector<base::Event> events;

  // What the drivers will say.
  bool base_speaks = true;
  bool radio_speaks = true;
  bool radio_counts = true;
  bool gnss_speaks = true;
  base::FixType fix = base::FixType::RtkFixed;
  int satellites = 20;
  base::Switch swa = base::Switch::Up;
  base::Switch swb = base::Switch::Up;
  base::Switch swc = base::Switch::Up;
  base::Switch swd = base::Switch::Up;
  double vra = 0.0;
  base::ControlMode control_mode = base::ControlMode::Can;
  base::VehicleState vehicle_state = base::VehicleState::Normal;
  bool radio_lost = false;
  std::optional<double> charge_pct;
  std::optional<double> receiver_late_s;  ///< its own time, behind ours; empty: it tells none
  bool obeys = true;                      ///< the base moves as it is told; else
  base::BodyTwist does{};                 ///< it moves so
  double grip = 1.0;                      ///< part of the wheels' way that is driven over ground
  double pivot_m = 0.0;                   ///< so far ahead of its origin it turns about
  std::optional<double> battery_v;
  std::optional<double> hdop;
  std::optional<double> fix_sigma_m;
  base::EnuPoint receiver_off{};  ///< told minus true position
  std::optional<double> speed_sigma_mps;
  base::HeadingSource compass = base::HeadingSource::Compass;
  bool compass_speaks = true;
  std::function<void()> more;  ///< says more at every tick, before the robot's
  base::EnuPoint at{};
  double yaw_rad = base::kPi / 2.0;
  Time now{};

  void tick() {
    now += std::chrono::milliseconds(20);
    const auto [v, w] = obeys ? command.twist : does;
    at.east_m += grip * v * 0.02 * std::cos(yaw_rad);
    at.north_m += grip * v * 0.02 * std::sin(yaw_rad);
    const double middle_rad = yaw_rad + 0.5 * w * 0.02;
    at.east_m += pivot_m * w * 0.02 * std::sin(middle_rad);
    at.north_m -= pivot_m * w * 0.02 * std::cos(middle_rad);
    yaw_rad = base::wrap_rad(yaw_rad + w * 0.02);
    speak(v, w);
    if (more) more();
    robot.tick(now, base::WallTime{now.time_since_epoch()});
    std::vector<PendingReply> replies;
    robot.replies().take(replies);
    for (auto& r : replies) {
      if (r.reply) r.reply(std::move(r.result));
    }
    robot.events().take(events);
  }

  void run(double seconds) {
    for (int i = 0; i < seconds * 50.0; ++i) tick();
  }

  base::Result<void> ask(Command command_, base::Duration valid = std::chrono::seconds(1)) {
    base::Result<void> answer = base::fail(base::Code::Unavailable, "no answer came");
    EXPECT_TRUE(robot.request(std::move(command_), now + valid,
                              [&answer](base::Result<void> r) { answer = std::move(r); }));
    tick();
    return answer;
  }

  base::Result<void> load(const mission::Plan& plan, std::int64_t revision = 1) {
    auto compiled = robot.compile({"m", revision, plan});
    if (!compiled) return tl::unexpected(compiled.error());
    return ask(LoadMission{*compiled});
  }

  /// Ready, armed, a mission of 20 m northwards running.
  void drive_mission() {
    run(8.0);
    ASSERT_TRUE(load(plan_of({{0, 20}})));
    const auto armed = ask(Arm{});
    ASSERT_TRUE(armed) << armed.error().detail;
    const auto started = ask(StartMission{"m", 1});
    ASSERT_TRUE(started) << started.error().detail;
    run(5.0);
    ASSERT_GT(command.twist.linear_mps, 0.3);
  }

  /// Sticks in the middle, dead-man off.
  void let_go() {
    robot.request(Drive{{}, false}, now, {});
    tick();
  }

  std::shared_ptr<const base::Snapshot> state() const { return robot.snapshot(); }
  ExecutionState execution() const { return state()->mission.state; }
  bool moves() const { return command.twist != base::BodyTwist{}; }
  bool has_condition(const std::string& id) const {
    return std::any_of(state()->safety.begin(), state()->safety.end(),
                       [&](const auto& c) { return c.id == id; });
  }
  bool has_event(const std::string& kind) const {
    return std::any_of(events.begin(), events.end(), [&](const auto& e) { return e.kind == kind; });
  }
  const base::Check& check(const std::string& id) const {
    const auto& all = state()->checks;
    return *std::find_if(all.begin(), all.end(), [&](const auto& c) { return c.id == id; });
  }

 private:
  void speak(double v, double w) {
    ++ticks_;
    auto& in = robot.measurements();
    if (base_speaks) {
      in.put(base::WheelTravel{now, (v - w * 0.3) * 0.02, (v + w * 0.3) * 0.02});
      in.put(base::BaseMotion{now, {v, w}});
      if (ticks_ % 5 == 0) {
        base::BaseStatus s;
        s.stamp = now;
        s.vehicle_state = vehicle_state;
        s.control_mode = control_mode;
        s.radio_lost = radio_lost;
        s.battery_v = battery_v;
        in.put(s);
      }
    }
    if (radio_speaks) {
      base::RadioState r;
      r.stamp = now;
      r.swa = swa;
      r.swb = swb;
      r.swc = swc;
      r.swd = swd;
      r.vra = vra;
      if (radio_counts) ++radio_count_;
      r.count = radio_count_;
      in.put(r);
    }
    if (charge_pct) in.put(base::BatteryState{now, *charge_pct, 50.0, {}, {}});
    if (!gnss_speaks || ticks_ % 10 != 0) return;
    base::GnssFix f;
    f.stamp = now;
    f.fix = fix;
    if (fix != base::FixType::None) f.position = kFrame.to_global(at + receiver_off);
    f.satellites = satellites;
    if (receiver_late_s) {
      f.utc = base::WallTime{std::chrono::seconds(1'780'000'000)} + now.time_since_epoch() -
              base::from_seconds(*receiver_late_s);
    }
    f.hdop = hdop;
    f.sigma_east_m = f.sigma_north_m = fix_sigma_m;
    in.put(f);
    in.put(base::GnssVelocity{now, grip * v * std::cos(yaw_rad), grip * v * std::sin(yaw_rad),
                              speed_sigma_mps});
    if (compass_speaks) in.put(base::Heading{now, yaw_rad, compass});
  }

  int ticks_ = 0;
  std::uint8_t radio_count_ = 0;
};

}  // namespace roverd::robot
