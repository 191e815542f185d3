// Tables of positions of other programs: how their columns are called, and in which units they are.

#include "mission/formats/csv_columns.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "mission/formats/formats.hpp"

namespace roverd::mission {
namespace {

std::string told(std::string_view content) {
  const auto file = import_file(content, Format::Csv);
  if (file) return "taken";
  const auto& fields = file.error().fields;
  return fields.empty() ? file.error().detail : fields[0].pointer + ": " + fields[0].detail;
}

Waypoint first_of(std::string_view content) {
  const auto file = import_file(content, Format::Csv);
  EXPECT_TRUE(file) << content << file.error().detail;
  return file ? std::get<Waypoint>(file->plan.items.at(0)) : Waypoint{};
}

/// Why a column of that name was left out; empty: it was not.
std::string left_out(const std::string& name) {
  const auto file = import_file("lat,lon," + name + "\n58.378,26.729,3.6\n", Format::Csv);
  EXPECT_TRUE(file) << name;
  if (!file) return {};
  for (const FileRow& row : file->rows) {
    if (row.what == "column " + name) return row.reason;
  }
  return {};
}

TEST(CsvColumns, ASpeedIsInTheUnitOfItsNameInAllUsualSpellings) {
  const std::vector<std::pair<double, std::vector<std::string>>> units = {
      {1.0,
       {"speed", "speed_mps", "speed (m/s)", "speed m_s", "speed [m s-1]", "velocity", "v",
        "vel_ms", "speed_limit", "SpeedMps", "speed meters per second"}},
      {1.0 / 3.6,
       {"speed_kmph", "SpeedKmh", "speedkmh", "speed km_h", "speed (km/h)", "speed [KM/H]",
        "speed_kph", "SPEED_KMH", "v_kmh", "speed km/hr", "velocity kilometers per hour"}},
      {1852.0 / 3600.0, {"speed_kn", "speed (knots)", "speed kts", "SpeedKnots"}},
      {0.44704, {"speed_mph", "SpeedMph", "speed miles/hour"}},
      {0.3048, {"speed ft/s", "speed_fps", "speed (feet per second)"}},
      {0.01, {"speed (cm/s)", "speed_cmps", "speedCmPerSec"}},
      {0.001, {"speed mm/s", "speed_mms"}},
      {1.0 / 60.0, {"speed m/min", "speed_mpm", "speed meters per minute"}}};
  for (const auto& [mps, names] : units) {
    for (const std::string& name : names) {
      const auto point = first_of("lat,lon," + name + "\n58.378,26.729,3.6\n");
      ASSERT_TRUE(point.speed_mps) << name;
      EXPECT_NEAR(*point.speed_mps, 3.6 * mps, 1e-9) << name;
    }
  }
}

TEST(CsvColumns, ASpeedOrHeightInAUnitThatIsNotKnownIsLeftOutAndTold) {
  for (const std::string name :
       {"speed (furlong/fortnight)", "speed_std", "speed_m", "speed %", "speed pct", "v_x_rpm"}) {
    const auto point = first_of("lat,lon," + name + "\n58.378,26.729,3.6\n");
    if (name == "speed %") {
      EXPECT_EQ(point.speed_mps, 3.6) << "a sign alone is no unit";
      continue;
    }
    EXPECT_FALSE(point.speed_mps) << name;
    EXPECT_NE(left_out(name), "") << name;
  }
  EXPECT_EQ(
      left_out("speed rpm"),
      "is no speed in a unit that is known: m/s, m/min, km/h, mph, knots, ft/s, cm/s and mm/s "
      "are");
  EXPECT_EQ(left_out("alt [fathoms]"),
            "is no height in a unit that is known: m, cm, mm, km and ft are");
}

TEST(CsvColumns, AHeightIsInTheUnitOfItsName) {
  const std::vector<std::pair<std::string, double>> names = {
      {"alt", 1.0},       {"alt [cm]", 0.01},  {"alt_mm", 0.001},
      {"alt_ft", 0.3048}, {"height (m)", 1.0}, {"Altitude MSL (feet)", 0.3048},
      {"AltCm", 0.01},    {"ele", 1.0}};
  for (const auto& [name, metres] : names) {
    const auto point = first_of("lat,lon," + name + "\n58.378,26.729,3600\n");
    ASSERT_TRUE(point.alt_m) << name;
    EXPECT_NEAR(*point.alt_m, 3600.0 * metres, 1e-9) << name;
  }
}

TEST(CsvColumns, AnglesInRadiansAreConvertedAndMinutesRefused) {
  const double lat_rad = 58.378 * std::numbers::pi / 180.0;
  const double lon_rad = 26.729 * std::numbers::pi / 180.0;
  const std::string row = std::to_string(lat_rad) + "0," + std::to_string(lon_rad) + "0\n";
  for (const std::string head :
       {"lat_rad,lon_rad\n", "lat [rad],lon [rad]\n", "LatitudeRadians,LongitudeRadians\n"}) {
    const auto point = first_of(head + row);
    EXPECT_NEAR(point.at.lat, 58.378, 1e-4) << head;
    EXPECT_NEAR(point.at.lon, 26.729, 1e-4) << head;
  }
  EXPECT_NEAR(first_of("latitudeE7,longitudeE7\n583780000,267290000\n").at.lat, 58.378, 1e-9);
  EXPECT_EQ(first_of("lat [deg],gps_lon\n58.378,26.729\n").at, (LatLon{58.378, 26.729}));
  EXPECT_EQ(
      told("lat_min,lon_min\n22.68,43.74\n"),
      "line 1: must name lat and lon, or x and y, each once: column lat_min is no latitude in "
      "degrees or radians");
}

TEST(CsvColumns, AnAngleInSeveralColumnsIsRefusedNotTakenByItsDegrees) {
  const auto refused_for = [](const std::string& content) {
    const std::string begin = "line 1: must name lat and lon, or x and y, each once: column ";
    const std::string all = told(content);
    return all.starts_with(begin) ? all.substr(begin.size()) : all;
  };
  const std::string no_lat = " is no latitude in degrees or radians";
  EXPECT_EQ(refused_for("lat_deg,lat_min,lon_deg,lon_min\n58,22.68,26,43.74\n"),
            "lat_min" + no_lat);
  EXPECT_EQ(refused_for("LatDeg,LatMin,LatSec,LonDeg,LonMin,LonSec\n58,22,41,26,43,44\n"),
            "LatMin" + no_lat);
  EXPECT_EQ(refused_for("lat_d,lat_m,lon_d,lon_m\n58,22.68,26,43.74\n"), "lat_m" + no_lat);
  EXPECT_EQ(refused_for("lat_d,lat_s,lon_d,lon_s\n58,22.68,26,43.74\n"), "lat_s" + no_lat);
  EXPECT_EQ(refused_for("lat,lat_dir,lon,lon_dir\n33.378,S,70.729,W\n"), "lat_dir" + no_lat);
  EXPECT_EQ(refused_for("GPSLatitude,GPSLatitudeRef,GPSLongitude,GPSLongitudeRef\n33,S,70,W\n"),
            "GPSLatitudeRef" + no_lat);
  EXPECT_EQ(refused_for("latitude,N/S,longitude,E/W\n33.378,S,70.729,W\n"), "N/S" + no_lat);
  EXPECT_EQ(refused_for("lat,lon,lat_offset\n33,70,0.5\n"), "lat_offset" + no_lat);
  EXPECT_EQ(refused_for("lat,lat_std,lat_ns,lon\n33,1,S,70\n"), "lat_ns" + no_lat);
  EXPECT_EQ(refused_for("lat,lon W\n33,70\n"), "lon W is no longitude in degrees or radians");
  // What speaks of the angle alone takes nothing from it, nor do parts beside x and y.
  EXPECT_EQ(told("lat,lat_std_m,lat_sd_sec,lat_max,lon\n33,1,1,34,70\n"), "taken");
  EXPECT_EQ(told("# origin 58 26\nx,y,lat_min\n1,2,22\n"), "taken");
}

TEST(CsvColumns, OfSeveralForOneThingTheExactNameWins) {
  const auto file = import_file(
      "lat_std,lat,lon,lon_std,alt_accuracy,alt,lat_of_gate\n0.01,58.378,26.729,0.01,3,61,1\n",
      std::nullopt);
  ASSERT_TRUE(file) << file.error().detail;
  const auto& point = std::get<Waypoint>(file->plan.items.at(0));
  EXPECT_EQ(point.at, (LatLon{58.378, 26.729}));
  EXPECT_EQ(point.alt_m, 61.0);
  std::size_t columns = 0;
  for (const FileRow& row : file->rows) columns += row.outcome == Outcome::LeftOut ? 1 : 0;
  EXPECT_EQ(columns, 4u);
  EXPECT_EQ(told("lat,latitude,lon\n1,2,3\n").substr(0, 16), "line 1: must nam");
}

TEST(CsvColumns, AnglesInDegreesMinutesAndSecondsAreRead) {
  struct Case {
    const char* text;
    double deg;
  };
  for (const auto& [text, deg] : std::initializer_list<Case>{{"58°22'41.2\"N", 58.378111111},
                                                             {"N 58:22:41.2", 58.378111111},
                                                             {"58° 22.687′", 58.378116667},
                                                             {"58d22m41.2s S", -58.378111111},
                                                             {"58d22m41.2s", 58.378111111},
                                                             {"58.378 N", 58.378},
                                                             {"-58°30'", -58.5},
                                                             {"58º22′41.2″n", 58.378111111},
                                                             {"s0°0'36\"", -0.01}}) {
    double is = 0.0;
    ASSERT_TRUE(read_angle(text, 'N', 'S', is)) << text;
    EXPECT_NEAR(is, deg, 1e-8) << text;
  }
  for (const char* text : {"", "N", "58", "58.378", "58 22 41", "58°60'0\"N", "58.5°30'N",
                           "58°22'E", "-58°N", "58°22'41\"12N", "°N", "58°x", "1e5°", "nan N"}) {
    double is = 0.0;
    EXPECT_FALSE(read_angle(text, 'N', 'S', is)) << text;
  }
  const auto point = first_of("lat,lon\n58°22'41.2\"N,26°43'44.4\"E\n");
  EXPECT_NEAR(point.at.lat, 58.378111111, 1e-8);
  EXPECT_NEAR(point.at.lon, 26.729, 1e-8);
  EXPECT_EQ(told("lat,lon\n58°22'41.2\"E,26.7\n"),
            "line 2: column 1 must be a finite number, or degrees, minutes and seconds");
}

TEST(CsvColumns, AFirstColumnThatCountsIsNoLatitude) {
  const std::string why =
      "line 1: begins with a whole number, as all rows do: if it counts them, put a line before "
      "that "
      "names the columns (number,lat,lon)";
  EXPECT_EQ(told("1,58.378,26.729\n2,58.3785,26.7295\n"), why);
  EXPECT_EQ(told("1,58.378,26.729\n"), why);
  EXPECT_EQ(told("7;58,378;26,729;35\n"), why);
  EXPECT_EQ(told("# a comment\n1 58.378 26.729\n# another\n2 58.378 27\n").substr(8),
            why.substr(8));
  EXPECT_EQ(told("number,lat,lon\n1,58.378,26.729\n"), "taken");
  EXPECT_EQ(told("58.378,26.729,35\n58,26.7295,35\n"), "taken");
  EXPECT_EQ(told("58,26,35\n58,27,35\n"), "taken");
  EXPECT_EQ(told("58,26.5,35\n58,27.5,35\n"), "taken");
}

}  // namespace
}  // namespace roverd::mission
