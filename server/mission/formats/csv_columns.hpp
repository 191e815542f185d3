#pragma once
// What the columns of a table of positions are, by their names in the head line. Pure.
//
//   lat  Latitude  gps_lat  LatDeg  lat_rad  latitudeE7     degrees, radians, 1e-7 degrees
//   alt (ft)  height_cm  z                                  m, cm, mm, km, feet
//   speed  SpeedKmh  speed [km/h]  velocity m/min  v_mph    m/s, and kSpeedUnits
//
// A name that says what is not known never stands for the usual unit.

#include <string>
#include <string_view>

namespace roverd::mission {

enum class Column { Lat, Lon, Alt, Speed, X, Y, Other };

/// How surely a column is what its name says; of several the surest is taken.
enum class Fit {
  Exact,   ///< "lat"
  Known,   ///< "lat [deg]": every word of it is known
  Likely,  ///< "lat_of_field"
  Not      ///< "lat_std", "speed [furlong/h]"
};

struct NamedColumn {
  Column column = Column::Other;
  double unit = 1.0;  ///< in degrees, m or m/s
  Fit fit = Fit::Exact;
  std::string why{};  ///< of Not: "is no ..."
  bool said = false;  ///< the name says the unit
  /// Of Not, latitude and longitude: minutes, seconds, a sign. Beside it no other column is the
  /// whole angle.
  bool part = false;
};

inline constexpr std::string_view kSpeedUnits = "m/s, m/min, km/h, mph, knots, ft/s, cm/s and mm/s";

/// @param name as it stands in the file
NamedColumn column_of(std::string_view name);

/// "58°22'41.2\"N", "N 58:22:41.2", "58.378 N": degrees as people write them, with a sign of
/// degrees, minutes or seconds, or the letter of a hemisphere; not plain numbers.
/// @param positive letter of the hemisphere that counts up, N or E; negative: the other one's
/// @return false: it is none
bool read_angle(std::string_view text, char positive, char negative, double& out_deg);

}  // namespace roverd::mission
