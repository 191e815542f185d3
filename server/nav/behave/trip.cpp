#include "nav/behave/trip.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angle.hpp"
#include "nav/behave/text.hpp"
#include "nav/track/corner.hpp"

namespace roverd::nav {
namespace {

constexpr double kNothing_m = 0.03;  ///< nearer than this there is nothing to drive

std::string centimetres(double m) {
  return std::to_string(std::lround(m * 100.0)) + " cm";
}

constexpr double kLeads = 0.7;  ///< at most of the way to its first point

}  // namespace

void Trip::reset() noexcept {
  tracker_.reset();
  rotation_.reset();
  state_ = State::Idle;
  reason_.clear();
  interrupted_ = false;
}

void Trip::begin(Order order, const Vehicle& vehicle, bool smoothly) {
  const bool moving = state_ == State::Way && tracker_.phase() == TrackPhase::Track;
  const bool same_way = !order_.way.empty() && !order.way.empty() &&
                        order_.way.front().reverse == order.way.front().reverse;
  order_ = std::move(order);
  next_ = 0;
  reason_.clear();
  interrupted_ = false;
  lay(vehicle, smoothly && moving && same_way);
}

/// The new way is joined while driving: so far it leads straight ahead first, and never beyond its
/// first point. Empty: that lies too far aside, or too near.
std::optional<double> Trip::lead_m(const Vehicle& v, const Vertex& first) const noexcept {
  if (tracker_.leg() != 0) return std::nullopt;
  const double ahead = first.reverse ? base::wrap_rad(v.yaw_rad + base::kPi) : v.yaw_rad;
  const double off = std::abs(base::angle_diff_rad(ahead, direction_rad(v.at, first.at)));
  const double most = path_params_->vehicle.steered()
                          ? base::kPi / 2.0
                          : base::rad_from_deg(path_params_->pivot.angle_deg);
  const double far_m = base::distance_m(v.at, first.at);
  const double lead_m =
      std::min(std::max(0.3, 0.6 * std::abs(v.speed_mps)), kLeads * far_m * std::cos(off));
  if (off >= most || far_m <= 2.0 * std::abs(v.speed_mps) || lead_m < kNothing_m) return {};
  return lead_m;
}

/// Where it begins, it turns on the spot if it was told to, also where it was interrupted before.
mission::Turn Trip::turn_first() const noexcept {
  const bool told =
      next_ == 0 ? order_.turns_first : order_.way[next_ - 1].turn == mission::Turn::Pivot;
  return told ? mission::Turn::Pivot : mission::Turn::Auto;
}

void Trip::lay(const Vehicle& v, bool smoothly) {
  stuck_s_ = 0.0;
  stuck_at_ = v;
  if (next_ >= order_.way.size()) return face();
  const Vertex& first = order_.way[next_];
  std::vector<Vertex> all;
  all.reserve(order_.way.size() - next_ + 2);
  all.push_back({v.at, first.speed_mps, first.reverse, false, turn_first(), 0.1});
  lead_ = 1;
  first_ = next_;
  const auto joins_m = smoothly && !order_.turns_first ? lead_m(v, first) : std::optional<double>{};
  if (joins_m) {
    const double ahead_m = first.reverse ? -*joins_m : *joins_m;
    Vertex lead = first;
    lead.at = {v.at.east_m + ahead_m * std::cos(v.yaw_rad),
               v.at.north_m + ahead_m * std::sin(v.yaw_rad)};
    lead.turn = mission::Turn::Through;
    lead.stop = false;
    lead.deviation_m = path_params_->track.through_deviation_m;
    all.push_back(lead);
    lead_ = 2;
  }
  all.insert(all.end(), order_.way.begin() + static_cast<std::ptrdiff_t>(next_), order_.way.end());
  if (all[lead_].curvature_1pm != 0.0) {  // onto the bend from wherever it stands
    all[lead_].curvature_1pm = 0.0;
    all[lead_].tangent = path_params_->vehicle.steered();
    all[lead_].stop = !all[lead_].tangent;
  }
  slot_ = 1 - slot_;
  paths_[slot_] = build_path(all, *path_params_);
  const Path& path = paths_[slot_];
  if (path.legs.empty() || path.length_m() < kNothing_m) return face();
  state_ = State::Way;
  if (joins_m) {
    tracker_.move_to(path, 0, 0.0);
  } else {
    tracker_.begin(path, 0, 0.0);
  }
}

void Trip::face() {
  if (order_.face_yaw_rad) {
    rotation_.to(*order_.face_yaw_rad, order_.turn_radps);
    state_ = State::Face;
  } else if (order_.turn_rad) {
    rotation_.by(*order_.turn_rad, order_.turn_radps);
    state_ = State::Face;
  } else {
    state_ = State::There;
  }
}

void Trip::fail(std::string why) {
  state_ = State::Failed;
  reason_ = std::move(why);
  tracker_.reset();
}

TrackOutput Trip::step(const Vehicle& v, double limit_mps, double dt_s) {
  if (interrupted_) {
    interrupted_ = false;
    if (state_ == State::Way) {
      tracker_.reset();
      lay(v, false);
    } else if (order_.turn_rad) {
      rotation_.by(rotation_.left_rad(), order_.turn_radps);
    } else {
      face();
    }
  }
  if (state_ == State::Face) {
    if (too_steep_to_turn(v, path_params_->slope)) {
      fail(steep_text(v, path_params_->slope));
      return {};
    }
    const TrackOutput out = rotation_.step(v, *path_params_, dt_s);
    if (rotation_.state() == RotateInPlace::State::Done) state_ = State::There;
    if (rotation_.state() == RotateInPlace::State::Failed)
      fail("a turn on the spot does not come to its end");
    return out;
  }
  if (state_ != State::Way) return {};
  const TrackOutput out = tracker_.step(v, limit_mps, dt_s);
  const Path& path = paths_[slot_];
  while (next_ + 1 < order_.way.size() && tracker_.s_m() >= path.vertex_m[lead_ + next_ - first_]) {
    ++next_;
  }
  if (tracker_.phase() == TrackPhase::Done) {
    if (tracker_.leg() + 1 < path.legs.size()) {
      tracker_.begin(path, tracker_.leg() + 1, path.legs[tracker_.leg() + 1].start_m);
      return out;
    }
    const double off_m = base::distance_m(v.at, path.points.back().at);
    if (off_m > order_.within_m) {
      fail("missed by " + centimetres(off_m));
    } else {
      next_ = order_.way.size();
      face();
    }
    return out;
  }
  watch(v, dt_s);
  return out;
}

bool Trip::again(std::size_t first, std::size_t points) noexcept {
  if (state_ != State::Way || next_ < first + points) return false;
  if (!interrupted_) {
    // The path may have begun behind it.
    if (next_ <= first_ + points) return false;
    const Path& path = paths_[slot_];
    const double next_m = path.vertex_m[lead_ + next_ - first_];
    const double back_m = next_m - path.vertex_m[lead_ + next_ - first_ - points];
    tracker_.move_to(path, tracker_.leg(), tracker_.s_m() - back_m);
  }
  next_ -= points;
  return true;
}

void Trip::watch(const Vehicle& v, double dt_s) {
  const TrackPhase phase = tracker_.phase();
  const bool driving = phase == TrackPhase::Track || phase == TrackPhase::Pivot;
  const bool moved = base::distance_m(v.at, stuck_at_.at) > behave_->stuck_m ||
                     std::abs(base::angle_diff_rad(stuck_at_.yaw_rad, v.yaw_rad)) >
                         base::rad_from_deg(behave_->stuck_deg);
  if (!driving || moved) {
    stuck_s_ = 0.0;
    stuck_at_ = v;
  } else {
    stuck_s_ += dt_s;
  }
  if (tracker_.too_steep()) {
    fail(steep_text(v, path_params_->slope));
  } else if (stuck_s_ > behave_->stuck_s) {
    fail("no progress for " + std::to_string(std::lround(behave_->stuck_s)) + " s");
  } else if (phase == TrackPhase::Track && std::abs(tracker_.cross_track_m()) > behave_->lost_m) {
    fail(std::to_string(std::lround(std::abs(tracker_.cross_track_m()))) + " m away from the way");
  }
}

std::optional<double> Trip::distance_left_m() const noexcept {
  if (state_ == State::Face || state_ == State::There) return 0.0;
  if (state_ != State::Way) return std::nullopt;
  return std::max(0.0, paths_[slot_].length_m() - tracker_.s_m());
}

std::optional<double> Trip::turn_left_rad() const noexcept {
  if (state_ != State::Face) return std::nullopt;
  return rotation_.left_rad();
}

}  // namespace roverd::nav
