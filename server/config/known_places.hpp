#pragma once
// Things whose place is known: sections [known_places.NAME], and the file in which those are kept
// that people entered while the robot ran.
//
//   [known_places.gate]
//   tag = 5                     # an AprilTag; without: a pole or a cone
//   lat = 58.37802              # or east_m, north_m from nav.estimate.map_lat, map_lon
//   lon = 26.7289
//   heading_deg = 180.0         # in which the tag looks; without: its place alone counts
//   accuracy_m = 0.05           # 1 sigma
//
//   FILE  {"known_places": [{"name": "gate", "tag": 5, "lat": 58.37802, …}]}

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/known_place.hpp"
#include "base/params.hpp"
#include "base/result.hpp"
#include "nav/estimate/params.hpp"

namespace roverd {

struct KnownPlaceSettings {
  int tag = -1;
  double lat = 0.0;
  double lon = 0.0;
  double east_m = 0.0;
  double north_m = 0.0;
  double heading_deg = -1.0;
  double accuracy_m = 0.05;
  double heading_accuracy_deg = 2.0;
};

template <class V>
void fields(V& v, KnownPlaceSettings& p) {
  v("tag", p.tag, -1, 586, "number of the AprilTag, of tag36h11; -1: a pole or a cone");
  v("lat", p.lat, -90.0, 90.0, "latitude of its middle; this and lon 0: east_m and north_m say it");
  v("lon", p.lon, -180.0, 180.0, "longitude of its middle");
  v("east_m", p.east_m, -10'000.0, 10'000.0,
    "its place without lat and lon: east of nav.estimate.map_lat, map_lon");
  v("north_m", p.north_m, -10'000.0, 10'000.0, "likewise, north");
  v("heading_deg", p.heading_deg, -1.0, 360.0,
    "compass heading in which the tag looks, out of the wall; -1: not known");
  v("accuracy_m", p.accuracy_m, 0.01, 2.0,
    "how well its place is known, 1 sigma: by it the robot is never surer of its own");
  v("heading_accuracy_deg", p.heading_accuracy_deg, 0.2, 45.0,
    "how well heading_deg is known, 1 sigma");
}

using KnownPlaceSections = std::map<std::string, KnownPlaceSettings>;

/// What only the whole tells: places that are none, a tag's number twice. Invalid; the field is the
/// key ("known_places.gate.tag").
base::Result<void> check(const KnownPlaceSections& said, const nav::EstimateParams& estimate);
/// Of the configuration, that was checked.
std::vector<base::KnownPlace> known_places_of(const KnownPlaceSections& said,
                                              const nav::EstimateParams& estimate);

std::string known_places_text(const std::vector<base::KnownPlace>& places);
/// Malformed, Invalid, naming what is wrong.
base::Result<std::vector<base::KnownPlace>> known_places_from(std::string_view text);
/// A file that is missing holds none. Unavailable: it cannot be read; else as known_places_from.
base::Result<std::vector<base::KnownPlace>> read_known_places(const std::filesystem::path& file);
/// All of them or nothing; durable when it returns. Unavailable.
base::Result<void> write_known_places(const std::filesystem::path& file,
                                      const std::vector<base::KnownPlace>& places);

}  // namespace roverd
