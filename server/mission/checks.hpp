#pragma once
// What speaks against driving a mission with a certain vehicle here and now, and how long it takes.
// Pure, any thread; some milliseconds for 10,000 items.
//
//   no_target          error: nothing to drive to
//   too_far            error: more than 10 km from the vehicle, or from the first position;
//                      warning: more than 1 km from the vehicle
//   leg_too_long       warning: a leg of more than 1 km
//   outside_fence      error: a position or a leg outside the active fence
//   near_fence         warning: nearer to its limit than half the vehicle's width
//   turn_too_tight     warning: legs too short for the turning radius between their corners;
//                      error: a turn on the spot by a vehicle that cannot
//   too_steep          error: between two heights, where both are known
//   duplicate_point    warning: the same place as the waypoint before
//   speed_above_limit  warning: it will be driven at the limit
//   unreachable_type   error: a type of item that cannot be driven as configured
//   unknown_action     error: an action that nothing here does
//   too_near           error: a wall or plants nearer beside the way than the guard lets it drive
//   no_effect          warning: a member that does not act as it stands
//   unseen_way         warning: backwards or on the spot into what no sensor of this vehicle sees
//   repeats_for_ever   warning: a jump without end

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mission/fence/fence.hpp"
#include "mission/plan.hpp"

namespace roverd::mission {

enum class Severity { Warning, Error };
std::string_view to_string(Severity severity) noexcept;  // warning error

struct Finding {
  Severity severity = Severity::Warning;
  std::string code;
  std::string pointer;      ///< "/items/3", "/items"
  std::optional<int> item;  ///< from 1
  std::string detail;       ///< "must …", "lies …": goes on from the item's name
};

/// What the check must know of the vehicle. From its profile.
struct VehicleLimits {
  double max_speed_mps = 1.0;
  double default_speed_mps = 0.8;
  double width_m = 0.8;
  double max_climb_deg = 30.0;
  double turn_radius_m = 0.0;  ///< smallest; 0: turns on the spot
  /// On the way while the steering goes from straight to its limit, and to be straight again behind
  /// a turn. Of no meaning without a radius.
  double steer_in_m = 0.0;
  double settle_m = 0.0;
  double yaw_rate_radps = 0.75;  ///< of a turn on the spot
  /// From its middle to what the guard lets it drive past; 0: nothing is guarded.
  double room_m = 0.0;
  double wall_m = 0.9;      ///< from a wall whose item says no distance
  bool sees_behind = true;  ///< a sensor looks there; or nothing is guarded
  bool sees_around = true;
  bool creeps_back = false;  ///< into what nobody has seen
  bool creeps_turning = false;
  std::optional<double> drive_power_w;
  std::optional<double> idle_power_w;
  std::optional<double> battery_wh;
  std::vector<std::string> item_types;  ///< that can be driven: "waypoint" …
  std::vector<std::string> actions;     ///< that are built in: "set_home" …
};

struct Surroundings {
  std::optional<LatLon> vehicle;
  const Fence* fence = nullptr;  ///< satisfies check_fence; null: none
};

/// Of what is driven, repetitions included; the way from the vehicle to the first item is not.
struct Estimate {
  std::optional<double> length_m;   ///< empty: an item goes as far as it sees its row, wall, marks
  std::optional<double> time_s;     ///< empty: likewise, or it has no end
  std::optional<double> energy_wh;  ///< empty: likewise, or the profile does not tell
};

struct CheckReport {
  std::vector<Finding> findings;  ///< errors first, each by item; at most kMaxFindings
  std::size_t errors = 0;
  std::size_t warnings = 0;
  Estimate estimate;
};
inline constexpr std::size_t kMaxFindings = 200;

/// @param plan satisfies check_plan
CheckReport check(const Plan& plan, const VehicleLimits& vehicle, const Surroundings& around);

/// How long it takes. Straight legs at the asked speed, holds, turns on the spot. Pure.
Estimate estimate(const Plan& plan, const VehicleLimits& vehicle);

/// A finding as a sentence of its own: "item 3 is reached by a way that leaves the fence".
std::string sentence(const Finding& finding);

/// Why an action cannot be done, with the names of those that are built in. Empty: it can.
std::string why_not_done(std::string_view action, const std::vector<std::string>& built_in);

/// Why a type of item cannot be driven: what must be configured.
std::string why_not_drivable(std::string_view type);

}  // namespace roverd::mission
