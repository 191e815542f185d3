// From the moment something fails to the robot standing, by its true pose: every fault in every way
// of driving, at three speeds. The limits were set before they were measured.
//
//   STOPPING_TABLE=FILE   adds the worst of each fault and speed as a table, as in docs/stopping.md

#include <cstdlib>
#include <fstream>
#include <map>

#include "vehicle_rig.hpp"

namespace roverd::loop {
namespace {

/// By hand it is pushed at all times; a target walks ahead at all times.
struct Ride {
  RigBase& rig;
  double speed_mps;
  Mode mode;
  bool pushes = false;
  double turn_radps = 0.0;
  bool follows = false;
  bool speaks = true;
  double ahead_m = 0.0;

  void tick() {
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

void by_stick(Ride& r, Mode mode, double turn_radps = 0.0) {
  r.mode = mode;
  ASSERT_TRUE(r.rig.ask(robot::SetMode{mode}));
  r.rig.let_go();
  r.pushes = true;
  r.turn_radps = turn_radps;
}

robot::GoTo north(Ride& r, double metres) {
  robot::GoTo g;
  g.at = r.rig.place({0.0, metres});
  g.speed_mps = r.speed_mps;
  return g;
}

const std::vector<Way> kWays = {
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
};

template <void (*Change)(sim::Faults&)>
void with(Ride& r) {
  r.rig.fault(Change);
}

void turn_switch(Ride& r) {
  sim::Radio radio;
  radio.swb = base::Switch::Middle;
  r.rig.plant.set_radio(radio);
}

void let_go(Ride& r) {
  r.speaks = false;
  r.rig.drive(0.0, 0.0, false);
}

void meddle(Ride& r) {
  dynamic_cast<Rig&>(r.rig).put_on_bus(bunker::encode(bunker::MotionCommand{{.linear_mps = 0.3}}));
}

constexpr double kTick_s = 0.04;  // the command is taken by the next tick, and seen after it

const std::vector<Fault> kFaults = {
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
     .zero_s = 1.8,
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
};

struct Measured {
  double zero_s = 0.0;
  double stands_s = 0.0;
  double way_m = 0.0;
  double turned_deg = 0.0;
};

/// What braking and its delay take, of a robot of 150 kg on a slope: beside the fault's own time.
double limit_m(const Fault& f, const Way& w, double speed_mps) {
  const double v = std::abs(speed_mps);
  const double brake_mps2 = std::string(w.vehicle).empty() ? 1.5 : 2.0;
  return v * (f.brakes_s + 0.35) + v * v / (2.0 * brake_mps2) + 0.05 + f.more_m;
}

std::unique_ptr<RigBase> rig_for(const Way& way, double speed_mps) {
  if (!std::string(way.vehicle).empty()) {
    return std::make_unique<CartRig>(
        CartOptions{.vehicle = way.vehicle,
                    .seed = 1,
                    .change_plant = [](sim::Params& p) { p.drive.max_linear_mps = 3.5; },
                    .change_settings =
                        [](Settings& s) {
                          s.robot.vehicle.max_speed_mps = 3.2;
                          s.ackermann.params.max_speed_mps = 3.3;
                          s.robot.speed.max_mps = 3.0;
                          s.robot.speed.default_mps = 3.0;
                        }});
  }
  RigOptions o;
  o.robot.speed.max_mps = way.by_hand ? 1.4 : std::max(0.3, std::abs(speed_mps));
  o.robot.speed.default_mps = std::max(0.2, std::abs(speed_mps));
  o.robot.manual.max_mps = 1.4;
  o.robot.safety.gnss_free_m = 5.0;
  return std::make_unique<Rig>(o);
}

/// The heading is learned by driving some metres.
void warm_up(RigBase& rig) {
  robot::GoTo ahead;
  ahead.at = rig.place({0.0, 4.0});
  ASSERT_TRUE(rig.ask(ahead));
  ASSERT_TRUE(rig.run_until(
      [&] { return rig.state()->activity.state == base::ActivityState::Reached; }, 60.0));
  rig.run(1.0);
}

Measured stop(const Way& way, double speed_mps, const Fault& fault) {
  const auto rig = rig_for(way, speed_mps);
  rig->arm();
  Ride ride{*rig, speed_mps, Mode::Auto};
  warm_up(*rig);
  way.begin(ride);
  const double wanted = ride.turn_radps != 0.0 ? 0.6 * ride.turn_radps : 0.9 * std::abs(speed_mps);
  bool moves = false;
  for (int i = 0; i < 50 * 60 && !moves; ++i) {
    ride.tick();
    moves = ride.pace() >= wanted && i > 50 * 2;
  }
  EXPECT_TRUE(moves) << "it does not get going: " << ride.pace() << " "
                     << rig->state()->speed_reason << " " << rig->state()->activity.reason
                     << rig->state()->mission.reason;
  if (!moves) return {};

  Measured m;
  const double began_s = rig->now_s();
  const double began_m = rig->truth().driven_m;
  double yaw_rad = rig->truth().yaw_rad;
  fault.breaks(ride);
  for (int i = 0; i < 50 * (fault.zero_s > 5.0 ? 60 : 6); ++i) {
    ride.tick();
    const double t_s = rig->now_s() - began_s;
    const auto twist = rig->truth().twist;
    m.turned_deg +=
        std::abs(base::deg_from_rad(base::angle_diff_rad(yaw_rad, rig->truth().yaw_rad)));
    yaw_rad = rig->truth().yaw_rad;
    if (rig->state()->command.twist != base::BodyTwist{}) m.zero_s = t_s;
    if (std::abs(twist.linear_mps) > 0.01 || std::abs(twist.angular_radps) > 0.01) m.stands_s = t_s;
  }
  m.way_m = rig->truth().driven_m - began_m;
  EXPECT_TRUE(rig->stands());
  return m;
}

class Stopping : public testing::TestWithParam<Fault> {};
INSTANTIATE_TEST_SUITE_P(Loop, Stopping, testing::ValuesIn(kFaults), [](const auto& fault) {
  std::string name = fault.param.name;
  std::replace_if(
      name.begin(), name.end(),
      [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name;
});

void PrintTo(const Fault& fault, std::ostream* out) {
  *out << fault.name;
}

/// The worst of every fault and speed, over all ways of driving.
class Table : public testing::Environment {
 public:
  void take(const Fault& f, const Way& w, double speed_mps, const Measured& m) {
    const bool car = !std::string(w.vehicle).empty();
    ++tried_;
    Measured& worst = worst_[f.name][{car, std::abs(speed_mps)}];
    worst.zero_s = std::max(worst.zero_s, m.zero_s);
    worst.stands_s = std::max(worst.stands_s, m.stands_s);
    worst.way_m = std::max(worst.way_m, m.way_m);
  }
  void TearDown() override {
    const char* file = std::getenv("STOPPING_TABLE");
    if (file == nullptr) return;
    std::ofstream out(file, std::ios::app);
    out << "| what fails | command is zero after | 0.5 m/s | 1.0 m/s | 1.3 m/s | car, 1.5 m/s | "
           "car, 3 m/s |\n"
           "|---|---|---|---|---|---|---|\n";
    for (const Fault& f : kFaults) row(out, f);
    out << "\n" << tried_ << " stops.\n";
  }

 private:
  void row(std::ostream& out, const Fault& f) {
    auto& of = worst_[f.name];
    double zero_s = 0.0;
    for (const auto& [at, m] : of) zero_s = std::max(zero_s, m.zero_s);
    out << "| " << f.name << " | " << text("%.2f s", zero_s) << " |";
    for (const auto& at :
         {std::pair{false, 0.5}, {false, 1.0}, {false, 1.3}, {true, 1.5}, {true, 3.0}}) {
      if (!of.contains(at)) {
        out << " |";
        continue;
      }
      out << text(" %.2f m, ", of[at].way_m) << text("%.1f s |", of[at].stands_s);
    }
    out << "\n";
  }
  static std::string text(const char* format, double value) {
    char line[40];
    std::snprintf(line, sizeof line, format, value);
    return line;
  }

  int tried_ = 0;
  std::map<std::string, std::map<std::pair<bool, double>, Measured>> worst_;
};

Table* const table = dynamic_cast<Table*>(testing::AddGlobalTestEnvironment(new Table));

TEST_P(Stopping, StandsWithinItsLimitsInEveryWayOfDriving) {
  const Fault& fault = GetParam();
  for (const Way& way : kWays) {
    const bool car = !std::string(way.vehicle).empty();
    const bool turns = std::string(way.name).find("turning") != std::string::npos;
    if (turns && !fault.turning) continue;
    if ((way.by_hand ? !fault.hands : !fault.alone) || (car && !fault.car)) continue;
    for (const double speed_mps : way.speeds) {
      SCOPED_TRACE(std::string(way.name) + " at " + std::to_string(speed_mps));
      const Measured m = stop(way, speed_mps, fault);
      table->take(fault, way, speed_mps, m);
      EXPECT_LE(m.zero_s, fault.zero_s);
      EXPECT_LE(m.way_m, limit_m(fault, way, speed_mps));
    }
  }
}

}  // namespace
}  // namespace roverd::loop
