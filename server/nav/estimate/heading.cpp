// Compass and antennas: what a heading says, and what happens when it is not believed.

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "nav/estimate/estimator.hpp"

namespace roverd::nav {
namespace {

using base::rad_from_deg;
using base::Refusal;

constexpr base::Duration kDropAfterPivot = std::chrono::seconds(2);
constexpr base::Duration kLearnAnew = std::chrono::seconds(5);
constexpr base::Duration kSetAnew = std::chrono::seconds(10);
constexpr double kAntennas_m = 0.01;  // of a baseline's ends, so that its heading is this over it

}  // namespace

void Estimator::set_heading(double yaw_rad, double sigma_rad) noexcept {
  StateVector change = StateVector::Zero();
  change(kYaw) = base::angle_diff_rad(belief_.x(kYaw), yaw_rad);
  reset_state(belief_, kYaw, base::wrap_rad(yaw_rad), sigma_rad);
  history_.shift(change);
  if (!heading_known_) heading_since_ = now_;
  heading_known_ = true;
}

/// A compass is a hint: as wrong as its bias may be.
void Estimator::first_heading(double yaw_rad, double sigma_rad, bool compass) noexcept {
  const double bias_rad = compass ? rad_from_deg(params_->compass_bias_sigma_deg) : 0.0;
  set_heading(yaw_rad, std::hypot(sigma_rad, bias_rad));
  if (!compass) return;
  // yaw = shown − bias: what one is too large the other is too small.
  reset_state(belief_, kBias, 0.0, bias_rad);
  belief_.P(kYaw, kBias) = belief_.P(kBias, kYaw) = -bias_rad * bias_rad;
}

/// Shown minus true, with what the motors' currents do to it.
double Estimator::shown_bias_rad(const StateVector& x) const noexcept {
  return x(kBias) + x(kCompassLeft) * left_.ampere + x(kCompassRight) * right_.ampere;
}

void Estimator::take(const base::Heading& heading) {
  const bool compass = heading.source == base::HeadingSource::Compass;
  Input& in = compass ? health_.compass : health_.heading;
  if (!std::isfinite(heading.yaw_rad)) return refuse(in, Refusal::NotFinite);
  if (!in_order(in, compass ? last_compass_ : last_antennas_, heading.stamp)) return;
  if (compass) health_.compass_heard = true;
  const double latency_s = compass ? params_->compass_latency_s : params_->gnss_latency_s;
  const Time taken = heading.stamp - base::from_seconds(latency_s);
  const auto past = history_.at(taken);
  const base::Sense sense = compass ? base::Sense::Compass : base::Sense::Antennas;
  const double noise_deg = compass ? params_->compass_sigma_deg : params_->heading_sigma_deg;
  votes_.heading(sense, heading.yaw_rad, heading.sigma_rad.value_or(rad_from_deg(noise_deg)), taken,
                 heading.stamp);
  if (heading_known_ && outvoted(sense, in)) return;
  if (!heading_known_) {
    const double turned_since = past ? base::angle_diff_rad(past->x(kYaw), belief_.x(kYaw)) : 0.0;
    const double sigma_deg = compass ? params_->compass_sigma_deg : params_->heading_sigma_deg;
    const double sigma_rad = heading.sigma_rad.value_or(rad_from_deg(sigma_deg));
    const double shown_rad =
        compass ? heading.yaw_rad - shown_bias_rad(belief_.x) : heading.yaw_rad;
    first_heading(shown_rad + turned_since, sigma_rad, compass);
    return;
  }
  const StateVector& at = past ? past->x : belief_.x;
  if (compass) {
    fuse_compass(heading, at);
  } else {
    fuse_antennas(heading, at);
  }
}

void Estimator::fuse_compass(const base::Heading& heading, const StateVector& at) noexcept {
  Input& in = health_.compass;
  // The iron remembers the currents of a turn on the spot; the gyro knows the heading meanwhile.
  if (gyro_used_ && pivot_at_ && heading.stamp - *pivot_at_ < kDropAfterPivot) {
    ++health_.refusals[static_cast<std::size_t>(Refusal::Disturbed)];
    return;
  }
  const double least_rad = rad_from_deg(params_->compass_sigma_deg);
  const double sigma_rad = std::max(least_rad, heading.sigma_rad.value_or(0.0));
  Observation<1> o;
  o.innovation(0) = base::wrap_rad(heading.yaw_rad - at(kYaw) - shown_bias_rad(at));
  o.H(0, kYaw) = 1.0;
  o.H(0, kBias) = 1.0;
  o.H(0, kCompassLeft) = left_.ampere;
  o.H(0, kCompassRight) = right_.ampere;
  o.R(0, 0) = sigma_rad * sigma_rad;
  o.gate = kGate1;
  if (standing_ && settled_in(heading_since_)) {
    o.may_change.setZero();
    o.may_change(kBias) = 1.0;
  }
  if (apply(in, o)) {
    compass_off_since_.reset();
    in.refused_since.reset();
    return;
  }
  refuse(in, Refusal::Jump);
  if (!compass_off_since_) compass_off_since_ = heading.stamp;
  if (heading.stamp - *compass_off_since_ < kLearnAnew) return;
  // The iron around it changed, or the robot was turned by hand: learn the compass anew.
  reset_state(belief_, kBias, base::wrap_rad(at(kBias) + o.innovation(0)),
              rad_from_deg(params_->compass_bias_sigma_deg));
  compass_off_since_.reset();
}

void Estimator::fuse_antennas(const base::Heading& heading, const StateVector& at) noexcept {
  Input& in = health_.heading;
  const double told_rad = heading.sigma_rad.value_or(rad_from_deg(params_->heading_sigma_deg));
  const double sigma_rad = std::max(told_rad, kAntennas_m / params_->antenna_baseline_m);
  Observation<1> o;
  o.innovation(0) = base::angle_diff_rad(at(kYaw), heading.yaw_rad);
  o.H(0, kYaw) = 1.0;
  o.R(0, 0) = sigma_rad * sigma_rad;
  o.gate = kGate1;
  if (apply(in, o)) {
    antennas_off_since_.reset();
    in.refused_since.reset();
    return;
  }
  refuse(in, Refusal::Jump);
  // A hint of a compass, or a heading that was never proved by driving, has no right against them.
  if (alignment_ == base::Alignment::Aligned) {
    if (!antennas_off_since_) antennas_off_since_ = heading.stamp;
    if (heading.stamp - *antennas_off_since_ < kSetAnew) return;
  }
  const Belief before = belief_;
  const double turned_since = base::angle_diff_rad(at(kYaw), belief_.x(kYaw));
  set_heading(heading.yaw_rad + turned_since, sigma_rad);
  note_reset("heading", before);
  antennas_off_since_.reset();
}

}  // namespace roverd::nav
