#pragma once
// Trees over the antenna: fix classes that come and go, and a slow error that nobody claims.

#include <cstdint>

#include "base/measurements.hpp"
#include "sim/ground_params.hpp"
#include "sim/noise.hpp"

namespace roverd::sim {

class Canopy {
 public:
  explicit Canopy(std::uint64_t seed);

  /// Once an epoch, wherever the antenna is: what comes later does not depend on it.
  void step(const TreesParams& p, bool under, double dt_s);

  /// @param open the class under an open sky.
  base::FixType through(const TreesParams& p, base::FixType open) const noexcept;
  bool under() const noexcept { return under_; }
  double east_m() const noexcept { return east_m_; }  ///< further error of the position
  double north_m() const noexcept { return north_m_; }

 private:
  Noise draws_;
  Drift east_, north_;
  double draw_;
  double held_s_ = 0.0;
  double cover_ = 0.0;  ///< 0 in the open, 1 well under them
  bool under_ = false;
  double east_m_ = 0.0;
  double north_m_ = 0.0;
};

}  // namespace roverd::sim
