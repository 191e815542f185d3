#pragma once
// Mission files of other programs, read and written.
//
//   plan       QGroundControl .plan: JSON, fileType "Plan", version 1
//   waypoints  QGC WPL 110, as Mission Planner and QGroundControl write it: a line for each command
//
// Both carry MAVLink mission commands. A rover that drives on the ground cannot do all of them:
// every row of a file is accounted for as taken, changed or left out, with the reason.
//
//   command                       item                    parameters
//   16 NAV_WAYPOINT               waypoint                p1 hold_s, p2 radius_m
//   21 NAV_LAND, 22 NAV_TAKEOFF,  waypoint (changed)      the position only
//   82 NAV_SPLINE_WAYPOINT        waypoint (changed)      driven straight
//   17/18/19 NAV_LOITER_*         waypoint (changed)      19: p1 hold_s
//   20 NAV_RETURN_TO_LAUNCH       return_home
//   93 NAV_DELAY, 112 COND_DELAY  wait                    p1 seconds
//   115 CONDITION_YAW             turn                    p1 deg, p3 direction, p4 relative
//   177 DO_JUMP                   jump                    p1 row number, p2 repetitions (−1: ever)
//   178 DO_CHANGE_SPEED           speed                   p2 m/s
//   179 DO_SET_HOME               home
//   194 DO_SET_REVERSE            reverse of what follows p1 1: backwards
//
// A navigation command at 0/0 means "where the vehicle is": it has no position of its own, so what
// remains of it (a hold) becomes a wait, otherwise the row is left out.
// Pure, any thread, throws nothing. Sources: MAVLink common.xml; QGroundControl's file format page.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"
#include "mission/plan.hpp"

namespace roverd::mission {

enum class Format { Plan, Waypoints };
std::string_view to_string(Format format) noexcept;  // plan waypoints
std::optional<Format> format_from(std::string_view word) noexcept;

/// By content first, then by the file name's ending. Empty: none of ours.
std::optional<Format> detect_format(std::string_view content, std::string_view file_name = {});

enum class Outcome { Taken, Changed, LeftOut };
std::string_view to_string(Outcome outcome) noexcept;  // taken changed left_out

/// What became of one row, item or section of a file.
struct FileRow {
  std::string row;   ///< "line 4", or a JSON pointer: "/mission/items/3"
  std::string what;  ///< "NAV_WAYPOINT (16)", "geofence" …; in an export: "item 3, row"
  Outcome outcome = Outcome::Taken;
  std::string reason;       ///< a sentence; empty for taken
  std::optional<int> item;  ///< number (from 1) of the item in the plan, if it has one
  friend bool operator==(const FileRow&, const FileRow&) = default;
};

struct ImportedFile {
  Format format = Format::Plan;
  Plan plan;  ///< satisfies check_plan; its name is the file's name without ending
  std::vector<FileRow> rows;
};

/// @param format empty: detected, Unsupported if that fails. @param file_name for the plan's name
/// and as a hint; may be empty. Malformed: the file is not of that format or breaks off; Invalid: a
/// value in it cannot be; `fields` then names each line or JSON pointer. A byte order mark and CRLF
/// line ends are fine.
base::Result<ImportedFile> import_file(std::string_view content, std::optional<Format> format,
                                       std::string_view file_name = {});

struct ExportedFile {
  std::string content;
  std::string file_name;   ///< from the plan's name, safe in a Content-Disposition header (ASCII)
  std::string media_type;  ///< without charset: "application/json" or "text/plain"
  /// Items that the format cannot hold (left out) or only in another form (changed). Items that are
  /// written as they are have no row.
  std::vector<FileRow> rows;
};

/// Positions come back equal when the file is imported again.
ExportedFile export_file(const Plan& plan, Format format);

}  // namespace roverd::mission
