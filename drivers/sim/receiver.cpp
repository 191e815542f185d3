#include "sim/receiver.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"

namespace roverd::sim {
namespace {

using base::FixType;

constexpr double kNoCourseBelow_mps = 0.1;

/// The newest epoch at or before `utc`: epochs lie on whole multiples of the period.
base::WallTime epoch_before(base::WallTime utc, double rate_hz) {
  const auto period_ns = static_cast<std::int64_t>(std::llround(1e9 / rate_hz));
  const std::int64_t ns = utc.time_since_epoch().count();
  return base::WallTime{base::Duration{ns - ns % period_ns}};
}

BodyState earlier(BodyState s, base::Duration by) {
  const double dt_s = base::seconds(by);
  s.time -= by;
  s.utc -= by;
  s.at = {s.at.east_m - s.east_mps * dt_s, s.at.north_m - s.north_mps * dt_s};
  s.yaw_rad -= s.yaw_rate_radps * dt_s;
  return s;
}

}  // namespace

FixErrors errors_of(FixType fix) noexcept {
  switch (fix) {
    case FixType::RtkFixed:
      return {fix, 0.012, 0.007, 60.0, 0.03, 24, 0.6};
    case FixType::RtkFloat:
      return {fix, 0.05, 0.25, 60.0, 0.04, 20, 0.8};
    case FixType::Differential:
      return {fix, 0.08, 0.5, 100.0, 0.05, 15, 0.9};
    case FixType::Single:
      return {fix, 0.1, 0.8, 60.0, 0.05, 12, 1.1};
    case FixType::Estimated:
    case FixType::Unknown:
    case FixType::None:
      break;
  }
  return {};
}

FixType fix_of_profile(std::string_view profile) noexcept {
  if (profile == "consumer") return FixType::Single;
  return profile == "float" ? FixType::RtkFloat : FixType::RtkFixed;
}

std::optional<FixType> fix_from(std::string_view word) noexcept {
  for (const FixType fix : {FixType::None, FixType::Single, FixType::Differential,
                            FixType::RtkFloat, FixType::RtkFixed}) {
    if (base::to_string(fix) == word) return fix;
  }
  return std::nullopt;
}

Receiver::Receiver(std::uint64_t seed, const base::LocalFrame& frame)
    : frame_(frame),
      east_(seed, Stream::GnssEast),
      north_(seed, Stream::GnssNorth),
      height_(seed, Stream::GnssHeight),
      velocity_(seed, Stream::GnssVelocity),
      compass_(seed, Stream::Compass),
      antennas_(seed, Stream::Antennas),
      drift_east_(seed, Stream::GnssDriftEast),
      drift_north_(seed, Stream::GnssDriftNorth) {}

std::string Receiver::step(const Params& p, const Faults& faults, const BodyState& now,
                           double motor_difference_a) {
  const double dt_s = last_step_ ? base::seconds(now.time - *last_step_) : 0.0;
  last_step_ = now.time;
  kick_.step(p.compass, motor_difference_a, dt_s);

  const base::Duration age = now.utc - epoch_before(now.utc, p.gnss.rate_hz);
  const Time epoch = now.time - age;
  const bool is_new = last_epoch_ ? epoch > *last_epoch_ : age == base::Duration::zero();
  if (!last_epoch_) last_epoch_ = epoch;
  if (is_new) {
    Epoch seen = measure(p, faults, earlier(now, age));
    corrupt(seen, faults);
    last_epoch_ = epoch;
    if (!faults.gnss_repeats || !last_text_) last_text_ = sentences(seen);
    pending_.push_back({epoch + base::from_seconds(p.gnss.latency_s), *last_text_});
  }
  std::string out;
  while (!pending_.empty() && pending_.front().due <= now.time) {
    if (!faults.gnss_silent) out += pending_.front().text;
    pending_.pop_front();
  }
  return out;
}

Epoch Receiver::measure(const Params& p, const Faults& faults, BodyState truth) {
  const auto forced = fix_from(faults.gnss_fix);
  const FixType fix =
      faults.gnss_outage ? FixType::None : forced.value_or(fix_of_profile(p.gnss.profile));
  Epoch epoch;
  epoch.utc = truth.utc;
  epoch.errors = errors_of(fix);
  FixErrors& e = epoch.errors;
  e.white_m *= p.gnss.noise_scale;
  e.drift_m *= p.gnss.noise_scale;
  e.velocity_mps *= p.gnss.noise_scale;
  // The streams advance at every epoch, with or without a fix: an outage does not shift what
  // comes after it.
  const double dt_s = last_epoch_ ? base::seconds(truth.time - *last_epoch_) : 0.0;
  const double drift_e = drift_east_.step(dt_s, e.drift_tau_s) * e.drift_m;
  const double drift_n = drift_north_.step(dt_s, e.drift_tau_s) * e.drift_m;
  const double white_e = east_.normal() * e.white_m;
  const double white_n = north_.normal() * e.white_m;
  const double height = height_.normal() * 1.5 * (e.white_m + e.drift_m);
  const double vel_e = velocity_.normal() * e.velocity_mps;
  const double vel_n = velocity_.normal() * e.velocity_mps;
  const bool drifts = faults.gnss_drift_east_mps != 0.0 || faults.gnss_drift_north_mps != 0.0;
  run_away_ = drifts ? base::EnuPoint{run_away_.east_m + faults.gnss_drift_east_mps * dt_s,
                                      run_away_.north_m + faults.gnss_drift_north_mps * dt_s}
                     : base::EnuPoint{};

  // E: ENU, B: body FLU, A: antenna. p_EA = p_EB + R_EB·p_BA, and its derivative.
  const double c = std::cos(truth.yaw_rad);
  const double s = std::sin(truth.yaw_rad);
  const double arm_e = c * p.gnss.antenna_forward_m - s * p.gnss.antenna_left_m;
  const double arm_n = s * p.gnss.antenna_forward_m + c * p.gnss.antenna_left_m;
  if (fix != FixType::None) {
    epoch.position = frame_.to_global(
        {truth.at.east_m + arm_e + faults.gnss_jump_east_m + run_away_.east_m + drift_e + white_e,
         truth.at.north_m + arm_n + faults.gnss_jump_north_m + run_away_.north_m + drift_n +
             white_n});
    epoch.alt_msl_m = p.gnss.alt_msl_m + height;
    epoch.geoid_sep_m = p.gnss.geoid_sep_m;
    const double east_mps =
        truth.east_mps - truth.yaw_rate_radps * arm_n + vel_e + faults.gnss_velocity_east_mps;
    const double north_mps =
        truth.north_mps + truth.yaw_rate_radps * arm_e + vel_n + faults.gnss_velocity_north_mps;
    epoch.speed_mps = std::hypot(east_mps, north_mps);
    if (epoch.speed_mps >= kNoCourseBelow_mps) {
      epoch.course_deg = base::heading_from_yaw(std::atan2(north_mps, east_mps));
    }
    epoch.sigma_m = std::hypot(e.white_m, e.drift_m);
  }
  epoch.heading_deg = heading_deg(p, faults, truth);
  return epoch;
}

/// Of two antennas where they are, else of the compass beside the receiver.
std::optional<double> Receiver::heading_deg(const Params& p, const Faults& faults,
                                            const BodyState& truth) {
  const double compass_deg = compass_.normal() * p.compass.noise_deg;
  const double antennas_deg = antennas_.normal() * p.gnss.antennas_noise_deg;
  const auto shown = [&](double error_deg) {
    return base::heading_from_yaw(truth.yaw_rad - base::rad_from_deg(error_deg));
  };
  if (p.gnss.antennas) {
    const bool fix = !faults.gnss_outage && faults.gnss_fix != "none";
    if (!fix) return std::nullopt;
    return shown(faults.antennas_extra_deg + antennas_deg);
  }
  if (!p.compass.fitted || p.imu.fitted || faults.compass_off) return std::nullopt;
  return shown(p.compass.bias_deg + faults.compass_extra_deg + compass_deg +
               kick_.error_deg(p.compass));
}

/// What stands still repeats what it told last; the streams of noise have gone on meanwhile.
void Receiver::corrupt(Epoch& epoch, const Faults& faults) {
  if (last_told_) {
    const Epoch& last = *last_told_;
    if (faults.gnss_position_frozen && epoch.position && last.position) {
      epoch.position = last.position;
      epoch.alt_msl_m = last.alt_msl_m;
    }
    if (faults.gnss_velocity_frozen && epoch.position && last.position) {
      epoch.speed_mps = last.speed_mps;
      epoch.course_deg = last.course_deg;
    }
    const bool heading = faults.antennas_frozen || faults.compass_frozen;
    if (heading && epoch.heading_deg && last.heading_deg) epoch.heading_deg = last.heading_deg;
  }
  last_told_ = epoch;
}

}  // namespace roverd::sim
