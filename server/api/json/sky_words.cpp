// What each receiver sees of the sky, as JSON.

#include <algorithm>
#include <cmath>

#include "api/json/words.hpp"

namespace roverd::api {
namespace {

/// Receivers tell once in a second to once in five.
constexpr double kSkyStaleAfter_s = 10.0;

template <class T>
Json value_or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json satellite_json(const base::Satellite& s) {
  Json signals = Json::array();
  for (const base::SatelliteSignal& one : s.signals) {
    signals.push_back(
        {{"name", one.name}, {"cn0_dbhz", value_or_null(one.cn0_dbhz)}, {"used", one.used}});
  }
  return {{"system", s.system},
          {"number", s.number},
          {"elevation_deg", value_or_null(s.elevation_deg)},
          {"azimuth_deg", value_or_null(s.azimuth_deg)},
          {"cn0_dbhz", value_or_null(s.cn0_dbhz)},
          {"used", value_or_null(s.used)},
          {"signals", std::move(signals)}};
}

}  // namespace

Json satellites_json(const base::Snapshot& snapshot, base::Time now) {
  Json receivers = Json::array();
  for (const base::SatellitesInView& sky : snapshot.satellites) {
    const double age_s = std::max(0.0, base::seconds(now - sky.stamp));
    Json satellites = Json::array();
    if (sky.satellites) {
      for (const base::Satellite& s : *sky.satellites) satellites.push_back(satellite_json(s));
    }
    receivers.push_back({{"driver", sky.driver},
                         {"age_s", std::round(age_s * 1e3) / 1e3},
                         {"stale", age_s > kSkyStaleAfter_s},
                         {"satellites", std::move(satellites)}});
  }
  return {{"receivers", std::move(receivers)}};
}

}  // namespace roverd::api
