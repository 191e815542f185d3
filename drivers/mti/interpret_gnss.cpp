// Positions of the unit: of its filter, or of the receiver in it.

#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/angle.hpp"
#include "mti/interpreter.hpp"

namespace roverd::mti {
namespace {

/// The receiver's word on its accuracy is of use for so long.
constexpr double kPvtPatience_s = 2.0;
/// Beyond this an accuracy says "unknown" (all bits set).
constexpr double kUnknownSigma_m = 1e6;

std::optional<base::WallTime> wall_of(const Utc& u, std::int64_t nanosecond) {
  using namespace std::chrono;
  const year_month_day date{year{u.year}, month{static_cast<unsigned>(u.month)},
                            day{static_cast<unsigned>(u.day)}};
  if (!u.date_valid() || !u.time_valid() || !date.ok() || u.hour > 23 || u.minute > 59 ||
      u.second > 60 || nanosecond < -1'000'000'000 || nanosecond > 1'000'000'000) {
    return {};
  }
  return sys_days{date} + hours{u.hour} + minutes{u.minute} + seconds{u.second} +
         microseconds{std::llround(static_cast<double>(nanosecond) / 1e3)};
}

std::optional<double> axis_sigma_m(double radius_m) noexcept {
  if (!(radius_m > 0.0) || radius_m > kUnknownSigma_m) return {};
  return radius_m / std::numbers::sqrt2;
}

const char* system_of(std::uint8_t constellation) noexcept {
  constexpr std::array kSystems{"gps", "sbas", "galileo", "beidou", "unknown", "qzss", "glonass"};
  return constellation < kSystems.size() ? kSystems[constellation] : "unknown";
}

}  // namespace

base::FixType Interpreter::filter_fix(Time stamp) const {
  if (!status_) return base::FixType::Unknown;
  if (!status_->gnss_fix()) return base::FixType::Estimated;  // coasting
  if (status_->bit(28)) return base::FixType::RtkFixed;
  if (status_->bit(27)) return base::FixType::RtkFloat;
  const bool fresh = pvt_ && base::seconds(stamp - pvt_at_) < kPvtPatience_s;
  return fresh && pvt_->differential() ? base::FixType::Differential : base::FixType::Single;
}

void Interpreter::tell_filter(const Sample& s, Time stamp) {
  if (!s.at || !oriented()) return;
  if (position_at_ && stamp >= *position_at_ &&
      base::seconds(stamp - *position_at_) < 1.0 / params_.position_hz - 5e-4) {
    return;
  }
  position_at_ = stamp;
  base::GnssFix fix;
  fix.stamp = stamp;
  fix.latency_s = latency_s_;
  fix.fix = filter_fix(stamp);
  fix.position = s.at;
  if (s.utc) fix.utc = wall_of(*s.utc, s.utc->nanosecond);
  if (pvt_ && base::seconds(stamp - pvt_at_) < kPvtPatience_s) {
    fix.satellites = pvt_->satellites;
    fix.hdop = pvt_->dop[4];
    fix.sigma_east_m = fix.sigma_north_m = axis_sigma_m(pvt_->horizontal_sigma_m);
    fix.geoid_sep_m = pvt_->height_ellipsoid_m - pvt_->height_msl_m;
    if (s.height_ellipsoid_m) fix.alt_msl_m = *s.height_ellipsoid_m - *fix.geoid_sep_m;
  }
  // The unit tells of its own place; told is the body's origin. p_O = p_S − p_OS.
  Vec3 arm_E{};
  Vec3 swing_E{};
  if (R_EB_) arm_E = *R_EB_ * arm_B_;
  if (R_EB_ && rate_B_) swing_E = *R_EB_ * cross(*rate_B_, arm_B_);
  if (arm_E[0] != 0.0 || arm_E[1] != 0.0) {
    fix.position = base::LocalFrame(1, *s.at).to_global({-arm_E[0], -arm_E[1]});
  }
  tell_fix(fix);
  if (!s.velocity_E) return;
  ears_.tell(base::GnssVelocity{
      stamp, (*s.velocity_E)[0] - swing_E[0], (*s.velocity_E)[1] - swing_E[1], {}, latency_s_});
}

void Interpreter::tell_receiver(const GnssPvt& pvt, Time stamp) {
  base::GnssFix fix;
  fix.stamp = stamp;
  fix.latency_s = latency_s_;
  fix.satellites = pvt.satellites;
  fix.hdop = pvt.dop[4];
  fix.utc = wall_of(pvt.utc, pvt.nano);
  if (!pvt.usable()) return tell_fix(fix);
  fix.fix = pvt.differential() ? base::FixType::Differential : base::FixType::Single;
  fix.position = pvt.at;
  fix.alt_msl_m = pvt.height_msl_m;
  fix.geoid_sep_m = pvt.height_ellipsoid_m - pvt.height_msl_m;
  fix.sigma_east_m = fix.sigma_north_m = axis_sigma_m(pvt.horizontal_sigma_m);
  tell_fix(fix);
  base::GnssVelocity velocity{stamp, pvt.east_mps, pvt.north_mps, {}, latency_s_};
  if (pvt.speed_sigma_mps > 0.0) velocity.sigma_mps = pvt.speed_sigma_mps;
  ears_.tell(velocity);
}

void Interpreter::tell_satellites(const Satellites& satellites, Time stamp) {
  constexpr unsigned kUsed = 8;  // as in u-blox NAV-SAT
  auto all = std::make_shared<std::vector<base::Satellite>>();
  for (const Satellite& s : satellites.all) {
    base::Satellite out{system_of(s.constellation), s.id, {}, {}, {}, {}};
    if (s.cn0_dbhz > 0) out.cn0_dbhz = s.cn0_dbhz;
    out.used = (s.flags & kUsed) != 0;
    all->push_back(std::move(out));
  }
  ears_.tell(base::SatellitesInView{stamp, name_, std::move(all)});
}

void Interpreter::tell_fix(base::GnssFix fix) {
  using std::chrono::sys_days, std::chrono::year;
  if (fix.utc && *fix.utc < sys_days{year{2015} / 1 / 1}) {
    ears_.refused("impossible date", 1);
    fix.utc.reset();
  }
  if (fix.position && fix.position->lat == 0.0 && fix.position->lon == 0.0) {
    ears_.refused("position 0, 0", 1);
    fix.position.reset();
    fix.fix = base::FixType::None;
  }
  ears_.tell(fix);
}

}  // namespace roverd::mti
