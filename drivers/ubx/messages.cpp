#include "ubx/messages.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace roverd::ubx {
namespace {

// Steps a unit. Divided by, so that a value is the double nearest to what was sent.
constexpr double kPerDeg = 1e7;
constexpr double kPerHeadingDeg = 1e5;

/// Little endian. @param at with enough bytes behind it.
std::uint64_t raw(Bytes p, std::size_t at, std::size_t size) noexcept {
  std::uint64_t v = 0;
  for (std::size_t i = size; i-- > 0;) v = v << 8U | p[at + i];
  return v;
}
std::uint16_t u2(Bytes p, std::size_t at) noexcept {
  return static_cast<std::uint16_t>(raw(p, at, 2));
}
std::uint32_t u4(Bytes p, std::size_t at) noexcept {
  return static_cast<std::uint32_t>(raw(p, at, 4));
}
std::int16_t i2(Bytes p, std::size_t at) noexcept {
  return static_cast<std::int16_t>(u2(p, at));
}
std::int32_t i4(Bytes p, std::size_t at) noexcept {
  return static_cast<std::int32_t>(u4(p, at));
}
std::int8_t i1(Bytes p, std::size_t at) noexcept {
  return static_cast<std::int8_t>(p[at]);
}
double r4(Bytes p, std::size_t at) noexcept {
  return std::bit_cast<float>(u4(p, at));
}
double mm(Bytes p, std::size_t at) noexcept {
  return i4(p, at) / 1e3;
}
double mm_unsigned(Bytes p, std::size_t at) noexcept {
  return u4(p, at) / 1e3;
}
Ned ned_mm(Bytes p, std::size_t at) noexcept {
  return {mm(p, at), mm(p, at + 4), mm(p, at + 8)};
}

Carrier carrier_of(unsigned bits) noexcept {
  if (bits == 2) return Carrier::Fixed;
  return bits == 1 ? Carrier::Float : Carrier::None;
}

Decoded too_short() {
  return {Verdict::TooShort, {}};
}

Decoded nav_pvt(Bytes p) {
  constexpr std::size_t kOldLength = 84;
  constexpr std::size_t kLength = 92;
  if (p.size() < kOldLength) return too_short();
  NavPvt m;
  m.itow_ms = u4(p, 0);
  m.year = u2(p, 4);
  m.month = p[6];
  m.day = p[7];
  m.hour = p[8];
  m.min = p[9];
  m.sec = p[10];
  m.valid = p[11];
  m.time_sigma_ns = u4(p, 12);
  m.nano = i4(p, 16);
  m.fix_type = p[20];
  m.flags = p[21];
  m.flags2 = p[22];
  m.satellites = p[23];
  m.at = {i4(p, 28) / kPerDeg, i4(p, 24) / kPerDeg};
  m.height_ellipsoid_m = mm(p, 32);
  m.height_msl_m = mm(p, 36);
  m.horizontal_sigma_m = mm_unsigned(p, 40);
  m.vertical_sigma_m = mm_unsigned(p, 44);
  m.velocity_mps = ned_mm(p, 48);
  m.ground_speed_mps = mm(p, 60);
  m.course_deg = i4(p, 64) / kPerHeadingDeg;
  m.speed_sigma_mps = mm_unsigned(p, 68);
  m.course_sigma_deg = u4(p, 72) / kPerHeadingDeg;
  m.pdop = u2(p, 76) / 100.0;
  m.flags3 = u2(p, 78);
  if (p.size() >= kLength) {
    if ((m.flags & 1U << 5U) != 0) m.heading_deg = i4(p, 84) / kPerHeadingDeg;
    if ((m.valid & 1U << 3U) != 0) {
      m.magnetic_declination_deg = i2(p, 88) / 100.0;
      m.magnetic_declination_sigma_deg = u2(p, 90) / 100.0;
    }
  }
  const bool on_earth = std::abs(m.at.lat) <= 90.0 && std::abs(m.at.lon) <= 180.0;
  return on_earth ? Decoded{Verdict::Decoded, m} : Decoded{Verdict::BadValue, {}};
}

Decoded nav_hpposllh(Bytes p) {
  if (p.size() < 36) return too_short();
  if (p[0] != 0) return {Verdict::WrongVersion, {}};
  // Coarse steps are a hundred, or ten, of the fine ones.
  const auto degrees = [&](std::size_t at, std::size_t fine) {
    return static_cast<double>(std::int64_t{i4(p, at)} * 100 + i1(p, fine)) / 1e9;
  };
  const auto metres = [&](std::size_t at, std::size_t fine) {
    return static_cast<double>(std::int64_t{i4(p, at)} * 10 + i1(p, fine)) / 1e4;
  };
  NavHpPosLlh m;
  m.invalid = (p[3] & 1U) != 0;
  m.itow_ms = u4(p, 4);
  m.at = {degrees(12, 25), degrees(8, 24)};
  m.height_ellipsoid_m = metres(16, 26);
  m.height_msl_m = metres(20, 27);
  m.horizontal_sigma_m = u4(p, 28) / 1e4;
  m.vertical_sigma_m = u4(p, 32) / 1e4;
  const bool on_earth = std::abs(m.at.lat) <= 90.0 && std::abs(m.at.lon) <= 180.0;
  return on_earth ? Decoded{Verdict::Decoded, m} : Decoded{Verdict::BadValue, {}};
}

Decoded nav_sat(Bytes p) {
  constexpr std::size_t kHead = 8;
  constexpr std::size_t kOne = 12;
  if (p.size() < kHead) return too_short();
  if (p[4] != 1) return {Verdict::WrongVersion, {}};
  const std::size_t count = p[5];
  if (p.size() < kHead + kOne * count) return too_short();
  NavSat m{u4(p, 0), {}};
  m.all.reserve(count);
  for (std::size_t at = kHead; m.all.size() < count; at += kOne) {
    m.all.push_back({p[at], p[at + 1], p[at + 2], i1(p, at + 3), i2(p, at + 4), u4(p, at + 8)});
  }
  return {Verdict::Decoded, std::move(m)};
}

std::optional<Covariance> covariance(Bytes p, std::size_t at) {
  Covariance c{};
  for (std::size_t i = 0; i < c.size(); ++i) c[i] = r4(p, at + 4 * i);
  if (!std::ranges::all_of(c, [](double x) { return std::isfinite(x); })) return {};
  return c;
}

Decoded nav_cov(Bytes p) {
  if (p.size() < 64) return too_short();
  NavCov m;
  m.itow_ms = u4(p, 0);
  m.version = p[4];
  if (p[5] != 0) m.position_m2 = covariance(p, 16);
  if (p[6] != 0) m.velocity_m2ps2 = covariance(p, 40);
  return {Verdict::Decoded, m};
}

Decoded nav_sig(Bytes p) {
  constexpr std::size_t kHead = 8;
  constexpr std::size_t kOne = 16;
  if (p.size() < kHead) return too_short();
  if (p[4] != 0) return {Verdict::WrongVersion, {}};
  const std::size_t count = p[5];
  if (p.size() < kHead + kOne * count) return too_short();
  NavSig m{u4(p, 0), {}};
  m.all.reserve(count);
  for (std::size_t at = kHead; m.all.size() < count; at += kOne) {
    m.all.push_back(
        {p[at], p[at + 1], p[at + 2], p[at + 6], p[at + 7], u2(p, at + 10), i2(p, at + 4) / 10.0});
  }
  return {Verdict::Decoded, std::move(m)};
}

/// 40 bytes: centimetres, then tenths of a millimetre, accuracies, flags.
Decoded nav_relposned_0(Bytes p) {
  if (p.size() < 40) return too_short();
  const auto metres = [&](std::size_t at, std::size_t fine) {
    return static_cast<double>(std::int64_t{i4(p, at)} * 100 + i1(p, fine)) / 1e4;
  };
  NavRelPosNed m;
  m.station = u2(p, 2);
  m.itow_ms = u4(p, 4);
  m.position_m = {metres(8, 20), metres(12, 21), metres(16, 22)};
  m.sigma_m = {u4(p, 24) / 1e4, u4(p, 28) / 1e4, u4(p, 32) / 1e4};
  m.flags = u4(p, 36);
  const Ned& at = m.position_m;
  const double flat = std::hypot(at.north, at.east);
  m.length_m = std::hypot(flat, at.down);
  m.length_sigma_m = std::hypot(m.sigma_m.north, m.sigma_m.east, m.sigma_m.down);
  if (flat <= 0.0) return {Verdict::Decoded, m};
  const double heading = std::atan2(at.east, at.north) * 180.0 / std::numbers::pi;
  m.heading_deg = heading < 0.0 ? heading + 360.0 : heading;
  const double across = std::hypot(m.sigma_m.north * at.east, m.sigma_m.east * at.north) / flat;
  m.heading_sigma_deg = std::atan2(across, flat) * 180.0 / std::numbers::pi;
  return {Verdict::Decoded, m};
}

Decoded nav_relposned(Bytes p) {
  if (p.empty()) return too_short();
  if (p[0] == 0) return nav_relposned_0(p);
  if (p[0] != 1) return {Verdict::WrongVersion, {}};
  if (p.size() < 64) return too_short();
  const auto metres = [&](std::size_t at, std::size_t fine) {
    return static_cast<double>(std::int64_t{i4(p, at)} * 100 + i1(p, fine)) / 1e4;
  };
  const auto sigma_m = [&](std::size_t at) { return u4(p, at) / 1e4; };
  NavRelPosNed m;
  m.version = p[0];
  m.station = u2(p, 2);
  m.itow_ms = u4(p, 4);
  m.position_m = {metres(8, 32), metres(12, 33), metres(16, 34)};
  m.length_m = metres(20, 35);
  m.heading_deg = i4(p, 24) / kPerHeadingDeg;
  m.sigma_m = {sigma_m(36), sigma_m(40), sigma_m(44)};
  m.length_sigma_m = sigma_m(48);
  m.heading_sigma_deg = u4(p, 52) / kPerHeadingDeg;
  m.flags = u4(p, 60);
  return {Verdict::Decoded, m};
}

/// Printable characters up to the first zero.
std::string text(Bytes p, std::size_t at, std::size_t size) {
  std::string out;
  for (std::size_t i = at; i < at + size && p[i] != 0; ++i) {
    out += p[i] >= ' ' && p[i] <= '~' ? static_cast<char>(p[i]) : '?';
  }
  return out;
}

Decoded mon_ver(Bytes p) {
  constexpr std::size_t kPart = 30;
  constexpr std::size_t kHead = 40;
  if (p.empty()) return {Verdict::Decoded, Poll{key::kMonVer}};
  if (p.size() < kHead) return too_short();
  MonVer m{text(p, 0, kPart), text(p, kPart, kHead - kPart), {}};
  for (std::size_t at = kHead; at + kPart <= p.size(); at += kPart) {
    m.extensions.push_back(text(p, at, kPart));
  }
  return {Verdict::Decoded, std::move(m)};
}

Decoded ack(Bytes p, bool accepted) {
  if (p.size() < 2) return too_short();
  return {Verdict::Decoded, Ack{accepted, {p[0], p[1]}}};
}

Decoded valset(Bytes p) {
  if (p.size() < 4) return too_short();
  if (p[0] != 0) return {Verdict::WrongVersion, {}};
  ValSet m;
  m.layers = p[1];
  for (std::size_t at = 4; at < p.size();) {
    if (p.size() - at < 4) return too_short();
    ValSet::Item item{u4(p, at), 0};
    const std::size_t size = value_size(item.id);
    if (size == 0 || m.items.size() == ValSet::kMaxItems) return {Verdict::BadValue, {}};
    if (p.size() - at - 4 < size) return too_short();
    item.value = raw(p, at + 4, size);
    m.items.push_back(item);
    at += 4 + size;
  }
  return {Verdict::Decoded, std::move(m)};
}

struct Name {
  Key key;
  std::string_view name;
};
constexpr std::array kNames{
    Name{key::kNavPvt, "NAV-PVT"},       Name{key::kNavHpPosLlh, "NAV-HPPOSLLH"},
    Name{key::kNavCov, "NAV-COV"},       Name{key::kNavRelPosNed, "NAV-RELPOSNED"},
    Name{key::kAckNak, "ACK-NAK"},       Name{key::kAckAck, "ACK-ACK"},
    Name{key::kCfgValSet, "CFG-VALSET"}, Name{key::kMonVer, "MON-VER"},
    Name{{0x01, 0x01}, "NAV-POSECEF"},   Name{{0x01, 0x02}, "NAV-POSLLH"},
    Name{{0x01, 0x03}, "NAV-STATUS"},    Name{{0x01, 0x04}, "NAV-DOP"},
    Name{{0x01, 0x12}, "NAV-VELNED"},    Name{{0x01, 0x13}, "NAV-HPPOSECEF"},
    Name{{0x01, 0x20}, "NAV-TIMEGPS"},   Name{{0x01, 0x21}, "NAV-TIMEUTC"},
    Name{{0x01, 0x22}, "NAV-CLOCK"},     Name{{0x01, 0x26}, "NAV-TIMELS"},
    Name{key::kNavSat, "NAV-SAT"},       Name{key::kNavSig, "NAV-SIG"},
    Name{{0x01, 0x61}, "NAV-EOE"},       Name{{0x02, 0x13}, "RXM-SFRBX"},
    Name{{0x02, 0x15}, "RXM-RAWX"},      Name{{0x02, 0x32}, "RXM-RTCM"},
    Name{{0x06, 0x00}, "CFG-PRT"},       Name{{0x06, 0x01}, "CFG-MSG"},
    Name{{0x06, 0x8B}, "CFG-VALGET"},    Name{{0x0A, 0x09}, "MON-HW"},
    Name{{0x0A, 0x36}, "MON-COMMS"},     Name{{0x0A, 0x38}, "MON-RF"},
    Name{{0x0D, 0x01}, "TIM-TP"},        Name{{0x10, 0x02}, "ESF-MEAS"},
};

void append(std::vector<std::uint8_t>& out, std::uint64_t value, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) out.push_back(static_cast<std::uint8_t>(value >> 8 * i));
}

}  // namespace

Carrier NavPvt::carrier() const noexcept {
  return carrier_of(flags >> 6U & 3U);
}

bool NavPvt::usable() const noexcept {
  return fix_ok() && fix_type >= 2 && fix_type <= 4 && !invalid_llh();
}

int NavPvt::quality() const noexcept {
  if (!usable()) return 0;
  if (carrier() == Carrier::Fixed) return 4;
  if (carrier() == Carrier::Float) return 5;
  return differential() ? 2 : 1;
}

Carrier NavRelPosNed::carrier() const noexcept {
  return carrier_of(flags >> 3U & 3U);
}

bool NavRelPosNed::heading_valid() const noexcept {
  if (version != 0) return bit(8);
  return position_valid() && moving() && (position_m.north != 0.0 || position_m.east != 0.0);
}

bool NavRelPosNed::heading_usable(double baseline_m, double tolerance_m) const noexcept {
  return fix_ok() && position_valid() && heading_valid() && !normalised() &&
         carrier() == Carrier::Fixed && std::abs(length_m - baseline_m) <= tolerance_m;
}

std::string MonVer::extension(std::string_view name) const {
  for (const std::string& e : extensions) {
    if (e.size() > name.size() && e.starts_with(name) && e[name.size()] == '=') {
      return e.substr(name.size() + 1);
    }
  }
  return {};
}

std::string_view to_string(Verdict verdict) noexcept {
  switch (verdict) {
    case Verdict::Decoded:
      return "decoded";
    case Verdict::NotOurs:
      return "a message that roverd has no use for";
    case Verdict::TooShort:
      return "the payload is too short";
    case Verdict::WrongVersion:
      return "a version of this message that roverd does not know";
    case Verdict::BadValue:
      return "a value outside its range";
  }
  return "?";
}

Decoded decode(const Frame& frame) {
  const Bytes p = frame.payload;
  if (frame.key == key::kNavPvt) return nav_pvt(p);
  if (frame.key == key::kNavHpPosLlh) return nav_hpposllh(p);
  if (frame.key == key::kNavCov) return nav_cov(p);
  if (frame.key == key::kNavSat) return nav_sat(p);
  if (frame.key == key::kNavSig) return nav_sig(p);
  if (frame.key == key::kNavRelPosNed) return nav_relposned(p);
  if (frame.key == key::kAckAck || frame.key == key::kAckNak) {
    return ack(p, frame.key == key::kAckAck);
  }
  if (frame.key == key::kCfgValSet) return valset(p);
  if (frame.key == key::kMonVer) return mon_ver(p);
  return {};
}

std::string_view name_of(Key key) noexcept {
  const auto found = std::ranges::find(kNames, key, &Name::key);
  return found == kNames.end() ? std::string_view() : found->name;
}

std::vector<std::uint8_t> encode(const ValSet& set) {
  if (set.items.size() > ValSet::kMaxItems) return {};
  std::vector<std::uint8_t> payload{0, set.layers, 0, 0};
  for (const ValSet::Item& item : set.items) {
    const std::size_t size = value_size(item.id);
    if (size == 0) return {};
    append(payload, item.id, 4);
    append(payload, item.value, size);
  }
  return encode(key::kCfgValSet, payload);
}

std::vector<std::uint8_t> encode(const Poll& poll) {
  return encode(poll.of, {});
}

}  // namespace roverd::ubx
