#include "gnss/nmea.hpp"

#include <algorithm>

#include "gnss/fields.hpp"

namespace roverd::gnss {

namespace {

constexpr std::uint32_t code(std::string_view type) noexcept {
  return (static_cast<std::uint32_t>(static_cast<std::uint8_t>(type[0])) << 16U) |
         (static_cast<std::uint32_t>(static_cast<std::uint8_t>(type[1])) << 8U) |
         static_cast<std::uint32_t>(static_cast<std::uint8_t>(type[2]));
}

/// Types a receiver may well send that tell us nothing new.
constexpr std::array<std::string_view, 10> kUnused{"GLL", "GBS", "GRS", "DTM", "TXT",
                                                   "VLW", "ROT", "HDG", "HDM", "VHW"};

Gga gga(Fields& f) noexcept {
  Gga s;
  s.time_s = f.time(1);
  s.lat = f.latitude(2);
  s.lon = f.longitude(4);
  s.quality = f.integer(6);
  s.sats = f.integer(7);
  s.hdop = f.number(8, 0.0);
  s.alt_msl_m = f.number(9);
  f.letter(10, "M");
  s.geoid_sep_m = f.number(11);
  f.letter(12, "M");
  s.dgps_age_s = f.number(13, 0.0);
  s.station = f.integer(14);
  return s;
}

Rmc rmc(Fields& f) noexcept {
  Rmc s;
  s.time_s = f.time(1);
  s.active = f.letter(2, "AV") == 'A';
  s.lat = f.latitude(3);
  s.lon = f.longitude(5);
  s.speed_kn = f.number(7, 0.0);
  s.course_deg = f.number(8, 0.0, 360.0);
  s.date = f.date(9);
  s.magvar_deg = f.number(10, -180.0, 180.0);
  if (f.letter(11, "EW") == 'W' && s.magvar_deg) s.magvar_deg = -*s.magvar_deg;
  s.mode = f.any_letter(12);
  s.nav_status = f.any_letter(13);
  return s;
}

Vtg vtg(Fields& f) noexcept {
  Vtg s;
  if (f.size() == 4) {  // before NMEA 2.0: the numbers alone
    s.course_true_deg = f.number(1, 0.0, 360.0);
    s.course_mag_deg = f.number(2, 0.0, 360.0);
    s.speed_kn = f.number(3, 0.0);
    s.speed_kmh = f.number(4, 0.0);
    return s;
  }
  s.course_true_deg = f.number(1, 0.0, 360.0);
  f.letter(2, "T");
  s.course_mag_deg = f.number(3, 0.0, 360.0);
  f.letter(4, "M");
  s.speed_kn = f.number(5, 0.0);
  f.letter(6, "N");
  s.speed_kmh = f.number(7, 0.0);
  f.letter(8, "K");
  s.mode = f.any_letter(9);
  return s;
}

Gsa gsa(Fields& f) noexcept {
  Gsa s;
  s.automatic = f.letter(1, "AM") == 'A';
  s.fix = f.integer(2, 1, 3).value_or(1);
  for (std::size_t i = 0; i < s.ids.size(); ++i) {
    if (const auto id = f.integer(3 + i)) s.ids[s.used++] = *id;
  }
  s.pdop = f.number(15, 0.0);
  s.hdop = f.number(16, 0.0);
  s.vdop = f.number(17, 0.0);
  s.system = f.integer(18);
  return s;
}

std::optional<int> signal_id(Fields& f, std::size_t i) noexcept {
  const char c = f.letter(i, "0123456789ABCDEFabcdef");
  if (c == 0) return std::nullopt;
  if (c <= '9') return c - '0';
  return (c | 0x20) - 'a' + 10;
}

Gsv gsv(Fields& f) noexcept {
  Gsv s;
  s.total = f.integer(1, 1, 9).value_or(0);
  s.index = f.integer(2, 1, 9).value_or(0);
  if (s.total == 0) f.refuse(1);
  if (s.index == 0 || s.index > s.total) f.refuse(2);
  s.in_view = f.integer(3).value_or(0);
  const std::size_t after = f.size() - 3;
  // Four fields a satellite; one more is the signal id of NMEA 4.11.
  if (after % 4 > 1 || after > 17) {
    f.refuse(f.size());
    return s;
  }
  for (std::size_t i = 0; i < after / 4; ++i) {
    const std::size_t at = 4 + 4 * i;
    Satellite sat;
    const auto id = f.integer(at);
    sat.elevation_deg = f.integer(at + 1, -90, 90);
    sat.azimuth_deg = f.integer(at + 2, 0, 360);
    sat.cn0_dbhz = f.integer(at + 3, 0, 99);
    if (!id) continue;
    sat.id = *id;
    s.sats[s.used++] = sat;
  }
  if (after % 4 == 1) s.signal = signal_id(f, f.size());
  return s;
}

Gst gst(Fields& f) noexcept {
  Gst s;
  s.time_s = f.time(1);
  s.rms_m = f.number(2, 0.0);
  s.major_m = f.number(3, 0.0);
  s.minor_m = f.number(4, 0.0);
  s.orient_deg = f.number(5);
  s.lat_sd_m = f.number(6, 0.0);
  s.lon_sd_m = f.number(7, 0.0);
  s.alt_sd_m = f.number(8, 0.0);
  return s;
}

Hdt hdt(Fields& f) noexcept {
  Hdt s;
  s.heading_deg = f.number(1, 0.0, 360.0);
  f.letter(2, "T");
  return s;
}

Ths ths(Fields& f) noexcept {
  Ths s;
  const char mode = f.letter(2, "AEMSV");
  s.mode = mode != 0 ? mode : 'V';
  const auto heading = f.number(1, 0.0, 360.0);
  if (s.mode != 'V') s.heading_deg = heading;
  return s;
}

Zda zda(Fields& f) noexcept {
  Zda s;
  s.time_s = f.time(1);
  const auto day = f.integer(2, 1, 31);
  const auto month = f.integer(3, 1, 12);
  const auto year = f.integer(4, 1980, 9999);
  if (day && month && year) {
    const Date date{std::chrono::year{*year}, std::chrono::month{static_cast<unsigned>(*month)},
                    std::chrono::day{static_cast<unsigned>(*day)}};
    if (date.ok()) {
      s.date = date;
    } else {
      f.refuse(2);
    }
  }
  s.zone_h = f.integer(5, -13, 13);
  s.zone_min = f.integer(6, -59, 59);
  return s;
}

Gns gns(Fields& f) noexcept {
  Gns s;
  s.time_s = f.time(1);
  s.lat = f.latitude(2);
  s.lon = f.longitude(4);
  const std::string_view modes = f.at(6);
  const bool letters =
      std::all_of(modes.begin(), modes.end(), [](char c) { return c >= 'A' && c <= 'Z'; });
  if (modes.size() > s.modes.size() || !letters) {
    f.refuse(6);
  } else {
    std::copy(modes.begin(), modes.end(), s.modes.begin());
  }
  s.sats = f.integer(7);
  s.hdop = f.number(8, 0.0);
  s.alt_msl_m = f.number(9);
  s.geoid_sep_m = f.number(10);
  s.dgps_age_s = f.number(11, 0.0);
  s.station = f.integer(12);
  s.nav_status = f.any_letter(13);
  return s;
}

template <class S>
void decode(Fields& f, std::size_t least, S (*from)(Fields&) noexcept, Parsed& out) noexcept {
  out.kind = Kind::Damaged;
  if (f.size() < least) {
    out.flaw = Flaw::TooFewFields;
    return;
  }
  S& s = out.sentence.emplace<S>(from(f));
  if (f.bad() != 0) {
    out.flaw = Flaw::BadField;
    out.field = f.bad();
    out.sentence = std::monostate{};
    return;
  }
  s.talker.id = {f.tag()[0], f.tag()[1]};
  out.kind = Kind::Used;
}

void dispatch(Fields& f, Parsed& out) noexcept {
  // "P…" is a manufacturer's own sentence, not a talker.
  if (f.tag().size() != 5 || f.tag().front() == 'P') {
    out.kind = Kind::Unknown;
    return;
  }
  const std::string_view type = f.tag().substr(2);
  switch (code(type)) {
    case code("GGA"):
      return decode(f, 14, gga, out);
    case code("RMC"):
      return decode(f, 9, rmc, out);
    case code("VTG"):
      return decode(f, f.size() == 4 ? 4 : 8, vtg, out);
    case code("GSA"):
      return decode(f, 17, gsa, out);
    case code("GSV"):
      return decode(f, 3, gsv, out);
    case code("GST"):
      return decode(f, 8, gst, out);
    case code("HDT"):
      return decode(f, 2, hdt, out);
    case code("THS"):
      return decode(f, 2, ths, out);
    case code("ZDA"):
      return decode(f, 4, zda, out);
    case code("GNS"):
      return decode(f, 12, gns, out);
    default:
      out.kind = std::find(kUnused.begin(), kUnused.end(), type) != kUnused.end() ? Kind::Unused
                                                                                  : Kind::Unknown;
  }
}

int hex_digit(char c) noexcept {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

/// Takes '$' and "*hh" off. @return the flaw, None if the checksum is right.
Flaw open_line(std::string_view& line) noexcept {
  if (!line.empty() && line.front() == '$') line.remove_prefix(1);
  if (line.size() > kMaxLine) return Flaw::TooLong;
  const std::size_t n = line.size();
  if (n < 3 || line[n - 3] != '*') return Flaw::NoChecksum;
  const int high = hex_digit(line[n - 2]);
  const int low = hex_digit(line[n - 1]);
  if (high < 0 || low < 0) return Flaw::NoChecksum;
  line.remove_suffix(3);
  return checksum(line) == high * 16 + low ? Flaw::None : Flaw::WrongChecksum;
}

}  // namespace

std::string_view to_string(Flaw flaw) noexcept {
  switch (flaw) {
    case Flaw::None:
      return "none";
    case Flaw::CutShort:
      return "cut short";
    case Flaw::NotText:
      return "not text";
    case Flaw::TooLong:
      return "too long";
    case Flaw::NoChecksum:
      return "no checksum";
    case Flaw::WrongChecksum:
      return "wrong checksum";
    case Flaw::TooFewFields:
      return "too few fields";
    case Flaw::BadField:
      return "bad field";
  }
  return "?";
}

Parsed parse_line(std::string_view line) noexcept {
  Parsed out;
  out.flaw = open_line(line);
  if (out.flaw != Flaw::None) return out;
  Fields fields(line);
  dispatch(fields, out);
  return out;
}

std::optional<double> time_of_day_s(std::string_view text) noexcept {
  if (open_line(text) != Flaw::None) return std::nullopt;
  const Fields f(text);
  if (f.tag().size() != 5 || f.tag().front() == 'P') return std::nullopt;
  const std::string_view type = f.tag().substr(2);
  constexpr std::array<std::string_view, 5> kTimeFirst{"GGA", "RMC", "GNS", "GST", "ZDA"};
  if (type == "GLL") return time_from(f.at(5));
  if (std::find(kTimeFirst.begin(), kTimeFirst.end(), type) == kTimeFirst.end()) {
    return std::nullopt;
  }
  return time_from(f.at(1));
}

}  // namespace roverd::gnss
