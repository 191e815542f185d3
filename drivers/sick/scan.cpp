#include "sick/scan.hpp"

#include <algorithm>
#include <cmath>

namespace roverd::sick {
namespace {

constexpr std::size_t kChannelName = 5;
constexpr std::size_t kShortestChannel = 20;  // bytes, without values, in CoLa B
constexpr double kMaxScale = 1000.0;
constexpr double kMaxOffset = 1e6;

void read_header(Fields& in, Scan& s) {
  s.version = in.u16("version");
  s.device = in.u16("device number");
  s.serial = in.u32("serial number");
  for (auto& b : s.status) b = in.u8("device status");
  s.telegram_count = in.u16("telegram counter");
  s.scan_count = in.u16("scan counter");
  s.start_us = in.u32("time since start");
  s.sent_us = in.u32("time of transmission");
  for (auto& b : s.inputs) b = in.u8("digital inputs");
  for (auto& b : s.outputs) b = in.u8("digital outputs");
  s.layer = in.u16("layer angle");
  s.scan_frequency_chz = in.u32("scan frequency");
  s.measuring_hhz = in.u32("measurement frequency");
}

void read_encoders(Fields& in, Scan& s) {
  const std::size_t n = in.u16("number of encoders");
  if (!in.holds("number of encoders", n, 6)) return;
  for (std::size_t i = 0; i < n && in.ok(); ++i) {
    const std::int32_t position = in.i32("encoder position");
    s.encoders.push_back({position, in.u16("encoder speed")});
  }
}

Channel read_channel(Fields& in, int bits) {
  Channel c;
  c.bits = bits;
  c.name = in.word("channel name", kChannelName);
  c.scale = in.f32("scale");
  if (in.ok() && !(c.scale > 0.0F && c.scale <= kMaxScale)) in.refuse("scale", "no useful number");
  c.offset = in.f32("offset");
  if (in.ok() && !(std::abs(c.offset) <= kMaxOffset)) in.refuse("offset", "no useful number");
  c.start_e4deg = in.i32("start angle");
  c.step_e4deg = in.u16("step");
  const std::size_t n = in.u16("number of values");
  if (!in.holds("number of values", n, bits == 16 ? 2 : 1)) return c;
  c.values.resize(n);
  for (auto& value : c.values) {
    value = bits == 16 ? in.u16("value") : std::uint16_t{in.u8("value")};
  }
  return c;
}

void read_channels(Fields& in, Scan& s, int bits) {
  const char* const field = bits == 16 ? "number of 16-bit channels" : "number of 8-bit channels";
  const std::size_t n = in.u16(field);
  if (!in.holds(field, n, kShortestChannel)) return;
  for (std::size_t i = 0; i < n && in.ok(); ++i) s.channels.push_back(read_channel(in, bits));
}

/// One of the flags of the tail.
bool flag(Fields& in, const char* field) {
  const std::uint16_t value = in.u16(field);
  if (value > 1) in.refuse(field, "neither 0 nor 1");
  return value == 1;
}

void read_tail(Fields& in, Scan& s) {
  if (flag(in, "position flag")) {
    Position& p = s.position.emplace();
    for (auto& value : p.xyz_turns) value = in.f32("position");
    p.rotation = in.u8("rotation type");
  }
  if (flag(in, "name flag")) {
    const std::size_t length = in.u8("name length");
    s.name = in.text("name", length);
  }
  if (flag(in, "comment flag")) {
    const std::size_t length = in.u8("comment length");
    s.comment = in.text("comment", length);
  }
  if (flag(in, "time flag")) {
    DeviceTime& t = s.time.emplace();
    t.year = in.u16("year");
    t.month = in.u8("month");
    t.day = in.u8("day");
    t.hour = in.u8("hour");
    t.minute = in.u8("minute");
    t.second = in.u8("second");
    t.microsecond = in.u32("microsecond");
  }
  s.event = in.u16("event flag");
  if (s.event == 0) in.ends();
}

void write_channels(Writer& out, const Scan& s, int bits) {
  const auto here = [bits](const Channel& c) { return c.bits == bits; };
  out.u16(static_cast<std::uint16_t>(std::count_if(s.channels.begin(), s.channels.end(), here)));
  for (const Channel& c : s.channels) {
    if (c.bits != bits) continue;
    out.word(c.name, kChannelName).f32(c.scale).f32(c.offset).i32(c.start_e4deg).u16(c.step_e4deg);
    out.u16(static_cast<std::uint16_t>(c.values.size()));
    for (const std::uint16_t value : c.values) {
      bits == 16 ? out.u16(value) : out.u8(static_cast<std::uint8_t>(value));
    }
  }
}

void write_text(Writer& out, const std::optional<std::string>& text) {
  out.u16(text ? 1 : 0);
  if (text) out.text(*text);
}

void write_tail(Writer& out, const Scan& s) {
  out.u16(s.position ? 1 : 0);
  if (s.position) {
    for (const float value : s.position->xyz_turns) out.f32(value);
    out.u8(s.position->rotation);
  }
  write_text(out, s.name);
  write_text(out, s.comment);
  out.u16(s.time ? 1 : 0);
  if (s.time) {
    const DeviceTime& t = *s.time;
    out.u16(t.year).u8(t.month).u8(t.day).u8(t.hour).u8(t.minute).u8(t.second);
    out.u32(t.microsecond);
  }
  out.u16(s.event);
}

}  // namespace

Status status_of(const Scan& scan) noexcept {
  const unsigned bits = scan.status[1];
  Status out;
  out.good = scan.status[0] == 0 && (bits & 1U) == 0;
  out.blocked = (bits & 4U) != 0;
  out.dirty = (bits & 2U) != 0;
  out.words = out.blocked           ? "pollution error"
              : (bits & 1U) != 0    ? "faulty"
              : scan.status[0] != 0 ? "starting"
              : out.dirty           ? "pollution warning"
                                    : "ok";
  return out;
}

bool is_scan(const Words& words) noexcept {
  return words.name == kScanData && (words.kind == "sSN" || words.kind == "sRA");
}

base::Result<Scan> decode_scan(const Telegram& telegram) {
  const auto words = words_of(telegram);
  if (!words || !is_scan(*words)) return base::fail(base::Code::Malformed, "no scan telegram");
  Scan s;
  s.polled = words->kind == "sRA";
  Fields in(telegram.dialect, telegram.body, words->fields_at);
  read_header(in, s);
  read_encoders(in, s);
  read_channels(in, s, 16);
  read_channels(in, s, 8);
  read_tail(in, s);
  if (!in.ok()) return tl::unexpected<base::Error>(*in.error());
  return s;
}

std::vector<std::uint8_t> encode(const Scan& s, Dialect dialect) {
  Writer out(dialect, s.polled ? "sRA" : "sSN", kScanData);
  out.u16(s.version).u16(s.device).u32(s.serial);
  for (const auto b : s.status) out.u8(b);
  out.u16(s.telegram_count).u16(s.scan_count).u32(s.start_us).u32(s.sent_us);
  for (const auto b : s.inputs) out.u8(b);
  for (const auto b : s.outputs) out.u8(b);
  out.u16(s.layer).u32(s.scan_frequency_chz).u32(s.measuring_hhz);
  out.u16(static_cast<std::uint16_t>(s.encoders.size()));
  for (const Encoder& e : s.encoders) out.i32(e.position).u16(e.speed);
  write_channels(out, s, 16);
  write_channels(out, s, 8);
  write_tail(out, s);
  return out.framed();
}

}  // namespace roverd::sick
