#pragma once
// What is wrong now, and what follows from it. Pure: facts in, conditions out; worst one wins.
//
// | loss                                   | after              | follows                        |
// | base e-stop                            | at once            | Stop: latched e-stop           |
// | no word from the base                  | 0.4 s (parameter)  | Hold                           |
// | base exception, unknown state          | at once            | Hold                           |
// | bumper pressed                         | at once            | Stop: latched e-stop           |
// | bumper enabled and silent              | 1 s (parameter)    | Hold                           |
// | base takes no commands while armed     | 3 s                | Hold; no motion before          |
// | base leaves our control by itself      | at once            | Hold                            |
// | base does not do what it is told       | 0.3 s (parameter)  | Hold                            |
// | radio silent, frozen, or reported lost | 0.5 s              | Hold                           |
// | no usable fix (AUTO), a gyro           | 2 s, 35 m driven   | Warn, Hold                     |
// | no usable fix (AUTO), no gyro          | 2 s, 6 s           | Slow, Hold                     |
// | two receivers disagree (AUTO)          | at once            | Hold                           |
// | wheels turn, robot stands (AUTO)      | 3 s (parameter)    | Hold                           |
// | a sensor contradicts the others (AUTO) | 0.6 s              | it is left out; gyro, velocity,|
// |                                        |                    | compass, antennas: Warn        |
// |   GNSS position                        | 5 m driven         | Slow, Hold                     |
// |   odometry, or two sensors             | at once            | Hold                           |
// | two sensors contradict, undecided      | 1.6 s              | Hold                           |
// | estimate set anew far off, or twice    | at once            | Hold until acknowledged        |
// | position uncertain (AUTO)              | at once, 2 s worse | Slow, Hold                     |
// | battery low, fault                     | at once            | Warn, Hold                     |
// | this computer: disk, clock, lateness   | at once            | Warn                           |
// Hold stops, goes to mode HOLD and stays there until an operator goes on. Only the radio's
// take-over ends by itself. What is wrong with the position is listed in every mode, and followed
// by something in AUTO only.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/snapshot.hpp"
#include "robot/config.hpp"
#include "robot/world.hpp"

namespace roverd::robot {

enum class Response { None, Warn, Slow, Hold, Stop };  // later ones win

struct Facts {
  const World& world;
  const std::optional<base::Pose>& pose;
  std::optional<Time> last_position;  ///< last one that was fused
  bool armed = false;
  bool estop = false;                     ///< latched
  bool autonomous = false;                ///< mode AUTO, mission running
  std::optional<Time> base_waited_since;  ///< armed, and the base takes no commands since
  bool base_left = false;                 ///< just now, and nobody told it to
  bool commands_lost = false;             ///< see ObedienceWatch
  bool not_following = false;             ///< commands_lost, and told to move now
  std::optional<Time> sigma_bad_since;
  bool spins = false;  ///< see SpinWatch
  const base::EstimatorHealth& estimate;
  std::string_view latched{};  ///< see ResetLatch; empty: not
};

struct Assessment {
  Response response = Response::None;
  std::string cause;  ///< of the worst response
  std::vector<base::SafetyCondition> conditions;
  bool base_estop = false;
};

/// Does the radio drive? The base says so, or the switch SWB stands elsewhere than up.
bool radio_drives(const World& world, const SafetyParams& p, Time now) noexcept;
/// Its frames come, and count.
bool radio_heard(const World& world, const SafetyParams& p, Time now) noexcept;
/// The base takes our commands.
bool base_listens(const World& world) noexcept;
bool base_lost(const World& world, const SafetyParams& p, Time now) noexcept;
/// Empty: the radio is all right. Otherwise why not.
std::string radio_trouble(const World& world, const SafetyParams& p, Time now);

Assessment assess(const Facts& facts, const SafetyParams& p, Time now);

/// The checks before arming, always all of them.
std::vector<base::Check> arming_checks(const Facts& facts, const SafetyParams& safety,
                                       const ArmingParams& p, bool mission_loaded, Time now);

}  // namespace roverd::robot
