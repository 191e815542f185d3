#pragma once
// How a side of a box goes, by a straight line through where it was; and two opposite ones. Of
// movers.cpp.

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace roverd::nav::sense {

constexpr double kOut_m = 0.01;  ///< a line is not surer than a side that is so far out

/// A straight line through what was measured.
struct SideLine {
  double slope = 0.0;
  double sigma = 0.0;
};

template <class Of>
SideLine line_through(std::size_t n, const Of& of) {
  double t = 0.0;
  double y = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const auto [ti, yi] = of(i);
    t += ti / static_cast<double>(n);
    y += yi / static_cast<double>(n);
  }
  double tt = 0.0;
  double ty = 0.0;
  double yy = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const auto [ti, yi] = of(i);
    tt += (ti - t) * (ti - t);
    ty += (ti - t) * (yi - y);
    yy += (yi - y) * (yi - y);
  }
  SideLine out;
  if (tt <= 0.0) return {0.0, 1e3};
  out.slope = ty / tt;
  const double rest = std::max(0.0, yy - out.slope * ty) / static_cast<double>(n - 2);
  out.sigma = std::sqrt((rest + kOut_m * kOut_m) / tt);
  return out;
}

/// Along one axis, of two opposite sides.
struct Going {
  double mean = 0.0;
  double sure = 0.0;  ///< the slower of the two; 0: they part, or meet
  double sigma = 0.0;
};

inline Going going(const SideLine& low, const SideLine& high) noexcept {
  Going out;
  out.sigma = std::max({low.sigma, high.sigma, 0.5 * std::abs(low.slope - high.slope)});
  if (low.slope * high.slope <= 0.0) return out;
  out.mean = 0.5 * (low.slope + high.slope);
  out.sure = std::abs(low.slope) < std::abs(high.slope) ? low.slope : high.slope;
  return out;
}

}  // namespace roverd::nav::sense
