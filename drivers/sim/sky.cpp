// GSA and GSV of one epoch: a made-up sky that turns slowly, of four systems.

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "gnss/nmea_encode.hpp"
#include "sim/receiver.hpp"

namespace roverd::sim {
namespace {

struct SkySystem {
  gnss::Talker talker;
  int number;  ///< of GSA
  int signal;  ///< of GSV
  int first;   ///< NMEA's number of the first satellite
  int step;
  int count;
};
constexpr std::array kSky{
    SkySystem{{{'G', 'P'}}, 1, 1, 2, 3, 10}, SkySystem{{{'G', 'L'}}, 2, 1, 66, 3, 7},
    SkySystem{{{'G', 'A'}}, 3, 7, 3, 4, 8}, SkySystem{{{'G', 'B'}}, 4, 1, 6, 5, 5}};

/// The n-th satellite of all. Golden-ratio steps spread them evenly over the sky.
gnss::Satellite placed(int n, int id, double time_s, const Epoch& epoch) {
  constexpr double kTurn_degps = 360.0 / 43'200.0;
  const double share = std::fmod(n * 0.6180339887, 1.0);
  gnss::Satellite s;
  s.id = id;
  const double elevation_deg = 8.0 + 78.0 * share;
  s.elevation_deg = static_cast<int>(elevation_deg);
  s.azimuth_deg = static_cast<int>(std::fmod(n * 137.50776 + time_s * kTurn_degps, 360.0));
  if (epoch.position) {
    s.cn0_dbhz =
        static_cast<int>(30.0 + 18.0 * std::sin(elevation_deg * 3.14159265 / 180.0)) + n % 3 - 1;
  }
  return s;
}

std::string groups_of(const SkySystem& system, const std::vector<gnss::Satellite>& sats) {
  std::string text;
  const std::size_t total = (sats.size() + 3) / 4;
  for (std::size_t i = 0; i < total; ++i) {
    gnss::Gsv s;
    s.talker = system.talker;
    s.total = static_cast<int>(total);
    s.index = static_cast<int>(i) + 1;
    s.in_view = static_cast<int>(sats.size());
    s.signal = system.signal;
    for (std::size_t k = 4 * i; k < std::min(sats.size(), 4 * i + 4); ++k) {
      s.sats[s.used++] = sats[k];
    }
    text += gnss::encode(s);
  }
  return text;
}

}  // namespace

std::string sky_sentences(const Epoch& epoch) {
  const auto day = std::chrono::floor<std::chrono::days>(epoch.utc);
  const double time_s = base::seconds(epoch.utc - day);
  int free = epoch.position ? epoch.errors.satellites : 0;
  int n = 0;
  std::string used;
  std::string seen;
  for (const SkySystem& system : kSky) {
    gnss::Gsa gsa;
    gsa.automatic = true;
    gsa.fix = epoch.position ? 3 : 1;
    gsa.system = system.number;
    gsa.hdop = epoch.errors.hdop;
    gsa.vdop = 1.3 * epoch.errors.hdop;
    gsa.pdop = 1.64 * epoch.errors.hdop;
    std::vector<gnss::Satellite> sats;
    for (int i = 0; i < system.count; ++i, ++n) {
      const int id = system.first + i * system.step;
      sats.push_back(placed(n, id, time_s, epoch));
      if (free-- > 0) gsa.ids[gsa.used++] = id;
    }
    used += gnss::encode(gsa);
    seen += groups_of(system, sats);
  }
  return used + seen;
}

}  // namespace roverd::sim
