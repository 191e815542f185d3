#include "nav/cells/align.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace roverd::nav::cells {

namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;

constexpr double kKernel = 9.0;   // d² at which a pair pulls a quarter: 3 deviations
constexpr int kCoarseSteps = 15;  // of each level
constexpr int kFineSteps = 15;
constexpr double kReach_cells = 10.0;  // of the fine stage
constexpr double kBeside_cells = 5.0;  // so near must a surface be measured to be found
constexpr double kUpright = 0.7;       // of a surface's normal: less points up than to the side
constexpr double kSame_cells = 2.5;    // nearer than this, two places are one
constexpr double kSame_rad = 0.05;
// So many pairs count as one: neighbours share their points, and what one surface gives wrongly all
// of it gives wrongly (halves of real scans, aligned one by one, differ by that).
constexpr double kAlike = 100.0;
constexpr double kTilt_rad = 0.07;     // so much a measured normal is off
constexpr double kFinest_cells = 0.1;  // no surface is measured nearer
constexpr double kRivals = 0.9;        // of the best fit: as good

Eigen::Matrix3d hat(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

/// Sums of one step about a pose.
struct Sums {
  Matrix6d h = Matrix6d::Zero();
  Vector6d b = Vector6d::Zero();
  double weight = 0.0;  // sum of w: how much fits
};

template <class Look>
Sums gather(std::span<const Surfel> source, const Look& look, const Eigen::Isometry3d& x) {
  Sums sums;
  const Eigen::Matrix3d r = x.linear();
  for (const Surfel& s : source) {
    const Eigen::Vector3d arm = r * s.mean_m;
    const Eigen::Vector3d p = arm + x.translation();
    const Surfel* t = look(p);
    if (t == nullptr) continue;
    const Eigen::Matrix3d spread = t->covariance_m2 + r * s.covariance_m2 * r.transpose();
    const Eigen::Matrix3d w = spread.inverse();
    const Eigen::Vector3d e = p - t->mean_m;
    const Eigen::Vector3d we = w * e;
    const double d2 = e.dot(we);
    const double share = kKernel / (kKernel + d2);
    const double k = share * share;
    const Eigen::Matrix3d kw = k * w;
    const Eigen::Matrix3d turn = -hat(arm);
    const Eigen::Matrix3d kwt = kw * turn;
    sums.h.topLeftCorner<3, 3>() += kw;
    sums.h.topRightCorner<3, 3>() += kwt;
    sums.h.bottomRightCorner<3, 3>().noalias() += turn.transpose() * kwt;
    sums.b.head<3>() += k * we;
    sums.b.tail<3>().noalias() += k * (turn.transpose() * we);
    sums.weight += k;
  }
  sums.h.bottomLeftCorner<3, 3>() = sums.h.topRightCorner<3, 3>().transpose();
  return sums;
}

struct Settled {
  Sums sums;  // about the last pose but one
  int steps = 0;
  bool still = false;
};

/// Gauss-Newton until the steps are shorter than still_m and still_rad.
template <class Look>
Settled settle(std::span<const Surfel> source, const Look& look, int most_steps, double still_m,
               double still_rad, Eigen::Isometry3d& x) {
  Settled out;
  while (out.steps < most_steps && !out.still) {
    ++out.steps;
    out.sums = gather(source, look, x);
    const double damp = 1e-9 * out.sums.h.trace();
    if (!(damp > 0.0)) return out;
    const Vector6d step = -(out.sums.h + damp * Matrix6d::Identity()).ldlt().solve(out.sums.b);
    if (!step.allFinite()) return out;
    const double turn = step.tail<3>().norm();
    if (turn > 1e-12) {
      const Eigen::Vector3d axis = step.tail<3>() / turn;
      x.linear() = Eigen::Quaterniond(Eigen::AngleAxisd(turn, axis).toRotationMatrix() * x.linear())
                       .normalized()
                       .toRotationMatrix();
    }
    x.translation() += step.head<3>();
    out.still = step.head<3>().norm() < still_m && turn < still_rad;
  }
  return out;
}

struct Place {
  Eigen::Isometry3d x;
  double fit = 0.0;  // share of the finest level's cells that fit
};

Place coarse_place(const Relief& source, const Relief& target, const Eigen::Isometry3d& start) {
  Place place{start};
  for (std::size_t i = 0; i < Relief::kCoarser.size(); ++i) {
    const Relief::Level& from = source.levels()[i];
    const Relief::Level& to = target.levels()[i];
    const auto look = [&](const Eigen::Vector3d& p) { return to.nearest(p); };
    const Settled s = settle(from.surfels, look, kCoarseSteps, 0.02 * to.cell_m, 0.002, place.x);
    place.fit = from.surfels.empty() ? 0.0 : s.sums.weight / double(from.surfels.size());
  }
  return place;
}

std::vector<Eigen::Isometry3d> starts_around(const Eigen::Isometry3d& start, const AlignParams& p) {
  std::vector<Eigen::Isometry3d> out = {start};
  constexpr std::array<std::array<double, 3>, 4> kSides = {
      {{1.0, 0.0, 1.0}, {-1.0, 0.0, 1.0}, {0.0, 1.0, -1.0}, {0.0, -1.0, -1.0}}};
  if (!(p.search_m > 0.0)) return out;
  for (const auto& side : kSides) {
    Eigen::Isometry3d x = start;
    x.translation() += Eigen::Vector3d(side[0], side[1], 0.0) * p.search_m;
    x.linear() =
        Eigen::AngleAxisd(side[2] * p.search_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix() *
        x.linear();
    out.push_back(x);
  }
  return out;
}

bool same(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double cell_m) {
  return (a.translation() - b.translation()).norm() < kSame_cells * cell_m &&
         Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle() < kSame_rad;
}

/// Which directions the surfaces hold. Only what is across a surface is measured there, and as far
/// as its normal is known: a flat floor seen with noise must not hold along itself.
struct Held {
  Matrix6d information = Matrix6d::Zero();  // for a deviation of 1 m across
  double arms_m2 = 0.0;
  double pairs = 0.0;

  void add(const Surfel& surface, const Eigen::Vector3d& arm) {
    const double tilt_rad2 = kTilt_rad * kTilt_rad + surface.tilt_rad2;
    Eigen::Matrix<double, 3, 6> j;
    j << Eigen::Matrix3d::Identity(), -hat(arm);
    const Vector6d across = j.transpose() * surface.across;
    information.noalias() += (1.0 + tilt_rad2) * (across * across.transpose());
    information.noalias() -= tilt_rad2 * (j.transpose() * j);
    arms_m2 += arm.squaredNorm();
    pairs += 1.0;
  }
  /// What is not held at all is known to some hundred metres, not to nothing: numbers stay finite.
  Matrix6d covariance(double variance_m2) const {
    Vector6d scale = Vector6d::Ones();  // turns count as what they move
    scale.tail<3>() /= std::sqrt(std::max(arms_m2 / std::max(pairs, 1.0), 1e-6));
    const Matrix6d scaled = scale.asDiagonal() * information * scale.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Matrix6d> axes(scaled);
    const Vector6d root = (axes.eigenvalues() / variance_m2).cwiseMax(1e-4).cwiseSqrt();
    const Matrix6d half =
        scale.asDiagonal() * axes.eigenvectors() * Matrix6d(root.cwiseInverse().asDiagonal());
    return half * half.transpose();
  }
};

/// What of the source lies on the target's surfaces, and how near.
void look_again(const Relief& source, const Relief& target, const AlignParams& p, Alignment& out) {
  const double near_m = p.found_cells * target.cell_m();
  std::array<std::size_t, 2> all{};  // lying, upright
  std::array<std::size_t, 2> found{};
  double squares = 0.0;
  Held held;
  for (const Surfel& s : source.surfels()) {
    const std::size_t kind = std::abs((out.x_ts.linear() * s.across).z()) < kUpright ? 1 : 0;
    ++all[kind];
    const Eigen::Vector3d at = out.x_ts * s.mean_m;
    const Surfel* t = target.nearest(at, kBeside_cells * target.cell_m());
    if (t == nullptr) continue;
    const double across_m = std::abs(t->across.dot(at - t->mean_m));
    if (across_m > near_m) continue;
    ++found[kind];
    squares += across_m * across_m;
    held.add(*t, at - out.x_ts.translation());
  }
  const auto share = [](std::size_t part, std::size_t whole) {
    return whole == 0 ? 0.0 : double(part) / double(whole);
  };
  out.overlap = share(found[0] + found[1], all[0] + all[1]);
  out.upright = share(found[1], all[1]);
  out.fit_m = std::sqrt(squares / std::max(double(found[0] + found[1]), 1.0));
  const double deviation_m = std::max(out.fit_m, kFinest_cells * target.cell_m());
  out.covariance = held.covariance(kAlike * deviation_m * deviation_m);
  const double floor_m = p.floor_cells * target.cell_m();
  out.covariance.diagonal().head<3>().array() += floor_m * floor_m;
  out.covariance.diagonal().tail<3>().array() += p.floor_rad * p.floor_rad;
}

void judge(const Relief& target, const AlignParams& p, bool still, Alignment& out) {
  const auto largest = [](const Eigen::Matrix3d& m) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(m, Eigen::EigenvaluesOnly);
    return std::sqrt(std::max(axes.eigenvalues().maxCoeff(), 0.0));
  };
  const bool loose =
      !(largest(out.covariance.topLeftCorner<3, 3>()) < p.loose_cells * target.cell_m() &&
        largest(out.covariance.bottomRightCorner<3, 3>()) < p.loose_rad);
  if (!still) {
    out.verdict = Verdict::Unsettled;
  } else if (!(std::min(out.overlap, out.upright) >= p.least_overlap)) {
    out.verdict = Verdict::LittleOverlap;
  } else if (loose) {
    out.verdict = Verdict::Loose;
  } else if (out.rival > kRivals) {
    out.verdict = Verdict::Ambiguous;
  } else {
    out.verdict = Verdict::Good;
  }
}

}  // namespace

std::string_view to_string(Verdict v) noexcept {
  switch (v) {
    case Verdict::Good:
      return "good";
    case Verdict::Nothing:
      return "nothing";
    case Verdict::Unsettled:
      return "unsettled";
    case Verdict::LittleOverlap:
      return "little overlap";
    case Verdict::Loose:
      return "loose";
    case Verdict::Ambiguous:
      return "ambiguous";
  }
  return "";
}

namespace {

/// Where the start is wrong by search_m: the best by coarse cells, and what came near it.
void search(const Relief& source, const Relief& target, const AlignParams& params, Alignment& out) {
  std::vector<Place> places;
  for (const Eigen::Isometry3d& from : starts_around(out.x_ts, params)) {
    places.push_back(coarse_place(source, target, from));
  }
  const auto best = std::max_element(places.begin(), places.end(),
                                     [](const auto& a, const auto& b) { return a.fit < b.fit; });
  for (const Place& other : places) {
    if (same(other.x, best->x, target.cell_m()) || !(best->fit > 0.0)) continue;
    out.rival = std::max(out.rival, other.fit / best->fit);
  }
  out.x_ts = best->x;
}

void settle_finely(const Relief& source, const Relief& target, const AlignParams& params,
                   Alignment& out) {
  const double reach_m = kReach_cells * target.cell_m();
  const auto look = [&](const Eigen::Vector3d& p) { return target.nearest(p, reach_m); };
  const Settled fine =
      settle(source.surfels(), look, kFineSteps, 0.01 * target.cell_m(), 2e-4, out.x_ts);
  out.steps = fine.steps;
  look_again(source, target, params, out);
  judge(target, params, fine.still, out);
}

/// More of it is found; of what is found as much, it lies nearer.
bool fits_better(const Alignment& a, const Alignment& b) noexcept {
  constexpr double kAlikeShare = 0.02;
  const double more = (a.overlap + a.upright) - (b.overlap + b.upright);
  return more > kAlikeShare || (more > -kAlikeShare && a.fit_m < b.fit_m);
}

}  // namespace

Alignment align(const Relief& source, const Relief& target, const Eigen::Isometry3d& start,
                const AlignParams& params) {
  Alignment out;
  out.x_ts = start;
  if (source.surfels().empty() || target.surfels().empty() || !start.matrix().allFinite()) {
    return out;
  }
  if (params.coarse) search(source, target, params, out);
  const Alignment found = out;
  settle_finely(source, target, params, out);
  if (!(params.beside_m > 0.0)) return out;
  for (const auto& [x, y] : {std::pair{1.0, 0.0}, {-1.0, 0.0}, {0.0, 1.0}, {0.0, -1.0}}) {
    Alignment other = found;
    other.x_ts.translation() =
        out.x_ts.translation() + params.beside_m * Eigen::Vector3d(x, y, 0.0);
    other.x_ts.linear() = out.x_ts.linear();
    settle_finely(source, target, params, other);
    if (fits_better(other, out)) out = other;
  }
  return out;
}

}  // namespace roverd::nav::cells
