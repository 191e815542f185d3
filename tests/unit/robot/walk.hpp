#pragma once
// A robot whose every word is compared.

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "field.hpp"
#include "robot/safety/fence_guard.hpp"

namespace roverd::robot {

inline constexpr const char* kNone = "";

class Walk : public Field {
 public:
  /// Disarmed: the change comes when the robot has begun, before anybody arms it; else on the way.
  enum class When { OnTheWay, Disarmed };

  Walk(const Config& config, std::string name, base::ParamValue value, When when = When::OnTheWay)
      : Field(config), name_(std::move(name)), value_(std::move(value)), when_(when) {
    if (when_ == When::Disarmed) set();
    robot.send = [this](const base::DriveCommand& c, Time) {
      command = c;
      if (changed_) look();
    };
  }

  /// The moment of the change. Without a name everything else is the same.
  void change() {
    if (when_ == When::OnTheWay) set();
    changed_ = true;
  }

  void stick(double speed_mps, double turn_radps, double seconds) {
    let_go();
    for (double t = 0.0; t < seconds; t += 0.1) {
      robot.request(Drive{{speed_mps, turn_radps}, true}, now + std::chrono::milliseconds(250), {});
      run(0.1);
    }
  }
  void go(const mission::Plan& plan) {
    (void)load(plan);
    (void)ask(Arm{});
    (void)ask(StartMission{"m", 1});
  }
  GoTo to(base::EnuPoint p) const {
    GoTo g;
    g.at = kFrame.to_global(p);
    return g;
  }
  void target(base::EnuPoint where, base::EnuPoint velocity) {
    SetTarget t;
    t.at = kFrame.to_global(where);
    t.velocity_mps = velocity;
    t.asked = now;
    (void)ask(t);
  }

  bool taken = true;
  std::string refusal;
  std::vector<std::uint64_t> seen;

 private:
  void set() {
    const auto present = SetParameter{"robot.arming.healthy_s", robot.config()->arming.healthy_s};
    if (name_ == kNone) {
      EXPECT_TRUE(ask(present));
      return;
    }
    const auto done = ask(SetParameter{name_, value_});
    taken = done.has_value();
    refusal = done ? std::string() : done.error().detail;
  }

  void mix(std::uint64_t v) { hash_ = (hash_ ^ v) * 1099511628211ULL; }
  void mix(double v) { mix(std::bit_cast<std::uint64_t>(v)); }
  void mix(std::string_view text) { mix(std::hash<std::string_view>{}(text)); }

  void look() {
    mix(command.twist.linear_mps);
    mix(command.twist.angular_radps);
    if (const auto s = robot.snapshot()) {
      mix(static_cast<std::uint64_t>(s->mode));
      mix(static_cast<std::uint64_t>(s->armed) + 2U * static_cast<std::uint64_t>(s->estop));
      mix(s->mission.reason);
      mix(static_cast<std::uint64_t>(s->mission.state));
      mix(s->activity.reason);
      for (const auto& c : s->safety) mix(c.id + c.detail);
      for (const auto& c : s->checks) mix(c.id + c.detail + (c.ok ? "+" : "-"));
      mix(s->radio_meaning.swa);
      mix(s->radio_meaning.swc);
      mix(s->radio_meaning.swd);
      mix(s->radio_meaning.vra);
      if (s->battery) mix(s->battery->charge_pct);
      if (s->pose) {
        mix(s->pose->at.east_m);
        mix(s->pose->at.north_m);
        mix(s->pose->yaw_rad);
        mix(s->pose->horizontal_sigma_m);
        mix(s->pose->yaw_sigma_rad);
      }
      mix(s->estimator.advice);
      mix(s->estimator.rejected);
      mix(static_cast<std::uint64_t>(s->estimator.alignment));
      if (s->home) {
        mix(s->home->lat);
        mix(s->home->lon);
      }
      if (s->fence && s->fence->distance_m) mix(*s->fence->distance_m);
      if (s->obstacle) {
        mix(static_cast<std::uint64_t>(s->obstacle->action));
        mix(s->obstacle->reason);
        mix(s->obstacle->then);
        if (const auto by = s->obstacle->decides_at) mix(base::seconds(*by - now));
      }
    }
    for (; told_ < events.size(); ++told_) {
      const base::Event& e = events[told_];
      if (!e.kind.ends_with("parameter")) mix(e.kind + e.detail);
    }
    seen.push_back(hash_);
  }

  std::string name_;
  base::ParamValue value_;
  When when_;
  bool changed_ = false;
  std::size_t told_ = 0;
  std::uint64_t hash_ = 14695981039346656037ULL;
};

}  // namespace roverd::robot
