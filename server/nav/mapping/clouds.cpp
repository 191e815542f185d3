#include "nav/mapping/clouds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/LU>

#include "nav/cells/align.hpp"
#include "nav/chart/stood.hpp"
#include "nav/mapping/standing.hpp"

namespace roverd::nav::mapping {

namespace {

using cells::CellIndex;
using cells::CellMap;
using cells::KeyTable;
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kColumn_m = 0.5;  // edge of the squares in which the ground is compared
constexpr std::size_t kFewColumns = 12;
constexpr double kGroundUp_m = 0.3;  // over the body's plane, and a fifth of the way to there
constexpr double kGroundUp = 0.2;
constexpr double kRise_m = 0.03;   // deviation of a rise by the ground; of the odometry: so much
constexpr double kDrift_m = 0.02;  // and so much of the way
constexpr double kDrift = 0.05;
constexpr double kAgain_m = 4.0;     // bodies so near stood on the same ground
constexpr double kAgainWay_m = 8.0;  // if so much was driven between
constexpr std::size_t kMostAgain = 3;

constexpr double kBeside_m = 12.0;  // clouds so near are laid on each other
constexpr std::size_t kMostBeside = 10;
// What the plane's way and the body's lie are right to.
constexpr double kPriorPlace_m = 0.05;
constexpr double kPriorTurn_rad = 0.01;

/// The lowest of a cloud's ground in each square, in M but for its height.
struct Ground {
  KeyTable table;
  std::vector<std::uint64_t> keys;
  std::vector<double> low_m;
};

Ground ground_of(const cells::Cloud& points, const Isometry3d& lies) {
  Ground out;
  const Vector3d at = lies.translation();
  for (const Eigen::Vector3f& p : points) {
    const Vector3d m = lies * p.cast<double>();
    const double up_m = m.z() - at.z();
    if (std::abs(up_m) > kGroundUp_m + kGroundUp * (m - at).head<2>().norm()) continue;
    CellIndex index;
    if (!cells::index_of({m.x(), m.y(), 0.0}, kColumn_m, index)) continue;
    const auto fresh = static_cast<std::int32_t>(out.keys.size());
    const std::int32_t i = out.table.find_or_add(cells::key_of(index), fresh);
    if (i == fresh) {
      out.keys.push_back(cells::key_of(index));
      out.low_m.push_back(up_m);
    } else {
      double& low = out.low_m[static_cast<std::size_t>(i)];
      low = std::min(low, up_m);
    }
  }
  return out;
}

/// By how much b's body stands over a's: the middle of what the squares say that both saw.
std::optional<double> rise_between(const Ground& a, const Ground& b) {
  std::vector<double> all;
  for (std::size_t i = 0; i < b.keys.size(); ++i) {
    const std::int32_t other = a.table.find(b.keys[i]);
    if (other >= 0) all.push_back(a.low_m[static_cast<std::size_t>(other)] - b.low_m[i]);
  }
  if (all.size() < kFewColumns) return std::nullopt;
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
  std::nth_element(all.begin(), middle, all.end());
  return *middle;
}

double apart_m(const Isometry3d& a, const Isometry3d& b) noexcept {
  return (a.translation() - b.translation()).head<2>().norm();
}

/// Those before i within reach, the nearest first.
std::vector<std::size_t> near_before(std::span<const Isometry3d> poses, std::size_t i,
                                     double reach_m) {
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < i; ++k) {
    if (apart_m(poses[k], poses[i]) <= reach_m) out.push_back(k);
  }
  std::ranges::sort(out, {}, [&](std::size_t k) { return apart_m(poses[k], poses[i]); });
  return out;
}

/// The place by what is behind it and by the prior, as sure as each is.
Isometry3d between(const Isometry3d& prior, const cells::Alignment& laid) {
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  cells::Matrix6d p = cells::Matrix6d::Identity();
  p.diagonal().head<3>().setConstant(kPriorPlace_m * kPriorPlace_m);
  p.diagonal().tail<3>().setConstant(kPriorTurn_rad * kPriorTurn_rad);
  const Eigen::AngleAxisd turn(laid.x_ts.linear() * prior.linear().transpose());
  Vector6d off;
  off << laid.x_ts.translation() - prior.translation(), turn.angle() * turn.axis();
  const Vector6d moved = p * (p + laid.covariance).inverse() * off;
  if (!moved.allFinite()) return prior;
  Isometry3d out = prior;
  out.translation() += moved.head<3>();
  const double angle = moved.tail<3>().norm();
  if (angle > 1e-9) {
    out.linear() = Eigen::AngleAxisd(angle, moved.tail<3>() / angle) * prior.linear();
  }
  return out;
}

void add_placed(CellMap& map, const cells::Cloud& points, const Isometry3d& x_mb) {
  const Eigen::Isometry3f x = x_mb.cast<float>();
  cells::Cloud placed;
  placed.reserve(points.size());
  for (const Eigen::Vector3f& p : points) placed.push_back(x * p);
  map.add(placed);
}

base::Error given_up() {
  return {base::Code::Unavailable, "given up"};
}

}  // namespace

bool Clouds::wants(double way_m) const noexcept {
  return clouds_.empty() || way_m - clouds_.back().at.way_m >= p_.every_m;
}

base::Result<void> Clouds::add(std::span<const Eigen::Vector3f> points, const CloudAt& at) {
  Kept kept{{}, at};
  KeyTable seen(points.size());
  for (const Eigen::Vector3f& p : points) {
    CellIndex index;
    if (!cells::index_of(p.cast<double>(), p_.thin_m, index)) continue;
    if (static_cast<double>(p.norm()) > p_.farthest_m) continue;
    const auto fresh = static_cast<std::int32_t>(kept.points.size());
    if (seen.find_or_add(cells::key_of(index), fresh) == fresh) kept.points.push_back(p);
  }
  if (points_ + kept.points.size() > kMostPoints) {
    return base::fail(base::Code::TooLarge, "as many points as a map may be made of");
  }
  if (kept.points.empty()) return {};
  kept.points.shrink_to_fit();
  points_ += kept.points.size();
  clouds_.push_back(std::move(kept));
  return {};
}

/// By the odometry, and by the ground where it was seen from both.
std::vector<Rise> Clouds::rises(std::span<const Isometry3d> poses) const {
  std::vector<Ground> grounds;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    grounds.push_back(ground_of(clouds_[i].points, poses[i]));
  }
  std::vector<Rise> out;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const CloudAt& at = clouds_[i].at;
    const CloudAt& before = clouds_[i - 1].at;
    out.push_back(
        {i - 1, i, at.lie.z_m - before.lie.z_m, kDrift_m + kDrift * (at.way_m - before.way_m)});
    if (const auto rise = rise_between(grounds[i - 1], grounds[i])) {
      out.push_back({i - 1, i, *rise, kRise_m});
    }
    std::size_t again = 0;
    for (const std::size_t k : near_before(poses, i, kAgain_m)) {
      if (again == kMostAgain) break;
      if (at.way_m - clouds_[k].at.way_m < kAgainWay_m) continue;
      if (const auto rise = rise_between(grounds[k], grounds[i])) {
        out.push_back({k, i, *rise, kRise_m});
        ++again;
      }
    }
  }
  return out;
}

/// Where it lies on those before it that are near; where it does not fit them, it stays.
Isometry3d Clouds::on_those_before(std::span<const Isometry3d> poses, std::size_t i,
                                   double cell_m) const {
  CellMap behind(cell_m);
  auto near = near_before(poses, i, kBeside_m);
  near.resize(std::min(near.size(), kMostBeside));
  for (const std::size_t k : near) add_placed(behind, clouds_[k].points, poses[k]);
  CellMap seen(cell_m);
  seen.add(clouds_[i].points);
  cells::AlignParams params;
  params.coarse = false;
  const auto laid = cells::align(cells::Relief(seen), cells::Relief(behind), poses[i], params);
  const bool fits = laid.verdict == cells::Verdict::Good || laid.verdict == cells::Verdict::Loose;
  return fits ? between(poses[i], laid) : poses[i];
}

base::Result<std::vector<Isometry3d>> Clouds::settled(std::span<const sense::Pose2> path,
                                                      double cell_m, const GiveUp& give_up) const {
  if (clouds_.empty() || path.empty()) {
    return base::fail(base::Code::Invalid, "there is no cloud");
  }
  std::vector<Isometry3d> poses;
  for (const Kept& c : clouds_) {
    const sense::Pose2 at = path[std::min(c.at.scan, path.size() - 1)] * c.at.since;
    poses.push_back(chart::stood(at, 0.0, c.at.lie));
  }
  const std::vector<double> heights = levelled(poses.size(), rises(poses));
  for (std::size_t i = 0; i < poses.size(); ++i) poses[i].translation().z() = heights[i];
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (give_up && give_up()) return tl::unexpected(given_up());
    if (i > 0) poses[i] = on_those_before(poses, i, cell_m);
  }
  return poses;
}

base::Result<CellMap> Clouds::laid(std::span<const sense::Pose2> path, double cell_m,
                                   const GiveUp& give_up) const {
  const auto poses = settled(path, cell_m, give_up);
  if (!poses) return tl::unexpected<base::Error>(poses.error());
  Standing standing(cell_m);
  for (std::uint32_t i = 0; i < clouds_.size(); ++i) {
    standing.meet(i, clouds_[i].points, (*poses)[i]);
  }
  for (std::uint32_t i = 0; i < clouds_.size(); ++i) {
    if (give_up && give_up()) return tl::unexpected(given_up());
    standing.look_through(i, clouds_[i].points, (*poses)[i], clouds_[i].at.eye_m.cast<double>());
  }
  CellMap map = standing.map();
  if (map.cells().empty()) return base::fail(base::Code::Invalid, "nothing was seen twice");
  return map;
}

}  // namespace roverd::nav::mapping
