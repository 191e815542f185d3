// NMEA 0183 text of one epoch, as a current multi-constellation receiver writes it.

#include <chrono>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "sim/receiver.hpp"

namespace roverd::sim {
namespace {

using base::FixType;

constexpr double kKnot_mps = 1852.0 / 3600.0;

std::string closed(const std::string& body) {
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  return fmt::format("${}*{:02X}\r\n", body, sum);
}

struct Utc {
  std::string time;  ///< hhmmss.ss
  std::string date;  ///< ddmmyy
};

Utc utc_of(base::WallTime wall) {
  using namespace std::chrono;
  const auto centi = floor<duration<std::int64_t, std::centi>>(wall);
  const auto day = floor<days>(centi);
  const year_month_day date{day};
  const hh_mm_ss clock{centi - day};
  return {fmt::format("{:02}{:02}{:02}.{:02}", clock.hours().count(), clock.minutes().count(),
                      clock.seconds().count(), clock.subseconds().count()),
          fmt::format("{:02}{:02}{:02}", unsigned{date.day()}, unsigned{date.month()},
                      static_cast<int>(date.year()) % 100)};
}

/// ddmm.mmmmmmm,N: 7 decimals of a minute are 0.2 mm. Rounded as a whole, so that 59.99999999
/// carries into the degree instead of printing 60 minutes.
std::string angle(double degrees, int width, const char* signs) {
  const auto units = std::llround(std::abs(degrees) * 60.0 * 1e7);
  const auto whole = units / 600'000'000;
  const auto rest = units % 600'000'000;
  return fmt::format("{:0{}}{:02}.{:07},{}", whole, width, rest / 10'000'000, rest % 10'000'000,
                     degrees < 0.0 ? signs[1] : signs[0]);
}

std::string place(const Epoch& epoch) {
  if (!epoch.position) return ",,,";
  return angle(epoch.position->lat, 2, "NS") + "," + angle(epoch.position->lon, 3, "EW");
}

int quality(FixType fix) {
  switch (fix) {
    case FixType::RtkFixed:
      return 4;
    case FixType::RtkFloat:
      return 5;
    case FixType::Differential:
      return 2;
    case FixType::Single:
      return 1;
    case FixType::Estimated:
      return 6;
    case FixType::Unknown:
    case FixType::None:
      break;
  }
  return 0;
}

char mode_letter(FixType fix) {
  switch (fix) {
    case FixType::RtkFixed:
      return 'R';
    case FixType::RtkFloat:
      return 'F';
    case FixType::Differential:
      return 'D';
    case FixType::Single:
      return 'A';
    case FixType::Estimated:
      return 'E';
    case FixType::Unknown:
    case FixType::None:
      break;
  }
  return 'N';
}

std::string gga(const Epoch& epoch, const Utc& utc) {
  const FixErrors& e = epoch.errors;
  const std::string head = fmt::format("GNGGA,{},{},{},", utc.time, place(epoch), quality(e.fix));
  if (!epoch.position) return closed(head + "00,99.99,,,,,,");
  const bool corrected = e.fix != FixType::Single;
  return closed(head + fmt::format("{:02},{:.1f},{:.3f},M,{:.3f},M,{},{}", e.satellites, e.hdop,
                                   epoch.alt_msl_m, epoch.geoid_sep_m, corrected ? "1.0" : "",
                                   corrected ? "0001" : ""));
}

std::string rmc(const Epoch& epoch, const Utc& utc, const std::string& course) {
  const char mode = mode_letter(epoch.errors.fix);
  if (!epoch.position) {
    return closed(fmt::format("GNRMC,{},V,,,,,,,{},,,{},V", utc.time, utc.date, mode));
  }
  return closed(fmt::format("GNRMC,{},A,{},{:.3f},{},{},,,{},V", utc.time, place(epoch),
                            epoch.speed_mps / kKnot_mps, course, utc.date, mode));
}

std::string vtg(const Epoch& epoch, const std::string& course) {
  const char mode = mode_letter(epoch.errors.fix);
  if (!epoch.position) return closed(fmt::format("GNVTG,,,,,,,,,{}", mode));
  return closed(fmt::format("GNVTG,{},T,,M,{:.3f},N,{:.3f},K,{}", course,
                            epoch.speed_mps / kKnot_mps, epoch.speed_mps * 3.6, mode));
}

std::string gst(const Epoch& epoch, const Utc& utc) {
  if (!epoch.position) return closed(fmt::format("GNGST,{},,,,,,,", utc.time));
  const double s = std::max(epoch.sigma_m, 0.001);
  return closed(fmt::format("GNGST,{},{:.3f},{:.3f},{:.3f},0.0,{:.3f},{:.3f},{:.3f}", utc.time,
                            1.4 * s, s, s, s, s, 1.5 * s));
}

/// Two decimals, and never "360.00".
std::string compass_angle(double degrees) {
  return fmt::format("{:.2f}", std::fmod(std::round(degrees * 100.0) / 100.0, 360.0));
}

}  // namespace

std::string sentences(const Epoch& epoch) {
  const Utc utc = utc_of(epoch.utc);
  const std::string course = epoch.course_deg ? compass_angle(*epoch.course_deg) : "";
  std::string text = gga(epoch, utc) + rmc(epoch, utc, course) + vtg(epoch, course);
  text += gst(epoch, utc);
  if (epoch.heading_deg) text += closed("GNHDT," + compass_angle(*epoch.heading_deg) + ",T");
  return text;
}

}  // namespace roverd::sim
