// One control tick: measurements of a full bus and a receiver in, estimate, mode, mission of 1,000
// and of 10,000 items, command and snapshot out. Reports the median and the 99th percentile of
// single ticks; for loading a mission those of the ticks that take it. The same with what sensors
// see: a scanner's picture in each tick, a lidar's in each fifth besides, and the guard.

#include <algorithm>
#include <memory>

#include <benchmark/benchmark.h>

#include "robot/guard/surroundings.hpp"
#include "tick_field.hpp"

namespace roverd::robot {
namespace {

/// Times ticks and tells their percentiles.
class Watch {
 public:
  explicit Watch(benchmark::State& state) : state_(state) { us_.reserve(1u << 20); }
  ~Watch() {
    if (us_.empty()) return;
    state_.counters["p50_us"] = at(0.50);
    state_.counters["p99_us"] = at(0.99);
    state_.counters["p99.9_us"] = at(0.999);
  }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  void tick(Field& field) {
    field.sense();
    const auto begin = std::chrono::steady_clock::now();
    field.tick();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    field.drain();
    state_.SetIterationTime(took.count());
    us_.push_back(took.count() * 1e6);
  }

 private:
  double at(double part) {
    const auto k = static_cast<std::size_t>(part * static_cast<double>(us_.size() - 1));
    std::nth_element(us_.begin(), us_.begin() + static_cast<std::ptrdiff_t>(k), us_.end());
    return us_[k];
  }

  benchmark::State& state_;
  std::vector<double> us_;
};

void one_tick(benchmark::State& state) {
  Field field;
  if (!field.start(static_cast<int>(state.range(0)))) {
    state.SkipWithError("the mission did not start");
    return;
  }
  Watch watch(state);
  for (auto _ : state) watch.tick(field);
  if (field.robot.snapshot()->mission.state != base::ExecutionState::Running) {
    state.SkipWithError("the mission stopped on the way");
  }
}
BENCHMARK(one_tick)->Arg(10)->Arg(1'000)->Arg(10'000)->UseManualTime()->MinTime(1.0);

/// What the sense thread tells: seen all around, and poles on both sides of a lane, 1 m apart, but
/// where it turns.
class Seen {
 public:
  explicit Seen(Field& field) : field_(field) {
    base::SensorState state;
    state.name = "front";
    state.health = base::SensorHealth::Good;
    sensors_.assign(2, state);
    sensors_[1].name = "top";
  }

  void tell() {
    field_.robot.odometry().take(moved_);
    if (!moved_.empty()) pose_ = moved_.back().pose;
    moved_.clear();
    field_.robot.surroundings_done().take(done_);
    done_.clear();
    put();
    if (++count_ % 5 == 0) put();
  }

 private:
  static constexpr std::int32_t kSide = 280;

  static void pole(nav::sense::Patch& patch, const nav::sense::Pose2& at) {
    const auto x = static_cast<std::int32_t>(std::floor(at.x_m / patch.cell_m)) - patch.x0;
    const auto y = static_cast<std::int32_t>(std::floor(at.y_m / patch.cell_m)) - patch.y0;
    patch.cells[static_cast<std::size_t>(y * kSide + x)].known = nav::sense::Known::Occupied;
  }

  void put() {
    auto s = std::make_shared<Surroundings>();
    s->seen = s->patch.stamp = field_.now;
    s->patch.side = kSide;
    s->patch.x0 = static_cast<std::int32_t>(std::floor(pose_.x_m / s->patch.cell_m)) - kSide / 2;
    s->patch.y0 = static_cast<std::int32_t>(std::floor(pose_.y_m / s->patch.cell_m)) - kSide / 2;
    s->patch.cells.assign(std::size_t{kSide} * kSide, {nav::sense::Known::Free, 0, 0});
    const bool on_lane = pose_.x_m > 6.0 && pose_.x_m < 24.0;
    for (int i = -6; on_lane && i <= 6; ++i) {
      for (const double left_m : {-0.75, 0.75})
        pole(s->patch, pose_ * nav::sense::Pose2{1.0 * i, left_m, 0.0});
    }
    s->marks.mark(s->patch);
    for (auto& one : sensors_) one.seen = field_.now;
    s->sensors = std::make_shared<const std::vector<base::SensorState>>(sensors_);
    field_.robot.surroundings().put(std::move(s));
  }

  Field& field_;
  nav::sense::Pose2 pose_;
  std::uint64_t count_ = 0;
  std::vector<base::SensorState> sensors_;
  std::vector<nav::sense::Odometry> moved_;
  std::vector<std::shared_ptr<const Surroundings>> done_;
};

void tick_that_sees(benchmark::State& state) {
  Field field;
  field.robot.guard_by({});
  Seen seen(field);
  field.more = [&seen] { seen.tell(); };
  if (!field.start(static_cast<int>(state.range(0)))) {
    state.SkipWithError("the mission did not start");
    return;
  }
  Watch watch(state);
  std::uint64_t ticks = 0;
  std::uint64_t standing = 0;
  for (auto _ : state) {
    watch.tick(field);
    ++ticks;
    const auto& obstacle = field.robot.snapshot()->obstacle;
    standing += obstacle && obstacle->action == base::GuardAction::Stop ? 1u : 0u;
  }
  if (10 * standing > ticks) state.SkipWithError("it stands, and has nothing to sweep");
  if (field.robot.snapshot()->mission.state != base::ExecutionState::Running) {
    state.SkipWithError("the mission stopped on the way");
  }
}
BENCHMARK(tick_that_sees)->Arg(1'000)->Arg(10'000)->UseManualTime()->Iterations(5'000);

/// What the mode needs before it can begin, then the mode.
bool enter(Field& field, base::Mode mode) {
  SetMode wanted{mode};
  const base::EnuPoint here = field.at();
  if (mode == base::Mode::Rtl) {
    field.ask(SetHome{kFrame.to_global({here.east_m > 0.0 ? -300.0 : 300.0, 40.0})});
  }
  if (mode == base::Mode::SmartRtl) {
    field.ask(StartMission{"m", 1});
    field.run(10'000);
  }
  if (mode == base::Mode::Dock) {
    wanted.goal.emplace();
    wanted.goal->at = kFrame.to_global({here.east_m > 0.0 ? -40.0 : 40.0, 5.0});
    wanted.goal->yaw_rad = 0.3;
  }
  return field.ask(wanted);
}

/// 5 times a second: the target of FOLLOW walks on a circle, GUIDED gets a new heading, the sticks
/// are held.
void stimulate(Field& field, base::Mode mode, int tick) {
  const double turn = 0.01 * tick / 10.0;
  const auto soon = field.now + std::chrono::milliseconds(250);
  if (mode == base::Mode::Follow) {
    SetTarget target;
    target.at = kFrame.to_global({25.0 * std::cos(turn), 25.0 * std::sin(turn)});
    target.asked = field.now;
    field.robot.request(target, soon, {});
  } else if (mode == base::Mode::Guided) {
    GoTo stream;
    stream.yaw_rad = std::remainder(turn, 2.0 * base::kPi);
    stream.speed_mps = 0.7;
    field.robot.request(stream, soon, {});
  } else if (mode == base::Mode::Acro || mode == base::Mode::Steering ||
             mode == base::Mode::Simple || mode == base::Mode::Manual) {
    // Let go now and then: whatever began meanwhile asks for it.
    field.robot.request(tick % 100 == 0 ? Drive{} : Drive{{0.6, 0.2}, true}, soon, {});
  }
}

void tick_in_mode(benchmark::State& state) {
  const auto mode = static_cast<base::Mode>(state.range(0));
  state.SetLabel(std::string(base::to_string(mode)));
  Field field;
  if (!field.start(10'000)) {
    state.SkipWithError("the mission did not start");
    return;
  }
  field.run(1'000);
  Watch watch(state);
  int count = 0;
  for (auto _ : state) {
    if (count % 10 == 0) stimulate(field, mode, count);
    if (field.robot.snapshot()->mode != mode && !enter(field, mode)) {
      state.SkipWithError("the mode does not begin");
      return;
    }
    ++count;
    watch.tick(field);
  }
}
BENCHMARK(tick_in_mode)
    ->Arg(static_cast<int>(base::Mode::Manual))
    ->Arg(static_cast<int>(base::Mode::Acro))
    ->Arg(static_cast<int>(base::Mode::Steering))
    ->Arg(static_cast<int>(base::Mode::Simple))
    ->Arg(static_cast<int>(base::Mode::Hold))
    ->Arg(static_cast<int>(base::Mode::Guided))
    ->Arg(static_cast<int>(base::Mode::Rtl))
    ->Arg(static_cast<int>(base::Mode::SmartRtl))
    ->Arg(static_cast<int>(base::Mode::Follow))
    ->Arg(static_cast<int>(base::Mode::Dock))
    ->UseManualTime()
    ->MinTime(0.5);

/// Under a fence, two missions of 10,000 items in turn, each compiled anew: what is timed is the
/// tick that takes one and lets the other go.
void tick_that_loads(benchmark::State& state) {
  Field field;
  field.run(500);
  auto fence = std::make_shared<mission::Fence>();
  mission::FencePolygon all;
  for (const base::EnuPoint p : {base::EnuPoint{-50.0, -50.0}, base::EnuPoint{3000.0, -50.0},
                                 base::EnuPoint{3000.0, 90.0}, base::EnuPoint{-50.0, 90.0}}) {
    all.points.push_back(kFrame.to_global(p));
  }
  fence->areas.push_back({mission::AreaKind::Inclusion, all});
  field.ask(SetFence{field.robot.lay_fence(fence)});
  Watch watch(state);
  bool loaded = true;
  for (auto _ : state) {
    auto compiled = field.robot.compile({"m", 1, plan_of(10'000)});
    field.run(5);  // as in the program, where another core compiles: the loop's caches are warm
    field.robot.request(LoadMission{std::move(*compiled)}, field.now + std::chrono::seconds(1),
                        [&loaded](base::Result<void> r) { loaded = loaded && r.has_value(); });
    watch.tick(field);
  }
  if (!loaded) state.SkipWithError("a mission was not loaded");
}
BENCHMARK(tick_that_loads)->UseManualTime()->Iterations(300);

void compile_a_mission(benchmark::State& state) {
  const Robot robot{Config{}};
  const auto plan = plan_of(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(robot.compile({"m", 1, plan}));
}
BENCHMARK(compile_a_mission)->Arg(1'000)->Arg(10'000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace roverd::robot
