#include "mission/formats/kml_fence.hpp"

#include <charconv>

#include "mission/fence/fence_json.hpp"
#include "mission/formats/xml.hpp"
#include "mission/text.hpp"

namespace roverd::mission {
namespace {

using base::LatLon;
using nlohmann::json;

std::string_view bare_word(std::string_view text) {
  constexpr std::string_view kXmlSpace = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(kXmlSpace);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kXmlSpace) - begin + 1);
}

std::string tuple_of(LatLon at) {
  constexpr int kDecimals = 9;
  return fixed_number(at.lon, kDecimals) + ',' + fixed_number(at.lat, kDecimals);
}

std::string kml_data(std::string_view name, std::string_view value) {
  return "<Data name=\"" + std::string(name) + "\"><value>" + xml_escaped(value) +
         "</value></Data>";
}

std::string placemark(const std::string& name, const std::string& words, const std::string& shape) {
  return "<Placemark><name>" + xml_escaped(name) + "</name><ExtendedData>" + words +
         "</ExtendedData>" + shape + "</Placemark>\n";
}

std::string kml_point(const std::string& tuple) {
  return "<Point><coordinates>" + tuple + "</coordinates></Point>";
}

}  // namespace

void set_kml_word(json& words, std::string_view name, std::string_view text) {
  text = bare_word(text);
  if (name == "fence") words["fence"] = text;
  if (name == "rally") words["rally"] = text == "true" || text == "1";
  if (name != "radius_m") return;
  double radius_m = 0.0;
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), radius_m);
  const bool number = ec == std::errc{} && end == text.data() + text.size();
  words["radius_m"] = number ? json(radius_m) : json(text);
}

bool is_kml_fence(const json& words) {
  return words.contains("fence") || words.value("rally", false);
}

std::string kml_of(const Fence& fence) {
  std::string out;
  for (const FenceArea& area : fence.areas) {
    const std::string kind(to_string(area.kind));
    if (const auto* circle = std::get_if<FenceCircle>(&area.shape)) {
      const std::string radius = number_text(circle->radius_m);
      out += placemark(kind + ' ' + radius + " m",
                       kml_data("fence", kind) + kml_data("radius_m", radius),
                       kml_point(tuple_of(circle->center)));
      continue;
    }
    std::string ring;
    const auto& points = std::get<FencePolygon>(area.shape).points;
    for (const LatLon at : points) ring += tuple_of(at) + ' ';
    ring += tuple_of(points.front());  // KML closes its rings
    out += placemark(kind, kml_data("fence", kind),
                     "<Polygon><outerBoundaryIs><LinearRing><coordinates>" + ring +
                         "</coordinates></LinearRing></outerBoundaryIs></Polygon>");
  }
  for (const RallyPoint& rally : fence.rally) {
    std::string at = tuple_of(rally.at);
    if (rally.alt_m) at += ',' + fixed_number(*rally.alt_m, 0);
    out += placemark("rally", kml_data("rally", "true"), kml_point(at));
  }
  return out;
}

}  // namespace roverd::mission
