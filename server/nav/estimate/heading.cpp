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
constexpr base::Duration kCourseFresh = std::chrono::milliseconds(300);
// A few courses of a slow robot: what follows has to be believed of the heading, not of slip.
constexpr double kJustAskew_rad = 0.2;
constexpr double kCourse_mps = 0.3;       // slower, a velocity tells no course
constexpr double kStraight_radps = 0.15;  // faster, an antenna swings, and both are late
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

void Estimator::take(const base::Heading& told) {
  const bool compass = told.source == base::HeadingSource::Compass;
  base::Heading heading = told;
  if (!compass) heading.yaw_rad = base::wrap_rad(told.yaw_rad - health_.antennas_offset_rad);
  Input& in = compass ? health_.compass : health_.heading;
  if (!std::isfinite(heading.yaw_rad)) return refuse(in, Refusal::NotFinite);
  if (!in_order(in, compass ? last_compass_ : last_antennas_, heading.stamp)) return;
  if (compass) health_.compass_heard = true;
  if (!compass && askew(heading)) return refuse(in, Refusal::Outvoted);
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

/// Their heading against the satellites' own course: neither knows of the other.
/// @return true: they are mounted askew, so that their heading is not used.
bool Estimator::askew(const base::Heading& heading) noexcept {
  const double speed = velocity_ ? std::hypot(velocity_->east_mps, velocity_->north_mps) : 0.0;
  const bool fresh = velocity_ && heading.stamp - velocity_->stamp < kCourseFresh;
  const bool straight =
      std::abs(gyro_used_ ? gyro_.rate_radps() : tracks_.angular_radps) < kStraight_radps;
  const double way_m = counted_m_ - askew_way_m_;
  askew_way_m_ = counted_m_;
  if (fresh && straight && speed > kCourse_mps && has_odometry(heading.stamp)) {
    const double back = tracks_.linear_mps < 0.0 ? base::kPi : 0.0;
    const double course = std::atan2(velocity_->north_mps, velocity_->east_mps) + back;
    const double sigma_rad = velocity_sigma_mps(fix_trust_.fix(), velocity_->sigma_mps) / speed;
    askew_watch_.take(base::angle_diff_rad(course, heading.yaw_rad), sigma_rad, way_m);
  }
  const auto off = askew_watch_.measured();
  if (!askew_watch_.askew() || !off) {
    if (askew_watch_.proved()) health_.antennas_askew.reset();
    return health_.antennas_askew.has_value();
  }
  const bool known = health_.antennas_askew.has_value();
  health_.antennas_askew = base::Askew{off->rad, off->sigma_rad, off->way_m};
  if (known || !heading_known_) return true;
  // What was believed of heading and compass came from them; what did not fit was taken for slip.
  const Belief before = belief_;
  set_heading(heading.yaw_rad - off->rad, kJustAskew_rad);
  reset_state(belief_, kBias, belief_.x(kBias), rad_from_deg(params_->compass_bias_sigma_deg));
  reset_state(belief_, kCrab, 0.0, kCrabUnseen);
  for (const StateIndex i : {kSlideE, kSlideN}) reset_state(belief_, i, 0.0, kCrabUnseen);
  note_reset("heading", before);
  return true;
}

void Estimator::correct_antennas() noexcept {
  if (!health_.antennas_askew) return;
  health_.antennas_offset_rad =
      base::wrap_rad(health_.antennas_offset_rad + health_.antennas_askew->offset_rad);
  health_.antennas_askew.reset();
  askew_watch_.forget();
}

void Estimator::correct_antennas_by(double offset_rad) noexcept {
  health_.antennas_offset_rad = base::wrap_rad(offset_rad);
  health_.antennas_askew.reset();
  askew_watch_.forget();
}

void Estimator::uncorrect_antennas() noexcept {
  health_.antennas_offset_rad = 0.0;
  health_.antennas_askew.reset();
  askew_watch_.forget();
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
