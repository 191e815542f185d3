#pragma once
// What stopping_test tries: the ways of driving, and what fails, each with its limits.

#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "vehicle_rig.hpp"

namespace roverd::loop {

/// By hand it is pushed at all times; a target walks ahead at all times.
struct Ride {
  RigBase& rig;
  double speed_mps;
  Mode mode;
  bool pushes = false;
  double turn_radps = 0.0;
  bool follows = false;
  bool speaks = true;
  bool watched = true;
  double ahead_m = 0.0;

  void tick() {
    if (watched) rig.robot.measurements().put(base::OperatorLink{rig.state()->now, 1});
    const long k = std::lround(50.0 * rig.now_s());
    if (pushes && speaks && k % 5 == 0) rig.drive(speed_mps, turn_radps);
    if (follows && k % 10 == 0) {
      ahead_m += 0.2 * speed_mps;
      robot::SetTarget t;
      t.at = rig.place({0.0, ahead_m});
      t.velocity_mps = base::EnuPoint{0.0, speed_mps};
      t.asked = Time{base::from_seconds(rig.now_s())};
      rig.robot.request(t, Time::max(), {});
    }
    rig.tick();
  }
  double pace() const {
    const auto twist = rig.truth().twist;
    return turn_radps != 0.0 ? std::abs(twist.angular_radps) : std::abs(twist.linear_mps);
  }
};

struct Way {
  const char* name;
  std::vector<double> speeds;
  void (*begin)(Ride&);
  bool by_hand = false;
  const char* vehicle = "";  ///< else the Bunker
};

inline void by_stick(Ride& r, Mode mode, double turn_radps = 0.0) {
  r.mode = mode;
  ASSERT_TRUE(r.rig.ask(robot::SetMode{mode}));
  r.rig.let_go();
  r.pushes = true;
  r.turn_radps = turn_radps;
}

inline robot::GoTo north(Ride& r, double metres) {
  robot::GoTo g;
  g.at = r.rig.place({0.0, metres});
  g.speed_mps = r.speed_mps;
  return g;
}

inline const std::vector<Way> kWays = {
    {"AUTO",
     {0.5, 1.0, 1.3},
     [](Ride& r) {
       r.rig.load(r.rig.plan_of({{0, 6}, {0, 60}}, r.speed_mps));
       r.rig.start();
     }},
    {"GUIDED", {0.5, 1.0, 1.3}, [](Ride& r) { ASSERT_TRUE(r.rig.ask(north(r, 60))); }},
    {"GUIDED, backwards",
     {0.5},
     [](Ride& r) {
       robot::GoTo g = north(r, -40);
       g.reverse = true;
       ASSERT_TRUE(r.rig.ask(g));
     }},
    {"GUIDED, turning on the spot",
     {0.5},
     [](Ride& r) {
       r.turn_radps = 0.2;
       robot::MoveBy turn;
       turn.turn_rad = 30.0;
       ASSERT_TRUE(r.rig.ask(turn));
     }},
    {"RTL",
     {0.5, 1.0, 1.3},
     [](Ride& r) {
       ASSERT_TRUE(r.rig.ask(robot::SetHome{r.rig.place({0, 60})}));
       ASSERT_TRUE(r.rig.ask(robot::SetMode{Mode::Rtl}));
     }},
    {"FOLLOW",
     {0.5, 1.0, 1.3},
     [](Ride& r) {
       r.follows = true;
       r.ahead_m = r.rig.truth().local.north_m + 8.0;
       for (int i = 0; i < 20; ++i) r.tick();
       ASSERT_TRUE(r.rig.ask(robot::SetMode{Mode::Follow}));
     }},
    {"DOCK",
     {0.5, 1.0, 1.3},
     [](Ride& r) {
       robot::SetMode dock{Mode::Dock, north(r, 60)};
       dock.goal->yaw_rad = base::kPi / 2.0;
       ASSERT_TRUE(r.rig.ask(dock));
     }},
    {"MANUAL", {0.5, 1.0, 1.3}, [](Ride& r) { by_stick(r, Mode::Manual); }, true},
    {"MANUAL, backwards", {-0.5, -1.0}, [](Ride& r) { by_stick(r, Mode::Manual); }, true},
    {"MANUAL, turning on the spot", {0.0}, [](Ride& r) { by_stick(r, Mode::Manual, 0.6); }, true},
    {"STEERING", {0.5, 1.0, 1.3}, [](Ride& r) { by_stick(r, Mode::Steering); }, true},
    {"AUTO, a car",
     {1.5, 3.0},
     [](Ride& r) {
       r.rig.load(r.rig.plan_of({{0, 20}, {0, 150}}, r.speed_mps));
       r.rig.start();
     },
     false,
     "imiev"},
};

struct Fault {
  const char* name;
  void (*breaks)(Ride&);
  double zero_s;             ///< at most until the command is zero, and stays so
  double brakes_s = zero_s;  ///< at most until the vehicle begins to brake
  double more_m = 0.0;       ///< allowed beside the way of reaction and braking
  bool hands = true;         ///< it stops who drives by hand, too
  bool alone = true;         ///< it stops what drives by itself
  bool car = true;           ///< there is such a thing in the car
  bool turning = true;       ///< it stops a turn on the spot, too
  bool to_hold = false;      ///< when nobody watches any more, by choice
  bool program = true;       ///< there is still one whose command could be zero
};

template <void (*Change)(sim::Faults&)>
void with(Ride& r) {
  r.rig.fault(Change);
}

inline void turn_switch(Ride& r) {
  sim::Radio radio;
  radio.swb = base::Switch::Middle;
  r.rig.plant.set_radio(radio);
}

inline void let_go(Ride& r) {
  r.speaks = false;
  r.rig.drive(0.0, 0.0, false);
}

inline void meddle(Ride& r) {
  dynamic_cast<Rig&>(r.rig).put_on_bus(bunker::encode(bunker::MotionCommand{{.linear_mps = 0.3}}));
}

inline void hit(Ride& r) {
  r.rig.robot.measurements().put(base::Bumper{r.rig.state()->now, true, "front"});
}

inline void lean(Ride& r) {
  sim::Params p = r.rig.plant.params();
  p.imu.roll_deg = 40.0;
  r.rig.plant.set_params(p);
}

inline constexpr double kTick_s = 0.04;  // the command is taken by the next tick, and seen after it

inline const std::vector<Fault> kFaults = {
    {.name = "emergency stop asked for",
     .breaks = [](Ride& r) { (void)r.rig.ask(robot::Estop{"a person"}); },
     .zero_s = kTick_s},
    {.name = "disarmed",
     .breaks = [](Ride& r) { (void)r.rig.ask(robot::Disarm{}); },
     .zero_s = kTick_s},
    {.name = "HOLD asked for",
     .breaks = [](Ride& r) { (void)r.rig.ask(robot::SetMode{Mode::Hold}); },
     .zero_s = kTick_s},
    {.name = "stick let go", .breaks = let_go, .zero_s = kTick_s, .alone = false},
    {.name = "the page falls silent",
     .breaks = [](Ride& r) { r.speaks = false; },
     .zero_s = 0.56,
     .alone = false},
    {.name = "red button on the robot",
     .breaks = with<[](sim::Faults& f) { f.estop = true; }>,
     .zero_s = 0.16},
    {.name = "radio takes over", .breaks = turn_switch, .zero_s = 0.10},
    {.name = "transmitter out of range, told",
     .breaks = with<[](sim::Faults& f) { f.radio_loss = true; }>,
     .zero_s = 0.60,
     .car = false},
    {.name = "transmitter out of range, its bytes frozen",
     .breaks = with<[](sim::Faults& f) { f.radio_freeze = true; }>,
     .zero_s = 0.60,
     .car = false},
    {.name = "transmitter out of range, not told",
     .breaks = with<[](sim::Faults& f) { f.radio_loss = f.radio_loss_unflagged = true; }>,
     .zero_s = 0.60,
     .car = false},
    {.name = "transmitter frozen, not told",
     .breaks = with<[](sim::Faults& f) { f.radio_freeze = f.radio_loss_unflagged = true; }>,
     .zero_s = 0.60,
     .car = false},
    {.name = "drive link dead",
     .breaks = with<[](sim::Faults& f) { f.bus_off = true; }>,
     .zero_s = 0.46,
     .brakes_s = 0.6},
    {.name = "commands to the base lost",
     .breaks = with<[](sim::Faults& f) { f.loss_to_base = 1.0; }>,
     .zero_s = 2.6,
     .brakes_s = 0.6},
    {.name = "frames of the base lost",
     .breaks = with<[](sim::Faults& f) { f.loss_from_base = 1.0; }>,
     .zero_s = 0.46},
    {.name = "fault bits of the motors",
     .breaks = with<[](sim::Faults& f) { f.error_bits = 0x10; }>,
     .zero_s = 0.40,
     .car = false},
    {.name = "somebody else commands the base", .breaks = meddle, .zero_s = 0.10, .car = false},
    {.name = "position lost",
     .breaks = with<[](sim::Faults& f) { f.gnss_outage = true; }>,
     .zero_s = 30.0,
     .brakes_s = 2.0,  // creeps from then on
     .more_m = 8.0,
     .hands = false,
     .turning = false},
    {.name = "receiver silent",
     .breaks = with<[](sim::Faults& f) { f.gnss_silent = true; }>,
     .zero_s = 30.0,
     .brakes_s = 2.0,  // creeps from then on
     .more_m = 8.0,
     .hands = false,
     .turning = false},
    {.name = "program killed",
     .breaks = [](Ride& r) { r.rig.dead = true; },
     .zero_s = 0.6,
     .program = false},
    {.name = "bumper hit", .breaks = hit, .zero_s = 0.06},
    {.name = "battery empty",
     .breaks = [](Ride& r) { r.rig.plant.set_battery_pct(4.0); },
     .zero_s = 2.5,
     .hands = false},
    {.name = "it leans by 40 deg", .breaks = lean, .zero_s = 1.5, .car = false},
    {.name = "nobody watches, and it is to hold then",
     .breaks = [](Ride& r) { r.watched = false; },
     .zero_s = 3.5,
     .hands = false,
     .car = false,
     .to_hold = true},
    {.name = "position frozen, its time runs on",
     .breaks = with<[](sim::Faults& f) { f.gnss_position_frozen = true; }>,
     .zero_s = 30.0,
     .brakes_s = 2.0,
     .more_m = 8.0,
     .hands = false,
     .turning = false},
    {.name = "receiver repeats its bytes",
     .breaks = with<[](sim::Faults& f) { f.gnss_repeats = true; }>,
     .zero_s = 30.0,
     .brakes_s = 2.0,
     .more_m = 8.0,
     .hands = false,
     .turning = false},
    {.name = "position jumps by 6 m",
     .breaks = with<[](sim::Faults& f) { f.gnss_jump_north_m = -6.0; }>,
     .zero_s = 30.0,
     .brakes_s = 2.0,
     .more_m = 8.0,
     .hands = false,
     .turning = false},
    {.name = "position drifts away, 0.2 m/s",
     .breaks = with<[](sim::Faults& f) { f.gnss_drift_east_mps = 0.2; }>,
     .zero_s = 30.0,
     .brakes_s = 8.0,
     .more_m = 8.0,
     .hands = false,
     .turning = false},
    {.name = "wheel counters frozen",
     .breaks = with<[](sim::Faults& f) { f.odometry_frozen = true; }>,
     .zero_s = 3.0,
     .hands = false,
     .car = false,
     .turning = false},
    {.name = "one track's counter stuck",
     .breaks = with<[](sim::Faults& f) { f.odometry_left_stuck = true; }>,
     .zero_s = 4.0,
     .hands = false,
     .car = false,
     .turning = false},
};

inline void PrintTo(const Fault& fault, std::ostream* out) {
  *out << fault.name;
}

}  // namespace roverd::loop
