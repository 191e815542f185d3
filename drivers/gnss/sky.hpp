#pragma once
// GSV, GSA, NAV-SAT and NAV-SIG to the satellites in view: one entry for each satellite, with the
// strongest of its signals, numbered within its system.
//
//   A sweep of GSV groups is told when nothing of it came for kPause_s, or when the next begins.
//   GSA sentences that follow one another are one list of what is used.
//   NAV-SAT is told at once; while it comes, GSV is not told. NAV-SIG gives each satellite its
//   signals; where it comes alone, its satellites have no place in the sky.
//
// Numbers: NMEA counts SBAS as 33-64 (PRN 120-151), GLONASS as 65-96 (slot 1-32), QZSS as 193-202;
// receivers before NMEA 4.11 say Galileo as 301-336 and BeiDou as 201-237 or 401-437. Pure state.

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/measurements.hpp"
#include "gnss/gsv.hpp"
#include "gnss/sentence.hpp"
#include "ubx/messages.hpp"

namespace roverd::gnss {

using base::Time;

/// System and number within it: {"glonass", 5} for 69. @param nmea_system of GSA (1 GPS, 2 GLONASS
/// …); empty: the talker and the number tell.
struct SatelliteName {
  std::string_view system = "unknown";
  int number = 0;
  auto operator<=>(const SatelliteName&) const = default;
};
SatelliteName satellite_name(const Talker& talker, std::optional<int> nmea_system, int id) noexcept;

class Sky {
 public:
  using OnMeasurement = std::function<void(const base::Measurement&)>;
  static constexpr double kPause_s = 0.3;
  /// NAV-SAT silent for so long gives the word back to GSV.
  static constexpr double kPatience_s = 5.0;

  /// @param driver as SatellitesInView names it.
  Sky(std::string driver, OnMeasurement on_measurement)
      : driver_(std::move(driver)), on_measurement_(std::move(on_measurement)) {}

  /// Every sentence, in order.
  void add(const Sentence& sentence, Time stamp);
  void add(const ubx::NavSat& sats, Time stamp);
  void add(const ubx::NavSig& signals, Time stamp);
  void tick(Time now);
  void reset();

 private:
  void add_group(const SatelliteGroup& group, Time stamp);
  void tell(Time stamp);
  void tell_ubx(Time stamp);

  const std::string driver_;
  const OnMeasurement on_measurement_;
  GsvAssembler groups_;
  std::vector<base::Satellite> sweep_;
  std::vector<std::pair<Talker, std::optional<int>>> swept_;  ///< groups of the sweep
  Time last_group_{};
  std::set<SatelliteName> used_;
  bool knows_used_ = false;
  bool in_gsa_ = false;
  std::optional<Time> ubx_;  ///< NAV-SAT or NAV-SIG
  std::vector<base::Satellite> sats_;
  std::optional<Time> sats_at_;
  ubx::NavSig signals_;
  std::optional<Time> signals_at_;
};

}  // namespace roverd::gnss
