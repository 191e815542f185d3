#pragma once
// The whole robot in one thread and simulated time: plant ⇄ real CAN frames and NMEA bytes over
// memory links ⇄ real drivers, codecs and gate ⇄ Robot::tick every 20 ms. What is asserted is
// measured against the plant's true pose, which the robot never sees.

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "bunker/driver.hpp"
#include "gnss/driver.hpp"
#include "link/memory.hpp"
#include "mti/driver.hpp"
#include "robot/robot.hpp"
#include "sim/bunker.hpp"
#include "sim/vehicle.hpp"

namespace roverd::loop {

using base::ExecutionState;
using base::Mode;
using base::Time;

/// Metres east and north of the plant's start.
struct Metres {
  double east_m = 0.0;
  double north_m = 0.0;
};

struct RigOptions {
  std::uint64_t seed = 1;
  double heading_deg = 0.0;
  sim::Params plant{};
  robot::Config robot{};
  gnss::Params gnss{};
};

/// What every vehicle's loop has in common; which plant and which drivers, the heirs say.
class RigBase {
 public:
  static constexpr base::Duration kTick = std::chrono::milliseconds(20);

  virtual ~RigBase() = default;
  RigBase(const RigBase&) = delete;
  RigBase& operator=(const RigBase&) = delete;

  // ---- time ----

  void tick() {
    now_ += kTick;
    if (dead) return live_on();
    run_devices(now_);
    robot.tick(now_, wall());
    drain();
    const sim::Truth t = plant.truth();
    track.push_back(t);
    fastest_mps = std::max(fastest_mps, std::abs(t.twist.linear_mps));
  }

  void run(double seconds) {
    const auto ticks = std::lround(seconds / base::seconds(kTick));
    for (long i = 0; i < ticks; ++i) tick();
  }

  /// @return false if `done` did not come true in time.
  template <class F>
  bool run_until(F done, double limit_s) {
    const auto ticks = std::lround(limit_s / base::seconds(kTick));
    for (long i = 0; i < ticks; ++i) {
      tick();
      if (done()) return true;
    }
    return false;
  }

  double now_s() const { return base::seconds(now_.time_since_epoch()); }

  // ---- commands; each answer comes at the next tick ----

  base::Result<void> ask(robot::Command command) {
    base::Result<void> answer = base::fail(base::Code::Unavailable, "no answer came");
    EXPECT_TRUE(robot.request(std::move(command), now_ + std::chrono::seconds(1),
                              [&answer](base::Result<void> r) { answer = std::move(r); }));
    tick();
    return answer;
  }

  void drive(double speed_mps, double yaw_rate_radps, bool deadman = true) {
    robot.request(robot::Drive{{speed_mps, yaw_rate_radps}, deadman},
                  now_ + std::chrono::milliseconds(250), {});
  }

  /// Sticks in the middle, dead-man off, until the robot has seen it.
  void let_go() {
    const auto ready = [this] {
      drive(0.0, 0.0, false);
      return state()->teleop.phase == base::TeleopPhase::Ready;
    };
    EXPECT_TRUE(run_until(ready, 3.0)) << state()->teleop.reason;
  }

  /// Waits until the checks pass, and arms.
  void arm() {
    ASSERT_TRUE(run_until([&] { return state()->ready_to_arm; }, 30.0)) << failing_checks();
    const auto armed = ask(robot::Arm{});
    ASSERT_TRUE(armed) << armed.error().detail;
  }

  void load(const mission::Plan& plan) {
    auto compiled = robot.compile({"m1", 1, plan});
    ASSERT_TRUE(compiled) << compiled.error().detail;
    const auto loaded = ask(robot::LoadMission{*compiled});
    ASSERT_TRUE(loaded) << loaded.error().detail;
  }

  void start() {
    const auto started = ask(robot::StartMission{"m1", 1});
    ASSERT_TRUE(started) << started.error().detail;
  }

  void arm_and_start(const mission::Plan& plan) {
    arm();
    load(plan);
    start();
    track.clear();
  }

  bool finish(double limit_s) {
    const bool done = run_until([&] { return execution() == ExecutionState::Finished; }, limit_s);
    run(2.0);
    return done;
  }

  // ---- what there is ----

  std::shared_ptr<const base::Snapshot> state() const { return robot.snapshot(); }
  ExecutionState execution() const { return state()->mission.state; }
  sim::Truth truth() const { return plant.truth(); }

  bool has_condition(const std::string& id) const {
    const auto& all = state()->safety;
    return std::any_of(all.begin(), all.end(), [&](const auto& c) { return c.id == id; });
  }
  bool has_event(const std::string& kind) const {
    return std::any_of(events.begin(), events.end(), [&](const auto& e) { return e.kind == kind; });
  }
  std::string failing_checks() const {
    std::string text;
    for (const auto& c : state()->checks) {
      if (!c.ok) text += c.id + ": " + c.detail + "\n";
    }
    return text;
  }

  base::LatLon place(Metres m) const { return plant.frame().to_global({m.east_m, m.north_m}); }

  mission::Plan plan_of(const std::vector<Metres>& points, double speed_mps = 0.8) const {
    mission::Plan plan;
    plan.name = "test";
    plan.settings.speed_mps = speed_mps;
    for (const Metres& m : points) {
      mission::Waypoint w;
      w.at = place(m);
      plan.items.emplace_back(w);
    }
    return plan;
  }

  /// Nearest the true robot ever came to a place.
  double nearest_m(Metres m) const {
    double best = std::numeric_limits<double>::infinity();
    for (const auto& t : track) {
      best = std::min(best, std::hypot(t.local.east_m - m.east_m, t.local.north_m - m.north_m));
    }
    return best;
  }

  /// Farthest the true robot ever was from the line a–b (infinite).
  double farthest_from_line_m(Metres a, Metres b) const {
    const double length = std::hypot(b.east_m - a.east_m, b.north_m - a.north_m);
    double worst = 0.0;
    for (const auto& t : track) {
      const double cross = (b.east_m - a.east_m) * (t.local.north_m - a.north_m) -
                           (b.north_m - a.north_m) * (t.local.east_m - a.east_m);
      worst = std::max(worst, std::abs(cross / length));
    }
    return worst;
  }

  double distance_to_m(Metres m) const {
    const auto t = plant.truth();
    return std::hypot(t.local.east_m - m.east_m, t.local.north_m - m.north_m);
  }

  /// Farthest from the polyline through `points`.
  double farthest_from_path_m(const std::vector<Metres>& points) const {
    double worst = 0.0;
    for (const auto& t : track) {
      double best = 1e9;
      for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        best = std::min(best, to_segment(t.local, points[i], points[i + 1]));
      }
      worst = std::max(worst, best);
    }
    return worst;
  }

  /// The estimate was set anew so far that it holds. A person looks, and lets it go on.
  bool holds_until_a_person_looked(double within_s) {
    if (!run_until([&] { return has_condition("estimate_latched"); }, within_s)) return false;
    run(3.0);
    if (!stands() || execution() != ExecutionState::Paused) return false;
    if (ask(robot::ResumeMission{})) return false;
    return ask(robot::Acknowledge{}) && ask(robot::ResumeMission{});
  }

  /// From a place to the line between two others.
  static double to_segment(base::EnuPoint p, Metres a, Metres b) {
    const double e = b.east_m - a.east_m;
    const double n = b.north_m - a.north_m;
    const double square = std::max(1e-9, e * e + n * n);
    const double t =
        std::clamp(((p.east_m - a.east_m) * e + (p.north_m - a.north_m) * n) / square, 0.0, 1.0);
    return std::hypot(p.east_m - a.east_m - t * e, p.north_m - a.north_m - t * n);
  }

  double yaw_error_deg() const {
    const auto s = state();
    return s->pose
               ? base::deg_from_rad(base::angle_diff_rad(plant.truth().yaw_rad, s->pose->yaw_rad))
               : 180.0;
  }

  double position_error_m() const {
    const auto s = state();
    return s->pose ? base::distance_bearing(s->pose->global, plant.truth().at).distance_m : 1e9;
  }

  bool stands() const {
    const auto t = plant.truth();
    return std::abs(t.twist.linear_mps) < 0.01 && std::abs(t.twist.angular_radps) < 0.01;
  }

  /// All faults off, then what `change` switches on.
  template <class F>
  void fault(F change) {
    sim::Faults f;
    change(f);
    ASSERT_TRUE(plant.set_faults(f));
  }

 protected:
  RigBase(std::unique_ptr<sim::Vehicle> vehicle, const robot::Config& config,
          const gnss::Params& receiver = {})
      : owned_(std::move(vehicle)),
        plant(*owned_),
        robot(config),
        bytes_(link::memory_byte_pair()),
        gnss_(
            "gnss", receiver,
            [this] { return base::Result<std::unique_ptr<link::ByteLink>>(std::move(bytes_.a)); },
            [this](const base::Measurement& m) { robot.measurements().put(m); }),
        imu_bytes_(link::memory_byte_pair()) {
    bytes_.b->set_immediate([this] { return at_; });
    EXPECT_TRUE(bytes_.b->open());
    plant.on_gnss = [this](base::Bytes b, Time t) {
      at_ = t;
      bytes_.b->write(b);
    };
    gnss_.start(at_);
    if (plant.params().imu.fitted) fit_imu();
  }

  /// Plant and drivers up to `now`.
  virtual void run_devices(Time now) = 0;

  static sim::Start start_of(double heading_deg) {
    sim::Start s;
    s.heading_deg = heading_deg;
    s.wall = base::WallTime{std::chrono::seconds(1'780'000'000)};
    return s;
  }

 private:
  std::unique_ptr<sim::Vehicle> owned_;

 public:
  sim::Vehicle& plant;
  robot::Robot robot;
  std::vector<sim::Truth> track;
  std::vector<base::Event> events;
  double fastest_mps = 0.0;
  /// The program has been killed: what remains is the vehicle.
  bool dead = false;
  /// What somebody did to the robot computer's clock; nothing but shown times may change.
  base::Duration clock_jump{};

 private:
  void live_on() {
    plant.advance_to(now_);
    track.push_back(plant.truth());
  }

  void fit_imu() {
    imu_bytes_.b->set_immediate([this] { return at_; });
    imu_bytes_.b->on_bytes = [this](base::Bytes b, Time) { plant.receive_imu(b); };
    EXPECT_TRUE(imu_bytes_.b->open());
    plant.on_imu = [this](base::Bytes b, Time t) {
      at_ = t;
      imu_bytes_.b->write(b);
    };
    mti_.emplace(
        "mti", mti::Params{},
        [this] { return base::Result<std::unique_ptr<link::ByteLink>>(std::move(imu_bytes_.a)); },
        [this](const base::Measurement& m) { robot.measurements().put(m); });
    mti_->start(at_);
  }

  base::WallTime wall() const {
    return base::WallTime{std::chrono::seconds(1'780'000'000)} + now_.time_since_epoch() +
           clock_jump;
  }

  void drain() {
    std::vector<robot::PendingReply> replies;
    robot.replies().take(replies);
    for (auto& r : replies) {
      if (r.reply) r.reply(std::move(r.result));
    }
    robot.events().take(events);
  }

  Time now_{};

 protected:
  Time at_{};  ///< finer than now_: when a frame leaves within a tick
  link::MemoryBytePair bytes_;
  gnss::Driver gnss_;
  link::MemoryBytePair imu_bytes_;
  std::optional<mti::Driver> mti_;  ///< where the plant has an inertial unit
};

/// The Bunker.
class Rig final : public RigBase {
 public:
  explicit Rig(const RigOptions& o)
      : RigBase(std::make_unique<sim::Bunker>(o.plant, o.seed, start_of(o.heading_deg)), o.robot,
                o.gnss),
        base_(static_cast<sim::Bunker&>(plant)),
        can_(link::memory_frame_pair()),
        bunker_(
            "bunker", {},
            [this] { return base::Result<std::unique_ptr<link::FrameLink>>(std::move(can_.a)); },
            [this](const base::Measurement& m) { robot.measurements().put(m); }) {
    can_.a->set_immediate([this] { return at_; });
    can_.b->set_immediate([this] { return at_; });
    can_.b->on_frame = [this](const base::CanFrame& f, Time) { base_.receive(f); };
    EXPECT_TRUE(can_.b->open());
    base_.on_frame = [this](const base::CanFrame& f, Time t) {
      at_ = t;
      can_.b->send(f);
    };
    robot.send = [this](const base::DriveCommand& c, Time t) { bunker_.send(c, t); };
    bunker_.start(at_);
  }

  /// Somebody else on the bus sends this.
  void put_on_bus(const base::CanFrame& f) { can_.b->send(f); }

 private:
  void run_devices(Time now) override {
    plant.advance_to(now);
    at_ = now;
    bunker_.tick(now);
    gnss_.tick(now);
    if (mti_) mti_->tick(now);
  }

  sim::Bunker& base_;
  link::MemoryFramePair can_;
  bunker::Driver bunker_;
};

}  // namespace roverd::loop
