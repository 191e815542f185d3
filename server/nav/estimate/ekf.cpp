#include "nav/estimate/ekf.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angle.hpp"

namespace roverd::nav {
namespace {

using base::rad_from_deg;

// Densities per √s, see the header. Yaw: without a gyro the turn rate is the tracks', and slip
// varies by some percent from moment to moment. With one they are those of a MEMS unit and of slip
// that wanders by half a percent: larger ones add up over minutes, and the ellipse of a drifting
// receiver grows too wide (estimate_bench watches it).
constexpr double kPositionNoise_m = 0.02;
constexpr double kPositionNoiseGyro_m = 0.005;
constexpr double kPositionNoisePerTurn_m = 0.05;
constexpr double kPositionNoisePerTurnGyro_m = 0.015;
constexpr double kStandingNoise_m = 0.001;
const double kYawNoise_rad = rad_from_deg(0.3);
const double kYawNoisePerSpeed_rad = rad_from_deg(0.8);
constexpr double kYawNoisePerTurn = 0.06;
const double kGyroNoise_rad = rad_from_deg(0.012);
constexpr double kGyroNoisePerTurn = 0.0015;  // scale of the gyro, lean of its axis
const double kGyroBiasNoise_radps = rad_from_deg(0.002);
const double kBiasNoise_rad = rad_from_deg(0.7);
const double kBiasNoiseStanding_rad = rad_from_deg(0.1);
const double kBiasNoisePivot_rad = rad_from_deg(6.0);
constexpr double kScaleNoise = 0.006;
constexpr double kScaleNoiseGyro = 0.0006;
constexpr double kYawScaleNoise = 0.02;
constexpr double kPullNoise_1pm = 0.004;
constexpr double kCoastNoise_m = 0.3;
const double kCoastYawNoise_rad = rad_from_deg(15.0);

void add_noise(Belief& b, int i, double density, double dt_s) noexcept {
  b.P(i, i) += density * density * dt_s;
}

/// What changes with time alone: the receiver's drift and the gyro's bias.
void age(Belief& b, const Drift& drift, double dt_s) noexcept {
  const double keep = std::exp(-dt_s / drift.tau_s);
  const double fresh = drift.sigma_m * drift.sigma_m * (1.0 - keep * keep);
  for (const int i : {kDriftE, kDriftN}) {
    b.x(i) *= keep;
    b.P.row(i) *= keep;
    b.P.col(i) *= keep;
    b.P(i, i) += fresh;
  }
  add_noise(b, kGyroBias, kGyroBiasNoise_radps, dt_s);
}

void carry(Belief& b, const StateMatrix& F) noexcept {
  const StateMatrix carried = F * b.P * F.transpose();
  b.P = 0.5 * (carried + carried.transpose());
}

/// The step's turn, and in which states it is linear. @return rad.
double turn(const Belief& b, const Travel& t, StateMatrix& F) noexcept {
  if (t.gyro_rad) {
    F(kYaw, kGyroBias) = -t.dt_s;
    return *t.gyro_rad - b.x(kGyroBias) * t.dt_s;
  }
  F(kYaw, kYawScale) = t.turn_rad;
  F(kYaw, kPull) = t.ahead_m;
  return b.x(kYawScale) * t.turn_rad + b.x(kPull) * t.ahead_m;
}

void add_motion_noise(Belief& b, const Travel& t, double turned_rad) noexcept {
  const double turn_rate = std::abs(turned_rad) / t.dt_s;
  const double speed = std::abs(t.ahead_m) / t.dt_s;
  // With a gyro, what the heading lacks is not asked of place and scale.
  const double place = t.gyro_rad ? kPositionNoiseGyro_m + kPositionNoisePerTurnGyro_m * turn_rate
                                  : kPositionNoise_m + kPositionNoisePerTurn_m * turn_rate;
  add_noise(b, kEast, place, t.dt_s);
  add_noise(b, kNorth, place, t.dt_s);
  const double yaw = t.gyro_rad ? kGyroNoise_rad + kGyroNoisePerTurn * turn_rate
                                : kYawNoise_rad + kYawNoisePerSpeed_rad * speed +
                                      kYawNoisePerTurn * std::abs(t.turn_rad) / t.dt_s;
  add_noise(b, kYaw, yaw, t.dt_s);
  // Motor currents of a turn on the spot move a compass by many degrees.
  const bool pivot = turn_rate > 0.3 && speed < 0.15;
  add_noise(b, kBias, pivot ? kBiasNoisePivot_rad : kBiasNoise_rad, t.dt_s);
  add_noise(b, kScale, (t.gyro_rad ? kScaleNoiseGyro : kScaleNoise) * std::min(1.0, speed), t.dt_s);
  add_noise(b, kYawScale, kYawScaleNoise * std::min(1.0, turn_rate), t.dt_s);
  add_noise(b, kPull, kPullNoise_1pm * std::min(1.0, speed), t.dt_s);
}

}  // namespace

void predict(Belief& b, const Travel& t, const Drift& drift, bool standing) noexcept {
  age(b, drift, t.dt_s);
  if (standing) {
    add_noise(b, kEast, kStandingNoise_m, t.dt_s);
    add_noise(b, kNorth, kStandingNoise_m, t.dt_s);
    add_noise(b, kBias, kBiasNoiseStanding_rad, t.dt_s);
    return;
  }
  StateMatrix F = StateMatrix::Identity();
  const double turned_rad = turn(b, t, F);
  const double k = b.x(kScale);
  const double middle_rad = b.x(kYaw) + 0.5 * turned_rad;
  const double east = std::cos(middle_rad);
  const double north = std::sin(middle_rad);
  const double ahead_m = k * t.ahead_m;
  // The middle of the step points along yaw + turned/2.
  F(kEast, kYaw) = -ahead_m * north;
  F(kNorth, kYaw) = ahead_m * east;
  for (const int i : {kGyroBias, kYawScale, kPull}) {
    F(kEast, i) = -0.5 * ahead_m * north * F(kYaw, i);
    F(kNorth, i) = 0.5 * ahead_m * east * F(kYaw, i);
  }
  F(kEast, kScale) = t.ahead_m * east;
  F(kNorth, kScale) = t.ahead_m * north;

  b.x(kEast) += ahead_m * east;
  b.x(kNorth) += ahead_m * north;
  b.x(kYaw) = base::wrap_rad(b.x(kYaw) + turned_rad);
  carry(b, F);
  add_motion_noise(b, t, turned_rad);
}

void predict_coasting(Belief& b, const Coast& coast, double dt_s, const Drift& drift) noexcept {
  age(b, drift, dt_s);
  b.x(kEast) += coast.velocity_mps.x() * dt_s;
  b.x(kNorth) += coast.velocity_mps.y() * dt_s;
  // d(sigma² t²) = 2 sigma² t dt
  const double more = 2.0 * coast.sigma_mps * coast.sigma_mps * coast.blind_s * dt_s;
  b.P(kEast, kEast) += more;
  b.P(kNorth, kNorth) += more;
  add_noise(b, kEast, kCoastNoise_m, dt_s);
  add_noise(b, kNorth, kCoastNoise_m, dt_s);
  if (coast.gyro_rad) {
    StateMatrix F = StateMatrix::Identity();
    const double turned_rad = turn(b, {0.0, 0.0, dt_s, coast.gyro_rad}, F);
    b.x(kYaw) = base::wrap_rad(b.x(kYaw) + turned_rad);
    carry(b, F);
    add_noise(b, kYaw, kGyroNoise_rad + kGyroNoisePerTurn * std::abs(turned_rad) / dt_s, dt_s);
  } else {
    add_noise(b, kYaw, kCoastYawNoise_rad, dt_s);
  }
  // An angle is never less certain than "anywhere".
  const double most = base::kPi * base::kPi;
  if (b.P(kYaw, kYaw) > most) {
    const double part = std::sqrt(most / b.P(kYaw, kYaw));
    b.P.row(kYaw) *= part;
    b.P.col(kYaw) *= part;
  }
}

template <int M>
bool update(Belief& b, const Observation<M>& o, StateVector& change, double& nis) noexcept {
  change.setZero();
  nis = std::numeric_limits<double>::quiet_NaN();
  if (!o.innovation.allFinite() || !o.H.allFinite() || !o.R.allFinite()) return false;
  const Eigen::Matrix<double, kStates, M> PHt = b.P * o.H.transpose();
  const Eigen::Matrix<double, M, M> S = o.H * PHt + o.R;
  const Eigen::Matrix<double, M, M> S_inverse = S.inverse();
  nis = o.innovation.dot(S_inverse * o.innovation);
  if (!std::isfinite(nis) || (o.gate > 0.0 && nis > o.gate)) return false;

  const Eigen::Matrix<double, kStates, M> K = o.may_change.asDiagonal() * PHt * S_inverse;
  const StateVector before = b.x;
  b.x += K * o.innovation;
  b.x(kYaw) = base::wrap_rad(b.x(kYaw));
  b.x(kGyroBias) = std::clamp(b.x(kGyroBias), -0.2, 0.2);
  b.x(kBias) = base::wrap_rad(b.x(kBias));
  b.x(kScale) = std::clamp(b.x(kScale), 0.5, 1.2);
  b.x(kYawScale) = std::clamp(b.x(kYawScale), 0.3, 1.5);
  b.x(kPull) = std::clamp(b.x(kPull), -0.3, 0.3);
  change = b.x - before;
  change(kYaw) = base::wrap_rad(change(kYaw));

  // Joseph form: right for any gain, so also for one with rows struck out.
  const StateMatrix A = StateMatrix::Identity() - K * o.H;
  const StateMatrix P = A * b.P * A.transpose() + K * o.R * K.transpose();
  b.P = 0.5 * (P + P.transpose());
  return true;
}

template bool update<1>(Belief&, const Observation<1>&, StateVector&, double&) noexcept;
template bool update<2>(Belief&, const Observation<2>&, StateVector&, double&) noexcept;

void reset_state(Belief& b, StateIndex i, double value, double sigma) noexcept {
  b.x(i) = value;
  b.P.row(i).setZero();
  b.P.col(i).setZero();
  b.P(i, i) = sigma * sigma;
}

}  // namespace roverd::nav
