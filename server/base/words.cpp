// The words of the public interface for every enumeration of base: written once, used by the API,
// the log and the events.

#include "base/measurements.hpp"
#include "base/sensing.hpp"
#include "base/sight.hpp"
#include "base/snapshot.hpp"

namespace roverd::base {

std::string_view to_string(FixType fix) noexcept {
  switch (fix) {
    case FixType::None:
      return "none";
    case FixType::Unknown:
      return "unknown";
    case FixType::Estimated:
      return "estimated";
    case FixType::Single:
      return "gps";
    case FixType::Differential:
      return "dgps";
    case FixType::RtkFloat:
      return "rtk_float";
    case FixType::RtkFixed:
      return "rtk_fixed";
  }
  return "unknown";
}

std::string_view to_string(VehicleState s) noexcept {
  switch (s) {
    case VehicleState::Normal:
      return "normal";
    case VehicleState::Estop:
      return "estop";
    case VehicleState::Exception:
      return "exception";
    case VehicleState::Unknown:
      return "unknown";
  }
  return "unknown";
}

std::string_view to_string(ControlMode m) noexcept {
  switch (m) {
    case ControlMode::Standby:
      return "standby";
    case ControlMode::Can:
      return "can";
    case ControlMode::Uart:
      return "uart";
    case ControlMode::Radio:
      return "rc";
    case ControlMode::Unknown:
      return "unknown";
  }
  return "unknown";
}

std::string_view to_string(Switch s) noexcept {
  switch (s) {
    case Switch::Unknown:
      return "unknown";
    case Switch::Up:
      return "up";
    case Switch::Middle:
      return "middle";
    case Switch::Down:
      return "down";
  }
  return "unknown";
}

std::string_view to_string(DriverPhase p) noexcept {
  switch (p) {
    case DriverPhase::Down:
      return "down";
    case DriverPhase::Opening:
      return "opening";
    case DriverPhase::Up:
      return "up";
    case DriverPhase::Faulty:
      return "faulty";
    case DriverPhase::Failed:
      return "failed";
  }
  return "failed";
}

std::string_view to_string(Recording r) noexcept {
  switch (r) {
    case Recording::Off:
      return "off";
    case Recording::On:
      return "on";
    case Recording::Stopped:
      return "stopped";
  }
  return "stopped";
}

std::string_view to_string(Window w) noexcept {
  switch (w) {
    case Window::Unknown:
      return "unknown";
    case Window::Clean:
      return "clean";
    case Window::Dirty:
      return "dirty";
    case Window::Blocked:
      return "blocked";
  }
  return "unknown";
}

std::string_view to_string(SensorHealth h) noexcept {
  switch (h) {
    case SensorHealth::Silent:
      return "silent";
    case SensorHealth::Blind:
      return "blind";
    case SensorHealth::Degraded:
      return "degraded";
    case SensorHealth::Good:
      return "good";
  }
  return "silent";
}

std::string_view to_string(GuardAction a) noexcept {
  switch (a) {
    case GuardAction::None:
      return "none";
    case GuardAction::Slow:
      return "slow";
    case GuardAction::Creep:
      return "creep";
    case GuardAction::Stop:
      return "stop";
    case GuardAction::Overridden:
      return "overridden";
  }
  return "stop";
}

std::string_view to_string(Mode mode) noexcept {
  switch (mode) {
    case Mode::Manual:
      return "MANUAL";
    case Mode::Hold:
      return "HOLD";
    case Mode::Auto:
      return "AUTO";
    case Mode::Guided:
      return "GUIDED";
    case Mode::Rtl:
      return "RTL";
    case Mode::SmartRtl:
      return "SMART_RTL";
    case Mode::Follow:
      return "FOLLOW";
    case Mode::Steering:
      return "STEERING";
    case Mode::Acro:
      return "ACRO";
    case Mode::Simple:
      return "SIMPLE";
    case Mode::Dock:
      return "DOCK";
    case Mode::Loiter:
      return "LOITER";
    case Mode::Circle:
      return "CIRCLE";
  }
  return "HOLD";
}

std::optional<Mode> mode_from(std::string_view text) noexcept {
  for (int i = 0; i <= static_cast<int>(Mode::Circle); ++i) {
    const Mode mode = static_cast<Mode>(i);
    if (to_string(mode) == text) return mode;
  }
  return std::nullopt;
}

std::string mode_words() {
  std::string words;
  for (int i = 0; i <= static_cast<int>(Mode::Circle); ++i) {
    if (i > 0) words += ' ';
    words += to_string(static_cast<Mode>(i));
  }
  return words;
}

std::string_view to_string(TeleopPhase phase) noexcept {
  switch (phase) {
    case TeleopPhase::Off:
      return "off";
    case TeleopPhase::Release:
      return "release";
    case TeleopPhase::Ready:
      return "ready";
    case TeleopPhase::Held:
      return "held";
  }
  return "off";
}

std::string_view to_string(Driver driver) noexcept {
  switch (driver) {
    case Driver::None:
      return "none";
    case Driver::Autonomy:
      return "auto";
    case Driver::Teleop:
      return "teleop";
    case Driver::Radio:
      return "rc";
  }
  return "none";
}

std::string_view to_string(ExecutionState s) noexcept {
  switch (s) {
    case ExecutionState::Idle:
      return "idle";
    case ExecutionState::Loaded:
      return "loaded";
    case ExecutionState::Running:
      return "running";
    case ExecutionState::Paused:
      return "paused";
    case ExecutionState::Blocked:
      return "blocked";
    case ExecutionState::Finished:
      return "finished";
    case ExecutionState::Aborted:
      return "aborted";
  }
  return "idle";
}

std::string_view to_string(ActivityState s) noexcept {
  switch (s) {
    case ActivityState::None:
      return "none";
    case ActivityState::Driving:
      return "driving";
    case ActivityState::Turning:
      return "turning";
    case ActivityState::Waiting:
      return "waiting";
    case ActivityState::Held:
      return "held";
    case ActivityState::Reached:
      return "reached";
    case ActivityState::Failed:
      return "failed";
  }
  return "none";
}

std::string_view to_string(Severity s) noexcept {
  switch (s) {
    case Severity::Info:
      return "info";
    case Severity::Warning:
      return "warning";
    case Severity::Error:
      return "error";
  }
  return "error";
}

std::string_view to_string(Alignment a) noexcept {
  switch (a) {
    case Alignment::Unknown:
      return "unknown";
    case Alignment::Aligning:
      return "aligning";
    case Alignment::Aligned:
      return "aligned";
  }
  return "unknown";
}

std::string_view to_string(PlacePhase p) noexcept {
  switch (p) {
    case PlacePhase::Off:
      return "off";
    case PlacePhase::Lost:
      return "lost";
    case PlacePhase::Searching:
      return "searching";
    case PlacePhase::Known:
      return "known";
  }
  return "off";
}

std::string_view to_string(Refusal r) noexcept {
  switch (r) {
    case Refusal::NotFinite:
      return "not_finite";
    case Refusal::Impossible:
      return "impossible";
    case Refusal::Stamp:
      return "time";
    case Refusal::Zero:
      return "zero_position";
    case Refusal::Date:
      return "date";
    case Refusal::Satellites:
      return "satellites";
    case Refusal::Dilution:
      return "dilution";
    case Refusal::Accuracy:
      return "accuracy";
    case Refusal::Disturbed:
      return "disturbed";
    case Refusal::Jump:
      return "jump";
    case Refusal::Receivers:
      return "receivers";
    case Refusal::Outvoted:
      return "outvoted";
  }
  return "impossible";
}

std::string_view to_string(Sense s) noexcept {
  switch (s) {
    case Sense::Tracks:
      return "tracks";
    case Sense::Gyro:
      return "gyro";
    case Sense::Position:
      return "gnss_position";
    case Sense::Velocity:
      return "gnss_velocity";
    case Sense::Compass:
      return "compass";
    case Sense::Antennas:
      return "antennas";
  }
  return "tracks";
}

std::string_view to_string(CalibrationKind kind) noexcept {
  switch (kind) {
    case CalibrationKind::Drive:
      return "drive";
    case CalibrationKind::Steering:
      return "steering";
    case CalibrationKind::Compass:
      return "compass";
    case CalibrationKind::Antennas:
      return "antennas";
  }
  return "drive";
}

std::optional<CalibrationKind> calibration_from(std::string_view text) noexcept {
  for (const CalibrationKind kind : kCalibrationKinds) {
    if (to_string(kind) == text) return kind;
  }
  return std::nullopt;
}

std::string_view to_string(PlaceVerdict verdict) noexcept {
  switch (verdict) {
    case PlaceVerdict::Unseen:
      return "unseen";
    case PlaceVerdict::Used:
      return "used";
    case PlaceVerdict::Agrees:
      return "agrees";
    case PlaceVerdict::Contradicts:
      return "contradicts";
    case PlaceVerdict::Disputed:
      return "disputed";
    case PlaceVerdict::Ambiguous:
      return "ambiguous";
  }
  return "unseen";
}

std::string_view to_string(CalibrationPhase phase) noexcept {
  switch (phase) {
    case CalibrationPhase::None:
      return "none";
    case CalibrationPhase::Running:
      return "running";
    case CalibrationPhase::Done:
      return "done";
    case CalibrationPhase::Failed:
      return "failed";
    case CalibrationPhase::Aborted:
      return "aborted";
  }
  return "none";
}

std::string_view to_string(Quantity q) noexcept {
  switch (q) {
    case Quantity::SteeringDelay:
      return "steering_delay";
    case Quantity::DriveDelay:
      return "drive_delay";
    case Quantity::Braking:
      return "braking";
    case Quantity::Acceleration:
      return "acceleration";
    case Quantity::SpeedScale:
      return "speed_scale";
    case Quantity::TurnScale:
      return "turn_scale";
    case Quantity::SideBias:
      return "side_bias";
    case Quantity::SteeringZero:
      return "steering_zero";
    case Quantity::CompassOffset:
      return "compass_offset";
    case Quantity::CompassSpread:
      return "compass_spread";
    case Quantity::AntennasOffset:
      return "antennas_offset";
  }
  return "braking";
}

}  // namespace roverd::base
