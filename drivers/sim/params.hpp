#pragma once
// Every number of the simulated robot, with unit, range and meaning. The robot itself never reads
// these: what it knows of its body stands in its own configuration, and may be wrong.

#include <string>
#include <string_view>
#include <vector>

#include "base/params.hpp"
#include "base/result.hpp"
#include "sim/ground_params.hpp"

namespace roverd::sim {

/// How the vehicle is spoken to, and with it what it drives on: "ackermann" is a car with steered
/// front wheels, every other wire belongs to tracks or wheels driven by side.
struct DeviceParams {
  std::string wire = "can";
  std::string port = "udp";
  double feedback_hz = 20.0;
  bool bumper = false;
};

template <class V>
void fields(V& v, DeviceParams& p) {
  v("wire", p.wire, "can (Bunker), ackermann, ratio, twist_text or twist_binary");
  v("port", p.port, "udp, tcp or pty: what carries it, where --drive does not say; not for can");
  v("feedback_hz", p.feedback_hz, 0.0, 100.0,
    "reports a second, on whole steps of 5 ms; 0: the device tells nothing; not for can");
  v("bumper", p.bumper, "a bumper speaks on a pseudo-terminal of its own; not for can");
}

/// Steered front wheels; speed is the section drive's. The body's origin is the rear axle's middle.
struct CarParams {
  double wheelbase_m = 1.3;
  double max_wheel_rad = 0.7;
  double wheel_rate_radps = 0.7;
  double wheel_lag_s = 0.1;
  double linkage_rad = 0.0;
  double servo_rad = 0.0;
};

template <class V>
void fields(V& v, CarParams& p) {
  v("wheelbase_m", p.wheelbase_m, 0.1, 10.0, "between the axles");
  v("max_wheel_rad", p.max_wheel_rad, 0.05, 1.4, "of the middle front wheel, either side");
  v("wheel_rate_radps", p.wheel_rate_radps, 0.01, 20.0, "the wheel turns no faster");
  v("wheel_lag_s", p.wheel_lag_s, 0.0, 2.0, "time constant of the steering, after drive.delay_s");
  v("linkage_rad", p.linkage_rad, -0.3, 0.3,
    "the wheels stand so far right of where the steering motor stands; its sensor cannot see it");
  v("servo_rad", p.servo_rad, -0.3, 0.3,
    "the steering motor stops so far right of where it is told; its sensor sees it");
}

/// From the command on the wire to the motion over ground.
struct DriveParams {
  double track_width_m = 0.60;
  double turn_loss = 1.3;
  double slip = 0.08;
  double side_difference = 0.02;
  double slip_left = 0.0;
  double slip_right = 0.0;
  double crab = 0.0;
  double slip_wander = 0.005;
  double pivot_centre_m = 0.03;
  double delay_s = 0.06;
  double delay_jitter_s = 0.0;
  double delay_hold_s = 0.3;
  double lag_s = 0.09;
  double accel_mps2 = 1.0;
  double decel_mps2 = 1.2;
  double turn_accel_radps2 = 1.6;
  double turn_decel_radps2 = 0.8;
  double estop_decel_mps2 = 3.0;
  double stick_mps = 0.02;
  double max_linear_mps = 1.5;
  double max_angular_radps = 1.0;
  double command_timeout_s = 0.5;
  bool timeout_leaves_can = false;
  double mass_kg = 150.0;
  double payload = 1.0;
  double rolling_resistance = 0.08;
  double scrub_friction = 0.5;
  double contact_length_m = 0.70;
  double motor_rev_per_m = 33.0;
  double newton_per_ampere = 25.0;
};

template <class V>
void fields(V& v, DriveParams& p) {
  v("track_width_m", p.track_width_m, 0.2, 2.0,
    "between the tracks' middle lines; the base divides turn commands and odometry by it");
  v("turn_loss", p.turn_loss, 1.0, 3.0, "nominal over true yaw rate: the tracks scrub in a turn");
  v("slip", p.slip, 0.0, 0.9, "share of the track's travel that does not become way over ground");
  v("side_difference", p.side_difference, -0.2, 0.2,
    "the right track grips better by this share, so a straight command bends left");
  v("slip_left", p.slip_left, 0.0, 0.9, "share that the left track loses besides");
  v("slip_right", p.slip_right, 0.0, 0.9, "likewise the right one; a car loses their mean");
  v("crab", p.crab, -0.5, 0.5,
    "share of the way that slides sideways, to the right; negative: to the left");
  v("slip_wander", p.slip_wander, 0.0, 0.2,
    "1 sigma of a slow random change of either track's slip");
  v("pivot_centre_m", p.pivot_centre_m, -0.5, 0.5, "centre of rotation ahead of the body's origin");
  v("delay_s", p.delay_s, 0.0, 1.0, "pure delay between a frame and the motors");
  v("delay_jitter_s", p.delay_jitter_s, 0.0, 1.0,
    "the delay is longer by up to this, anew every delay_hold_s; commands keep their order");
  v("delay_hold_s", p.delay_hold_s, 0.005, 60.0, "so long one of those delays stays");
  v("lag_s", p.lag_s, 0.0, 2.0, "time constant of the speed loop, after the delay");
  v("accel_mps2", p.accel_mps2, 0.05, 10.0, "limit while the speed grows");
  v("decel_mps2", p.decel_mps2, 0.05, 10.0, "limit while the speed falls");
  v("turn_accel_radps2", p.turn_accel_radps2, 0.05, 20.0, "limit while the turn rate grows");
  v("turn_decel_radps2", p.turn_decel_radps2, 0.05, 20.0,
    "limit while the turn rate falls; skid steer brakes a turn about half as hard");
  v("estop_decel_mps2", p.estop_decel_mps2, 0.1, 20.0, "brake of the e-stop, on either track");
  v("stick_mps", p.stick_mps, 0.0, 0.5, "a standing track stays standing below this command");
  v("max_linear_mps", p.max_linear_mps, 0.1, 5.0, "the base cuts commands to this");
  v("max_angular_radps", p.max_angular_radps, 0.1, 5.0, "the base cuts commands to this");
  v("command_timeout_s", p.command_timeout_s, 0.02, 5.0, "without a motion command the base stops");
  v("timeout_leaves_can", p.timeout_leaves_can,
    "after that time-out the base also goes to standby");
  v("mass_kg", p.mass_kg, 10.0, 2000.0, "for motor currents");
  v("payload", p.payload, 1.0, 5.0,
    "times the mass; every acceleration and braking is so much weaker, and the robot is not told");
  v("rolling_resistance", p.rolling_resistance, 0.0, 1.0, "force over weight, straight ahead");
  v("scrub_friction", p.scrub_friction, 0.0, 2.0, "sideways friction of the tracks in a turn");
  v("contact_length_m", p.contact_length_m, 0.1, 3.0, "of a track on the ground");
  v("motor_rev_per_m", p.motor_rev_per_m, 1.0, 1000.0, "motor revolutions for a metre of track");
  v("newton_per_ampere", p.newton_per_ampere, 1.0, 1000.0, "track force for a motor's ampere");
}

/// The firmware of the base.
struct BaseParams {
  std::string protocol = "v2";
  int motors = 2;
  std::string firmware = "BUNKER-SIM V2.0.1";
  double v1_full_linear_mps = 3.0;
  double v1_full_angular_radps = 2.5235;
};

template <class V>
void fields(V& v, BaseParams& p) {
  v("protocol", p.protocol, "v2, or v1: what older firmware speaks");
  v("motors", p.motors, 2, 4,
    "drive motors that report themselves (V2); 4: numbers 3 and 4 are the second right and left");
  v("firmware", p.firmware, "answer to a version request (V2 only), at most 80 characters");
  v("v1_full_linear_mps", p.v1_full_linear_mps, 0.1, 10.0, "what 100 percent mean in V1");
  v("v1_full_angular_radps", p.v1_full_angular_radps, 0.1, 10.0, "likewise, turning");
}

struct BatteryParams {
  double capacity_ah = 60.0;
  double start_pct = 90.0;
  double full_v = 54.0;
  double empty_v = 42.0;
  double resistance_ohm = 0.05;
  double electronics_w = 45.0;
  double warn_pct = 15.0;
  double fault_pct = 5.0;
  double uneven = 0.0;
};

template <class V>
void fields(V& v, BatteryParams& p) {
  v("capacity_ah", p.capacity_ah, 0.1, 1000.0, "charge between full and empty");
  v("start_pct", p.start_pct, 0.0, 100.0, "state of charge at the start");
  v("full_v", p.full_v, 10.0, 100.0, "open-circuit voltage at 100 %");
  v("empty_v", p.empty_v, 10.0, 100.0, "open-circuit voltage at 0 %");
  v("resistance_ohm", p.resistance_ohm, 0.0, 1.0, "inner resistance: the voltage sags under load");
  v("electronics_w", p.electronics_w, 0.0, 500.0, "drawn while standing");
  v("warn_pct", p.warn_pct, 0.0, 100.0, "below it the under-voltage warning bit is set");
  v("fault_pct", p.fault_pct, 0.0, 100.0, "below it the fault bit is set and the base stops");
  v("uneven", p.uneven, 0.0, 0.9,
    "share of every wanted speed that the motors miss at empty_v, less above, none at full_v, "
    "under load too; the encoders tell it");
}

struct RadioParams {
  double max_linear_mps = 1.2;
  double max_angular_radps = 0.8;
  std::string linear_stick = "right_ud";
  std::string turn_stick = "left_lr";
  int fight_limit = 10;
};

template <class V>
void fields(V& v, RadioParams& p) {
  v("max_linear_mps", p.max_linear_mps, 0.1, 5.0, "speed at full stick");
  v("max_angular_radps", p.max_angular_radps, 0.1, 5.0, "turn rate at full stick");
  v("linear_stick", p.linear_stick, "right_ud or left_ud: which axis drives");
  v("turn_stick", p.turn_stick, "left_lr or right_lr: which axis turns; right turns right");
  v("fight_limit", p.fight_limit, 0, 1000,
    "so many CAN requests while the radio drives latch an exception; 0: never");
}

struct GnssParams {
  std::string profile = "rtk";
  double rate_hz = 5.0;
  double latency_s = 0.12;
  double noise_scale = 1.0;
  double antenna_forward_m = 0.0;
  double antenna_left_m = 0.0;
  double antenna_up_m = 0.0;
  double alt_msl_m = 62.0;
  double geoid_sep_m = 18.4;
  bool antennas = false;
  double antennas_noise_deg = 0.3;
  double antennas_offset_deg = 0.0;
  double velocity_lag_s = 0.0;
};

template <class V>
void fields(V& v, GnssParams& p) {
  v("profile", p.profile,
    "rtk, float, consumer or plain: the receiver's fix class and its errors; plain is a consumer's "
    "with errors of several time constants, Doppler's too");
  v("rate_hz", p.rate_hz, 1.0, 10.0, "epochs a second, on whole fractions of the UTC second");
  v("velocity_lag_s", p.velocity_lag_s, 0.0, 1.0,
    "by which the velocity follows the motion, as of a receiver that filters it");
  v("latency_s", p.latency_s, 0.0, 2.0, "from the epoch to the last byte of its sentences");
  v("noise_scale", p.noise_scale, 0.0, 20.0, "times the profile's position and velocity noise");
  v("antenna_forward_m", p.antenna_forward_m, -3.0, 3.0, "antenna ahead of the body's origin");
  v("antenna_left_m", p.antenna_left_m, -3.0, 3.0, "antenna left of the body's origin");
  v("antenna_up_m", p.antenna_up_m, -1.0, 5.0, "antenna above the body's origin: sways on slopes");
  v("alt_msl_m", p.alt_msl_m, -500.0, 9000.0, "height above mean sea level, constant");
  v("geoid_sep_m", p.geoid_sep_m, -120.0, 120.0, "geoid above the ellipsoid");
  v("antennas", p.antennas, "two antennas: HDT tells their heading, and no compass beside it");
  v("antennas_noise_deg", p.antennas_noise_deg, 0.0, 45.0, "1 sigma of every heading of theirs");
  v("antennas_offset_deg", p.antennas_offset_deg, -180.0, 180.0,
    "they are mounted so far off: shown minus true heading, and nobody told the robot");
}

/// The compass: in the inertial unit where there is one, else beside the receiver, where it speaks
/// HDT (true headings; the inertial unit knows magnetic north only).
struct CompassParams {
  bool fitted = true;
  double bias_deg = 8.0;
  double noise_deg = 1.5;
  double kick_deg_per_a = 0.25;
  double kick_memory_s = 2.0;
  double declination_deg = 0.0;
};

template <class V>
void fields(V& v, CompassParams& p) {
  v("fitted", p.fitted, "false: no HDT sentences (with an inertial unit there are none anyway)");
  v("bias_deg", p.bias_deg, -180.0, 180.0, "shown minus true heading, constant");
  v("noise_deg", p.noise_deg, 0.0, 45.0, "1 sigma of every reading");
  v("kick_deg_per_a", p.kick_deg_per_a, -5.0, 5.0,
    "further error for each ampere by which the motors' currents differ");
  v("kick_memory_s", p.kick_memory_s, 0.0, 60.0,
    "time constant with which that error comes and goes");
  v("declination_deg", p.declination_deg, -180.0, 180.0,
    "true minus magnetic heading, of the field that the inertial unit sees");
}

/// An MTi: gyros, accelerometers, the compass, and an orientation made of them.
struct ImuParams {
  bool fitted = true;
  double rate_hz = 100.0;
  double latency_s = 0.005;
  double gyro_bias_dps = 0.3;
  double gyro_wander_dps = 0.02;
  double gyro_noise_dps = 0.1;
  double accel_bias_mps2 = 0.02;
  double accel_noise_mps2 = 0.05;
  double roll_deg = 0.0;
  double pitch_deg = 0.0;
};

template <class V>
void fields(V& v, ImuParams& p) {
  v("fitted", p.fitted, "false: no inertial unit; the compass then speaks HDT");
  v("rate_hz", p.rate_hz, 1.0, 200.0, "messages a second, on whole steps of 5 ms");
  v("latency_s", p.latency_s, 0.0, 1.0, "from the sample to the last byte of its message");
  v("gyro_bias_dps", p.gyro_bias_dps, -50.0, 50.0, "of each axis, constant");
  v("gyro_wander_dps", p.gyro_wander_dps, 0.0, 5.0,
    "1 sigma of a slow random change of that bias, over five minutes");
  v("gyro_noise_dps", p.gyro_noise_dps, 0.0, 20.0, "1 sigma of every sample");
  v("accel_bias_mps2", p.accel_bias_mps2, -5.0, 5.0, "of each axis, constant");
  v("accel_noise_mps2", p.accel_noise_mps2, 0.0, 5.0, "1 sigma of every sample");
  v("roll_deg", p.roll_deg, -45.0, 45.0, "how the robot leans besides the slope, right side down");
  v("pitch_deg", p.pitch_deg, -45.0, 45.0, "the same, nose up");
}

struct Params {
  DeviceParams device;
  DriveParams drive;
  CarParams car;
  BaseParams base;
  BatteryParams battery;
  RadioParams radio;
  GnssParams gnss;
  CompassParams compass;
  ImuParams imu;
  GroundParams ground;
  TreesParams trees;
  BodyParams body;
};

/// Lists the sections: their names are the tables of the configuration file.
template <class V>
void sections(V& v, Params& p) {
  v("device", p.device);
  v("drive", p.drive);
  v("car", p.car);
  v("base", p.base);
  v("battery", p.battery);
  v("radio", p.radio);
  v("gnss", p.gnss);
  v("compass", p.compass);
  v("imu", p.imu);
  v("ground", p.ground);
  v("trees", p.trees);
  v("body", p.body);
}

/// @param key "section.name". Unknown key, wrong type, out of range, unknown word: an error that
/// names the key; nothing changed.
base::Result<void> set_param(Params& params, std::string_view key, const base::ParamValue& value);

/// Everything as "section.name", in listed order.
std::vector<base::ParamInfo> describe(const Params& params);

}  // namespace roverd::sim
