#pragma once
// Ranges to points in S (x ahead, y left). What such a sensor hears lies anywhere on an arc over
// its field of view, so all of the arc is taken for it: points every fan_step_deg, edges included.
//
//        . - .           bearing b, field of view f, range r: points at
//      .   |   .         b − f/2 … b + f/2, all at r
//       \  |  /
//        \ | /           nothing seen: the same fan, Clear or Unknown (Params::clear_to_m)
//          S
//
// Pure; what it allocates is the points: 16 fans of 241 at most.

#include <vector>

#include "base/sight.hpp"
#include "ranges/codec.hpp"
#include "ranges/params.hpp"

namespace roverd::ranges {

class Fans {
 public:
  /// @param params valid (validate); invalid lists become those of the defaults.
  explicit Fans(const Params& params);

  /// @param readings as many as Params::count. Sets points, half_step_rad, clear_to_m.
  void spread(const std::vector<Reading>& readings, base::Sight& sight) const;

 private:
  struct Fan {
    float x_m = 0.0F;
    float y_m = 0.0F;
    std::vector<float> cos{};
    std::vector<float> sin{};
  };
  std::vector<Fan> fans_;
  float half_step_rad_ = 0.0F;
  float max_range_m_;
  float clear_to_m_;
};

/// Metres of Params::unit; empty: there is no such unit.
std::optional<double> metres_of(const std::string& unit);

}  // namespace roverd::ranges
