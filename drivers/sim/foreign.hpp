#pragma once
// Somebody else's plant in place of ours: it moves, and measures as far as it likes to; what it
// does not tell is made here from its truth. The wire, the base's modes and its watchdog stay ours.

#include <optional>

#include "base/geo.hpp"
#include "base/measurements.hpp"

namespace roverd::sim {

/// What the motors shall do for the next 10 ms, after the base's modes, watchdog and limits.
struct ForeignOrder {
  double t_s = 0.0;    ///< the end of it, since the start
  bool brake = false;  ///< e-stop: as hard as it goes, whatever is wanted
  double speed_mps = 0.0;
  double yaw_rate_radps = 0.0;      ///< left positive; not of a car
  std::optional<double> wheel_rad;  ///< of a car, left positive; empty: stays
};

/// One epoch of its receiver, of the antenna where it is.
struct ForeignFix {
  base::FixType fix = base::FixType::None;
  base::EnuPoint at;
  double sigma_m = 0.0;  ///< as claimed
  double speed_mps = 0.0;
  std::optional<double> course_deg;
  std::optional<double> heading_deg;  ///< of two antennas
  double age_s = 0.0;                 ///< of the epoch when its sentences leave
};

/// Metres east and north of the start; compass degrees are already yaw.
struct ForeignState {
  base::EnuPoint at;
  double yaw_rad = 0.0;
  double speed_mps = 0.0;
  double lateral_mps = 0.0;  ///< left positive
  double yaw_rate_radps = 0.0;
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
  double left_mps = 0.0;  ///< what the encoders see; of a car both are the wheels'
  double right_mps = 0.0;
  std::optional<double> wheel_rad;    ///< of a car: as its sensor sees it
  std::optional<double> gyro_radps;   ///< as the gyro shows it
  std::optional<double> compass_deg;  ///< as the compass shows it
  std::optional<ForeignFix> fix;      ///< an epoch that is told now
};

class Foreign {
 public:
  static constexpr double kStep_s = 0.01;

  virtual ~Foreign() = default;
  Foreign(const Foreign&) = delete;
  Foreign& operator=(const Foreign&) = delete;

  /// Once every 10 ms. Nothing is thrown; one that fails stays where it was.
  virtual const ForeignState& step(const ForeignOrder& order) = 0;
  virtual const ForeignState& state() const noexcept = 0;
  /// It has a receiver of its own.
  virtual bool has_gnss() const noexcept = 0;

 protected:
  Foreign() = default;
};

}  // namespace roverd::sim
