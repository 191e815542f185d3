#pragma once
// What the robot says of its sensors and of what stands in its way. Part of the snapshot.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/sight.hpp"
#include "base/time.hpp"

namespace roverd::base {

enum class SensorHealth { Silent, Blind, Degraded, Good };
std::string_view to_string(SensorHealth h) noexcept;  // silent blind degraded good

/// One sensor of the profile.
struct SensorState {
  std::string name;
  std::string kind;
  bool required = true;
  SensorHealth health = SensorHealth::Silent;
  std::string reason;  ///< why it is not good
  Window window = Window::Unknown;
  std::optional<Time> seen;  ///< its last piece
  double rate_hz = 0.0;
  double unknown_part = 0.0;  ///< of its directions, 0 to 1
  std::uint64_t refused = 0;  ///< pieces that could not be used
  std::uint64_t points = 0;   ///< of the last piece
  Mount mount;
};

/// Where the body is in the odometry's own frame O, which drifts and never jumps: what sensors saw
/// is kept there. Metres; yaw left positive.
struct OdometryPlace {
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;
};

/// What the guard does about what it knows of the way.
/// Overridden: a hand drives on at its own risk, slowly.
enum class GuardAction { None, Slow, Creep, Stop, Overridden };
std::string_view to_string(GuardAction a) noexcept;  // none slow creep stop overridden

/// What lies on the commanded curve.
struct Obstacle {
  GuardAction action = GuardAction::None;
  std::string_view what;     ///< obstacle, drop, unseen, blind
  bool moves = false;        ///< an obstacle that is waited for
  double distance_m = 0.0;   ///< way of the origin until the margin is touched
  double bearing_rad = 0.0;  ///< of it, left positive
  double ahead_m = 0.0;      ///< of it, from the origin
  double left_m = 0.0;
  std::string sensor;  ///< that saw it; empty: none did
  double age_s = 0.0;  ///< since it was seen
  std::optional<Time> stopped_since;
  std::optional<Time> since;       ///< it limits the speed, or stops, without a pause
  bool blocked = false;            ///< a drive by itself, for longer than it may last
  std::string_view then;           ///< what follows when it is blocked; empty: a hand drives
  std::optional<Time> decides_at;  ///< when that will be; empty: it is, or never will
  std::string no_way;              ///< why there is no way around it; empty: nobody has found so
  std::string reason;              ///< one sentence for people
};

}  // namespace roverd::base
