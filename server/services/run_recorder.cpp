#include "services/run_recorder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/log.hpp"

namespace roverd::services {

namespace {

using base::ExecutionState;

bool in_hand(ExecutionState s) noexcept {
  return s == ExecutionState::Running || s == ExecutionState::Paused ||
         s == ExecutionState::Blocked;
}

std::vector<store::RunParameter> changed_parameters(const robot::Robot& robot) {
  std::vector<store::RunParameter> out;
  for (const robot::Parameter& p : robot.parameters()) {
    if (p.info.value == p.initial) continue;
    out.push_back({p.section + "." + p.info.name, p.info.value});
  }
  return out;
}

}  // namespace

void RunRecorder::recall() {
  if (std::exchange(recalling_, true)) return;
  store_.read_place([self = std::weak_ptr<RunRecorder*>(self_)](auto place) {
    const auto alive = self.lock();
    if (!alive) return;
    RunRecorder& r = **alive;
    r.recalled_ = true;
    if (place && *place && !r.place_kept_) r.offer_ = std::move(**place);
  });
}

std::optional<store::StoredPlace> RunRecorder::offer() const {
  const bool other = offer_ && !loaded_id_.empty() && loaded_id_ != offer_->mission_id;
  return other ? std::nullopt : offer_;
}

void RunRecorder::forget(std::function<void(base::Result<void>)> done) {
  if (!offer_) return done({});
  offer_.reset();
  if (place_kept_) return done({});  // what is kept now is of the mission in hand
  store_.keep_place(std::nullopt, std::move(done));
}

void RunRecorder::look(const base::Snapshot& s) {
  recall();
  const base::MissionProgress& m = s.mission;
  const bool hand = in_hand(m.state);
  loaded_id_ = m.mission_id;
  if (hand) {
    offer_.reset();
    recalled_ = true;
  }
  keep_place(s);
  const bool other = open_ && m.mission_id != mission_id_;
  if (open_ && (other || !hand)) {
    end(m.state == ExecutionState::Finished && !other ? store::RunOutcome::Finished
                                                      : store::RunOutcome::Aborted,
        s);
  }
  if (!open_ && m.state == ExecutionState::Running) begin(s);
  state_ = m.state;
  if (!open_) return;
  if (drives(s) && (stands_ || s.now - sampled_ >= kEvery)) sample(s);
  if (s.now - flushed_ < kFlush) return;
  flushed_ = s.now;
  flush(s.wall, std::nullopt);
}

/// While the mission runs, and after a pause or a stop until the robot stands: how it came to rest
/// is part of the run. What is driven by hand after that is not.
bool RunRecorder::drives(const base::Snapshot& s) {
  if (s.mission.state == ExecutionState::Running) {
    ran_ = s.now;
    stands_ = false;
    return true;
  }
  if (stands_ || s.now - ran_ > kStops) return false;
  stands_ = s.pose && std::abs(s.pose->speed_mps.value_or(0.0)) < kStanding_mps;
  return true;
}

void RunRecorder::begin(const base::Snapshot& s) {
  const auto loaded = robot_.loaded();
  if (!loaded) return;
  open_ = true;
  id_.reset();
  sending_ = true;  // until the store has told the run's number
  batch_.points.clear();
  if (std::exchange(batch_.outcome, std::nullopt)) batch_.events.clear();
  lap_ = 1;
  mission_id_ = s.mission.mission_id;
  begun_ = flushed_ = s.now;
  sampled_ = s.now - kEvery;
  store::StoredRun run;
  run.head.begun = s.wall;
  run.head.mission_id = loaded->id;
  run.head.revision = loaded->revision;
  run.head.name = loaded->plan.name;
  run.head.vehicle = vehicle_;
  run.head.first_item = s.mission.current_item.value_or(1);
  run.plan = loaded->plan;
  run.parameters = changed_parameters(robot_);
  const std::uint64_t mine = ++generation_;
  store_.begin_run(std::move(run), [self = std::weak_ptr<RunRecorder*>(self_), mine](auto id) {
    const auto alive = self.lock();
    if (!alive || (*alive)->generation_ != mine) return;
    RunRecorder& r = **alive;
    r.sending_ = false;
    if (id) r.id_ = *id;
    if (id && (!r.open_ || r.batch_.outcome)) r.send();
    if (id) return;
    r.open_ = false;
    static base::LogLimit limit(10.0);
    if (limit.due()) {
      base::log(base::Level::Error, "services", "a run is not recorded",
                {{"reason", id.error().detail}});
    }
  });
}

void RunRecorder::sample(const base::Snapshot& s) {
  sampled_ = s.now;
  if (!s.pose) return;
  store::RunPoint p;
  p.t_s = base::seconds(s.now - begun_);
  p.at = s.pose->global;
  p.yaw_rad = s.pose->yaw_rad;
  p.speed_mps = s.pose->speed_mps.value_or(0.0);
  p.yaw_rate_radps = s.pose->yaw_rate_radps.value_or(0.0);
  p.sigma_m = s.pose->horizontal_sigma_m;
  p.cross_m = s.mission.cross_track_m;
  p.item = s.mission.current_item;
  p.lap = lap_;
  if (s.battery && s.battery->current_a) p.power_w = s.battery->voltage_v * *s.battery->current_a;
  p.by_itself = s.control == base::Driver::Autonomy;
  if (batch_.points.size() >= kMost) {
    batch_.points.erase(batch_.points.begin());
    ++lost_;
  }
  batch_.points.push_back(p);
}

void RunRecorder::take(const base::Event& event) {
  // The event that a mission begins comes before the snapshot in which it runs.
  const bool begins = event.kind == "mission_started" || event.kind == "mission_resumed";
  if (!open_ && begins && !batch_.outcome) batch_.events.assign(1, event);
  if (!open_ || batch_.events.size() >= kMost) return;
  if (event.kind == "mission_lap") ++lap_;
  batch_.events.push_back(event);
}

void RunRecorder::end(store::RunOutcome outcome, const base::Snapshot& s) {
  sample(s);
  flush(s.wall, outcome);
  open_ = false;
}

void RunRecorder::flush(base::WallTime wall, std::optional<store::RunOutcome> outcome) {
  if (outcome) {
    batch_.outcome = outcome;
    batch_.ended = wall;
  }
  send();
}

void RunRecorder::send() {
  if (sending_ || !id_) return;
  if (batch_.points.empty() && batch_.events.empty() && !batch_.outcome) return;
  sending_ = true;
  auto sent = std::make_shared<store::RunBatch>(std::move(batch_));
  batch_ = {};
  const std::uint64_t mine = generation_;
  store_.add_to_run(*id_, *sent,
                    [self = std::weak_ptr<RunRecorder*>(self_), mine, sent](auto done) {
                      const auto alive = self.lock();
                      if (!alive || (*alive)->generation_ != mine) return;
                      RunRecorder& r = **alive;
                      r.sending_ = false;
                      if (!done && done.error().code == base::Code::Unavailable) {
                        r.lost_ += sent->points.size();
                      }
                      if (r.batch_.outcome) r.send();
                    });
}

/// Where the mission stands: at once when the item or the state changes, else every second.
void RunRecorder::keep_place(const base::Snapshot& s) {
  const base::MissionProgress& m = s.mission;
  if (!in_hand(m.state) || !m.place) {
    if (place_kept_) store_.keep_place(std::nullopt, [](auto) {});
    place_kept_ = false;
    place_seen_.clear();
    return;
  }
  std::string seen = m.mission_id + "/" + std::to_string(m.revision) + "/" +
                     std::to_string(m.place->step) + "/" + std::string(base::to_string(m.state));
  const bool due = m.state == ExecutionState::Running && s.now - place_at_ >= kFlush;
  if (seen == place_seen_ && !due) return;
  place_seen_ = std::move(seen);
  place_at_ = s.now;
  place_kept_ = true;
  store::StoredPlace place;
  place.time = s.wall;
  place.mission_id = m.mission_id;
  place.revision = m.revision;
  place.name = m.name;
  place.item = m.current_item;
  place.items = m.items;
  place.place = *m.place;
  store_.keep_place(std::move(place), [](auto) {});
}

}  // namespace roverd::services
