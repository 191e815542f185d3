// The bytes of a GNSS receiver to named values.

#include <array>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>

#include "gnss/framer.hpp"
#include "gnss/nmea.hpp"
#include "tools/decode.hpp"

namespace roverd {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json known(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}
Json letter(char c) {
  return c == 0 ? Json(nullptr) : Json(std::string(1, c));
}
Json day(const std::optional<gnss::Date>& date) {
  if (!date) return nullptr;
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%04d-%02u-%02u", static_cast<int>(date->year()),
                static_cast<unsigned>(date->month()), static_cast<unsigned>(date->day()));
  return text.data();
}

/// Writes one sentence's type and fields.
struct DescribeSentence {
  Json& out;

  void begin(const char* type, const gnss::Talker& talker) const {
    out["sentence"] = type;
    out["talker"] = talker.view();
  }
  template <class S>
  void place(const S& s) const {
    out["time_s"] = known(s.time_s);
    out["lat"] = known(s.lat);
    out["lon"] = known(s.lon);
  }

  void operator()(std::monostate) const {}
  void operator()(const gnss::Gga& s) const {
    begin("GGA", s.talker);
    place(s);
    out["quality"] = known(s.quality);
    out["sats"] = known(s.sats);
    out["hdop"] = known(s.hdop);
    out["alt_msl_m"] = known(s.alt_msl_m);
    out["geoid_sep_m"] = known(s.geoid_sep_m);
    out["dgps_age_s"] = known(s.dgps_age_s);
    out["station"] = known(s.station);
    out["fix"] = to_string(s.fix());
  }
  void operator()(const gnss::Rmc& s) const {
    begin("RMC", s.talker);
    out["time_s"] = known(s.time_s);
    out["valid"] = s.valid();
    out["lat"] = known(s.lat);
    out["lon"] = known(s.lon);
    out["speed_kn"] = known(s.speed_kn);
    out["speed_mps"] = s.speed_kn ? Json(*s.speed_kn * gnss::kMpsPerKnot) : Json(nullptr);
    out["course_deg"] = known(s.course_deg);
    out["date"] = day(s.date);
    out["magvar_deg"] = known(s.magvar_deg);
    out["mode"] = letter(s.mode);
    out["nav_status"] = letter(s.nav_status);
  }
  void operator()(const gnss::Vtg& s) const {
    begin("VTG", s.talker);
    out["course_true_deg"] = known(s.course_true_deg);
    out["course_mag_deg"] = known(s.course_mag_deg);
    out["speed_kn"] = known(s.speed_kn);
    out["speed_kmh"] = known(s.speed_kmh);
    out["mode"] = letter(s.mode);
  }
  void operator()(const gnss::Gsa& s) const {
    begin("GSA", s.talker);
    out["auto"] = s.automatic;
    out["fix"] = s.fix;
    out["ids"] = Json::array();
    for (std::size_t i = 0; i < s.used; ++i) out["ids"].push_back(s.ids[i]);
    out["pdop"] = known(s.pdop);
    out["hdop"] = known(s.hdop);
    out["vdop"] = known(s.vdop);
    out["system"] = known(s.system);
  }
  void operator()(const gnss::Gsv& s) const {
    begin("GSV", s.talker);
    out["total"] = s.total;
    out["index"] = s.index;
    out["in_view"] = s.in_view;
    out["signal"] = known(s.signal);
    out["sats"] = Json::array();
    for (std::size_t i = 0; i < s.used; ++i) {
      const gnss::Satellite& sat = s.sats[i];
      out["sats"].push_back({{"id", sat.id},
                             {"el", known(sat.elevation_deg)},
                             {"az", known(sat.azimuth_deg)},
                             {"snr", known(sat.cn0_dbhz)}});
    }
  }
  void operator()(const gnss::Gst& s) const {
    begin("GST", s.talker);
    out["time_s"] = known(s.time_s);
    out["rms_m"] = known(s.rms_m);
    out["major_m"] = known(s.major_m);
    out["minor_m"] = known(s.minor_m);
    out["orient_deg"] = known(s.orient_deg);
    out["lat_sd_m"] = known(s.lat_sd_m);
    out["lon_sd_m"] = known(s.lon_sd_m);
    out["alt_sd_m"] = known(s.alt_sd_m);
  }
  void operator()(const gnss::Hdt& s) const {
    begin("HDT", s.talker);
    out["heading_deg"] = known(s.heading_deg);
  }
  void operator()(const gnss::Ths& s) const {
    begin("THS", s.talker);
    out["heading_deg"] = known(s.heading_deg);
    out["mode"] = letter(s.mode);
    out["valid"] = s.valid();
  }
  void operator()(const gnss::Zda& s) const {
    begin("ZDA", s.talker);
    out["time_s"] = known(s.time_s);
    out["date"] = day(s.date);
    out["zone_h"] = known(s.zone_h);
    out["zone_min"] = known(s.zone_min);
  }
  void operator()(const gnss::Gns& s) const {
    begin("GNS", s.talker);
    place(s);
    out["modes"] = s.modes_view();
    out["sats"] = known(s.sats);
    out["hdop"] = known(s.hdop);
    out["alt_msl_m"] = known(s.alt_msl_m);
    out["geoid_sep_m"] = known(s.geoid_sep_m);
    out["dgps_age_s"] = known(s.dgps_age_s);
    out["station"] = known(s.station);
    out["nav_status"] = letter(s.nav_status);
    out["fix"] = to_string(s.fix());
  }
};

Json line_object(std::string_view text) {
  const gnss::Parsed parsed = gnss::parse_line(text);
  Json out;
  if (parsed.kind == gnss::Kind::Used) {
    std::visit(DescribeSentence{out}, parsed.sentence);
    return out;
  }
  out["text"] = text;
  switch (parsed.kind) {
    case gnss::Kind::Used:
    case gnss::Kind::Unused:
      out["refused"] = "a sentence that roverd has no use for";
      break;
    case gnss::Kind::Unknown:
      out["refused"] = "unknown sentence";
      break;
    case gnss::Kind::Damaged:
      out["refused"] = to_string(parsed.flaw);
      if (parsed.flaw == gnss::Flaw::BadField) out["field"] = parsed.field;
      break;
  }
  return out;
}

using DescribeUbx = Json (*)(base::Bytes frame);

/// @param ubx null: UBX frames are only named.
Json binary_object(const gnss::Cut& cut, DescribeUbx ubx) {
  if (cut.piece == gnss::Piece::Ubx && ubx != nullptr) return ubx(cut.bytes);
  Json out;
  const auto& b = cut.bytes;
  if (cut.piece == gnss::Piece::Ubx) {
    std::array<char, 16> text{};
    std::snprintf(text.data(), text.size(), "%02X %02X", b[2], b[3]);
    out["ubx"] = text.data();
    out["bytes"] = b.size();
    out["refused"] = "a UBX frame (class and id as shown)";
  } else {
    out["rtcm3"] = b.size() > 7 ? Json(b[3] << 4 | b[4] >> 4) : Json(nullptr);
    out["bytes"] = b.size();
    out["refused"] = "an RTCM3 frame (type as shown)";
  }
  return out;
}

class NmeaBytes {
 public:
  explicit NmeaBytes(OnObject on_object, DescribeUbx ubx = nullptr)
      : on_object_(std::move(on_object)), ubx_(ubx) {}

  void feed(base::Bytes bytes) {
    framer_.feed(bytes, {}, [this](const gnss::Cut& cut) { take(cut); });
  }

  /// A last line without its end counts; what only looked like a binary frame holds nothing back.
  void finish() {
    const auto sink = [this](const gnss::Cut& cut) { take(cut); };
    constexpr std::array<std::uint8_t, 1> kEnd{'\n'};
    framer_.give_up({}, sink);
    framer_.feed(kEnd, {}, sink);
    framer_.give_up({}, sink);
    tell_skipped();
  }

 private:
  void take(const gnss::Cut& cut) {
    tell_skipped();
    switch (cut.piece) {
      case gnss::Piece::Line:
        return on_object_(line_object(cut.text));
      case gnss::Piece::Broken:
        return on_object_({{"text", cut.text}, {"refused", to_string(cut.flaw)}});
      case gnss::Piece::Ubx:
      case gnss::Piece::Rtcm3:
        return on_object_(binary_object(cut, ubx_));
    }
  }

  void tell_skipped() {
    const auto skipped = framer_.counts().skipped_bytes;
    if (skipped == skipped_) return;
    const auto broken = framer_.counts().broken_binary;
    on_object_({{"skipped_bytes", skipped - skipped_},
                {"refused", broken == broken_ ? "outside any sentence or binary frame"
                                              : "what begins like a binary frame has a wrong "
                                                "checksum or length"}});
    skipped_ = skipped;
    broken_ = broken;
  }

  const OnObject on_object_;
  const DescribeUbx ubx_;
  gnss::Framer framer_;
  std::uint64_t skipped_ = 0;
  std::uint64_t broken_ = 0;
};

}  // namespace

namespace {

Reader reader_of(std::shared_ptr<NmeaBytes> bytes) {
  return {.feed = [bytes](base::Bytes part) { bytes->feed(part); },
          .finish = [bytes] { bytes->finish(); }};
}

}  // namespace

Reader nmea_reader(OnObject on_object) {
  return reader_of(std::make_shared<NmeaBytes>(std::move(on_object)));
}

Reader ubx_reader(OnObject on_object) {
  return reader_of(std::make_shared<NmeaBytes>(std::move(on_object), ubx_object));
}

}  // namespace roverd
