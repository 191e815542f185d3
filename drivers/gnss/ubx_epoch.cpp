#include "gnss/ubx_epoch.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/angle.hpp"
#include "gnss/sentence.hpp"

namespace roverd::gnss {
namespace {

/// Beyond this an accuracy says "unknown" (the receiver sends all bits set).
constexpr double kUnknownSigma_m = 1e6;
constexpr double kAntennaSigma_m = 0.01;

std::optional<double> axis_sigma(double radius_m) {
  if (!(radius_m > 0.0) || radius_m > kUnknownSigma_m) return std::nullopt;
  return radius_m / std::numbers::sqrt2;
}

std::optional<double> root(double variance) {
  if (!std::isfinite(variance) || variance <= 0.0) return std::nullopt;
  return std::sqrt(variance);
}

std::optional<base::WallTime> utc_of(const ubx::NavPvt& m) {
  if (!m.date_valid() || !m.time_valid()) return std::nullopt;
  const Date date{std::chrono::year{m.year}, std::chrono::month{static_cast<unsigned>(m.month)},
                  std::chrono::day{static_cast<unsigned>(m.day)}};
  if (!date.ok() || m.year < 1980 || m.year > 2200 || m.hour > 23 || m.min > 59 || m.sec > 60)
    return std::nullopt;
  // Whole microseconds, as from NMEA; the fraction may be negative.
  const auto fraction_us = std::llround(m.nano / 1e3);
  return std::chrono::sys_days{date} + std::chrono::hours{m.hour} + std::chrono::minutes{m.min} +
         std::chrono::seconds{m.sec} + std::chrono::microseconds{fraction_us};
}

base::GnssFix fix_from_epoch(const UbxEpoch& e) {
  const ubx::NavPvt& m = *e.pvt;
  base::GnssFix out;
  out.stamp = e.stamp;
  out.fix = fix_from_quality(m.quality());
  out.satellites = m.satellites;
  out.correction_age_s = correction_age_s(m.correction_age_class());
  out.utc = utc_of(m);
  if (!m.usable()) return out;
  const bool precise = e.precise && !e.precise->invalid;
  out.position = precise ? e.precise->at : m.at;
  out.alt_msl_m = precise ? e.precise->height_msl_m : m.height_msl_m;
  out.geoid_sep_m = m.height_ellipsoid_m - m.height_msl_m;
  out.sigma_east_m = out.sigma_north_m =
      axis_sigma(precise ? e.precise->horizontal_sigma_m : m.horizontal_sigma_m);
  if (e.cov && e.cov->position_m2) {
    const ubx::Covariance& p = *e.cov->position_m2;  // NN NE ND EE ED DD
    if (const auto sigma = root(p[3])) out.sigma_east_m = sigma;
    if (const auto sigma = root(p[0])) out.sigma_north_m = sigma;
  }
  return out;
}

base::GnssVelocity velocity_from_epoch(const UbxEpoch& e) {
  const ubx::NavPvt& m = *e.pvt;
  base::GnssVelocity out{e.stamp, m.velocity_mps.east, m.velocity_mps.north, {}};
  if (m.speed_sigma_mps > 0.0) out.sigma_mps = m.speed_sigma_mps;
  if (e.cov && e.cov->velocity_m2ps2) {
    const ubx::Covariance& p = *e.cov->velocity_m2ps2;
    if (const auto sigma = root((p[0] + p[3]) / 2.0)) out.sigma_mps = sigma;
  }
  return out;
}

}  // namespace

std::optional<double> correction_age_s(int age_class) noexcept {
  constexpr std::array kUpTo{0.0, 1.0, 2.0, 5.0, 10.0, 15.0, 20.0, 30.0, 45.0, 60.0, 90.0, 120.0};
  if (age_class <= 0) return std::nullopt;
  const auto i = static_cast<std::size_t>(age_class);
  return i < kUpTo.size() ? kUpTo[i] : 600.0;
}

UbxEpochs::UbxEpochs(const UbxEpochOptions& options, OnMeasurement on_measurement)
    : options_(options), on_measurement_(std::move(on_measurement)) {}

void UbxEpochs::add(const ubx::Message& message, Time stamp) {
  if (const auto* pvt = std::get_if<ubx::NavPvt>(&message)) {
    epoch_for(kPvt, pvt->itow_ms, stamp).pvt = *pvt;
  } else if (const auto* precise = std::get_if<ubx::NavHpPosLlh>(&message)) {
    epoch_for(kPrecise, precise->itow_ms, stamp).precise = *precise;
  } else if (const auto* cov = std::get_if<ubx::NavCov>(&message)) {
    epoch_for(kCov, cov->itow_ms, stamp).cov = *cov;
  } else if (const auto* relative = std::get_if<ubx::NavRelPosNed>(&message)) {
    return on_relative(*relative, stamp);
  } else {
    return;
  }
  complete(stamp);
}

UbxEpoch& UbxEpochs::epoch_for(Part part, std::uint32_t itow_ms, Time stamp) {
  if (epoch_ && (epoch_->itow_ms != itow_ms || (epoch_->parts & part) != 0)) finish();
  if (!epoch_) {
    epoch_.emplace();
    epoch_->stamp = stamp;
    epoch_->itow_ms = itow_ms;
  }
  epoch_->parts |= part;
  return *epoch_;
}

void UbxEpochs::on_relative(const ubx::NavRelPosNed& m, Time stamp) {
  if (options_.baseline_m <= 0.0) return;
  if (!m.heading_usable(options_.baseline_m, options_.baseline_tolerance * options_.baseline_m)) {
    ++headings_refused_;
    return;
  }
  base::Heading heading;
  heading.stamp = epoch_ && epoch_->itow_ms == m.itow_ms ? epoch_->stamp : stamp;
  heading.yaw_rad = base::yaw_from_heading(m.heading_deg + options_.heading_offset_deg);
  heading.source = base::HeadingSource::DualAntenna;
  // What the receiver reports is its noise; the antennas' own centres wander by a centimetre.
  heading.sigma_rad = std::max(base::rad_from_deg(std::max(0.0, m.heading_sigma_deg)),
                               kAntennaSigma_m / options_.baseline_m);
  on_measurement_(heading);
}

void UbxEpochs::complete(Time stamp) {
  epoch_->last = stamp;
  if (!epoch_->told && learned_ != 0 && epoch_->parts == learned_) tell();
}

void UbxEpochs::finish() {
  if (!epoch_->told) tell();
  if (epoch_->parts == candidate_) learned_ = candidate_;
  candidate_ = epoch_->parts;
  epoch_.reset();
}

void UbxEpochs::tell() {
  epoch_->told = true;
  if (!epoch_->pvt) return;
  on_measurement_(fix_from_epoch(*epoch_));
  if (epoch_->pvt->usable()) on_measurement_(velocity_from_epoch(*epoch_));
}

void UbxEpochs::tick(Time now) {
  if (epoch_ && !epoch_->told && base::seconds(now - epoch_->last) > options_.timeout_s) tell();
}

void UbxEpochs::reset() {
  if (epoch_ && !epoch_->told) tell();
  epoch_.reset();
  learned_ = 0;
  candidate_ = 0;
}

}  // namespace roverd::gnss
