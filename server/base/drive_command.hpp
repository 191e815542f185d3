#pragma once
// What the robot tells a base, 50 times a second.

#include "base/geo.hpp"

namespace roverd::base {

struct DriveCommand {
  BodyTwist twist{};
  /// The robot wants the base under computer control. false: the driver sends zero and lets the
  /// base go to standby.
  bool enabled = false;
  friend bool operator==(const DriveCommand&, const DriveCommand&) = default;
};

}  // namespace roverd::base
