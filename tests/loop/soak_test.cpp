// Hours of simulated time: missions drawn at random are driven one after the other, while sensors
// and the bus fail and it is stopped at random. At every tick:
//
//   it stands   3 s after it was stopped, disarmed, held or its mission ended or waits, by the true
//               pose, whatever fails
//   it is slow  enough for what the mission allows
//
// and at the end all is well again, a mission is driven to its last place, and no more memory is
// held than after the first tenth. SOAK_HOURS=8 makes it long; SOAK_SEED chooses another course.

#include <array>
#include <cstdlib>
#include <random>

#include <malloc.h>

#include "rig.hpp"

namespace roverd::loop {
namespace {

constexpr double kSpeed_mps = 0.8;
constexpr double kYard_m = 15.0;
constexpr double kStop_s =
    3.0;  ///< 1.7 s of a dead link's time-out, the rest to roll (stopping.md)
constexpr double kMinute_s = 60.0;
constexpr double kMostGrowth_kb = 2000.0;

double number_from(const char* name, double otherwise) {
  const char* asked = std::getenv(name);
  return asked != nullptr ? std::atof(asked) : otherwise;
}

/// Taken from the system and in use, whatever the allocator keeps for later.
double heap_kb() {
  const struct mallinfo2 info = ::mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd) / 1000.0;
}

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0 : values[values.size() / 2];
}

struct Trouble {
  const char* name;
  double longest_s;
  void (*breaks)(sim::Faults&);
};

const std::vector<Trouble> kTroubles = {
    {"no fix", 30.0, [](sim::Faults& f) { f.gnss_outage = true; }},
    {"receiver silent", 30.0, [](sim::Faults& f) { f.gnss_silent = true; }},
    {"jump", 8.0, [](sim::Faults& f) { f.gnss_jump_east_m = 3.0; }},
    {"drift", 20.0, [](sim::Faults& f) { f.gnss_drift_north_mps = 0.1; }},
    {"position frozen", 10.0, [](sim::Faults& f) { f.gnss_position_frozen = true; }},
    {"receiver repeats", 10.0, [](sim::Faults& f) { f.gnss_repeats = true; }},
    {"velocity frozen", 10.0, [](sim::Faults& f) { f.gnss_velocity_frozen = true; }},
    {"bus off", 10.0, [](sim::Faults& f) { f.bus_off = true; }},
    {"commands lost", 10.0, [](sim::Faults& f) { f.loss_to_base = 1.0; }},
    {"some commands lost", 20.0, [](sim::Faults& f) { f.loss_to_base = 0.5; }},
    {"frames lost", 10.0, [](sim::Faults& f) { f.loss_from_base = 1.0; }},
    {"some frames lost", 20.0, [](sim::Faults& f) { f.loss_from_base = 0.5; }},
    {"red button", 10.0, [](sim::Faults& f) { f.estop = true; }},
    {"motor fault", 5.0, [](sim::Faults& f) { f.error_bits = 1; }},
    {"odometry frozen", 10.0, [](sim::Faults& f) { f.odometry_frozen = true; }},
    {"a track's encoder stuck", 10.0, [](sim::Faults& f) { f.odometry_left_stuck = true; }},
};

class Marathon {
 public:
  explicit Marathon(unsigned seed) : rig_({.seed = seed, .plant = plant()}), chance_(seed) {}

  void run(double hours) {
    const double end_s = 3600.0 * hours;
    while (rig_.now_s() < end_s && violations.size() < 5) {
      if (due(urge_s_, 0.5, 1.0)) urge();
      if (due(trouble_s_, 10.0, 60.0)) break_or_mend();
      if (due(stop_s_, 15.0, 60.0)) stop();
      if (due(clock_s_, 300.0, 900.0)) rig_.clock_jump = base::from_seconds(between(-1e5, 1e5));
      tick();
      if (rig_.now_s() >= minute_s_) note_minute();
    }
  }

  /// All is well, and one more mission.
  bool finish() {
    mend();
    const int before = finished;
    const double limit_s = rig_.now_s() + 600.0;
    while (finished == before && rig_.now_s() < limit_s) {
      if (due(urge_s_, 0.5, 1.0)) urge();
      tick();
    }
    return finished > before;
  }

  /// From the last place of the last mission.
  double end_error_m() const { return rig_.distance_to_m(goal_); }

  std::vector<std::string> violations;
  std::vector<double> heap_kb_by_minute;
  int finished = 0;
  int troubles = 0;
  int stops = 0;
  double driven_m = 0.0;
  double longest_roll_s = 0.0;

 private:
  static sim::Params plant() {
    sim::Params p;
    p.imu.fitted = true;
    return p;
  }
  double between(double a, double b) { return std::uniform_real_distribution<>(a, b)(chance_); }
  std::size_t below(std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(chance_);
  }
  bool due(double& at_s, double shortest_s, double longest_s) {
    if (at_s <= 0.0) at_s = rig_.now_s() + between(shortest_s, longest_s);
    if (rig_.now_s() < at_s) return false;
    at_s = rig_.now_s() + between(shortest_s, longest_s);
    return true;
  }

  void tick() {
    rig_.tick();
    judge();
  }

  void say(const std::string& what) {
    violations.push_back("at " + std::to_string(rig_.now_s()) + " s: " + what + " (" + trouble_ +
                         ", mode " + std::string(to_string(rig_.state()->mode)) + ", " +
                         rig_.state()->mission.reason + ")");
  }

  void judge() {
    const auto s = rig_.state();
    const sim::Truth t = rig_.truth();
    driven_m += std::abs(t.twist.linear_mps) * base::seconds(RigBase::kTick);
    const bool may_move = s->armed && !s->estop && s->mode == Mode::Auto &&
                          s->mission.state == ExecutionState::Running;
    const bool moves =
        std::abs(t.twist.linear_mps) > 0.02 || std::abs(t.twist.angular_radps) > 0.03;
    if (may_move || !moves) {
      if (may_move) allowed_s_ = rig_.now_s();
    } else {
      const double rolls_s = rig_.now_s() - allowed_s_;
      longest_roll_s = std::max(longest_roll_s, rolls_s);
      if (rolls_s > kStop_s) {
        say("it moves " + std::to_string(rolls_s) + " s after it may not");
        allowed_s_ = rig_.now_s();  // told once
      }
    }
    if (std::abs(t.twist.linear_mps) > kSpeed_mps + 0.2) say("it is too fast");
    if (s->mission.state == ExecutionState::Finished && seen_ != ExecutionState::Finished) {
      ++finished;
    }
    seen_ = s->mission.state;
  }

  /// The answer may be a refusal: it is asked again later.
  void ask(robot::Command command) {
    (void)rig_.ask(std::move(command));
    judge();
  }

  /// One step towards driving on.
  void urge() {
    const auto s = rig_.state();
    if (!s) return;
    if (s->estop) return ask(robot::ResetEstop{});
    if (rig_.has_condition("estimate_latched")) return ask(robot::Acknowledge{});
    if (!s->armed) return ask(robot::Arm{});
    switch (s->mission.state) {
      case ExecutionState::Paused:
      case ExecutionState::Blocked:
        return ask(robot::ResumeMission{});
      case ExecutionState::Idle:
      case ExecutionState::Finished:
      case ExecutionState::Aborted:
        return load();
      case ExecutionState::Loaded:
        return ask(robot::StartMission{"m", revision_});
      case ExecutionState::Running:
        return;
    }
  }

  void load() {
    std::vector<Metres> points;
    for (std::size_t i = 0; i < 2 + below(8); ++i) {
      points.push_back({between(-kYard_m, kYard_m), between(-kYard_m, kYard_m)});
    }
    goal_ = points.back();
    auto compiled = rig_.robot.compile({"m", ++revision_, rig_.plan_of(points, kSpeed_mps)});
    if (compiled) ask(robot::LoadMission{*compiled});
  }

  void stop() {
    ++stops;
    switch (below(5)) {
      case 0:
        return ask(robot::Estop{"the soak"});
      case 1:
        return ask(robot::Disarm{});
      case 2:
        return ask(robot::SetMode{Mode::Hold});
      case 3:
        return ask(robot::PauseMission{});
      default:
        return ask(robot::StopMission{});
    }
  }

  void break_or_mend() {
    if (trouble_ != "all well") return mend();
    const Trouble& trouble = kTroubles[below(kTroubles.size())];
    ++troubles;
    trouble_ = trouble.name;
    rig_.fault(trouble.breaks);
    trouble_s_ = rig_.now_s() + between(0.5, trouble.longest_s);
  }
  void mend() {
    trouble_ = "all well";
    rig_.fault([](sim::Faults&) {});
  }

  void note_minute() {
    minute_s_ = rig_.now_s() + kMinute_s;
    rig_.track = {};  // what the rig keeps for other tests
    rig_.events = {};
    heap_kb_by_minute.push_back(heap_kb());
  }

  Rig rig_;
  std::mt19937 chance_;
  std::string trouble_ = "all well";
  double urge_s_ = 0.0;
  double trouble_s_ = 0.0;
  double stop_s_ = 0.0;
  double clock_s_ = 0.0;
  double minute_s_ = kMinute_s;
  double allowed_s_ = 0.0;  ///< when it last might move
  std::int64_t revision_ = 0;
  Metres goal_;
  ExecutionState seen_ = ExecutionState::Idle;
};

TEST(Soak, HoursOfMissionsWithFaultsAndStops) {
  const double hours = number_from("SOAK_HOURS", 0.25);
  Marathon marathon(static_cast<unsigned>(number_from("SOAK_SEED", 1)));
  marathon.heap_kb_by_minute.reserve(static_cast<std::size_t>(70 * hours) + 10);
  marathon.run(hours);
  EXPECT_TRUE(marathon.finish()) << "the last mission is not finished";
  EXPECT_LT(marathon.end_error_m(), 0.5);
  for (const std::string& v : marathon.violations) ADD_FAILURE() << v;
  EXPECT_GT(marathon.finished, 4.0 * hours);  // it drove, for all that

  const auto& heap = marathon.heap_kb_by_minute;
  const auto warm = static_cast<std::ptrdiff_t>(heap.size() / 10 + 1);
  const auto third = (static_cast<std::ptrdiff_t>(heap.size()) - warm) / 3;
  ASSERT_GT(third, 0);
  const double first_kb = median_of({heap.begin() + warm, heap.begin() + warm + third});
  const double last_kb = median_of({heap.end() - third, heap.end()});
  std::printf(
      "%.2f h simulated: %d missions, %.1f km, %d stops, %d faults; longest roll %.2f s; memory in "
      "use %.0f kB in the first third, %.0f kB in the last: %+.0f kB\n",
      hours, marathon.finished, marathon.driven_m / 1000.0, marathon.stops, marathon.troubles,
      marathon.longest_roll_s, first_kb, last_kb, last_kb - first_kb);
  EXPECT_LT(last_kb - first_kb, kMostGrowth_kb);
}

}  // namespace
}  // namespace roverd::loop
