#include "sick/commands.hpp"

#include <algorithm>
#include <array>

namespace roverd::sick {
namespace {

constexpr std::string_view kSetScanConfig = "mLMPsetscancfg";

/// Words of mLMPsetscancfg's answer.
std::string_view config_refusal(int code) noexcept {
  constexpr std::array<std::string_view, 6> kWords{"",
                                                   "frequency error",
                                                   "resolution error",
                                                   "resolution and scan area error",
                                                   "scan area error",
                                                   "refused"};
  return code < static_cast<int>(kWords.size()) ? kWords[static_cast<std::size_t>(code)]
                                                : kWords.back();
}

}  // namespace

Request login(Dialect d) {
  return Writer(d, "sMN", "SetAccessMode").two_digits(3).u32(kClientPassword).framed();
}
Request read(Dialect d, std::string_view name) {
  return Writer(d, "sRN", name).framed();
}
Request call(Dialect d, std::string_view name) {
  return Writer(d, "sMN", name).framed();
}
Request set(Dialect d, const ScanConfig& c) {
  Writer out(d, "sMN", kSetScanConfig);
  out.decimal(c.frequency_chz, 4).decimal(c.sectors, 2).decimal(c.step_e4deg, 4);
  out.decimal(c.start_e4deg, 4).decimal(c.stop_e4deg, 4);
  return out.framed();
}
Request set(Dialect d, const OutputRange& range) {
  Writer out(d, "sWN", "LMPoutputRange");
  write(out, range);
  return out.framed();
}
Request set(Dialect d, const DataConfig& config) {
  Writer out(d, "sWN", "LMDscandatacfg");
  write(out, config);
  return out.framed();
}
Request subscribe(Dialect d, bool on) {
  return Writer(d, "sEN", "LMDscandata").u8(on ? 1 : 0).framed();
}

ScanConfig read_scan_config(Fields& in) {
  ScanConfig c;
  c.frequency_chz = in.u32("scan frequency");
  c.sectors = in.u16("number of sectors");
  c.step_e4deg = in.u32("resolution");
  c.start_e4deg = in.i32("start angle");
  c.stop_e4deg = in.i32("stop angle");
  return c;
}
OutputRange read_output_range(Fields& in) {
  OutputRange r;
  r.sectors = in.u16("number of sectors");
  r.step_e4deg = in.u32("resolution");
  r.start_e4deg = in.i32("start angle");
  r.stop_e4deg = in.i32("stop angle");
  return r;
}
DataConfig read_data_config(Fields& in) {
  const auto yes = [&in](const char* field) { return in.u8(field) != 0; };
  const auto pair = [&in](const char* field) {
    const unsigned high = in.u8(field);
    return static_cast<std::uint16_t>(high << 8U | in.u8(field));
  };
  DataConfig c;
  c.echoes = pair("channels");
  c.remission = yes("remission");
  c.remission_16_bit = yes("resolution of the remission");
  c.unit = in.u8("unit");
  c.encoders = pair("encoders");
  c.position = yes("position");
  c.name = yes("device name");
  c.comment = yes("comment");
  c.time = yes("time");
  c.every = in.u16("output interval");
  return c;
}

void write(Writer& out, const ScanConfig& c) {
  out.u32(c.frequency_chz).u16(c.sectors).u32(c.step_e4deg).i32(c.start_e4deg).i32(c.stop_e4deg);
}
void write(Writer& out, const OutputRange& r) {
  out.u16(r.sectors).u32(r.step_e4deg).i32(r.start_e4deg).i32(r.stop_e4deg);
}
void write(Writer& out, const DataConfig& c) {
  const auto pair = [&out](std::uint16_t value) {
    out.two_digits(static_cast<std::uint8_t>(value >> 8U));
    out.two_digits(static_cast<std::uint8_t>(value & 0xFFU));
  };
  pair(c.echoes);
  out.u8(c.remission ? 1 : 0).u8(c.remission_16_bit ? 1 : 0).u8(c.unit);
  pair(c.encoders);
  out.u8(c.position ? 1 : 0).u8(c.name ? 1 : 0).u8(c.comment ? 1 : 0).u8(c.time ? 1 : 0);
  out.decimal(c.every, 2);
}

std::string_view refusal_in(const Telegram& answer, const Words& words) noexcept {
  if (words.kind == "sFA") return error_words(error_code(answer));
  if (words.kind != "sAN") return {};
  Fields in(answer.dialect, answer.body, words.fields_at);
  const int code = in.u8("result");
  if (!in.ok()) return "refused";
  if (words.name == kSetScanConfig) return config_refusal(code);
  // These answer 1 for done, the others 0 for no error.
  const bool done =
      words.name == "SetAccessMode" || words.name == "Run" || words.name == "mEEwriteall"
          ? code == 1
          : code == 0;
  return done ? "" : "refused";
}

base::Result<int> state_in(const Telegram& answer, const Words& words) {
  Fields in(answer.dialect, answer.body, words.fields_at);
  // One byte or two in CoLa B, as the firmware has it: no state needs the second.
  int state = in.u8("state");
  if (answer.dialect == Dialect::B && state == 0 && in.ok() && in.holds("state", 1, 1)) {
    state = in.u8("state");
  }
  if (state > kMeasuring) in.refuse("state", "unknown");
  if (!in.ok()) return tl::unexpected<base::Error>(*in.error());
  return state;
}

std::string_view state_words(int state) noexcept {
  constexpr std::array<std::string_view, 8> kWords{
      "undefined", "initialising",   "configuration", "idle",
      "rotating",  "in preparation", "ready",         "ready for measurement"};
  return state >= 0 && state <= kMeasuring ? kWords[static_cast<std::size_t>(state)] : kWords[0];
}

std::string letters_in(const Telegram& answer, const Words& words) {
  constexpr std::size_t kMost = 64;
  std::string out;
  for (const std::uint8_t b : answer.body.subspan(words.fields_at)) {
    if (b >= 0x20 && b < 0x7F && out.size() < kMost) out += static_cast<char>(b);
  }
  const std::size_t begin = out.find_first_not_of(' ');
  if (begin == std::string::npos) return {};
  return out.substr(begin, out.find_last_not_of(' ') + 1 - begin);
}

}  // namespace roverd::sick
