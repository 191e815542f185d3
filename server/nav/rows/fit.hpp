#pragma once
// An arc through the plants of one or two sides, robustly, with a covariance that holds: what
// stands within half a metre of a side counts as one measurement, because it leans together.

#include <array>
#include <cstddef>
#include <vector>

#include "nav/rows/marks.hpp"
#include "nav/rows/params.hpp"
#include "nav/rows/view.hpp"

namespace roverd::nav::rows {

/// The line as it is estimated.
struct Line {
  Pose2 at;  ///< X_OL
  double curvature_1pm = 0.0;
  double width_m = 0.0;
  /// Of [shift, direction, curvature, width], rows first.
  std::array<double, 16> covariance{};
};

/// What is known of the width already.
struct WidthPrior {
  double width_m = 0.0;
  double sigma_m = 0.0;
};

/// What is known of the line already; as it is, nearly nothing: rows are rather straight.
struct LinePrior {
  double aside_m = 1.0;     ///< 1 sigma of where it lies
  double turned_rad = 0.5;  ///< and of its direction
  double curvature_1pm = 0.0;
  double curvature_sigma_1pm = 0.08;  ///< radii down to 12 m
};

/// Half a metre of one side.
struct Piece {
  double s_m = 0.0;  ///< from L, mean
  double d_m = 0.0;  ///< median
  double sigma_m = 0.0;
  int side = 1;        ///< +1 left, −1 right
  double ago_m = 0.0;  ///< way since it was seen, mean
};

struct Fitted {
  bool good = false;  ///< there was enough to fit
  int left = 0;       ///< pieces
  int right = 0;
  double drift = 0.0;     ///< of older marks to the right for each metre since: RowView::drift
  double spread_m = 0.0;  ///< by which pieces stand off the line, robust 1 sigma
};

/// The pieces within the window and the gate about a line.
/// @param sides whose plants count. @param gate_m about ±width/2.
void pieces_of(const std::vector<Mark>& marks, const Line& line, Sides sides, double gate_m,
               const RowParams& params, std::vector<Piece>& out);

/// Moves the line to where the plants are. On failure it stays as it was.
/// @param known of the line as it is handed in
/// @param pieces a buffer; holds the last ones.
Fitted fit_line(const std::vector<Mark>& marks, Sides sides, double gate_m, const WidthPrior& prior,
                const LinePrior& known, const RowParams& params, Line& line,
                std::vector<Piece>& pieces);

}  // namespace roverd::nav::rows
