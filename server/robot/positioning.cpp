// Where the robot is, as an operator says it, and the first metres while its heading is uncertain.

#include <cmath>
#include <string>

#include "base/angle.hpp"
#include "robot/impl.hpp"

namespace roverd::robot {
namespace {

using base::Code;
using base::Severity;

}  // namespace

/// A person tells it of a robot that stands and that no mission moves meanwhile.
base::Result<void> Robot::Impl::may_be_placed() const {
  if (missions.executor.running()) {
    return base::fail(Code::Conflict, "a mission runs: pause or stop it first");
  }
  const double speed_mps = pose ? std::abs(pose->speed_mps.value_or(0.0)) : 0.0;
  if (speed_mps > 0.05 || sent.twist != base::BodyTwist{}) {
    return base::fail(Code::Conflict, "the robot moves: stop it first");
  }
  return {};
}

/// An operator said where the robot is: that is no jump to tell of, and all else begins anew.
void Robot::Impl::told_where() {
  estimator.acquit_all();
  estimator.trust();
  known_places.trust();
  estimate_watch.moved_on_purpose(estimator.health());
  reset_latch.moved_on_purpose(estimator.health());
}

base::Result<void> Robot::Impl::handle(const Acknowledge&) {
  if (const std::string& why = reset_latch.why(); !why.empty()) {
    event(Severity::Info, "estimate_acknowledged",
          std::string("acknowledged ") + asker + ": " + why);
  }
  reset_latch.acknowledge();
  estimator.acquit_all();
  estimator.trust();
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
  told_where();
  event(Severity::Info, "pose_set", "the operator said where the robot stands");
  return {};
}

base::Result<void> Robot::Impl::handle(const SetAnchor& c) {
  if (auto ok = may_be_placed(); !ok) return ok;
  const auto heard = estimator.last_position();
  if (!pose || !heard || estimator.health().placed ||
      clock.now() - *heard > std::chrono::seconds(2)) {
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
  told_where();
  estimate_watch.anchored(true);
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
  if (!missions) return base::fail(Code::Conflict, "no mission is loaded");
  for (const nav::RouteStep& step : missions->route.forth.steps) {
    if (step.item == *c.item && step.kind == nav::StepKind::Go) {
      return missions->route.forth.nodes[step.node].at;
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
  estimate_watch.anchored(false);
  event(Severity::Info, "anchor_dropped", "the anchor was dropped by the operator");
  return {};
}

base::Result<void> Robot::Impl::handle(const SettleShift& c) {
  if (auto ok = may_be_placed(); !ok) return ok;
  const auto shift = estimator.health().base_shift;
  if (!shift) return base::fail(Code::Conflict, "the receiver's positions have not moved");
  estimator.settle_shift(c.keep);
  told_where();
  estimate_watch.anchored(estimator.health().anchor.has_value());
  const std::string by = tenths_of(std::hypot(shift->offset.east_m, shift->offset.north_m));
  event(Severity::Info, "base_shift_settled",
        c.keep ? "the old place is kept: the receiver's positions are moved back by " + by + " m"
               : "the new place is taken: the robot's position is moved by " + by + " m");
  return {};
}

base::Result<void> Robot::Impl::handle(const CorrectAntennas& c) {
  if (auto ok = may_be_placed(); !ok) return ok;
  const base::EstimatorHealth known = estimator.health();
  if (c.apply && !known.antennas_askew) {
    return base::fail(Code::Conflict, "the two antennas were not seen to be askew");
  }
  if (!c.apply && known.antennas_offset_rad == 0.0) {
    return base::fail(Code::Conflict, "nothing is taken from the antennas' headings");
  }
  c.apply ? estimator.correct_antennas() : estimator.uncorrect_antennas();
  const double off_deg = base::deg_from_rad(estimator.health().antennas_offset_rad);
  event(Severity::Info, "antennas_corrected",
        c.apply ? "the two antennas' headings are turned by " + tenths_of(off_deg) +
                      " deg to the " + (off_deg > 0.0 ? "right" : "left") +
                      ", until the program starts anew: drivers.gnss.heading_offset_deg keeps it"
                : "the two antennas' headings are taken as they are");
  return {};
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

/// While the heading is uncertain, along a leg: the mission's speed, but straight on. Not where the
/// item asks for none.
base::BodyTwist Robot::Impl::straight_first(const base::BodyTwist& wanted) {
  constexpr double kEndNear_m = 1.0;
  constexpr double kAside_deg = 50.0;  // a target so far aside is not reached straight on
  StraightStart::State state{health.alignment == base::Alignment::Aligned, false,
                             estimator.turned_rad(), estimator.driven_m()};
  const auto target = missions.executor.progress(pose->at).target;
  bool ahead = true;
  if (target) {
    const base::EnuPoint way = *target - pose->at;
    const double back = wanted.linear_mps < 0.0 ? base::kPi : 0.0;
    const double bearing = std::atan2(way.north_m, way.east_m) + back;
    ahead = std::hypot(way.east_m, way.north_m) > kEndNear_m &&
            std::abs(base::angle_diff_rad(pose->yaw_rad, bearing)) < base::rad_from_deg(kAside_deg);
  }
  state.driving = missions.executor.phase() == nav::TrackPhase::Track && wanted.linear_mps != 0.0 &&
                  ahead && !missions.executor.asks_no_place();
  const auto turn = straight.step(state);
  if (!turn) return wanted;
  speed_reason = "heading_uncertain";
  const double track_mps = wanted.linear_mps;
  return {track_mps, (*turn - estimator.pull_1pm() * track_mps) / estimator.yaw_scale()};
}

}  // namespace roverd::robot
