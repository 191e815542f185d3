#pragma once
// Map tiles of somebody in the network, for the page: sections [layers.NAME], 8 at most. The page
// fetches them itself, while its computer has a network, and can keep an area of them on the robot.
//
//   [layers.aerial]
//   url = "https://tiles.example.org/aerial/{z}/{x}/{y}.jpg"
//   attribution = "© Land Board"
//   max_zoom = 20
//
// Any address with {z}, {x} and {y} (or {-y}: rows counted from the south) does, a WMTS's as well:
// its matrix set must be that of the web's maps (GoogleMapsCompatible).

#include <map>
#include <string>
#include <vector>

#include "base/params.hpp"
#include "base/result.hpp"

namespace roverd {

struct LayerSettings {
  std::string url;
  std::string attribution;
  int max_zoom = 19;
};

template <class V>
void fields(V& v, LayerSettings& p) {
  v("url", p.url, "http: or https:, with {z}, {x} and {y} or {-y}");
  v("attribution", p.attribution, "whose pictures they are; shown on the map");
  v("max_zoom", p.max_zoom, 0, 24, "the finest that there is");
}

using Layers = std::map<std::string, LayerSettings>;

inline constexpr std::size_t kMostLayers = 8;

/// Addresses that are none. Invalid; the field is the key ("layers.aerial.url").
base::Result<void> check(const Layers& layers);

/// "https://tiles.example.org", each once: from where the page may take pictures.
std::vector<std::string> origins_of(const Layers& layers);

}  // namespace roverd
