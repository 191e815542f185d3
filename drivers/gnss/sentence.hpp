#pragma once
// NMEA 0183 sentences as values. Units are the wire's (knots, degrees); the driver converts them.
// An empty field is an empty optional, never zero. Times are UTC seconds of the day; 23:59:60 of a
// leap second is 86400.

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>

#include "base/measurements.hpp"

namespace roverd::gnss {

inline constexpr double kMpsPerKnot = 1852.0 / 3600.0;

/// Who speaks: GP GPS, GL GLONASS, GA Galileo, GB or BD BeiDou, GN combined, HE heading device …
struct Talker {
  std::array<char, 2> id{'G', 'N'};
  constexpr std::string_view view() const noexcept { return {id.data(), id.size()}; }
  friend bool operator==(const Talker&, const Talker&) = default;
};

using Date = std::chrono::year_month_day;

/// GGA quality number to our word; 3 (encrypted service) is a single fix, 7 (manual), 8
/// (simulator) and unlisted numbers are Unknown: not usable.
constexpr base::FixType fix_from_quality(std::optional<int> quality) noexcept {
  using base::FixType;
  constexpr std::array kFix{FixType::None,     FixType::Single,   FixType::Differential,
                            FixType::Single,   FixType::RtkFixed, FixType::RtkFloat,
                            FixType::Estimated};
  if (!quality) return FixType::None;
  const auto q = static_cast<std::size_t>(*quality);
  return q < kFix.size() ? kFix[q] : FixType::Unknown;
}

struct Gga {
  Talker talker{};
  std::optional<double> time_s{};
  std::optional<double> lat{};
  std::optional<double> lon{};
  std::optional<int> quality{};
  std::optional<int> sats{};
  std::optional<double> hdop{};
  std::optional<double> alt_msl_m{};
  std::optional<double> geoid_sep_m{};  ///< ellipsoid height = alt_msl_m + geoid_sep_m
  std::optional<double> dgps_age_s{};
  std::optional<int> station{};

  constexpr base::FixType fix() const noexcept { return fix_from_quality(quality); }
};

struct Rmc {
  Talker talker{};
  std::optional<double> time_s{};
  bool active = false;  ///< status A
  std::optional<double> lat{};
  std::optional<double> lon{};
  std::optional<double> speed_kn{};
  std::optional<double> course_deg{};  ///< over ground, true
  std::optional<Date> date{};
  std::optional<double> magvar_deg{};  ///< west negative
  char mode = 0;                       ///< A D E F M N P R S; 0: before NMEA 2.3
  char nav_status = 0;                 ///< NMEA 4.1; not the validity

  /// Status A, and no mode N beside it.
  constexpr bool valid() const noexcept { return active && mode != 'N'; }
};

struct Vtg {
  Talker talker{};
  std::optional<double> course_true_deg{};
  std::optional<double> course_mag_deg{};
  std::optional<double> speed_kn{};
  std::optional<double> speed_kmh{};
  char mode = 0;  ///< 0: old form
};

struct Gsa {
  Talker talker{};
  bool automatic = false;
  int fix = 1;  ///< 1 none, 2 2D, 3 3D
  std::array<int, 12> ids{};
  std::size_t used = 0;  ///< how many of ids
  std::optional<double> pdop{};
  std::optional<double> hdop{};
  std::optional<double> vdop{};
  std::optional<int> system{};  ///< NMEA 4.11: 1 GPS, 2 GLONASS, 3 Galileo, 4 BeiDou, 5 QZSS …
};

struct Satellite {
  int id = 0;
  std::optional<int> elevation_deg{};
  std::optional<int> azimuth_deg{};
  std::optional<int> cn0_dbhz{};  ///< empty: not tracked
  friend bool operator==(const Satellite&, const Satellite&) = default;
};

/// One of up to nine sentences of a group; see gnss/gsv.hpp.
struct Gsv {
  Talker talker{};
  int total = 1;
  int index = 1;
  int in_view = 0;
  std::optional<int> signal{};
  std::array<Satellite, 4> sats{};
  std::size_t used = 0;
};

struct Gst {
  Talker talker{};
  std::optional<double> time_s{};
  std::optional<double> rms_m{};
  std::optional<double> major_m{};
  std::optional<double> minor_m{};
  std::optional<double> orient_deg{};
  std::optional<double> lat_sd_m{};
  std::optional<double> lon_sd_m{};
  std::optional<double> alt_sd_m{};
};

struct Hdt {
  Talker talker{};
  std::optional<double> heading_deg{};  ///< true, [0, 360]
};

struct Ths {
  Talker talker{};
  std::optional<double> heading_deg{};  ///< empty in mode V
  char mode = 'V';  ///< A autonomous, E estimated, M manual, S simulator, V void
  constexpr bool valid() const noexcept { return mode != 'V' && heading_deg.has_value(); }
};

struct Zda {
  Talker talker{};
  std::optional<double> time_s{};
  std::optional<Date> date{};
  std::optional<int> zone_h{};
  std::optional<int> zone_min{};
};

struct Gns {
  Talker talker{};
  std::optional<double> time_s{};
  std::optional<double> lat{};
  std::optional<double> lon{};
  std::array<char, 8> modes{};  ///< one letter per constellation, unused ones 0
  std::optional<int> sats{};
  std::optional<double> hdop{};
  std::optional<double> alt_msl_m{};
  std::optional<double> geoid_sep_m{};
  std::optional<double> dgps_age_s{};
  std::optional<int> station{};
  char nav_status = 0;

  constexpr std::string_view modes_view() const noexcept {
    std::size_t n = 0;
    while (n < modes.size() && modes[n] != 0) ++n;
    return {modes.data(), n};
  }
  /// The best letter: R over F over D and P over A over E; M and S are Unknown.
  constexpr base::FixType fix() const noexcept;
};

using Sentence = std::variant<std::monostate, Gga, Rmc, Vtg, Gsa, Gsv, Gst, Hdt, Ths, Zda, Gns>;

/// Mode letter of RMC, VTG and GNS (NMEA 2.3 and later) to our word.
constexpr base::FixType fix_from_mode(char letter) noexcept {
  using base::FixType;
  switch (letter) {
    case 'R':
      return FixType::RtkFixed;
    case 'F':
      return FixType::RtkFloat;
    case 'D':
    case 'P':
      return FixType::Differential;
    case 'A':
      return FixType::Single;
    case 'E':
      return FixType::Estimated;
    case 'N':
      return FixType::None;
    default:
      return FixType::Unknown;
  }
}

constexpr base::FixType Gns::fix() const noexcept {
  base::FixType best = base::FixType::None;
  for (const char letter : modes_view()) {
    const base::FixType fix = fix_from_mode(letter);
    if (fix > best) best = fix;
  }
  return best;
}

}  // namespace roverd::gnss
