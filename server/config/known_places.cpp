#include "config/known_places.hpp"

#include <set>

#include "base/angle.hpp"
#include "base/geo.hpp"

namespace roverd {
namespace {

base::Result<void> wrong_place(const std::string& name, const char* field, const std::string& why) {
  const std::string key = "known_places." + name + "." + field;
  return base::fail(base::Code::Invalid, key + " " + why, {{key, why}});
}

bool on_earth(const KnownPlaceSettings& p) noexcept {
  return p.lat != 0.0 || p.lon != 0.0;
}

}  // namespace

base::Result<void> check(const KnownPlaceSections& said, const nav::EstimateParams& estimate) {
  std::set<int> tags;
  for (const auto& [name, p] : said) {
    if (!on_earth(p) && !estimate.has_map()) {
      return wrong_place(name, "lat",
                         "is missing: east_m and north_m count from nav.estimate.map_lat and "
                         "map_lon, which are not set");
    }
    if (p.tag < 0 && p.heading_deg >= 0.0) {
      return wrong_place(name, "heading_deg", "is of a tag; a pole looks nowhere");
    }
    if (p.tag >= 0 && !tags.insert(p.tag).second) {
      return wrong_place(name, "tag", "is another one's number, too: " + std::to_string(p.tag));
    }
  }
  return {};
}

std::vector<base::KnownPlace> known_places_of(const KnownPlaceSections& said,
                                              const nav::EstimateParams& estimate) {
  std::vector<base::KnownPlace> out;
  for (const auto& [name, p] : said) {
    base::KnownPlace k;
    k.name = name;
    k.at = on_earth(p) ? base::LatLon{p.lat, p.lon}
                       : base::LocalFrame(1, {estimate.map_lat, estimate.map_lon})
                             .to_global({p.east_m, p.north_m});
    k.sigma_m = p.accuracy_m;
    if (p.tag >= 0) k.tag = p.tag;
    if (p.heading_deg >= 0.0) k.yaw_rad = base::yaw_from_heading(p.heading_deg);
    k.yaw_sigma_rad = base::rad_from_deg(p.heading_accuracy_deg);
    k.configured = true;
    out.push_back(std::move(k));
  }
  return out;
}

}  // namespace roverd
