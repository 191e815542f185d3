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
// More from a gentle bend to a turn on the spot, at which the centre wanders where the ground
// slips.
constexpr double kPositionNoisePivot_m = 0.015;
constexpr double kOnTheSpot_radps = 0.4;
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
constexpr double kYawScaleNoise = 0.02;
constexpr double kPullNoise_1pm = 0.004;
constexpr double kPivotNoise_m = 0.002;  // per √rad
// The way after which crab and slide are forgotten.
constexpr double kCrabFades_m = 100.0;
constexpr double kSlideFades_m = 60.0;
constexpr double kCoastNoise_m = 0.3;
const double kCoastYawNoise_rad = rad_from_deg(15.0);

void add_noise(Belief& b, int i, double density, double dt_s) noexcept {
  b.P(i, i) += density * density * dt_s;
}

/// Towards zero with the way driven; `fresh` is what comes in its place.
void fade(Belief& b, int i, double keep, double fresh) noexcept {
  b.x(i) *= keep;
  b.P.row(i) *= keep;
  b.P.col(i) *= keep;
  b.P(i, i) += fresh;
}

/// What changes with time alone: the receiver's drift and the gyro's bias.
void age(Belief& b, const Drift& drift, double dt_s) noexcept {
  const double keep = std::exp(-dt_s / drift.tau_s);
  const double fresh = drift.sigma_m * drift.sigma_m * (1.0 - keep * keep);
  for (const int i : {kDriftE, kDriftN}) fade(b, i, keep, fresh);
  add_noise(b, kGyroBias, kGyroBiasNoise_radps, dt_s);
}

/// The first three rows of the step's Jacobian F; the others are those of the unit matrix.
using Moved = Eigen::Matrix<double, 3, kStates>;
static_assert(kEast == 0 && kNorth == 1 && kYaw == 2);

Moved unmoved() noexcept {
  return Moved::Identity();
}

/// P = F·P·Fᵀ, of which only three rows and columns change.
void carry(Belief& b, const Moved& F) noexcept {
  const Moved FP = F * b.P;
  const Eigen::Matrix3d corner = FP * F.transpose();
  b.P.topRows<3>() = FP;
  b.P.leftCols<3>() = FP.transpose();
  b.P.topLeftCorner<3, 3>() = 0.5 * (corner + corner.transpose());
}

void fade_slip(Belief& b, const Slip& slip, double way_m) noexcept {
  if (way_m <= 0.0) return;
  const double keep = std::exp(-way_m / kCrabFades_m);
  fade(b, kCrab, keep, slip.crab_sigma * slip.crab_sigma * (1.0 - keep * keep));
  const double fresh = slip.slide_noise * slip.slide_noise * way_m;
  for (const int i : {kSlideE, kSlideN}) fade(b, i, std::exp(-way_m / kSlideFades_m), fresh);
}

/// The step's turn, and in which states it is linear. @return rad.
double turn(const Belief& b, const Travel& t, Moved& F) noexcept {
  if (t.gyro_rad) {
    F(kYaw, kGyroBias) = -t.dt_s;
    return *t.gyro_rad - b.x(kGyroBias) * t.dt_s;
  }
  F(kYaw, kYawScale) = t.turn_rad;
  F(kYaw, kPull) = t.ahead_m;
  return b.x(kYawScale) * t.turn_rad + b.x(kPull) * t.ahead_m;
}

void add_motion_noise(Belief& b, const Travel& t, const Slip& slip, double turned_rad) noexcept {
  const double turn_rate = std::abs(turned_rad) / t.dt_s;
  const double speed = std::abs(t.ahead_m) / t.dt_s;
  // With a gyro, what the heading lacks is not asked of place and scale.
  const double pivot_m = kPositionNoisePivot_m * std::min(1.0, turn_rate / kOnTheSpot_radps);
  const double per_turn_m = kPositionNoisePerTurnGyro_m + pivot_m;
  const double place = t.gyro_rad ? kPositionNoiseGyro_m + per_turn_m * turn_rate
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
  const double scale = t.gyro_rad ? slip.scale_noise : std::max(kScaleNoise, slip.scale_noise);
  b.P(kScale, kScale) += scale * scale * std::min(speed, speed * speed) * t.dt_s;
  add_noise(b, kYawScale, kYawScaleNoise * std::min(1.0, turn_rate), t.dt_s);
  add_noise(b, kPull, kPullNoise_1pm * std::min(1.0, speed), t.dt_s);
  if (b.P(kPivot, kPivot) > 0.0) add_noise(b, kPivot, kPivotNoise_m, std::abs(turned_rad));
}

}  // namespace

Eigen::Vector2d way_per_m(const StateVector& x, double yaw_rad, double way) noexcept {
  const double c = std::cos(yaw_rad);
  const double s = std::sin(yaw_rad);
  return {way * (x(kScale) * c - x(kCrab) * s) + x(kSlideE),
          way * (x(kScale) * s + x(kCrab) * c) + x(kSlideN)};
}

Eigen::Vector2d way_per_rad(const StateVector& x, double yaw_rad) noexcept {
  return {x(kPivot) * std::sin(yaw_rad), -x(kPivot) * std::cos(yaw_rad)};
}

void predict(Belief& b, const Travel& t, const Slip& slip, const Drift& drift,
             bool standing) noexcept {
  age(b, drift, t.dt_s);
  if (standing) {
    add_noise(b, kEast, kStandingNoise_m, t.dt_s);
    add_noise(b, kNorth, kStandingNoise_m, t.dt_s);
    add_noise(b, kBias, kBiasNoiseStanding_rad, t.dt_s);
    return;
  }
  Moved F = unmoved();
  const double turned_rad = turn(b, t, F);
  // The middle of the step points along yaw + turned/2.
  const double middle_rad = b.x(kYaw) + 0.5 * turned_rad;
  const double way_m = std::abs(t.ahead_m);
  const double back = t.ahead_m < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector2d per_rad = way_per_rad(b.x, middle_rad);
  const Eigen::Vector2d moved = way_m * way_per_m(b.x, middle_rad, back) + turned_rad * per_rad;
  const double c = t.ahead_m * std::cos(middle_rad);
  const double s = t.ahead_m * std::sin(middle_rad);
  // What of the way turns with the robot.
  const double own_east = moved.x() - way_m * b.x(kSlideE);
  const double own_north = moved.y() - way_m * b.x(kSlideN);
  F(kEast, kYaw) = -own_north;
  F(kNorth, kYaw) = own_east;
  for (const int i : {kGyroBias, kYawScale, kPull}) {
    F(kEast, i) = (per_rad.x() - 0.5 * own_north) * F(kYaw, i);
    F(kNorth, i) = (per_rad.y() + 0.5 * own_east) * F(kYaw, i);
  }
  F(kEast, kScale) = c;
  F(kNorth, kScale) = s;
  F(kEast, kCrab) = -s;
  F(kNorth, kCrab) = c;
  F(kEast, kSlideE) = F(kNorth, kSlideN) = way_m;
  F(kEast, kPivot) = turned_rad * std::sin(middle_rad);
  F(kNorth, kPivot) = -turned_rad * std::cos(middle_rad);

  b.x(kEast) += moved.x();
  b.x(kNorth) += moved.y();
  b.x(kYaw) = base::wrap_rad(b.x(kYaw) + turned_rad);
  carry(b, F);
  fade_slip(b, slip, way_m);
  add_motion_noise(b, t, slip, turned_rad);
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
    Moved F = unmoved();
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
  b.x(kCrab) = std::clamp(b.x(kCrab), -0.3, 0.3);
  for (const int i : {kSlideE, kSlideN}) b.x(i) = std::clamp(b.x(i), -0.4, 0.4);
  b.x(kPivot) = std::clamp(b.x(kPivot), -1.0, 1.0);
  change = b.x - before;
  change(kYaw) = base::wrap_rad(change(kYaw));

  // Joseph's form, right for any gain and so for one with rows struck out, multiplied out:
  // (I−KH)P(I−KH)ᵀ + KRKᵀ = P − K(HP) − (HP)ᵀKᵀ + KSKᵀ
  const Eigen::Matrix<double, kStates, M> half = PHt - 0.5 * K * S;
  b.P -= K * half.transpose() + half * K.transpose();
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
