#include "sim/receiver.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "mti/rotation.hpp"

namespace roverd::sim {
namespace {

using base::FixType;

constexpr double kNoCourseBelow_mps = 0.1;

/// A consumer receiver as its errors really are: most of a metre that hardly changes within a run,
/// and a smooth way. Sources: D. L. Wilson, GPS error correlation; P. Misra, P. Enge, Global
/// Positioning System, chapters 5 and 6.
constexpr FixErrors kPlain{.fix = FixType::Single,
                           .white_m = 0.03,
                           .drift_m = 0.6,
                           .drift_tau_s = 60.0,
                           .velocity_mps = 0.04,
                           .satellites = 14,
                           .hdop = 0.9,
                           .slow_m = 1.2,
                           .slow_tau_s = 900.0,
                           .fast_m = 0.2,
                           .fast_tau_s = 4.0,
                           .velocity_drift_mps = 0.03,
                           .velocity_tau_s = 10.0};

bool is_corrected(FixType fix) noexcept {
  return fix == FixType::RtkFixed || fix == FixType::RtkFloat || fix == FixType::Differential;
}

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
  s.up_m -= s.up_mps * dt_s;
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

FixErrors errors_of(FixType fix, std::string_view profile) noexcept {
  return profile == "plain" && fix == FixType::Single ? kPlain : errors_of(fix);
}

FixType fix_of_profile(std::string_view profile) noexcept {
  if (profile == "consumer" || profile == "plain") return FixType::Single;
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
      drift_north_(seed, Stream::GnssDriftNorth),
      slow_east_(seed, Stream::PlainSlowEast),
      slow_north_(seed, Stream::PlainSlowNorth),
      fast_east_(seed, Stream::PlainFastEast),
      fast_north_(seed, Stream::PlainFastNorth),
      velocity_east_(seed, Stream::PlainVelocityEast),
      velocity_north_(seed, Stream::PlainVelocityNorth),
      canopy_(seed) {}

std::string Receiver::step(const Params& p, const Faults& faults, const BodyState& now,
                           double motor_difference_a) {
  const double dt_s = last_step_ ? base::seconds(now.time - *last_step_) : 0.0;
  last_step_ = now.time;
  kick_.step(p.compass, motor_difference_a, dt_s);
  feel(now, p.gnss.velocity_lag_s, dt_s);

  if (now.own_gnss) {
    if (!now.fix) return {};
    Epoch told = pass_on(p, faults, now);
    corrupt(told, faults);
    return faults.gnss_silent ? std::string() : sentences(told);
  }
  const base::Duration age = now.utc - epoch_before(now.utc, p.gnss.rate_hz);
  const Time epoch = now.time - age;
  const bool is_new = last_epoch_ ? epoch > *last_epoch_ : age == base::Duration::zero();
  if (!last_epoch_) last_epoch_ = epoch;
  if (is_new) {
    BodyState then = earlier(now, age);
    if (p.gnss.velocity_lag_s > 0.0) {
      then.east_mps = felt_mps_->east_m;
      then.north_mps = felt_mps_->north_m;
    }
    Epoch seen = measure(p, faults, then);
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

/// A filter of the first order: behind an even acceleration by just its lag.
void Receiver::feel(const BodyState& now, double lag_s, double dt_s) {
  const base::EnuPoint mps{now.east_mps, now.north_mps};
  if (!felt_mps_ || lag_s <= 0.0) felt_mps_ = mps;
  const double part = -std::expm1(-dt_s / std::max(1e-3, lag_s));
  felt_mps_->east_m += part * (mps.east_m - felt_mps_->east_m);
  felt_mps_->north_m += part * (mps.north_m - felt_mps_->north_m);
}

Epoch Receiver::measure(const Params& p, const Faults& faults, BodyState truth) {
  const double dt_s = last_epoch_ ? base::seconds(truth.time - *last_epoch_) : 0.0;
  canopy_.step(p.trees, truth.under_trees, dt_s);
  const auto forced = fix_from(faults.gnss_fix);
  const FixType open =
      faults.gnss_outage ? FixType::None : forced.value_or(fix_of_profile(p.gnss.profile));
  const FixType fix = canopy_.through(p.trees, open);
  Epoch epoch;
  epoch.utc = truth.utc + base::from_seconds(faults.gnss_time_step_s);
  epoch.errors = errors_of(fix, p.gnss.profile);
  FixErrors& e = epoch.errors;
  for (double* sigma :
       {&e.white_m, &e.drift_m, &e.slow_m, &e.fast_m, &e.velocity_mps, &e.velocity_drift_mps}) {
    *sigma *= p.gnss.noise_scale;
  }
  // What is claimed is what the class has in the open.
  epoch.sigma_m = std::hypot(std::hypot(e.white_m, e.drift_m), std::hypot(e.slow_m, e.fast_m));
  if (canopy_.under() && fix != FixType::None) {
    e.white_m *= p.trees.noise;
    e.satellites = (e.satellites + 1) / 2;
    e.hdop *= 2.0;
  }
  // The streams advance at every epoch, with or without a fix: an outage does not shift what
  // comes after it.
  Added added = noise(e, dt_s);
  lie(added, faults, fix, dt_s);
  if (fix != FixType::None) {
    const bool shifted =
        faults.gnss_base_shift_east_m != 0.0 || faults.gnss_base_shift_north_m != 0.0;
    epoch.station = shifted ? 2 : 1;
    look(epoch, p, truth, added);
  }
  epoch.heading_deg = heading_deg(p, faults, truth, fix != FixType::None);
  return epoch;
}

Receiver::Added Receiver::noise(const FixErrors& e, double dt_s) {
  Added a;
  const double drift_e = drift_east_.step(dt_s, e.drift_tau_s) * e.drift_m;
  const double drift_n = drift_north_.step(dt_s, e.drift_tau_s) * e.drift_m;
  const double plain_e = slow_east_.step(dt_s, e.slow_tau_s) * e.slow_m +
                         fast_east_.step(dt_s, e.fast_tau_s) * e.fast_m;
  const double plain_n = slow_north_.step(dt_s, e.slow_tau_s) * e.slow_m +
                         fast_north_.step(dt_s, e.fast_tau_s) * e.fast_m;
  a.east_m = drift_e + east_.normal() * e.white_m + plain_e;
  a.north_m = drift_n + north_.normal() * e.white_m + plain_n;
  a.up_m = height_.normal() * 1.5 * (e.white_m + e.drift_m);
  a.east_mps = velocity_.normal() * e.velocity_mps;
  a.north_mps = velocity_.normal() * e.velocity_mps;
  a.east_mps += velocity_east_.step(dt_s, e.velocity_tau_s) * e.velocity_drift_mps;
  a.north_mps += velocity_north_.step(dt_s, e.velocity_tau_s) * e.velocity_drift_mps;
  return a;
}

void Receiver::lie(Added& added, const Faults& faults, FixType fix, double dt_s) {
  const bool drifts = faults.gnss_drift_east_mps != 0.0 || faults.gnss_drift_north_mps != 0.0;
  run_away_ = drifts ? base::EnuPoint{run_away_.east_m + faults.gnss_drift_east_mps * dt_s,
                                      run_away_.north_m + faults.gnss_drift_north_mps * dt_s}
                     : base::EnuPoint{};
  added.east_m += faults.gnss_jump_east_m + run_away_.east_m + canopy_.east_m();
  added.north_m += faults.gnss_jump_north_m + run_away_.north_m + canopy_.north_m();
  if (is_corrected(fix)) {
    added.east_m += faults.gnss_base_shift_east_m;
    added.north_m += faults.gnss_base_shift_north_m;
  }
  added.east_mps += faults.gnss_velocity_east_mps;
  added.north_mps += faults.gnss_velocity_north_mps;
}

void Receiver::look(Epoch& epoch, const Params& p, const BodyState& truth,
                    const Added& added) const {
  // E: ENU, H: level with the body's yaw, B: body FLU. p_EA = p_EB + R_EH·R_HB·p_BA, and its
  // derivative.
  const mti::Vec3 p_HA =
      mti::leaning(truth.roll_rad, truth.pitch_rad) *
      mti::Vec3{p.gnss.antenna_forward_m, p.gnss.antenna_left_m, p.gnss.antenna_up_m};
  const double c = std::cos(truth.yaw_rad);
  const double s = std::sin(truth.yaw_rad);
  const double arm_e = c * p_HA[0] - s * p_HA[1];
  const double arm_n = s * p_HA[0] + c * p_HA[1];
  epoch.position = frame_.to_global(
      {truth.at.east_m + arm_e + added.east_m, truth.at.north_m + arm_n + added.north_m});
  epoch.alt_msl_m = p.gnss.alt_msl_m + added.up_m + truth.up_m + p_HA[2];
  epoch.geoid_sep_m = p.gnss.geoid_sep_m;
  const double east_mps = truth.east_mps - truth.yaw_rate_radps * arm_n + added.east_mps;
  const double north_mps = truth.north_mps + truth.yaw_rate_radps * arm_e + added.north_mps;
  epoch.speed_mps = std::hypot(east_mps, north_mps);
  if (epoch.speed_mps >= kNoCourseBelow_mps) {
    epoch.course_deg = base::heading_from_yaw(std::atan2(north_mps, east_mps));
  }
}

Epoch Receiver::pass_on(const Params& p, const Faults& faults, const BodyState& now) const {
  const ForeignFix& fix = *now.fix;
  Epoch epoch;
  epoch.utc = now.utc - base::from_seconds(fix.age_s - faults.gnss_time_step_s);
  epoch.errors = errors_of(faults.gnss_outage ? FixType::None : fix.fix);
  epoch.sigma_m = fix.sigma_m;
  epoch.heading_deg = fix.heading_deg ? fix.heading_deg : now.compass_deg;
  if (epoch.errors.fix == FixType::None) return epoch;
  epoch.position = frame_.to_global(
      {fix.at.east_m + faults.gnss_jump_east_m, fix.at.north_m + faults.gnss_jump_north_m});
  epoch.alt_msl_m = p.gnss.alt_msl_m;
  epoch.geoid_sep_m = p.gnss.geoid_sep_m;
  epoch.speed_mps = fix.speed_mps;
  epoch.course_deg = fix.course_deg;
  return epoch;
}

/// Of two antennas where they are, else of the compass beside the receiver.
std::optional<double> Receiver::heading_deg(const Params& p, const Faults& faults,
                                            const BodyState& truth, bool fix) {
  const double compass_deg = compass_.normal() * p.compass.noise_deg;
  const double antennas_deg = antennas_.normal() * p.gnss.antennas_noise_deg;
  const auto shown = [&](double error_deg) {
    return base::heading_from_yaw(truth.yaw_rad - base::rad_from_deg(error_deg));
  };
  if (p.gnss.antennas) {
    if (!fix) return std::nullopt;
    return shown(p.gnss.antennas_offset_deg + faults.antennas_extra_deg + antennas_deg);
  }
  if (!p.compass.fitted || p.imu.fitted || faults.compass_off) return std::nullopt;
  if (truth.compass_deg) return truth.compass_deg;
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
