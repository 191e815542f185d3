#include "gnss/nmea_encode.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>

#include "gnss/nmea.hpp"

namespace roverd::gnss {

namespace {

/// Builds the body field by field.
class Body {
 public:
  Body(const Talker& talker, std::string_view type) {
    text_.append(talker.view());
    text_.append(type);
  }

  Body& text(std::string_view value) {
    text_ += ',';
    text_ += value;
    return *this;
  }
  Body& letter(char value) { return text(value != 0 ? std::string_view(&value, 1) : ""); }

  Body& number(const std::optional<double>& value, int decimals, int width = 0) {
    text_ += ',';
    if (value && std::isfinite(*value)) print("%0*.*f", width, decimals, *value + 0.0);
    return *this;
  }
  Body& integer(const std::optional<int>& value, int width = 0) {
    text_ += ',';
    if (value) print("%0*d", width, *value);
    return *this;
  }

  /// hhmmss.ss; only a leap second has 60, rounding never makes one.
  Body& time(const std::optional<double>& time_s) {
    text_ += ',';
    if (!time_s || !(*time_s >= 0.0 && *time_s < 86401.0)) return *this;
    const long centi =
        std::min(std::lround(*time_s * 100.0), *time_s < 86400.0 ? 8639999L : 8640099L);
    const long whole = std::min(centi / 100, 86399L);
    print("%02ld%02ld%02ld.%02ld", whole / 3600, whole / 60 % 60,
          whole % 60 + (centi / 100 - whole), centi % 100);
    return *this;
  }

  Body& date(const std::optional<Date>& date) {
    text_ += ',';
    if (date) {
      print("%02u%02u%02d", static_cast<unsigned>(date->day()),
            static_cast<unsigned>(date->month()), static_cast<int>(date->year()) % 100);
    }
    return *this;
  }

  /// Degrees as d…dmm.m… and its side. Counted in whole steps, so minutes never print as 60.
  Body& arc(const std::optional<double>& deg, int degree_digits, int decimals,
            std::string_view sides) {
    text_ += ',';
    if (!deg || !std::isfinite(*deg)) {
      text_ += ',';
      return *this;
    }
    decimals = std::clamp(decimals, 4, 9);
    long long scale = 1;
    for (int i = 0; i < decimals; ++i) scale *= 10;
    const long long total = std::llround(std::abs(*deg) * 60.0 * static_cast<double>(scale));
    print("%0*lld%02lld.%0*lld", degree_digits, total / scale / 60, total / scale % 60, decimals,
          total % scale);
    text_ += ',';
    text_ += sides[*deg < 0.0 ? 1 : 0];
    return *this;
  }

  std::string line() const { return gnss::line(text_); }

 private:
  [[gnu::format(printf, 2, 3)]] void print(const char* format, ...) {
    std::array<char, 64> out{};
    va_list args;
    va_start(args, format);
    std::vsnprintf(out.data(), out.size(), format, args);
    va_end(args);
    text_ += out.data();
  }

  std::string text_;
};

}  // namespace

std::string line(std::string_view body) {
  std::array<char, 8> tail{};
  std::snprintf(tail.data(), tail.size(), "*%02X\r\n", unsigned{checksum(body)});
  std::string out;
  out.reserve(body.size() + 6);
  out += '$';
  out += body;
  out += tail.data();
  return out;
}

std::string encode(const Gga& s, int decimals) {
  return Body(s.talker, "GGA")
      .time(s.time_s)
      .arc(s.lat, 2, decimals, "NS")
      .arc(s.lon, 3, decimals, "EW")
      .integer(s.quality.value_or(0))
      .integer(s.sats, 2)
      .number(s.hdop, 1)
      .number(s.alt_msl_m, 3)
      .text(s.alt_msl_m ? "M" : "")
      .number(s.geoid_sep_m, 3)
      .text(s.geoid_sep_m ? "M" : "")
      .number(s.dgps_age_s, 1)
      .integer(s.station, 4)
      .line();
}

std::string encode(const Rmc& s, int decimals) {
  std::optional<double> magvar;
  if (s.magvar_deg) magvar = std::abs(*s.magvar_deg);
  Body body(s.talker, "RMC");
  body.time(s.time_s)
      .text(s.active ? "A" : "V")
      .arc(s.lat, 2, decimals, "NS")
      .arc(s.lon, 3, decimals, "EW")
      .number(s.speed_kn, 3)
      .number(s.course_deg, 2)
      .date(s.date)
      .number(magvar, 1)
      .text(!s.magvar_deg ? "" : (*s.magvar_deg < 0.0 ? "W" : "E"));
  if (s.mode != 0) body.letter(s.mode);
  if (s.mode != 0 && s.nav_status != 0) body.letter(s.nav_status);
  return body.line();
}

std::string encode(const Vtg& s) {
  std::optional<double> kmh = s.speed_kmh;
  if (!kmh && s.speed_kn) kmh = *s.speed_kn * 1.852;
  Body body(s.talker, "VTG");
  body.number(s.course_true_deg, 2)
      .text("T")
      .number(s.course_mag_deg, 2)
      .text("M")
      .number(s.speed_kn, 3)
      .text("N")
      .number(kmh, 3)
      .text("K");
  if (s.mode != 0) body.letter(s.mode);
  return body.line();
}

std::string encode(const Gsa& s) {
  Body body(s.talker, "GSA");
  body.letter(s.automatic ? 'A' : 'M').integer(s.fix);
  for (std::size_t i = 0; i < s.ids.size(); ++i) {
    body.integer(i < s.used ? std::optional<int>(s.ids[i]) : std::nullopt, 2);
  }
  body.number(s.pdop, 2).number(s.hdop, 2).number(s.vdop, 2);
  if (s.system) body.integer(s.system);
  return body.line();
}

std::string encode(const Gsv& s) {
  Body body(s.talker, "GSV");
  body.integer(s.total).integer(s.index).integer(s.in_view, 2);
  for (std::size_t i = 0; i < s.used; ++i) {
    const Satellite& sat = s.sats[i];
    body.integer(sat.id, 2)
        .integer(sat.elevation_deg, 2)
        .integer(sat.azimuth_deg, 3)
        .integer(sat.cn0_dbhz, 2);
  }
  if (s.signal) body.integer(s.signal);
  return body.line();
}

std::string encode(const Gst& s) {
  return Body(s.talker, "GST")
      .time(s.time_s)
      .number(s.rms_m, 3)
      .number(s.major_m, 3)
      .number(s.minor_m, 3)
      .number(s.orient_deg, 1)
      .number(s.lat_sd_m, 3)
      .number(s.lon_sd_m, 3)
      .number(s.alt_sd_m, 3)
      .line();
}

std::string encode(const Hdt& s) {
  return Body(s.talker, "HDT").number(s.heading_deg, 2).text("T").line();
}

std::string encode(const Ths& s) {
  return Body(s.talker, "THS").number(s.heading_deg, 2).letter(s.mode).line();
}

std::string encode(const Zda& s) {
  Body body(s.talker, "ZDA");
  body.time(s.time_s);
  if (s.date) {
    body.integer(static_cast<int>(static_cast<unsigned>(s.date->day())), 2)
        .integer(static_cast<int>(static_cast<unsigned>(s.date->month())), 2)
        .integer(static_cast<int>(s.date->year()), 4);
  } else {
    body.text("").text("").text("");
  }
  return body.integer(s.zone_h.value_or(0), 2).integer(s.zone_min.value_or(0), 2).line();
}

}  // namespace roverd::gnss
