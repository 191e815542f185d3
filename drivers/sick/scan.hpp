#pragma once
// The scan telegram (LMDscandata), field by field as the scanner says it, in either dialect and
// either direction. Device units stay until sight.hpp; names carry them. Pure.
//
// Source: SICK, Telegram Listing Ranging Sensors (8014631), LMDscandata.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "sick/fields.hpp"

namespace roverd::sick {

inline constexpr std::string_view kScanData = "LMDscandata";

struct Encoder {
  std::int32_t position = 0;  ///< ticks
  std::uint16_t speed = 0;    ///< ticks/mm
  friend bool operator==(const Encoder&, const Encoder&) = default;
};

/// One measured quantity of all beams. Value = raw · scale + offset: of DISTn mm, of RSSIn none.
struct Channel {
  std::string name;  ///< five characters: DIST1 RSSI1 DIST2 RSSI2
  int bits = 16;     ///< 16 or 8
  float scale = 1.0F;
  float offset = 0.0F;
  std::int32_t start_e4deg = 0;  ///< of beam 0, 0.0001°, in the scanner's angles
  std::uint16_t step_e4deg = 0;  ///< counter-clockwise seen from above
  std::vector<std::uint16_t> values;
  friend bool operator==(const Channel&, const Channel&) = default;
};

/// Where somebody told the scanner that it is.
struct Position {
  std::array<float, 6> xyz_turns{};  ///< x y z, then turns about them
  std::uint8_t rotation = 0;
  friend bool operator==(const Position&, const Position&) = default;
};

/// Of the scanner's own calendar, which may never have been set.
struct DeviceTime {
  std::uint16_t year = 1970;
  std::uint8_t month = 1;
  std::uint8_t day = 1;
  std::uint8_t hour = 0;
  std::uint8_t minute = 0;
  std::uint8_t second = 0;
  std::uint32_t microsecond = 0;
  friend bool operator==(const DeviceTime&, const DeviceTime&) = default;
};

struct Scan {
  bool polled = false;  ///< sRA, an answer; else sSN, one of a stream
  std::uint16_t version = 1;
  std::uint16_t device = 1;
  std::uint32_t serial = 0;
  std::array<std::uint8_t, 2> status{};  ///< 0 0 is well: status_of
  std::uint16_t telegram_count = 0;
  std::uint16_t scan_count = 0;
  std::uint32_t start_us = 0;  ///< since power up, of the scan; wraps after 71.6 min
  std::uint32_t sent_us = 0;   ///< of its transmission, on the same clock
  std::array<std::uint8_t, 2> inputs{};
  std::array<std::uint8_t, 2> outputs{};
  std::uint16_t layer = 0;
  std::uint32_t scan_frequency_chz = 0;  ///< 0.01 Hz
  std::uint32_t measuring_hhz = 0;       ///< 100 Hz
  std::vector<Encoder> encoders;
  std::vector<Channel> channels;  ///< those of 16 bits, then those of 8
  std::optional<Position> position;
  std::optional<std::string> name;
  std::optional<std::string> comment;
  std::optional<DeviceTime> time;
  std::uint16_t event = 0;  ///< not 0: event data followed, which are not read
  friend bool operator==(const Scan&, const Scan&) = default;
};

/// What the status pair says. The second number is a set of bits: 1 faulty, 2 the window is getting
/// dirty, 4 it is too dirty; a first number other than 0 is said while the scanner starts.
struct Status {
  bool good = true;  ///< no fault, and started
  bool dirty = false;
  bool blocked = false;
  std::string_view words;  ///< ok, starting, faulty, pollution warning, pollution error
};
Status status_of(const Scan& scan) noexcept;

/// Is this telegram a scan (which may yet be damaged)?
bool is_scan(const Words& words) noexcept;

/// @param telegram one for which is_scan. @return Malformed, with the field and the byte of the
/// body: a number that is none or too large for its field, a count that does not fit, bytes after
/// the last field, a scale or offset that is no number or absurd (scale in (0, 1000], offset within
/// ±1e6).
base::Result<Scan> decode_scan(const Telegram& telegram);

/// With its frame: what the scanner would send. Of event only the flag.
std::vector<std::uint8_t> encode(const Scan& scan, Dialect dialect);

}  // namespace roverd::sick
