#pragma once
// Mission files of other programs, read and written.
//
//   plan       QGroundControl .plan: JSON, fileType "Plan", version 1
//   waypoints  QGC WPL 110, as Mission Planner and QGroundControl write it: a line for each command
//   gpx        GPX 1.0 and 1.1: the routes, else the tracks, else the waypoints
//   kml        KML 2.0 to 2.3: lines, else points
//   kmz        the same, zipped
//   geojson    RFC 7946: lines, else points
//   csv        lat,lon[,alt,speed]; read: also the follower's form
//   follower   x,y,z,yaw,velocity from an origin: m, rad, m/s
//   fence      ArduPilot's older texts, read only: a fence (a return point, then a closed figure,
//              "LAT LON" a line) or rally points ("RALLY LAT LON ALT …")
//
// gpx to follower carry positions: each becomes a waypoint, with a height and a speed where the
// format has them; a circle is written as points of its way, a loiter as its place. Lines, tracks
// and routes that do not touch are missions of their own (track_points.hpp). .plan and .waypoints
// carry MAVLink mission commands. A rover that drives on the ground cannot do all of them: every
// row of a file is accounted for as taken, changed or left out, with the reason.
//
//   command                       item                  parameters
//   16 NAV_WAYPOINT               waypoint              p1 hold_s, p2 radius_m
//   17 NAV_LOITER_UNLIM           loiter                p3 radius_m; without end
//   19 NAV_LOITER_TIME            loiter                p1 seconds, p3 radius_m
//   18 NAV_LOITER_TURNS           circle                p1 turns, p3 radius: clockwise positive
//   34 DO_ORBIT (read)            circle                p1 radius, p2 m/s, p4 rad
//   21 LAND, 82 SPLINE_WAYPOINT   waypoint, changed: the position only
//   20 NAV_RETURN_TO_LAUNCH       return_home
//   93 NAV_DELAY, 112 CONDITION_DELAY                   wait: p1 seconds
//   115 CONDITION_YAW             turn                  p1 deg, p3 −1: left, p4 1: relative
//   177 DO_JUMP                   jump                  p1 row's number, p2 times (−1: for ever)
//   178 DO_CHANGE_SPEED           speed                 p2 m/s
//   194 DO_SET_REVERSE            reverse of the waypoints that follow: p1 1
//   5001, 5002 FENCE_POLYGON_VERTEX_*     corner of an inclusion, an exclusion: p1 how many it has
//   5003, 5004 FENCE_CIRCLE_*             circle: p1 radius
//   5000 FENCE_RETURN_POINT               left out
//   5100 RALLY_POINT                      rally point
//
// Row 0 of .waypoints is home if it is written as one: NAV_WAYPOINT in frame 0 without parameters.
//
// A jump to a row that was left out goes to the next one that was not. A navigation command at 0/0
// means "where the vehicle is": it has no position of its own, so its hold becomes a wait, and
// without one it is left out. A home at 0/0 is no home. Heights do not steer a ground vehicle: they
// are kept as numbers (above home, frame 3), 0 is none.
//
// Written positions have as many digits as it takes to read the same double back, at least 8
// decimals in .waypoints (1e-9 deg is 0.1 mm).
// Pure, any thread, throws nothing. Sources: MAVLink common.xml; QGroundControl's file format page.

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"
#include "mission/fence/fence.hpp"
#include "mission/plan.hpp"

namespace roverd::mission {

enum class Format { Plan, Waypoints, Gpx, Kml, Kmz, GeoJson, Csv, Follower, Fence };
inline constexpr std::array kFormats{Format::Plan,     Format::Waypoints, Format::Gpx,
                                     Format::Kml,      Format::GeoJson,   Format::Csv,
                                     Format::Follower, Format::Kmz,       Format::Fence};
/// All but Fence.
bool is_written(Format format) noexcept;
/// plan waypoints gpx kml kmz geojson csv follower fence
std::string_view to_string(Format format) noexcept;
std::optional<Format> format_from(std::string_view word) noexcept;

/// By content first, then by the file name's ending. Empty: none of ours.
std::optional<Format> detect_format(std::string_view content, std::string_view file_name = {});

enum class Outcome { Taken, Changed, LeftOut };
std::string_view to_string(Outcome outcome) noexcept;  // taken changed left_out

/// What became of one row, item or section of a file.
struct FileRow {
  std::string row;   ///< "line 4" or a JSON pointer into the file; in an export into the plan
  std::string what;  ///< "NAV_WAYPOINT (16)", "geofence" …; in an export the item's type
  Outcome outcome = Outcome::Taken;
  std::string reason;       ///< a sentence; empty for taken
  std::optional<int> item;  ///< number (from 1) of the item in the plan, if it has one
  int mission = 1;          ///< number (from 1) of the mission that has the item
  friend bool operator==(const FileRow&, const FileRow&) = default;
};

/// A field, or whatever a polygon without a word is: what plan_survey can cover.
struct FieldArea {
  std::string name;
  std::string row;                         ///< its place in the file
  std::vector<std::vector<LatLon>> rings;  ///< not closed; the first is the field, others are holes
};

/// At least one of mission, fence and area.
struct ImportedFile {
  Format format = Format::Plan;
  /// The first mission; satisfies check_plan and has something to drive, or has no items: there is
  /// none. Called as the file without its ending.
  Plan plan;
  std::vector<FileRow> rows;
  /// Satisfies check_fence, named like the file.
  std::optional<Fence> fence{};
  /// Further missions, one for each way that is not connected with the one before it; like `plan`,
  /// their names tell which they are.
  std::vector<Plan> more{};
  std::vector<FieldArea> areas{};
  std::string name{};  ///< the file's own; while it is read
};

/// What a file of the follower's form may leave unsaid, and what is to be done with wrong places.
struct ImportHints {
  std::optional<LatLon> origin{};  ///< goes before the file's own
  bool kmh = false;                ///< its velocities are in km/h
  /// A position that cannot be is a row that is left out, with its reason. Without it, and in
  /// .plan, .waypoints and fences always, it makes the file Invalid; so does a wrong corner of an
  /// area.
  bool leave_out_wrong = false;
};

/// @param format empty: detected, Unsupported if that fails. @param file_name for the plan's name
/// and as a hint; may be empty. Invalid: the file is not of that format or of an unknown version of
/// it, breaks off, holds values that cannot be, or nothing to drive, to keep to or to cover;
/// `fields` then names each line ("line 4") or JSON pointer. TooLarge: more than kMaxItems items,
/// or what would need more memory than a robot has to spare. Text may be UTF-8 or UTF-16, with or
/// without a byte order mark, with LF, CR or CRLF as line ends.
base::Result<ImportedFile> import_file(std::string_view content, std::optional<Format> format,
                                       std::string_view file_name = {},
                                       const ImportHints& hints = {});

struct ExportedFile {
  std::string content;
  std::string file_name;   ///< from the plan's name, safe in a Content-Disposition header (ASCII)
  std::string media_type;  ///< without charset: "application/json", "text/csv" …
  bool binary = false;     ///< no text
  /// Items that the format cannot hold (left out) or only in another form (changed). Items that are
  /// written as they are have no row.
  std::vector<FileRow> rows;
};

/// Of a file that is given: ASCII letters, digits, '-' and '_'; runs of all else become one '_'.
/// 80 characters at most. @param otherwise where none is left
std::string file_stem(std::string_view name, std::string_view otherwise = "mission");

/// Positions come back equal when the file is imported again. A plan that counts from a map, where
/// that lies is known (Plan::frame): its points are written as waypoints there, and `rows` says so.
/// Where it is not, they are left out. @param format is_written @param fence written into .plan,
/// GeoJSON, KML and KMZ; the other formats have no place for it, and `rows` says so. Null: none
ExportedFile export_file(const Plan& plan, Format format, const Fence* fence = nullptr);

}  // namespace roverd::mission
