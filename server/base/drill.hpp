#pragma once
// The failures that a drill plays in simulated time, by the words of the public interface. Which of
// them a vehicle has, and how they are played, the study knows.

#include <algorithm>
#include <array>
#include <string_view>

namespace roverd::base {

struct DrillFailure {
  std::string_view id;
  std::string_view title;  ///< for people
};

inline constexpr std::array kDrillFailures{
    DrillFailure{"estop_page", "Emergency stop from the page"},
    DrillFailure{"estop_button", "Red button on the robot"},
    DrillFailure{"bumper", "Bumper hit"},
    DrillFailure{"operator_lost", "No operator heard any more"},
    DrillFailure{"radio_takeover", "Radio takes over, sticks in the middle"},
    DrillFailure{"radio_lost", "Transmitter out of range"},
    DrillFailure{"radio_frozen", "Transmitter frozen, not told"},
    DrillFailure{"drive_link", "Drive link dead"},
    DrillFailure{"commands_lost", "Commands to the base lost"},
    DrillFailure{"feedback_lost", "Frames of the base lost"},
    DrillFailure{"motor_fault", "Fault bits of the motors"},
    DrillFailure{"second_commander", "Somebody else commands the base"},
    DrillFailure{"program_killed", "roverd dies"},
    DrillFailure{"battery_empty", "Battery below its limit"},
    DrillFailure{"gnss_outage", "Receiver without a fix"},
    DrillFailure{"gnss_silent", "Receiver silent"},
    DrillFailure{"gnss_frozen", "Receiver repeats its last position"},
    DrillFailure{"gnss_jump", "Position jumps 5 m to the left"},
    DrillFailure{"imu_silent", "Inertial unit silent"},
    DrillFailure{"gyro_biased", "Gyro wrong by 5 degrees a second"},
    DrillFailure{"wheels_spin", "Tracks or wheels spin"},
};

/// Null: there is no such failure.
constexpr const DrillFailure* drill_failure(std::string_view id) noexcept {
  const auto* const found = std::find_if(kDrillFailures.begin(), kDrillFailures.end(),
                                         [id](const DrillFailure& f) { return f.id == id; });
  return found == kDrillFailures.end() ? nullptr : found;
}

/// What a drill may be asked for: simulated time after the failure, s.
inline constexpr double kDrillLimitMin_s = 5.0;
inline constexpr double kDrillLimitMax_s = 600.0;
inline constexpr double kDrillLimit_s = 120.0;

}  // namespace roverd::base
