#include "nav/calibrate/calibration_meter.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"

namespace roverd::nav {
namespace {

using base::CalibrationKind;
using base::Quantity;

constexpr double kAsToldShare = 0.9;    // of the slope that was asked for: it follows
constexpr double kOneStop = 0.04;       // 1 sigma of one look at braking, of one
constexpr double kLeastScale = 0.003;   // 1 sigma of one way, of one
constexpr double kYawFloor_rad = 0.01;  // no heading is better known
constexpr double kShortWay_m = 1.5;
constexpr double kChord_m = 1.5;
constexpr double kBesideTheirs_rad = 0.05;  // turned within a chord: it is none
constexpr int kStopsWanted = 2;
constexpr double kMostSteering_rad = 0.0524;  // 3 deg
constexpr double kMostBias_1pm = 0.3;

}  // namespace

void CalibrationMeter::begin(CalibrationKind kind, const CalibrationBefore& before,
                             const PathParams& set) {
  *this = CalibrationMeter{};
  kind_ = kind;
  before_ = before;
  set_ = set;
}

void CalibrationMeter::see(const CalibrationSight& s) noexcept {
  VehicleLearner::Seen seen = s.seen;
  if (!s.turn_measured) seen.yaw_rate_radps.reset();
  seen.turns_count = weaves_;
  learner_.see(seen);
  if (seen_) turned_rad_ += base::angle_diff_rad(now_.yaw_rad, s.vehicle.yaw_rad);
  now_ = s.vehicle;
  shows_ = s.seen.tracks.has_value();
  if (s.told && s.told_stamp != told_at_) {
    const double dt_s = seen_ ? std::min(0.3, base::seconds(s.told_stamp - told_at_)) : 0.0;
    told_at_ = s.told_stamp;
    told_mps_ = s.told->linear_mps;
    told_m_ += told_mps_ * dt_s;
    told_rad_ += s.told->angular_radps * dt_s;
    if (shows_ && tracing_ != Trace::None) {
      trace_.put(base::seconds(told_at_.time_since_epoch()), std::abs(told_mps_));
    }
  }
  seen_ = true;
  see_headings(s);
}

void CalibrationMeter::sent(const base::BodyTwist& twist) noexcept {
  learner_.sent(twist, set_);
}

void CalibrationMeter::stretch_begins() noexcept {
  stretch_ = mark();
  on_straight_ = false;
}

void CalibrationMeter::straight_begins() noexcept {
  straight_ = mark();
  on_straight_ = true;
  chord_.reset();
}

void CalibrationMeter::stretch_ends(bool straight) noexcept {
  const double sigma = std::hypot(kYawFloor_rad, now_.yaw_sigma_rad);
  turns_.take(turned_rad_ - stretch_.turned_rad, told_rad_ - stretch_.told_rad,
              told_m_ - stretch_.told_m, sigma);
  if (straight && on_straight_) {
    const double told_m = told_m_ - straight_.told_m;
    if (told_m > kShortWay_m) {
      scales_.take(base::distance_m(straight_.at, now_.at) / told_m);
      scale_noise_ = std::hypot(kLeastScale, std::sqrt(2.0) * now_.sigma_m / told_m);
    }
  }
  on_straight_ = false;
  chord_.reset();
}

void CalibrationMeter::ramp_begins(double to_mps, double accel_mps2) noexcept {
  tracing_ = Trace::Ramp;
  ramp_asked_mps2_ = accel_mps2;
  trace_.begin(to_mps);
}

void CalibrationMeter::ramp_ends() noexcept {
  if (tracing_ != Trace::Ramp) return;
  tracing_ = Trace::None;
  const auto slope = trace_.slope();
  if (!slope) return;
  ramps_.take(*slope);
  ramp_limited_ = ramp_limited_ || *slope < kAsToldShare * ramp_asked_mps2_;
}

void CalibrationMeter::stop_begins() noexcept {
  ramp_ends();
  tracing_ = Trace::Stop;
  trace_.begin(std::abs(told_mps_));
}

void CalibrationMeter::stop_ends() noexcept {
  if (tracing_ != Trace::Stop) return;
  tracing_ = Trace::None;
  if (const auto slope = trace_.slope()) stops_.take(*slope);
}

void CalibrationMeter::see_headings(const CalibrationSight& s) noexcept {
  if (s.compass_rad) {
    if (c_n_ == 0.0) c_about_ = base::angle_diff_rad(now_.yaw_rad, *s.compass_rad);
    const double off =
        base::wrap_rad(base::angle_diff_rad(now_.yaw_rad, *s.compass_rad) - c_about_);
    c_n_ += 1.0;
    c_sum_ += off;
    c_squares_ += off * off;
  }
  if (s.antennas_rad && on_straight_) see_course(*s.antennas_rad);
}

/// Their heading against the way between two places.
void CalibrationMeter::see_course(double antennas_rad) noexcept {
  if (std::abs(told_mps_) < 0.15) return chord_.reset();
  if (!chord_) {
    chord_ = Chord{now_.at, 0.0, antennas_rad, 0, told_m_};
    return;
  }
  Chord& c = *chord_;
  c.sum += base::angle_diff_rad(c.about, antennas_rad);
  ++c.n;
  const EnuPoint way = now_.at - c.from;
  const double way_m = std::hypot(way.east_m, way.north_m);
  if (way_m < kChord_m) return;
  const double mean = c.sum / c.n;
  const double course = std::atan2(way.north_m, way.east_m);
  const bool even = std::abs(base::angle_diff_rad(c.about, antennas_rad)) < 2 * kBesideTheirs_rad;
  const double sigma = std::sqrt(2.0) * std::max(0.01, now_.sigma_m) / way_m;
  if (even) askew_.take(base::wrap_rad(c.about + mean - course), sigma, way_m);
  chord_.reset();
}

CalibrationMeter::Value CalibrationMeter::learned(Quantity q) const noexcept {
  const base::VehicleLearned known = learner_.learned(set_);
  Value v;
  v.of = q;
  v.most = DelayMeter::kMost_s;
  const auto& found = q == Quantity::SteeringDelay ? known.delay_s : known.drive_delay_s;
  if (q == Quantity::SteeringDelay) v.before = before_.delay_s;
  v.keeps = q == Quantity::SteeringDelay;
  if (found) {
    v.after = found->value;
    v.sigma = found->sigma;
  }
  return v;
}

CalibrationMeter::Value CalibrationMeter::driven(Quantity q) const noexcept {
  Value v;
  v.of = q;
  v.least = 0.05;
  v.most = 10.0;
  const Looks& looks = q == Quantity::Braking ? stops_ : ramps_;
  v.before = q == Quantity::Braking ? before_.braking_mps2 : before_.acceleration_mps2;
  if (looks.count() < kStopsWanted) return v;
  v.after = looks.mean();
  v.sigma = looks.sigma(kOneStop * looks.mean());
  v.at_least = q == Quantity::Acceleration && !ramp_limited_;
  v.keeps = !v.at_least;
  return v;
}

CalibrationMeter::Value CalibrationMeter::turned(Quantity q) const noexcept {
  Value v;
  v.of = q;
  const bool scale = q == Quantity::TurnScale;
  const bool zero = q == Quantity::SteeringZero;
  const double base_m = set_.vehicle.wheelbase_m;
  v.least = scale ? 0.3 : zero ? -kMostSteering_rad : -kMostBias_1pm;
  v.most = scale ? 1.5 : -v.least;
  v.before = scale  ? before_.turn_scale
             : zero ? std::atan(base_m * before_.side_bias_1pm)
                    : before_.side_bias_1pm;
  const auto found = turns_.found();
  if (!found) return v;
  v.after = scale ? found->scale : zero ? std::atan(base_m * found->bias_1pm) : found->bias_1pm;
  v.sigma = scale  ? found->scale_sigma
            : zero ? base_m * found->bias_sigma_1pm
                   : found->bias_sigma_1pm;
  return v;
}

/// What compass and antennas show.
CalibrationMeter::Value CalibrationMeter::shown(Quantity q) const noexcept {
  Value v;
  v.of = q;
  v.keeps = q == Quantity::AntennasOffset;
  v.least = q == Quantity::CompassSpread ? 0.0 : -base::kPi;
  v.most = q == Quantity::CompassSpread ? 0.35 : base::kPi;
  if (q == Quantity::AntennasOffset) {
    v.before = before_.antennas_offset_rad;
    if (const auto off = askew_.measured()) {
      v.after = off->rad;
      v.sigma = off->sigma_rad;
    }
    return v;
  }
  if (q == Quantity::CompassOffset) v.before = before_.compass_offset_rad;
  if (c_n_ < 100.0) return v;
  const double mean = c_sum_ / c_n_;
  const double spread = std::sqrt(std::max(0.0, c_squares_ / c_n_ - mean * mean));
  v.after = q == Quantity::CompassOffset ? base::wrap_rad(c_about_ + mean) : spread;
  v.sigma = std::max(0.005, spread / std::sqrt(0.02 * c_n_));
  return v;
}

std::size_t CalibrationMeter::tell(
    std::array<base::CalibrationValue, base::kQuantities>& out) const noexcept {
  std::size_t n = 0;
  const auto add = [&](const Value& v) { out[n++] = v; };
  const bool steered = set_.vehicle.steered();
  if (kind_ == CalibrationKind::Drive || kind_ == CalibrationKind::Steering) {
    add(learned(Quantity::SteeringDelay));
    if (kind_ == CalibrationKind::Drive) {
      add(learned(Quantity::DriveDelay));
      add(driven(Quantity::Braking));
      add(driven(Quantity::Acceleration));
      Value scale;
      scale.of = Quantity::SpeedScale;
      scale.before = before_.speed_scale;
      scale.least = 0.6;
      scale.most = 1.15;
      if (scales_.count() > 0) {
        scale.after = scales_.mean();
        scale.sigma = scales_.sigma(scale_noise_);
      }
      add(scale);
    }
    add(turned(Quantity::TurnScale));
    add(turned(steered ? Quantity::SteeringZero : Quantity::SideBias));
  }
  if (kind_ == CalibrationKind::Compass) {
    add(shown(Quantity::CompassOffset));
    add(shown(Quantity::CompassSpread));
  }
  if (kind_ == CalibrationKind::Antennas) add(shown(Quantity::AntennasOffset));
  return n;
}

}  // namespace roverd::nav
