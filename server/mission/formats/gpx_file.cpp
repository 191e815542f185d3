// GPX 1.0 and 1.1: its routes; without one, its tracks; without one, its waypoints. A route is one
// way; so is each segment of a track ("to represent a single GPS track where GPS reception was
// lost, start a new Track Segment"), unless it begins where the one before it ends. What is not
// taken is told with the reason; extensions are looked into for speeds alone. Written as one route.

#include <charconv>
#include <cmath>
#include <utility>

#include "mission/formats/file_formats.hpp"
#include "mission/formats/track_points.hpp"
#include "mission/formats/xml.hpp"
#include "mission/text.hpp"

namespace roverd::mission {

namespace {

using base::Error;
using base::Result;

bool is_gpx_point(std::string_view element) {
  return element == "rtept" || element == "trkpt" || element == "wpt";
}

std::optional<double> number_in(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) return std::nullopt;
  text = text.substr(begin, text.find_last_not_of(" \t\r\n") - begin + 1);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (ec != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

class GpxReader {
 public:
  explicit GpxReader(bool leave_out_wrong) : builder_(file_, problems_, leave_out_wrong) {}

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
    return std::move(builder_).finish();
  }

 private:
  void begin(const XmlElement& element) {
    path_.emplace_back(element.name);
    if (path_.size() == 1) begin_document(element);
    if (extension_depth_ > 0) return;
    if (element.name == "extensions") extension_depth_ = path_.size();
    if (point_) return;
    if (element.name == "rte" || element.name == "trk") name_.clear();
    if (element.name == "rte") builder_.begin(PartKind::Route);
    if (element.name == "trkseg") builder_.begin(PartKind::Track);
    if (is_gpx_point(element.name)) begin_point(element);
  }

  void begin_document(const XmlElement& element) {
    is_gpx_ = element.name == "gpx";
    const std::string_view version = element.attribute("version");
    if (is_gpx_ && !version.empty() && version != "1.0" && version != "1.1") {
      problems_.add(element.row, "is of GPX version " + clean_name(version, "unknown") +
                                     "; 1.0 and 1.1 are known");
    }
  }

  void begin_point(const XmlElement& element) {
    TrackPoint& point = point_.emplace(TrackPoint{element.row, std::string(element.name)});
    point_depth_ = path_.size();
    const auto lat = number_in(element.attribute("lat"));
    const auto lon = number_in(element.attribute("lon"));
    point_good_ = lat && lon;
    if (!point_good_) {
      builder_.refuse(element.row, point.what, "lat and lon must be finite numbers");
    }
    point.lat = lat.value_or(0.0);
    point.lon = lon.value_or(0.0);
  }

  void end(std::string_view name, const std::string& text, const std::string&) {
    const std::size_t depth = path_.size();
    if (point_ && depth > point_depth_) {
      // A height is the point's own; a speed may stand in an extension, too.
      if ((name == "ele" && depth == point_depth_ + 1) || name == "speed") value(name, text);
    } else if (point_) {
      end_point(name);
    } else if (extension_depth_ == 0) {
      end_outside(name, text);
    }
    if (depth == extension_depth_) extension_depth_ = 0;
    path_.pop_back();
  }

  void end_point(std::string_view name) {
    // Waypoints are one list, wherever they stand.
    if (name == "wpt") builder_.begin(PartKind::Points);
    if (point_good_) builder_.add(std::move(*point_));
    if (name == "wpt") builder_.end_whole({});
    point_.reset();
  }

  void end_outside(std::string_view name, const std::string& text) {
    if (name == "rte" || name == "trk") builder_.end_whole(name_);
    if (name != "name" || path_.size() < 2) return;
    const std::string& parent = path_[path_.size() - 2];
    if (parent == "rte" || parent == "trk") name_ = text;
    if ((parent == "metadata" || parent == "gpx") && file_.plan.name.empty()) {
      file_.plan.name = text;
    }
  }

  void value(std::string_view name, const std::string& text) {
    const auto number = number_in(text);
    if (number) {
      (name == "ele" ? point_->alt_m : point_->speed_mps) = *number;
    } else {
      point_->note = name == "ele" ? "its height is no number" : "its speed is no number";
    }
  }

  std::vector<std::string> path_;
  bool is_gpx_ = false;
  std::string name_;                 ///< of the open route or track
  std::size_t extension_depth_ = 0;  ///< of the outermost open <extensions>; 0: none
  std::optional<TrackPoint> point_;  ///< the open one
  std::size_t point_depth_ = 0;
  bool point_good_ = false;
  ImportedFile file_;
  Problems problems_;
  TrackBuilder builder_;
};

}  // namespace

Result<ImportedFile> read_gpx(std::string_view content, const ImportHints& hints) {
  return GpxReader(hints.leave_out_wrong).read(content);
}

std::string write_gpx(const Plan& plan, std::vector<FileRow>& rows) {
  report_left_out(plan, {true, false}, rows);
  const auto positions = positions_of(plan);
  const std::string name = xml_escaped(plan.name);
  std::string out =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<gpx version=\"1.1\" creator=\"roverd\" xmlns=\"http://www.topografix.com/GPX/1/1\">\n"
      " <rte>\n  <name>" +
      name + "</name>\n";
  constexpr int kDecimals = 9;
  for (const Waypoint& point : positions) {
    out += "  <rtept lat=\"" + fixed_number(point.at.lat, kDecimals) + "\" lon=\"" +
           fixed_number(point.at.lon, kDecimals) + '"';
    out += point.alt_m ? "><ele>" + fixed_number(*point.alt_m, 0) + "</ele></rtept>\n" : "/>\n";
  }
  return out + " </rte>\n</gpx>\n";
}

}  // namespace roverd::mission
