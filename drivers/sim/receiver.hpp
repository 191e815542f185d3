#pragma once
// The GNSS receiver on the robot and the compass that speaks beside it: once an epoch they look at
// the truth, add their errors, and deliver sentences a latency later.

#include <deque>
#include <optional>
#include <string>

#include "base/geo.hpp"
#include "base/measurements.hpp"
#include "base/time.hpp"
#include "sim/canopy.hpp"
#include "sim/foreign.hpp"
#include "sim/kick.hpp"
#include "sim/noise.hpp"
#include "sim/params.hpp"
#include "sim/radio.hpp"

namespace roverd::sim {

using base::Time;

/// 1 sigma per horizontal axis. `white` is new at every epoch, the others are Gauss-Markov
/// processes: neighbours in time are alike.
struct FixErrors {
  base::FixType fix = base::FixType::None;
  double white_m = 0.0;
  double drift_m = 0.0;
  double drift_tau_s = 60.0;
  double velocity_mps = 0.0;
  int satellites = 0;
  double hdop = 99.9;
  double slow_m = 0.0;  ///< orbits and the ionosphere
  double slow_tau_s = 900.0;
  double fast_m = 0.0;  ///< of the receiver's own filter
  double fast_tau_s = 4.0;
  double velocity_drift_mps = 0.0;  ///< Doppler is not white either
  double velocity_tau_s = 10.0;
};

/// The errors of a fix class. Source of the drift figures: D. L. Wilson, GPS error correlation.
FixErrors errors_of(base::FixType fix) noexcept;
/// Likewise of a receiver of that profile: "plain" knows more of its errors than its class.
FixErrors errors_of(base::FixType fix, std::string_view profile) noexcept;
base::FixType fix_of_profile(std::string_view profile) noexcept;
/// Empty: not one of none, gps, dgps, rtk_float, rtk_fixed.
std::optional<base::FixType> fix_from(std::string_view word) noexcept;

/// What is true at one instant, at the body's origin.
struct BodyState {
  Time time;
  base::WallTime utc;
  base::EnuPoint at;
  double yaw_rad = 0.0;
  double east_mps = 0.0;
  double north_mps = 0.0;
  double yaw_rate_radps = 0.0;
  double roll_rad = 0.0;   ///< right side down positive
  double pitch_rad = 0.0;  ///< nose up positive
  double up_m = 0.0;       ///< above the start
  double up_mps = 0.0;
  bool under_trees = false;
  // Of a plant that measures itself; all else is made from the truth.
  std::optional<double> gyro_radps{};
  std::optional<double> compass_deg{};
  bool own_gnss = false;
  std::optional<ForeignFix> fix{};  ///< an epoch that is told now
};

/// What the receiver and the compass make of it.
struct Epoch {
  base::WallTime utc;
  FixErrors errors;
  std::optional<base::LatLon> position;  ///< empty without a fix
  double alt_msl_m = 0.0;
  double geoid_sep_m = 0.0;
  double speed_mps = 0.0;
  std::optional<double> course_deg;  ///< empty below 0.1 m/s, as receivers do
  double sigma_m = 0.0;              ///< per axis, honest but under trees and of lies
  int station = 1;                   ///< whose corrections, where there are any
  std::optional<double> heading_deg;
};

/// Text of one epoch: GGA RMC VTG GST, HDT where there is a heading, and the sky once a second.
std::string sentences(const Epoch& epoch);

/// GSA and GSV of four systems: as many used as the epoch has satellites.
std::string sky_sentences(const Epoch& epoch);

class Receiver {
 public:
  Receiver(std::uint64_t seed, const base::LocalFrame& frame);

  /// Once a step. @param now truth at the end of the step. @param motor_difference_a right minus
  /// left motor current. @return what leaves the receiver during this step; usually empty.
  std::string step(const Params& p, const Faults& faults, const BodyState& now,
                   double motor_difference_a);

 private:
  /// What is added to the truth at an epoch.
  struct Added {
    double east_m = 0.0;
    double north_m = 0.0;
    double up_m = 0.0;
    double east_mps = 0.0;
    double north_mps = 0.0;
  };
  Epoch measure(const Params& p, const Faults& faults, BodyState truth);
  Added noise(const FixErrors& e, double dt_s);
  void feel(const BodyState& now, double lag_s, double dt_s);
  /// Whatever the receiver tells although it is not so.
  void lie(Added& added, const Faults& faults, base::FixType fix, double dt_s);
  void look(Epoch& epoch, const Params& p, const BodyState& truth, const Added& added) const;
  std::optional<double> heading_deg(const Params& p, const Faults& faults, const BodyState& truth,
                                    bool fix);
  /// What somebody else's receiver measured.
  Epoch pass_on(const Params& p, const Faults& faults, const BodyState& now) const;
  void corrupt(Epoch& epoch, const Faults& faults);

  struct Pending {
    Time due;
    std::string text;
  };

  base::LocalFrame frame_;
  Noise east_, north_, height_, velocity_, compass_, antennas_;
  Drift drift_east_, drift_north_;
  Drift slow_east_, slow_north_, fast_east_, fast_north_, velocity_east_, velocity_north_;
  Canopy canopy_;
  Kick kick_;
  std::optional<Time> last_epoch_;
  std::optional<Time> last_step_;
  std::deque<Pending> pending_;
  base::EnuPoint run_away_;                 ///< by gnss_drift_*
  std::optional<base::EnuPoint> felt_mps_;  ///< the velocity, by velocity_lag_s behind
  std::optional<Epoch> last_told_;          ///< what a frozen receiver repeats of it
  std::optional<std::string> last_text_;    ///< what one repeats that hangs
};

}  // namespace roverd::sim
