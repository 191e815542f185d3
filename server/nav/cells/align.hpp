#pragma once
// How one cloud lies in another (a scan in a map, a scan in the scan before), with how sure that is
// and whether it is to be believed.
//
// Frames: S of the source, T of the target; X_TS takes points of S to T. Coarse cells first,
// distribution to distribution (Stoyanov, Magnusson, Lilienthal 2012), from the start and from
// places around it; then surfels, plane to plane (Segal, Haehnel, Thrun 2009), each with
//   sum of w(d²) d²,  d² = eᵀ (C_T + R C_S Rᵀ)⁻¹ e,  e = m_T - X_TS m_S,  w = (9 / (9 + d²))²
// (Geman and McClure's estimator: what does not fit stops pulling).
//
// A wrong place can fit, too: the verdict says Good only where enough of the source was found, at
// the distances that surfaces seen twice have, where every direction is held, and where no other
// start led to another place that fits as well.

#include <string_view>

#include <Eigen/Geometry>

#include "nav/cells/relief.hpp"

namespace roverd::nav::cells {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

struct AlignParams {
  /// How far the start may be wrong: other starts lie that far to its sides.
  double search_m = 1.0;
  double search_rad = 0.17;
  /// False: it is right within half a cell or so, as from one cloud to the next. Nothing is
  /// searched but the fine place, and Ambiguous is never found.
  bool coarse = true;
  /// Of the place that was found also its four sides so far away are settled, and the best is
  /// taken: the other face of a thin wall is found from there. 0: none.
  double beside_m = 0.0;
  /// Least share of the source's surfels that must be found in the target. Less: LittleOverlap.
  double least_overlap = 0.5;
  /// A surfel is found where it lies within so many cells' lengths of a target's surface.
  double found_cells = 0.5;
  /// Largest deviation of position, in cells' lengths, and of direction. More: Loose.
  double loose_cells = 0.5;
  double loose_rad = 0.02;
  /// No surer than that, however many points: what scans distorted by motion, sparse rings and
  /// the choice of method change (docs/figures.md). Added to the covariance's root.
  double floor_cells = 0.05;
  double floor_rad = 0.004;
};

enum class Verdict {
  Good,
  Nothing,        ///< one of the two holds no surface at all, or the start is no number
  Unsettled,      ///< still moving after the last step
  LittleOverlap,  ///< too little of the source is found in the target
  Loose,          ///< some direction is held by too little: a corridor, a plain
  Ambiguous,      ///< another start led elsewhere and fits as well
};
std::string_view to_string(Verdict v) noexcept;  // good nothing unsettled "little overlap" loose …

struct Alignment {
  Eigen::Isometry3d x_ts = Eigen::Isometry3d::Identity();
  /// Of x_ts: [x y z of S's origin in T, m; turn about T's axes through it, rad].
  Matrix6d covariance = Matrix6d::Zero();
  Verdict verdict = Verdict::Nothing;
  double overlap = 0.0;  ///< share of the source's surfels found in the target, [0, 1]
  double upright = 0.0;  ///< the same of those that stand: ground fits ground anywhere
  double fit_m = 0.0;    ///< rms across the surfaces of those found
  double rival = 0.0;    ///< fit of the best other place over that of this one; 0: none was met
  int steps = 0;         ///< of the last, fine stage
};

/// @param start X_TS, wrong by search_m and search_rad at most. Pure; time grows with the source's
/// cells, and with the logarithm of the target's. Both should have cells of one size.
Alignment align(const Relief& source, const Relief& target, const Eigen::Isometry3d& start,
                const AlignParams& params = {});

}  // namespace roverd::nav::cells
