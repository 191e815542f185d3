// Tables of positions. Two forms, told apart by the head line, or without one by the number of
// columns:
//
//   lat,lon[,alt,speed]        degrees, m, m/s; the head line may name them in any order and case
//   x,y,z,yaw,velocity         the path follower's: m east and north of an origin, m, rad, m/s
//
// The origin stands in a comment before the rows, "# origin LAT LON", or is given with the call.
// Within 10 km of it x and y are those of the tangent plane; farther out, where that shrinks, they
// are direction and length of the way there (the two agree within 4 mm where they meet). What the
// names of the columns say of their units holds (csv_columns.hpp); a height or speed in a unit that
// is not known is left out. One that is empty or "nan" is not known; a speed of 0 is none of its
// own.

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/angle.hpp"
#include "base/tangent_plane.hpp"
#include "mission/formats/csv_columns.hpp"
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

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
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

/// As angles in degrees and minutes have them.
bool has_marks(std::string_view text) {
  return std::any_of(text.begin(), text.end(), [](char c) {
    return static_cast<unsigned char>(c) >= 0x80U || c == ':' || c == '\'' || c == '"' || c == ' ';
  });
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
        if (counts_rows()) return counted();
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

  tl::unexpected<Error> refuse(const std::string& detail) const {
    const std::string where = table_.place();
    return base::fail(Code::Invalid, where + " " + detail, {{where, detail}});
  }

  tl::unexpected<Error> no_table() const {
    return refuse(why_none_.empty() ? "must name lat and lon, or x and y, each once, or hold 2 to "
                                      "4 numbers (lat, lon, alt, "
                                      "speed) or 5 (x, y, z, yaw, velocity)"
                                    : "must name lat and lon, or x and y, each once: " + why_none_);
  }

  /// Of several columns for one thing the surest one stays, if there is one.
  void keep_surest(Column column, const std::vector<CsvField>& fields) {
    auto surest = Fit::Not;
    for (const NamedColumn& c : columns_) {
      if (c.column == column) surest = std::min(surest, c.fit);
    }
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      NamedColumn& at = columns_[i];
      if (at.column != column || (at.fit == surest && surest != Fit::Not)) continue;
      const std::string name = clean_name(fields[i].text, "a column without a name");
      const bool position = column != Column::Alt && column != Column::Speed;
      if (at.fit == Fit::Not && position && (why_none_.empty() || (at.part && !in_parts_))) {
        why_none_ = "column " + name + ' ' + at.why;
      }
      in_parts_ = in_parts_ || at.part;
      unused(name, at.fit == Fit::Not ? at.why : "another column fits better");
      at = {};
    }
  }

  bool take_head(const std::vector<CsvField>& fields) {
    for (const CsvField& field : fields) columns_.push_back(column_of(field.text));
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (columns_[i].column == Column::Other) unused(fields[i]);
    }
    for (const Column c :
         {Column::Lat, Column::Lon, Column::X, Column::Y, Column::Alt, Column::Speed}) {
      keep_surest(c, fields);
    }
    local_ = !(has(Column::Lat) && has(Column::Lon));
    for (std::size_t i = 0; i < fields.size(); ++i) {
      NamedColumn& at = columns_[i];
      const bool of_other_form = local_ ? at.column == Column::Lat || at.column == Column::Lon
                                        : at.column == Column::X || at.column == Column::Y;
      if (of_other_form) {
        at = {};
        unused(fields[i]);
      }
    }
    if (count(Column::Alt) > 1 || count(Column::Speed) > 1 || (in_parts_ && !local_)) return false;
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
    constexpr std::array kUsual{Lat, Lon, Alt, Speed};
    if (count < 2 || count > kUsual.size()) return false;
    for (std::size_t i = 0; i < count; ++i) columns_.push_back({kUsual[i]});
    suspicious_ = count == kUsual.size() && table_.separator() == ',';
    return true;
  }

  void unused(const std::string& name, std::string reason = "a waypoint has no place for it") {
    builder_.leave_out(table_.place(), "column " + name, std::move(reason));
  }
  void unused(const CsvField& field) { unused(clean_name(field.text, "a column without a name")); }

  /// Without a head: is the first column whole in all rows, as a count is, and the next two are
  /// not? "1,58.378,26.729" is no latitude of 1 degree.
  bool counts_rows() const {
    if (columns_.size() < 3 || columns_.size() > 4) return false;
    CsvTable rows = table_;
    std::array<bool, 2> parts{};
    do {
      const auto& fields = rows.fields();
      if (!rows.comment().empty()) continue;
      if (fields.size() < 3 || !is_whole(fields[0].text)) return false;
      for (std::size_t i = 0; i < parts.size(); ++i) {
        parts[i] = parts[i] || !is_whole(fields[i + 1].text);
      }
    } while (rows.next());
    return parts[0] && parts[1];
  }

  tl::unexpected<Error> counted() const {
    return refuse(
        "begins with a whole number, as all rows do: if it counts them, put a line before that "
        "names the columns (number,lat,lon)");
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
      const auto value = value_of(columns_[i], fields[i]);
      if (!value) {
        const bool angle =
            (column == Column::Lat || column == Column::Lon) && has_marks(fields[i].text);
        builder_.refuse(place, "row",
                        "column " + std::to_string(i + 1) + " must be a finite number" +
                            (angle ? ", or degrees, minutes and seconds" : ""));
        return;
      }
      put(columns_[i], *value, point, local);
    }
    if (suspicious_) look_for_commas(fields);
    if (local_ && !place_locally(point, local)) return;
    builder_.add(std::move(point));
  }

  std::optional<double> value_of(const NamedColumn& column, const CsvField& field) const {
    const auto number = table_.number(field);
    const bool lat = column.column == Column::Lat;
    if (number || column.unit != 1.0 || (!lat && column.column != Column::Lon)) return number;
    double angle_deg = 0.0;
    const bool read = read_angle(field.text, lat ? 'N' : 'E', lat ? 'S' : 'W', angle_deg);
    return read ? std::optional(angle_deg) : std::nullopt;
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
        point.lat = value * column.unit;
        break;
      case Column::Lon:
        point.lon = value * column.unit;
        break;
      case Column::Alt:
        point.alt_m = value * column.unit;
        break;
      case Column::Speed:
        if (value == 0.0) {
          point.note = "a speed of 0 is none of its own";
        } else {
          point.speed_mps = kmh_ && !column.said ? value / 3.6 : value * column.unit;
        }
        break;
      case Column::X:
        local.east_m = value * column.unit;
        break;
      case Column::Y:
        local.north_m = value * column.unit;
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
  bool in_parts_ = false;  ///< a column is a part of the angle that another one begins
  std::string why_none_;   ///< why a column is no place though its name begins so
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
      has[static_cast<std::size_t>(column_of(field.text).column)] = true;
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
