#pragma once
// A robot in a field with an ideal vehicle, tick by tick, and a mission of any length.

#include <chrono>
#include <cmath>
#include <functional>
#include <vector>

#include "base/angle.hpp"
#include "robot/robot.hpp"

namespace roverd::robot {

inline const base::LocalFrame kFrame{9, {58.378, 26.729}};

/// Lanes of 30 m, 1.5 m apart, with a waypoint every 3 m.
inline mission::Plan plan_of(int items) {
  mission::Plan plan;
  plan.name = "bench";
  plan.settings.speed_mps = 1.0;
  plan.settings.at_end = mission::AtEnd::Repeat;
  for (int i = 0; i < items; ++i) {
    const int lane = i / 11;
    const int at = lane % 2 == 0 ? i % 11 : 10 - i % 11;
    mission::Waypoint w;
    w.at = kFrame.to_global({1.5 * lane, 3.0 * at});
    plan.items.emplace_back(w);
  }
  return plan;
}

/// An ideal vehicle that speaks like the drivers do: 50 Hz tracks and motion, 5 Hz GNSS.
class Field {
 public:
  Robot robot{Config{}};
  base::Time now{};
  std::function<void()> more;  ///< at the end of sense(), if there is one

  Field() {
    robot.send = [this](const base::DriveCommand& c, base::Time) { command_ = c; };
  }

  void sense() {
    hear();
    if (more) more();
  }

  void tick() { robot.tick(now, base::WallTime{now.time_since_epoch()}); }

  bool ask(Command command) {
    bool done = false;
    robot.request(std::move(command), now + std::chrono::seconds(1),
                  [&](base::Result<void> r) { done = r.has_value(); });
    sense();
    tick();
    drain();
    return done;
  }

  void drain() {
    replies_.clear();
    events_.clear();
    robot.replies().take(replies_);
    robot.events().take(events_);
    for (auto& r : replies_) {
      if (r.reply) r.reply(std::move(r.result));
    }
  }

  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      sense();
      tick();
      drain();
    }
  }

  base::EnuPoint at() const { return at_; }

  bool start(int items) {
    run(500);
    auto compiled = robot.compile({"m", 1, plan_of(items)});
    return compiled && ask(Arm{}) && ask(LoadMission{*compiled}) && ask(StartMission{"m", 1});
  }

 private:
  void hear() {
    now += std::chrono::milliseconds(20);
    const auto [v, w] = command_.twist;
    at_.east_m += v * 0.02 * std::cos(yaw_);
    at_.north_m += v * 0.02 * std::sin(yaw_);
    yaw_ = base::wrap_rad(yaw_ + w * 0.02);
    auto& in = robot.measurements();
    in.put(base::WheelTravel{now, (v - w * 0.3) * 0.02, (v + w * 0.3) * 0.02});
    in.put(base::BaseMotion{now, command_.twist});
    base::RadioState radio;
    radio.stamp = now;
    radio.swb = base::Switch::Up;
    radio.count = ++count_;
    in.put(radio);
    if (count_ % 5 == 0) {
      base::BaseStatus status;
      status.stamp = now;
      status.vehicle_state = base::VehicleState::Normal;
      status.control_mode = base::ControlMode::Can;
      status.battery_v = 50.0;
      in.put(status);
    }
    if (count_ % 10 != 0) return;
    base::GnssFix fix;
    fix.stamp = now;
    fix.fix = base::FixType::RtkFixed;
    fix.position = kFrame.to_global(at_);
    fix.satellites = 20;
    in.put(fix);
    in.put(base::GnssVelocity{now, v * std::cos(yaw_), v * std::sin(yaw_), {}});
    in.put(base::Heading{now, yaw_, base::HeadingSource::Compass});
  }

  base::DriveCommand command_;
  base::EnuPoint at_{};
  double yaw_ = base::kPi / 2.0;
  std::uint8_t count_ = 0;
  std::vector<PendingReply> replies_;
  std::vector<base::Event> events_;
};

}  // namespace roverd::robot
