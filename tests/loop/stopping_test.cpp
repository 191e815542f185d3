// From the moment something fails to the robot standing, by its true pose: every fault in every way
// of driving, at three speeds. The limits were set before they were measured.
//
//   STOPPING_TABLE=FILE   adds the worst of each fault and speed as a table, as in docs/stopping.md

#include <cstdlib>
#include <fstream>
#include <map>

#include "stopping_faults.hpp"

namespace roverd::loop {
namespace {

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

std::unique_ptr<RigBase> rig_for(const Way& way, double speed_mps, const Fault& fault) {
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
  if (fault.to_hold) o.robot.safety.link_lost = "hold";
  o.robot.safety.link_timeout_s = 3.0;
  return std::make_unique<Rig>(o);
}

/// The heading is learned by driving some metres.
void warm_up(Ride& ride) {
  ride.tick();
  robot::GoTo ahead;
  ahead.at = ride.rig.place({0.0, 4.0});
  ASSERT_TRUE(ride.rig.ask(ahead));
  const auto there = [&] {
    return ride.rig.state()->activity.state == base::ActivityState::Reached;
  };
  for (int i = 0; i < 60 * 50 && !there(); ++i) ride.tick();
  ASSERT_TRUE(there());
  for (int i = 0; i < 50; ++i) ride.tick();
}

Measured stop(const Way& way, double speed_mps, const Fault& fault) {
  const auto rig = rig_for(way, speed_mps, fault);
  rig->arm();
  Ride ride{*rig, speed_mps, Mode::Auto};
  warm_up(ride);
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
    if (!rig->dead && rig->state()->command.twist != base::BodyTwist{}) m.zero_s = t_s;
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
    out << "| " << f.name << " | " << (f.program ? text("%.2f s", zero_s) : "") << " |";
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
      EXPECT_LE(m.zero_s, fault.zero_s + 1e-9);
      EXPECT_LE(m.way_m, limit_m(fault, way, speed_mps));
    }
  }
}

}  // namespace
}  // namespace roverd::loop
