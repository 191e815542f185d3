// Frames of u-blox receivers to named values. Names are those of the fact sheet's tables; values
// are in m, m/s, deg and s, null where the receiver says that there is none.

#include <array>
#include <cstdio>
#include <string>

#include "tools/decode.hpp"
#include "ubx/messages.hpp"

namespace roverd {
namespace {

using Json = nlohmann::ordered_json;

/// What a receiver sends for an accuracy it does not know: all bits set, in mm.
constexpr double kUnknown_m = 4294967.295;

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}
Json only_if(bool valid, double value) {
  return valid ? Json(value) : Json(nullptr);
}
Json accuracy(double value) {
  return only_if(value < kUnknown_m, value);
}
std::string ubx_hex(std::uint32_t value, int digits) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%0*X", digits, static_cast<unsigned>(value));
  return text.data();
}

struct UbxFields {
  Json& out;

  void operator()(std::monostate) const {}
  void operator()(const ubx::NavPvt& m) const {
    out["iTOW"] = m.itow_ms;
    out["year"] = m.year;
    out["month"] = m.month;
    out["day"] = m.day;
    out["hour"] = m.hour;
    out["min"] = m.min;
    out["sec"] = m.sec;
    out["nano"] = m.nano;
    out["validDate"] = m.date_valid();
    out["validTime"] = m.time_valid();
    out["fullyResolved"] = m.time_resolved();
    out["tAcc"] = m.time_sigma_ns;
    out["fixType"] = m.fix_type;
    out["gnssFixOK"] = m.fix_ok();
    out["diffSoln"] = m.differential();
    out["carrSoln"] = static_cast<int>(m.carrier());
    out["invalidLlh"] = m.invalid_llh();
    out["usable"] = m.usable();
    out["quality"] = m.quality();
    out["correctionAgeClass"] = m.correction_age_class();
    out["numSV"] = m.satellites;
    out["lon"] = only_if(m.usable(), m.at.lon);
    out["lat"] = only_if(m.usable(), m.at.lat);
    out["height"] = only_if(m.usable(), m.height_ellipsoid_m);
    out["hMSL"] = only_if(m.usable(), m.height_msl_m);
    out["hAcc"] = accuracy(m.horizontal_sigma_m);
    out["vAcc"] = accuracy(m.vertical_sigma_m);
    out["velN"] = m.velocity_mps.north;
    out["velE"] = m.velocity_mps.east;
    out["velD"] = m.velocity_mps.down;
    out["gSpeed"] = m.ground_speed_mps;
    out["headMot"] = m.course_deg;
    out["sAcc"] = accuracy(m.speed_sigma_mps);
    out["headAcc"] = m.course_sigma_deg;
    out["pDOP"] = m.pdop;
    out["headVeh"] = or_null(m.heading_deg);
    out["magDec"] = or_null(m.magnetic_declination_deg);
    out["magAcc"] = or_null(m.magnetic_declination_sigma_deg);
  }
  void operator()(const ubx::NavHpPosLlh& m) const {
    out["iTOW"] = m.itow_ms;
    out["invalid"] = m.invalid;
    out["lon"] = only_if(!m.invalid, m.at.lon);
    out["lat"] = only_if(!m.invalid, m.at.lat);
    out["height"] = only_if(!m.invalid, m.height_ellipsoid_m);
    out["hMSL"] = only_if(!m.invalid, m.height_msl_m);
    out["hAcc"] = m.horizontal_sigma_m;
    out["vAcc"] = m.vertical_sigma_m;
  }
  void operator()(const ubx::NavCov& m) const {
    out["iTOW"] = m.itow_ms;
    out["version"] = m.version;
    out["posCovValid"] = m.position_m2.has_value();
    out["velCovValid"] = m.velocity_m2ps2.has_value();
    out["posCov"] = named(m.position_m2);
    out["velCov"] = named(m.velocity_m2ps2);
  }
  void operator()(const ubx::NavRelPosNed& m) const {
    out["version"] = m.version;
    out["refStationId"] = m.station;
    out["iTOW"] = m.itow_ms;
    out["relPosN"] = m.position_m.north;
    out["relPosE"] = m.position_m.east;
    out["relPosD"] = m.position_m.down;
    out["relPosLength"] = m.length_m;
    out["relPosHeading"] = only_if(m.heading_valid(), m.heading_deg);
    out["accN"] = m.sigma_m.north;
    out["accE"] = m.sigma_m.east;
    out["accD"] = m.sigma_m.down;
    out["accLength"] = m.length_sigma_m;
    out["accHeading"] = m.heading_sigma_deg;
    out["gnssFixOK"] = m.fix_ok();
    out["diffSoln"] = m.differential();
    out["relPosValid"] = m.position_valid();
    out["carrSoln"] = static_cast<int>(m.carrier());
    out["isMoving"] = m.moving();
    out["refPosMiss"] = m.bit(6);
    out["refObsMiss"] = m.bit(7);
    out["relPosHeadingValid"] = m.heading_valid();
    out["relPosNormalized"] = m.normalised();
  }
  void operator()(const ubx::NavSat& m) const {
    out["iTOW"] = m.itow_ms;
    out["svs"] = Json::array();
    for (const auto& s : m.all) {
      out["svs"].push_back({{"gnssId", s.gnss_id},
                            {"svId", s.number},
                            {"cno", s.cn0_dbhz},
                            {"elev", s.elevation_deg},
                            {"azim", s.azimuth_deg},
                            {"qualityInd", s.quality()},
                            {"svUsed", s.used()}});
    }
  }
  void operator()(const ubx::NavSig& m) const {
    out["iTOW"] = m.itow_ms;
    out["sigs"] = Json::array();
    for (const auto& s : m.all) {
      const auto name = ubx::signal_name(s.gnss_id, s.signal_id);
      out["sigs"].push_back({{"gnssId", s.gnss_id},
                             {"svId", s.number},
                             {"sigId", s.signal_id},
                             {"signal", name.empty() ? Json(nullptr) : Json(name)},
                             {"prRes", s.residual_m},
                             {"cno", s.cn0_dbhz},
                             {"qualityInd", s.quality},
                             {"health", s.health()},
                             {"prUsed", s.code_used()},
                             {"crUsed", s.carrier_used()},
                             {"doUsed", s.doppler_used()}});
    }
  }
  void operator()(const ubx::MonVer& m) const {
    out["swVersion"] = m.software;
    out["hwVersion"] = m.hardware;
    out["extensions"] = m.extensions;
    out["module"] = m.extension("MOD");
    out["protocol"] = m.extension("PROTVER");
  }
  void operator()(const ubx::Ack& m) const {
    out["accepted"] = m.accepted;
    out["to_class"] = ubx_hex(m.to.cls, 2);
    out["to_id"] = ubx_hex(m.to.id, 2);
    out["to"] = ubx::name_of(m.to);
  }
  void operator()(const ubx::ValSet& m) const {
    out["layers"] = m.layers;
    out["items"] = Json::array();
    for (const auto& item : m.items) {
      out["items"].push_back({{"key", "0x" + ubx_hex(item.id, 8)}, {"value", item.value}});
    }
  }
  void operator()(const ubx::Poll&) const { out["poll"] = true; }

 private:
  static Json named(const std::optional<ubx::Covariance>& c) {
    if (!c) return nullptr;
    return {{"NN", (*c)[0]}, {"NE", (*c)[1]}, {"ND", (*c)[2]},
            {"EE", (*c)[3]}, {"ED", (*c)[4]}, {"DD", (*c)[5]}};
  }
};

}  // namespace

Json ubx_object(base::Bytes bytes) {
  const ubx::Frame frame = ubx::opened(bytes);
  const auto name = ubx::name_of(frame.key);
  const ubx::Decoded decoded = ubx::decode(frame);
  Json out;
  out["message"] = name.empty() ? Json(nullptr) : Json("UBX-" + std::string(name));
  out["class"] = ubx_hex(frame.key.cls, 2);
  out["id"] = ubx_hex(frame.key.id, 2);
  if (decoded.verdict == ubx::Verdict::Decoded) {
    std::visit(UbxFields{out}, decoded.message);
  } else {
    out["bytes"] = bytes.size();
    out["refused"] = ubx::to_string(decoded.verdict);
  }
  return out;
}

}  // namespace roverd
