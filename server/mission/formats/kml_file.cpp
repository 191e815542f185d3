// KML 2.0 to 2.3: its lines (LineString, LinearRing, gx:Track); without one, its Points. Each line
// is a way of its own, unless it stands in one Placemark with the one before it and begins where
// that ends. Polygons are areas that can be covered, or, if their Placemark says so, fences (see
// kml_fence.hpp). Links to other documents are followed inside of a KMZ archive. Written as one
// Placemark with a LineString, a Point if there is only one.

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <deque>
#include <set>
#include <utility>

#include "mission/formats/field_area.hpp"
#include "mission/formats/file_formats.hpp"
#include "mission/formats/kml_fence.hpp"
#include "mission/formats/track_points.hpp"
#include "mission/formats/xml.hpp"
#include "mission/json/json.hpp"
#include "mission/text.hpp"

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

constexpr std::string_view kXmlBlanks = " \t\r\n";

/// "./layers/a.kml#view" → "layers/a.kml".
std::string file_of(std::string_view href) {
  href.remove_prefix(std::min(href.find_first_not_of(kXmlBlanks), href.size()));
  href = href.substr(0, href.find_first_of("#?"));
  href = href.substr(0, href.find_last_not_of(kXmlBlanks) + 1);
  while (href.starts_with("./")) href.remove_prefix(2);
  return std::string(href);
}

/// A position in coordinates: up to the next blank.
std::string_view take_word(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(kXmlBlanks), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(kXmlBlanks));
  text.remove_prefix(word.size());
  return word;
}

/// KML has no blanks inside a position, some programs do: "26.7, 58.3, 0". Such a text without the
/// blanks at its commas; any other as it stands, for "26.7,58.3, 26.8,58.4" is two positions.
std::string joined_at_commas(std::string_view text) {
  bool in_pieces = false;
  for (std::string_view rest = text, word = take_word(rest); !word.empty();
       word = take_word(rest)) {
    const std::size_t comma = word.find(',');
    in_pieces =
        in_pieces || comma == 0 || comma == std::string_view::npos || comma + 1 == word.size();
  }
  if (!in_pieces) return std::string(text);
  std::string out;
  for (std::string_view rest = text, word = take_word(rest); !word.empty();
       word = take_word(rest)) {
    if (!out.empty() && out.back() != ',' && word.front() != ',') out += ' ';
    out += word;
  }
  return out;
}

/// Geometry and features that are nothing to drive.
bool is_picture(std::string_view element) {
  return element == "GroundOverlay" || element == "ScreenOverlay" || element == "PhotoOverlay" ||
         element == "Model" || element == "Tour";
}

/// "2.9" of a namespace that says so; empty: known, or none.
std::string_view unknown_kml_version(std::string_view name_space) {
  for (const std::string_view begin :
       {"http://www.opengis.net/kml/", "http://earth.google.com/kml/",
        "https://www.opengis.net/kml/"}) {
    if (!name_space.starts_with(begin)) continue;
    const std::string_view version = name_space.substr(begin.size());
    const bool known = version == "2.0" || version == "2.1" || version == "2.2" ||
                       version == "2.3" || version == "2.x";
    return known ? std::string_view{} : version.empty() ? "?" : version;
  }
  return {};
}

class KmlReader {
 public:
  explicit KmlReader(bool leave_out_wrong) : builder_(file_, problems_, leave_out_wrong) {}

  /// The file, and what it links to, as far as `linked` has it.
  Result<ImportedFile> read(std::string_view content, const LinkedKml& linked) {
    if (auto done = read_document(content); !done) return tl::unexpected<Error>(done.error());
    while (linked && !links_.empty()) {
      const Link link = std::move(links_.front());
      links_.pop_front();
      if (!read_.insert(link.href).second) continue;
      const auto text = linked(link.href);
      if (!text) {
        builder_.leave_out(link.row, "NetworkLink", "what it links to is not in the archive");
        continue;
      }
      within_ = clean_name(link.href, "a linked file") + ", ";
      if (auto done = read_document(*text); !done) {
        return base::fail(done.error().code, within_ + done.error().detail, done.error().fields);
      }
    }
    const bool links = !links_.empty() || !read_.empty();
    for (const Link& link : links_) {
      builder_.leave_out(link.row, "NetworkLink",
                         "it leads to another file, which is read inside of a KMZ archive alone");
    }
    if (!fence_.areas.empty() || !fence_.rally.empty()) file_.fence = std::move(fence_);
    const bool nothing = builder_.count() == 0 && file_.areas.empty() && !file_.fence;
    if (nothing && links && problems_.none()) {
      return base::fail(
          base::Code::Invalid,
          "the file has no position that could be driven to: its NetworkLink leads to "
          "another file, which is not read",
          {{"", "has no position"}});
    }
    return std::move(builder_).finish();
  }

 private:
  struct Link {
    std::string row;
    std::string href;
  };

  Result<void> read_document(std::string_view content) {
    XmlEvents events;
    events.begin = [this](const XmlElement& element) { begin(element); };
    events.end = [this](std::string_view name, const std::string& text, const std::string&) {
      end(name, text);
    };
    path_.clear();
    rows_.clear();
    is_kml_ = false;
    if (auto done = read_xml(content, events); !done) return done;
    end_placemark();  // shapes outside of one
    if (is_kml_) return {};
    return base::fail(base::Code::Invalid, "line 1 must begin a <kml> document",
                      {{"line 1", "must begin a <kml> document"}});
  }

  /// Of the Placemark that is being read. What it is is told by its words, which may come last.
  struct Shape {
    std::string row;
    std::vector<std::string> rings;  ///< of a Polygon, as they stand there; the outer one first
    std::optional<TrackPoint> point;
    bool no_position = false;  ///< a Point whose position cannot be read
  };

  void begin(const XmlElement& element) {
    path_.emplace_back(element.name);
    rows_.push_back(within_ + element.row);
    if (path_.size() == 1) begin_kml(element);
    if (element.name == "NetworkLink") links_.push_back({rows_.back(), {}});
    if (element.name == "Placemark") {
      words_ = nlohmann::json::object();
      name_.clear();
    }
    if (element.name == "Polygon") {
      shapes_.push_back({rows_.back(), {}, std::nullopt, false});
      in_polygon_ = true;
    }
    if (element.name == "Track") {
      line_ = true;
      builder_.begin(PartKind::Line);
    }
    if (element.name == "Data" || element.name == "SimpleData") word_ = element.attribute("name");
  }

  void begin_kml(const XmlElement& element) {
    is_kml_ = element.name == "kml";
    const std::string_view version = unknown_kml_version(element.name_space());
    if (version.empty()) return;
    problems_.add(element.row,
                  "is of KML version " + clean_name(version, "unknown") + "; 2.0 to 2.3 are known");
  }

  void end(std::string_view name, const std::string& text) {
    path_.pop_back();
    const std::string row = std::move(rows_.back());
    rows_.pop_back();
    const std::string_view inside = path_.empty() ? std::string_view{} : path_.back();
    if (name == "coordinates") coordinates(text, row, inside);
    if (name == "coord" && inside == "Track") track_point(text, row);
    if (name == "name" && inside == "Placemark") name_ = text;
    if (name == "name" && (inside == "Document" || inside == "Folder") && file_.plan.name.empty()) {
      file_.plan.name = text;
    }
    if (name == "SimpleData" || (name == "value" && inside == "Data")) {
      set_kml_word(words_, word_, text);
    }
    if (name == "Polygon") in_polygon_ = false;
    if (name == "href" && in_link()) links_.back().href = file_of(text);
    if (is_picture(name)) builder_.leave_out(row, std::string(name), "it is nothing to drive");
    if (name == "Placemark") {
      ask_for_shape(row);
      end_placemark();
    }
  }

  /// Of <NetworkLink><Link><href>, or <Url> in older files.
  bool in_link() const {
    return path_.size() >= 2 && (path_.back() == "Link" || path_.back() == "Url") &&
           path_[path_.size() - 2] == "NetworkLink" && !links_.empty();
  }

  /// A line that is meant as a fence is not to be driven, and what has no shape keeps nobody out.
  void ask_for_shape(const std::string& row) {
    if (!is_kml_fence(words_) || (!shapes_.empty() && !line_)) return;
    take_fence_feature(words_, nlohmann::json::object(), {row, row}, fence_, file_.rows, problems_);
  }

  void end_placemark() {
    for (Shape& shape : shapes_) {
      if (shape.no_position) {
        refuse_point(shape);
      } else if (is_kml_fence(words_)) {
        take_fence(shape);
      } else if (shape.point) {
        builder_.begin(PartKind::Points);
        builder_.add(std::move(*shape.point));
      } else {
        take_area(shape);
      }
    }
    builder_.end_whole(name_);
    shapes_.clear();
    line_ = false;
    in_polygon_ = false;  // a Placemark inside a Polygon, which no schema allows, ends both
    name_.clear();
    words_ = nlohmann::json::object();
  }

  /// A fence or a rally point is never left out.
  void refuse_point(Shape& shape) {
    if (is_kml_fence(words_)) return problems_.add(std::move(shape.row), kNoPosition);
    builder_.refuse(std::move(shape.row), kPoint, kNoPosition);
  }

  /// A gx:coord; KML 2.3 lets it be empty where the receiver had no position.
  void track_point(const std::string& text, const std::string& row) {
    if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
      return builder_.leave_out(row, "gx:coord", "it has no position");
    }
    if (auto point = tuple(text, row, "gx:coord", ' ')) builder_.add(std::move(*point));
  }

  void take_area(const Shape& shape) {
    FieldArea area{name_, shape.row, {}};
    for (const std::string& text : shape.rings) {
      auto& ring = area.rings.emplace_back();
      const bool good = tuples(text, shape.row, kCorner, [&](const TrackPoint& corner) {
        ring.push_back({corner.lat, corner.lon});
        return ring.size() <= kMaxItems;
      });
      if (!good) return;
      if (ring.size() > kMaxItems) return problems_.add(shape.row, "has too many corners");
    }
    take_field_area(std::move(area), "Polygon", file_, problems_);
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
        auto& ring = rings.emplace_back(nlohmann::json::array());
        const bool good = tuples(text, shape.row, kCorner, [&](const TrackPoint& corner) {
          ring.push_back(position(corner));
          return ring.size() <= kMaxFencePoints + 1;
        });
        if (!good) return;
      }
      found = {{"type", "Polygon"}, {"coordinates", std::move(rings)}};
    }
    take_fence_feature(words_, found, {shape.row, shape.row}, fence_, file_.rows, problems_);
  }

  void coordinates(const std::string& text, const std::string& row, std::string_view inside) {
    if (inside == "LinearRing" && in_polygon_) {
      shapes_.back().rings.push_back(text);
    } else if (inside == "LineString" || inside == "LinearRing") {
      line_ = true;
      builder_.begin(PartKind::Line);
      tuples(text, row, "coordinate", [this](TrackPoint point) {
        builder_.add(std::move(point));
        return true;
      });
    } else if (inside == "Point") {
      auto point = tuple(joined_at_commas(text), row, kPoint, ',');
      if (point) shapes_.push_back({row, {}, std::move(*point), false});
    }
  }

  /// Calls `take` for each position until it is enough: false. @param each what one is called
  /// @return all were good
  template <class Take>
  bool tuples(std::string_view text, const std::string& row, const std::string& each, Take take) {
    bool good = true;
    const std::string joined = joined_at_commas(text);
    std::string_view rest = joined;
    for (std::size_t number = 1;; ++number) {
      const std::string_view one = take_word(rest);
      if (one.empty()) return good;
      std::string place = row + ", " + each + ' ' + std::to_string(number);
      auto point = tuple(one, std::move(place), each, ',');
      good = good && point.has_value();
      if (point && !take(std::move(*point))) return good;
    }
  }

  /// A shape without one of its corners is another shape: those are never left out. What a Point is
  /// the words of its Placemark tell, which may come later.
  void no_position(std::string row, std::string what) {
    if (what == kCorner) return problems_.add(std::move(row), kNoPosition);
    if (what == kPoint) return void(shapes_.push_back({std::move(row), {}, std::nullopt, true}));
    builder_.refuse(std::move(row), std::move(what), kNoPosition);
  }

  /// longitude, latitude and perhaps a height; what more there is is told
  std::optional<TrackPoint> tuple(std::string_view text, std::string row, std::string what,
                                  char separator) {
    const std::size_t begin = std::min(text.find_first_not_of(kXmlBlanks), text.size());
    text.remove_prefix(begin);
    while (!text.empty() && kXmlBlanks.find(text.back()) != std::string_view::npos) {
      text.remove_suffix(1);
    }
    std::array<double, 3> values{};
    std::size_t count = 0;
    bool good = !text.empty();
    while (good && !text.empty()) {
      const auto value = take_number(text);
      good = value.has_value() && (text.empty() || text.front() == separator);
      if (value && count < values.size()) values[count] = *value;
      ++count;
      while (good && !text.empty() && text.front() == separator) {
        text.remove_prefix(1);
        if (separator != ' ') break;
      }
    }
    if (!good || count < 2) {
      no_position(std::move(row), std::move(what));
      return std::nullopt;
    }
    TrackPoint point{std::move(row), std::move(what), values[1], values[0]};
    if (count > 2) point.alt_m = values[2];
    if (count > values.size()) {
      point.note = "of its " + std::to_string(count) + " numbers the first three are kept";
    }
    return point;
  }

  static constexpr const char* kCorner = "corner";
  static constexpr const char* kPoint = "Point";
  static constexpr const char* kNoPosition = "must be longitude, latitude and perhaps a height";

  std::vector<std::string> path_;
  std::vector<std::string> rows_;
  std::deque<Link> links_;      ///< that were found and not read
  std::set<std::string> read_;  ///< links that were
  std::string within_;          ///< "layers/a.kml, " while a linked document is read
  bool is_kml_ = false;
  bool in_polygon_ = false;
  std::string name_;  ///< of the open Placemark
  std::vector<Shape> shapes_;
  std::string word_;
  bool line_ = false;  ///< the Placemark has a way
  nlohmann::json words_ = nlohmann::json::object();
  Fence fence_;
  ImportedFile file_;
  Problems problems_;
  TrackBuilder builder_;
};

}  // namespace

Result<ImportedFile> read_kml(std::string_view content, const ImportHints& hints,
                              const LinkedKml& linked) {
  return KmlReader(hints.leave_out_wrong).read(content, linked);
}

std::string write_kml(const Plan& plan, const Fence* fence, std::vector<FileRow>& rows) {
  report_left_out(plan, {true, false}, rows);
  const auto positions = positions_of(plan);
  constexpr int kDecimals = 9;
  std::string points;
  int count = 0;
  for (const Waypoint& point : positions) {
    points += fixed_number(point.at.lon, kDecimals) + ',' + fixed_number(point.at.lat, kDecimals);
    if (point.alt_m) points += ',' + fixed_number(*point.alt_m, 0);
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
