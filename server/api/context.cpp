#include "api/context.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include "api/json/map_words.hpp"
#include "api/json/teach_words.hpp"
#include "api/profile.hpp"
#include "base/angle.hpp"
#include "base/log.hpp"

namespace roverd::api {

std::shared_ptr<const base::Snapshot> Context::snapshot_or_refuse(const CallPtr& call) const {
  auto snapshot = deps.robot.snapshot();
  if (!snapshot) {
    call->respond(problem({base::Code::Unavailable, "the control loop has not started yet"}));
  }
  return snapshot;
}

Profile Context::profile() const {
  Profile now = deps.profile;
  take_parameters(now, *deps.robot.config());
  return now;
}

std::optional<Response> Context::without_control(const Call& call) const {
  if (!call.acts || control.may(control.driver(call.who, peer_of(call.request))))
    return std::nullopt;
  return problem_response(403, control.problem());
}

Json Context::vehicle(const base::Snapshot& snapshot, base::Time now) const {
  Json out = vehicle_json(snapshot, deps.profile.name, now);
  const maps::Shelf* shelf = deps.maps.shelf;
  const auto in_use = shelf != nullptr ? shelf->in_use() : std::nullopt;
  const auto placed = in_use && deps.maps.placed ? deps.maps.placed() : std::nullopt;
  // It may have been given another name since it was taken into use.
  const auto label = in_use ? shelf->label_of(*in_use) : std::nullopt;
  if (label && !out["place"]["map"].is_null()) out["place"]["map"] = label->name;
  out["place"]["map_id"] = in_use ? Json(*in_use) : Json(nullptr);
  out["localisation"]["map_id"] = out["place"]["map_id"];
  out["place"]["placed"] = anchor_json(placed);
  out["teach"] = teach_brief_json(deps.services.view()->teach);
  out["holder"] = control.holder();
  return out;
}

std::optional<base::MapLies> Context::lies_of(const std::string& map) const {
  const maps::Shelf* const shelf = deps.maps.shelf;
  if (shelf == nullptr) return std::nullopt;
  const auto known = shelf->list();
  const auto found = std::ranges::find(known, map, &maps::About::name);
  if (found == known.end()) return std::nullopt;
  std::optional<maps::Anchor> lies = found->anchor;
  if (shelf->in_use() == found->id && deps.maps.placed) {
    if (const auto placed = deps.maps.placed()) lies = placed;
  }
  if (!lies) return std::nullopt;
  return base::MapLies{lies->at, base::yaw_from_heading(lies->heading_deg)};
}

std::optional<store::StoredPlace> Context::offer(const base::Snapshot& snapshot) const {
  const base::MissionProgress& m = snapshot.mission;
  const bool in_hand = m.state == base::ExecutionState::Running ||
                       m.state == base::ExecutionState::Paused ||
                       m.state == base::ExecutionState::Blocked;
  const auto offer = deps.services.view()->offer;
  const bool other = offer && !m.mission_id.empty() && m.mission_id != offer->mission_id;
  return in_hand || other ? std::nullopt : offer;
}

void Context::go_aside(const CallPtr& call, Effort effort, std::function<void()> work,
                       std::function<bool()> then) const {
  const auto tried = [work = std::move(work)] {
    try {
      work();
    } catch (const std::exception& bug) {
      base::log(base::Level::Error, "api", "work failed", {{"what", bug.what()}});
    }
  };
  const auto ended = [call, then = std::move(then)] {
    try {
      if (then()) return;
    } catch (const std::exception& bug) {
      base::log(base::Level::Error, "api", "a handler failed", {{"what", bug.what()}});
    }
    call->respond(problem({base::Code::Unavailable, "the request could not be handled"}));
  };
  if (!deps.aside || effort.bytes <= Effort::kAtOnce) {
    tried();
    return ended();
  }
  const Aside::Size size = effort.bytes >= Effort::kSlow   ? Aside::Size::Slow
                           : effort.bytes > Effort::kSmall ? Aside::Size::Large
                                                           : Aside::Size::Small;
  if (deps.aside({tried, ended, size, effort.must})) return;
  call->respond(
      problem({base::Code::Unavailable, "too much is being worked on; nothing was done"}));
}

void Context::announce(const std::string& id, std::optional<std::int64_t> revision) const {
  if (on_mission_change) on_mission_change(id, revision);
}

}  // namespace roverd::api
