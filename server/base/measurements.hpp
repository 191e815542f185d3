#pragma once
// What drivers tell the robot. SI, radians, stamped with the monotonic time at which the bytes
// arrived (device units die in the codecs). An unknown value is an empty optional, never zero.

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/geo.hpp"
#include "base/time.hpp"

namespace roverd::base {

/// Ordered: a later one is a better position.
enum class FixType { None, Unknown, Estimated, Single, Differential, RtkFloat, RtkFixed };
std::string_view to_string(
    FixType fix) noexcept;  // none unknown estimated gps dgps rtk_float rtk_fixed

/// One epoch's position. `position` is empty without a fix.
struct GnssFix {
  Time stamp;
  FixType fix = FixType::None;
  std::optional<LatLon> position;
  std::optional<double> alt_msl_m;
  std::optional<double> geoid_sep_m;
  std::optional<int> satellites;
  std::optional<double> hdop;
  std::optional<double> sigma_east_m;  ///< 1σ as the receiver reports it (GST)
  std::optional<double> sigma_north_m;
  std::optional<double> correction_age_s;
  std::optional<WallTime> utc;  ///< epoch by the receiver
  /// Age at its stamp where the device tells when it measured; empty: nav.estimate.gnss_latency_s.
  std::optional<double> latency_s{};
};

/// Velocity over ground.
struct GnssVelocity {
  Time stamp;
  double east_mps = 0.0;
  double north_mps = 0.0;
  std::optional<double> sigma_mps;
  std::optional<double> latency_s{};  ///< as in GnssFix
};

enum class HeadingSource { Compass, DualAntenna };

/// Absolute yaw. A compass may carry a large, slowly changing bias; two antennas do not.
struct Heading {
  Time stamp;
  double yaw_rad = 0.0;
  HeadingSource source = HeadingSource::Compass;
  std::optional<double> sigma_rad{};  ///< as the device reports it
};

/// Along the body's axes: forward, left, up.
struct BodyVector {
  double forward = 0.0;
  double left = 0.0;
  double up = 0.0;
  friend bool operator==(const BodyVector&, const BodyVector&) = default;
};

/// One sample of an inertial unit, turned into the body's axes by its driver.
struct Inertial {
  Time stamp;
  /// About the body's axes, left turns positive, bias included: on the level, up is the yaw rate.
  std::optional<BodyVector> rate_radps;
  std::optional<BodyVector> accel_mps2;  ///< specific force: standing level, up is +9.81
};

/// How the body leans, by a device that works it out itself.
struct Attitude {
  Time stamp;
  double roll_rad = 0.0;   ///< right side down positive
  double pitch_rad = 0.0;  ///< nose up positive
};

/// One signal of a satellite, where the receiver tells them apart.
struct SatelliteSignal {
  std::string name;  ///< "L1 C/A", "E5b I"; a number where it has no name here
  std::optional<double> cn0_dbhz;
  bool used = false;  ///< its code, carrier or Doppler, in the solution
};

/// One satellite as a receiver tells of it.
struct Satellite {
  std::string system;  ///< gps glonass galileo beidou qzss sbas navic unknown
  int number = 0;      ///< within its system
  std::optional<double> elevation_deg;
  std::optional<double> azimuth_deg;  ///< compass
  std::optional<double> cn0_dbhz;     ///< of the strongest signal; empty: in view, not tracked
  std::optional<bool> used;           ///< in the solution
  std::vector<SatelliteSignal> signals{};
};

/// All satellites that one receiver sees; replaces what that receiver told before.
struct SatellitesInView {
  Time stamp;
  std::string driver;
  std::shared_ptr<const std::vector<Satellite>> satellites;
};

/// Track or wheel travel since the last message of this kind.
struct WheelTravel {
  Time stamp;
  double left_m = 0.0;
  double right_m = 0.0;
};

/// Speed and turn rate as the base measures them on its wheels (slip is not seen).
struct BaseMotion {
  Time stamp;
  BodyTwist twist;
  bool assumed = false;  ///< the base tells nothing: this is what it was told to do
};

/// Angle of the (virtual middle) front wheel as the vehicle reports it, left positive.
struct SteeringState {
  Time stamp;
  double wheel_rad = 0.0;
};

enum class VehicleState { Normal, Estop, Exception, Unknown };
enum class ControlMode { Standby, Can, Uart, Radio, Unknown };
std::string_view to_string(VehicleState s) noexcept;  // normal estop exception unknown
std::string_view to_string(ControlMode m) noexcept;   // standby can uart rc unknown

struct BaseStatus {
  Time stamp;
  VehicleState vehicle_state = VehicleState::Unknown;
  ControlMode control_mode = ControlMode::Unknown;
  std::optional<double> battery_v;
  std::uint16_t error_code = 0;
  std::vector<std::string> errors;  ///< error bits in words
  bool radio_lost = false;
  bool battery_fault = false;
};

struct BatteryState {
  Time stamp;
  double charge_pct = 0.0;  ///< 0..100
  double voltage_v = 0.0;
  std::optional<double> current_a;
  std::optional<double> temperature_c;
  std::vector<std::string> alarms{};  ///< in words
};

/// One motor of the base, counted from 1. What its frames have not told yet is empty.
struct MotorState {
  Time stamp;
  int motor = 0;
  std::optional<double> speed_rpm;
  std::optional<double> current_a;
  std::optional<std::int32_t> encoder_pulses;
  std::optional<double> supply_v;
  std::optional<double> driver_temperature_c;
  std::optional<double> motor_temperature_c;
  std::vector<std::string> faults;  ///< in words
};

/// The base's lights. Modes: 0 off, 1 on, 2 breathing, 3 own brightness.
struct LightState {
  Time stamp;
  bool commanded = false;  ///< the computer decides, not the base
  int front_mode = 0;
  int front_pct = 0;
  int rear_mode = 0;
  int rear_pct = 0;
};

/// Contact switches around the robot.
struct Bumper {
  Time stamp;
  bool pressed = false;
  std::string where;  ///< "front left"; empty where the device does not tell
};

enum class Switch { Unknown, Up, Middle, Down };
std::string_view to_string(Switch s) noexcept;  // unknown up middle down

/// Transmitter state. Axes in [−1, 1]: sticks up and right positive.
struct RadioState {
  Time stamp;
  Switch swa = Switch::Unknown;
  Switch swb = Switch::Unknown;
  Switch swc = Switch::Unknown;
  Switch swd = Switch::Unknown;
  double right_lr = 0.0;
  double right_ud = 0.0;
  double left_ud = 0.0;
  double left_lr = 0.0;
  double vra = 0.0;
  std::uint8_t count = 0;
};

/// A driver's own state machine: Down → Opening → Up → Faulty → (back-off) Opening. Failed: it
/// threw or hangs; only a restart on request brings it back (or the end of the hanging).
enum class DriverPhase { Down, Opening, Up, Faulty, Failed };
std::string_view to_string(DriverPhase p) noexcept;  // down opening up faulty failed

/// What is written down of a driver's input. Stopped: it was wanted, and the disk refused.
enum class Recording { Off, On, Stopped };
std::string_view to_string(Recording r) noexcept;  // off on stopped

/// What a driver counts and finds, in words for people. Immutable once told.
struct DriverDetail {
  std::map<std::string, std::uint64_t> counts;  ///< refusals by cause: "0x221 too short"
  std::map<std::string, double> rates_hz;       ///< by message: "0x221"
  std::map<std::string, std::string> facts;     ///< "protocol": "V2", "can_state": "error active"
  std::uint64_t lost = 0;      ///< pieces that the device counted and that never came
  std::uint64_t twice = 0;     ///< pieces that came again, and were not used again
  std::uint64_t foreign = 0;   ///< what somebody else sent to its port
  std::string refused_last{};  ///< cause of the last refusal; empty: nothing was refused
  std::optional<Time> refused_last_at{};
  /// Dangers that this driver alone can see ("somebody else sends 0x111"). While one is listed the
  /// robot does not move.
  std::vector<std::string> hazards;
  /// One of them: somebody else commands the vehicle. Nothing that is armed stays so.
  bool others_command = false;
};

struct DriverStatus {
  Time stamp;
  std::string name;
  DriverPhase phase = DriverPhase::Down;
  std::string reason;          ///< why it is not up; empty when up
  std::uint64_t received = 0;  ///< frames or sentences understood
  std::uint64_t refused = 0;   ///< damaged, out of range
  std::uint64_t sent = 0;
  std::optional<Time> last_received{};
  std::uint64_t restarts = 0;                    ///< on request
  std::string link{};                            ///< address
  std::shared_ptr<const DriverDetail> detail{};  ///< may be null
  bool link_open = false;
  /// Why it was faulty or failed last, and when; kept when it is up again.
  std::string last_error{};
  std::optional<Time> last_error_at{};
  Recording recording = Recording::Off;
  std::string recording_problem{};  ///< why Stopped; empty otherwise
};

/// An operator is there: a client of the stream that watches the vehicle said something, be it that
/// it is there (a ping).
struct OperatorLink {
  Time stamp;
  int clients = 0;  ///< that watch the vehicle
};

/// What is wrong with the robot's own computer. Nothing of it stops the robot.
struct HostProblem {
  std::string id;        ///< storage_failed storage_low storage_silent clock_unset loop_late
                         ///< realtime_refused memory_unlocked not_announced forbidden_left_out
                         ///< forbidden_not_placed
  std::string detail;    ///< in words
  bool alarming = true;  ///< also where safety is told; else in the checks and GET /health alone
  friend bool operator==(const HostProblem&, const HostProblem&) = default;
};

struct HostStatus {
  Time stamp;
  std::vector<HostProblem> problems;
};

/// A place on the earth at which a map shows the body, when it was seen. The covariance is that of
/// the place in the map: an error of the map's own anchor is not in it.
struct PlaceFix {
  LatLon at;             ///< of the body's origin
  double yaw_rad = 0.0;  ///< from east, left positive
  /// Of east, north (m) and yaw (rad): east², east·north, north², east·yaw, north·yaw, yaw².
  std::array<double, 6> covariance{};
  std::uint32_t map = 0;              ///< a number of its own for each map that was taken into use
  std::uint32_t found = 0;            ///< how often the place was found anew
  LatLon anchor;                      ///< where the map's origin lies
  double anchor_sigma_m = 0.0;        ///< how well that is known, 1 sigma
  double anchor_yaw_sigma_rad = 0.0;  ///< how well it is known which way the map looks, 1 sigma
  /// A person said where north is: while nothing else tells it, it is what the map says.
  bool north_said = false;
};

/// Off: no map is in use. Lost: what is seen fits nowhere.
enum class PlacePhase { Off, Lost, Searching, Known };
std::string_view to_string(PlacePhase p) noexcept;  // off lost searching known

/// In a map's frame: metres, yaw left positive.
struct MapPlace {
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;
};

/// How a map's frame lies on the earth.
struct MapLies {
  LatLon at;             ///< of its origin, x = y = 0
  double yaw_rad = 0.0;  ///< of its x axis: from east, left positive
};

/// What the matcher of a map says of one moment.
struct PlaceState {
  Time stamp;  ///< when it was seen; of Off: when it was told
  PlacePhase phase = PlacePhase::Off;
  std::string map;         ///< its name; empty: none
  std::string reason;      ///< one phrase for people; empty: nothing is wrong
  bool says_cure = false;  ///< the reason says what to do
  /// What is seen does not fit where somebody said that the robot is, or fits nowhere any more.
  bool denied = false;
  std::optional<MapPlace> in_map{};  ///< empty: not known
  std::optional<double> sigma_m{};   ///< larger axis
  std::optional<double> sigma_rad{};
  std::optional<MapLies> lies{};  ///< the map; empty: nobody knows
  std::optional<PlaceFix> fix{};  ///< only of a moment at which what is seen fits
};

using Measurement =
    std::variant<GnssFix, GnssVelocity, Heading, Inertial, Attitude, SatellitesInView, WheelTravel,
                 BaseMotion, SteeringState, BaseStatus, BatteryState, MotorState, LightState,
                 RadioState, Bumper, OperatorLink, DriverStatus, HostStatus, PlaceState>;

inline Time stamp_of(const Measurement& m) noexcept {
  return std::visit([](const auto& value) { return value.stamp; }, m);
}

}  // namespace roverd::base
