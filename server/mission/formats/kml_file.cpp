// KML 2.2: the coordinates of its lines (LineString, gx:Track); without one, of its Points. Areas
// are left out, unless their Placemark says that they are a fence (see kml_fence.hpp). Written as
// one Placemark with a LineString, a Point if there is only one.

#include <charconv>
#include <cmath>
#include <utility>

#include "mission/formats/file_formats.hpp"
#include "mission/formats/kml_fence.hpp"
#include "mission/formats/track_points.hpp"
#include "mission/formats/xml.hpp"

namespace roverd::mission {

namespace {

using base::Error;
using base::Result;

/// The next finite number at the front of `text`.
std::optional<double> take_number(std::string_view& text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (ec != std::errc{} || !std::isfinite(value)) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

class KmlReader {
 public:
  Result<ImportedFile> read(std::string_view content) {
    XmlEvents events;
    events.begin = [this](const XmlElement& element) {
      path_.emplace_back(element.name);
      rows_.push_back(element.row);
      if (path_.size() == 1) is_kml_ = element.name == "kml";
      if (element.name == "Placemark") words_ = nlohmann::json::object();
      if (element.name == "Polygon") shapes_.push_back({element.row, {}, std::nullopt});
      if (element.name == "Data" || element.name == "SimpleData") {
        word_ = element.attribute("name");
      }
    };
    events.end = [this](std::string_view name, const std::string& text, const std::string&) {
      path_.pop_back();
      const std::string row = std::move(rows_.back());
      rows_.pop_back();
      const std::string_view inside = path_.empty() ? std::string_view{} : path_.back();
      if (name == "coordinates") coordinates(text, row, inside);
      if (name == "coord" && inside == "Track") tuple(text, row, "gx:coord", ' ', lines_);
      if (name == "name" && file_.plan.name.empty()) file_.plan.name = text;
      if (name == "SimpleData" || (name == "value" && inside == "Data")) {
        set_kml_word(words_, word_, text);
      }
      if (name == "Placemark") end_placemark();
    };
    if (auto done = read_xml(content, events); !done) return tl::unexpected<Error>(done.error());
    end_placemark();  // shapes outside of one
    if (!is_kml_) {
      return base::fail(base::Code::Invalid, "line 1 must begin a <kml> document",
                        {{"line 1", "must begin a <kml> document"}});
    }
    const bool line = !lines_.empty();
    for (TrackPoint& point : line ? lines_ : points_) builder_.add(std::move(point));
    if (line) {
      for (TrackPoint& point : points_) {
        builder_.leave_out(std::move(point.row), "Point", "the file's line is taken instead");
      }
    }
    if (!fence_.areas.empty() || !fence_.rally.empty()) file_.fence = std::move(fence_);
    return std::move(builder_).finish();
  }

 private:
  /// Of the Placemark that is being read. What it is is told by its words, which may come last.
  struct Shape {
    std::string row;
    std::vector<std::string> rings;  ///< of a Polygon, as they stand there; the outer one first
    std::optional<TrackPoint> point;
  };

  void end_placemark() {
    for (Shape& shape : shapes_) {
      if (is_kml_fence(words_)) {
        take_fence(shape);
      } else if (shape.point) {
        points_.push_back(std::move(*shape.point));
      } else {
        builder_.leave_out(std::move(shape.row), "Polygon", "an area is no way to drive");
      }
    }
    shapes_.clear();
    words_ = nlohmann::json::object();
  }

  void take_fence(const Shape& shape) {
    const auto position = [](const TrackPoint& at) {
      auto out = nlohmann::json::array({at.lon, at.lat});
      if (at.alt_m) out.push_back(*at.alt_m);
      return out;
    };
    nlohmann::json found;
    if (shape.point) {
      found = {{"type", "Point"}, {"coordinates", position(*shape.point)}};
    } else {
      auto rings = nlohmann::json::array();
      for (const std::string& text : shape.rings) {
        std::vector<TrackPoint> corners;
        if (!tuples(text, shape.row, "corner", corners)) return;
        auto& ring = rings.emplace_back(nlohmann::json::array());
        for (const TrackPoint& corner : corners) ring.push_back(position(corner));
      }
      found = {{"type", "Polygon"}, {"coordinates", std::move(rings)}};
    }
    take_fence_feature(words_, found, {shape.row, shape.row}, fence_, file_.rows, problems_);
  }

  void coordinates(const std::string& text, const std::string& row, std::string_view inside) {
    if (inside == "LineString") {
      tuples(text, row, "coordinate", lines_);
    } else if (inside == "Point") {
      std::vector<TrackPoint> one;
      tuples(text, row, nullptr, one);
      for (TrackPoint& point : one) shapes_.push_back({row, {}, std::move(point)});
    } else if (inside == "LinearRing" && !shapes_.empty()) {
      shapes_.back().rings.push_back(text);
    }
  }

  /// @param each what one of many is called; null: there is one, at `row`. @return all were good
  bool tuples(std::string_view text, const std::string& row, const char* each,
              std::vector<TrackPoint>& out) {
    bool good = true;
    constexpr std::string_view kXmlBlanks = " \t\r\n";
    for (std::size_t number = 1;; ++number) {
      const std::size_t begin = text.find_first_not_of(kXmlBlanks);
      if (begin == std::string_view::npos) return good;
      text.remove_prefix(begin);
      const std::string_view one = text.substr(0, text.find_first_of(kXmlBlanks));
      text.remove_prefix(one.size());
      std::string place = each != nullptr ? row + ", " + each + ' ' + std::to_string(number) : row;
      good &= tuple(one, std::move(place), each != nullptr ? each : "Point", ',', out);
    }
  }

  /// longitude, latitude and perhaps a height
  bool tuple(std::string_view text, std::string row, const char* what, char separator,
             std::vector<TrackPoint>& out) {
    constexpr std::string_view kXmlBlanks = " \t\r\n";
    const std::size_t begin = std::min(text.find_first_not_of(kXmlBlanks), text.size());
    text.remove_prefix(begin);
    while (!text.empty() && kXmlBlanks.find(text.back()) != std::string_view::npos) {
      text.remove_suffix(1);
    }
    std::vector<double> values;
    bool good = !text.empty();
    while (good && !text.empty() && values.size() < 3) {
      const auto value = take_number(text);
      good = value.has_value() && (text.empty() || text.front() == separator);
      if (value) values.push_back(*value);
      if (good && !text.empty()) text.remove_prefix(1);
    }
    if (!good || !text.empty() || values.size() < 2) {
      problems_.add(row, "must be longitude, latitude and perhaps a height");
      return false;
    }
    TrackPoint point{std::move(row), what, values[1], values[0]};
    if (values.size() > 2) point.alt_m = values[2];
    out.push_back(std::move(point));
    return true;
  }

  std::vector<std::string> path_;
  std::vector<std::string> rows_;
  bool is_kml_ = false;
  std::vector<TrackPoint> lines_;
  std::vector<TrackPoint> points_;
  std::vector<Shape> shapes_;
  std::string word_;
  nlohmann::json words_ = nlohmann::json::object();
  Fence fence_;
  ImportedFile file_;
  Problems problems_;
  TrackBuilder builder_{file_, problems_};
};

}  // namespace

Result<ImportedFile> read_kml(std::string_view content) {
  return KmlReader().read(content);
}

std::string write_kml(const Plan& plan, const Fence* fence, std::vector<FileRow>& rows) {
  report_left_out(plan, {true, false}, rows);
  constexpr int kDecimals = 9;
  std::string points;
  int count = 0;
  for (const Item& item : plan.items) {
    const auto* point = std::get_if<Waypoint>(&item);
    if (point == nullptr) continue;
    points += fixed_number(point->at.lon, kDecimals) + ',' + fixed_number(point->at.lat, kDecimals);
    if (point->alt_m) points += ',' + fixed_number(*point->alt_m, 0);
    points += '\n';
    ++count;
  }
  const std::string shape = count == 1 ? "Point" : "LineString";
  const std::string name = xml_escaped(plan.name);
  const std::string way = count == 0 ? ""
                                     : "<Placemark><name>" + name + "</name><" + shape +
                                           "><coordinates>\n" + points + "</coordinates></" +
                                           shape + "></Placemark>\n";
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
         "<kml xmlns=\"http://www.opengis.net/kml/2.2\">\n<Document>\n<name>" +
         name + "</name>\n" + way + (fence != nullptr ? kml_of(*fence) : std::string()) +
         "</Document>\n</kml>\n";
}

}  // namespace roverd::mission
