// Heights of bodies from rises between them, as weighted least squares.

#include <cmath>

#include <Eigen/SparseCholesky>

#include "nav/mapping/clouds.hpp"

namespace roverd::nav::mapping {

namespace {

constexpr int kRounds = 5;
constexpr double kLoss = 2.0;  // deviations from which on a rise pulls less

/// Cauchy's weight of a rise by how far it is from what holds.
double weight_of(const Rise& rise, std::span<const double> heights) {
  const double off = (heights[rise.b] - heights[rise.a] - rise.m) / rise.sigma_m;
  return 1.0 / ((1.0 + off * off / (kLoss * kLoss)) * rise.sigma_m * rise.sigma_m);
}

}  // namespace

std::vector<double> levelled(std::size_t count, std::span<const Rise> rises) {
  std::vector<double> heights(count, 0.0);
  if (count < 2) return heights;
  // Along the way first: what is far from it then is wrong, and not what it is compared with.
  for (const Rise& r : rises) {
    if (r.b == r.a + 1) heights[r.b] = heights[r.a] + r.m;
  }
  const auto n = static_cast<Eigen::Index>(count - 1);  // the first stays
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Eigen::Triplet<double>> rows;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
    const auto put = [&](std::size_t of, std::size_t with, double w) {
      if (of == 0 || with == 0) return;
      rows.emplace_back(static_cast<int>(of - 1), static_cast<int>(with - 1), w);
    };
    for (const Rise& r : rises) {
      const double w = weight_of(r, heights);
      put(r.a, r.a, w);
      put(r.b, r.b, w);
      put(r.a, r.b, -w);
      put(r.b, r.a, -w);
      if (r.a > 0) right(static_cast<Eigen::Index>(r.a - 1)) -= w * r.m;
      if (r.b > 0) right(static_cast<Eigen::Index>(r.b - 1)) += w * r.m;
    }
    Eigen::SparseMatrix<double> sum(n, n);
    sum.setFromTriplets(rows.begin(), rows.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(sum);
    if (solver.info() != Eigen::Success) return heights;
    const Eigen::VectorXd found = solver.solve(right);
    if (!found.allFinite()) return heights;
    for (std::size_t i = 1; i < count; ++i) heights[i] = found(static_cast<Eigen::Index>(i - 1));
  }
  return heights;
}

}  // namespace roverd::nav::mapping
