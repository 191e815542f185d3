#pragma once
// What a guided calibration drive is, and what it came to: words of the snapshot.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/geo.hpp"

namespace roverd::base {

/// Drive: all of how it answers. Steering: of a steered vehicle, its wheels alone. Compass: offset
/// of the place and the iron. Antennas: how two of them are mounted.
enum class CalibrationKind { Drive, Steering, Compass, Antennas };
inline constexpr std::array kCalibrationKinds{CalibrationKind::Drive, CalibrationKind::Steering,
                                              CalibrationKind::Compass, CalibrationKind::Antennas};
std::string_view to_string(CalibrationKind kind) noexcept;  // drive steering compass antennas
std::optional<CalibrationKind> calibration_from(std::string_view text) noexcept;

/// Failed: it could not be driven to its end. Aborted: somebody or something else ended it.
enum class CalibrationPhase { None, Running, Done, Failed, Aborted };
std::string_view to_string(CalibrationPhase phase) noexcept;  // none running done failed aborted

enum class Quantity {
  SteeringDelay,   ///< s, from a command to its turn
  DriveDelay,      ///< s, from a command to its speed
  Braking,         ///< m/s², when it is told to stand
  Acceleration,    ///< m/s²
  SpeedScale,      ///< way over ground for that of the tracks
  TurnScale,       ///< turn over ground for that of the tracks
  SideBias,        ///< 1/m, bend of a straight command; left positive
  SteeringZero,    ///< rad, where steered wheels stand when told to stand straight; left positive
  CompassOffset,   ///< rad, shown minus true; left positive
  CompassSpread,   ///< rad, what is left of it by heading, 1 sigma
  AntennasOffset,  ///< rad, shown minus driven; left positive
};
inline constexpr std::size_t kQuantities = 11;
std::string_view to_string(Quantity q) noexcept;  // steering_delay drive_delay braking …

struct CalibrationValue {
  Quantity of = Quantity::Braking;
  std::optional<double> before;  ///< in use when the drive began
  std::optional<double> after;   ///< measured; empty: not yet, or not well enough
  double sigma = 0.0;            ///< of `after`
  double least = 0.0;            ///< what a vehicle can have
  double most = 0.0;
  bool at_least = false;  ///< it did what it was told; more was not asked
  bool keeps = true;      ///< a word of keep uses it; else it is merely told

  bool inside() const noexcept { return after && *after >= least && *after <= most; }
};

/// What the drive needs, from where the robot stands, along and beside where it points, the body
/// included.
struct CalibrationSpace {
  double ahead_m = 0.0;
  double behind_m = 0.0;
  double left_m = 0.0;
  double right_m = 0.0;
};

struct CalibrationState {
  std::uint64_t id = 0;  ///< counts the drives; 0: none yet
  CalibrationPhase phase = CalibrationPhase::None;
  CalibrationKind kind = CalibrationKind::Drive;
  std::string reason;     ///< why failed or aborted
  std::string_view step;  ///< stands straight turn circle
  int steps_done = 0;
  int steps = 0;
  double share = 0.0;  ///< done, 0..1
  double left_s = 0.0;
  CalibrationSpace space;
  EnuPoint from;  ///< where it began, in the robot's frame; of any phase but None
  double from_yaw_rad = 0.0;
  std::array<CalibrationValue, kQuantities> values{};
  std::size_t count = 0;  ///< of them
};

}  // namespace roverd::base
