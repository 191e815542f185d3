#pragma once
// The robot's and the store's values in the words of the public interface. Radians and yaw end
// here: JSON has degrees and compass headings. Pure; `now` gives the ages.

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "api/message.hpp"
#include "base/snapshot.hpp"
#include "mission/checks.hpp"
#include "mission/formats/formats.hpp"
#include "mission/rows/headland.hpp"
#include "robot/guard/outlook.hpp"
#include "robot/robot.hpp"
#include "services/trail.hpp"
#include "store/store.hpp"

namespace roverd::api {

/// Older than this is stale, seconds. About twice the usual period of each device and more.
struct StaleAfter {
  static constexpr double kPosition_s = 1.0;
  static constexpr double kAttitude_s = 1.0;
  static constexpr double kGnss_s = 2.5;
  static constexpr double kBase_s = 0.5;
  static constexpr double kBattery_s = 5.0;
  static constexpr double kRc_s = 0.5;
  static constexpr double kDriver_s = 2.5;
  static constexpr double kLights_s = 2.5;
};

/// What main says of the vehicle; fixed while the program runs.
/// By what the guard reckons how far ahead it must be free.
struct GuardProfile {
  double back_m = 0.0;  ///< from the vehicle's origin to its rear end
  double cell_m = 0.0;  ///< of the grid in which it sees
  double side_m = 0.0;
  double gap_m = 0.0;
  double delay_s = 0.0;
  double decel_mps2 = 0.0;
  double turn_decel_radps2 = 0.0;
  /// The stop by counted rays, where it is enabled.
  struct Rays {
    bool instead = false;  ///< nothing is swept: the figures above say nothing
    double stop_m = 0.0;
    double slow_m = 0.0;
    double fan_rad = 0.0;  ///< to either side
    int rays = 0;
  };
  std::optional<Rays> rays{};
};

struct Profile {
  std::string name;
  std::string title;
  std::string kinematics;
  double length_m = 0.0;
  double width_m = 0.0;
  double mass_kg = 0.0;
  double max_speed_mps = 0.0;
  double max_yaw_rate_radps = 0.0;
  double max_acceleration_mps2 = 0.0;
  double pivot_angle_rad = 0.0;
  std::vector<base::Mode> modes;
  std::vector<std::string> drivers;
  bool lights = false;                       ///< can be set
  bool clears_errors = false;                ///< latched ones
  std::vector<std::string> item_types;       ///< those that execution can drive
  std::map<std::string, std::string> radio;  ///< "swc_up" → "mode.manual"
  mission::VehicleLimits limits{};           ///< what missions are checked against
  mission::TurningVehicle turning{};         ///< between rows
  std::optional<GuardProfile> guard{};       ///< empty: it drives blind
};

Json vehicle_json(const base::Snapshot& snapshot, const std::string& name, base::Time now);
/// How well the robot knows where it is: a part of vehicle_json.
Json estimator_json(const base::Snapshot& snapshot);
Json learned_json(const base::VehicleLearned& learned);
Json calibration_json(const base::Snapshot& snapshot);
Json calibration_preview_json(const robot::CalibrationPreview& preview);
/// @param snapshot the last one that the trail has taken
Json trail_json(const services::Trail& trail, const base::Snapshot& snapshot);
/// Null: nothing limits or stops.
/// [[lat, lon], …], 200 at most; null: none.
Json detour_json(const base::Snapshot& s);
Json row_json(const std::optional<base::RowState>& row);
/// The same in short, of nulls where no row is driven or seen: the topic `row`.
Json row_now_json(const std::optional<base::RowState>& row);
Json obstacle_json(const std::optional<base::Obstacle>& obstacle, base::Time now);
/// All of the profile, as they were seen last.
Json sensors_json(const base::Snapshot& snapshot, base::Time now);
/// Landmarks and walls that are known, and what cameras told. @param seen may be null
Json landmarks_json(const robot::Outlook* seen, const base::Snapshot& s, base::Time now);
/// What stands around the robot, of topic and call `obstacles`. @param seen null: nothing yet
Json obstacles_json(const robot::Outlook* seen, const base::Snapshot& snapshot, base::Time now);
/// What the sensors saw last, about the robot.
Json scan_json(const robot::Outlook& seen, const base::Snapshot& snapshot, base::Time now);
/// What is known of the ground about the robot.
Json grid_json(const robot::Outlook& seen, const base::Snapshot& snapshot, base::Time now);
/// Every receiver's satellites, newest word of each.
Json satellites_json(const base::Snapshot& snapshot, base::Time now);
Json checks_json(const base::Snapshot& snapshot);
/// @param offer a mission that a restart left behind
Json execution_json(const base::MissionProgress& progress,
                    const std::optional<store::StoredPlace>& offer = std::nullopt);
Json way_home_json(const robot::WayHomePreview& preview);
Json preview_json(const robot::Preview& preview, base::ExecutionState state);
Json smoothed_json(const std::vector<robot::SmoothedItems>& stretches);
Json mission_way_json(const robot::MissionWay& way);
Json capabilities_json(const Profile& profile, const std::string& version);
/// @param rate_hz received per second
Json driver_json(const base::DriverStatus& driver, std::optional<double> rate_hz, base::Time now);
/// What LightState counts from 0.
inline constexpr std::array<std::string_view, 4> kLightModes = {"off", "on", "breathing", "custom"};
/// As the vehicle tells them.
Json lights_json(const base::Snapshot& snapshot, base::Time now);
/// @param rates received per second by driver name; a missing one is null.
Json drivers_json(const base::Snapshot& snapshot, const std::map<std::string, double>& rates,
                  base::Time now);

Json mission_json(const store::StoredMission& mission);
Json mission_list_json(const store::Page<store::MissionSummary>& page);
/// With `deleted_at`.
Json deleted_list_json(const store::Page<store::MissionSummary>& page);
/// What changed between two revisions of one mission.
Json differences_json(const store::StoredMission& older, const store::StoredMission& newer);
Json revision_list_json(const store::Page<store::RevisionSummary>& page);
Json tag_list_json(const store::Page<store::TagCount>& page);
/// JSON, as text: the account of a large file has many rows.
std::string import_text(const mission::ImportedFile& file, const store::StoredImport& kept);
Json event_json(const store::StoredEvent& event);

/// "rev-3", with its quotes.
std::string etag_of(std::int64_t revision);
/// The revision in such a tag; empty if it is another one, or a weak one.
std::optional<std::int64_t> revision_of(std::string_view etag) noexcept;

}  // namespace roverd::api
