#pragma once
// MAVLink mission commands: what .plan and .waypoints files have in common. A file format turns its
// rows into Commands and back; here they become items and back.
// Source: MAVLink common.xml (MAV_CMD, MAV_FRAME); DO_SET_REVERSE: ArduPilot Rover.

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mission/formats/formats.hpp"
#include "mission/json/pointer.hpp"
#include "mission/plan.hpp"

namespace roverd::mission {

struct Command {
  std::string row;            ///< its place in the file: "line 4", "/mission/items/3"
  std::string_view lat_at{};  ///< added to `row` to name the latitude: "/params/4"
  std::string_view lon_at{};  ///< likewise
  int number = 0;             ///< by which a DO_JUMP names it
  int id = 0;                 ///< MAV_CMD
  int frame = 3;              ///< MAV_FRAME
  bool auto_continue = true;  ///< false: wait for the operator after it
  std::array<std::optional<double>, 4> p{};  ///< param1..4; empty: not given (NaN)
  std::optional<double> lat;                 ///< param5
  std::optional<double> lon;                 ///< param6
  std::optional<double> alt;                 ///< param7
};

/// "NAV_WAYPOINT (16)", "command 2500".
std::string command_name(int id);

/// Appends the commands' items to the plan and an account of each to `rows`. Coordinates that
/// cannot be go to `problems`.
void items_from_commands(const std::vector<Command>& commands, Plan& plan,
                         std::vector<FileRow>& rows, Problems& problems);

/// @param with_speed the mission's speed is written as a first command, because the format has no
/// other place for it. Numbers are 1, 2, 3 … `rows` gets what cannot be written as it is.
std::vector<Command> commands_from_items(const Plan& plan, bool with_speed,
                                         std::vector<FileRow>& rows);

/// Is it how a home is written: NAV_WAYPOINT above sea level that asks for nothing?
bool is_home_command(const Command& at) noexcept;

/// Takes fence and rally commands (5000 to 5004, 5100) out of the list and makes a fence of them,
/// with their accounts; empty if there are none. What cannot be goes to `problems`.
std::optional<Fence> fence_from_commands(std::vector<Command>& commands, std::vector<FileRow>& rows,
                                         Problems& problems);

/// Home from its numbers, with its account. 0/0 is none.
void take_home(const Command& at, Plan& plan, std::vector<FileRow>& rows, Problems& problems);

namespace cmd {
inline constexpr int kWaypoint = 16;
inline constexpr int kLoiterForever = 17;
inline constexpr int kLoiterTurns = 18;
inline constexpr int kLoiterTime = 19;
inline constexpr int kReturn = 20;
inline constexpr int kLand = 21;
inline constexpr int kTakeoff = 22;
inline constexpr int kOrbit = 34;
inline constexpr int kSpline = 82;
inline constexpr int kDelay = 93;
inline constexpr int kConditionDelay = 112;
inline constexpr int kYaw = 115;
inline constexpr int kJump = 177;
inline constexpr int kChangeSpeed = 178;
inline constexpr int kSetHome = 179;
inline constexpr int kSetReverse = 194;
inline constexpr int kFenceReturn = 5000;
inline constexpr int kFenceInclusion = 5001;
inline constexpr int kFenceExclusion = 5002;
inline constexpr int kFenceCircleInclusion = 5003;
inline constexpr int kFenceCircleExclusion = 5004;
inline constexpr int kRally = 5100;
}  // namespace cmd

inline constexpr int kFrameGlobal = 0;
inline constexpr int kFrameMission = 2;
inline constexpr int kFrameRelative = 3;
inline constexpr int kFrameGlobalInt = 5;

}  // namespace roverd::mission
