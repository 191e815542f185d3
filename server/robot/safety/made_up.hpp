#pragma once
// A robot that does not exist and to which nothing is wrong: what the failsafes are tried on.

#include <optional>

#include "robot/safety/failsafes.hpp"

namespace roverd::robot {

/// Armed, drives by itself, knows where it is. Refers to itself, so it is neither copied nor moved.
struct MadeUp {
  MadeUp();
  MadeUp(const MadeUp&) = delete;
  MadeUp& operator=(const MadeUp&) = delete;

  /// A driver that sees something.
  base::DriverDetail& driver();

  Time now{std::chrono::hours(1)};
  SafetyParams params;
  World world;
  std::optional<base::Pose> pose;
  base::EstimatorHealth estimate;
  Facts facts{.world = world, .pose = pose, .estimate = estimate};
};

}  // namespace roverd::robot
