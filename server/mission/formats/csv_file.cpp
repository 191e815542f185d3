// Tables of positions. Two forms, told apart by the head line, or without one by the number of
// columns:
//
//   lat,lon[,alt,speed]        degrees, m, m/s; the head line may name them in any order and case
//   x,y,z,yaw,velocity         the path follower's: m east and north of an origin, m, rad, m/s
//
// The origin stands in a comment before the rows, "# origin LAT LON", or is given with the call.
// "km/h" or "kmh" in the name of the speed's column makes it that unit. Fields are apart by comma,
// semicolon, tab or blanks; '#' begins a comment.

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "base/angle.hpp"
#include "base/tangent_plane.hpp"
#include "mission/formats/file_formats.hpp"
#include "mission/formats/text_lines.hpp"
#include "mission/formats/track_points.hpp"

namespace roverd::mission {

namespace {

using base::Code;
using base::Error;
using base::Result;
using base::TangentPlane;

constexpr std::size_t kMaxColumns = 32;
constexpr double kKmh = 3.6;

enum class Column { Lat, Lon, Alt, Speed, X, Y, Other };

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\"");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\"") - begin + 1);
}

std::optional<double> number_of(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (ec != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

char separator_of(std::string_view line) {
  for (const char c : {';', ',', '\t'}) {
    if (line.find(c) != std::string_view::npos) return c;
  }
  return ' ';
}

std::vector<std::string_view> fields_of(std::string_view line, char separator) {
  std::vector<std::string_view> out;
  while (out.size() <= kMaxColumns) {
    if (separator == ' ') {
      const std::size_t begin = line.find_first_not_of(' ');
      if (begin == std::string_view::npos) return out;
      line.remove_prefix(begin);
    }
    const std::size_t end = line.find(separator);
    out.push_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) return out;
    line.remove_prefix(end + 1);
  }
  return out;
}

Column column_of(const std::string& name) {
  const auto is = [&name](std::initializer_list<std::string_view> words) {
    return std::find(words.begin(), words.end(), name) != words.end();
  };
  if (is({"lat", "latitude", "lat_deg"})) return Column::Lat;
  if (is({"lon", "lng", "long", "longitude", "lon_deg"})) return Column::Lon;
  if (is({"alt", "altitude", "alt_m", "ele", "elevation", "height"})) return Column::Alt;
  if (is({"x", "east", "east_m"})) return Column::X;
  if (is({"y", "north", "north_m"})) return Column::Y;
  if (name.starts_with("speed") || name.starts_with("velocity") || name == "v") {
    return Column::Speed;
  }
  return Column::Other;
}

class CsvReader {
 public:
  CsvReader(std::string_view content, const ImportHints& hints)
      : lines_(without_bom(content)), origin_(hints.origin), kmh_(hints.kmh) {}

  Result<ImportedFile> read() {
    std::string_view line;
    while (lines_.next(line)) {
      const std::string_view text = trimmed(line);
      if (text.empty()) continue;
      if (text.front() == '#') {
        comment(text);
        continue;
      }
      const auto fields = fields_of(line, separator_of(line));
      if (columns_.empty()) {
        const bool head = !number_of(fields.front());
        if (!(head ? take_head(fields) : take_usual(fields.size()))) return no_table();
        if (head) continue;
      }
      row(fields);
    }
    if (columns_.empty()) return no_table();
    return std::move(builder_).finish();
  }

 private:
  bool has(Column column) const {
    return std::find(columns_.begin(), columns_.end(), column) != columns_.end();
  }

  tl::unexpected<Error> no_table() const {
    const std::string where = lines_.place();
    const std::string detail =
        "must name lat and lon, or x and y, or hold 2 to 4 numbers (lat, lon, alt, speed) or 5 "
        "(x, y, z, yaw, velocity)";
    return base::fail(Code::Invalid, where + " " + detail, {{where, detail}});
  }

  bool take_head(const std::vector<std::string_view>& fields) {
    for (const std::string_view field : fields) {
      const std::string name = lower_case(field);
      columns_.push_back(column_of(name));
      if (columns_.back() == Column::Speed &&
          (name.find("kmh") != std::string::npos || name.find("km/h") != std::string::npos)) {
        kmh_ = true;
      }
      if (columns_.back() == Column::Other) unused(clean_name(field, "a column without a name"));
    }
    local_ = !(has(Column::Lat) && has(Column::Lon));
    return !local_ || (has(Column::X) && has(Column::Y));
  }

  bool take_usual(std::size_t count) {
    using enum Column;
    if (count == 5) {
      columns_ = {X, Y, Other, Other, Speed};
      local_ = true;
      unused("z");
      unused("yaw");
      return true;
    }
    constexpr std::array kUsual{Lat, Lon, Alt, Speed};
    if (count < 2 || count > kUsual.size()) return false;
    columns_.assign(kUsual.begin(), kUsual.begin() + static_cast<std::ptrdiff_t>(count));
    return true;
  }

  void unused(std::string name) {
    builder_.leave_out(lines_.place(), "column " + name, "a waypoint has no place for it");
  }

  void comment(std::string_view text) {
    const std::string copy = lower_case(text);
    const auto parts = fields_of(copy, ' ');
    const auto at = std::find_if(parts.begin(), parts.end(), [](std::string_view word) {
      return word == "origin" || word == "#origin" || word == "origin:";
    });
    if (parts.end() - at >= 3) {
      const auto without_comma = [](std::string_view word) {
        return word.ends_with(',') ? word.substr(0, word.size() - 1) : word;
      };
      const auto lat = number_of(without_comma(at[1]));
      const auto lon = number_of(without_comma(at[2]));
      if (!lat || !lon || !base::is_valid({*lat, *lon})) {
        problems_.add(lines_.place(), "origin must be a latitude and a longitude");
        return;
      }
      if (!origin_) origin_ = LatLon{*lat, *lon};
      builder_.leave_out(lines_.place(), "origin", "");
      file_.rows.back().outcome = Outcome::Taken;
      return;
    }
    builder_.leave_out(lines_.place(), "comment", "a comment");
  }

  void row(const std::vector<std::string_view>& fields) {
    const std::string place = lines_.place();
    if (fields.size() != columns_.size()) {
      problems_.add(place, "must have " + std::to_string(columns_.size()) + " columns, has " +
                               std::to_string(fields.size()));
      return;
    }
    TrackPoint point{place, "row"};
    base::EnuPoint local;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (columns_[i] == Column::Other) continue;
      const bool optional = columns_[i] == Column::Alt || columns_[i] == Column::Speed;
      if (optional && fields[i].empty()) continue;
      const auto value = number_of(fields[i]);
      if (!value) {
        problems_.add(place, "column " + std::to_string(i + 1) + " must be a finite number");
        return;
      }
      put(columns_[i], *value, point, local);
    }
    if (local_ && !place_locally(point, local)) return;
    builder_.add(std::move(point));
  }

  void put(Column column, double value, TrackPoint& point, base::EnuPoint& local) const {
    switch (column) {
      case Column::Lat:
        point.lat = value;
        break;
      case Column::Lon:
        point.lon = value;
        break;
      case Column::Alt:
        point.alt_m = value;
        break;
      case Column::Speed:
        if (value != 0.0) point.speed_mps = kmh_ ? value / kKmh : value;  // 0: none of its own
        break;
      case Column::X:
        local.east_m = value;
        break;
      case Column::Y:
        local.north_m = value;
        break;
      case Column::Other:
        break;
    }
  }

  bool place_locally(TrackPoint& point, base::EnuPoint local) {
    if (!origin_) {
      problems_.add(point.row,
                    "needs an origin: a line \"# origin LAT LON\" before it, or origin_lat and "
                    "origin_lon with the call");
      return false;
    }
    if (!(std::hypot(local.east_m, local.north_m) <= base::LocalFrame::kReach_m)) {
      problems_.add(point.row, "must lie within 10 km of the origin");
      return false;
    }
    if (!plane_) plane_.emplace(*origin_);
    const LatLon at = plane_->to_global(local);
    point.lat = at.lat;
    point.lon = at.lon;
    return true;
  }

  TextLines lines_;
  std::optional<LatLon> origin_;
  bool kmh_;
  bool local_ = false;
  std::vector<Column> columns_;
  std::optional<TangentPlane> plane_;
  ImportedFile file_;
  Problems problems_;
  TrackBuilder builder_{file_, problems_};
};

std::optional<LatLon> origin_of(const Plan& plan) {
  if (plan.home) return plan.home->at;
  for (const Item& item : plan.items) {
    if (const auto* point = std::get_if<Waypoint>(&item)) return point->at;
  }
  return std::nullopt;
}

}  // namespace

bool looks_like_csv(std::string_view content) {
  TextLines lines(content);
  std::string_view line;
  while (lines.next(line)) {
    const std::string_view text = trimmed(line);
    if (text.empty() || text.front() == '#') continue;
    const auto fields = fields_of(line, separator_of(line));
    if (fields.size() < 2) return false;
    if (number_of(fields[0])) return number_of(fields[1]).has_value() && fields.size() <= 5;
    std::vector<Column> columns;
    for (const std::string_view field : fields) columns.push_back(column_of(lower_case(field)));
    const auto has = [&columns](Column c) {
      return std::find(columns.begin(), columns.end(), c) != columns.end();
    };
    return (has(Column::Lat) && has(Column::Lon)) || (has(Column::X) && has(Column::Y));
  }
  return false;
}

Result<ImportedFile> read_csv(std::string_view content, const ImportHints& hints) {
  return CsvReader(content, hints).read();
}

std::string write_csv(const Plan& plan, std::vector<FileRow>& rows) {
  report_left_out(plan, {true, true}, rows);
  std::string out = "lat,lon,alt,speed\n";
  for (const Item& item : plan.items) {
    const auto* point = std::get_if<Waypoint>(&item);
    if (point == nullptr) continue;
    constexpr int kDecimals = 9;
    out += fixed_number(point->at.lat, kDecimals) + ',' + fixed_number(point->at.lon, kDecimals);
    out += ',';
    if (point->alt_m) append_number(out, *point->alt_m);
    out += ',';
    if (point->speed_mps) append_number(out, *point->speed_mps);
    out += '\n';
  }
  return out;
}

std::string write_follower(const Plan& plan, std::vector<FileRow>& rows) {
  report_left_out(plan, {false, true}, rows);
  std::string out;
  std::vector<base::EnuPoint> points;
  std::vector<double> speeds;
  if (const auto origin = origin_of(plan)) {
    constexpr int kDecimals = 9;
    out += "# origin " + fixed_number(origin->lat, kDecimals) + ' ' +
           fixed_number(origin->lon, kDecimals) + '\n';
    const TangentPlane plane(*origin);
    for (const Item& item : plan.items) {
      const auto* point = std::get_if<Waypoint>(&item);
      if (point == nullptr) continue;
      points.push_back(plane.to_local(point->at));
      speeds.push_back(point->speed_mps.value_or(plan.settings.speed_mps.value_or(0.0)));
    }
  }
  out += "x,y,z,yaw,velocity\n";
  double yaw_rad = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i + 1 < points.size()) {  // the last one looks where the way came from
      const base::EnuPoint way = points[i + 1] - points[i];
      if (std::hypot(way.east_m, way.north_m) > 0.0) yaw_rad = std::atan2(way.north_m, way.east_m);
    }
    for (const double value : {points[i].east_m, points[i].north_m, 0.0, yaw_rad}) {
      append_number(out, value);
      out += ',';
    }
    append_number(out, speeds[i]);
    out += '\n';
  }
  return out;
}

}  // namespace roverd::mission
