#include "nav/place/cell_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/LU>

#include "base/angle.hpp"
#include "nav/cells/cell_map.hpp"
#include "nav/chart/carrier.hpp"
#include "nav/chart/stood.hpp"
#include "nav/sense/mount.hpp"

namespace roverd::nav::place {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t kFewPoints = 200;  // less is no view
constexpr double kSearch_m = 0.3;        // around what the odometry says
constexpr double kSearch_rad = 0.1;
constexpr double kMostSearch_m = 1.0;  // around what is told (align.hpp is tried so far)
constexpr double kMostSearch_rad = 0.26;
constexpr double kGate = 16.3;  // 99.9 % of three

Pose2 in_plane(const Eigen::Isometry3d& x) {
  const Vector3d ahead = x.linear().col(0);
  return {x.translation().x(), x.translation().y(), std::atan2(ahead.y(), ahead.x())};
}

/// Of x, y and the turn about the vertical.
Matrix3d in_plane(const cells::Matrix6d& c) {
  constexpr std::array<Eigen::Index, 3> kOf{0, 1, 5};
  Matrix3d out;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      out(i, k) = c(kOf[static_cast<std::size_t>(i)], kOf[static_cast<std::size_t>(k)]);
    }
  }
  return out;
}

Vector3d between(const Pose2& from, const Pose2& to) {
  return {to.x_m - from.x_m, to.y_m - from.y_m, base::angle_diff_rad(from.yaw_rad, to.yaw_rad)};
}

}  // namespace

bool has_rows(const base::Sight& sight) noexcept {
  constexpr std::size_t kLooks = 64;
  const std::size_t n = std::min(kLooks, sight.points.size());
  for (std::size_t i = 1; i < n; ++i) {
    if (sight.points[i].ring != sight.points[0].ring) return true;
  }
  return false;
}

std::optional<Cloud> cloud_of(const base::Sight& sight, const base::Mount& mount,
                              const sense::PoseHistory& odometry, const CloudParams& p) {
  if (!sight.good || sight.points.empty()) return std::nullopt;
  const double end_s = chart::last_s(sight);
  Cloud cloud;
  cloud.stamp = sight.stamp + base::from_seconds(end_s);
  const auto reference = odometry.at(cloud.stamp);
  if (!reference) return std::nullopt;
  cloud.lie = odometry.lie_at(cloud.stamp);
  chart::Carrier carrier(odometry, sight.stamp, *reference);
  const Matrix3d turned = sense::rotation(mount);
  const Vector3d seat(mount.x_m, mount.y_m, mount.z_m);
  for (const base::SightPoint& s : sight.points) {
    if (s.echo != base::Echo::Hit || !(s.after_s >= 0.0F && s.after_s <= end_s)) continue;
    const Vector3d in_sensor(s.x_m, s.y_m, s.z_m);
    const double range = in_sensor.norm();
    if (!(range >= p.nearest_m && range <= p.farthest_m)) continue;
    const auto then = carrier.at(s.after_s);
    if (!then) continue;
    const Vector3d b = turned * in_sensor + seat;
    const Pose2 at = *then * Pose2{b.x(), b.y(), 0.0};
    cloud.points.emplace_back(static_cast<float>(at.x_m), static_cast<float>(at.y_m),
                              static_cast<float>(b.z()));
  }
  if (cloud.points.empty()) return std::nullopt;
  return cloud;
}

CellTracker::CellTracker(std::shared_ptr<const cells::Relief> map, const TrackerParams& params)
    : map_(std::move(map)), p_(params) {}

void CellTracker::set_pose(const Pose2& in_map, double deviation_m, double deviation_rad) {
  if (!std::isfinite(in_map.x_m + in_map.y_m + in_map.yaw_rad)) return;
  now_.begin(in_map, deviation_m, deviation_rad);
  phase_ = Phase::Tracking;
  told_ = true;
  fitted_ = false;
  last_stamp_.reset();
  ++resets_;
}

void CellTracker::forget() {
  phase_ = Phase::Searching;
  told_ = fitted_ = false;
  last_stamp_.reset();
}

Told CellTracker::feed(const Cloud& cloud, const Pose2& odometry) {
  Told told;
  told.stamp = cloud.stamp;
  const bool finite = std::isfinite(odometry.x_m + odometry.y_m + odometry.yaw_rad);
  if (!finite || (last_stamp_ && cloud.stamp <= *last_stamp_)) {
    told.reason = "not newer than the cloud before, or without odometry";
    return answer(std::move(told));
  }
  const Pose2 step = last_stamp_ ? inverse(last_odometry_) * odometry : Pose2{};
  // Where the ground rises is in the map; a start is on the height where the map was begun, or
  // where it was followed to.
  if (last_stamp_) z_m_ += cloud.lie.z_m - last_lie_z_m_;
  last_stamp_ = cloud.stamp;
  last_odometry_ = odometry;
  last_lie_z_m_ = cloud.lie.z_m;
  if (searches()) {
    told.reason = phase_ == Phase::Lost ? kLostWords : "looking for the place in the map";
  } else {
    track(cloud, step, told);
  }
  return answer(std::move(told));
}

Told CellTracker::answer(Told told) const {
  told.phase = phase_;
  told.resets = resets_;
  told.fitted = fitted_;
  if (!searches()) told.pose = now_.pose;
  return told;
}

/// Empty: it fits.
std::string_view CellTracker::misfit(const cells::Alignment& a, const Pose2& at) const {
  using cells::Verdict;
  if (a.verdict == Verdict::Nothing) return "too little to see";
  if (a.verdict == Verdict::Unsettled || a.verdict == Verdict::LittleOverlap) {
    return "what the sensor sees is not in the map";
  }
  if (a.verdict == Verdict::Ambiguous && told_) {
    return "more than one place around the told one fits: drive on";
  }
  // Known places do not jump: what fits elsewhere is another place.
  const Vector3d off = between(now_.pose, at);
  const Matrix3d sum = now_.covariance + in_plane(a.covariance);
  if (off.dot(sum.inverse() * off) > kGate) return "what fits lies elsewhere";
  return {};
}

/// From one cloud to the next the odometry is right within centimetres; where that does not fit, or
/// somebody told the place, it is searched around.
cells::Alignment CellTracker::lay(const cells::Relief& seen, const Eigen::Isometry3d& start) const {
  cells::AlignParams params;
  params.coarse = false;
  cells::Alignment near;
  if (!told_) {
    near = cells::align(seen, *map_, start, params);
    if (near.verdict == cells::Verdict::Good || near.verdict == cells::Verdict::Loose) return near;
  }
  params.coarse = true;
  params.beside_m = map_->cell_m();
  params.search_m = kSearch_m;
  params.search_rad = kSearch_rad;
  if (told_) {
    params.search_m = std::clamp(2.0 * std::sqrt(now_.covariance(0, 0)), kSearch_m, kMostSearch_m);
    params.search_rad = std::clamp(std::sqrt(now_.covariance(2, 2)), kSearch_rad, kMostSearch_rad);
  }
  return cells::align(seen, *map_, start, params);
}

void CellTracker::track(const Cloud& cloud, const Pose2& step, Told& told) {
  now_.go(step, p_);
  cells::CellMap seen(map_->cell_m());
  seen.add(cloud.points);
  cells::Alignment a;
  if (cloud.points.size() >= kFewPoints) {
    a = lay(cells::Relief(seen), chart::stood(now_.pose, z_m_, cloud.lie));
  }
  const Pose2 at = in_plane(a.x_ts);
  told.agreement.explained = a.overlap;
  told.agreement.hits = cloud.points.size();
  told.reason = misfit(a, at);
  if (!told.reason.empty()) {
    const bool alike = a.verdict == cells::Verdict::Ambiguous && told_;
    told.denied = !fitted_ && a.verdict != cells::Verdict::Nothing && !alike;
    phase_ = now_.bad(step, p_);
    if (phase_ == Phase::Lost) told.reason = kLostWords;
    return;
  }
  const Matrix3d measured = in_plane(a.covariance);
  const Matrix3d gain = now_.covariance * (now_.covariance + measured).inverse();
  const Vector3d moved = gain * between(now_.pose, at);
  now_.pose = {now_.pose.x_m + moved.x(), now_.pose.y_m + moved.y(),
               base::wrap_rad(now_.pose.yaw_rad + moved.z())};
  const Matrix3d left = (Matrix3d::Identity() - gain) * now_.covariance;
  now_.covariance = 0.5 * (left + left.transpose());
  now_.good(step, p_);
  z_m_ = a.x_ts.translation().z();
  told_ = false;
  fitted_ = true;
  phase_ = Phase::Tracking;
  told.fix = Fix{cloud.stamp, now_.pose, measured};
}

}  // namespace roverd::nav::place
