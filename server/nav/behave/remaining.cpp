// How much of a mission is left.

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "base/angle.hpp"
#include "nav/behave/executor.hpp"
#include "nav/track/corner.hpp"

namespace roverd::nav {
namespace {

constexpr double kAhead_m = 0.2;  // to see where a way leads
constexpr double kStands_s = 1.5;

/// What turning on the spot takes between one direction and another.
double turn_s(double from_rad, double to_rad, const PathParams& params) noexcept {
  const double turn_rad = std::abs(base::angle_diff_rad(from_rad, to_rad));
  const bool pivots =
      !params.vehicle.steered() && turn_rad > base::rad_from_deg(params.pivot.angle_deg);
  return pivots ? turn_rad / params.pivot.max_rate_radps + kStands_s : 0.0;
}

double yaw_from(const Path& path, double s_m) noexcept {
  return direction_rad(path.at(s_m), path.at(s_m + kAhead_m));
}

double yaw_to(const Path& path, double s_m) noexcept {
  return direction_rad(path.at(s_m - kAhead_m), path.at(s_m));
}

}  // namespace

/// Laps after this one; none of a mission that repeats for ever.
Executor::Left Executor::laps_left() const noexcept {
  const Course& course = *course_;
  if (route_->times <= laps_ + 1 || course.nodes.empty()) return {};
  const double laps = route_->times - laps_ - 1;
  Left lap{course.path.length_m(), course.path.left_s(0.0) + course.pauses_s.front()};
  if (route_->at_end == mission::AtEnd::Repeat) {
    const double back_m = base::distance_m(course.nodes.back().at, course.nodes.front().at);
    lap.m += back_m;
    lap.s += back_m / std::max(0.1, route_->speed_mps);
    const double back_rad = direction_rad(course.nodes.back().at, course.nodes.front().at);
    lap.s += turn_s(yaw_to(course.path, course.path.length_m()), back_rad, *path_params_) +
             turn_s(back_rad, yaw_from(course.path, 0.0), *path_params_);
  }
  return {laps * lap.m, laps * lap.s};
}

/// Of this lap; empty where it is not known yet.
std::optional<Executor::Left> Executor::left(const RouteStep& step,
                                             std::optional<EnuPoint> here) const noexcept {
  const Path& path = course_->path;
  const auto from = [&path](double s_m) { return Left{path.length_m() - s_m, path.left_s(s_m)}; };
  const double by_mps = std::max(0.1, route_->speed_mps);  // where no speed is planned
  if (doing_ == Doing::Path) {
    if (tracker_.path() == &path) return from(tracker_.s_m());
    Left all = from(s_m_);
    // It waits, and was moved meanwhile: back to the way first.
    const double off_m = here ? base::distance_m(*here, path.at(s_m_)) : 0.0;
    if (off_m > path_params_->track.rejoin_m) all = {all.m + off_m, all.s + off_m / by_mps};
    return all;
  }
  if (on_own_way()) {
    const bool drives = tracker_.path() == &connector_;
    if (connector_.points.empty() || (!drives && !here)) return std::nullopt;
    // One that waits begins anew where the robot stands then.
    const double length_m = connector_.length_m();
    const double left_m =
        drives ? length_m - tracker_.s_m() : base::distance_m(*here, connector_.points.back().at);
    const double more_m = std::max(0.0, left_m - length_m);
    Left all{left_m, connector_.left_s(std::max(0.0, length_m - left_m)) + more_m / by_mps};
    if (!rejoin_ && step.kind != StepKind::Go) return all;
    const double joins_m = rejoin_ ? s_m_ : path.vertex_m[step.node];
    const Left rest = from(joins_m);
    all.m += rest.m;
    all.s += rest.s;
    if (rest.m > kAhead_m) {
      all.s +=
          turn_s(yaw_to(connector_, connector_.length_m()), yaw_from(path, joins_m), *path_params_);
    }
    return all;
  }
  const bool rests = doing_ == Doing::Wait || step.kind == StepKind::Stay;
  if (rests && standing_) return from(path.vertex_m[*standing_]);
  if (step.kind != StepKind::Go || !here) return std::nullopt;
  // Not on its way yet: straight to the waypoint first.
  const double there_m = base::distance_m(*here, course_->nodes[step.node].at);
  const Left rest = from(path.vertex_m[step.node]);
  return Left{rest.m + there_m, rest.s + there_m / by_mps};
}

/// An item of several places, such as a circle, is reached at the last of them that counts.
void Executor::tell_item_end(Progress& p, std::optional<EnuPoint> here) const noexcept {
  p.item_end = p.target;
  const auto& steps = course_->steps;
  const int item = steps[at_].item;
  std::optional<std::size_t> next;  // nodes
  std::optional<std::size_t> end;
  for (std::size_t i = at_; i < steps.size() && steps[i].item == item; ++i) {
    const bool goes = steps[i].kind == StepKind::Go;
    if (goes && !next) next = steps[i].node;
    if (goes) end = steps[i].node;
    if (!steps[i].silent && end) break;
  }
  const bool several = end && (*end != *next || steps[at_].kind != StepKind::Go);
  if (!several || stays_) return;
  const Path& path = course_->path;
  p.item_end = course_->nodes[*end].at;
  const double rest_m = path.vertex_m[*end] - path.vertex_m[*next];
  std::optional<double> to_next_m;
  if (doing_ == Doing::Path && tracker_.path() == &path) {
    to_next_m = path.vertex_m[*next] - tracker_.s_m();
  } else if (here) {
    to_next_m = base::distance_m(*here, course_->nodes[*next].at);
  }
  if (to_next_m) p.way_to_item_end_m = std::max(0.0, *to_next_m + rest_m);
}

std::optional<base::Lead> Executor::lead() const noexcept {
  if (!running()) return std::nullopt;
  const auto told = [](std::string_view what, ToldBy by, marks::By asked) {
    return base::Lead{what, by.scan, by.vision, marks::to_string(asked)};
  };
  const base::Time now = mark_sight_ ? mark_sight_->now : base::Time{};
  switch (doing_) {
    case Doing::Row:
      return base::Lead{.what = "row", .scan = row_.state() == RowDrive::State::Driving};
    case Doing::Wall:
      return told(wall_.passes() ? "landmarks" : "wall", wall_.told_by(now), wall_.by());
    case Doing::Landmarks:
      return told("landmarks", landmarks_.told_by(), landmarks_.by());
    case Doing::Dock:
      return base::Lead{.what = "tag", .vision = dock_.state() != tags::TagDock::State::Search};
    default:
      return std::nullopt;
  }
}

Progress Executor::progress(std::optional<EnuPoint> here, double sigma_m) const {
  Progress p;
  const RouteStep* step = step_now();
  if (step == nullptr || state_ == base::ExecutionState::Idle ||
      state_ == base::ExecutionState::Finished) {
    return p;
  }
  if (state_ != base::ExecutionState::Loaded) p.current_item = step->item;
  if (step->kind == StepKind::Go) p.target = course_->nodes[step->node].at;
  if (here && in_hand() && step->kind == StepKind::Go) {
    p.arrival_radius_m = arrival_radius_m(&course_->nodes[step->node], sigma_m, *params_);
  }
  if (here && in_hand()) p.cross_track_limit_m = cross_track_limit_m(sigma_m);
  if (stays_) p.target = stays_;
  if (step->kind != StepKind::Go && on_own_way()) {
    p.target = connector_.points.back().at;
  }
  tell_item_end(p, here);
  const bool tracking = (doing_ == Doing::Path && tracker_.path() == &course_->path) ||
                        (on_own_way() && tracker_.path() == &connector_);
  if (running() && tracking) p.cross_track_m = tracker_.cross_track_m();
  // Where it only looks for one, there is no line to be beside of.
  const auto beside = [&](Doing doing, const auto& drive) {
    using State = std::decay_t<decltype(drive.state())>;
    if (running() && doing_ == doing && drive.state() == State::Driving)
      p.cross_track_m = drive.cross_track_m();
  };
  beside(Doing::Row, row_);
  beside(Doing::Wall, wall_);
  beside(Doing::Landmarks, landmarks_);
  p.lead = lead();
  if (const auto lap = left(*step, here)) {
    const Left more = laps_left();
    const bool waits = doing_ == Doing::Wait || (stays_ && !step->endless);
    const double pauses_s = course_->pauses_s[at_ + (waits ? 1 : 0)] + (waits ? wait_s_ : 0.0);
    p.distance_left_m = std::max(0.0, lap->m) + more.m;
    const double eta_s = std::max(0.0, lap->s) + pauses_s + more.s;
    if (std::isfinite(eta_s)) p.eta_s = eta_s;
  }
  return p;
}

}  // namespace roverd::nav
