#include "mission/formats/csv_columns.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "mission/text.hpp"

namespace roverd::mission {

namespace csv_names {

namespace {

using Words = std::span<const std::string_view>;
using Unit = std::pair<std::string_view, double>;

bool is_one_of(std::string_view word, Words words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

char small(char c) noexcept {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}
bool is_small(char c) noexcept {
  return c >= 'a' && c <= 'z';
}
bool is_large(char c) noexcept {
  return c >= 'A' && c <= 'Z';
}
bool is_digit(char c) noexcept {
  return c >= '0' && c <= '9';
}

/// "SpeedKmh" and "speed [km/h]": speed, km, h or speed, kmh; in small letters.
std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> out;
  bool inside = false;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    if (!is_small(c) && !is_large(c) && !is_digit(c)) {
      inside = false;
      continue;
    }
    const char before = i > 0 ? name[i - 1] : '\0';
    const bool hump =
        is_large(c) &&
        (is_small(before) || (is_large(before) && i + 1 < name.size() && is_small(name[i + 1])));
    if (!inside || hump) out.emplace_back();
    out.back() += small(c);
    inside = true;
  }
  // "speedkmh"
  for (const std::string_view begin : {"speed", "velocity"}) {
    if (out.empty() || !out[0].starts_with(begin) || out[0].size() == begin.size()) continue;
    const std::string rest = out[0].substr(begin.size());
    out[0] = begin;
    out.insert(out.begin() + 1, rest);
  }
  return out;
}

constexpr std::array<std::string_view, 2> kLatWords = {"lat", "latitude"};
constexpr std::array<std::string_view, 4> kLonWords = {"lon", "lng", "long", "longitude"};
constexpr std::array<std::string_view, 6> kAltWords = {"alt",       "altitude", "ele",
                                                       "elevation", "height",   "z"};
constexpr std::array<std::string_view, 2> kXWords = {"x", "east"};
constexpr std::array<std::string_view, 2> kYWords = {"y", "north"};
constexpr std::array<std::string_view, 2> kSpeedWords = {"v", "vel"};

/// Said beside a quantity, and no matter which unit it has.
constexpr std::array<std::string_view, 14> kBeside = {"gps",      "gnss",     "wgs",  "wgs84", "84",
                                                      "pos",      "position", "pose", "point", "wp",
                                                      "waypoint", "of",       "the",  "in"};
constexpr std::array<std::string_view, 15> kBesideDegrees = {
    "deg", "degs", "degree", "degrees", "d", "dd",    "decimal",   "dec",
    "dms", "epsg", "4326",   "n",       "e", "coord", "coordinate"};
constexpr std::array<std::string_view, 16> kBesideHeight = {
    "msl",         "amsl", "asl",   "above", "mean",   "sea", "level",    "ellipsoid",
    "ellipsoidal", "hae",  "geoid", "agl",   "ground", "rel", "relative", "up"};
constexpr std::array<std::string_view, 10> kBesidePlane = {
    "enu", "local", "map", "utm", "odom", "easting", "northing", "coord", "coordinate", "axis"};
constexpr std::array<std::string_view, 19> kBesideSpeed = {
    "limit",   "max",      "maximum", "target",  "desired",   "over",      "ground",
    "set",     "setpoint", "cmd",     "command", "commanded", "reference", "ref",
    "planned", "plan",     "nominal", "cruise",  "value"};
/// Of something else than a place: how sure it is, how it changes, the most of it.
constexpr std::array<std::string_view, 25> kNoPlace = {
    "std",   "stdev", "stddev",     "sd",         "sigma",       "err",       "error",
    "acc",   "hacc",  "vacc",       "var",        "variance",    "accuracy",  "cov",
    "dop",   "max",   "covariance", "vel",        "uncertainty", "precision", "speed",
    "accel", "gon",   "velocity",   "orientation"};
/// Of the same angle, or of a place along one axis: its minutes and seconds, its sign, what is
/// still to be added. Without it the rest is another place.
constexpr std::array<std::string_view, 33> kPartOfAngle = {
    "min",  "mins",   "minute",    "minutes",    "arcmin",    "m",         "sec",
    "secs", "second", "seconds",   "arcsec",     "s",         "dir",       "direction",
    "ref",  "hem",    "hemi",      "hemisphere", "ns",        "ew",        "w",
    "sign", "offset", "delta",     "frac",       "fraction",  "arcminute", "arcminutes",
    "sgn",  "letter", "indicator", "arcsecond",  "arcseconds"};
constexpr std::array<std::string_view, 10> kNoDegrees = {
    "meter", "meters", "metre", "metres", "cm", "mm", "km", "ft", "feet", "utm"};
constexpr std::array<std::string_view, 14> kNoLength = {
    "deg",    "degree", "degrees", "rad",   "radian",  "radians", "inch",
    "inches", "yd",     "yard",    "yards", "angular", "linear",  "quaternion"};

constexpr std::array<Unit, 8> kAngleUnits = {{{"", 1.0},
                                              {"rad", 180.0 / std::numbers::pi},
                                              {"rads", 180.0 / std::numbers::pi},
                                              {"radian", 180.0 / std::numbers::pi},
                                              {"radians", 180.0 / std::numbers::pi},
                                              {"e7", 1e-7},
                                              {"dege7", 1e-7},
                                              {"1e7", 1e-7}}};
constexpr double kFoot_m = 0.3048;
constexpr std::array<Unit, 19> kLengthUnits = {{{"", 1.0},
                                                {"m", 1.0},
                                                {"meter", 1.0},
                                                {"meters", 1.0},
                                                {"metre", 1.0},
                                                {"metres", 1.0},
                                                {"cm", 0.01},
                                                {"centimeter", 0.01},
                                                {"centimeters", 0.01},
                                                {"centimetre", 0.01},
                                                {"centimetres", 0.01},
                                                {"mm", 0.001},
                                                {"millimeter", 0.001},
                                                {"millimeters", 0.001},
                                                {"millimetres", 0.001},
                                                {"km", 1000.0},
                                                {"ft", kFoot_m},
                                                {"feet", kFoot_m},
                                                {"foot", kFoot_m}}};

/// So many metres, and so many seconds; each as it is written before and behind the stroke.
constexpr std::array<Unit, 16> kWays = {{{"m", 1.0},
                                         {"meter", 1.0},
                                         {"meters", 1.0},
                                         {"metre", 1.0},
                                         {"metres", 1.0},
                                         {"km", 1000.0},
                                         {"kilometers", 1000.0},
                                         {"kilometres", 1000.0},
                                         {"cm", 0.01},
                                         {"mm", 0.001},
                                         {"ft", kFoot_m},
                                         {"f", kFoot_m},
                                         {"feet", kFoot_m},
                                         {"mi", 1609.344},
                                         {"mile", 1609.344},
                                         {"miles", 1609.344}}};
constexpr std::array<Unit, 12> kTimes = {{{"s", 1.0},
                                          {"s1", 1.0},
                                          {"sec", 1.0},
                                          {"second", 1.0},
                                          {"min", 60.0},
                                          {"min1", 60.0},
                                          {"minute", 60.0},
                                          {"h", 3600.0},
                                          {"h1", 3600.0},
                                          {"hr", 3600.0},
                                          {"hour", 3600.0},
                                          {"std", 3600.0}}};
/// Those that are not written as a way and a time.
constexpr double kKnot_mps = 1852.0 / 3600.0;
constexpr std::array<Unit, 9> kSpeeds = {{{"", 1.0},
                                          {"mph", 0.44704},
                                          {"mpm", 1.0 / 60.0},
                                          {"kph", 1.0 / 3.6},
                                          {"kn", kKnot_mps},
                                          {"kt", kKnot_mps},
                                          {"kts", kKnot_mps},
                                          {"knot", kKnot_mps},
                                          {"knots", kKnot_mps}}};

std::optional<double> unit_in(std::string_view word, std::span<const Unit> units) {
  const auto found =
      std::find_if(units.begin(), units.end(), [&](const Unit& u) { return u.first == word; });
  return found == units.end() ? std::nullopt : std::optional(found->second);
}

/// "kmh", "kmperh", "kmph": what stood between way and time is gone, or is "p" or "per".
std::optional<double> speed_unit(std::string_view word) {
  if (const auto speed = unit_in(word, kSpeeds)) return speed;
  for (const auto& [way, metres] : kWays) {
    if (!word.starts_with(way)) continue;
    std::string_view rest = word.substr(way.size());
    for (const std::string_view between : {"per", "p", ""}) {
      if (!rest.starts_with(between)) continue;
      if (const auto seconds = unit_in(rest.substr(between.size()), kTimes)) {
        return metres / *seconds;
      }
    }
  }
  return std::nullopt;
}

/// The words of a name but for those of the quantity and those that say no unit.
struct Rest {
  std::vector<std::string_view> words;
  bool alone = true;  ///< the name is the quantity's word and no more
  std::string joined() const {
    std::string out;
    for (const std::string_view word : words) out += word;
    return out;
  }
};

Rest rest_of(const std::vector<std::string>& words, Words quantity, Words beside) {
  Rest out;
  out.alone = words.size() == 1;
  bool taken = false;
  for (const std::string& word : words) {
    const bool is_it = !taken && is_one_of(word, quantity);
    taken = taken || is_it;
    if (!is_it && !is_one_of(word, kBeside) && !is_one_of(word, beside)) out.words.push_back(word);
  }
  return out;
}

bool any_of(const std::vector<std::string>& words, Words wanted) {
  return std::any_of(words.begin(), words.end(),
                     [&](const std::string& word) { return is_one_of(word, wanted); });
}

bool any_of(const Rest& rest, Words wanted) {
  return std::any_of(rest.words.begin(), rest.words.end(),
                     [&](std::string_view word) { return is_one_of(word, wanted); });
}

NamedColumn none(Column column, std::string why) {
  return {column, 1.0, Fit::Not, std::move(why)};
}

NamedColumn known(Column column, double unit, const Rest& rest) {
  return {column, unit, rest.alone ? Fit::Exact : Fit::Known, {}, !rest.words.empty()};
}

NamedColumn angle_column(Column column, const Rest& rest) {
  const auto unit = unit_in(rest.joined(), kAngleUnits);
  if (unit) return known(column, *unit, rest);
  const bool part = any_of(rest, kPartOfAngle) && !any_of(rest, kNoPlace);
  if (part || any_of(rest, kNoPlace) || any_of(rest, kNoDegrees)) {
    NamedColumn out =
        none(column, std::string("is no ") + (column == Column::Lat ? "latitude" : "longitude") +
                         " in degrees or radians");
    out.part = part;
    return out;
  }
  return {column, 1.0, Fit::Likely, {}};
}

NamedColumn plane_column(Column column, const Rest& rest) {
  const auto unit = unit_in(rest.joined(), kLengthUnits);
  if (unit) return known(column, *unit, rest);
  if (any_of(rest, kNoPlace) || any_of(rest, kPartOfAngle) || any_of(rest, kNoLength)) {
    return none(column, "is no coordinate in m, cm, mm, km or ft");
  }
  return {column, 1.0, Fit::Likely, {}};
}

NamedColumn height_column(const Rest& rest) {
  const auto unit = unit_in(rest.joined(), kLengthUnits);
  if (unit) return known(Column::Alt, *unit, rest);
  return none(Column::Alt, "is no height in a unit that is known: m, cm, mm, km and ft are");
}

NamedColumn speed_column(const Rest& rest) {
  const auto unit = speed_unit(rest.joined());
  if (unit) return known(Column::Speed, *unit, rest);
  return none(Column::Speed,
              "is no speed in a unit that is known: " + std::string(kSpeedUnits) + " are");
}

/// "N/S", "E/W indicator": the column of the letters, as NMEA 0183 has them, with no word of what
/// they are the sign of. @return Other: it is none
Column column_of_letters(const std::vector<std::string>& words) {
  if (words.size() < 2) return Column::Other;
  if (words[0] == "n" && words[1] == "s") return Column::Lat;
  return words[0] == "e" && words[1] == "w" ? Column::Lon : Column::Other;
}

}  // namespace

NamedColumn column(std::string_view name) {
  const auto words = words_of(name);
  if (const Column of = column_of_letters(words); of != Column::Other) {
    return angle_column(of, {{"sign"}, false});
  }
  if (any_of(words, kLatWords)) {
    return angle_column(Column::Lat, rest_of(words, kLatWords, kBesideDegrees));
  }
  if (any_of(words, kLonWords)) {
    return angle_column(Column::Lon, rest_of(words, kLonWords, kBesideDegrees));
  }
  if (any_of(words, kAltWords)) return height_column(rest_of(words, kAltWords, kBesideHeight));
  if (any_of(words, kXWords)) {
    return plane_column(Column::X, rest_of(words, kXWords, kBesidePlane));
  }
  if (any_of(words, kYWords)) {
    return plane_column(Column::Y, rest_of(words, kYWords, kBesidePlane));
  }
  constexpr std::array<std::string_view, 2> kWhole = {"speed", "velocity"};
  if (!words.empty() && is_one_of(words[0], kWhole)) {
    return speed_column(rest_of(words, kWhole, kBesideSpeed));
  }
  if (any_of(words, kSpeedWords)) return speed_column(rest_of(words, kSpeedWords, kBesideSpeed));
  return {};
}

namespace {

/// Takes one of the marks off the front, with the blanks around it. @return which was there: 2 a
/// mark, 1 blanks alone, 0 nothing
int take_mark(std::string_view& text, Words marks) {
  const auto blanks = [&text] {
    const std::size_t n = std::min(text.find_first_not_of(' '), text.size());
    text.remove_prefix(n);
    return n > 0;
  };
  const bool blank = blanks();
  for (const std::string_view mark : marks) {
    if (!text.starts_with(mark)) continue;
    text.remove_prefix(mark.size());
    blanks();
    return 2;
  }
  return blank ? 1 : 0;
}

/// The letter at either end. @return it, large; 0: there is none
char take_letter(std::string_view& text, char positive, char negative) {
  const auto is_it = [&](char c) {
    const char large = is_small(c) ? static_cast<char>(c - 'a' + 'A') : c;
    return large == positive || large == negative ? large : '\0';
  };
  if (text.empty()) return '\0';
  // "41.2s" are seconds.
  const bool second = text.size() > 1 && text.back() == 's' && is_digit(text[text.size() - 2]);
  if (const char c = is_it(text.back()); c != '\0' && !second) {
    text.remove_suffix(1);
    return c;
  }
  const char c = is_it(text.front());
  if (c != '\0') text.remove_prefix(1);
  return c;
}

}  // namespace

bool angle(std::string_view text, char positive, char negative, double& out_deg) {
  constexpr std::array<std::string_view, 6> kDegrees = {"\u00b0", "\u00ba", "\u02da",
                                                        "deg",    "d",      ":"};
  constexpr std::array<std::string_view, 6> kMinutes = {"\u2032", "\u2019", "min", "m", ":", "'"};
  constexpr std::array<std::string_view, 6> kSeconds = {"\u2033", "\u201d", "''",
                                                        "\"\"",   "\"",     "s"};
  const std::array<Words, 3> marks = {kDegrees, kMinutes, kSeconds};
  const char letter = take_letter(text, positive, negative);
  take_mark(text, {});
  const bool minus = letter == '\0' && text.starts_with('-');
  if (minus) text.remove_prefix(1);
  bool marked = letter != '\0';
  double sum = 0.0;
  bool whole = true;
  double part = 1.0;
  for (std::size_t i = 0; i < marks.size() && !text.empty(); ++i, part *= 60.0) {
    double value = 0.0;
    if (!whole || !is_digit(text.front())) return false;
    const auto [end, ec] =
        std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
    if (ec != std::errc{} || (i > 0 && value >= 60.0)) return false;
    whole = std::find(text.data(), end, '.') == end;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    const int mark = take_mark(text, marks[i]);
    if (mark == 0 && !text.empty()) return false;
    marked = marked || mark == 2;
    sum += value / part;
  }
  if (!text.empty() || !marked || part == 1.0) return false;
  out_deg = minus || letter == negative ? -sum : sum;
  return true;
}

}  // namespace csv_names

NamedColumn column_of(std::string_view name) {
  return csv_names::column(name);
}

bool read_angle(std::string_view text, char positive, char negative, double& out_deg) {
  return csv_names::angle(text, positive, negative, out_deg);
}

}  // namespace roverd::mission
