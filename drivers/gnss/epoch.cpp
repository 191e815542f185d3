#include "gnss/epoch.hpp"

#include <cmath>
#include <utility>

#include "base/angle.hpp"

namespace roverd::gnss {

using base::FixType;

namespace {

/// Two sentences belong to one epoch if their times agree; some print more decimals than others.
constexpr double kSameTime_s = 0.005;
/// Below this a missing course means standing still; above it, that the receiver does not know.
constexpr double kStandstill_mps = 0.2;
/// A heading this long after its epoch's beginning was measured at another moment.
constexpr double kHeadingReach_s = 0.1;

std::optional<base::LatLon> position(std::optional<double> lat, std::optional<double> lon) {
  if (!lat || !lon) return std::nullopt;
  return base::LatLon{*lat, *lon};
}

std::optional<base::GnssVelocity> velocity(Time stamp, std::optional<double> speed_kn,
                                           std::optional<double> course_deg) {
  if (!speed_kn) return std::nullopt;
  const double v = *speed_kn * kMpsPerKnot;
  if (!course_deg) {
    if (v > kStandstill_mps) return std::nullopt;
    // Receivers leave the course out of what is slow: not that it stands is known, but how fast it
    // is at most.
    return base::GnssVelocity{stamp, 0.0, 0.0, v > 0.0 ? std::optional(v) : std::nullopt};
  }
  const double yaw = base::yaw_from_heading(*course_deg);
  return base::GnssVelocity{stamp, v * std::cos(yaw), v * std::sin(yaw), std::nullopt};
}

std::optional<double> positive(std::optional<double> sigma) {
  return sigma && *sigma > 0.0 ? sigma : std::nullopt;
}

}  // namespace

void Calendar::set(Date date, double time_s) noexcept {
  if (date.year() > std::chrono::year{2200}) return;  // beyond what a WallTime holds
  day_ = std::chrono::sys_days{date};
  time_s_ = time_s;
}

std::optional<base::WallTime> Calendar::at(double time_s) const noexcept {
  if (!day_) return std::nullopt;
  constexpr double kHalfDay_s = 43'200.0;
  std::chrono::sys_days day = *day_;
  if (time_s < time_s_ - kHalfDay_s) day += std::chrono::days{1};
  if (time_s > time_s_ + kHalfDay_s) day -= std::chrono::days{1};
  // Whole microseconds: 0.2 s is not a binary fraction.
  return day + std::chrono::microseconds{std::llround(time_s * 1e6)};
}

EpochAssembler::EpochAssembler(const EpochOptions& options, OnMeasurement on_measurement)
    : options_(options), on_measurement_(std::move(on_measurement)) {}

void EpochAssembler::add(const Sentence& sentence, Time stamp) {
  if (const auto* gga = std::get_if<Gga>(&sentence)) {
    epoch_for(kGga, gga->time_s, stamp).gga = *gga;
  } else if (const auto* rmc = std::get_if<Rmc>(&sentence)) {
    note_date(rmc->date, rmc->time_s);
    epoch_for(kRmc, rmc->time_s, stamp).rmc = *rmc;
  } else if (const auto* gst = std::get_if<Gst>(&sentence)) {
    epoch_for(kGst, gst->time_s, stamp).gst = *gst;
  } else if (const auto* gns = std::get_if<Gns>(&sentence)) {
    epoch_for(kGns, gns->time_s, stamp).gns = *gns;
  } else if (const auto* zda = std::get_if<Zda>(&sentence)) {
    note_date(zda->date, zda->time_s);
    epoch_for(kZda, zda->time_s, stamp);
  } else if (const auto* vtg = std::get_if<Vtg>(&sentence)) {
    on_vtg(*vtg, stamp);
  } else if (const auto* hdt = std::get_if<Hdt>(&sentence)) {
    on_heading(hdt->heading_deg, stamp);
  } else if (const auto* ths = std::get_if<Ths>(&sentence)) {
    on_heading(ths->valid() ? ths->heading_deg : std::nullopt, stamp);
  }
  if (!epoch_) return;
  epoch_->last = stamp;  // satellites (GSA, GSV) too show that the burst goes on
  complete();
}

Epoch& EpochAssembler::epoch_for(Part part, std::optional<double> time_s, Time stamp) {
  const bool another_time =
      epoch_ && epoch_->time_s && time_s && std::abs(*epoch_->time_s - *time_s) > kSameTime_s;
  if (epoch_ && (another_time || (epoch_->parts & part) != 0)) finish();
  if (!epoch_) {
    epoch_.emplace();
    epoch_->stamp = stamp;
  }
  if (!epoch_->time_s) epoch_->time_s = time_s;
  epoch_->parts |= part;
  return *epoch_;
}

void EpochAssembler::on_vtg(const Vtg& vtg, Time stamp) {
  if (epoch_ && (epoch_->parts & kVtg) == 0) {
    epoch_->parts |= kVtg;
    epoch_->vtg = vtg;
    return;
  }
  // Not of the epoch in progress (VTG leads the burst, or has a rate of its own). Where there is no
  // RMC it is the only velocity, so it counts by itself.
  if (!epoch_ || !epoch_->told || epoch_->rmc || epoch_->fix == FixType::None) return;
  if (vtg.mode == 'N') return;
  if (const auto v = velocity(stamp, vtg.speed_kn, vtg.course_true_deg)) on_measurement_(*v);
}

void EpochAssembler::on_heading(std::optional<double> heading_deg, Time stamp) {
  if (!heading_deg) return;
  base::Heading heading;
  heading.stamp = stamp;
  heading.yaw_rad = base::yaw_from_heading(*heading_deg + options_.heading_offset_deg);
  heading.source = options_.heading_source;
  if (epoch_ && !epoch_->heading_told && base::seconds(stamp - epoch_->stamp) < kHeadingReach_s) {
    heading.stamp = epoch_->stamp;
    epoch_->heading_told = true;
  }
  on_measurement_(heading);
}

void EpochAssembler::note_date(std::optional<Date> date, std::optional<double> time_s) {
  if (date && time_s) calendar_.set(*date, *time_s);
}

/// Tells the epoch if it is whole; a told one may still give its velocity.
void EpochAssembler::complete() {
  if (!epoch_->told) {
    if (learned_ != 0 && epoch_->parts == learned_) tell();
  } else if (!epoch_->velocity_told) {
    tell_velocity();
  }
}

void EpochAssembler::finish() {
  if (!epoch_->told) tell();
  if (epoch_->parts == candidate_) learned_ = candidate_;
  candidate_ = epoch_->parts;
  epoch_.reset();
}

void EpochAssembler::tell() {
  epoch_->told = true;
  if (!epoch_->gga && !epoch_->gns && !epoch_->rmc) return;
  const base::GnssFix fix = fix_of(*epoch_);
  epoch_->fix = fix.fix;
  on_measurement_(fix);
  tell_velocity();
}

void EpochAssembler::tell_velocity() {
  Epoch& e = *epoch_;
  if (e.fix == FixType::None) return;
  std::optional<base::GnssVelocity> v;
  if (e.rmc && e.rmc->valid()) v = velocity(e.stamp, e.rmc->speed_kn, e.rmc->course_deg);
  if (!v && e.vtg && e.vtg->mode != 'N') {
    v = velocity(e.stamp, e.vtg->speed_kn, e.vtg->course_true_deg);
  }
  if (!v) return;
  e.velocity_told = true;
  on_measurement_(*v);
}

base::GnssFix EpochAssembler::fix_of(const Epoch& e) const {
  base::GnssFix out;
  out.stamp = e.stamp;
  if (e.time_s) out.utc = calendar_.at(*e.time_s);
  const auto common = [&](const auto& s) {
    out.fix = s.fix();
    out.position = position(s.lat, s.lon);
    out.alt_msl_m = s.alt_msl_m;
    out.geoid_sep_m = s.geoid_sep_m;
    out.satellites = s.sats;
    out.hdop = s.hdop;
    out.correction_age_s = s.dgps_age_s;
  };
  if (e.gga) {
    common(*e.gga);
  } else if (e.gns) {
    common(*e.gns);
  } else {
    out.fix = e.rmc->mode != 0 ? fix_from_mode(e.rmc->mode) : FixType::Single;
    out.position = position(e.rmc->lat, e.rmc->lon);
  }
  if (e.gst) {
    out.sigma_east_m = positive(e.gst->lon_sd_m);
    out.sigma_north_m = positive(e.gst->lat_sd_m);
  }
  if ((e.rmc && !e.rmc->valid()) || (!out.position && out.fix != FixType::Unknown)) {
    out.fix = FixType::None;
  }
  // Without a fix receivers repeat the last position or zeros; neither is where we are.
  if (out.fix == FixType::None || out.fix == FixType::Unknown) {
    out.position.reset();
    out.alt_msl_m.reset();
    out.sigma_east_m.reset();
    out.sigma_north_m.reset();
  }
  return out;
}

void EpochAssembler::tick(Time now) {
  if (epoch_ && !epoch_->told && base::seconds(now - epoch_->last) > options_.timeout_s) tell();
}

void EpochAssembler::reset() {
  if (epoch_ && !epoch_->told) tell();
  epoch_.reset();
  learned_ = 0;
  candidate_ = 0;
}

}  // namespace roverd::gnss
