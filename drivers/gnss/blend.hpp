#pragma once
// One receiver, two languages: what it says in UBX and in NMEA at the same time becomes one stream
// of measurements. UBX is the more exact one, so while it gives a position (or a heading) NMEA's is
// not told, only read for what UBX lacks: HDOP and the exact age of the corrections.
//
// Also here, for either language: a position of exactly 0, 0 is no position, and a date before
// this software was written is no date (a receiver before its first fix says 1980; one whose week
// counter rolled over is 1,024 weeks late). An epoch that is earlier than the one before it is no
// position either; what comes after is measured against it, so a clock that is set back costs one
// epoch. Counted. Pure state.

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>

#include "base/measurements.hpp"

namespace roverd::gnss {

class Blend {
 public:
  using OnMeasurement = std::function<void(const base::Measurement&)>;
  /// UBX silent for so long gives the word back to NMEA.
  static constexpr double kPatience_s = 2.0;

  struct Counts {
    std::uint64_t zero_positions = 0;
    std::uint64_t impossible_dates = 0;
    std::uint64_t backwards = 0;
  };

  explicit Blend(OnMeasurement on_measurement) : on_measurement_(std::move(on_measurement)) {}

  void nmea(const base::Measurement& m) {
    if (const auto* fix = std::get_if<base::GnssFix>(&m)) {
      said_ = *fix;
      if (!recent(ubx_fix_, fix->stamp)) tell(*fix);
    } else if (const auto* velocity = std::get_if<base::GnssVelocity>(&m)) {
      if (!recent(ubx_fix_, velocity->stamp)) on_measurement_(m);
    } else if (const auto* heading = std::get_if<base::Heading>(&m)) {
      if (!recent(ubx_heading_, heading->stamp)) on_measurement_(m);
    }
  }

  void ubx(const base::Measurement& m) {
    if (const auto* said = std::get_if<base::GnssFix>(&m)) {
      base::GnssFix fix = *said;
      ubx_fix_ = fix.stamp;
      if (said_ && recent(said_->stamp, fix.stamp)) {
        fix.hdop = said_->hdop;
        if (said_->correction_age_s) fix.correction_age_s = said_->correction_age_s;
      }
      return tell(fix);
    }
    if (const auto* heading = std::get_if<base::Heading>(&m)) ubx_heading_ = heading->stamp;
    on_measurement_(m);
  }

  void reset() noexcept {
    ubx_fix_.reset();
    ubx_heading_.reset();
    said_.reset();
    utc_.reset();
  }
  const Counts& counts() const noexcept { return counts_; }

 private:
  static bool recent(std::optional<base::Time> then, base::Time now) noexcept {
    return then && base::seconds(now - *then) < kPatience_s;
  }

  void tell(base::GnssFix fix) {
    using std::chrono::sys_days, std::chrono::year;
    if (fix.utc && *fix.utc < sys_days{year{2015} / 1 / 1}) {
      ++counts_.impossible_dates;
      fix.utc.reset();
    }
    if (fix.position && fix.position->lat == 0.0 && fix.position->lon == 0.0) {
      ++counts_.zero_positions;
      fix.position.reset();
      fix.fix = base::FixType::None;
    }
    if (fix.utc) {
      if (utc_ && *fix.utc < *utc_) {
        ++counts_.backwards;
        fix.position.reset();
        fix.fix = base::FixType::None;
      }
      utc_ = fix.utc;
    }
    on_measurement_(fix);
  }

  const OnMeasurement on_measurement_;
  std::optional<base::GnssFix> said_;  ///< by NMEA, last
  std::optional<base::WallTime> utc_;  ///< of the last epoch
  std::optional<base::Time> ubx_fix_;
  std::optional<base::Time> ubx_heading_;
  Counts counts_;
};

}  // namespace roverd::gnss
