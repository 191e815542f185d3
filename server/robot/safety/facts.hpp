#pragma once
// What the failsafes judge by: what the drivers said last, and what the watches made of it.
// A view of one tick; control thread.

#include <optional>
#include <string_view>

#include "base/snapshot.hpp"
#include "robot/safety/driver_falls.hpp"
#include "robot/world.hpp"

namespace roverd::robot {

struct Facts {
  const World& world;
  const std::optional<base::Pose>& pose;
  std::optional<Time> last_position{};  ///< last one that was fused
  bool armed = false;
  bool estop = false;       ///< latched
  bool autonomous = false;  ///< mode AUTO, mission running
  /// The mission's item in hand asks for no position (a row, a move, a turn), and no fence does.
  bool by_sight = false;
  bool homeward = false;                    ///< RTL, SMART_RTL, DOCK: there a return leads, too
  std::optional<Time> base_waited_since{};  ///< armed, and the base takes no commands since
  bool base_left = false;                   ///< just now, and nobody told it to
  bool commands_lost = false;               ///< see ObedienceWatch
  bool not_following = false;               ///< commands_lost, and told to move now
  std::optional<Time> sigma_bad_since{};
  std::optional<double> corridor_m{};        ///< of the mission that runs
  std::optional<Time> corridor_bad_since{};  ///< 2 sigma of the position pass it
  bool spins = false;                        ///< see SpinWatch
  std::optional<base::Attitude> attitude{};
  std::optional<Time> leans_since{};  ///< beyond tilt_stop_deg
  std::optional<Time> rolls_since{};  ///< to a side, beyond most_roll_deg
  double most_roll_deg = 90.0;        ///< that nav.slope.roll_over_share allows this vehicle
  bool gyro_lost = false;             ///< there was one in this life of the program
  DriverFalls::Worst falls{};         ///< of drivers, within a minute
  std::optional<double> home_m{};     ///< straight
  std::optional<double> use_pct_per_m{};
  std::string_view self_test{};  ///< what it found; empty: nothing
  const base::EstimatorHealth& estimate;
  std::string_view latched{};         ///< see ResetLatch; empty: not
  std::string_view moved_disarmed{};  ///< likewise
  std::string_view blind{};           ///< which required sensor does not see, and why; empty: none
  bool looks = false;                 ///< there are sensors that look around
  double wander_unknown_s = 0.0;      ///< see nav/estimate/wander_watch.hpp
};

}  // namespace roverd::robot
