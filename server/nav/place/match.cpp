#include "nav/place/match.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "base/angle.hpp"

namespace roverd::nav::place {

namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr int kMostSteps = 25;
constexpr double kDeepest_m = 0.06;

/// x, y, yaw, depth.
struct Sums {
  Matrix4d h = Matrix4d::Zero();
  Vector4d g = Vector4d::Zero();
  std::size_t used = 0;
};

/// @param narrow_m c of the robust weights.
Sums sums_at(const Field& field, std::span<const Point> points, const Pose2& pose, double depth_m,
             double narrow_m) {
  Sums sums;
  const double c = std::cos(pose.yaw_rad);
  const double s = std::sin(pose.yaw_rad);
  const double scale = 1.0 / (2.0 * narrow_m * narrow_m);
  for (const Point& p : points) {
    const double bx = p.x_m + depth_m * p.ahead;
    const double by = p.y_m + depth_m * p.left;
    const double rx = c * bx - s * by;
    const double ry = s * bx + c * by;
    const Wall* wall = field.wall(pose.x_m + rx, pose.y_m + ry);
    if (wall == nullptr) continue;
    const Vector2d e(pose.x_m + rx - wall->x_m, pose.y_m + ry - wall->y_m);
    Matrix2d counts;
    counts << wall->xx, wall->xy, wall->xy, wall->yy;
    // How the hit moves with x, y, a radian of yaw, a metre of depth.
    Eigen::Matrix<double, 2, 4> j;
    j << 1.0, 0.0, -ry, c * p.ahead - s * p.left, 0.0, 1.0, rx, s * p.ahead + c * p.left;
    const Vector2d counted = counts * e;
    const double w = std::exp(-e.dot(counted) * scale);
    sums.h.noalias() += w * (j.transpose() * (counts * j));
    sums.g.noalias() += w * (j.transpose() * counted);
    ++sums.used;
  }
  return sums;
}

/// Directions that the hits hardly hold are not held at all: the little that they seem to hold
/// comes from the raggedness of walls. Of a 2 x 2 information.
Matrix2d without_raggedness(const Matrix2d& information, double empty) {
  Eigen::SelfAdjointEigenSolver<Matrix2d> solved(information);
  Vector2d values = solved.eigenvalues();
  const double strongest = std::max(values(1), 0.0);
  for (int i = 0; i < 2; ++i) values(i) = std::max(values(i) - empty * strongest, 0.0);
  return solved.eigenvectors() * values.asDiagonal() * solved.eigenvectors().transpose();
}

Matrix3d covariance_of(const Matrix3d& h, const MatchParams& p) {
  Matrix3d information = h / (p.shared * p.beam_m * p.beam_m);
  // Where the place is when the heading is free, and the heading when the place is free.
  const double yaw_alone = std::max(information(2, 2), 1e-9);
  const Matrix2d place = information.topLeftCorner<2, 2>();
  const Matrix2d kept = without_raggedness(place, p.empty);
  information.topLeftCorner<2, 2>() = kept;
  information(2, 2) = yaw_alone;
  // What is known at worst, in every direction.
  const Vector3d widest(p.widest_m, p.widest_m, p.widest_rad);
  for (int i = 0; i < 3; ++i) information(i, i) += 1.0 / (widest(i) * widest(i));
  Eigen::SelfAdjointEigenSolver<Matrix3d> solved(information);
  Vector3d values = solved.eigenvalues().cwiseMax(0.5 / (p.widest_m * p.widest_m));
  Matrix3d covariance = solved.eigenvectors() * values.cwiseInverse().asDiagonal() *
                        solved.eigenvectors().transpose();
  covariance(0, 0) += p.floor_m * p.floor_m;
  covariance(1, 1) += p.floor_m * p.floor_m;
  covariance(2, 2) += p.floor_rad * p.floor_rad;
  return 0.5 * (covariance + covariance.transpose());
}

Vector4d off_prior(const Pose2& pose, double depth_m, const Prior& prior) {
  return {pose.x_m - prior.pose.x_m, pose.y_m - prior.pose.y_m,
          base::angle_diff_rad(prior.pose.yaw_rad, pose.yaw_rad), depth_m - prior.depth_m};
}

/// Of the place when the depth is not known better than `held` says: the Schur complement.
Matrix3d without_depth(const Matrix4d& h, double held) {
  const Vector3d with = h.topRightCorner<3, 1>();
  return h.topLeftCorner<3, 3>() - with * with.transpose() / (h(3, 3) + held);
}

/// From the line of the nearest wall; beyond its end from there. Infinite: none within reach.
double off_line_m(const Field& field, double x_m, double y_m) noexcept {
  constexpr double kBeside_m = 0.20;  // further from its point than that, the line has ended
  constexpr double kPoint_m = 0.10;
  const Wall* wall = field.wall(x_m, y_m);
  if (wall == nullptr) return std::numeric_limits<double>::infinity();
  const double x = x_m - wall->x_m;
  const double y = y_m - wall->y_m;
  const double off =
      std::sqrt(std::max(wall->xx * x * x + 2.0 * wall->xy * x * y + wall->yy * y * y, 0.0));
  const double all = std::hypot(x, y);
  return all > kBeside_m ? std::max(off, all - kPoint_m) : off;
}

Point point_of(const chart::Scan& scan, const chart::Beam& b) {
  const float x = b.x_m - scan.eye_x_m;
  const float y = b.y_m - scan.eye_y_m;
  const float range = std::max(std::hypot(x, y), 1e-3F);
  return {b.x_m, b.y_m, x / range, y / range};
}

}  // namespace

std::vector<Point> hits_of(const chart::Scan& scan, std::size_t most) {
  const auto all = static_cast<std::size_t>(
      std::count_if(scan.beams.begin(), scan.beams.end(), [](const auto& b) { return b.hit; }));
  const std::size_t step = most == 0 ? 1 : (all + most - 1) / std::max<std::size_t>(most, 1);
  std::vector<Point> out;
  out.reserve(std::min(all, most));
  std::size_t n = 0;
  for (const chart::Beam& b : scan.beams) {
    if (b.hit && n++ % std::max<std::size_t>(step, 1) == 0) out.push_back(point_of(scan, b));
  }
  return out;
}

std::vector<Point> spread_hits(const chart::Scan& scan, double apart_m, std::size_t most) {
  std::unordered_set<std::int64_t> taken;
  std::vector<Point> all;
  for (const chart::Beam& b : scan.beams) {
    const double column = std::floor(b.x_m / apart_m);
    const double row = std::floor(b.y_m / apart_m);
    if (!b.hit || !(std::abs(column) < 1e6 && std::abs(row) < 1e6)) continue;
    const auto key = static_cast<std::int64_t>(column) * 4'000'000 + static_cast<std::int64_t>(row);
    if (taken.insert(key).second) all.push_back(point_of(scan, b));
  }
  if (all.size() <= most) return all;
  std::vector<Point> out;
  out.reserve(most);
  for (std::size_t i = 0; i < most; ++i) out.push_back(all[i * all.size() / most]);
  return out;
}

Match refine(const Field& field, std::span<const Point> points, const Pose2& start,
             const Prior& prior, const MatchParams& p) {
  Match match;
  match.pose = start;
  match.depth_m = prior.depth_m;
  // The prior weighs against hits that count as they do in the certainty.
  const double counts = p.shared * p.beam_m * p.beam_m;
  Matrix4d held = Matrix4d::Zero();
  held.topLeftCorner<3, 3>() = prior.information * counts;
  held(3, 3) = counts / (prior.depth_deviation_m * prior.depth_deviation_m);
  double c = p.wide_m;
  for (int i = 0; i < kMostSteps; ++i) {
    const Sums sums = sums_at(field, points, match.pose, match.depth_m, c);
    match.used = sums.used;
    if (sums.used == 0) break;
    Matrix4d h = sums.h + held;
    h.diagonal() += Vector4d::Constant(1e-9 * h.topLeftCorner<3, 3>().trace() + 1e-12);
    const Vector4d pull = sums.g + held * off_prior(match.pose, match.depth_m, prior);
    Vector4d step = -h.ldlt().solve(pull);
    const double size = std::hypot(step(0), step(1));
    constexpr double kLongest_m = 0.20;
    constexpr double kLargest_rad = 0.10;
    step /= std::max({size / kLongest_m, std::abs(step(2)) / kLargest_rad, 1.0});
    match.pose = {match.pose.x_m + step(0), match.pose.y_m + step(1),
                  base::wrap_rad(match.pose.yaw_rad + step(2))};
    match.depth_m = std::clamp(match.depth_m + step(3), -kDeepest_m, kDeepest_m);
    if (c <= p.narrow_m && size < 2e-4 && std::abs(step(2)) < 1e-4) {
      match.settled = true;
      break;
    }
    c = std::max(0.6 * c, p.narrow_m);
  }
  const Sums last = sums_at(field, points, match.pose, match.depth_m, p.narrow_m);
  match.covariance = covariance_of(without_depth(last.h, held(3, 3)), p);
  const Matrix3d place =
      last.h.topLeftCorner<3, 3>() + held.topLeftCorner<3, 3>() + Matrix3d::Identity() * 1e-6;
  const Vector3d with = last.h.topRightCorner<3, 1>();
  const double kept = last.h(3, 3) + held(3, 3) - with.dot(place.ldlt().solve(with));
  match.depth_deviation_m = std::sqrt(counts / std::max(kept, 1e-6));
  return match;
}

Agreement agreement(const Field& field, const chart::Scan& scan, const Pose2& pose,
                    std::size_t most) {
  constexpr double kAtWall_m = 0.17;
  constexpr double kBehind_m = 0.35;
  constexpr double kSigma_m = 0.10;
  constexpr double kStray = 0.05;  // share of hits that are anywhere
  const double close_m = std::max(0.05, 0.5 * field.resolution_m());
  Agreement a;
  const Pose2 eye = pose * Pose2{scan.eye_x_m, scan.eye_y_m, 0.0};
  std::size_t at_wall = 0;
  std::size_t through = 0;
  std::size_t odd = 0;
  std::size_t unseen = 0;
  double log_sum = 0.0;
  double close_sum = 0.0;
  const std::vector<Point> hits = hits_of(scan, most);
  for (const Point& p : hits) {
    const Pose2 hit = pose * Pose2{p.x_m, p.y_m, 0.0};
    const double range = std::hypot(hit.x_m - eye.x_m, hit.y_m - eye.y_m);
    // Walk there; at a wall well before the end the map contradicts.
    bool crossed = false;
    const double step = field.resolution_m();
    const double ux = (hit.x_m - eye.x_m) / std::max(range, 1e-6);
    const double uy = (hit.y_m - eye.y_m) / std::max(range, 1e-6);
    for (double r = step; r < range - kBehind_m && !crossed; r += step) {
      crossed = field.ground(eye.x_m + r * ux, eye.y_m + r * uy) == Field::Ground::Occupied;
    }
    const double d = field.distance_m(hit.x_m, hit.y_m);
    const bool explained = d <= kAtWall_m;
    // Through a wall, yet at a wall: half a contradiction, for a table's leg hides nothing.
    double likelihood = kStray + (1.0 - kStray) * std::exp(-d * d / (2.0 * kSigma_m * kSigma_m));
    if (crossed) likelihood = std::min(likelihood, 0.02);
    log_sum += std::log(likelihood);
    const double off = crossed ? 1.0 : off_line_m(field, hit.x_m, hit.y_m) / close_m;
    close_sum += std::log(kStray + (crossed ? 0.0 : (1.0 - kStray) * std::exp(-0.5 * off * off)));
    if (crossed) {
      ++through;
    } else if (explained) {
      ++at_wall;
    } else if (field.ground(hit.x_m, hit.y_m) == Field::Ground::Unknown) {
      ++unseen;
    } else {
      ++odd;
    }
  }
  a.hits = hits.size();
  if (hits.empty()) return a;
  const auto share = [&](std::size_t n) {
    return static_cast<double>(n) / static_cast<double>(hits.size());
  };
  a.explained = share(at_wall);
  a.crossed = share(through);
  a.odd = share(odd);
  a.unseen = share(unseen);
  a.log_fit = log_sum / static_cast<double>(hits.size());
  a.close_fit = close_sum / static_cast<double>(hits.size());
  return a;
}

}  // namespace roverd::nav::place
