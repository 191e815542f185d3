#include "mti/data2.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

namespace roverd::mti {
namespace {

/// Big endian. @param at with enough bytes behind it.
std::uint64_t raw(Bytes p, std::size_t at, std::size_t size) noexcept {
  std::uint64_t v = 0;
  for (std::size_t i = 0; i < size; ++i) v = v << 8U | p[at + i];
  return v;
}
std::uint16_t u2(Bytes p, std::size_t at) noexcept {
  return static_cast<std::uint16_t>(raw(p, at, 2));
}
std::uint32_t u4(Bytes p, std::size_t at) noexcept {
  return static_cast<std::uint32_t>(raw(p, at, 4));
}
std::int32_t i4(Bytes p, std::size_t at) noexcept {
  return static_cast<std::int32_t>(u4(p, at));
}
double mm(Bytes p, std::size_t at) noexcept {
  return i4(p, at) / 1e3;
}
double mm_unsigned(Bytes p, std::size_t at) noexcept {
  return u4(p, at) / 1e3;
}

constexpr std::size_t width(Format format) noexcept {
  constexpr std::array<std::size_t, 4> kWidths{4, 4, 6, 8};
  return kWidths[static_cast<std::size_t>(format)];
}

double number(Bytes p, std::size_t at, Format format) noexcept {
  switch (format) {
    case Format::Float32:
      return std::bit_cast<float>(u4(p, at));
    case Format::Fp1220:
      return i4(p, at) / 1048576.0;
    case Format::Fp1632:
      return static_cast<std::int16_t>(u2(p, at + 4)) + u4(p, at) / 4294967296.0;
    case Format::Float64:
      break;
  }
  return std::bit_cast<double>(raw(p, at, 8));
}

/// What is known of a kind. count: numbers of any format; 0: of its own layout.
struct Row {
  Kind kind;
  std::string_view name;
  std::size_t count;
};
constexpr std::array kRows{
    Row{Kind::Temperature, "temperature", 1},
    Row{Kind::UtcTime, "utc_time", 0},
    Row{Kind::PacketCounter, "packet_counter", 0},
    Row{Kind::TimeOfWeek, "time_of_week", 0},
    Row{Kind::SampleTimeFine, "sample_time_fine", 0},
    Row{Kind::SampleTimeCoarse, "sample_time_coarse", 0},
    Row{Kind::Quaternion, "quaternion", 4},
    Row{Kind::RotationMatrix, "rotation_matrix", 9},
    Row{Kind::Euler, "euler", 3},
    Row{Kind::Pressure, "pressure", 0},
    Row{Kind::DeltaV, "delta_v", 3},
    Row{Kind::Acceleration, "acceleration", 3},
    Row{Kind::FreeAcceleration, "free_acceleration", 3},
    Row{Kind::HighRateAcceleration, "high_rate_acceleration", 3},
    Row{Kind::AltitudeEllipsoid, "altitude", 1},
    Row{Kind::PositionEcef, "ecef_position", 3},
    Row{Kind::LatLon, "lat_lon", 2},
    Row{Kind::GnssPvt, "gnss_pvt", 0},
    Row{Kind::GnssSatellites, "gnss_satellites", 0},
    Row{Kind::RateOfTurn, "rate_of_turn", 3},
    Row{Kind::DeltaQ, "delta_q", 4},
    Row{Kind::HighRateTurn, "high_rate_rate_of_turn", 3},
    Row{Kind::MagneticField, "magnetic_field", 3},
    Row{Kind::Velocity, "velocity", 3},
    Row{Kind::StatusByte, "status_byte", 0},
    Row{Kind::StatusWord, "status_word", 0},
};

const Row* row_of(Kind kind) noexcept {
  const auto found = std::ranges::find(kRows, kind, &Row::kind);
  return found == kRows.end() ? nullptr : &*found;
}

bool on_earth(base::LatLon at) noexcept {
  return std::abs(at.lat) <= 90.0 && std::abs(at.lon) <= 180.0;
}

void read_numbers(Packet& packet, std::size_t count) {
  const Format format = packet.format();
  packet.fault = Fault::WrongSize;
  if (packet.bytes.size() != count * width(format)) return;
  Numbers n;
  n.size = count;
  for (std::size_t i = 0; i < count; ++i) {
    n.value[i] = number(packet.bytes, i * width(format), format);
    packet.fault = Fault::NotFinite;
    if (!std::isfinite(n.value[i])) return;
  }
  packet.fault = Fault::OutOfRange;
  if (packet.kind() == Kind::LatLon && !on_earth({n[0], n[1]})) return;
  packet.fault = Fault::None;
  packet.value = n;
}

/// Date and time as both structures have them: year, then one byte each, flags last.
Utc read_utc(Bytes p, std::size_t at) noexcept {
  Utc u;
  u.year = u2(p, at);
  u.month = p[at + 2];
  u.day = p[at + 3];
  u.hour = p[at + 4];
  u.minute = p[at + 5];
  u.second = p[at + 6];
  u.flags = p[at + 7];
  return u;
}

GnssPvt read_pvt(Bytes p) {
  constexpr double kPerDeg = 1e7;
  constexpr double kPerHeadingDeg = 1e5;
  GnssPvt m;
  m.itow_ms = u4(p, 0);
  m.utc = read_utc(p, 4);
  m.time_sigma_ns = u4(p, 12);
  m.nano = i4(p, 16);
  m.fix_type = p[20];
  m.flags = p[21];
  m.satellites = p[22];
  m.at = {i4(p, 28) / kPerDeg, i4(p, 24) / kPerDeg};
  m.height_ellipsoid_m = mm(p, 32);
  m.height_msl_m = mm(p, 36);
  m.horizontal_sigma_m = mm_unsigned(p, 40);
  m.vertical_sigma_m = mm_unsigned(p, 44);
  m.north_mps = mm(p, 48);
  m.east_mps = mm(p, 52);
  m.down_mps = mm(p, 56);
  m.ground_speed_mps = mm(p, 60);
  m.course_deg = i4(p, 64) / kPerHeadingDeg;
  m.speed_sigma_mps = mm_unsigned(p, 68);
  m.course_sigma_deg = u4(p, 72) / kPerHeadingDeg;
  m.vehicle_heading_deg = i4(p, 76) / kPerHeadingDeg;
  for (std::size_t i = 0; i < m.dop.size(); ++i) m.dop[i] = u2(p, 80 + 2 * i) / 100.0;
  return m;
}

std::optional<Satellites> read_satellites(Bytes p) {
  constexpr std::size_t kHead = 8;
  if (p.size() < kHead || p.size() != kHead + 4U * p[4]) return {};
  Satellites s{u4(p, 0), {}};
  for (std::size_t at = kHead; at < p.size(); at += 4) {
    s.all.push_back({p[at], p[at + 1], p[at + 2], p[at + 3]});
  }
  return s;
}

void read_structure(Packet& packet) {
  const Bytes p = packet.bytes;
  packet.fault = Fault::WrongSize;
  const auto integer = [&](std::size_t size) {
    if (p.size() != size) return;
    packet.value = static_cast<std::uint32_t>(raw(p, 0, size));
    packet.fault = Fault::None;
  };
  const auto status = [&](std::size_t size) {
    if (p.size() != size) return;
    packet.value = Status{static_cast<std::uint32_t>(raw(p, 0, size))};
    packet.fault = Fault::None;
  };
  switch (packet.kind()) {
    case Kind::PacketCounter:
      return integer(2);
    case Kind::TimeOfWeek:
    case Kind::SampleTimeFine:
    case Kind::SampleTimeCoarse:
    case Kind::Pressure:
      return integer(4);
    case Kind::StatusByte:
      return status(1);
    case Kind::StatusWord:
      return status(4);
    case Kind::UtcTime:
      if (p.size() != 12) return;
      packet.value = read_utc(p, 4);
      std::get<Utc>(packet.value).nanosecond = u4(p, 0);
      packet.fault = Fault::None;
      return;
    case Kind::GnssPvt: {
      if (p.size() != 94) return;
      const GnssPvt pvt = read_pvt(p);
      packet.fault = on_earth(pvt.at) ? Fault::None : Fault::OutOfRange;
      if (packet.fault == Fault::None) packet.value = pvt;
      return;
    }
    case Kind::GnssSatellites:
      if (auto found = read_satellites(p)) {
        packet.value = std::move(*found);
        packet.fault = Fault::None;
      }
      return;
    default:
      packet.fault = Fault::UnknownKind;
  }
}

/// GPS packets of the first firmware of the MTi-G-700.
constexpr bool is_old_gnss(std::uint16_t xdi) noexcept {
  const unsigned kind = xdi & 0xFFF0U;
  return kind == 0x8830 || kind == 0x8840 || kind == 0x8880 || kind == 0x88A0;
}

}  // namespace

std::string_view to_string(Axes axes) noexcept {
  constexpr std::array<std::string_view, 4> kWords{"ENU", "NED", "NWU", "unknown"};
  return kWords[static_cast<std::size_t>(axes)];
}

std::string_view to_string(Format format) noexcept {
  constexpr std::array<std::string_view, 4> kWords{"float32", "fp12.20", "fp16.32", "float64"};
  return kWords[static_cast<std::size_t>(format)];
}

std::string_view to_string(Fault fault) noexcept {
  switch (fault) {
    case Fault::None:
      return "none";
    case Fault::UnknownKind:
      return "unknown data id";
    case Fault::OldGnss:
      return "old GNSS format";
    case Fault::WrongSize:
      return "the wrong size for this data id";
    case Fault::NotFinite:
      return "a number that is none";
    case Fault::OutOfRange:
      return "a position that is not on earth";
  }
  return "?";
}

std::string_view name_of(Kind kind) noexcept {
  const Row* row = row_of(kind);
  return row == nullptr ? std::string_view() : row->name;
}

Data2 decode_data2(Bytes payload) {
  constexpr std::size_t kHead = 3;
  Data2 out;
  for (std::size_t at = 0; at < payload.size();) {
    if (payload.size() - at < kHead) return {};
    const std::size_t size = payload[at + 2];
    if (payload.size() - at - kHead < size) return {};
    Packet packet;
    packet.xdi = u2(payload, at);
    packet.bytes = payload.subspan(at + kHead, size);
    const Row* row = row_of(packet.kind());
    if (is_old_gnss(packet.xdi)) {
      packet.fault = Fault::OldGnss;
    } else if (row != nullptr && row->count > 0) {
      read_numbers(packet, row->count);
    } else if (row != nullptr) {
      read_structure(packet);
    }
    out.packets.push_back(std::move(packet));
    at += kHead + size;
  }
  out.whole = true;
  return out;
}

}  // namespace roverd::mti
