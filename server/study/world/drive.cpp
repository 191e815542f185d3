// One drive through one world: the robot on its mission, or somebody drunk at the sticks.

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <mutex>
#include <numbers>
#include <optional>
#include <thread>
#include <utility>

#include "base/angle.hpp"
#include "config/lookout.hpp"
#include "robot/compile.hpp"
#include "robot/guard/around.hpp"
#include "robot/guard/lookout.hpp"
#include "robot/guard/surroundings.hpp"
#include "sim/config.hpp"
#include "sim/surroundings.hpp"
#include "sim/world/draw.hpp"
#include "study/stage.hpp"
#include "study/world/eyes.hpp"
#include "study/world/passable.hpp"
#include "study/world/referee.hpp"

namespace roverd::study {
namespace {

using base::Result;

constexpr base::LatLon kWorldPlace{58.378020, 26.728900};
constexpr double kReadyWithin_s = 60.0;
constexpr double kGivesUp_s = 6.0;  // AUTO that stands so long before what does not move is done
constexpr double kAway_m = 18.0;    // somebody drunk turns back here
constexpr double kStuck_s = 30.0;   // and that shall have driven around it
constexpr double kRoom_m = 0.3;     // of a way around that there is
constexpr std::uint64_t kLate = 16;
constexpr int kWordEvery_ticks = 25;
constexpr int kHeardPerTick = 2;
const base::WallTime kWorldWall{std::chrono::seconds(1'780'000'000)};

/// Arcs, reversals, turns on the spot, and straight at whatever stands nearest.
class Drunk {
 public:
  Drunk(std::uint64_t number, double speed_mps) : draw_(number, 99), speed_mps_(speed_mps) {}

  base::BodyTwist wants(double now_s, const sim::world::Pose& pose,
                        const std::optional<double>& nearest_rad) {
    if (now_s >= until_s_) choose(now_s);
    double bearing_rad = nearest_rad.value_or(0.0);
    const double away_m = std::hypot(pose.x_m, pose.y_m);
    if (away_m > kAway_m) {
      bearing_rad = base::angle_diff_rad(pose.yaw_rad, std::atan2(-pose.y_m, -pose.x_m));
    }
    if (charges_ || away_m > kAway_m) {
      const double off_rad =
          back_ && away_m <= kAway_m ? base::wrap_rad(bearing_rad + std::numbers::pi) : bearing_rad;
      const double sign = back_ && away_m <= kAway_m ? -1.0 : 1.0;
      const double turn = std::clamp(1.5 * off_rad, -0.75, 0.75);
      return {std::abs(off_rad) > 0.8 ? 0.15 * sign * speed_mps_ : sign * speed_mps_, turn};
    }
    return twist_;
  }

 private:
  void choose(double now_s) {
    until_s_ = now_s + draw_.uniform(0.8, 4.0);
    const double what = draw_.uniform();
    charges_ = what < 0.4;
    back_ = draw_.uniform() < 0.35;
    const double sign = back_ ? -1.0 : 1.0;
    twist_ = {sign * speed_mps_ * draw_.uniform(0.4, 1.0), draw_.uniform(-0.7, 0.7)};
    if (what > 0.75) twist_.linear_mps = 0.0;
    if (what > 0.4 && what < 0.5) twist_.angular_radps = 0.0;
  }

  sim::world::Draw draw_;
  double speed_mps_;
  double until_s_ = 0.0;
  bool charges_ = false;
  bool back_ = false;
  base::BodyTwist twist_;
};

struct Made {
  Settings settings;
  sim::Params plant;
  std::vector<EyeSetup> eyes;
  mission::Plan plan;
  sim::Start start;
};

Result<Made> make(const Setup& setup, const Scenario& s) {
  Made out;
  // What the study asks for is allowed; what somebody sets comes later and wins.
  std::vector<std::string> overrides{"nav.speed.max_mps=1.3", "nav.speed.reverse_max_mps=1.3",
                                     "robot.manual.max_mps=1.3"};
  if (s.lidar) {
    // Beside and behind it a lidar's lowest beams are too high.
    overrides.emplace_back("sense.protect.creep_turn_radps=0.3");
    overrides.emplace_back("sense.protect.creep_back_mps=0.25");
  }
  if (s.around_late_s) {
    overrides.emplace_back("sense.blocked.then=around");
    overrides.emplace_back("sense.blocked.after_s=1");
  }
  overrides.insert(overrides.end(), setup.overrides.begin(), setup.overrides.end());
  auto settings = load_settings({setup.config, setup.vehicle, overrides});
  if (!settings) return tl::unexpected(settings.error());
  out.settings = std::move(*settings);
  sim::Config plant;
  const auto file = setup.config.parent_path() / "sim" / (out.settings.vehicle.name + ".toml");
  if (auto good = sim::read_config_file(plant, file.string()); !good) {
    return tl::unexpected(good.error());
  }
  for (const auto& text : setup.sim_overrides) {
    if (auto good = sim::apply_override(plant, text); !good) return tl::unexpected(good.error());
  }
  out.plant = plant.params;
  out.eyes = usual_eyes(out.plant.body, s.lidar);
  out.settings.sensors.clear();
  for (const EyeSetup& eye : out.eyes) out.settings.sensors[eye.seen.name] = eye.said;
  out.plan = s.plan ? *s.plan : plan_of(s.course, base::LocalFrame(1, kWorldPlace), s.number);
  out.start.at = kWorldPlace;
  out.start.wall = kWorldWall;
  const base::EnuPoint first = s.course.points[1] - s.course.points[0];
  const double along_deg = base::heading_from_yaw(std::atan2(first.north_m, first.east_m));
  const double turned = s.course.reverse && !s.sticks ? 180.0 : 0.0;
  out.start.heading_deg = std::fmod(s.course.start_heading_deg.value_or(along_deg + turned), 360.0);
  return out;
}

class WorldDrive {
 public:
  WorldDrive(const Scenario& s, Made& made, robot::Lookout lookout)
      : s_(s),
        made_(made),
        stage_(made.settings, made.plant, s.number, made.start),
        around_(s.world, made.plant.body, base::Time{}),
        referee_(around_, made.settings.robot.protect, made.settings.sense.ground,
                 s.lidar ? 0.0 : made.eyes.front().seen.z_m),
        lookout_(std::move(lookout)) {
    around_.attend(stage_.plant());
    stage_.robot().guard_by(made.settings.robot.protect, true, made.settings.robot.blocked,
                            made.settings.sense.outline, made.settings.robot.rays);
    for (const EyeSetup& eye : made.eyes) eyes_.emplace_back(eye, s.number);
    stage_.on_heard = [this](base::Time t) { sense(t); };
  }

  WorldRun run() {
    WorldRun out;
    out.scenario = s_;
    if (auto ready = become_ready(); !ready) {
      out.problem = ready.error().detail;
      return out;
    }
    referee_.begin();
    began_s_ = stage_.now_s();
    if (s_.sticks) {
      by_hand();
    } else {
      by_itself(out);
    }
    referee_.report(out);
    out.detours = detours_;
    if (s_.around_late_s && !made_.settings.robot.vehicle.steered()) {
      const Passage passage{s_.course.points.front(), s_.course.points.back(),
                            made_.settings.robot.behave.lost_m, kRoom_m};
      out.way = passable(around_.scene(), around_.witness().body(), passage);
    }
    return out;
  }

 private:
  double driven_s() const { return stage_.now_s() - began_s_; }

  /// The sense thread's work, in simulated time.
  void sense(base::Time t) {
    moved_.clear();
    stage_.robot().odometry().take(moved_);
    rows_.clear();
    stage_.robot().row_questions().take(rows_);
    if (!rows_.empty()) lookout_.look_for(rows_.back());
    lookout_.follow(stage_.robot().config()->wall, stage_.robot().config()->landmarks);
    for (const auto& o : moved_) lookout_.moved(o);
    done_.clear();
    stage_.robot().surroundings_done().take(done_);
    static const sim::world::SensorFaults kClear;
    const bool struck = began_s_ > 0.0 && driven_s() >= s_.fault_after_s;
    const auto& faults = struck ? s_.faults : kClear;
    for (std::size_t i = 0; i < eyes_.size(); ++i) {
      const auto& p = made_.eyes[i].seen;
      const sim::world::Pose mount{p.x_m, p.y_m, p.z_m, 0.0, 0.0, base::rad_from_deg(p.yaw_deg)};
      eyes_[i].advance(around_, faults, [&](const WorldEye::Told& told) {
        referee_.saw(told.sweeps, mount, around_.now_s());
        lookout_.see(told.sight, t);
      });
    }
    // Of two between the same ticks the robot would take the later one only.
    if (heard_++ % kHeardPerTick == kHeardPerTick - 1) {
      if (auto picture = lookout_.picture(t)) stage_.robot().surroundings().put(std::move(picture));
    }
    answer();
    referee_.look();
  }

  /// The around thread's work: on a busy machine it takes its time.
  void answer() {
    asked_.clear();
    stage_.robot().around_questions().take(asked_);
    if (!asked_.empty()) {
      if (!planner_) planner_ = std::make_unique<nav::around::Planner>();
      answer_ = robot::answer_around(*planner_, asked_.back());
      answer_at_s_ = stage_.now_s() + late_.uniform(0.0, s_.around_late_s.value_or(0.0));
    }
    if (!answer_ || stage_.now_s() < answer_at_s_) return;
    stage_.robot().around_answers().put(std::exchange(answer_, nullptr));
  }

  void tick() {
    if (ticks_++ % kWordEvery_ticks == 0) {
      const base::Time now{base::from_seconds(stage_.now_s())};
      stage_.robot().measurements().put(base::OperatorLink{now, 1});
    }
    stage_.tick();
    const auto shown = stage_.robot().snapshot();
    referee_.heed(shown->obstacle);
    const bool around = shown->detour != nullptr;
    if (around && !goes_around_) ++detours_;
    goes_around_ = around;
  }

  Result<void> become_ready() {
    tick();
    while (!stage_.robot().snapshot()->ready_to_arm && stage_.now_s() < kReadyWithin_s) tick();
    return stage_.ask(robot::Arm{});
  }

  void by_itself(WorldRun& out) {
    auto compiled = stage_.robot().compile({"world", 1, made_.plan});
    if (!compiled) {
      out.problem = compiled.error().detail;
      return;
    }
    if (auto loaded = stage_.ask(robot::LoadMission{*compiled}); !loaded) {
      out.problem = loaded.error().detail;
      return;
    }
    if (auto started = stage_.ask(robot::StartMission{"world", 1}); !started) {
      out.problem = started.error().detail;
      return;
    }
    const bool waits = s_.kind == "moving" || s_.kind == "crossing" || s_.kind == "turning";
    while (driven_s() < s_.time_s) {
      tick();
      const auto state = stage_.robot().snapshot()->mission.state;
      out.finished = state == base::ExecutionState::Finished;
      if (state != base::ExecutionState::Running && state != base::ExecutionState::Paused) break;
      const double most_s = s_.around_late_s ? kStuck_s : kGivesUp_s;
      if (referee_.stands_s() > most_s && driven_s() > 2.0 * most_s && !waits) break;
    }
  }

  void by_hand() {
    (void)stage_.ask(robot::SetMode{base::Mode::Manual});
    Drunk drunk(s_.number, s_.speed_mps);
    constexpr int kLetGo_ticks = 15;
    for (int i = 0; driven_s() < s_.time_s; ++i) {
      if (i % 3 == 0) {
        robot::Drive drive;
        drive.deadman = i >= kLetGo_ticks;
        if (drive.deadman) {
          drive.twist =
              drunk.wants(stage_.now_s(), around_.pose_at(around_.now_s()), referee_.nearest_rad());
        }
        const base::Time until{base::from_seconds(stage_.now_s() + 0.25)};
        stage_.robot().request(drive, until, {});
      }
      tick();
    }
  }

  const Scenario& s_;
  Made& made_;
  Stage stage_;
  sim::Surroundings around_;
  Referee referee_;
  robot::Lookout lookout_;
  std::vector<WorldEye> eyes_;
  std::vector<robot::RowQuestion> rows_;
  std::vector<nav::sense::Odometry> moved_;
  std::vector<std::shared_ptr<const robot::Surroundings>> done_;
  std::vector<std::shared_ptr<const robot::AroundQuestion>> asked_;
  std::unique_ptr<nav::around::Planner> planner_;
  std::shared_ptr<const robot::AroundAnswer> answer_;
  double answer_at_s_ = 0.0;
  sim::world::Draw late_{s_.number, kLate};
  std::size_t detours_ = 0;
  bool goes_around_ = false;
  double began_s_ = 0.0;
  int ticks_ = 0;
  int heard_ = 0;
};

}  // namespace

std::string_view to_string(Blame blame) noexcept {
  switch (blame) {
    case Blame::Ours:
      return "ours";
    case Blame::Late:
      return "late";
    case Blame::Beside:
      return "beside";
    case Blame::Unseen:
      return "unseen";
    case Blame::Standing:
      return "standing";
  }
  return "ours";
}

Result<WorldRun> run_world(const Setup& setup, const Scenario& scenario) {
  auto made = make(setup, scenario);
  if (!made) return tl::unexpected(made.error());
  auto lookout = lookout_of(made->settings, base::Time{});
  if (!lookout) return tl::unexpected(lookout.error());
  const auto drive = std::make_unique<WorldDrive>(scenario, *made, std::move(*lookout));
  return drive->run();
}

Result<std::vector<WorldRun>> run_worlds(const Setup& setup, const std::vector<Scenario>& scenarios,
                                         int jobs, const std::function<void(std::size_t)>& told) {
  std::vector<WorldRun> runs(scenarios.size());
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::size_t done = 0;
  std::optional<base::Error> error;
  const auto work = [&] {
    for (std::size_t i = next++; i < scenarios.size(); i = next++) {
      auto run = run_world(setup, scenarios[i]);
      const std::lock_guard lock(mutex);
      if (!run) {
        if (!error) error = run.error();
        next = scenarios.size();
        return;
      }
      runs[i] = std::move(*run);
      if (told) told(++done);
    }
  };
  {
    std::vector<std::jthread> threads;
    const std::size_t most = std::min(static_cast<std::size_t>(jobs), scenarios.size());
    for (std::size_t i = 0; i < most; ++i) threads.emplace_back(work);
  }
  if (error) return tl::unexpected(*error);
  return runs;
}

}  // namespace roverd::study
