#pragma once
// MTData2, what an MTi measures: packets of u16 data id (XDI), u8 size, bytes; big endian.
//
//   XDI bits 15-4 what it is, 3-2 coordinate system (0 ENU, 1 NED, 2 NWU), 1-0 number format
//   (0 float32, 1 fp12.20, 2 fp16.32: u32 fraction, then i16 whole, 3 float64)
//
// A packet that runs past the end makes the whole message invalid. A packet of unknown kind is
// kept with its bytes; one of a known kind with a wrong size, or with a number that is none (NaN,
// infinite), says so and has no value. Angles stay in degrees as the device tells them. Pure.

#include <array>
#include <cstdint>
#include <string_view>
#include <variant>
#include <vector>

#include "base/geo.hpp"
#include "mti/xbus.hpp"

namespace roverd::mti {

/// XDI without coordinate system and number format.
enum class Kind : std::uint16_t {
  Temperature = 0x0810,           ///< deg C
  UtcTime = 0x1010,               ///< Utc
  PacketCounter = 0x1020,         ///< u16, wraps
  TimeOfWeek = 0x1030,            ///< u32, ms
  SampleTimeFine = 0x1060,        ///< u32, 100 us, wraps
  SampleTimeCoarse = 0x1070,      ///< u32, s
  Quaternion = 0x2010,            ///< w x y z: sensor frame to local frame
  RotationMatrix = 0x2020,        ///< 9 numbers; their order is to be checked on the device
  Euler = 0x2030,                 ///< roll, pitch, yaw, deg
  Pressure = 0x3010,              ///< u32, Pa
  DeltaV = 0x4010,                ///< m/s
  Acceleration = 0x4020,          ///< m/s2
  FreeAcceleration = 0x4030,      ///< m/s2, without gravity, local frame
  HighRateAcceleration = 0x4040,  ///< m/s2
  AltitudeEllipsoid = 0x5020,     ///< m
  PositionEcef = 0x5030,          ///< m
  LatLon = 0x5040,                ///< deg
  GnssPvt = 0x7010,
  GnssSatellites = 0x7020,
  RateOfTurn = 0x8020,  ///< rad/s
  DeltaQ = 0x8030,
  HighRateTurn = 0x8040,   ///< rad/s
  MagneticField = 0xC020,  ///< 1.0: the field at calibration
  Velocity = 0xD010,       ///< m/s: ENU east north up, NED north east down
  StatusByte = 0xE010,     ///< StatusWord's bits 0-7
  StatusWord = 0xE020,
};

enum class Axes : std::uint8_t { Enu = 0, Ned = 1, Nwu = 2, Unknown = 3 };
enum class Format : std::uint8_t { Float32 = 0, Fp1220 = 1, Fp1632 = 2, Float64 = 3 };
std::string_view to_string(Axes axes) noexcept;      // "ENU"
std::string_view to_string(Format format) noexcept;  // "fp16.32"

/// One to nine numbers of a kind that comes in any format.
struct Numbers {
  std::array<double, 9> value{};
  std::size_t size = 0;
  double operator[](std::size_t i) const noexcept { return value[i]; }
};

struct Utc {
  std::uint32_t nanosecond = 0;
  int year = 0;
  int month = 0;
  int day = 0;
  int hour = 0;
  int minute = 0;
  int second = 0;
  std::uint8_t flags = 0;  ///< bits: 0 date valid, 1 time valid, 2 fully resolved
  bool date_valid() const noexcept { return (flags & 1U) != 0; }
  bool time_valid() const noexcept { return (flags & 2U) != 0; }
  bool resolved() const noexcept { return (flags & 4U) != 0; }
};

struct GnssPvt {
  std::uint32_t itow_ms = 0;
  Utc utc;  ///< nanosecond is not used; see nano
  std::int32_t nano = 0;
  std::uint32_t time_sigma_ns = 0;
  int fix_type = 0;  ///< 0 none, 1 dead reckoning, 2 2D, 3 3D, 4 both, 5 time only
  std::uint8_t flags = 0;
  int satellites = 0;
  base::LatLon at;  ///< meaningless unless usable()
  double height_ellipsoid_m = 0.0;
  double height_msl_m = 0.0;
  double horizontal_sigma_m = 0.0;
  double vertical_sigma_m = 0.0;
  double north_mps = 0.0;
  double east_mps = 0.0;
  double down_mps = 0.0;
  double ground_speed_mps = 0.0;
  double course_deg = 0.0;
  double speed_sigma_mps = 0.0;
  double course_sigma_deg = 0.0;
  double vehicle_heading_deg = 0.0;
  /// geometric, position, time, vertical, horizontal, north, east
  std::array<double, 7> dop{};

  bool fix_ok() const noexcept { return (flags & 1U) != 0; }
  bool differential() const noexcept { return (flags & 2U) != 0; }
  bool usable() const noexcept { return fix_ok() && fix_type >= 2 && fix_type <= 4; }
};

struct Satellite {
  std::uint8_t constellation = 0;
  std::uint8_t id = 0;
  std::uint8_t cn0_dbhz = 0;
  std::uint8_t flags = 0;
};
struct Satellites {
  std::uint32_t itow_ms = 0;
  std::vector<Satellite> all;
};

/// The meaning of StatusWord and StatusByte.
struct Status {
  std::uint32_t word = 0;
  bool bit(unsigned n) const noexcept { return (word >> n & 1U) != 0; }
  bool self_test_ok() const noexcept { return bit(0); }
  bool orientation_valid() const noexcept { return bit(1); }
  bool gnss_fix() const noexcept { return bit(2); }
  bool clipping() const noexcept { return bit(19); }
  /// 0 no GNSS, 1 coasting, 3 with GNSS.
  int filter_mode() const noexcept { return static_cast<int>(word >> 23U & 7U); }
};

enum class Fault { None, UnknownKind, OldGnss, WrongSize, NotFinite, OutOfRange };
std::string_view to_string(Fault fault) noexcept;  // in words

struct Packet {
  std::uint16_t xdi = 0;
  Bytes bytes;  ///< valid as long as the payload
  Fault fault = Fault::UnknownKind;
  std::variant<std::monostate, Numbers, std::uint32_t, Utc, GnssPvt, Satellites, Status> value;

  Kind kind() const noexcept { return static_cast<Kind>(xdi & 0xFFF0U); }
  Axes axes() const noexcept { return static_cast<Axes>(xdi >> 2U & 3U); }
  Format format() const noexcept { return static_cast<Format>(xdi & 3U); }
};

struct Data2 {
  bool whole = false;  ///< false: a packet ran past the end; nothing of it is to be used
  std::vector<Packet> packets;
};

/// @param payload of message 36.
Data2 decode_data2(Bytes payload);
/// "acceleration"; empty: unknown.
std::string_view name_of(Kind kind) noexcept;

}  // namespace roverd::mti
