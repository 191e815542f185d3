#pragma once
// A tag (a printed square with a number) that a camera sees or saw, told from the body.

#include <cstdint>
#include <optional>
#include <string>

#include "base/time.hpp"

namespace roverd::base {

struct TagState {
  int id = 0;
  double ahead_m = 0.0;  ///< from the body now; by the odometry since it was seen
  double left_m = 0.0;
  double sigma_m = 0.0;           ///< 1 sigma of that place
  std::optional<double> yaw_rad;  ///< the way somebody looks who faces it, against the body's;
                                  ///< empty: in doubt
  std::optional<double> yaw_sigma_rad;
  std::string camera;        ///< that saw it last
  std::uint64_t sights = 0;  ///< images that it was taken from
  Time seen_at;
};

}  // namespace roverd::base
