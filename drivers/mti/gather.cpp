// MTData2 packets to one sample, and how each packet is accounted for.

#include <cmath>
#include <limits>

#include "base/angle.hpp"
#include "mti/interpreter.hpp"

namespace roverd::mti {
namespace {

constexpr double kUnitLengthError = 0.01;
/// Beyond these a number is none that such a unit measures.
constexpr double kMostRate_radps = 100.0;
constexpr double kMostAccel_mps2 = 1000.0;
constexpr double kMostField = 100.0;
constexpr double kMostVelocity_mps = 1000.0;
constexpr double kMostHeight_m = 100'000.0;

double most_of(Kind kind) noexcept {
  switch (kind) {
    case Kind::RateOfTurn:
      return kMostRate_radps;
    case Kind::Acceleration:
      return kMostAccel_mps2;
    case Kind::MagneticField:
      return kMostField;
    case Kind::Velocity:
      return kMostVelocity_mps;
    case Kind::AltitudeEllipsoid:
      return kMostHeight_m;
    case Kind::Euler:
      return 360.0;
    default:
      return std::numeric_limits<double>::infinity();
  }
}

Vec3 three(const Numbers& n) noexcept {
  return {n[0], n[1], n[2]};
}

/// "temperature" for people: with blanks.
std::string words(std::string_view name) {
  std::string out(name);
  for (char& c : out) {
    if (c == '_') c = ' ';
  }
  return out;
}

}  // namespace

Sample Interpreter::gather(const Data2& data) const {
  Sample s;
  for (const Packet& packet : data.packets) {
    const Kind kind = packet.kind();
    if (packet.fault == Fault::UnknownKind || packet.fault == Fault::OldGnss) {
      ears_.noted(packet.fault == Fault::OldGnss ? "packet of old GNSS format" : "unknown packet",
                  1);
      continue;
    }
    if (packet.fault != Fault::None) {
      ears_.refused(words(name_of(kind)) + ": " + std::string(to_string(packet.fault)), 1);
      continue;
    }
    if (const auto* n = std::get_if<Numbers>(&packet.value)) {
      gather_numbers(s, packet, *n);
    } else if (const auto* whole = std::get_if<std::uint32_t>(&packet.value)) {
      if (kind == Kind::SampleTimeFine) s.count = *whole;
      if (kind == Kind::PacketCounter) s.number = static_cast<std::uint16_t>(*whole);
    } else if (const auto* status = std::get_if<Status>(&packet.value)) {
      if (!s.status || kind == Kind::StatusWord) s.status = *status;  // the byte says less
    } else if (const auto* utc = std::get_if<Utc>(&packet.value)) {
      s.utc = *utc;
    } else if (const auto* pvt = std::get_if<GnssPvt>(&packet.value)) {
      s.pvt = *pvt;
    } else if (const auto* all = std::get_if<Satellites>(&packet.value)) {
      s.satellites = *all;
    }
  }
  return s;
}

void Interpreter::gather_numbers(Sample& s, const Packet& packet, const Numbers& n) const {
  const Axes axes = packet.axes();
  const bool framed = packet.kind() == Kind::Quaternion || packet.kind() == Kind::Euler ||
                      packet.kind() == Kind::Velocity;
  if (framed && axes == Axes::Unknown) {
    return ears_.refused(words(name_of(packet.kind())) + ": unknown coordinate system", 1);
  }
  for (std::size_t i = 0; i < n.size; ++i) {
    if (std::abs(n[i]) <= most_of(packet.kind())) continue;
    return ears_.refused(words(name_of(packet.kind())) + ": impossible", 1);
  }
  switch (packet.kind()) {
    case Kind::RateOfTurn:
      s.rate_S = three(n);
      return;
    case Kind::Acceleration:
      s.accel_S = three(n);
      return;
    case Kind::MagneticField:
      s.field_S = three(n);
      return;
    case Kind::Quaternion: {
      const std::array<double, 4> q{n[0], n[1], n[2], n[3]};
      const double square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
      if (std::abs(square - 1.0) > kUnitLengthError) {
        return ears_.refused("quaternion: not of length one", 1);
      }
      s.R_ES = to_enu(axes) * from_quaternion(q);
      return;
    }
    case Kind::Euler:
      if (!s.R_ES) {
        s.R_ES = to_enu(axes) * from_euler(base::rad_from_deg(n[0]), base::rad_from_deg(n[1]),
                                           base::rad_from_deg(n[2]));
      }
      return;
    case Kind::LatLon:
      s.at = base::LatLon{n[0], n[1]};
      return;
    case Kind::AltitudeEllipsoid:
      s.height_ellipsoid_m = n[0];
      return;
    case Kind::Velocity:
      s.velocity_E = to_enu(axes) * three(n);
      return;
    default:
      ears_.noted("packet of no use", 1);  // temperature, delta v, free acceleration, matrix …
  }
}

}  // namespace roverd::mti
