#pragma once
// Fences in KML, which has no word for them: Placemarks that say so by ExtendedData, with the words
// and shapes of geojson_fence.hpp: Polygon or Point, fence, radius_m, rally.
//
//   <Placemark><ExtendedData><Data name="fence"><value>inclusion</value></Data></ExtendedData>
//   <Polygon>…</Polygon></Placemark>

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "mission/formats/geojson_fence.hpp"

namespace roverd::mission {

/// Keeps one Data or SimpleData of a Placemark, if it is a word of a fence. @param words an object
void set_kml_word(nlohmann::json& words, std::string_view name, std::string_view text);

/// Do the words say that the Placemark's shapes are a fence's?
bool is_kml_fence(const nlohmann::json& words);

/// A Placemark for each area and rally point.
std::string kml_of(const Fence& fence);

}  // namespace roverd::mission
