#include "robot/mission_keeper.hpp"

#include <algorithm>
#include <cmath>

namespace roverd::robot {
namespace {

using base::Code;

constexpr const char* kLeftBehind = "left by a restart";
constexpr double kKnown_m = 0.5;  // a vaguer place says nothing of how far it rolled
constexpr double kRolls_m = 3.0;  // farther it was carried, or driven by hand
// What stays left of what was all but done: 0 stands for all of it.
constexpr double kLeastTurn_rad = 1e-3;
constexpr double kLeastMove_m = 0.01;

/// @param left either sign
double less(double left, double by, double least) noexcept {
  const double most = std::max(0.0, std::abs(left) - least);
  return left - std::copysign(std::min(by, most), left);
}

/// Of an arc whose ends lie so far apart.
double arc_rad(double chord_m, double radius_m) noexcept {
  return 2.0 * std::asin(std::min(1.0, chord_m / (2.0 * radius_m)));
}

}  // namespace

std::string MissionKeeper::name() const {
  return "mission \"" + mission_->copy.plan.name + "\" revision " +
         std::to_string(mission_->copy.revision);
}

MissionKeeper::Mission MissionKeeper::load(Mission mission) {
  Mission old = std::exchange(mission_, std::move(mission));
  executor.load(route());
  return old;
}

base::Result<void> MissionKeeper::may_revise(const ReviseMission& r) const {
  const bool same =
      mission_ ? mission_->copy.id == r.from_id && mission_->copy.revision == r.from_revision
               : r.from_id.empty();
  if (!same) return base::fail(Code::Conflict, "another mission was loaded meanwhile");
  return {};
}

MissionKeeper::Mission MissionKeeper::revise(const ReviseMission& r) {
  Mission old = std::exchange(mission_, r.mission);
  if (!mission_) {
    if (executor.running()) executor.stop("nothing is left of the mission");
    executor.load(nullptr);
  } else if (!old) {
    executor.load(route());
  } else if (r.kind == EditKind::RemoveItem) {
    executor.drop(route(), r.item);
  } else {
    executor.extend(route());
  }
  return old;
}

base::Result<void> MissionKeeper::may_lay_anew(const CompiledMission& mission) const {
  const bool same = mission_ && mission_->copy.id == mission.copy.id &&
                    mission_->copy.revision == mission.copy.revision &&
                    mission_->frame.id() == mission.frame.id();
  if (!same) return base::fail(Code::Conflict, "another mission was loaded meanwhile");
  if (in_hand()) {
    return base::fail(Code::Conflict, "the mission is " + std::string(to_string(executor.state())) +
                                          ": its way stays as it is");
  }
  return {};
}

MissionKeeper::Mission MissionKeeper::lay_anew(Mission mission) {
  Mission old = std::exchange(mission_, std::move(mission));
  executor.lay_anew(route());
  return old;
}

base::Result<void> MissionKeeper::may_restore(const ResumeAt& left, const ParameterSet& set,
                                              base::EnuPoint here) const {
  nav::Executor trial(set.path, set.behave, set.modes, set.row, set.marks);
  const std::shared_ptr<const nav::Route> way(left.mission, &left.mission->route);
  if (auto ok = trial.restore(way, left.place, kLeftBehind); !ok) return ok;
  return trial.may_resume(here);
}

void MissionKeeper::restore(const base::MissionPlace& place) {
  (void)executor.restore(route(), place, kLeftBehind);
}

base::MissionPlace rolled_on(const nav::Route& route, base::MissionPlace place,
                             const base::Pose& pose) noexcept {
  const auto& steps = place.back ? route.back.steps : route.forth.steps;
  const bool fits = place.step >= 0 && static_cast<std::size_t>(place.step) < steps.size();
  if (!fits || !place.driving || !place.at || pose.horizontal_sigma_m > kKnown_m) return place;
  const nav::RouteStep& step = steps[static_cast<std::size_t>(place.step)];
  const double way_m = base::distance_bearing(*place.at, pose.global).distance_m;
  if (way_m > kRolls_m) return place;
  if (step.kind == nav::StepKind::Row || step.kind == nav::StepKind::Wall) {
    place.left += way_m;
  } else if (step.moves_on() && place.left != 0.0) {
    const bool turns = step.kind == nav::StepKind::Turn;
    place.left = turns ? less(place.left, arc_rad(way_m, step.radius_m), kLeastTurn_rad)
                       : less(place.left, way_m, kLeastMove_m);
  }
  return place;
}

base::MissionProgress MissionKeeper::progress(const std::optional<base::Pose>& pose,
                                              const std::optional<base::LocalFrame>& frame,
                                              bool radio) const {
  base::MissionProgress p;
  if (!mission_) return p;
  p.mission_id = mission_->copy.id;
  p.revision = mission_->copy.revision;
  p.name = mission_->copy.plan.name;
  p.state = executor.state();
  p.reason = executor.reason();
  p.waits_for_word = executor.waits_for_word();
  if (p.waits_for_word) p.reason = "stays here until it is resumed, or skipped";
  if (executor.running() && radio) {
    p.reason = "the radio drives; the mission goes on when it gives control back";
  }
  p.items = static_cast<int>(mission_->copy.plan.items.size());
  const nav::Progress at = executor.progress(pose ? std::optional(pose->at) : std::nullopt,
                                             pose ? pose->horizontal_sigma_m : 0.0);
  p.current_item = at.current_item;
  p.cross_track_m = at.cross_track_m;
  p.arrival_radius_m = at.arrival_radius_m;
  p.cross_track_limit_m = at.cross_track_limit_m;
  p.distance_left_m = at.distance_left_m;
  p.eta_s = at.eta_s;
  p.lead = at.lead;
  p.place =
      executor.place(pose && pose->heading_known ? std::optional(pose->yaw_rad) : std::nullopt);
  const bool known = pose && pose->horizontal_sigma_m <= kKnown_m;
  if (p.place && p.place->driving && known) p.place->at = pose->global;
  if (pose && at.item_end && frame) {
    const auto to = base::distance_bearing(pose->global, frame->to_global(*at.item_end));
    p.distance_to_item_m = at.way_to_item_end_m.value_or(to.distance_m);
    p.bearing_to_item_deg = to.bearing_deg;
  }
  return p;
}

}  // namespace roverd::robot
