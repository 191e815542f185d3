#pragma once
// The row that a mission drives along, as it is seen now.

#include <optional>
#include <string_view>

namespace roverd::base {

/// What is seen of it.
struct RowInSight {
  double offset_m = 0.0;          ///< of the vehicle from the line that it follows, left positive
  double angle_rad = 0.0;         ///< of the vehicle against it, left positive
  double sigma_m = 0.0;           ///< 1 sigma of where the line lies 1.5 m ahead
  double certainty = 0.0;         ///< 1: as sure as full speed needs; 0: it stands for want of it
  std::optional<double> width_m;  ///< between both sides' plants
  std::optional<double> width_sigma_m;
  std::optional<double> to_end_m;  ///< where nothing comes behind the last plants
  double age_s = 0.0;
};

struct RowState {
  int item = 0;
  std::string_view side;    ///< both, left, right
  std::string_view seeing;  ///< line, rays
  /// seeking: none is seen yet; driving; waiting: it stands for want of one.
  std::string_view state;
  double driven_m = 0.0;         ///< along the row, as it was seen
  std::optional<double> left_m;  ///< to where the item ends; empty: that is not seen yet

  std::optional<RowInSight> seen;  ///< empty: nothing is
};

}  // namespace roverd::base
