#pragma once
// One smooth curve through a chain of points that noise has moved, as stiff as they allow.
//
//   · ·   ·       what noise explains is smoothed away; what it does not explain is followed:
//  ───·───── · ─  where the residuals' mean over a window is not what points with this noise have,
//   ·     ·       the curve becomes more supple there; where the tolerance is passed, it is pulled
//
// The noise is measured from the points themselves. Pure; lengths m, angles rad; linear in the
// points but for a search in a sorted list.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "base/geo.hpp"
#include "nav/track/spline.hpp"

namespace roverd::nav {

using base::EnuPoint;

/// Points in order, and how far along each counts. `u` grows strictly.
struct Chain {
  std::vector<EnuPoint> at;
  std::vector<double> u;

  EnuPoint place(double u_m) const noexcept;  ///< on the polyline
};

/// Counts along the way as it is without noise: from one point to the next one that is a little
/// apart, what lies between in proportion. @param points two or more, neighbours differ.
Chain chain_of(std::vector<EnuPoint> points);

/// Standard deviation across the way, robust against corners and single outliers; 0: too few.
double noise_m(const Chain& chain);

struct PieceEnds {
  std::optional<EnuPoint> begin;  ///< held there; empty: as the points have it
  std::optional<EnuPoint> end;
  bool straight_in = false;  ///< its first leg is driven straight for a while
  bool straight_out = false;
};

struct FitLimits {
  /// Beside a point. One that noise threw out, or two side by side, up to four sigmas of it, are no
  /// reason for a bend: where points lie 0.15 m apart or less, and their neighbours keep to this,
  /// 1.4 times.
  double tolerance_m = 0.1;
  double noise_m = 0.0;
  double shortest_m = 0.6;    ///< waves shorter than this are never followed
  double sharpest_1pm = 1.7;  ///< what bends more, by more than the turn below, is a corner
  double corner_rad = 0.5;
};

struct CurvePoint {
  EnuPoint at;
  double u = 0.0;
  double curvature_1pm = 0.0;  ///< of the way from here to the next one; left positive
};

class PieceFit {
 public:
  PieceFit(Chain chain, const PieceEnds& ends, const FitLimits& limits);

  /// Points of the chain, neither its first nor its last, that are corners after all.
  std::vector<std::size_t> corners() const;
  /// The curve in points; the way between two of them is an arc.
  std::vector<CurvePoint> points() const;
  /// What was fitted: each point counts where the curve comes nearest to it, as far as their order
  /// allows.
  const Chain& chain() const noexcept { return chain_; }

 private:
  void lay_data();
  void refit();
  void adapt();
  bool soften();
  void soften_about(double u, double half_m, std::vector<char>& softer) const;
  void keep_tolerance();
  void count_where_nearest();
  std::size_t piece_of(double u) const noexcept;

  Chain chain_;
  PieceEnds ends_;
  FitLimits limits_;
  double spacing_m_;
  SmoothSpline curve_;
  std::vector<SplineDatum> data_;
  std::vector<double> wave_m_;  ///< by piece: the shortest wave that is followed there
};

/// How far a polyline of points of a curve and the chain are apart where both have come equally far
/// along, which is at least as much as either is from the other anywhere.
struct Apart {
  double m = 0.0;
  double beyond_m = -1e9;  ///< what may be; > 0: too far
  double u = 0.0;          ///< where most beyond
};
Apart apart(const Chain& chain, std::span<const CurvePoint> points, const FitLimits& limits);

}  // namespace roverd::nav
