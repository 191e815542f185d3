// NMEA 0183 text of one epoch, as a current multi-constellation receiver writes it.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>

#include "gnss/nmea_encode.hpp"
#include "sim/receiver.hpp"

namespace roverd::sim {
namespace {

using base::FixType;

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

/// Two decimals, and never "360.00".
double angle_as_printed(double degrees) {
  return std::fmod(std::round(degrees * 100.0) / 100.0, 360.0);
}

gnss::Gga gga_of(const Epoch& epoch, double time_s) {
  gnss::Gga s{.time_s = time_s, .quality = quality(epoch.errors.fix)};
  s.sats = epoch.errors.satellites;
  s.hdop = epoch.errors.hdop;
  if (!epoch.position) return s;
  s.lat = epoch.position->lat;
  s.lon = epoch.position->lon;
  s.alt_msl_m = epoch.alt_msl_m;
  s.geoid_sep_m = epoch.geoid_sep_m;
  if (epoch.errors.fix != FixType::Single) {  // corrected by some reference station
    s.dgps_age_s = 1.0;
    s.station = epoch.station;
  }
  return s;
}

gnss::Gst gst_of(const Epoch& epoch, double time_s) {
  gnss::Gst s;
  s.time_s = time_s;
  if (!epoch.position) return s;
  const double sigma_m = std::max(epoch.sigma_m, 0.001);
  s.rms_m = 1.4 * sigma_m;
  s.major_m = s.minor_m = s.lat_sd_m = s.lon_sd_m = sigma_m;
  s.orient_deg = 0.0;
  s.alt_sd_m = 1.5 * sigma_m;
  return s;
}

}  // namespace

std::string sentences(const Epoch& epoch) {
  const auto day = std::chrono::floor<std::chrono::days>(epoch.utc);
  const double time_s = base::seconds(epoch.utc - day);

  gnss::Rmc rmc;
  rmc.time_s = time_s;
  rmc.date = gnss::Date{day};
  rmc.mode = mode_letter(epoch.errors.fix);
  rmc.nav_status = 'V';
  gnss::Vtg vtg;
  vtg.mode = rmc.mode;
  if (epoch.position) {
    rmc.active = true;
    rmc.lat = epoch.position->lat;
    rmc.lon = epoch.position->lon;
    rmc.speed_kn = vtg.speed_kn = epoch.speed_mps / gnss::kMpsPerKnot;
    if (epoch.course_deg) {
      rmc.course_deg = vtg.course_true_deg = angle_as_printed(*epoch.course_deg);
    }
  }
  std::string text = gnss::encode(gga_of(epoch, time_s)) + gnss::encode(rmc) + gnss::encode(vtg) +
                     gnss::encode(gst_of(epoch, time_s));
  if (epoch.heading_deg) {
    gnss::Hdt hdt;
    hdt.heading_deg = angle_as_printed(*epoch.heading_deg);
    text += gnss::encode(hdt);
  }
  if (epoch.utc == std::chrono::floor<std::chrono::seconds>(epoch.utc)) {
    text += sky_sentences(epoch);
  }
  return text;
}

}  // namespace roverd::sim
