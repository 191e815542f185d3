#include "nav/rows/fit.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace roverd::nav::rows {
namespace {

constexpr double kPiece_m = 0.5;
constexpr std::size_t kLeastMarks = 3;   // of a piece
constexpr double kMarkSigma_m = 0.10;    // foliage: of one mark within its piece
constexpr double kDriftPerMetre = 0.01;  // of the odometry, since a mark was seen
constexpr double kSameLook_m = 0.4;      // of way
constexpr double kDriftSigma = 0.02;     // of what is known of the drift
constexpr double kTightest_1pm = 1.0 / 10.0;
constexpr double kCauchy = 2.0;
constexpr int kRounds = 4;

using Vector5 = Eigen::Matrix<double, 5, 1>;
using Matrix5 = Eigen::Matrix<double, 5, 5>;

double median_of(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

void pieces_of(const std::vector<Mark>& marks, const Line& line, Sides sides, double gate_m,
               const RowParams& params, std::vector<Piece>& out) {
  out.clear();
  const auto count =
      static_cast<std::size_t>(std::ceil((params.ahead_m + params.behind_m) / kPiece_m));
  struct Seen {
    Along at;
    double ago_m = 0.0;
  };
  struct Held {
    std::vector<Seen> seen;
    double newest_m = 1e9;
  };
  std::vector<Held> held(2 * count);
  const Pose2 to_line = sense::inverse(line.at);
  const double c = std::cos(to_line.yaw_rad);
  const double s = std::sin(to_line.yaw_rad);
  for (const Mark& m : marks) {
    const double x = to_line.x_m + c * m.x_m - s * m.y_m;
    const double y = to_line.y_m + s * m.x_m + c * m.y_m;
    const Along at = beside_arc(x, y, line.curvature_1pm);
    if (at.s_m < -params.behind_m || at.s_m >= params.ahead_m) continue;
    const int side = at.d_m > 0.0 ? 1 : -1;
    if ((side > 0 && sides == Sides::Right) || (side < 0 && sides == Sides::Left)) continue;
    if (std::abs(std::abs(at.d_m) - 0.5 * line.width_m) > gate_m) continue;
    const auto i =
        std::min(count - 1, static_cast<std::size_t>((at.s_m + params.behind_m) / kPiece_m));
    Held& h = held[side > 0 ? i : count + i];
    h.seen.push_back({at, m.ago_m});
    h.newest_m = std::min(h.newest_m, m.ago_m);
  }
  std::vector<double> d_m;
  for (std::size_t i = 0; i < held.size(); ++i) {
    const Held& h = held[i];
    Piece piece;
    d_m.clear();
    // Where it is still seen, what it looked like from afar does not count.
    for (const Seen& one : h.seen) {
      if (one.ago_m > h.newest_m + kSameLook_m) continue;
      d_m.push_back(one.at.d_m);
      piece.s_m += one.at.s_m;
      piece.ago_m += one.ago_m;
    }
    if (d_m.size() < kLeastMarks) continue;
    const auto n = double(d_m.size());
    piece.s_m /= n;
    piece.ago_m /= n;
    const double drift_m = kDriftPerMetre * piece.ago_m;
    piece.sigma_m = std::sqrt(params.plant_m * params.plant_m + kMarkSigma_m * kMarkSigma_m / n +
                              drift_m * drift_m);
    piece.d_m = median_of(d_m);
    piece.side = i < count ? 1 : -1;
    out.push_back(piece);
  }
}

Fitted fit_line(const std::vector<Mark>& marks, Sides sides, double gate_m, const WidthPrior& prior,
                const LinePrior& known, const RowParams& params, Line& line,
                std::vector<Piece>& pieces) {
  Fitted out;
  Line now = line;
  const double before[5] = {known.aside_m, known.turned_rad, known.curvature_sigma_1pm,
                            std::max(1e-4, prior.sigma_m), kDriftSigma};
  Matrix5 information = Matrix5::Zero();
  double chi = 0.0;
  double weights = 0.0;
  std::vector<double> off;
  for (int round = 0; round < kRounds; ++round) {
    pieces_of(marks, now, sides, gate_m, params, pieces);
    if (pieces.size() < 3) return out;
    off.clear();
    for (const Piece& p : pieces) off.push_back(std::abs(p.d_m - p.side * 0.5 * now.width_m));
    out.spread_m = 1.4826 * median_of(off);
    Vector5 gradient = Vector5::Zero();
    information.setZero();
    // What is known before: rows are rather straight, as wide as they were, and drift as they did.
    for (int i = 0; i < 5; ++i) information(i, i) = 1.0 / (before[i] * before[i]);
    const Pose2 moved = sense::inverse(line.at) * now.at;
    gradient(0) = -moved.y_m * information(0, 0);
    gradient(1) = -moved.yaw_rad * information(1, 1);
    gradient(2) = (known.curvature_1pm - now.curvature_1pm) * information(2, 2);
    gradient(3) = (prior.width_m - now.width_m) * information(3, 3);
    gradient(4) = -out.drift * information(4, 4);
    chi = weights = 0.0;
    for (const Piece& p : pieces) {
      const double r = p.d_m - p.side * 0.5 * now.width_m + out.drift * p.ago_m;
      const double part = r / (kCauchy * p.sigma_m);
      const double robust = 1.0 / (1.0 + part * part);
      const double w = robust / (p.sigma_m * p.sigma_m);
      Vector5 j;
      j << 1.0, p.s_m, 0.5 * p.s_m * p.s_m, 0.5 * p.side, -p.ago_m;
      information += w * j * j.transpose();
      gradient += w * r * j;
      chi += w * r * r;
      weights += robust;
    }
    const Vector5 step = information.ldlt().solve(gradient);
    if (!step.allFinite()) return out;
    now.at = now.at * Pose2{0.0, step(0), step(1)};
    now.curvature_1pm = std::clamp(now.curvature_1pm + step(2), -kTightest_1pm, kTightest_1pm);
    now.width_m += step(3);
    out.drift += step(4);
  }
  if (now.width_m < 0.5 * params.width_min_m || now.width_m > 2.0 * params.width_max_m) return out;
  for (const Piece& p : pieces) ++(p.side > 0 ? out.left : out.right);
  // Where plants scatter more than was said, so does the line.
  const double worse = std::max(1.0, chi / std::max(1.0, weights - 4.0));
  const Matrix5 p = worse * information.ldlt().solve(Matrix5::Identity());
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) now.covariance[static_cast<std::size_t>(4 * r + c)] = p(r, c);
  }
  line = now;
  out.good = true;
  return out;
}

}  // namespace roverd::nav::rows
