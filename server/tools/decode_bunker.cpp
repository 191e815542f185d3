// CAN frames of a Bunker, from candump's text to named values.

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>

#include "bunker/codec.hpp"
#include "bunker/plausible.hpp"
#include "bunker/v1.hpp"
#include "link/candump.hpp"
#include "tools/decode.hpp"

namespace roverd {
namespace {

using base::CanFrame;
using Json = nlohmann::ordered_json;

/// No line of candump is longer; a longer one is refused without keeping it.
constexpr std::size_t kLongestLine = 4096;
/// Faster than this no Bunker reports itself (as in the driver).
constexpr double kMaxSpeed_mps = 4.0;

std::string id_text(const CanFrame& f) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), f.extended || f.error ? "0x%08X" : "0x%03X",
                static_cast<unsigned>(f.id));
  return text.data();
}

/// The double nearest to what was written: base::seconds may be off by its last digit.
double exact_seconds(base::Duration d) {
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(d);
  return static_cast<double>(whole.count()) + static_cast<double>((d - whole).count()) / 1e9;
}

std::string hex(base::Bytes bytes) {
  std::string out;
  std::array<char, 4> two{};
  for (const std::uint8_t byte : bytes) {
    std::snprintf(two.data(), two.size(), "%02X", byte);
    out += (out.empty() ? "" : " ") + std::string(two.data());
  }
  return out;
}

std::string mode_word(std::uint8_t raw) {
  constexpr std::array kWords{"standby", "can", "uart"};
  return raw < kWords.size() ? kWords[raw] : "unknown";
}

Json words(std::uint16_t code, const bunker::ErrorTable& table) {
  Json out = Json::array();
  for (const bunker::ErrorBit& bit : bunker::error_bits(code, table)) out.push_back(bit.word);
  return out;
}

/// Writes one message's name and fields.
struct Describe {
  Json& out;

  void operator()(std::monostate) const {}

  void motion(const char* name, const bunker::Motion& m) const {
    out["name"] = name;
    out["linear_mps"] = m.linear_mps;
    out["angular_radps"] = m.angular_radps;
    out["lateral_mps"] = m.lateral_mps;
    out["steering_rad"] = m.steering_rad;
  }
  void operator()(const bunker::MotionCommand& m) const { motion("motion_command", m); }
  void operator()(const bunker::MotionState& m) const { motion("motion_state", m); }

  void operator()(const bunker::ControlModeCommand& m) const {
    out["name"] = "control_mode_command";
    out["control_mode"] = mode_word(static_cast<std::uint8_t>(m.mode));
    out["control_mode_raw"] = static_cast<int>(m.mode);
  }
  void operator()(const bunker::ClearErrors& m) const {
    out["name"] = "clear_errors";
    out["motor"] = m.which;
  }

  void light(const char* name, const bunker::Light& m) const {
    out["name"] = name;
    out["enabled"] = m.enabled;
    out["front_mode"] = static_cast<int>(m.front_mode);
    out["front_value"] = m.front_value;
    out["rear_mode"] = static_cast<int>(m.rear_mode);
    out["rear_value"] = m.rear_value;
    out["count"] = m.count;
  }
  void operator()(const bunker::LightCommand& m) const { light("light_command", m); }
  void operator()(const bunker::LightState& m) const { light("light_state", m); }
  void operator()(const bunker::v1::LightCommand& m) const { light("light_command", m); }
  void operator()(const bunker::v1::LightState& m) const { light("light_state", m); }

  template <class State>
  void system(const State& m, const bunker::ErrorTable& table) const {
    out["name"] = "system_state";
    out["vehicle_state"] = to_string(m.vehicle_state());
    out["vehicle_state_raw"] = m.vehicle_state_raw;
    out["control_mode"] = to_string(m.control_mode());
    out["control_mode_raw"] = m.control_mode_raw;
    out["battery_v"] = m.battery_v;
    out["error_code"] = m.error_code;
    out["errors"] = words(m.error_code, table);
    out["count"] = m.count;
  }
  void operator()(const bunker::SystemState& m) const { system(m, bunker::kErrorBits); }
  void operator()(const bunker::v1::SystemState& m) const { system(m, bunker::v1::kErrorBits); }

  void operator()(const bunker::RadioFrame& m) const {
    out["name"] = "rc_state";
    out["swa"] = to_string(m.swa());
    out["swb"] = to_string(m.swb());
    out["swc"] = to_string(m.swc());
    out["swd"] = to_string(m.swd());
    out["right_lr"] = m.right_lr;
    out["right_ud"] = m.right_ud;
    // Which of the two is up and down depends on the firmware.
    out["byte3"] = m.left_ud;
    out["byte4"] = m.left_lr;
    out["vra"] = m.vra;
    out["count"] = m.count;
  }
  void operator()(const bunker::ActuatorFast& m) const {
    out["name"] = "actuator_fast_state";
    out["motor"] = m.motor;
    out["rpm"] = m.rpm;
    out["current_a"] = m.current_a;
    out["pulses"] = m.pulses;
  }
  void operator()(const bunker::ActuatorSlow& m) const {
    out["name"] = "actuator_slow_state";
    out["motor"] = m.motor;
    out["driver_voltage_v"] = m.driver_voltage_v;
    out["driver_temp_c"] = m.driver_temp_c;
    out["motor_temp_c"] = m.motor_temp_c;
    out["driver_state"] = m.driver_state;
    Json& flags = out["driver_flags"] = Json::array();
    for (std::size_t i = 0; i < bunker::kDriverFlags.size(); ++i) {
      if ((static_cast<unsigned>(m.driver_state) >> i & 1U) != 0) {
        flags.push_back(bunker::kDriverFlags[i]);
      }
    }
  }
  void operator()(const bunker::Odometer& m) const {
    out["name"] = "odometer";
    out["left_mm"] = m.left_mm;
    out["right_mm"] = m.right_mm;
  }
  void operator()(const bunker::Battery& m) const {
    out["name"] = "battery";
    out["soc_pct"] = m.soc_pct;
    out["soh_pct"] = m.soh_pct;
    out["voltage_v"] = m.voltage_v;
    out["current_a"] = m.current_a;
    out["temperature_c"] = m.temperature_c;
  }
  void operator()(const bunker::BatteryAlarms& m) const {
    out["name"] = "battery_alarms";
    out["alarm1"] = m.alarm1;
    out["alarm2"] = m.alarm2;
    out["warn1"] = m.warn1;
    out["warn2"] = m.warn2;
  }
  void operator()(const bunker::Version& m) const {
    out["name"] = "version";
    out["numbers"] = m.number;
  }
  void operator()(const bunker::VersionText& m) const {
    out["name"] = "version_text";
    std::string text;
    for (const char c : m.text) {
      if (c >= ' ' && c <= '~') text += c;
    }
    out["text"] = text;
  }

  void operator()(const bunker::v1::Command& m) const {
    out["name"] = "command";
    out["control_mode"] = m.mode == bunker::v1::RequestedMode::Radio
                              ? "rc"
                              : mode_word(static_cast<std::uint8_t>(m.mode));
    out["control_mode_raw"] = static_cast<int>(m.mode);
    out["error_clear"] = m.clear;
    out["linear_pct"] = m.linear_pct;
    out["angular_pct"] = m.angular_pct;
    out["lateral_pct"] = m.lateral_pct;
    out["count"] = m.count;
  }
  void operator()(const bunker::v1::MotionState& m) const {
    out["name"] = "motion_state";
    out["linear_mps"] = m.linear_mps;
    out["angular_radps"] = m.angular_radps;
    out["count"] = m.count;
  }
  void operator()(const bunker::v1::Motor& m) const {
    out["name"] = "motor_state";
    out["motor"] = m.motor;
    out["current_a"] = m.current_a;
    out["rpm"] = m.rpm;
    out["driver_temp_c"] = m.driver_temp_c;
    out["motor_temp_c"] = m.motor_temp_c;
    out["count"] = m.count;
  }
};

std::string refusal(bunker::Verdict verdict, const CanFrame& f) {
  if (f.error) return "error frame";
  if (f.remote) return "remote frame";
  if (f.extended) return "extended id";
  switch (verdict) {
    case bunker::Verdict::Decoded:
      return {};
    case bunker::Verdict::Foreign:
      return "unknown id " + id_text(f);
    case bunker::Verdict::TooShort:
      return id_text(f) + " too short";
    case bunker::Verdict::BadValue:
      return id_text(f) + " with an unlisted code";
    case bunker::Verdict::BadChecksum:
      return id_text(f) + " with a wrong checksum";
  }
  return "?";
}

class BunkerText {
 public:
  explicit BunkerText(OnObject on_object) : on_object_(std::move(on_object)) {}

  void feed(base::Bytes bytes) {
    std::string_view rest(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    while (!rest.empty()) {
      const auto end = rest.find('\n');
      keep(rest.substr(0, end));
      if (end == std::string_view::npos) return;
      take_line();
      rest.remove_prefix(end + 1);
    }
  }

  void finish() {
    if (!text_.empty() || cut_) take_line();
  }

 private:
  void keep(std::string_view part) {
    const auto room = kLongestLine - text_.size();
    cut_ = cut_ || part.size() > room;
    text_ += part.substr(0, room);
  }

  void take_line() {
    ++line_;
    Json out;
    out["line"] = line_;
    if (cut_) {
      out["refused"] = "the line is too long for a frame";
      on_object_(out);
    } else if (const auto record = link::parse_candump_line(text_); !record) {
      out["text"] = text_;
      out["refused"] = record.error().detail;
      on_object_(out);
    } else if (*record) {
      describe(**record, out);
      on_object_(out);
    }
    text_.clear();
    cut_ = false;
  }

  void describe(const link::CanRecord& record, Json& out) {
    const CanFrame& f = record.frame;
    out["time"] = record.stamp ? Json(exact_seconds(*record.stamp)) : Json(nullptr);
    out["interface"] = record.bus;
    if (record.sent) out["sent"] = true;
    out["id"] = id_text(f);
    out["data"] = hex(f.remote ? base::Bytes{} : f.bytes());
    if (f.id == bunker::id::kSystemState && v1_seen_ && !v2_seen_) {
      out["refused"] = "in protocol V1 0x211 is the answer to a setting";
    } else if (bunker::v1::is_known(f.id)) {
      say("V1", bunker::v1::decode(f), f, out);
    } else {
      say("V2", bunker::decode(f), f, out);
    }
  }

  template <class Decoded>
  void say(const char* protocol, const Decoded& decoded, const CanFrame& f, Json& out) {
    if (auto reason = refusal(decoded.verdict, f); !reason.empty()) {
      out["refused"] = std::move(reason);
      return;
    }
    v1_seen_ = v1_seen_ || f.id == bunker::v1::id::kSystemState;
    v2_seen_ = v2_seen_ || f.id == bunker::id::kMotionState || f.id == bunker::id::kRadioState;
    out["protocol"] = protocol;
    std::visit(Describe{out}, decoded.message);
    if (const auto bad = bunker::impossible(decoded.message, kMaxSpeed_mps)) {
      std::array<char, 32> value{};
      std::snprintf(value.data(), value.size(), " %.10g", bad->value);
      out["refused"] =
          "impossible value: " + std::string(bad->what) + value.data() + std::string(bad->unit);
    }
  }

  const OnObject on_object_;
  std::string text_;
  bool cut_ = false;
  std::uint64_t line_ = 0;
  bool v1_seen_ = false;
  bool v2_seen_ = false;
};

}  // namespace

Reader bunker_reader(OnObject on_object) {
  const auto text = std::make_shared<BunkerText>(std::move(on_object));
  return {.feed = [text](base::Bytes bytes) { text->feed(bytes); },
          .finish = [text] { text->finish(); }};
}

}  // namespace roverd
