#include "nav/behave/row_drive.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angle.hpp"
#include "nav/behave/text.hpp"

namespace roverd::nav {
namespace {

constexpr double kPoint_m = 0.25;
constexpr double kBehind_m = 0.5;  // the way begins so far behind the robot
constexpr double kLeast_m = 0.25;  // a shorter way is none
constexpr double kThere_m = 0.08;  // nearer to the end there is nothing to drive
constexpr double kOver_m = 0.15;   // a way that leads farther beyond it is cut short
constexpr double kOnset_s = 0.2;   // until braking has begun
constexpr double kYawSigma_rad = 0.02;
constexpr double kBeside_m = 10.0;  // a place that lies farther aside is not passed

}  // namespace

void RowDrive::begin(const Order& order) noexcept {
  reset();
  order_ = order;
  driven_m_ = order.driven_m;
  state_ = State::Seeking;
}

void RowDrive::reset() noexcept {
  tracker_.reset();
  state_ = State::Idle;
  reason_.clear();
  began_.reset();
  last_.reset();
  left_m_.reset();
  laid_.reset();
  driven_m_ = waited_s_ = 0.0;
  at_end_ = goes_on_ = beside_ = false;
}

void RowDrive::interrupt() noexcept {
  // Where somebody else left the robot, the row may have to be looked for.
  if (state_ == State::Driving || state_ == State::Failed) state_ = State::Seeking;
  tracker_.reset();
  laid_.reset();
  last_.reset();
  began_.reset();
  goes_on_ = false;
  waited_s_ = 0.0;
}

void RowDrive::fail(std::string why) {
  tracker_.reset();
  state_ = State::Failed;
  reason_ = std::move(why);
}

bool RowDrive::usable(const RowSight& sight) const noexcept {
  return sight.view != nullptr && sight.age_s <= params_->old_s;
}

/// Enough to lay a way along it.
bool RowDrive::sure(const rows::RowView& view, const rows::Along& at) const noexcept {
  return std::max(view.sigma_m(at.s_m), view.sigma_m(at.s_m + kLeast_m)) <= params_->unsure_m;
}

double RowDrive::certainty(double sigma_m) const noexcept {
  const double span_m = std::max(1e-3, params_->unsure_m - params_->sure_m);
  return std::clamp((params_->unsure_m - sigma_m) / span_m, 0.0, 1.0);
}

/// Full where the row is sure, creeping where it hardly is.
double RowDrive::wanted_mps(const rows::RowView& view, double s_m) const noexcept {
  const RowDriveParams& p = *params_;
  const double full_mps =
      std::min(order_.speed_mps.value_or(p.speed_mps), path_params_->speed.max_mps);
  const double part = certainty(view.sigma_m(s_m + kLook_m));
  return std::max(std::min(p.creep_mps, full_mps), part * full_mps);
}

/// The arc from begin to end of a line; at_m is where on it the robot is.
void RowDrive::lay(const rows::Pose2& from, double curvature_1pm, double begin_m, double end_m,
                   double speed_mps, double at_m) {
  Path& path = paths_[1 - slot_];
  path.points.clear();
  path.legs.clear();
  const double length_m = end_m - begin_m;
  const auto pieces = std::clamp<std::size_t>(
      static_cast<std::size_t>(std::ceil(length_m / kPoint_m)), 1, kMostPoints - 1);
  for (std::size_t i = 0; i <= pieces; ++i) {
    const double s_m = length_m * double(i) / double(pieces);
    const rows::Pose2 at = from * rows::on_arc(begin_m + s_m, curvature_1pm);
    PathPoint point;
    point.at = {at.x_m, at.y_m};
    point.s_m = s_m;
    point.curvature_1pm = curvature_1pm;
    point.segment_mps = point.plan_mps = speed_mps;
    point.speed_mps = i == pieces ? 0.0 : speed_mps;
    path.points.push_back(point);
  }
  Leg leg;
  leg.last = pieces;
  leg.end_m = length_m;
  leg.align_rad = base::rad_from_deg(path_params_->pivot.angle_deg);
  path.legs.push_back(leg);
  slot_ = 1 - slot_;
  line_ = from;
  curvature_1pm_ = curvature_1pm;
  goes_on_ = true;
  tracker_.move_to(path, 0, at_m - begin_m);
}

void RowDrive::seek(const RowSight& sight) {
  if (began_) return;
  began_ = sight.body;
  at_end_ = false;
  lay(sight.body, 0.0, 0.0, std::max(kLeast_m, params_->entry_m), params_->creep_mps, 0.0);
}

/// The way along the line as far as it is known, or to where the item ends.
void RowDrive::follow(const RowSight& sight, const rows::Along& at, const Vehicle& v) {
  const rows::RowView& view = *sight.view;
  double end_m = at.s_m + params_->horizon_m;
  for (double s = at.s_m; s < end_m; s += kPoint_m) {
    if (view.sigma_m(s) > params_->unsure_m) end_m = s;
  }
  std::optional<double> last_m = view.to_end_m;
  const auto nearer = [&](double s_m) { last_m = last_m ? std::min(*last_m, s_m) : s_m; };
  if (order_.distance_m) nearer(at.s_m + std::max(0.0, *order_.distance_m - driven_m_));
  if (order_.place) {
    const rows::Pose2 in_line = sense::inverse(view.line) * *order_.place;
    const rows::Along beside = rows::beside_arc(in_line.x_m, in_line.y_m, view.curvature_1pm);
    if (std::abs(beside.d_m) <= kBeside_m) nearer(beside.s_m);
  }
  left_m_.reset();
  if (last_m) left_m_ = std::max(0.0, *last_m - at.s_m);
  const bool ends = last_m && *last_m <= end_m;
  if (ends) end_m = *last_m;
  const TrackPhase phase = tracker_.phase();
  const bool there = ends && end_m - at.s_m < kThere_m;
  if (there && (phase == TrackPhase::Track || phase == TrackPhase::Stop)) {
    // Braking to the end of the item, it is left alone: what is laid anew begins anew.
    const bool over = paths_[slot_].length_m() - tracker_.s_m() > kOver_m;
    if (over) brake(sight, v);
    at_end_ = true;
    return;
  }
  if (there) {
    state_ = State::Done;
    return;
  }
  if (laid_ == view.stamp && phase != TrackPhase::Done) return;
  laid_ = view.stamp;
  if (!ends && end_m - at.s_m < kLeast_m) return brake(sight, v);
  began_.reset();
  at_end_ = ends;
  lay(view.line, view.curvature_1pm, at.s_m - kBehind_m, std::max(end_m, at.s_m + 0.01),
      wanted_mps(view, at.s_m), at.s_m);
}

/// What was seen is too old or too vague, or the end is here: to a stop along the way in hand, at
/// once. Told again while it brakes, it goes on braking: a way laid anew would end later.
void RowDrive::brake(const RowSight& sight, const Vehicle& v) {
  if (!goes_on_) return;
  at_end_ = false;
  const rows::Pose2 in_line = sense::inverse(line_) * sight.body;
  const double s_m = rows::beside_arc(in_line.x_m, in_line.y_m, curvature_1pm_).s_m;
  const double speed_mps = std::abs(v.speed_mps);
  const double way_m = speed_mps * (path_params_->track.delay_s + kOnset_s) +
                       speed_mps * speed_mps / (2.0 * path_params_->speed.decel_mps2);
  lay(line_, curvature_1pm_, s_m - kBehind_m, s_m + way_m + 0.02,
      std::max(speed_mps, params_->creep_mps), s_m);
  goes_on_ = false;
}

TrackOutput RowDrive::step(const RowSight& sight, const Vehicle& vehicle, double limit_mps,
                           double dt_s) {
  if (state_ != State::Seeking && state_ != State::Driving) return {};
  Vehicle v = vehicle;
  v.at = {sight.body.x_m, sight.body.y_m};
  v.yaw_rad = sight.body.yaw_rad;
  v.yaw_sigma_rad = std::min(v.yaw_sigma_rad, kYawSigma_rad);
  v.slide = {};
  v.crab = sight.view != nullptr ? -sight.view->drift : 0.0;  // what O knows of it
  const bool sees = usable(sight);
  const rows::Along at = sees ? rows::beside_line(*sight.view, sight.body) : rows::Along{};
  if (sees && state_ == State::Seeking && sure(*sight.view, at)) state_ = State::Driving;
  // Rays are never as sure as a line; what they tell is what is driven by.
  beside_ = sees && sight.view->sigma_m(at.s_m) <=
                        (sight.view->by_rays ? params_->unsure_m : params_->sure_m);
  if (state_ == State::Seeking) {
    seek(sight);
  } else if (sees) {
    if (last_) {
      const rows::Pose2 before = sense::inverse(sight.view->line) * *last_;
      driven_m_ += at.s_m - rows::beside_arc(before.x_m, before.y_m, sight.view->curvature_1pm).s_m;
    }
    follow(sight, at, v);
  } else {
    brake(sight, v);
  }
  last_ = sight.body;
  if (state_ == State::Done) return {};
  const TrackOutput out = tracker_.step(v, limit_mps, dt_s);
  if (tracker_.phase() == TrackPhase::Done) {
    if (at_end_) state_ = State::Done;
    if (state_ == State::Seeking && !sees) {
      fail("no row is seen within " + tenths_text(params_->entry_m));
    }
  }
  const bool done = tracker_.phase() == TrackPhase::Done;
  const bool waits = state_ == State::Driving ? !sees || done : state_ == State::Seeking && done;
  waited_s_ = waits ? waited_s_ + dt_s : 0.0;
  if (waited_s_ > params_->wait_s) {
    fail(sees ? "the row is not seen surely enough" : "the row is lost");
  }
  return out;
}

}  // namespace roverd::nav
