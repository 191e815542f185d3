// Messages of an Xsens MTi to named values.

#include <array>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>

#include "mti/data2.hpp"
#include "tools/decode.hpp"

namespace roverd {
namespace {

using Json = nlohmann::ordered_json;

std::string mti_hex(std::uint32_t value, int digits) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%0*X", digits, static_cast<unsigned>(value));
  return text.data();
}

/// Names of a kind's numbers; empty: an array, "value" where there is one.
std::vector<std::string> names_of(mti::Kind kind, mti::Axes axes) {
  using enum mti::Kind;
  switch (kind) {
    case Quaternion:
    case DeltaQ:
      return {"q0", "q1", "q2", "q3"};
    case Euler:
      return {"roll", "pitch", "yaw"};
    case LatLon:
      return {"lat", "lon"};
    case Velocity:
      if (axes == mti::Axes::Ned) return {"north", "east", "down"};
      if (axes == mti::Axes::Enu) return {"east", "north", "up"};
      return {"north", "west", "up"};
    case RotationMatrix:
    case Temperature:
    case AltitudeEllipsoid:
      return {};
    default:
      return {"x", "y", "z"};
  }
}

struct DescribePacket {
  Json& out;
  const mti::Packet& packet;

  void operator()(std::monostate) const {}
  void operator()(const mti::Numbers& n) const {
    out["axes"] = to_string(packet.axes());
    out["format"] = to_string(packet.format());
    const auto names = names_of(packet.kind(), packet.axes());
    if (names.size() == n.size) {
      for (std::size_t i = 0; i < n.size; ++i) out[names[i]] = n[i];
    } else if (n.size == 1) {
      out["value"] = n[0];
    } else {
      out["values"] = std::vector<double>(n.value.begin(), n.value.begin() + n.size);
    }
  }
  void operator()(std::uint32_t value) const { out["value"] = value; }
  void operator()(const mti::Utc& u) const {
    utc(u);
    out["ns"] = u.nanosecond;
    out["flags"] = u.flags;
  }
  void operator()(const mti::GnssPvt& m) const {
    out["iTOW"] = m.itow_ms;
    utc(m.utc);
    out["tAcc"] = m.time_sigma_ns;
    out["nano"] = m.nano;
    out["fix_type"] = m.fix_type;
    out["fix_ok"] = m.fix_ok();
    out["differential"] = m.differential();
    out["usable"] = m.usable();
    out["satellites"] = m.satellites;
    out["lon"] = m.usable() ? Json(m.at.lon) : Json(nullptr);
    out["lat"] = m.usable() ? Json(m.at.lat) : Json(nullptr);
    out["height"] = m.height_ellipsoid_m;
    out["height_msl"] = m.height_msl_m;
    out["hAcc"] = m.horizontal_sigma_m;
    out["vAcc"] = m.vertical_sigma_m;
    out["velN"] = m.north_mps;
    out["velE"] = m.east_mps;
    out["velD"] = m.down_mps;
    out["ground_speed"] = m.ground_speed_mps;
    out["course"] = m.course_deg;
    out["sAcc"] = m.speed_sigma_mps;
    out["course_accuracy"] = m.course_sigma_deg;
    out["heading_of_vehicle"] = m.vehicle_heading_deg;
    constexpr std::array kDops{"gDOP", "pDOP", "tDOP", "vDOP", "hDOP", "nDOP", "eDOP"};
    for (std::size_t i = 0; i < kDops.size(); ++i) out[kDops[i]] = m.dop[i];
  }
  void operator()(const mti::Satellites& s) const {
    out["iTOW"] = s.itow_ms;
    out["satellites"] = Json::array();
    for (const mti::Satellite& one : s.all) {
      out["satellites"].push_back({{"constellation", one.constellation},
                                   {"id", one.id},
                                   {"cn0", one.cn0_dbhz},
                                   {"flags", one.flags}});
    }
  }
  void operator()(const mti::Status& s) const {
    out["value"] = s.word;
    out["self_test_ok"] = s.self_test_ok();
    out["orientation_valid"] = s.orientation_valid();
    out["gnss_fix"] = s.gnss_fix();
    if (packet.kind() != mti::Kind::StatusWord) return;
    out["clipping"] = s.clipping();
    out["filter_mode"] = s.filter_mode();
  }

 private:
  void utc(const mti::Utc& u) const {
    out["year"] = u.year;
    out["month"] = u.month;
    out["day"] = u.day;
    out["hour"] = u.hour;
    out["minute"] = u.minute;
    out["second"] = u.second;
    out["date_valid"] = u.date_valid();
    out["time_valid"] = u.time_valid();
    out["fully_resolved"] = u.resolved();
  }
};

Json packet_object(const mti::Packet& packet) {
  const auto name = mti::name_of(packet.kind());
  Json out;
  out["xdi"] = mti_hex(packet.xdi, 4);
  out["content"] = name.empty() ? Json(nullptr) : Json(name);
  if (packet.fault == mti::Fault::None) {
    std::visit(DescribePacket{out, packet}, packet.value);
  } else {
    out["bytes"] = packet.bytes.size();
    out["refused"] = to_string(packet.fault);
  }
  return out;
}

std::string product_text(base::Bytes payload) {
  std::string text(payload.begin(), payload.end());
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

void describe_short(Json& out, const mti::Message& m) {
  const base::Bytes p = m.payload;
  if (m.mid == mti::mid::kDeviceId && p.size() == 4) {
    std::uint32_t id = 0;
    for (const std::uint8_t byte : p) id = id << 8U | byte;
    out["device_id"] = mti_hex(id, 8);
  } else if (m.mid == mti::mid::kFirmware && p.size() >= 3) {
    out["firmware"] =
        std::to_string(p[0]) + "." + std::to_string(p[1]) + "." + std::to_string(p[2]);
  } else if (m.mid == mti::mid::kProductCode) {
    out["product"] = product_text(p);
  } else if (m.mid == mti::mid::kError && !p.empty()) {
    out["code"] = p[0];
    out["error"] = mti::error_words(p[0]);
  } else if (m.mid == mti::mid::kSetOutput || m.mid == mti::mid::kSetOutputAck) {
    out["outputs"] = Json::array();
    for (const mti::Output& o : mti::outputs_of(p)) {
      out["outputs"].push_back({{"xdi", mti_hex(o.xdi, 4)}, {"rate", o.rate_hz}});
    }
  } else if (!p.empty()) {
    out["bytes"] = p.size();
    out["refused"] =
        m.mid == mti::mid::kMtData ? "the legacy format" : "a message that roverd has no use for";
  }
}

Json message_object(const mti::Message& m) {
  const auto name = mti::name_of(m.mid);
  Json out;
  out["message"] = name.empty() ? Json(nullptr) : Json(name);
  out["mid"] = mti_hex(m.mid, 2);
  if (m.mid != mti::mid::kMtData2) {
    describe_short(out, m);
    return out;
  }
  const mti::Data2 data = mti::decode_data2(m.payload);
  if (!data.whole) {
    out["bytes"] = m.payload.size();
    out["refused"] = "a packet runs past the end of the message";
    return out;
  }
  out["packets"] = Json::array();
  for (const mti::Packet& packet : data.packets) out["packets"].push_back(packet_object(packet));
  return out;
}

class MtiBytes {
 public:
  explicit MtiBytes(OnObject on_object) : on_object_(std::move(on_object)) {}

  void feed(base::Bytes bytes) {
    framer_.feed(bytes, [this](const mti::Message& m) { take(m); });
  }
  void finish() {
    framer_.give_up([this](const mti::Message& m) { take(m); });
    tell_skipped();
  }

 private:
  void take(const mti::Message& m) {
    tell_skipped();
    on_object_(message_object(m));
  }
  void tell_skipped() {
    const auto& counts = framer_.counts();
    const auto broken = counts.bad_checksum + counts.too_long;
    if (counts.skipped_bytes == skipped_) return;
    on_object_({{"skipped_bytes", counts.skipped_bytes - skipped_},
                {"refused", broken == broken_ ? "outside any message"
                                              : "what begins like a message has a wrong checksum "
                                                "or length"}});
    skipped_ = counts.skipped_bytes;
    broken_ = broken;
  }

  const OnObject on_object_;
  mti::Framer framer_;
  std::uint64_t skipped_ = 0;
  std::uint64_t broken_ = 0;
};

}  // namespace

Reader mti_reader(OnObject on_object) {
  const auto bytes = std::make_shared<MtiBytes>(std::move(on_object));
  return {.feed = [bytes](base::Bytes part) { bytes->feed(part); },
          .finish = [bytes] { bytes->finish(); }};
}

}  // namespace roverd
