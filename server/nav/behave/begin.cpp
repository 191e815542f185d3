// The executor where the position is not exact: how a mission begins, and what counts then.

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "nav/behave/executor.hpp"
#include "nav/behave/text.hpp"
#include "nav/track/corner.hpp"

namespace roverd::nav {
namespace {

constexpr double kCorridorSigmas = 2.0;  // of the position, that a corridor must hold
constexpr double kOfCorridor = 0.25;  // left of it for the driving, however uncertain the position

constexpr double kJoined_m = 0.5;
const double kJoined_rad = base::rad_from_deg(20.0);

}  // namespace

Beginning beginning(const Route& route, const StartAt& at, const std::optional<Stand>& stand,
                    std::optional<EnuPoint> home, const PathParams& path,
                    const BehaveParams& behave) noexcept {
  Beginning out;
  out.step = first_step(route, at, stand ? std::optional(stand->at) : std::nullopt);
  if (out.step >= route.forth.steps.size()) return out;
  out.target = first_target(route, out.step, home);
  if (stand && at.from != StartAt::From::Item) {
    out.joins = join_way(route, out.step, *stand, path, behave);
  }
  if (out.joins) out.target = route.forth.path.at(out.joins->s_m);
  return out;
}

/// The first waypoint of a start. @return false: it is driven to, as any other.
bool Executor::begin_here(const RouteStep& step, const Vehicle& vehicle) {
  if (modes_->goal_cut_m > 0.0 || course_ != &route_->forth) return false;
  const Stand stand{vehicle.at, vehicle.yaw_rad, vehicle.sigma_m};
  if (const auto where = join_way(*route_, at_, stand, *path_params_, *params_)) {
    join(*where, vehicle);
    return true;
  }
  const RouteNode& node = course_->nodes[step.node];
  const double known_m = params_->arrive_sigmas * vehicle.sigma_m;
  const bool there = base::distance_m(vehicle.at, node.at) <= std::max(node.radius_m, known_m);
  if (there && params_->join_m > 0.0) reached(step);
  return there && params_->join_m > 0.0;
}

/// What lies behind is told: as reached where the robot stands near enough, else as left out.
void Executor::join(const Joining& where, const Vehicle& vehicle) {
  for (; at_ < where.step; ++at_) {
    const RouteStep& behind = course_->steps[at_];
    const RouteNode& node = course_->nodes[behind.node];
    standing_ = behind.node;
    if (behind.silent) continue;
    const double off_m = base::distance_m(vehicle.at, node.at);
    if (off_m <= arrival_radius_m(&node, vehicle.sigma_m, *params_)) {
      notices_.push_back({Notice::Kind::ItemReached, behind.item, {}});
    } else {
      notices_.push_back({Notice::Kind::ItemMissed, behind.item,
                          "left out: the robot stood " + tenths_text(off_m) +
                              " from it and joined the way ahead"});
    }
  }
  if (path_params_->vehicle.steered()) {
    going_round_m_ = base::distance_m(vehicle.at, course_->path.at(where.s_m)) +
                     2.0 * min_radius_m(path_params_->vehicle);
  }
  doing_ = Doing::Path;
  drove_ = true;
  tracker_.begin(course_->path, course_->path.leg_from(where.s_m), where.s_m);
}

/// On its way, and along it: a vehicle that goes round crosses the way before.
bool Executor::has_joined(const Vehicle& vehicle) const noexcept {
  const Path* path = tracker_.path();
  if (path == nullptr || tracker_.leg() >= path->legs.size()) return true;
  const Leg& leg = path->legs[tracker_.leg()];
  const double way_rad =
      path->yaw_rad(leg, tracker_.s_m(), leg.first) + (leg.reverse ? base::kPi : 0.0);
  return std::abs(tracker_.cross_track_m()) < kJoined_m &&
         std::abs(base::angle_diff_rad(vehicle.yaw_rad, way_rad)) < kJoined_rad;
}

/// From so far beside it the way is followed at once, not driven to first.
double Executor::beside_m(const Vehicle& vehicle) const noexcept {
  const double most_m = kBesideOfLost * params_->lost_m;
  const double known_m = std::min(params_->arrive_sigmas * vehicle.sigma_m, most_m);
  const double least_m = path_params_->vehicle.steered() ? most_m : 0.5;
  return std::max({path_params_->track.rejoin_m, known_m, least_m});
}

/// A steered vehicle that comes beside a waypoint, from where it could not aim at it, goes on with
/// the way; what stops there, or does something, does not. @return whether it goes on.
bool Executor::passed_by(const RouteStep* step, double off_m) {
  const bool plain = step != nullptr && step->kind == StepKind::Go && !(step->seconds > 0.0) &&
                     at_ + 1 < course_->steps.size() &&
                     course_->steps[at_ + 1].kind == StepKind::Go;
  const bool may = plain && doing_ == Doing::Connector && path_params_->vehicle.steered() &&
                   off_m <= kBesideOfLost * params_->lost_m;
  if (!may) return false;
  notices_.push_back({Notice::Kind::ItemMissed, step->item, "passed at " + tenths_text(off_m)});
  doing_ = Doing::Nothing;
  pass(*step);
  return true;
}

/// How far off its way the robot may seem: in a corridor, what the position leaves of it.
double Executor::cross_track_limit_m(double sigma_m) const noexcept {
  if (!route_ || !route_->corridor_m) return params_->lost_m + going_round_m_;
  const double corridor_m = *route_->corridor_m;
  const double left_m = std::max(corridor_m - kCorridorSigmas * sigma_m, kOfCorridor * corridor_m);
  return std::min(params_->lost_m, left_m);
}

}  // namespace roverd::nav
