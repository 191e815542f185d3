#include "nav/mapping/graph.hpp"

#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <ceres/ceres.h>

#include "base/angle.hpp"

namespace roverd::nav::mapping {

namespace {

constexpr double kLoopLoss = 3.0;  // deviations from which on a loop pulls less
constexpr int kIterations = 30;

/// The upper triangle U with UᵀU = covariance⁻¹: it weighs the three numbers.
Eigen::Matrix3d weight_of(const Eigen::Matrix3d& covariance) {
  return Eigen::LLT<Eigen::Matrix3d>(covariance.inverse()).matrixU();
}

struct Between {
  Pose2 x_ab;
  Eigen::Matrix3d weight;

  template <class T>
  bool operator()(const T* a, const T* b, T* out) const {
    using std::cos;
    using std::floor;
    using std::sin;
    const T c = cos(a[2]);
    const T s = sin(a[2]);
    const T dx = b[0] - a[0];
    const T dy = b[1] - a[1];
    T turn = b[2] - a[2] - T(x_ab.yaw_rad);
    constexpr double kTurn = 2.0 * 3.14159265358979323846;
    turn -= T(kTurn) * floor((turn + T(0.5 * kTurn)) / T(kTurn));
    const T e0 = c * dx + s * dy - T(x_ab.x_m);
    const T e1 = c * dy - s * dx - T(x_ab.y_m);
    out[0] = T(weight(0, 0)) * e0 + T(weight(0, 1)) * e1 + T(weight(0, 2)) * turn;
    out[1] = T(weight(1, 1)) * e1 + T(weight(1, 2)) * turn;
    out[2] = T(weight(2, 2)) * turn;
    return true;
  }
};

}  // namespace

double strain(const Edge& edge, std::span<const Pose2> poses) {
  const std::array<double, 3> a = {poses[edge.a].x_m, poses[edge.a].y_m, poses[edge.a].yaw_rad};
  const std::array<double, 3> b = {poses[edge.b].x_m, poses[edge.b].y_m, poses[edge.b].yaw_rad};
  std::array<double, 3> out{};
  Between{edge.x_ab, weight_of(edge.covariance)}(a.data(), b.data(), out.data());
  return std::hypot(out[0], out[1], out[2]);
}

bool relax(std::span<const Edge> edges, std::vector<Pose2>& poses) {
  if (poses.size() < 2 || edges.empty()) return false;
  std::vector<std::array<double, 3>> x;
  x.reserve(poses.size());
  for (const Pose2& p : poses) x.push_back({p.x_m, p.y_m, p.yaw_rad});
  ceres::Problem problem;
  for (const Edge& edge : edges) {
    auto* cost = new ceres::AutoDiffCostFunction<Between, 3, 3, 3>(
        new Between{edge.x_ab, weight_of(edge.covariance)});
    problem.AddResidualBlock(cost, edge.loop ? new ceres::CauchyLoss(kLoopLoss) : nullptr,
                             x[edge.a].data(), x[edge.b].data());
  }
  if (problem.HasParameterBlock(x[0].data())) problem.SetParameterBlockConstant(x[0].data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = kIterations;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) return false;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    poses[i] = {x[i][0], x[i][1], base::wrap_rad(x[i][2])};
  }
  return true;
}

}  // namespace roverd::nav::mapping
