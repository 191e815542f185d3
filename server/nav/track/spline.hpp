#pragma once
// A curve through the plane as a cubic B-spline with equal pieces, fitted to weighted points:
//
//   minimise  Σ wₖ·|c(uₖ) − pₖ|² + Σ gᵢ·|Δ³cᵢ|²
//
// The third difference of the control points is the third derivative of the curve: what is paid for
// is a change of curvature, so that lines and wide bends cost nothing. Both sums couple at most
// four neighbours: one banded Cholesky, linear in points and pieces.
// Source: Eilers and Marx 1996 (P-splines); Reinsch 1967. Pure; lengths m.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "base/geo.hpp"

namespace roverd::nav {

struct SplineDatum {
  double u = 0.0;
  base::EnuPoint at;
  double weight = 1.0;  ///< > 0
};

struct SplinePlace {
  base::EnuPoint at;
  base::EnuPoint first;   ///< derivative by u
  base::EnuPoint second;  ///< likewise
};

class SmoothSpline {
 public:
  /// @param length of u, > 0. @param piece_m about as long as this is one piece.
  SmoothSpline(double length, double piece_m);

  std::size_t pieces() const noexcept { return pieces_; }
  double piece() const noexcept { return piece_; }
  /// @param stiffness of each piece, > 0. Few data: the rest is as stiffness wants it.
  void fit(std::span<const SplineDatum> data, std::span<const double> stiffness);
  /// @param u is held to [0, length].
  base::EnuPoint at(double u) const noexcept;
  SplinePlace place(double u) const noexcept;

 private:
  using Row = std::array<double, 4>;  ///< the diagonal, then its three neighbours before it
  struct Within {
    std::size_t piece;
    double part;
  };
  Within within(double u) const noexcept;
  void factor();
  void solve() noexcept;

  std::size_t pieces_ = 1;
  double piece_ = 1.0;
  std::vector<base::EnuPoint> control_;  ///< pieces + 3
  std::vector<Row> matrix_;
};

}  // namespace roverd::nav
