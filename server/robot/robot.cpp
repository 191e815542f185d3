#include "robot/robot.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include "robot/impl.hpp"
#include "robot/map_frame.hpp"
#include "robot/safety/self_test.hpp"
#include "robot/safety/start_check.hpp"

namespace roverd::robot {

using base::Code;
using base::Severity;

Robot::Impl::Impl(Config c)
    : config(std::move(c)),
      estimator(config.estimate),
      missions(config),
      self_driving(config),
      by_hand(config),
      driven(config->modes.crumb_m),
      keys(config.radio, config.safety),
      handling(config),
      self_test(test_failsafes()) {
  world.gauge = BatteryGauge(config.battery);
  shared_config.publish(config.whole());
  reviewed = config.whole();
  measurement_batch.reserve(256);
  command_batch.reserve(64);
  pressed.reserve(64);
}

Robot::Robot(const Config& config) : impl_(std::make_unique<Impl>(config)) {}
Robot::~Robot() = default;

base::Inbox<base::Measurement>& Robot::measurements() noexcept {
  return impl_->measurements;
}
void Robot::guard_by(const nav::sense::ProtectParams& params, bool demands,
                     const BlockedParams& blocked, const OutlineParams& outline,
                     const nav::sense::RaysParams& rays) {
  impl_->guard.set(params, impl_->config->vehicle, demands, blocked, impl_->config->tool, outline,
                   rays);
  Config said = *impl_->config;
  said.protect = params;
  said.blocked = blocked;
  said.rays = rays;
  impl_->config.adopt(std::make_shared<const Config>(std::move(said)));
  impl_->shared_config.publish(impl_->config.whole());
}
void Robot::recognise() {
  impl_->recognises = true;
}
void Robot::read_tags() {
  impl_->reads_tags = true;
}
base::Inbox<std::shared_ptr<const nav::tags::TagsSeen>>& Robot::tags() noexcept {
  return impl_->tags;
}
void Robot::know(std::shared_ptr<const std::vector<base::KnownPlace>> places) {
  if (!places) return;
  while (!impl_->shared_places.publish(places)) continue;  // somebody reads it for a moment
  impl_->known_lists.put(std::move(places));
}
base::Inbox<std::shared_ptr<const Surroundings>>& Robot::surroundings() noexcept {
  return impl_->surroundings;
}
base::Inbox<std::shared_ptr<const Surroundings>>& Robot::surroundings_done() noexcept {
  return impl_->surroundings_done;
}
base::Inbox<RowQuestion>& Robot::row_questions() noexcept {
  return impl_->row_questions;
}
base::Inbox<nav::sense::Odometry>& Robot::odometry() noexcept {
  return impl_->odometry;
}
base::Inbox<std::shared_ptr<const AroundQuestion>>& Robot::around_questions() noexcept {
  return impl_->around_questions;
}
base::Inbox<std::shared_ptr<const AroundAnswer>>& Robot::around_answers() noexcept {
  return impl_->around_answers;
}
base::Inbox<PendingReply>& Robot::replies() noexcept {
  return impl_->outbox.replies;
}
base::Inbox<base::Event>& Robot::events() noexcept {
  return impl_->outbox.events;
}
base::Inbox<TeachWish>& Robot::teach_wishes() noexcept {
  return impl_->outbox.wishes;
}
base::Inbox<MissionEdit>& Robot::edits() noexcept {
  return impl_->outbox.edits;
}
void Robot::recall(const nav::Learned& learned) noexcept {
  impl_->estimator.recall(learned);
  impl_->handling.recall(learned);
  impl_->calibrated.recall(learned);
}
void Robot::reviewed(const Config& config) {
  impl_->reviewed = std::make_shared<const Config>(config);
}
void Robot::tell(base::Event event) {
  // Past the outbox, which is the control thread's alone.
  impl_->outbox.events.put(std::move(event));
  if (wake) wake();
}
void Robot::begin_latched(const std::string& why, base::WallTime wall) {
  (void)impl_->arm.latch();
  impl_->latch_told = true;
  tell({wall, base::Severity::Error, "estop", "emergency stop: " + why});
}
std::shared_ptr<const nav::Learned> Robot::learned() const {
  return impl_->learned.get();
}
std::shared_ptr<const base::Snapshot> Robot::snapshot() const {
  return impl_->snapshot.get();
}

std::shared_ptr<const MissionCopy> Robot::loaded() const {
  const auto mission = impl_->loaded.get();
  if (!mission) return nullptr;
  return {mission, &mission->copy};
}

bool Robot::request(Command command, Validity validity, Reply reply) {
  // The stop itself never waits for room in a queue.
  const bool stop = std::holds_alternative<Estop>(command);
  if (stop) impl_->estop_asked.store(true);
  const std::size_t more = is_stop(command) ? kStopsWaiting : 0;
  const bool queued = impl_->commands.offer({std::move(command), validity, std::move(reply)}, more);
  if (stop && alert) alert();
  return queued;
}

nav::StartAt start_at(const StartMission& c) noexcept {
  switch (c.from) {
    case StartMission::From::First:
      return {nav::StartAt::From::First, 1};
    case StartMission::From::Nearest:
      return {nav::StartAt::From::Nearest, 1};
    case StartMission::From::Item:
      return {nav::StartAt::From::Item, c.item};
  }
  return {};
}

namespace {

/// What nobody would do is not driven to either.
base::Result<void> actions_known(const mission::Plan& plan) {
  std::vector<base::FieldError> wrong;
  std::string detail;
  for (std::size_t i = 0; i < plan.items.size(); ++i) {
    const auto* action = std::get_if<mission::Action>(&plan.items[i]);
    if (action == nullptr) continue;
    std::string why = mission::why_not_done(action->name, kActions);
    if (why.empty()) continue;
    if (detail.empty()) detail = "item " + std::to_string(i + 1) + " " + why;
    wrong.push_back({"/items/" + std::to_string(i), std::move(why)});
  }
  if (wrong.empty()) return {};
  return base::fail(Code::Invalid, std::move(detail), std::move(wrong));
}

const mission::Until* until_of(const mission::Item& item) noexcept {
  if (const auto* row = std::get_if<mission::Row>(&item)) return &row->until;
  if (const auto* wall = std::get_if<mission::Wall>(&item)) return &wall->until;
  return nullptr;
}

/// "; known are: gate, pole".
std::string names_of(const std::vector<base::KnownPlace>* places) {
  constexpr std::size_t kMostNames = 5;
  if (places == nullptr || places->empty()) return "; none is";
  std::string text = "; known are: ";
  for (std::size_t i = 0; i < std::min(kMostNames, places->size()); ++i) {
    text += (i > 0 ? ", " : "") + (*places)[i].name;
  }
  return text + (places->size() > kMostNames ? " and others" : "");
}

/// What ends beside a known place gets that one's position, in a plan of its own; empty: nothing
/// does. Invalid, naming the item. @param places null: none
base::Result<std::optional<mission::Plan>> with_places(
    const mission::Plan& said, const std::vector<base::KnownPlace>* places) {
  const bool any = std::ranges::any_of(said.items, [](const mission::Item& item) {
    const mission::Until* until = until_of(item);
    return until != nullptr && until->place;
  });
  if (!any) return std::optional<mission::Plan>{};
  mission::Plan plan = said;
  std::vector<base::FieldError> wrong;
  const auto resolve = [&](mission::Until& until, std::size_t item) {
    if (!until.place) return;
    const std::string at = "/items/" + std::to_string(item) + "/until_place";
    if (until.lat) {
      wrong.push_back({at, "until_place and until_lat exclude each other: give one of them"});
      return;
    }
    if (places != nullptr) {
      const auto known = std::ranges::find(*places, *until.place, &base::KnownPlace::name);
      if (known != places->end()) {
        until.lat = known->at.lat;
        until.lon = known->at.lon;
        return;
      }
    }
    wrong.push_back({at, "ends at \"" + *until.place +
                             "\", which nobody has entered as a known place" + names_of(places)});
  };
  for (std::size_t i = 0; i < plan.items.size(); ++i) {
    if (auto* row = std::get_if<mission::Row>(&plan.items[i])) resolve(row->until, i);
    if (auto* wall = std::get_if<mission::Wall>(&plan.items[i])) resolve(wall->until, i);
  }
  if (wrong.empty()) return plan;
  std::string detail = "item " + std::to_string(std::stoi(wrong.front().pointer.substr(7)) + 1) +
                       " " + wrong.front().detail;
  return base::fail(Code::Invalid, std::move(detail), std::move(wrong));
}

}  // namespace

base::Result<std::shared_ptr<const CompiledMission>> Robot::compile(MissionCopy copy) const {
  const auto state = impl_->snapshot.get();
  std::optional<base::LocalFrame> frame;
  if (state) frame = state->frame;
  bool local = false;
  for (std::size_t i = 0; !frame && i < copy.plan.items.size(); ++i) {
    const auto first = mission::place_of(copy.plan.items[i]);
    local = local || !first;
    if (first && base::is_valid(*first)) frame.emplace(impl_->frame_ids.fetch_add(1), *first);
  }
  if (!frame && copy.plan.home && local) {
    frame.emplace(impl_->frame_ids.fetch_add(1), copy.plan.home->at);
  }
  const std::optional<base::PlaceState> nowhere;
  const MapNow map_now{state ? state->place : nowhere, frame,
                       state ? state->estimator.map_offset : base::EnuPoint{},
                       state ? state->now : base::Time{}};
  if (copy.plan.frame) {  // before all else: it says why the position is not known
    auto lies = lies_of(*copy.plan.frame, map_now);
    if (!lies) return tl::unexpected(std::move(lies.error()));
    copy.plan.frame->lies = *lies;
  }
  if (!frame && local) {
    return base::fail(Code::Conflict,
                      "the position is not known, and the mission says of no place where it is");
  }
  if (!frame) {
    return base::fail(Code::Invalid, "the mission has no waypoint",
                      {{"/items", "the mission has no waypoint"}});
  }
  const auto known = impl_->shared_places.get();
  auto named = with_places(copy.plan, known.get());
  if (!named) return tl::unexpected(std::move(named.error()));
  if (auto done = actions_known(copy.plan); !done) return tl::unexpected(std::move(done.error()));
  const auto config = impl_->shared_config.get();
  auto route = nav::lay_route(*named ? **named : copy.plan, *frame, config->path());
  if (!route) return tl::unexpected(std::move(route.error()));
  CompiledMission made{impl_->made.fetch_add(1), std::move(copy), *frame, std::move(*route),
                       config->way};
  const auto fence = impl_->shared_fence.get();
  if (fence && fence->frame_id == frame->id()) {
    made.fence_id = fence->id;
    made.fence_margin_m = config->way_margin_m();
    made.fence_objection = route_objection(made.route, fence->limits, made.fence_margin_m);
  }
  return std::make_shared<const CompiledMission>(std::move(made));
}

std::shared_ptr<const LaidFence> Robot::lay_fence(
    std::shared_ptr<const mission::Fence> fence) const {
  if (!fence) return nullptr;
  auto laid = std::make_shared<LaidFence>();
  laid->id = impl_->made.fetch_add(1);
  laid->fence = std::move(fence);
  const auto state = impl_->snapshot.get();
  if (!state || !state->frame) return laid;
  laid->frame_id = state->frame->id();
  laid->limits = mission::CompiledFence(*laid->fence, *state->frame);
  for (const mission::RallyPoint& r : laid->fence->rally) {
    laid->rally.push_back(state->frame->to_local(r.at));
  }
  const auto mission = impl_->loaded.get();
  if (!mission || mission->frame.id() != laid->frame_id) return laid;
  laid->mission_id = mission->id;
  laid->margin_m = impl_->shared_config.get()->way_margin_m();
  laid->objection = route_objection(mission->route, laid->limits, laid->margin_m);
  return laid;
}

std::vector<mission::Finding> Robot::objections(const CompiledMission& mission,
                                                const StartMission& start) const {
  const auto config = impl_->shared_config.get();
  const auto state = impl_->snapshot.get();
  const double margin_m = config->way_margin_m();
  const nav::PathParams path = config->path();
  StartView view{.route = mission.route,
                 .margin_m = margin_m,
                 .path = path,
                 .behave = config->behave,
                 .at = start_at(start)};
  if (state && state->pose && state->frame && state->frame->id() == mission.frame.id()) {
    view.stand = stand_of(*state->pose);
  }
  for (const base::SafetyCondition& c :
       state ? state->safety : std::vector<base::SafetyCondition>{}) {
    if (c.id == "blind") view.blind = c.detail;
  }
  const auto& own = mission.copy.plan.home;
  const auto loaded = impl_->loaded.get();
  const bool is_loaded = loaded && loaded->id == mission.id;
  if (own && !is_loaded) {
    view.home = mission.frame.to_local(own->at);  // loading it sets home there
  } else if (state && state->home) {
    view.home = mission.frame.to_local(*state->home);
  }
  const auto fence = impl_->shared_fence.get();
  std::optional<mission::Finding> legs;
  if (fence && fence->frame_id == mission.frame.id()) {
    const auto* compared = legs_of(mission, *fence, margin_m);
    legs =
        compared != nullptr ? *compared : route_objection(mission.route, fence->limits, margin_m);
    view.limits = &fence->limits;
    view.legs = &legs;
  }
  if (const auto& map = mission.copy.plan.frame; map && state) {
    const auto& steps = mission.route.forth.steps;
    const std::size_t first =
        state->pose ? nav::first_step(mission.route, view.at, state->pose->at) : 0;
    const bool into_it =
        leads_into_map(mission.copy.plan, first < steps.size() ? &steps[first] : nullptr);
    const auto ok = counts_from(
        *map, {state->place, state->frame, state->estimator.map_offset, state->now}, into_it);
    if (!ok) view.not_in_map = ok.error().detail;
  }
  return start_findings(view);
}

std::vector<mission::Finding> Robot::objections(const StartMission& start) const {
  const auto mission = impl_->loaded.get();
  return mission ? objections(*mission, start) : std::vector<mission::Finding>{};
}

bool Robot::fenced(const CompiledMission& mission) const {
  const auto fence = impl_->shared_fence.get();
  return fence && fence->frame_id == mission.frame.id();
}

std::shared_ptr<const Config> Robot::config() const {
  return impl_->shared_config.get();
}

void Robot::Impl::take_estop(Time now) {
  // Latched already: its command is in the queue, or was the one that latched. Counted again a tick
  // later, it would refuse the reset of whoever was answered in between.
  if (!estop_asked.exchange(false) || arm.latched()) return;
  last_stop.take(now);
  unnamed_stop = now;
  latch_silently();
}

constexpr base::Duration kStopNamed = std::chrono::milliseconds(200);

/// Its command says by whom, a tick later or two; one that does not come leaves it unnamed.
void Robot::Impl::name_stop(Time now) {
  if (unnamed_stop && now - *unnamed_stop > kStopNamed) tell_stop("the operator");
}

/// What changed about a driver, for those who look later. One that is tried again and again, and is
/// not there, is told of once: until it is up.
void Robot::Impl::note_driver(const base::DriverStatus& d) {
  using Phase = base::DriverPhase;
  const auto known = std::find_if(world.drivers.begin(), world.drivers.end(),
                                  [&](const auto& k) { return k.name == d.name; });
  const bool is_new = known == world.drivers.end();
  if (is_new || known->phase != d.phase) {
    if (d.phase == Phase::Up) {
      std::erase(down_told, d.name);
      event(Severity::Info, "driver_up", d.name + " is up");
    }
    if (d.phase == Phase::Faulty && std::ranges::count(down_told, d.name) == 0) {
      down_told.push_back(d.name);
      event(Severity::Warning, "driver_down", d.name + ": " + d.reason);
    }
    if (d.phase == Phase::Failed) {
      event(Severity::Error, "driver_failed", d.name + ": " + d.reason);
    }
  }
  const bool stopped = d.recording == base::Recording::Stopped;
  if (stopped && (is_new || known->recording != base::Recording::Stopped)) {
    event(Severity::Warning, "recording_stopped", d.name + ": " + d.recording_problem);
  }
}

void Robot::Impl::take_measurements() {
  measurement_batch.clear();
  measurements.try_take(measurement_batch);
  std::stable_sort(measurement_batch.begin(), measurement_batch.end(),
                   [](const base::Measurement& a, const base::Measurement& b) {
                     return base::stamp_of(a) < base::stamp_of(b);
                   });
  for (base::Measurement& m : measurement_batch) {
    estimator.take(m, clock.now());
    if (const auto* d = std::get_if<base::DriverStatus>(&m)) {
      note_driver(*d);
      driver_falls.take(*d);
    }
    const auto* radio = std::get_if<base::RadioState>(&m);
    const auto frame = radio != nullptr ? std::optional(*radio) : std::nullopt;
    world.take(std::move(m));
    if (frame) press(*frame);
  }
  measurement_batch.clear();
  world.forget_stale(clock.now());
  estimator.advance(clock.now());
  pose = estimator.pose(clock.now());
}

void Robot::Impl::tell_latch(const Robot& self) {
  if (std::exchange(latch_told, arm.latched()) != arm.latched() && self.on_latch) {
    self.on_latch(arm.latched());
  }
}

void Robot::heed_stop(Time now) noexcept {
  Impl& r = *impl_;
  // Latched already: every tick sends what stands.
  if (r.arm.latched() || r.clock.health().ticks == 0 || !r.estop_asked) return;
  try {
    r.take_estop(now);
    r.sent = {};
    if (send) send(r.sent, now);
    r.tell_latch(*this);
  } catch (...) {
    r.estop_asked = true;  // the next tick's
  }
}

void Robot::tick(Time now, base::WallTime wall, base::Duration lateness) noexcept {
  Impl& r = *impl_;
  try {
    r.clock.begin(now, wall, lateness);
    r.take_estop(now);
    r.take_commands();
    r.name_stop(now);
    r.take_measurements();
    r.look_around();
    r.watch_estimate();
    r.watch_frame();
    r.act_on_radio();
    r.judge();
    if (r.pose) r.lay_way();
    r.see_handling();
    r.sent = r.decide();
    r.sent_handling();
    if (send) send(r.sent, now);
    r.tell_latch(*this);
    if (r.publish() && r.outbox.flush() && wake) wake();
  } catch (const std::exception& e) {
    r.survive(e.what(), *this);
  } catch (...) {
    r.survive("no std::exception", *this);
  }
}

/// An exception ended the tick (no memory, or a bug): nothing moves until somebody arms again, and
/// whoever looks is told. What needs memory comes last, each for itself; the next tick tries again.
void Robot::Impl::survive(const char* what, const Robot& self) noexcept {
  const bool was_armed = arm.disarm();
  const bool due = clock.fault() || was_armed;
  driver = base::Driver::None;
  sent = {};
  const auto try_to = [](auto deed) {
    try {
      deed();
    } catch (...) {
      // The base stops by itself when it hears nothing; the counter tells of the rest.
      return;
    }
  };
  try_to([&] {
    if (self.send) self.send(sent, clock.now());
  });
  try_to([&] { tell_latch(self); });
  try_to([&] {
    by_hand.lock("the control loop had a fault", clock.now());
    change_mode(ModeCause::Fault, "a fault in the control loop");
    if (!due) return;
    event(Severity::Error, "loop_fault",
          std::string("an exception ended a tick of the control loop") +
              (was_armed ? ", and the robot is disarmed: " : ": ") + what);
  });
  try_to([&] {
    if (publish() && outbox.flush() && self.wake) self.wake();
  });
}

}  // namespace roverd::robot
