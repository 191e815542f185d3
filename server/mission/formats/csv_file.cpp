// Tables of positions. Two forms, told apart by the head line, or without one by the number of
// columns:
//
//   lat,lon[,alt,speed]        degrees, m, m/s; the head line may name them in any order and case
//   x,y,z,yaw,velocity         the path follower's: m east and north of an origin, m, rad, m/s
//
// The origin stands in a comment before the rows, "# origin LAT LON", or is given with the call.
// Within 10 km of it x and y are those of the tangent plane; farther out, where that shrinks, they
// are direction and length of the way there (the two agree within 4 mm where they meet). A unit in
// the name of a column makes it that unit: km/h, mph, knots, feet. A height or speed that is empty
// or "nan" is not known; a speed of 0 is none of its own.

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/angle.hpp"
#include "base/tangent_plane.hpp"
#include "mission/formats/csv_table.hpp"
#include "mission/formats/file_formats.hpp"
#include "mission/formats/text_lines.hpp"
#include "mission/formats/track_points.hpp"
#include "mission/json/json.hpp"
#include "mission/text.hpp"

namespace roverd::mission {

namespace {

using base::Code;
using base::Error;
using base::Result;
using base::TangentPlane;

constexpr double kMpsOfKmh = 1.0 / 3.6;

enum class Column { Lat, Lon, Alt, Speed, X, Y, Other };
struct NamedColumn {
  Column column = Column::Other;
  double unit = 1.0;  ///< in m or m/s
};

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

/// Is `word` one of the words of the name, which are apart by whatever is no letter or digit?
bool has_word(std::string_view name, std::string_view word) {
  const auto is_part = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); };
  for (std::size_t at = name.find(word); at != std::string_view::npos;
       at = name.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    const bool begins = at == 0 || !is_part(name[at - 1]);
    if (begins && (end == name.size() || !is_part(name[end]))) return true;
  }
  return false;
}

bool has_word(std::string_view name, std::initializer_list<std::string_view> words) {
  return std::any_of(words.begin(), words.end(),
                     [&](std::string_view word) { return has_word(name, word); });
}

double speed_unit(std::string_view name) {
  constexpr double kMpsOfKnot = 1852.0 / 3600.0;
  constexpr double kMpsOfMph = 0.44704;
  if (name.find("km/h") != std::string_view::npos || has_word(name, {"kmh", "kph"})) {
    return kMpsOfKmh;
  }
  if (has_word(name, {"kn", "kt", "kts", "knot", "knots"})) return kMpsOfKnot;
  return has_word(name, "mph") ? kMpsOfMph : 1.0;
}

/// @param name in small letters
NamedColumn column_of(std::string_view name) {
  constexpr double kMetresOfFoot = 0.3048;
  if (has_word(name, {"lat", "latitude"})) return {Column::Lat};
  if (has_word(name, {"lon", "lng", "long", "longitude"})) return {Column::Lon};
  if (has_word(name, {"alt", "altitude", "ele", "elevation", "height", "z"})) {
    return {Column::Alt, has_word(name, {"ft", "feet", "foot"}) ? kMetresOfFoot : 1.0};
  }
  if (has_word(name, {"x", "east"})) return {Column::X};
  if (has_word(name, {"y", "north"})) return {Column::Y};
  if (name.starts_with("speed") || name.starts_with("velocity") || has_word(name, {"v", "vel"})) {
    return {Column::Speed, speed_unit(name)};
  }
  return {};
}

bool is_not_known(std::string_view text) {
  const std::string word = lower_case(text);
  return word.empty() || word == "nan" || word == "null" || word == "na" || word == "n/a" ||
         word == "-";
}

bool is_whole(std::string_view text) {
  const std::size_t digits = text.find_first_not_of("+-");
  return digits <= 1 && text.find_first_not_of("0123456789", digits) == std::string_view::npos;
}

class CsvReader {
 public:
  CsvReader(std::string_view content, const ImportHints& hints)
      : table_(content),
        origin_(hints.origin),
        kmh_(hints.kmh),
        builder_(file_, problems_, hints.leave_out_wrong) {}

  Result<ImportedFile> read() {
    while (table_.next()) {
      if (!table_.comment().empty()) {
        comment(table_.comment());
        continue;
      }
      const auto& fields = table_.fields();
      if (columns_.empty()) {
        const bool head = !table_.number(fields.front());
        if (!(head ? take_head(fields) : take_usual(fields.size()))) return no_table();
        if (head) continue;
      }
      row(fields);
    }
    if (table_.unclosed()) problems_.add(table_.place(), "opens a quote that is not closed");
    if (columns_.empty() && problems_.none()) return no_table();
    if (decimal_commas_ > 0 && !other_numbers_) {
      problems_.add(table_.place(),
                    "has whole numbers alone: with decimal commas fields must be apart by ';'");
    }
    return std::move(builder_).finish();
  }

 private:
  bool has(Column column) const { return count(column) > 0; }
  std::ptrdiff_t count(Column column) const {
    return std::count_if(columns_.begin(), columns_.end(),
                         [column](const NamedColumn& c) { return c.column == column; });
  }

  tl::unexpected<Error> no_table() const {
    const std::string where = table_.place();
    const std::string detail =
        "must name lat and lon, or x and y, each once, or hold 2 to 4 numbers (lat, lon, alt, "
        "speed) or 5 (x, y, z, yaw, velocity)";
    return base::fail(Code::Invalid, where + " " + detail, {{where, detail}});
  }

  bool take_head(const std::vector<CsvField>& fields) {
    for (const CsvField& field : fields) columns_.push_back(column_of(lower_case(field.text)));
    local_ = !(has(Column::Lat) && has(Column::Lon));
    for (std::size_t i = 0; i < fields.size(); ++i) {
      NamedColumn& at = columns_[i];
      const bool of_other_form = local_ ? at.column == Column::Lat || at.column == Column::Lon
                                        : at.column == Column::X || at.column == Column::Y;
      if (of_other_form) at = {};
      if (at.column == Column::Other) unused(clean_name(fields[i].text, "a column without a name"));
    }
    if (count(Column::Alt) > 1 || count(Column::Speed) > 1) return false;
    return local_ ? count(Column::X) == 1 && count(Column::Y) == 1
                  : count(Column::Lat) == 1 && count(Column::Lon) == 1;
  }

  bool take_usual(std::size_t count) {
    using enum Column;
    if (count == 5) {
      columns_ = {{X}, {Y}, {Alt}, {}, {Speed}};
      local_ = true;
      unused("yaw");
      return true;
    }
    constexpr std::array kUsual{NamedColumn{Lat}, NamedColumn{Lon}, NamedColumn{Alt},
                                NamedColumn{Speed}};
    if (count < 2 || count > kUsual.size()) return false;
    columns_.assign(kUsual.begin(), kUsual.begin() + static_cast<std::ptrdiff_t>(count));
    suspicious_ = count == kUsual.size() && table_.separator() == ',';
    return true;
  }

  void unused(std::string name) {
    builder_.leave_out(table_.place(), "column " + name, "a waypoint has no place for it");
  }

  void comment(std::string_view text) {
    const std::string copy = lower_case(text);
    const std::size_t at = copy.find("origin");
    const bool says =
        at != std::string::npos && copy.find_first_not_of("# \t") == at && copy.size() > at + 6;
    if (!says) return builder_.leave_out(table_.place(), "comment", "a comment");
    std::string_view rest = std::string_view(copy).substr(at + 6);
    if (rest.starts_with(':')) rest.remove_prefix(1);
    std::string numbers(rest);
    std::replace(numbers.begin(), numbers.end(), ',', ' ');
    CsvTable words(numbers);
    const bool any = words.next() && words.fields().size() >= 2;
    if (!any) return builder_.leave_out(table_.place(), "comment", "a comment");
    const auto lat = words.number(words.fields()[0]);
    const auto lon = words.number(words.fields()[1]);
    if (!lat || !lon || !base::is_valid({*lat, *lon})) {
      problems_.add(table_.place(), "origin must be a latitude and a longitude");
      return;
    }
    const LatLon origin{*lat, *lon};
    builder_.leave_out(table_.place(), "origin", "");
    file_.rows.back().outcome = Outcome::Taken;
    if (!origin_) {
      origin_ = origin;
    } else if (!(*origin_ == origin)) {
      file_.rows.back().outcome = Outcome::LeftOut;
      file_.rows.back().reason = "another origin was given before it";
    }
  }

  void row(const std::vector<CsvField>& fields) {
    const std::string place = table_.place();
    if (fields.size() != columns_.size()) {
      builder_.refuse(place, "row",
                      "must have " + std::to_string(columns_.size()) + " columns, has " +
                          std::to_string(fields.size()));
      return;
    }
    TrackPoint point{place, "row"};
    base::EnuPoint local;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const Column column = columns_[i].column;
      if (column == Column::Other) continue;
      const bool optional = column == Column::Alt || column == Column::Speed;
      if (optional && is_not_known(fields[i].text)) continue;
      const auto value = table_.number(fields[i]);
      if (!value) {
        builder_.refuse(place, "row",
                        "column " + std::to_string(i + 1) + " must be a finite number");
        return;
      }
      put(columns_[i], *value, point, local);
    }
    if (suspicious_) look_for_commas(fields);
    if (local_ && !place_locally(point, local)) return;
    builder_.add(std::move(point));
  }

  /// "58,37,26,72" without a head line may be two numbers or four.
  void look_for_commas(const std::vector<CsvField>& fields) {
    const bool whole = std::all_of(fields.begin(), fields.end(),
                                   [](const CsvField& field) { return is_whole(field.text); });
    (whole ? decimal_commas_ : other_numbers_) += 1;
  }

  void put(const NamedColumn& column, double value, TrackPoint& point,
           base::EnuPoint& local) const {
    switch (column.column) {
      case Column::Lat:
        point.lat = value;
        break;
      case Column::Lon:
        point.lon = value;
        break;
      case Column::Alt:
        point.alt_m = value * column.unit;
        break;
      case Column::Speed:
        if (value == 0.0) {
          point.note = "a speed of 0 is none of its own";
        } else {
          point.speed_mps = kmh_ && column.unit == 1.0 ? value / 3.6 : value * column.unit;
        }
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
    const double far_m = std::hypot(local.east_m, local.north_m);
    if (!(far_m <= kFarthest_m)) {
      builder_.refuse(point.row, point.what, "must lie within 20,000 km of the origin");
      return false;
    }
    if (!plane_) plane_.emplace(*origin_);
    const LatLon at = far_m <= base::LocalFrame::kReach_m
                          ? plane_->to_global(local)
                          : base::destination(*origin_, bearing_deg(local), far_m);
    point.lat = at.lat;
    point.lon = at.lon;
    return true;
  }

  static double bearing_deg(base::EnuPoint p) {
    return base::deg_from_rad(std::atan2(p.east_m, p.north_m));
  }

  /// Half way round the earth.
  static constexpr double kFarthest_m = 20'000'000.0;

  CsvTable table_;
  std::optional<LatLon> origin_;
  bool kmh_;
  bool local_ = false;
  bool suspicious_ = false;  ///< four columns without names, apart by commas
  std::size_t decimal_commas_ = 0;
  std::size_t other_numbers_ = 0;
  std::vector<NamedColumn> columns_;
  std::optional<TangentPlane> plane_;
  ImportedFile file_;
  Problems problems_;
  TrackBuilder builder_;
};

}  // namespace

bool looks_like_csv(std::string_view content) {
  CsvTable table(content);
  while (table.next()) {
    if (!table.comment().empty()) continue;
    const auto& fields = table.fields();
    if (fields.size() < 2) return false;
    if (table.number(fields[0])) return table.number(fields[1]).has_value() && fields.size() <= 5;
    std::array<bool, 7> has{};
    for (const CsvField& field : fields) {
      has[static_cast<std::size_t>(column_of(lower_case(field.text)).column)] = true;
    }
    const auto is = [&has](Column c) { return has[static_cast<std::size_t>(c)]; };
    return (is(Column::Lat) && is(Column::Lon)) || (is(Column::X) && is(Column::Y));
  }
  return false;
}

Result<ImportedFile> read_csv(std::string_view content, const ImportHints& hints) {
  return CsvReader(without_bom(content), hints).read();
}

}  // namespace roverd::mission
