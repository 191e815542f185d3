#pragma once
// UBX payloads to values. Units die here: degrees, metres, metres a second, seconds; headings stay
// compass degrees (clockwise from true north), velocities north, east, down. What a receiver marks
// as not valid is empty; a field without a mark is as sent, so look at `usable()` first.
//
//   NAV-PVT 01 07   NAV-HPPOSLLH 01 14   NAV-SAT 01 35   NAV-COV 01 36   NAV-RELPOSNED 01 3C
//   NAV-SIG 01 43   MON-VER 0A 04        ACK-NAK 05 00   ACK-ACK 05 01
//   CFG-VALSET 06 8A (to the receiver)
//
// Pure. Any payload may come in.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/geo.hpp"
#include "ubx/framer.hpp"

namespace roverd::ubx {

namespace key {
inline constexpr Key kNavPvt{0x01, 0x07};
inline constexpr Key kNavHpPosLlh{0x01, 0x14};
inline constexpr Key kNavSat{0x01, 0x35};
inline constexpr Key kNavCov{0x01, 0x36};
inline constexpr Key kNavRelPosNed{0x01, 0x3C};
inline constexpr Key kNavSig{0x01, 0x43};
inline constexpr Key kAckNak{0x05, 0x00};
inline constexpr Key kAckAck{0x05, 0x01};
inline constexpr Key kCfgValSet{0x06, 0x8A};
inline constexpr Key kMonVer{0x0A, 0x04};
}  // namespace key

/// NED vectors, metres or metres a second.
struct Ned {
  double north = 0.0;
  double east = 0.0;
  double down = 0.0;
};

enum class Carrier : std::uint8_t { None = 0, Float = 1, Fixed = 2 };

struct NavPvt {
  std::uint32_t itow_ms = 0;  ///< GPS time of week
  int year = 0;
  int month = 0;
  int day = 0;
  int hour = 0;
  int min = 0;
  int sec = 0;             ///< 60 in a leap second
  std::int32_t nano = 0;   ///< to be added to the second; may be negative
  std::uint8_t valid = 0;  ///< bits: 0 date, 1 time, 2 fully resolved, 3 magnetic declination
  std::uint32_t time_sigma_ns = 0;
  int fix_type = 0;  ///< 0 none, 1 dead reckoning, 2 2D, 3 3D, 4 both, 5 time only
  std::uint8_t flags = 0;
  std::uint8_t flags2 = 0;
  std::uint16_t flags3 = 0;
  int satellites = 0;
  base::LatLon at;  ///< meaningless unless usable()
  double height_ellipsoid_m = 0.0;
  double height_msl_m = 0.0;
  double horizontal_sigma_m = 0.0;  ///< 4294967.295: unknown
  double vertical_sigma_m = 0.0;
  Ned velocity_mps;
  double ground_speed_mps = 0.0;
  double course_deg = 0.0;  ///< of motion, [0, 360)
  double speed_sigma_mps = 0.0;
  double course_sigma_deg = 0.0;
  double pdop = 0.0;
  std::optional<double> heading_deg;  ///< of the vehicle
  std::optional<double> magnetic_declination_deg;
  std::optional<double> magnetic_declination_sigma_deg;

  bool date_valid() const noexcept { return (valid & 1U) != 0; }
  bool time_valid() const noexcept { return (valid & 2U) != 0; }
  bool time_resolved() const noexcept { return (valid & 4U) != 0; }
  bool fix_ok() const noexcept { return (flags & 1U) != 0; }
  bool differential() const noexcept { return (flags & 2U) != 0; }
  Carrier carrier() const noexcept;
  bool invalid_llh() const noexcept { return (flags3 & 1U) != 0; }
  int correction_age_class() const noexcept { return flags3 >> 1U & 0xF; }
  /// Position, height and velocity may be used.
  bool usable() const noexcept;
  /// As GGA's quality: 0 none, 1 single, 2 differential, 4 RTK fixed, 5 RTK float.
  int quality() const noexcept;
};

struct NavHpPosLlh {
  std::uint32_t itow_ms = 0;
  bool invalid = false;
  base::LatLon at;  ///< to 1e-9 deg
  double height_ellipsoid_m = 0.0;
  double height_msl_m = 0.0;
  double horizontal_sigma_m = 0.0;
  double vertical_sigma_m = 0.0;
};

/// Symmetric, in the order NN, NE, ND, EE, ED, DD.
using Covariance = std::array<double, 6>;
struct NavCov {
  std::uint32_t itow_ms = 0;
  int version = 0;
  std::optional<Covariance> position_m2;
  std::optional<Covariance> velocity_m2ps2;
};

/// Vector from the base to the rover; with a moving base the direction of the vehicle. Version 0
/// (receivers before the F9, 40 bytes) tells neither length nor heading: they are computed from the
/// vector and its accuracies, and the heading counts as valid with a moving base.
struct NavRelPosNed {
  int version = 0;
  int station = 0;
  std::uint32_t itow_ms = 0;
  Ned position_m;
  double length_m = 0.0;     ///< 1 if normalised()
  double heading_deg = 0.0;  ///< [0, 360); see heading_usable()
  Ned sigma_m;
  double length_sigma_m = 0.0;
  double heading_sigma_deg = 0.0;
  std::uint32_t flags = 0;

  bool bit(unsigned n) const noexcept { return (flags >> n & 1U) != 0; }
  bool fix_ok() const noexcept { return bit(0); }
  bool differential() const noexcept { return bit(1); }
  bool position_valid() const noexcept { return bit(2); }
  Carrier carrier() const noexcept;
  bool moving() const noexcept { return bit(5); }
  bool heading_valid() const noexcept;
  bool normalised() const noexcept { return version != 0 && bit(9); }
  /// @param baseline_m as mounted. @param tolerance_m by which the measured length may differ.
  bool heading_usable(double baseline_m, double tolerance_m) const noexcept;
};

/// Every satellite that the receiver knows of.
struct NavSat {
  struct One {
    int gnss_id = 0;  ///< 0 GPS, 1 SBAS, 2 Galileo, 3 BeiDou, 5 QZSS, 6 GLONASS, 7 NavIC
    int number = 0;
    int cn0_dbhz = 0;       ///< 0: not tracked
    int elevation_deg = 0;  ///< beyond ±90: not known
    int azimuth_deg = 0;
    std::uint32_t flags = 0;
    int quality() const noexcept { return static_cast<int>(flags & 7U); }
    bool used() const noexcept { return (flags >> 3U & 1U) != 0; }
  };
  std::uint32_t itow_ms = 0;
  std::vector<One> all;
};

/// Every signal that the receiver tracks: a satellite has one to three.
struct NavSig {
  struct One {
    int gnss_id = 0;  ///< as in NavSat
    int number = 0;
    int signal_id = 0;
    int cn0_dbhz = 0;
    int quality = 0;  ///< 0 none … 4 code locked … 7 code and carrier locked, time known
    unsigned flags = 0;
    double residual_m = 0.0;  ///< of the pseudorange
    /// 0 unknown, 1 healthy, 2 unhealthy.
    int health() const noexcept { return static_cast<int>(flags & 3U); }
    bool code_used() const noexcept { return (flags >> 3U & 1U) != 0; }
    bool carrier_used() const noexcept { return (flags >> 4U & 1U) != 0; }
    bool doppler_used() const noexcept { return (flags >> 5U & 1U) != 0; }
    bool used() const noexcept { return (flags & 0x38U) != 0; }
  };
  std::uint32_t itow_ms = 0;
  std::vector<One> all;
};
/// "L1 C/A", "E5b Q"; empty: unknown here.
std::string_view signal_name(int gnss_id, int signal_id) noexcept;

struct MonVer {
  std::string software;
  std::string hardware;
  std::vector<std::string> extensions;
  /// @param name "MOD", "PROTVER", "FWVER". Empty: not told.
  std::string extension(std::string_view name) const;
};

/// Accepted (ACK-ACK) or rejected (ACK-NAK).
struct Ack {
  bool accepted = false;
  Key to;
};

struct ValSet {
  std::uint8_t layers = 1;  ///< bits: 0 RAM, 1 battery-backed, 2 flash
  struct Item {
    std::uint32_t id = 0;
    std::uint64_t value = 0;
    friend bool operator==(const Item&, const Item&) = default;
  };
  std::vector<Item> items;  ///< at most kMaxItems
  static constexpr std::size_t kMaxItems = 64;
};

/// An empty MON-VER payload asks for the version.
struct Poll {
  Key of;
};

using Message = std::variant<std::monostate, NavPvt, NavHpPosLlh, NavCov, NavRelPosNed, NavSat,
                             NavSig, MonVer, Ack, ValSet, Poll>;

/// NotOurs: intact, but of a class and id that has no struct here.
enum class Verdict { Decoded, NotOurs, TooShort, WrongVersion, BadValue };
std::string_view to_string(Verdict verdict) noexcept;  // in words

struct Decoded {
  Verdict verdict = Verdict::NotOurs;
  Message message{};
};

Decoded decode(const Frame& frame);
/// "NAV-PVT"; empty for what has no name here (more are named than decoded).
std::string_view name_of(Key key) noexcept;

/// Whole frames. More than kMaxItems or an id with an impossible size code: empty.
std::vector<std::uint8_t> encode(const ValSet& set);
std::vector<std::uint8_t> encode(const Poll& poll);

/// Bytes a configuration value takes, from bits 30..28 of its key; 0: no such size.
constexpr std::size_t value_size(std::uint32_t id) noexcept {
  constexpr std::array<std::size_t, 8> kSizes{0, 1, 1, 2, 4, 8, 0, 0};
  return kSizes[id >> 28U & 7U];
}

}  // namespace roverd::ubx
