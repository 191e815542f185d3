#pragma once
// The transmitter in the operator's hand, and what may go wrong while the simulator runs.

#include <string>

#include "base/measurements.hpp"
#include "base/result.hpp"
#include "sim/world/faults.hpp"

namespace roverd::sim {

/// Sticks in [−1, 1], up and right positive. The usual position: CAN drives, everything else off.
struct Radio {
  bool on = true;
  base::Switch swa = base::Switch::Up;
  base::Switch swb = base::Switch::Up;  ///< up: the CAN bus drives; other positions: the sticks
  base::Switch swc = base::Switch::Up;
  base::Switch swd = base::Switch::Up;
  double right_lr = 0.0;
  double right_ud = 0.0;
  double left_ud = 0.0;
  double left_lr = 0.0;
  double vra = 0.0;
};

/// Switchable while running. All off: a healthy robot.
struct Faults {
  bool bus_off = false;
  double loss_to_base = 0.0;
  double loss_from_base = 0.0;
  bool estop = false;
  bool radio_loss = false;
  bool radio_freeze = false;
  bool radio_loss_unflagged = false;
  int error_bits = 0;
  bool gnss_outage = false;
  bool gnss_silent = false;
  std::string gnss_fix;
  double gnss_jump_east_m = 0.0;
  double gnss_jump_north_m = 0.0;
  double gnss_jump_s = 0.0;
  double gnss_drift_east_mps = 0.0;
  double gnss_drift_north_mps = 0.0;
  double gnss_base_shift_east_m = 0.0;
  double gnss_base_shift_north_m = 0.0;
  double gnss_time_step_s = 0.0;
  bool gnss_position_frozen = false;
  bool gnss_repeats = false;
  bool gnss_velocity_frozen = false;
  double gnss_velocity_east_mps = 0.0;
  double gnss_velocity_north_mps = 0.0;
  double antennas_extra_deg = 0.0;
  bool antennas_frozen = false;
  double odometry_share = 1.0;
  bool odometry_frozen = false;
  bool odometry_left_stuck = false;
  bool compass_frozen = false;
  bool compass_off = false;
  double compass_extra_deg = 0.0;
  bool imu_silent = false;
  bool imu_freeze = false;
  double imu_gyro_extra_dps = 0.0;
  double imu_gyro_ramp_dps2 = 0.0;
  bool imu_gyro_frozen = false;
  int bumper = 0;
  bool bumper_silent = false;
  world::SensorFaults see;
};

template <class V>
void fields(V& v, Faults& f) {
  v("bus_off", f.bus_off, "the drive link is dead: nothing goes in or out");
  v("loss_to_base", f.loss_to_base, 0.0, 1.0,
    "share of frames or messages lost on the way to the base");
  v("loss_from_base", f.loss_from_base, 0.0, 1.0,
    "share of frames or messages lost on the way from the base");
  v("estop", f.estop, "the red button on the robot is pressed");
  v("radio_loss", f.radio_loss, "the transmitter is out of range: 0x241 stops, error bit 2");
  v("radio_freeze", f.radio_freeze, "out of range: 0x241 repeats its last bytes, error bit 2");
  v("radio_loss_unflagged", f.radio_loss_unflagged, "a lost transmitter does not set error bit 2");
  v("error_bits", f.error_bits, 0, 65535,
    "further error bits of 0x211, 0x441 clears them; elsewhere any of them stops the motors");
  v("gnss_outage", f.gnss_outage, "sentences without a fix");
  v("gnss_silent", f.gnss_silent, "no byte from the receiver");
  v("gnss_fix", f.gnss_fix, "rtk_fixed, rtk_float, dgps, gps or none; empty: by the profile");
  v("gnss_jump_east_m", f.gnss_jump_east_m, -1000.0, 1000.0, "added to the position");
  v("gnss_jump_north_m", f.gnss_jump_north_m, -1000.0, 1000.0, "added to the position");
  v("gnss_jump_s", f.gnss_jump_s, 0.0, 86400.0, "the jump ends after this; 0: it stays");
  v("gnss_drift_east_mps", f.gnss_drift_east_mps, -10.0, 10.0,
    "the position runs away by so much a second; what has run stays until both are 0");
  v("gnss_drift_north_mps", f.gnss_drift_north_mps, -10.0, 10.0, "likewise, northwards");
  v("gnss_base_shift_east_m", f.gnss_base_shift_east_m, -1000.0, 1000.0,
    "corrections come from another base, whose place is wrong by this; its number is another too");
  v("gnss_base_shift_north_m", f.gnss_base_shift_north_m, -1000.0, 1000.0, "likewise, northwards");
  v("gnss_time_step_s", f.gnss_time_step_s, -86400.0, 86400.0,
    "the receiver's clock is so far ahead of the truth, negative: it has stepped back");
  v("gnss_position_frozen", f.gnss_position_frozen,
    "the receiver repeats its last position; its time and its velocity go on");
  v("gnss_repeats", f.gnss_repeats, "the receiver repeats its last sentences, byte by byte");
  v("gnss_velocity_frozen", f.gnss_velocity_frozen,
    "the receiver repeats its last speed and course; its time and its position go on");
  v("gnss_velocity_east_mps", f.gnss_velocity_east_mps, -20.0, 20.0, "added to the velocity");
  v("gnss_velocity_north_mps", f.gnss_velocity_north_mps, -20.0, 20.0, "added to the velocity");
  v("antennas_extra_deg", f.antennas_extra_deg, -180.0, 180.0,
    "added to the heading of two antennas");
  v("antennas_frozen", f.antennas_frozen, "two antennas repeat their last heading");
  v("odometry_share", f.odometry_share, 0.0, 5.0,
    "the tracks' counters and speeds tell this share of what the tracks do");
  v("odometry_frozen", f.odometry_frozen, "the tracks' counters stand still; speeds are told on");
  v("odometry_left_stuck", f.odometry_left_stuck, "the left track's encoder tells no motion");
  v("compass_frozen", f.compass_frozen, "the compass repeats its last heading");
  v("compass_off", f.compass_off, "no HDT sentences, no field in the inertial unit's messages");
  v("compass_extra_deg", f.compass_extra_deg, -180.0, 180.0, "added to the compass heading");
  v("imu_silent", f.imu_silent, "no byte from the inertial unit");
  v("imu_freeze", f.imu_freeze, "the inertial unit repeats its last message");
  v("imu_gyro_extra_dps", f.imu_gyro_extra_dps, -100.0, 100.0, "added to the gyro's bias");
  v("imu_gyro_ramp_dps2", f.imu_gyro_ramp_dps2, -10.0, 10.0,
    "the gyro's bias grows by so much a second; what has grown stays until it is 0");
  v("imu_gyro_frozen", f.imu_gyro_frozen,
    "the inertial unit repeats its last rate of turn; its counters and all else go on");
  v("bumper", f.bumper, 0, 255, "switches pressed, one bit each: 1 front left, 2 front …");
  v("bumper_silent", f.bumper_silent, "no line from the bumper");
  fields(v, f.see);
}

}  // namespace roverd::sim
