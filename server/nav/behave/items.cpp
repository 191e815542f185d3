// The executor's items beside waypoints, and goals that are cut.

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angle.hpp"
#include "nav/behave/executor.hpp"
#include "nav/behave/text.hpp"
#include "nav/track/corner.hpp"

namespace roverd::nav {
namespace {

/// Over the few metres between two rows.
constexpr double kCarriedSigma_m = 0.05;
constexpr double kCarriedSigma_rad = 0.02;
constexpr double kUntilSigma_m = 1.0;     // a vaguer place is not ended beside
constexpr double kUntilSigma_rad = 0.35;  // likewise
constexpr double kMostPassed = 1e6;       // of what a kept place says
/// It counts from where the robot stands: that its place is vague is no reason to leave it out.
constexpr double kLeastMove_m = 0.05;

/// It counts from where the robot is and points.
bool relative(const RouteStep& step) noexcept {
  return step.kind == StepKind::Move || step.kind == StepKind::Wait || step.kind == StepKind::Act ||
         (step.kind == StepKind::Turn && !step.yaw_rad);
}

double length_of_move_m(const RouteStep& step) noexcept {
  if (step.kind == StepKind::Turn) return std::abs(step.by) * step.radius_m;
  return step.kind == StepKind::Move ? std::abs(step.by) : 0.0;
}

/// Over relative steps alone. @param across_m grows by the moves, that of the step `at` left out
bool leads_to_row(const Course& course, std::size_t at, bool forward, double& across_m) noexcept {
  for (std::size_t i = at; forward ? i + 1 < course.steps.size() : i > 0;) {
    i = forward ? i + 1 : i - 1;
    const RouteStep& s = course.steps[i];
    if (s.kind == StepKind::Row) return true;
    if (!relative(s)) return false;
    across_m += length_of_move_m(s);
  }
  return false;
}

}  // namespace

bool asks_no_place(const Course& course, std::size_t step) noexcept {
  if (step >= course.steps.size()) return false;
  const RouteStep& s = course.steps[step];
  if (s.by_sight()) return true;
  if (!relative(s)) return false;
  double across_m = length_of_move_m(s);
  const bool from_row = leads_to_row(course, step, false, across_m);
  const bool to_row = leads_to_row(course, step, true, across_m);
  return (from_row || to_row) && across_m <= Executor::kAcross_m;
}

/// Straight on from where the robot is and points.
bool Executor::enter_move(const RouteStep& step, const Vehicle& vehicle) {
  const double way_m = left_ != 0.0 ? left_ : step.by;
  left_ = 0.0;
  standing_.reset();
  Vertex end;
  end.at = {vehicle.at.east_m + way_m * std::cos(vehicle.yaw_rad),
            vehicle.at.north_m + way_m * std::sin(vehicle.yaw_rad)};
  end.reverse = way_m < 0.0;
  end.speed_mps = end.reverse ? modes_->move_back_mps : modes_->move_mps;
  carry(vehicle);
  if (lay_connector(end, vehicle, kLeastMove_m)) return true;
  reached(step);
  return false;
}

bool Executor::enter_turn(const RouteStep& step, const Vehicle& vehicle) {
  carry(vehicle);
  if (step.moves_on()) return enter_arc(step, vehicle);
  const double rate_radps =
      step.kind == StepKind::Turn ? modes_->turn_radps : path_params_->pivot.max_rate_radps;
  if (step.yaw_rad) {
    rotation_.to(*step.yaw_rad, rate_radps);
  } else {
    rotation_.by(left_ != 0.0 ? left_ : step.by, rate_radps);
  }
  left_ = 0.0;
  drove_ = true;
  doing_ = Doing::Turn;
  return true;
}

TrackOutput Executor::step_turn(const Vehicle& vehicle, double dt_s) {
  if (too_steep_to_turn(vehicle, path_params_->slope)) {
    block(steep_text(vehicle, path_params_->slope));
    return {};
  }
  const TrackOutput out = rotation_.step(vehicle, *path_params_, dt_s);
  if (rotation_.state() == RotateInPlace::State::Failed)
    block("a turn on the spot does not come to its end");
  if (rotation_.state() == RotateInPlace::State::Done) {
    doing_ = Doing::Nothing;
    reached(*step_now());
  }
  return out;
}

/// Where the map's frame lies in that of the odometry now: from here on the latter counts.
void Executor::carry(const Vehicle& vehicle) noexcept {
  carry_.reset();
  if (!row_sight_ || !asks_no_place()) return;
  carry_ = rows::Pose2{vehicle.at.east_m, vehicle.at.north_m, vehicle.yaw_rad} *
           sense::inverse(row_sight_->body);
}

/// The way in hand lies in the frame that the odometry carries, not in the map's.
bool Executor::by_odometry() const noexcept {
  const bool moves = doing_ == Doing::Connector || doing_ == Doing::Arc || doing_ == Doing::Turn;
  return carry_ && row_sight_ && moves && asks_no_place();
}

/// The vehicle where the odometry has carried it; empty: where it is said to be.
std::optional<Vehicle> Executor::carried(const Vehicle& vehicle) const noexcept {
  if (!by_odometry()) return std::nullopt;
  const rows::Pose2 at = *carry_ * row_sight_->body;
  Vehicle out = vehicle;
  out.at = {at.x_m, at.y_m};
  out.yaw_rad = at.yaw_rad;
  out.yaw_sigma_rad = std::min(vehicle.yaw_sigma_rad, kCarriedSigma_rad);
  out.sigma_m = std::min(vehicle.sigma_m, kCarriedSigma_m);
  out.slide = {};
  return out;
}

const RowToDrive* Executor::row_order() const noexcept {
  const RouteStep* step = step_now();
  return step != nullptr && step->row ? &*step->row : nullptr;
}

bool Executor::asks_no_place() const noexcept {
  return running() && nav::asks_no_place(*course_, at_);
}

std::optional<RowWanted> Executor::row_wanted() const noexcept {
  const RouteStep* step = step_now();
  if (!running() || doing_ != Doing::Row || step == nullptr || !step->row) return std::nullopt;
  return RowWanted{rows_begun_, step->row->order};
}

/// Where a place of the map lies in O now. Empty: the position is too vague to say so; what was
/// told before is carried on by the odometry.
std::optional<rows::Pose2> Executor::until_in_odometry(EnuPoint place, const Vehicle& vehicle,
                                                       const rows::Pose2& body) const noexcept {
  if (!(vehicle.sigma_m <= kUntilSigma_m) || !(vehicle.yaw_sigma_rad <= kUntilSigma_rad)) {
    return std::nullopt;
  }
  const rows::Pose2 at{vehicle.at.east_m, vehicle.at.north_m, vehicle.yaw_rad};
  return body * (sense::inverse(at) * rows::Pose2{place.east_m, place.north_m, 0.0});
}

/// Along what is seen, from where the robot stands. After a restart so much of it is done.
bool Executor::enter_row(const RouteStep& step) {
  RowDrive::Order order;
  order.speed_mps = step.row->speed_mps;
  order.distance_m = step.row->distance_m;
  order.driven_m = left_;
  left_ = 0.0;
  standing_.reset();
  drove_ = true;
  doing_ = Doing::Row;
  ++rows_begun_;
  row_left_ = false;
  row_.begin(order);
  return true;
}

TrackOutput Executor::step_row(const Vehicle& vehicle, double limit_mps, double dt_s) {
  if (!row_sight_) {
    block("nothing on this robot sees rows");
    return {};
  }
  if (const auto& until = step_now()->row->until) {
    const auto beside = until_in_odometry(*until, vehicle, row_sight_->body);
    if (beside) row_.end_beside(*beside);
  }
  const TrackOutput out = row_.step(*row_sight_, vehicle, limit_mps, dt_s);
  if (row_.state() == RowDrive::State::Failed) {
    std::string why = row_.reason();
    block("item " + std::to_string(step_now()->item) + ": " + why);
  } else if (row_.state() == RowDrive::State::Done) {
    doing_ = Doing::Nothing;
    reached(*step_now());
  }
  return out;
}

/// Likewise along a wall.
bool Executor::enter_wall(const RouteStep& step) {
  const WallToDrive& wall = *step.wall;
  wall_.begin({{wall.side, wall.distance_m, wall.speed_mps, wall.length_m, wall.by, left_},
               wall.landmarks_first});
  left_ = 0.0;
  standing_.reset();
  drove_ = true;
  doing_ = Doing::Wall;
  return true;
}

TrackOutput Executor::step_wall(const Vehicle& vehicle, double limit_mps, double dt_s) {
  if (!mark_sight_) {
    block("nothing on this robot sees walls");
    return {};
  }
  if (const auto& until = step_now()->wall->until) {
    const auto beside = until_in_odometry(*until, vehicle, mark_sight_->body);
    if (beside) wall_.end_beside({beside->x_m, beside->y_m});
  }
  const TrackOutput out = wall_.step(*mark_sight_, vehicle, limit_mps, dt_s);
  if (wall_.state() == AlongWall::State::Failed) {
    std::string why = wall_.reason();
    block("item " + std::to_string(step_now()->item) + ": " + why);
  } else if (wall_.state() == AlongWall::State::Done) {
    doing_ = Doing::Nothing;
    reached(*step_now());
  }
  return out;
}

/// Likewise past landmarks; after a restart so many are behind.
bool Executor::enter_landmarks(const RouteStep& step) {
  const LandmarksToPass& pass = *step.landmarks;
  LandmarkDrive::Order order;
  order.side = pass.side;
  order.offset_m = pass.offset_m;
  order.name = pass.name;
  order.speed_mps = pass.speed_mps;
  order.count = pass.count;
  order.by = pass.by;
  order.passed = static_cast<int>(std::clamp(left_, 0.0, kMostPassed));
  left_ = 0.0;
  standing_.reset();
  tracker_.reset();  // a turn before it says nothing of getting on here
  drove_ = true;
  doing_ = Doing::Landmarks;
  landmarks_.begin(std::move(order));
  return true;
}

TrackOutput Executor::step_landmarks(const Vehicle& vehicle, double limit_mps, double dt_s) {
  if (!mark_sight_) {
    block("nothing on this robot sees landmarks");
    return {};
  }
  const TrackOutput out = landmarks_.step(*mark_sight_, vehicle, limit_mps, dt_s);
  if (landmarks_.state() == LandmarkDrive::State::Failed) {
    std::string why = landmarks_.reason();
    block("item " + std::to_string(step_now()->item) + ": " + why);
    return out;
  }
  if (landmarks_.state() == LandmarkDrive::State::Done) {
    doing_ = Doing::Nothing;
    reached(*step_now());
    return out;
  }
  // Wedged at one its tracks would pull for ever; while it stands and waits it is not to move.
  if (out.command == base::BodyTwist{}) {
    stuck_s_ = 0.0;
  } else {
    watch_stuck(nav::by_odometry(*mark_sight_, vehicle), dt_s);
  }
  return out;
}

/// Likewise to a tag; after a restart from where it stands.
bool Executor::enter_dock(const RouteStep& step) {
  standing_.reset();
  tracker_.reset();
  drove_ = true;
  doing_ = Doing::Dock;
  dock_.begin({step.dock->tag, step.dock->stand_off_m},
              mark_sight_ ? mark_sight_->now : base::Time{});
  return true;
}

TrackOutput Executor::step_dock(const Vehicle& vehicle, double limit_mps, double dt_s) {
  if (!mark_sight_ || mark_sight_->tags == nullptr) {
    block("no camera on this robot reads tags");
    return {};
  }
  const TrackOutput out = dock_.step({mark_sight_->tags, mark_sight_->now, mark_sight_->body},
                                     vehicle, limit_mps, dt_s);
  if (dock_.state() == tags::TagDock::State::Failed) {
    block("item " + std::to_string(step_now()->item) + ": not docked at tag " +
          std::to_string(dock_.tag()) + ": " + dock_.reason());
  } else if (dock_.state() == tags::TagDock::State::Docked) {
    doing_ = Doing::Nothing;
    reached(*step_now());
  }
  return out;
}

/// Begun anew, or with what is left after a restart.
bool Executor::enter_stay(const RouteStep& step, const Vehicle& vehicle) {
  stays_ = step.place.value_or(vehicle.at);
  if (!(wait_s_ > 0.0)) wait_s_ = step.seconds;
  doing_ = Doing::Stay;
  return true;
}

bool Executor::pushed_away(const RouteStep& step, const Vehicle& vehicle) const noexcept {
  const double off_m = base::distance_m(vehicle.at, *stays_);
  return off_m > std::max(step.within_m, params_->arrive_sigmas * vehicle.sigma_m);
}

bool Executor::stands(const Vehicle& vehicle, double dt_s) const noexcept {
  const RouteStep* step = step_now();
  if (!running() || step == nullptr) return false;
  if (doing_ == Doing::Wait) return wait_s_ > dt_s;
  if (doing_ == Doing::Stay) {
    return (step->endless || wait_s_ > dt_s) && !pushed_away(*step, vehicle);
  }
  return doing_ == Doing::Nothing && step->kind == StepKind::Wait && step->seconds > dt_s;
}

/// Its time goes on while it drives back. Pushed away, it drives to where it stood: backwards, if
/// that is shorter than to turn round.
void Executor::step_stay(const Vehicle& vehicle) {
  const RouteStep& step = *step_now();
  if (pushed_away(step, vehicle)) {
    const EnuPoint place = *stays_;
    const double bearing_rad =
        base::angle_diff_rad(vehicle.yaw_rad, direction_rad(vehicle.at, place));
    Vertex end;
    end.at = place;
    end.reverse = std::abs(bearing_rad) > base::kPi / 2.0;
    end.speed_mps = route_->speed_mps;
    standing_.reset();
    if (lay_connector(end, vehicle)) return;
    doing_ = Doing::Stay;
  }
  if (step.endless || wait_s_ > 0.0) return;
  doing_ = Doing::Nothing;
  tracker_.reset();  // it is done with the way here, not with the next one
  reached(step);
}

/// Where the parameters ask for it, only so far towards a place.
EnuPoint Executor::cut(EnuPoint to, EnuPoint here) const noexcept {
  const double far_m = base::distance_m(here, to);
  if (modes_->goal_cut_m <= 0.0 || far_m <= modes_->goal_cut_m) return to;
  const double part = modes_->goal_cut_m / far_m;
  return {here.east_m + part * (to.east_m - here.east_m),
          here.north_m + part * (to.north_m - here.north_m)};
}

/// Looks at a cut goal anew. @return true: it counts as reached, and something else begins.
bool Executor::cut_goal(const Vehicle& vehicle, double dt_s) {
  const RouteStep* step = step_now();
  const bool cuts = modes_->goal_cut_m > 0.0 && doing_ == Doing::Connector && !rejoin_ &&
                    step != nullptr && step->kind == StepKind::Go;
  if (!cuts) return false;
  const RouteNode& node = course_->nodes[step->node];
  if (base::distance_m(vehicle.at, node.at) <= std::max(node.radius_m, modes_->goal_within_m)) {
    doing_ = Doing::Nothing;
    tracker_.reset();
    reached(*step);
    return true;
  }
  looked_s_ += dt_s;
  const bool whole = base::distance_m(connector_end_.at, node.at) < 0.01;
  const bool due = looked_s_ >= modes_->goal_cut_s || tracker_.phase() == TrackPhase::Done;
  if (whole || !due) return false;
  looked_s_ = 0.0;
  Vertex end = connector_end_;
  end.at = cut(node.at, vehicle.at);
  const Vertex both[] = {{vehicle.at, end.speed_mps, end.reverse, false, mission::Turn::Auto, 0.1},
                         end};
  connector_ = build_path(both, *path_params_);
  connector_end_ = end;
  tracker_.move_to(connector_, 0, 0.0);
  return false;
}

}  // namespace roverd::nav
