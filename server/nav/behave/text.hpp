#pragma once
// Figures in the words of a notice.

#include <cmath>
#include <string>

#include "base/angle.hpp"
#include "nav/track/slope.hpp"
#include "nav/track/tracker.hpp"

namespace roverd::nav {

/// "1.4 m"
inline std::string tenths_text(double m) {
  const long rounded = std::lround(m * 10.0);
  return std::to_string(rounded / 10) + "." + std::to_string(rounded % 10) + " m";
}

/// Why it does not turn on the spot there.
inline std::string steep_text(const Vehicle& v, const SlopeParams& p) {
  const auto deg = [](double rad) { return std::to_string(std::lround(base::deg_from_rad(rad))); };
  return "too steep to turn on the spot: leans " + deg(lean_rad(v.roll_rad, v.pitch_rad)) +
         " deg, at most " + deg(base::rad_from_deg(p.pivot_deg)) + " deg";
}

}  // namespace roverd::nav
