// What SICK scanners and their programs say to each other, to named values. Two forms of file, told
// apart by their beginning: the bytes of either dialect, or a session as text,
//
//   1.626867 < 02020202…      one TCP payload, hexadecimal, from the scanner (> to it)
//   1.626867 sSN LMDscandata  one telegram of CoLa A without its frame

#include <array>
#include <charconv>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sick/commands.hpp"
#include "sick/scan.hpp"
#include "tools/decode.hpp"

namespace roverd {
namespace {

using Json = nlohmann::ordered_json;

/// A payload of 64 kB in hexadecimal, and its time.
constexpr std::size_t kLongestSessionLine = 2 * sick::kMaxBody + 256;
/// Within so many bytes a session's first line shows that it is one.
constexpr std::size_t kLongestTime = 32;

Json channel_object(const sick::Channel& c) {
  return {{"name", c.name},
          {"bits", c.bits},
          {"scale", c.scale},
          {"offset", c.offset},
          {"start_angle_deg", c.start_e4deg / 1e4},
          {"step_deg", c.step_e4deg / 1e4},
          {"count", c.values.size()},
          {"values", c.values}};
}

void describe_tail(Json& out, const sick::Scan& s) {
  out["position"] = nullptr;
  if (s.position) {
    constexpr std::array kNames{"x", "y", "z", "rx", "ry", "rz"};
    Json position;
    for (std::size_t i = 0; i < kNames.size(); ++i) position[kNames[i]] = s.position->xyz_turns[i];
    position["rotation_type"] = s.position->rotation;
    out["position"] = std::move(position);
  }
  out["name"] = s.name ? Json(*s.name) : Json(nullptr);
  out["comment"] = s.comment ? Json(*s.comment) : Json(nullptr);
  out["time_stamp"] = nullptr;
  if (s.time) {
    out["time_stamp"] = {{"year", s.time->year},
                         {"month", s.time->month},
                         {"day", s.time->day},
                         {"hour", s.time->hour},
                         {"minute", s.time->minute},
                         {"second", s.time->second},
                         {"microsecond", s.time->microsecond}};
  }
  out["event_flag"] = s.event;
}

void describe_scan(Json& out, const sick::Scan& s) {
  out["version"] = s.version;
  out["device_number"] = s.device;
  out["serial_number"] = s.serial;
  out["device_status"] = s.status;
  out["status"] = sick::status_of(s).words;
  out["telegram_counter"] = s.telegram_count;
  out["scan_counter"] = s.scan_count;
  out["time_since_start_us"] = s.start_us;
  out["time_of_transmission_us"] = s.sent_us;
  out["digital_inputs"] = s.inputs;
  out["digital_outputs"] = s.outputs;
  out["layer_angle"] = s.layer;
  out["scan_frequency_hz"] = s.scan_frequency_chz / 100.0;
  out["measurement_frequency_hz"] = s.measuring_hhz * 100.0;
  out["encoders"] = Json::array();
  for (const sick::Encoder& e : s.encoders) {
    out["encoders"].push_back({{"position", e.position}, {"speed", e.speed}});
  }
  out["channels"] = Json::array();
  for (const sick::Channel& c : s.channels) out["channels"].push_back(channel_object(c));
  describe_tail(out, s);
}

/// @return false: it has other fields than these.
bool describe_ranges(Json& out, const sick::Telegram& t, const sick::Words& words) {
  sick::Fields in(t.dialect, t.body, words.fields_at);
  const auto angles = [&out](std::uint16_t sectors, double step_deg, double from, double to) {
    out["sectors"] = sectors;
    out["resolution_deg"] = step_deg;
    out["start_angle_deg"] = from;
    out["stop_angle_deg"] = to;
  };
  if (words.name == "LMPoutputRange") {
    const auto r = sick::read_output_range(in);
    if (!in.ends()) return false;
    angles(r.sectors, r.step_e4deg / 1e4, r.start_e4deg / 1e4, r.stop_e4deg / 1e4);
    return true;
  }
  const bool answer = words.kind == "sAN";
  if (words.name != "LMPscancfg" && words.name != "mLMPsetscancfg") return false;
  const int error = answer ? in.u8("error") : 0;
  const auto c = sick::read_scan_config(in);
  if (!in.ends()) return false;
  if (answer) out["error"] = error;
  out["scan_frequency_hz"] = c.frequency_chz / 100.0;
  angles(c.sectors, c.step_e4deg / 1e4, c.start_e4deg / 1e4, c.stop_e4deg / 1e4);
  return true;
}

bool describe_content(Json& out, const sick::Telegram& t, const sick::Words& words) {
  if (words.name != "LMDscandatacfg") return false;
  sick::Fields in(t.dialect, t.body, words.fields_at);
  const auto c = sick::read_data_config(in);
  if (!in.ends()) return false;
  out["channels"] = {c.echoes >> 8U, c.echoes & 0xFFU};
  out["remission"] = c.remission;
  out["remission_bits"] = c.remission_16_bit ? 16 : 8;
  out["unit"] = c.unit;
  out["encoders"] = {c.encoders >> 8U, c.encoders & 0xFFU};
  out["position"] = c.position;
  out["name"] = c.name;
  out["comment"] = c.comment;
  out["time"] = c.time;
  out["every"] = c.every;
  return true;
}

/// What no other function knows: text as text, binary in hexadecimal.
void describe_rest(Json& out, const sick::Telegram& t, const sick::Words& words) {
  const base::Bytes rest = t.body.subspan(words.fields_at);
  std::string text;
  for (const std::uint8_t b : rest) {
    if (t.dialect == sick::Dialect::A) {
      text += static_cast<char>(b);
      continue;
    }
    std::array<char, 3> hex{};
    std::snprintf(hex.data(), hex.size(), "%02x", b);
    text += hex.data();
  }
  out["fields"] = text;
}

Json& describe_telegram(Json& out, const sick::Telegram& t) {
  out["dialect"] = t.dialect == sick::Dialect::A ? "A" : "B";
  const auto words = sick::words_of(t);
  if (!words) {
    out["bytes"] = t.body.size();
    out["refused"] = "a telegram without words";
    return out;
  }
  out["type"] = words->kind;
  if (words->kind == "sFA") {
    out["code"] = sick::error_code(t);
    out["error"] = sick::error_words(sick::error_code(t));
    return out;
  }
  out["command"] = words->name;
  if (sick::is_scan(*words)) {
    if (const auto scan = sick::decode_scan(t)) {
      describe_scan(out, *scan);
    } else {
      out["bytes"] = t.body.size();
      out["refused"] = scan.error().detail;
    }
    return out;
  }
  if (words->fields_at >= t.body.size()) return out;
  if (describe_ranges(out, t, *words) || describe_content(out, t, *words)) return out;
  describe_rest(out, t, *words);
  if (words->name == "STlms" && words->kind == "sRA") {
    if (const auto state = sick::state_in(t, *words)) out["state"] = sick::state_words(*state);
  }
  return out;
}

/// Telegrams of one direction, and what lies between them.
class SickStream {
 public:
  /// @param begin of each object.
  void feed(base::Bytes bytes, const Json& begin, const OnObject& on_object) {
    framer_.feed(bytes, [&](const sick::Telegram& t) { take(t, begin, on_object); });
    if (!framer_.waiting()) tell_skipped(begin, on_object);
  }
  void finish(const Json& begin, const OnObject& on_object) {
    framer_.give_up([&](const sick::Telegram& t) { take(t, begin, on_object); });
    tell_skipped(begin, on_object);
  }

 private:
  void take(const sick::Telegram& t, const Json& begin, const OnObject& on_object) {
    tell_skipped(begin, on_object);
    Json out = begin;
    on_object(describe_telegram(out, t));
  }
  void tell_skipped(const Json& begin, const OnObject& on_object) {
    const auto& now = framer_.counts();
    if (now.skipped_bytes == told_.skipped_bytes) return;
    Json out = begin;
    out["skipped_bytes"] = now.skipped_bytes - told_.skipped_bytes;
    out["refused"] = now.bad_checksum != told_.bad_checksum ? "a telegram with a wrong checksum"
                     : now.bad_length != told_.bad_length   ? "a telegram of an impossible length"
                     : now.cut != told_.cut                 ? "a telegram that was cut"
                                                            : "outside any telegram";
    told_ = now;
    on_object(out);
  }

  sick::Framer framer_;
  sick::Framer::Counts told_;
};

int hex_digit(char c) noexcept {
  if (c >= '0' && c <= '9') return c - '0';
  const char low = static_cast<char>(c | 0x20);
  return low >= 'a' && low <= 'f' ? low - 'a' + 10 : -1;
}

/// The lines of a session.
class SickSession {
 public:
  explicit SickSession(OnObject on_object) : on_object_(std::move(on_object)) {}

  void feed(base::Bytes bytes) {
    for (const std::uint8_t b : bytes) {
      if (b == '\n') {
        end_line();
      } else if (line_.size() < kLongestSessionLine) {
        line_ += static_cast<char>(b);
      } else {
        too_long_ = true;
      }
    }
  }
  void finish() {
    if (!line_.empty()) end_line();
    const Json begin = Json::object();
    to_scanner_.finish(begin, on_object_);
    from_scanner_.finish(begin, on_object_);
  }

 private:
  void end_line() {
    ++number_;
    if (!line_.empty() && line_.back() == '\r') line_.pop_back();
    if (!line_.empty()) take(line_);
    line_.clear();
    too_long_ = false;
  }

  void take(std::string_view line) {
    Json out{{"line", number_}};
    const auto refuse = [&](const char* why) {
      out["refused"] = why;
      on_object_(out);
    };
    if (too_long_) return refuse("the line is too long");
    double time_s = 0.0;
    const auto [end, problem] =
        std::from_chars(line.data(), line.data() + line.size(), time_s, std::chars_format::fixed);
    line.remove_prefix(static_cast<std::size_t>(end - line.data()));
    if (problem != std::errc{} || line.size() < 2 || line[0] != ' ') {
      return refuse("no time and telegram");
    }
    out["time"] = time_s;
    line.remove_prefix(1);
    if (line.size() < 2 || (line[0] != '<' && line[0] != '>') || line[1] != ' ') {
      const base::Bytes body(reinterpret_cast<const std::uint8_t*>(line.data()), line.size());
      return on_object_(describe_telegram(out, {sick::Dialect::A, body}));
    }
    const bool from = line[0] == '<';
    out["direction"] = from ? "from the scanner" : "to the scanner";
    line.remove_prefix(2);
    std::vector<std::uint8_t> bytes;
    for (std::size_t i = 0; i + 1 < line.size(); i += 2) {
      const int high = hex_digit(line[i]);
      const int low = hex_digit(line[i + 1]);
      if (high < 0 || low < 0) return refuse("no hexadecimal digits");
      bytes.push_back(static_cast<std::uint8_t>(high << 4 | low));
    }
    if (line.size() % 2 != 0) return refuse("half a byte at the end");
    (from ? from_scanner_ : to_scanner_).feed(bytes, out, on_object_);
  }

  const OnObject on_object_;
  std::string line_;
  bool too_long_ = false;
  std::uint64_t number_ = 0;
  SickStream to_scanner_;
  SickStream from_scanner_;
};

/// Empty: it takes more to tell.
std::optional<bool> looks_like_session(std::string_view begin) noexcept {
  const std::size_t time = begin.find_first_not_of("0123456789.");
  if (time == 0 || (time == std::string_view::npos && begin.size() > kLongestTime)) return false;
  if (time == std::string_view::npos || begin.size() < time + 3) return {};
  const std::string_view rest = begin.substr(time, 3);
  return rest == " > " || rest == " < " || rest.starts_with(" s");
}

/// Finds out which form it is, and hands over.
class SickFile {
 public:
  explicit SickFile(OnObject on_object) : on_object_(on_object), session_(std::move(on_object)) {}

  void feed(base::Bytes bytes) {
    if (is_session_) return give(bytes);
    begin_.insert(begin_.end(), bytes.begin(), bytes.end());
    is_session_ = looks_like_session(std::string(begin_.begin(), begin_.end()));
    if (is_session_) give(std::exchange(begin_, {}));
  }
  void finish() {
    if (!is_session_) {
      is_session_ = false;
      give(begin_);
    }
    if (*is_session_) return session_.finish();
    stream_.finish(Json::object(), on_object_);
  }

 private:
  void give(base::Bytes bytes) {
    if (*is_session_) return session_.feed(bytes);
    stream_.feed(bytes, Json::object(), on_object_);
  }

  const OnObject on_object_;
  std::vector<std::uint8_t> begin_;
  std::optional<bool> is_session_;
  SickSession session_;
  SickStream stream_;
};

}  // namespace

Reader sick_reader(OnObject on_object) {
  const auto file = std::make_shared<SickFile>(std::move(on_object));
  return {.feed = [file](base::Bytes part) { file->feed(part); },
          .finish = [file] { file->finish(); }};
}

}  // namespace roverd
