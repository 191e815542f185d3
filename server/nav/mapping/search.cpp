#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "nav/chart/cell.hpp"
#include "nav/mapping/field.hpp"

namespace roverd::nav::mapping {

namespace {

constexpr double kTurn_rad = 0.0087;     // half a degree: 5 cm at 6 m, as the cells
constexpr std::size_t kMostTried = 150;  // points; more do not find another place
constexpr int kRefinements = 8;
constexpr double kSpread = 0.3;       // deviation of one point's likelihood
constexpr double kAside_m = 0.1;      // further than ripples are long
constexpr double kAlikePoints = 4.0;  // neighbouring points that err together
constexpr double kEach = 1.0 / (kSpread * kSpread * kAlikePoints);

struct Turned {
  double rad = 0.0;
  std::vector<std::array<std::int32_t, 2>> cells;  // of the points, at the window's corner
};

struct Candidate {
  std::uint32_t bound = 0;
  std::uint16_t turn = 0;
  std::int16_t column = 0;  // cells from the window's corner
  std::int16_t row = 0;
};

Turned turned(const Field& field, std::span<const Eigen::Vector2f> points, const Pose2& guess,
              double rad, double window_m) {
  Turned out{rad, {}};
  const double c = std::cos(guess.yaw_rad + rad);
  const double s = std::sin(guess.yaw_rad + rad);
  const std::size_t step = (points.size() + kMostTried - 1) / kMostTried;
  for (std::size_t i = 0; i < points.size(); i += step) {
    const Eigen::Vector2d p = points[i].cast<double>();
    const Eigen::Vector2d at = field.cell_of({guess.x_m - window_m + c * p.x() - s * p.y(),
                                              guess.y_m - window_m + s * p.x() + c * p.y()});
    out.cells.push_back({chart::whole_cell(at.x()), chart::whole_cell(at.y())});
  }
  return out;
}

/// 1 at the guess, less beside it. The bound of a block is not weighed: it stays a bound.
double preference(const Window& w, double x_m, double y_m, double rad) {
  double exponent = 0.0;
  if (w.guess_m > 0.0) exponent += (x_m * x_m + y_m * y_m) / (w.guess_m * w.guess_m);
  if (w.guess_rad > 0.0) exponent += rad * rad / (w.guess_rad * w.guess_rad);
  return 1.0 / (1.0 + 0.02 * exponent);
}

}  // namespace

Fit search(const Field& field, std::span<const Eigen::Vector2f> points, const Pose2& guess,
           const Window& window) {
  if (points.empty()) return {guess};
  const auto turns = static_cast<int>(std::ceil(window.rad / kTurn_rad));
  const auto cells = static_cast<std::int16_t>(std::ceil(2.0 * window.m / Field::kCell_m));
  std::vector<Turned> all;
  std::vector<Candidate> candidates;
  for (int t = -turns; t <= turns; ++t) {
    all.push_back(turned(field, points, guess, t * kTurn_rad, window.m));
    for (std::int16_t row = 0; row <= cells; row = static_cast<std::int16_t>(row + Field::kBlock)) {
      for (std::int16_t column = 0; column <= cells;
           column = static_cast<std::int16_t>(column + Field::kBlock)) {
        std::uint32_t bound = 0;
        for (const auto& c : all.back().cells) bound += field.bound(c[0] + column, c[1] + row);
        candidates.push_back({bound, static_cast<std::uint16_t>(all.size() - 1), column, row});
      }
    }
  }
  const auto less = [](const Candidate& a, const Candidate& b) { return a.bound < b.bound; };
  std::make_heap(candidates.begin(), candidates.end(), less);
  double best = 0.0;
  Pose2 found = guess;
  while (!candidates.empty() && double(candidates.front().bound) > best) {
    const Candidate c = candidates.front();
    std::pop_heap(candidates.begin(), candidates.end(), less);
    candidates.pop_back();
    const Turned& t = all[c.turn];
    for (std::int32_t i = 0; i < Field::kBlock * Field::kBlock; ++i) {
      const std::int32_t column = c.column + i % Field::kBlock;
      const std::int32_t row = c.row + i / Field::kBlock;
      std::uint32_t sum = 0;
      for (const auto& cell : t.cells) sum += field.at(cell[0] + column, cell[1] + row);
      if (double(sum) <= best) continue;
      const double x_m = column * Field::kCell_m - window.m;
      const double y_m = row * Field::kCell_m - window.m;
      const double weighed = sum * preference(window, x_m, y_m, t.rad);
      if (weighed <= best) continue;
      best = weighed;
      found = {guess.x_m + x_m, guess.y_m + y_m, base::wrap_rad(guess.yaw_rad + t.rad)};
    }
  }
  return refine(field, points, found, guess, window);
}

namespace {

double mean_of(const Field& field, std::span<const Eigen::Vector2f> points, const Pose2& pose) {
  const double c = std::cos(pose.yaw_rad);
  const double s = std::sin(pose.yaw_rad);
  double sum = 0.0;
  for (const auto& point : points) {
    const Eigen::Vector2d p = point.cast<double>();
    Eigen::Vector2d slope;
    sum +=
        field.sample({pose.x_m + c * p.x() - s * p.y(), pose.y_m + s * p.x() + c * p.y()}, slope);
  }
  return sum / double(points.size());
}

/// The field's ripples from point to point look like something to hold on to, along a wall, too.
/// What holds loses: the direction that is held least is weighed by what moving along it costs.
Eigen::Matrix3d without_ripples(const Field& field, std::span<const Eigen::Vector2f> points,
                                const Fit& fit, const Eigen::Matrix3d& information) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(
      Eigen::Matrix2d(information.topLeftCorner<2, 2>()));
  const Eigen::Vector2d along = axes.eigenvectors().col(0) * kAside_m;
  const auto beside = [&](double sign) {
    return mean_of(
        field, points,
        {fit.pose.x_m + sign * along.x(), fit.pose.y_m + sign * along.y(), fit.pose.yaw_rad});
  };
  const double lost = std::max(fit.score - 0.5 * (beside(1.0) + beside(-1.0)), 0.0);
  const double holds = double(points.size()) * kEach * 2.0 * lost / (kAside_m * kAside_m);
  const double said = axes.eigenvalues().x();
  if (!(said > holds)) return information;
  const Eigen::Vector2d u = axes.eigenvectors().col(0);
  Eigen::Matrix3d weaker = Eigen::Matrix3d::Identity();
  weaker.topLeftCorner<2, 2>() -= (1.0 - std::sqrt(holds / said)) * (u * u.transpose());
  return weaker * information * weaker;
}

}  // namespace

Fit refine(const Field& field, std::span<const Eigen::Vector2f> points, const Pose2& start,
           const Pose2& guess, const Window& window) {
  Fit fit{start};
  if (points.empty()) return fit;
  Eigen::Vector3d held = Eigen::Vector3d::Constant(1e-3);
  if (window.guess_m > 0.0) held.head<2>().setConstant(1.0 / (window.guess_m * window.guess_m));
  if (window.guess_rad > 0.0) held.z() = 1.0 / (window.guess_rad * window.guess_rad);
  for (int i = 0; i < kRefinements; ++i) {
    Eigen::Matrix3d seen = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b =
        held.cwiseProduct(Eigen::Vector3d(guess.x_m - fit.pose.x_m, guess.y_m - fit.pose.y_m,
                                          base::wrap_rad(guess.yaw_rad - fit.pose.yaw_rad)));
    const double c = std::cos(fit.pose.yaw_rad);
    const double s = std::sin(fit.pose.yaw_rad);
    double sum = 0.0;
    for (const auto& point : points) {
      const Eigen::Vector2d p = point.cast<double>();
      const Eigen::Vector2d arm(c * p.x() - s * p.y(), s * p.x() + c * p.y());
      Eigen::Vector2d slope;
      const double value = field.sample(arm + Eigen::Vector2d(fit.pose.x_m, fit.pose.y_m), slope);
      sum += value;
      const Eigen::Vector3d j(slope.x(), slope.y(), slope.y() * arm.x() - slope.x() * arm.y());
      seen.noalias() += kEach * (j * j.transpose());
      b += kEach * (1.0 - value) * j;
    }
    fit.score = sum / double(points.size());
    if (i + 1 == kRefinements) {
      seen = without_ripples(field, points, fit, seen);
      fit.covariance = (seen + Eigen::Matrix3d(held.asDiagonal())).inverse();
      break;
    }
    const Eigen::Vector3d step = (seen + Eigen::Matrix3d(held.asDiagonal())).ldlt().solve(b);
    if (!step.allFinite()) return {start};
    // No further than the field is smooth.
    const double most = std::max(step.head<2>().norm() / 0.1, std::abs(step.z()) / 0.05);
    const Eigen::Vector3d taken = most > 1.0 ? Eigen::Vector3d(step / most) : step;
    fit.pose = {fit.pose.x_m + taken.x(), fit.pose.y_m + taken.y(),
                base::wrap_rad(fit.pose.yaw_rad + taken.z())};
  }
  return fit;
}

}  // namespace roverd::nav::mapping
