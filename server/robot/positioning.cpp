// Where the robot is, as an operator says it, and what of the estimate an operator must know.

#include <cmath>
#include <string>

#include "base/angle.hpp"
#include "robot/impl.hpp"

namespace roverd::robot {
namespace {

using base::Code;
using base::Severity;

constexpr base::Duration kLasts = std::chrono::seconds(2);

std::string tenths_of(double value) {
  const long rounded = std::lround(std::abs(value) * 10.0);
  return std::to_string(rounded / 10) + "." + std::to_string(rounded % 10);
}

std::string cause_of(base::Refusal why) {
  switch (why) {
    case base::Refusal::NotFinite:
      return "they are not numbers";
    case base::Refusal::Impossible:
      return "they cannot be";
    case base::Refusal::Stamp:
      return "they are doubled, out of order or too old";
    case base::Refusal::Zero:
      return "latitude and longitude are exactly zero";
    case base::Refusal::Date:
      return "their date lies before such receivers were made";
    case base::Refusal::Satellites:
      return "too few satellites";
    case base::Refusal::Dilution:
      return "the satellites stand badly";
    case base::Refusal::Accuracy:
      return "the receiver itself is not sure enough";
    case base::Refusal::Disturbed:
      return "a turn on the spot disturbs them";
    case base::Refusal::Jump:
      return "they contradict what the robot did";
    case base::Refusal::Receivers:
      return "two receivers say different places";
  }
  return {};
}

}  // namespace

/// A person tells it of a robot that stands and that no mission moves meanwhile.
base::Result<void> Robot::Impl::may_be_placed() const {
  if (executor.running()) {
    return base::fail(Code::Conflict, "a mission runs: pause or stop it first");
  }
  const double speed_mps = pose ? std::abs(pose->speed_mps.value_or(0.0)) : 0.0;
  if (speed_mps > 0.05 || sent.twist != base::BodyTwist{}) {
    return base::fail(Code::Conflict, "the robot moves: stop it first");
  }
  return {};
}

base::Result<void> Robot::Impl::handle(const SetPose& c) {
  if (!c.at && !c.local && !c.heading_deg) {
    return base::fail(Code::Invalid, "neither a position nor a heading",
                      {{"", "lat and lon, or east_m and north_m, or heading_deg"}});
  }
  if (auto ok = may_be_placed(); !ok) return ok;
  std::optional<base::EnuPoint> at = c.local;
  if (c.at) {
    if (!base::is_valid(*c.at)) {
      return base::fail(Code::Invalid, "this is no position on earth", {{"/lat", "out of range"}});
    }
    if (!estimator.frame()) estimator.use_frame({frame_ids.fetch_add(1), *c.at});
    if (!within_reach(*c.at)) {
      return base::fail(Code::Invalid, "the place lies more than 10 km from the robot's map",
                        {{"/lat", "or /lon lies more than 10 km from the robot's map"}});
    }
    at = estimator.frame()->to_local(*c.at);
  }
  if (at && !estimator.frame()) {
    return base::fail(Code::Conflict,
                      "there is no map yet that east and north could be of: give lat and lon, load "
                      "a mission, or set nav.estimate.map_lat and map_lon");
  }
  if (at && std::hypot(at->east_m, at->north_m) > base::LocalFrame::kReach_m) {
    return base::fail(Code::Invalid, "the place lies more than 10 km from the map's origin",
                      {{"/east_m", "or /north_m lies more than 10 km from the map's origin"}});
  }
  std::optional<double> yaw_rad;
  if (c.heading_deg) yaw_rad = base::yaw_from_heading(*c.heading_deg);
  estimator.place(at, yaw_rad);
  resets_seen = estimator.health().resets;
  event(Severity::Info, "pose_set", "the operator said where the robot stands");
  return {};
}

base::Result<void> Robot::Impl::handle(const SetAnchor& c) {
  if (auto ok = may_be_placed(); !ok) return ok;
  const auto heard = estimator.last_position();
  if (!pose || !heard || estimator.health().placed || now - *heard > std::chrono::seconds(2)) {
    return base::fail(Code::Conflict, "there is no position from GNSS that could be anchored");
  }
  const auto at = anchor_point(c);
  if (!at) return tl::unexpected(at.error());
  const double off_m = base::distance_m(*at, pose->at);
  if (off_m > config->estimate.anchor_max_m) {
    std::string detail = "the point is " + tenths_of(off_m) + " m away; an anchor moves at most " +
                         tenths_of(config->estimate.anchor_max_m) + " m";
    return base::fail(Code::Conflict, std::move(detail));
  }
  estimator.anchor(*at, c.item);
  resets_seen = estimator.health().resets;
  anchored = true;
  event(Severity::Info, "anchored",
        "the robot stands at " +
            (c.item ? "item " + std::to_string(*c.item) : std::string("the given point")) +
            ": positions are moved by " + tenths_of(off_m) + " m");
  return {};
}

base::Result<base::EnuPoint> Robot::Impl::anchor_point(const SetAnchor& c) const {
  if (c.at && base::is_valid(*c.at)) return estimator.frame()->to_local(*c.at);
  if (!c.item) {
    return base::fail(Code::Invalid, "neither a point nor an item", {{"", "lat and lon, or item"}});
  }
  if (!mission) return base::fail(Code::Conflict, "no mission is loaded");
  for (const nav::RouteStep& step : mission->route.forth.steps) {
    if (step.item == *c.item && step.kind == nav::StepKind::Go) {
      return mission->route.forth.nodes[step.node].at;
    }
  }
  return base::fail(Code::Invalid,
                    "item " + std::to_string(*c.item) + " of the loaded mission is no place",
                    {{"/item", "is no place of the loaded mission"}});
}

base::Result<void> Robot::Impl::handle(const DropAnchor&) {
  if (auto ok = may_be_placed(); !ok) return ok;
  if (!estimator.health().anchor) return base::fail(Code::Conflict, "there is no anchor");
  estimator.drop_anchor();
  anchored = false;
  event(Severity::Info, "anchor_dropped", "the anchor was dropped by the operator");
  return {};
}

/// Resets, refusals that last, the gyro's coming and going, the anchor.
void Robot::Impl::watch_estimate() {
  health = estimator.health();
  if (health.resets != resets_seen) {
    resets_seen = health.resets;
    std::string detail = "the sensors contradicted the estimate for too long: ";
    if (const auto& reset = health.last_reset) {
      detail += std::string(reset->what) + " set anew, moved by " +
                tenths_of(std::hypot(reset->jump.east_m, reset->jump.north_m)) + " m, turned by " +
                tenths_of(base::deg_from_rad(reset->jump_rad)) + " deg";
    }
    event(Severity::Warning, "estimate_reset", std::move(detail));
  }
  if (health.gyro != gyro_seen) {
    gyro_seen = health.gyro;
    event(gyro_seen ? Severity::Info : Severity::Warning, gyro_seen ? "gyro_back" : "gyro_lost",
          gyro_seen ? "turns are measured by the gyro"
                    : "the gyro is silent: turns are measured by the tracks");
  }
  if (health.alignment != alignment_seen) {
    const bool found = health.alignment == base::Alignment::Aligned;
    if (found) event(Severity::Info, "heading_found", "the heading is known");
    if (alignment_seen == base::Alignment::Aligned) {
      event(Severity::Warning, "heading_lost", "the heading is not certain any more");
    }
    alignment_seen = health.alignment;
  }
  if (anchored && !health.anchor) {
    anchored = false;
    const std::string why = "the anchor was dropped: the fix class changed";
    event(Severity::Warning, "anchor_dropped", why);
    if (executor.running()) {
      hold(why);
      event(Severity::Warning, "mission_paused", why);
    }
  }
  watch_refusals();
}

void Robot::Impl::watch_refusals() {
  struct Watched {
    const base::InputHealth& input;
    const char* what;
  };
  const std::array<Watched, 4> inputs{{{health.position, "positions of the receiver"},
                                       {health.velocity, "velocities of the receiver"},
                                       {health.heading, "headings of the antennas"},
                                       {health.odometry, "distances of the base"}}};
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const auto& since = inputs[i].input.refused_since;
    const bool lasts = since && now - *since >= kLasts;
    if (lasts == refusal_told[i]) continue;
    refusal_told[i] = lasts;
    if (lasts) {
      event(Severity::Warning, "input_refused",
            std::string(inputs[i].what) + " are not used: " + cause_of(inputs[i].input.why));
    } else {
      event(Severity::Info, "input_used", std::string(inputs[i].what) + " are used again");
    }
  }
}

/// Nobody knows where the robot points, not even roughly: straight on, slowly.
base::DriveCommand Robot::Impl::seek_heading() {
  speed_reason = "heading_unknown";
  const StraightStart::State state{false, true, estimator.turned_rad(), estimator.driven_m()};
  const auto turn = straight.step(state);
  if (!turn) {
    const std::string why = "the heading was not found in 3 m of driving straight";
    hold(why);
    event(Severity::Warning, "mission_paused", why);
    straight.reset();
    return {{}, true};
  }
  const double speed_mps = config->speed.creep_mps;
  return {{speed_mps, (*turn - estimator.pull_1pm() * speed_mps) / estimator.yaw_scale()}, true};
}

/// While the heading is uncertain, along a leg: the mission's speed, but straight on.
base::BodyTwist Robot::Impl::straight_first(const base::BodyTwist& wanted) {
  constexpr double kEndNear_m = 1.0;
  constexpr double kAside_deg = 50.0;  // a target so far aside is not reached straight on
  StraightStart::State state{health.alignment == base::Alignment::Aligned, false,
                             estimator.turned_rad(), estimator.driven_m()};
  const auto target = executor.progress(pose->at).target;
  bool ahead = true;
  if (target) {
    const base::EnuPoint way = *target - pose->at;
    const double back = wanted.linear_mps < 0.0 ? base::kPi : 0.0;
    const double bearing = std::atan2(way.north_m, way.east_m) + back;
    ahead = std::hypot(way.east_m, way.north_m) > kEndNear_m &&
            std::abs(base::angle_diff_rad(pose->yaw_rad, bearing)) < base::rad_from_deg(kAside_deg);
  }
  state.driving = executor.phase() == nav::TrackPhase::Follow && wanted.linear_mps != 0.0 && ahead;
  const auto turn = straight.step(state);
  if (!turn) return wanted;
  speed_reason = "heading_uncertain";
  const double track_mps = wanted.linear_mps;
  return {track_mps, (*turn - estimator.pull_1pm() * track_mps) / estimator.yaw_scale()};
}

}  // namespace roverd::robot
