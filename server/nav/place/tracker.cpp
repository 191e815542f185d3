#include "nav/place/tracker.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/LU>

#include "base/angle.hpp"

namespace roverd::nav::place {

namespace {

using Eigen::Matrix3d;

constexpr double kSame_m = 0.4;  // nearer to each other are no rivals
constexpr double kSame_rad = 0.2;
constexpr double kDepthAtFirst_m = 0.02;
constexpr double kDepthDrift_m = 0.0005;  // a scan; other walls, other materials
constexpr double kDepthSurest_m = 0.003;
constexpr double kMostDoubt = 8.0;

bool finite(const Pose2& p) noexcept {
  return std::isfinite(p.x_m) && std::isfinite(p.y_m) && std::isfinite(p.yaw_rad);
}

/// Turns the x and y of a covariance.
Matrix3d turned_by(const Matrix3d& covariance, double yaw_rad) {
  Matrix3d r = Matrix3d::Identity();
  r(0, 0) = r(1, 1) = std::cos(yaw_rad);
  r(1, 0) = std::sin(yaw_rad);
  r(0, 1) = -r(1, 0);
  return r * covariance * r.transpose();
}

}  // namespace

std::string_view to_string(Phase p) noexcept {
  switch (p) {
    case Phase::Searching:
      return "searching";
    case Phase::Tracking:
      return "tracking";
    case Phase::Doubtful:
      return "doubtful";
    case Phase::Lost:
      return "lost";
  }
  return "lost";
}

std::string_view misfit(const Agreement& a, const TrackerParams& p) noexcept {
  if (a.hits < p.least_hits) return "too little to see";
  if (a.crossed > p.most_crossed) return "the scanner sees through walls of the map";
  if (a.explained < p.least_explained) return "what the scanner sees is not in the map";
  return {};
}

Tracker::Tracker(std::shared_ptr<const Field> field, const TrackerParams& params)
    : field_(std::move(field)),
      p_(params),
      start_(params.start),
      depth_deviation_m_(kDepthAtFirst_m) {}

void Tracker::set_pose(const Pose2& in_map, double deviation_m, double deviation_rad) {
  if (!finite(in_map)) return;
  begin_at(in_map, deviation_m, deviation_rad);
  suggested_.reset();
  last_stamp_.reset();
  start_.clear();
  ++resets_;
}

void Tracker::suggest(const Pose2& in_map, double deviation_m, double deviation_rad) {
  if (!finite(in_map) || !searches()) return;
  suggested_ = Suggested{in_map, deviation_m, deviation_rad};
}

void Reckoned::begin(const Pose2& at, double deviation_m, double deviation_rad) noexcept {
  const double place = std::clamp(deviation_m, 0.05, 1.0);
  const double turn = std::clamp(deviation_rad, 0.02, base::kPi / 3.0);
  pose = at;
  covariance = Matrix3d::Zero();
  covariance.diagonal() << place * place, place * place, turn * turn;
  bad_m = 0.0;
  bad_scans = 0;
}

void Reckoned::go(const Pose2& step, const TrackerParams& p) {
  const double way = std::hypot(step.x_m, step.y_m);
  const double c = std::cos(pose.yaw_rad);
  const double s = std::sin(pose.yaw_rad);
  Matrix3d f = Matrix3d::Identity();
  f(0, 2) = -s * step.x_m - c * step.y_m;
  f(1, 2) = c * step.x_m - s * step.y_m;
  const double slip = p.slip_m + p.slip_share * way;
  const double turn = p.turn_rad + p.turn_share * std::abs(step.yaw_rad) + p.turn_per_m_rad * way;
  covariance = f * covariance * f.transpose();
  covariance(0, 0) += slip * slip;
  covariance(1, 1) += slip * slip;
  covariance(2, 2) += turn * turn;
  pose = pose * step;
}

Phase Reckoned::bad(const Pose2& step, const TrackerParams& p) noexcept {
  bad_m += std::hypot(step.x_m, step.y_m);
  ++bad_scans;
  const bool lost = bad_m >= p.lost_after_m && bad_scans >= p.lost_after;
  return lost ? Phase::Lost : Phase::Doubtful;
}

void Reckoned::good(const Pose2& step, const TrackerParams& p) noexcept {
  bad_m = std::max(0.0, bad_m - p.made_up * std::hypot(step.x_m, step.y_m));
  if (bad_m == 0.0) bad_scans = 0;
}

void Tracker::begin_at(const Pose2& in_map, double deviation_m, double deviation_rad) {
  now_.begin(inverse(field_->shape().origin) * in_map, deviation_m, deviation_rad);
  phase_ = Phase::Tracking;
  told_ = true;
  fitted_ = false;
  held_m_ = 0.0;
}

void Tracker::forget() {
  suggested_.reset();
  phase_ = Phase::Searching;
  told_ = fitted_ = false;
  last_stamp_.reset();
  start_.clear();
}

Told Tracker::feed(const chart::Scan& scan, const Pose2& odometry) {
  Told told;
  told.stamp = scan.stamp;
  if (!finite(odometry) || (last_stamp_ && scan.stamp <= *last_stamp_)) {
    told.reason = "not newer than the scan before, or without odometry";
    return answer(std::move(told));
  }
  const Pose2 step = last_stamp_ ? inverse(last_odometry_) * odometry : Pose2{};
  last_stamp_ = scan.stamp;
  last_odometry_ = odometry;
  if (phase_ == Phase::Tracking || phase_ == Phase::Doubtful) {
    track(scan, step, told);
  } else if (!suggested_ || !tries(scan, told)) {
    search(scan, step, told);
  }
  return answer(std::move(told));
}

Told Tracker::answer(Told told) const {
  told.phase = phase_;
  told.resets = resets_;
  told.fitted = fitted_;
  if (phase_ == Phase::Tracking || phase_ == Phase::Doubtful) {
    told.pose = field_->shape().origin * now_.pose;
  }
  return told;
}

void Tracker::track(const chart::Scan& scan, const Pose2& step, Told& told) {
  now_.go(step, p_);
  WindowParams window = p_.window;
  if (told_) {
    window.half_m = std::clamp(3.0 * std::sqrt(now_.covariance(0, 0)), window.half_m, 3.0);
    window.half_rad =
        std::clamp(3.0 * std::sqrt(now_.covariance(2, 2)), window.half_rad, base::kPi);
  }
  const std::vector<Point> few = spread_hits(scan, 0.10, p_.search_points);
  const std::vector<Point> hits = hits_of(scan, p_.match_points);
  if (hits.size() < p_.least_hits) {
    told.reason = "too little to see";
    bad(step);
    return;
  }
  const Found found = search_window(*field_, few, now_.pose, window);
  const double depth_deviation_m = std::hypot(depth_deviation_m_, kDepthDrift_m);
  const Prior prior{now_.pose, now_.covariance.inverse(), depth_m_, depth_deviation_m};
  const Match match = refine(*field_, hits, found.pose, prior, p_.match);
  told.agreement = agreement(*field_, scan, match.pose);
  told.reason = misfit(told.agreement, p_);
  if (told.reason.empty() && told_ && told.agreement.close_fit < p_.start.nowhere) {
    told.reason = "what the scanner sees is not in the map at the told place";
  }
  if (!told.reason.empty()) {
    told.denied = !fitted_;
    bad(step);
    if (phase_ == Phase::Lost) told.reason = kLostWords;
    return;
  }
  if (told_ && has_rival(scan, few, hits, match, told.agreement.log_fit, window)) {
    told_ = false;
    phase_ = Phase::Searching;
    start_.stay_near(now_.pose, window.half_m, window.half_rad);
    (void)start_.feed(*field_, scan, Pose2{});
    told.candidates = start_.places().size();
    told.reason = "more than one place around the told one fits: drive on";
    return;
  }
  const Matrix3d sum = prior.information + match.covariance.inverse();
  now_.covariance = sum.inverse();
  now_.pose = match.pose;
  depth_m_ = match.depth_m;
  depth_deviation_m_ = std::max(match.depth_deviation_m, kDepthSurest_m);
  told_ = false;
  fitted_ = true;
  now_.good(step, p_);
  held_m_ += std::hypot(step.x_m, step.y_m);
  if (held_m_ >= p_.held_after_m) doubt_ = 1.0;
  phase_ = Phase::Tracking;
  const double yaw = field_->shape().origin.yaw_rad;
  told.fix = Fix{scan.stamp, field_->shape().origin * now_.pose, turned_by(match.covariance, yaw)};
}

/// Does another place in the window fit about as well? Where the map is too large to look at all of
/// it, nobody knows, and the told one counts.
bool Tracker::has_rival(const chart::Scan& scan, const std::vector<Point>& few,
                        const std::vector<Point>& hits, const Match& match, double log_fit,
                        const WindowParams& window) const {
  const Whole whole = search_whole(*field_, few, p_.start.whole);
  if (!whole.complete) return false;
  for (const Found& f : whole.found) {
    const bool inside =
        std::hypot(f.pose.x_m - now_.pose.x_m, f.pose.y_m - now_.pose.y_m) <= window.half_m &&
        std::abs(base::angle_diff_rad(now_.pose.yaw_rad, f.pose.yaw_rad)) <= window.half_rad;
    if (!inside) continue;
    const Match other = refine(*field_, hits, f.pose, {}, p_.match);
    const bool same =
        std::hypot(other.pose.x_m - match.pose.x_m, other.pose.y_m - match.pose.y_m) < kSame_m &&
        std::abs(base::angle_diff_rad(other.pose.yaw_rad, match.pose.yaw_rad)) < kSame_rad;
    if (same) continue;
    const Agreement a = agreement(*field_, scan, other.pose);
    if (misfit(a, p_).empty() && p_.start.counts * (log_fit - a.log_fit) < p_.rival) {
      return true;
    }
  }
  return false;
}

void Tracker::bad(const Pose2& step) {
  phase_ = now_.bad(step, p_);
  if (phase_ != Phase::Lost) return;
  if (fitted_ && held_m_ < p_.held_after_m) doubt_ = std::min(2.0 * doubt_, kMostDoubt);
  start_.clear();
  start_.doubt(doubt_);
}

/// @return false: nothing fits at the suggested place, the search goes on
bool Tracker::tries(const chart::Scan& scan, Told& told) {
  const Phase before = phase_;
  const Suggested there = *std::exchange(suggested_, std::nullopt);
  begin_at(there.in_map, there.deviation_m, there.deviation_rad);
  track(scan, Pose2{}, told);
  if (phase_ == Phase::Doubtful || phase_ == Phase::Lost) {
    phase_ = before;
    told_ = false;
    told.agreement = {};
    told.denied = false;  // satellites said so, and nobody else believes it
    return false;
  }
  if (phase_ == Phase::Tracking) {
    ++resets_;
    start_.clear();
  }
  return true;  // known; or more than one place around it fits, and some way decides
}

void Tracker::search(const chart::Scan& scan, const Pose2& step, Told& told) {
  const auto decided = start_.feed(*field_, scan, step);
  told.candidates = start_.places().size();
  told.reason = phase_ == Phase::Lost   ? kLostWords
                : start_.fits_nowhere() ? "nothing in the map fits: is it the map of this place?"
                                        : "looking for the place in the map";
  if (!decided) return;
  now_.begin(*decided, 0.1, 0.03);
  phase_ = Phase::Tracking;
  told_ = fitted_ = false;
  held_m_ = 0.0;
  ++resets_;
  start_.clear();
  track(scan, Pose2{}, told);
}

}  // namespace roverd::nav::place
