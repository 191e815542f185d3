// The modes that are told where to go: GUIDED, FOLLOW, DOCK, LOITER, CIRCLE.

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "robot/impl.hpp"

namespace roverd::robot {
namespace {

using base::Code;

}  // namespace

// ---- GUIDED ----

base::Result<void> Robot::Impl::enter_guided() {
  if (auto ok = may_drive_by_itself(); !ok) return ok;
  if (machine.mode() == Mode::Guided) return go_on();
  change_mode(ModeCause::Chosen, asker, Mode::Guided);
  self_driving.wait_for_goal();
  return {};
}

base::Result<base::EnuPoint> Robot::Impl::place_of(const GoTo& c) const {
  base::EnuPoint p;
  if (c.at) {
    if (!base::is_valid(*c.at)) {
      return base::fail(Code::Invalid, "the goal is not a position on earth",
                        {{"/lat", "or /lon out of range"}});
    }
    if (!within_reach(*c.at)) {
      return base::fail(Code::Invalid, "the goal lies more than 10 km from the robot's map",
                        {{"/lat", "or /lon lies more than 10 km from the robot's map"}});
    }
    p = estimator.frame()->to_local(*c.at);
  } else if (c.local) {
    p = *c.local;
    const double far_m = std::hypot(p.east_m, p.north_m);
    if (!(far_m <= base::LocalFrame::kReach_m)) {
      return base::fail(Code::Invalid, "the goal lies more than 10 km from the robot's map",
                        {{"/east_m", "or /north_m lies more than 10 km from the robot's map"}});
    }
  }
  return p;
}

base::Result<void> Robot::Impl::guide(const nav::GuidedGoal& goal, std::string_view kind) {
  if (const std::string no = self_driving.refusal(goal); !no.empty()) {
    return base::fail(Code::Conflict, no);
  }
  change_mode(ModeCause::Chosen, asker, Mode::Guided);
  self_driving.go(goal, kind, vehicle());
  return {};
}

base::Result<void> Robot::Impl::handle(const GoTo& c) {
  const bool finite =
      std::isfinite(c.yaw_rad.value_or(0.0)) && std::isfinite(c.speed_mps.value_or(0.0)) &&
      (!c.local || (std::isfinite(c.local->east_m) && std::isfinite(c.local->north_m)));
  if (!finite) return base::fail(Code::Invalid, "a goal has finite numbers only");
  if (auto ok = may_drive_by_itself(); !ok) return ok;
  nav::GuidedGoal goal;
  goal.yaw_rad = c.yaw_rad;
  goal.speed_mps = c.speed_mps;
  goal.reverse = c.reverse;
  if (!c.at && !c.local) {
    if (!c.yaw_rad || !c.speed_mps) {
      return base::fail(Code::Invalid, "a goal is a position, or a heading and a speed");
    }
    goal.kind = nav::GuidedGoal::Kind::Steer;
    // One more of a stream is no word of a person.
    const HeldByRadio& held = self_driving.held();
    if (held.waits() && self_driving.activity().kind == "heading") {
      return base::fail(Code::Conflict, held.why());
    }
    return guide(goal, "heading");
  }
  const auto place = place_of(c);
  if (!place) return tl::unexpected(place.error());
  if (auto ok = inside(*place); !ok) return ok;
  goal.at = *place;
  return guide(goal, "goto");
}

base::Result<void> Robot::Impl::handle(const MoveBy& c) {
  for (const auto& value : {c.forward_m, c.turn_rad, c.yaw_rad, c.speed_mps}) {
    if (value && !std::isfinite(*value)) {
      return base::fail(Code::Invalid, "a move has finite numbers only");
    }
  }
  if (auto ok = may_drive_by_itself(); !ok) return ok;
  nav::GuidedGoal goal;
  if (c.forward_m) {
    goal.kind = nav::GuidedGoal::Kind::Move;
    goal.forward_m = *c.forward_m;
    goal.speed_mps = c.speed_mps;
    const base::EnuPoint to{pose->at.east_m + *c.forward_m * std::cos(pose->yaw_rad),
                            pose->at.north_m + *c.forward_m * std::sin(pose->yaw_rad)};
    if (auto ok = inside(to); !ok) return ok;
    return guide(goal, "move");
  }
  goal.kind = nav::GuidedGoal::Kind::Turn;
  goal.turn_rad = c.turn_rad;
  goal.yaw_rad = c.yaw_rad;
  if (c.turn_rad && c.yaw_rad) goal.yaw_rad.reset();
  return guide(goal, "turn");
}

// ---- FOLLOW ----

base::Result<void> Robot::Impl::handle(const SetTarget& c) {
  if (!estimator.frame()) return base::fail(Code::Conflict, "the position is not known");
  GoTo where;
  where.at = c.at;
  where.local = c.local;
  if (!c.at && !c.local) return base::fail(Code::Invalid, "a target has a position");
  const auto place = place_of(where);
  if (!place) return tl::unexpected(place.error());
  const auto bad = [](double x) { return !std::isfinite(x); };
  const bool not_finite =
      bad(place->east_m) || bad(place->north_m) || bad(c.age_s) || bad(c.a_m) || bad(c.b_m) ||
      (c.velocity_mps && (bad(c.velocity_mps->east_m) || bad(c.velocity_mps->north_m)));
  if (not_finite) return base::fail(Code::Invalid, "a target has finite numbers only");
  nav::FollowTarget target{*place, c.velocity_mps, c.asked - base::from_seconds(c.age_s)};
  if (target.stamp > clock.now() + std::chrono::milliseconds(200)) {
    return base::fail(Code::Invalid, "the target's time lies in the future",
                      {{"/time", "lies in the future"}});
  }
  if (base::seconds(clock.now() - target.stamp) > config->modes.follow_hold_s) {
    return base::fail(Code::Late, "the target's time is too long ago");
  }
  nav::FollowOffset offset;
  if (c.offset == SetTarget::Offset::North) offset.frame = nav::FollowOffset::Frame::North;
  if (c.offset == SetTarget::Offset::Course) offset.frame = nav::FollowOffset::Frame::Course;
  offset.a_m = c.a_m;
  offset.b_m = c.b_m;
  if (const std::string no = self_driving.take(target, offset); !no.empty()) {
    return base::fail(Code::Conflict, "the target is not believed: " + no);
  }
  return {};
}

base::Result<void> Robot::Impl::enter_follow() {
  if (auto ok = may_drive_by_itself(); !ok) return ok;
  if (machine.mode() == Mode::Follow) return go_on();
  const std::string no = self_driving.follow_refusal(pose->at, clock.now());
  if (!no.empty()) return base::fail(Code::Conflict, no);
  change_mode(ModeCause::Chosen, asker, Mode::Follow);
  self_driving.follow();
  return {};
}

// ---- DOCK ----

/// By sight alone: what stands before the tag is judged by the guard, where it is by nobody.
base::Result<void> Robot::Impl::enter_dock_at_tag(const SetMode& c) {
  if (!reads_tags) return base::fail(Code::Conflict, "no camera that reads tags is configured");
  if (config->vehicle.steered()) {
    return base::fail(Code::Conflict, "this vehicle cannot turn on the spot: it docks at no tag");
  }
  if (config->tool.pulled()) {
    return base::fail(Code::Conflict, "with a trailer no tag is docked at");
  }
  if (*c.tag < 0 || *c.tag > mission::kMostTag) {
    return base::fail(Code::Invalid, "there is no such tag", {{"/tag", "must be 0 to 586"}});
  }
  const double ahead_m = 0.5 * config->vehicle.length_m;
  const double stand_off_m = c.stand_off_m.value_or(config->tag_dock.stand_off_m);
  if (!(stand_off_m > ahead_m) || !(stand_off_m <= 5.0)) {
    return base::fail(Code::Invalid,
                      "the vehicle would not stand before the tag: its front is " +
                          std::to_string(std::lround(ahead_m * 100.0)) + " cm before its middle",
                      {{"/stand_off_m", "must be more than that, and 5 at most"}});
  }
  if (auto ok = may_drive_by_itself(true, fence.get() == nullptr); !ok) return ok;
  change_mode(ModeCause::Chosen, asker, Mode::Dock);
  self_driving.dock_at({*c.tag, c.stand_off_m}, clock.now());
  return {};
}

base::Result<void> Robot::Impl::enter_dock(const SetMode& c) {
  if (c.tag) return enter_dock_at_tag(c);
  const bool whole = c.goal && (c.goal->at || c.goal->local) && c.goal->yaw_rad;
  if (!whole) {
    return base::fail(Code::Invalid, "DOCK needs the pose to dock at",
                      {{"/heading_deg", "with lat and lon, or east_m and north_m, is missing"}});
  }
  if (auto ok = may_drive_by_itself(true); !ok) return ok;
  const auto place = place_of(*c.goal);
  if (!place) return tl::unexpected(place.error());
  if (!std::isfinite(place->east_m + place->north_m + *c.goal->yaw_rad)) {
    return base::fail(Code::Invalid, "a pose has finite numbers only");
  }
  if (auto ok = inside(*place); !ok) return ok;
  if (pose->horizontal_sigma_m > 2.0 * config->modes.dock_within_m) {
    return base::fail(Code::Conflict,
                      "the position is uncertain by " +
                          std::to_string(std::lround(pose->horizontal_sigma_m * 100.0)) +
                          " cm: too much to dock");
  }
  change_mode(ModeCause::Chosen, asker, Mode::Dock);
  self_driving.dock({*place, *c.goal->yaw_rad, c.goal->reverse}, vehicle());
  return {};
}

// ---- LOITER, CIRCLE ----

base::Result<void> Robot::Impl::enter_loiter(const SetMode& c) {
  if (auto ok = may_drive_by_itself(); !ok) return ok;
  nav::StayGoal goal{pose->at, c.radius_m.value_or(mission::kLoiterRadius_m)};
  if (c.goal) goal.speed_mps = c.goal->speed_mps;
  if (c.goal && (c.goal->at || c.goal->local)) {
    const auto place = place_of(*c.goal);
    if (!place) return tl::unexpected(place.error());
    if (auto ok = inside(*place); !ok) return ok;
    goal.at = *place;
  }
  if (!std::isfinite(goal.within_m) || !(goal.speed_mps.value_or(1.0) > 0.0)) {
    return base::fail(Code::Invalid, "radius and speed are above zero");
  }
  change_mode(ModeCause::Chosen, asker, Mode::Loiter);
  self_driving.stay(goal, vehicle(), estimator.frame()->to_global(goal.at));
  return {};
}

/// None of the way leads outside: to it, and round.
base::Result<void> Robot::Impl::circle_inside(const nav::OrbitGoal& goal) const {
  constexpr int kChords = 72;
  const mission::CircleWay way = nav::Orbit::way_of(goal, pose->at);
  if (auto ok = inside(way.entry()); !ok) return ok;
  if (const auto lead = nav::Orbit::lead_of(way, config->vehicle)) {
    if (auto ok = inside(*lead); !ok) return ok;
    if (auto ok = fence.inside(*lead, way.entry(), way_margin_m()); !ok) return ok;
  }
  const double sweep_rad = std::clamp(way.sweep_rad, -2.0 * base::kPi, 2.0 * base::kPi);
  // So far out that the chords lie outside of the arc.
  mission::CircleWay outer = way;
  outer.radius_m /= std::cos(base::kPi / kChords);
  for (int i = 0; i < kChords; ++i) {
    const base::EnuPoint from = outer.at(sweep_rad * i / kChords);
    const base::EnuPoint to = outer.at(sweep_rad * (i + 1) / kChords);
    if (auto ok = fence.inside(from, to, way_margin_m()); !ok) return ok;
  }
  return {};
}

base::Result<void> Robot::Impl::enter_circle(const SetMode& c) {
  if (!c.goal || (!c.goal->at && !c.goal->local) || !c.radius_m) {
    return base::fail(Code::Invalid, "CIRCLE needs its centre and its radius",
                      {{c.radius_m ? "/lat" : "/radius_m", "is missing"}});
  }
  if (auto ok = may_drive_by_itself(); !ok) return ok;
  const auto place = place_of(*c.goal);
  if (!place) return tl::unexpected(place.error());
  const nav::OrbitGoal goal{*place, *c.radius_m, c.clockwise, c.turns, c.goal->speed_mps};
  const bool finite = std::isfinite(goal.radius_m) && std::isfinite(goal.turns.value_or(1.0)) &&
                      std::isfinite(goal.speed_mps.value_or(1.0));
  if (!finite || goal.radius_m <= 0.0 || goal.turns.value_or(1.0) <= 0.0) {
    return base::fail(Code::Invalid, "a circle has a radius, and turns if any, above zero");
  }
  if (const std::string no = self_driving.refusal(goal); !no.empty()) {
    return base::fail(Code::Conflict, no);
  }
  if (auto ok = circle_inside(goal); !ok) return ok;
  change_mode(ModeCause::Chosen, asker, Mode::Circle);
  self_driving.circle(goal, vehicle(), estimator.frame()->to_global(*place));
  return {};
}

}  // namespace roverd::robot
