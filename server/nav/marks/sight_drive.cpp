#include "nav/marks/sight_drive.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace roverd::nav::marks {
namespace {

/// A corner's rounding begins and ends within this of it.
constexpr double kCornerReach_m = 0.6;
constexpr double kWorthStarting_m = 0.3;

}  // namespace

bool SightDrive::in_corner() const noexcept {
  if (!path_ || state_ != State::Driving) return false;
  return std::ranges::any_of(corners_, [&](std::size_t i) {
    return i < path_->vertex_m.size() &&
           std::abs(path_->vertex_m[i] - tracker_.s_m()) < kCornerReach_m;
  });
}

bool SightDrive::take(const Way& way) {
  if (in_corner()) return false;
  auto path = std::make_shared<const Path>(build_path(way.vertices, *params_));
  const double left_m = path->legs.empty() ? 0.0 : path->legs.front().end_m - way.here_m;
  // Braking to the same end it is left alone: what is laid anew begins anew.
  const bool halting = state_ != State::Driving || tracker_.phase() == TrackPhase::Stop;
  if (path->legs.empty() || (halting && left_m < kWorthStarting_m)) {
    if (!path_) stand(way.end);
    return false;
  }
  tracker_.move_to(*path, 0, way.here_m);
  path_ = std::move(path);  // the old one lives until the tracker has left it
  corners_ = way.corners;
  end_ = way.end;
  state_ = State::Driving;
  return true;
}

/// Nothing was driven yet, and there is nothing to drive: it is at the end as if it had come there.
void SightDrive::stand(WayEnd end) noexcept {
  end_ = end;
  state_ = State::Ended;
}

TrackOutput SightDrive::step(const Vehicle& vehicle, double limit_mps, double dt_s) noexcept {
  const TrackOutput out = tracker_.step(vehicle, limit_mps, dt_s);
  if (state_ == State::Driving && tracker_.phase() == TrackPhase::Done) state_ = State::Ended;
  return out;
}

void SightDrive::reset() noexcept {
  tracker_.reset();
  path_.reset();
  corners_.clear();
  end_ = WayEnd::Horizon;
  state_ = State::Idle;
}

double SightDrive::left_m() const noexcept {
  if (!path_ || path_->legs.empty() || state_ != State::Driving) return 0.0;
  return std::max(0.0, path_->legs.front().end_m - tracker_.s_m());
}

}  // namespace roverd::nav::marks
