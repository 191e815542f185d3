#pragma once
// The filter's arithmetic, without sensors or time: one belief, one prediction, one update.
//
//   x = [east_m, north_m, yaw_rad, gyro_bias_radps, compass_bias_rad, compass_left_radpa,
//        compass_right_radpa, odometry_scale, yaw_scale, pull_1pm, drift_east_m, drift_north_m,
//        crab, slide_east, slide_north, pivot_m]ᵀ ,
//   P is 16×16 in that order.
//
// The position is that of the body's origin in the local frame. A gyro shows w + gyro_bias. A
// compass shows yaw + compass_bias + compass_left·I_left + compass_right·I_right (motor currents,
// A). The tracks say v_odo and w_odo; the ground sees v = odometry_scale·v_odo and w =
// yaw_scale·w_odo + pull·v_odo: a skid-steer turns less than its tracks claim, and bends to one
// side where one track grips better. A receiver shows position + drift, drift being a slow
// Gauss-Markov process that vanishes with RTK fixed.
//
// No robot drives exactly where it points. For each metre of its tracks it moves `crab` metres to
// its left (to the right when it reverses), and by the vector `slide`, the same whichever way it
// points: downhill. On one straight line a heading, the crab and the slide across it cannot be told
// apart, and need not be; the first turn parts the slide from the other two. Both fade with the way
// driven, for the ground changes.
//
// Nor does a skid-steer turn about its origin: the centre of its turns lies `pivot` metres ahead of
// that, by how its load lies, and for each radian to the left the origin moves as far to the right.
// Positions cannot tell it from an antenna that is mounted elsewhere than they were told.
//
// The yaw is the gyro's integral where there is one: Pentzer 2014 found 0.42 m of error over 40 m
// for the best that tracks can tell. Without a gyro it is the tracks'.

#include <optional>

#include <Eigen/Dense>

namespace roverd::nav {

enum StateIndex : int {
  kEast,
  kNorth,
  kYaw,
  kGyroBias,
  kBias,
  kCompassLeft,
  kCompassRight,
  kScale,
  kYawScale,
  kPull,
  kDriftE,
  kDriftN,
  kCrab,
  kSlideE,
  kSlideN,
  kPivot,
  kStates
};

using StateVector = Eigen::Matrix<double, kStates, 1>;
using StateMatrix = Eigen::Matrix<double, kStates, kStates>;

struct Belief {
  StateVector x = StateVector::Zero();
  StateMatrix P = StateMatrix::Zero();
};

/// What the tracks did in one step, as they measure it.
struct Travel {
  double ahead_m = 0.0;
  double turn_rad = 0.0;
  double dt_s = 0.0;                 ///< > 0
  std::optional<double> gyro_rad{};  ///< turned by the gyro, its bias included; empty: none
};

/// Slow drift of the position source.
struct Drift {
  double sigma_m = 0.0;
  double tau_s = 60.0;
};

/// How little the way over the ground may be what the tracks make of it.
struct Slip {
  double scale_noise = 6e-4;  ///< of the scale, per √m
  double slide_noise = 2e-3;  ///< of the slide, each way, per √m
  double crab_sigma = 0.01;   ///< of the crab, where nothing is known of it
};

/// Advances the belief by one step of odometry. `standing`: nothing turns, so nothing but the drift
/// and the sensors' biases get less certain. Noise densities are those of a 1.3 m/s tracked
/// vehicle.
void predict(Belief& b, const Travel& travel, const Slip& slip, const Drift& drift,
             bool standing) noexcept;

/// The way of one radian to the left, of the turn alone, in ENU.
Eigen::Vector2d way_per_rad(const StateVector& x, double yaw_rad) noexcept;

/// The way of one metre forwards (`way` 1) or backwards (−1) of the tracks, in ENU.
Eigen::Vector2d way_per_m(const StateVector& x, double yaw_rad, double way) noexcept;

/// What is known of the motion without odometry.
struct Coast {
  Eigen::Vector2d velocity_mps{0.0, 0.0};  ///< over ground, east and north
  double sigma_mps = 0.0;                  ///< of it, each way, the same error all the time
  double blind_s = 0.0;                    ///< since odometry or a position told where it is
  std::optional<double> gyro_rad{};        ///< as in Travel
};

/// Advances without odometry. The error of the velocity adds up with time, not with its root:
/// without a position for t seconds sigma grows to sigma_mps · t.
void predict_coasting(Belief& b, const Coast& coast, double dt_s, const Drift& drift) noexcept;

/// y'S⁻¹y limits, 99.9 % of a chi-square with one and two degrees of freedom.
inline constexpr double kGate1 = 10.8;
inline constexpr double kGate2 = 13.8;

/// One measurement of M values, linearised.
template <int M>
struct Observation {
  Eigen::Matrix<double, M, 1> innovation;  ///< measured − expected, angles wrapped
  Eigen::Matrix<double, M, kStates> H = Eigen::Matrix<double, M, kStates>::Zero();
  Eigen::Matrix<double, M, M> R = Eigen::Matrix<double, M, M>::Zero();
  double gate = 0.0;  ///< 0: none
  /// 1 for a state this measurement may change, 0 for one it only has to consider.
  StateVector may_change = StateVector::Ones();
};

/// Right for any gain, symmetrised, yaw wrapped, scales bounded to [0.5, 1.2] and [0.3, 1.5], pull
/// to ±0.3 /m, the gyro's bias to ±0.2 rad/s, crab to ±0.3, the slide to ±0.4 each way, the pivot
/// to ±1 m.
/// @param change what was added to x (for past states). @param nis y'S⁻¹y, NaN where not finite.
/// @return false: outside the gate, or not finite; nothing changed.
template <int M>
bool update(Belief& b, const Observation<M>& o, StateVector& change, double& nis) noexcept;

extern template bool update<1>(Belief&, const Observation<1>&, StateVector&, double&) noexcept;
extern template bool update<2>(Belief&, const Observation<2>&, StateVector&, double&) noexcept;

/// Sets one state to a value of its own, uncorrelated with the others.
void reset_state(Belief& b, StateIndex i, double value, double sigma) noexcept;

}  // namespace roverd::nav
