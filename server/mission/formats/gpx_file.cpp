// GPX 1.1 (and 1.0): the points of its routes; without one, of its tracks; without one, its
// waypoints. Whatever is not taken is told with the reason. Written as one route.

#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "mission/formats/file_formats.hpp"
#include "mission/formats/track_points.hpp"
#include "mission/formats/xml.hpp"

namespace roverd::mission {

namespace {

using base::Error;
using base::Result;

enum class Kind { Route, Track, Waypoint };
constexpr std::array kKinds{Kind::Route, Kind::Track, Kind::Waypoint};

std::optional<Kind> kind_of(std::string_view element) {
  if (element == "rtept") return Kind::Route;
  if (element == "trkpt") return Kind::Track;
  if (element == "wpt") return Kind::Waypoint;
  return std::nullopt;
}

std::optional<double> number_in(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r\n+");
  if (begin == std::string_view::npos) return std::nullopt;
  text = text.substr(begin, text.find_last_not_of(" \t\r\n") - begin + 1);
  double value = 0.0;
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (ec != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

class GpxReader {
 public:
  Result<ImportedFile> read(std::string_view content) {
    XmlEvents events;
    events.begin = [this](const XmlElement& element) { begin(element); };
    events.end = [this](std::string_view name, const std::string& text, const std::string& row) {
      end(name, text, row);
    };
    if (auto done = read_xml(content, events); !done) return tl::unexpected<Error>(done.error());
    if (!is_gpx_) {
      return base::fail(base::Code::Invalid, "line 1 must begin a <gpx> document",
                        {{"line 1", "must begin a <gpx> document"}});
    }
    std::optional<Kind> chosen;
    for (const Kind kind : kKinds) {
      auto& points = points_[static_cast<std::size_t>(kind)];
      if (!chosen && !points.empty()) chosen = kind;
      for (TrackPoint& point : points) {
        if (chosen == kind) {
          builder_.add(std::move(point));
        } else {
          builder_.leave_out(std::move(point.row), std::move(point.what),
                             chosen == Kind::Route ? "the file's route is taken instead"
                                                   : "the file's track is taken instead");
        }
      }
    }
    return std::move(builder_).finish();
  }

 private:
  void begin(const XmlElement& element) {
    path_.emplace_back(element.name);
    if (path_.size() == 1) is_gpx_ = element.name == "gpx";
    kind_ = kind_of(element.name);
    if (!kind_ || point_) return;
    TrackPoint& point = point_.emplace(TrackPoint{element.row, std::string(element.name)});
    point_depth_ = path_.size();
    const auto lat = number_in(element.attribute("lat"));
    const auto lon = number_in(element.attribute("lon"));
    point_good_ = lat && lon;
    if (!point_good_) problems_.add(element.row, "lat and lon must be finite numbers");
    point.lat = lat.value_or(0.0);
    point.lon = lon.value_or(0.0);
  }

  void end(std::string_view name, const std::string& text, const std::string& row) {
    if (point_ && path_.size() > point_depth_) {
      if (name == "ele" || name == "speed") value(name, text, row);
    } else if (point_) {
      const auto kind = static_cast<std::size_t>(*kind_of(name));
      if (point_good_) points_[kind].push_back(std::move(*point_));
      point_.reset();
    } else if (name == "name" && file_.plan.name.empty()) {
      file_.plan.name = text;
    }
    path_.pop_back();
  }

  void value(std::string_view name, const std::string& text, const std::string& row) {
    const auto number = number_in(text);
    if (!number) return problems_.add(row, std::string(name) + " must be a finite number");
    (name == "ele" ? point_->alt_m : point_->speed_mps) = *number;
  }

  std::vector<std::string> path_;
  bool is_gpx_ = false;
  std::optional<Kind> kind_;
  std::optional<TrackPoint> point_;  ///< the open one
  std::size_t point_depth_ = 0;
  bool point_good_ = false;
  std::array<std::vector<TrackPoint>, kKinds.size()> points_;
  ImportedFile file_;
  Problems problems_;
  TrackBuilder builder_{file_, problems_};
};

}  // namespace

Result<ImportedFile> read_gpx(std::string_view content) {
  return GpxReader().read(content);
}

std::string write_gpx(const Plan& plan, std::vector<FileRow>& rows) {
  report_left_out(plan, {true, false}, rows);
  const std::string name = xml_escaped(plan.name);
  std::string out =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<gpx version=\"1.1\" creator=\"roverd\" xmlns=\"http://www.topografix.com/GPX/1/1\">\n"
      " <rte>\n  <name>" +
      name + "</name>\n";
  constexpr int kDecimals = 9;
  for (const Item& item : plan.items) {
    const auto* point = std::get_if<Waypoint>(&item);
    if (point == nullptr) continue;
    out += "  <rtept lat=\"" + fixed_number(point->at.lat, kDecimals) + "\" lon=\"" +
           fixed_number(point->at.lon, kDecimals) + '"';
    out += point->alt_m ? "><ele>" + fixed_number(*point->alt_m, 0) + "</ele></rtept>\n" : "/>\n";
  }
  return out + " </rte>\n</gpx>\n";
}

}  // namespace roverd::mission
