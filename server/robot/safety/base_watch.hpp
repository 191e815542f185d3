#pragma once
// Does the base take our commands, and do what they say?
//
//   nobody asks it ──armed, no radio──▶ in charge ──0.5 s──▶ settled
//
//   in charge   it does not listen: waits since (Facts::base_waited_since)
//   settled     it listened and, still well, does not any more: it left by itself
//               it listens again after that: back
//   told to move and does not: lost, until it moves or listens anew (safety/obedience.hpp)
//
// Just armed, or just given back by the radio, the base's last word is still of the time before:
// nothing is concluded until it has settled. Control thread; time is an argument.

#include <optional>

#include "base/drive_command.hpp"
#include "robot/config.hpp"
#include "robot/safety/obedience.hpp"
#include "robot/safety/safety.hpp"

namespace roverd::robot {

class BaseWatch {
 public:
  /// The base tells its state every 0.1 to 0.2 s.
  static constexpr base::Duration kSettled = std::chrono::milliseconds(500);

  struct Facts {
    const World& world;
    const SafetyParams& params;
    bool armed = false;
    bool radio = false;        ///< it drives
    base::DriveCommand sent;   ///< at the tick before
    base::BodyTwist possible;  ///< the part of it that this vehicle can do at all
  };

  /// What is new at this tick.
  struct News {
    bool left = false;
    bool back = false;
    bool disobeys = false;
    bool obeys = false;  ///< again
  };

  /// Once a tick.
  News step(const Facts& facts, Time now) noexcept;
  /// Armed or disarmed: it is asked anew.
  void ask_anew() noexcept { waited_since_.reset(); }

  std::optional<Time> waited_since() const noexcept { return waited_since_; }
  bool left() const noexcept { return left_; }                       ///< at this tick
  bool commands_lost() const noexcept { return obedience_.lost(); }  ///< as far as is known
  bool disobeys_now() const noexcept { return obedience_.failing(); }

 private:
  ObedienceWatch obedience_;
  std::optional<Time> waited_since_;
  std::optional<Time> in_charge_since_;
  bool listened_ = false;
  bool left_ = false;
  bool gone_ = false;  ///< since it left
};

/// The part of a command that a vehicle can do at all.
base::BodyTwist possible(const base::BodyTwist& told, const Config& config) noexcept;

}  // namespace roverd::robot
