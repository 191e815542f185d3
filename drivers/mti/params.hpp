#pragma once
// Settings of the MTi driver. Section [drivers.mti].

#include <string>

#include "base/params.hpp"

namespace roverd::mti {

struct Params {
  bool configure = false;
  double rate_hz = 100.0;
  double mount_yaw_deg = 0.0;
  double mount_pitch_deg = 0.0;
  double mount_roll_deg = 0.0;
  double arm_forward_m = 0.0;
  double arm_left_m = 0.0;
  double arm_up_m = 0.0;
  std::string heading = "field";
  double heading_hz = 10.0;
  double declination_deg = 0.0;
  std::string position = "none";
  double position_hz = 5.0;
  double silent_after_s = 0.5;
  double silent_reopen_s = 10.0;
  double retry_first_s = 0.5;
  double retry_max_s = 5.0;
};

template <class V>
void fields(V& v, Params& p) {
  v("configure", p.configure,
    "tell the unit what to send; otherwise it sends what is stored in it, and we listen");
  v("rate_hz", p.rate_hz, 10.0, 400.0, "inertial samples a second, once configured");
  v("mount_yaw_deg", p.mount_yaw_deg, -180.0, 180.0,
    "how the unit is mounted: its x axis points so far left of forward");
  v("mount_pitch_deg", p.mount_pitch_deg, -90.0, 90.0, "then that axis points so far up");
  v("mount_roll_deg", p.mount_roll_deg, -180.0, 180.0,
    "then it is turned about that axis, its left side up; 180: it hangs upside down");
  v("arm_forward_m", p.arm_forward_m, -5.0, 5.0, "the unit ahead of the centre of rotation");
  v("arm_left_m", p.arm_left_m, -5.0, 5.0, "the unit left of the centre of rotation");
  v("arm_up_m", p.arm_up_m, -5.0, 5.0, "the unit above the centre of rotation");
  v("heading", p.heading,
    "field: computed from the magnetic field; orientation: as the unit's own filter says; none");
  v("heading_hz", p.heading_hz, 0.5, 100.0,
    "headings told a second: neighbours are alike, more of them tell nothing new");
  v("declination_deg", p.declination_deg, -180.0, 180.0,
    "true minus magnetic heading where the robot drives, east positive; 0: the unit knows it");
  v("position", p.position,
    "none; filter: what the unit's own filter makes of GNSS and inertia; gnss: its receiver's");
  v("position_hz", p.position_hz, 0.5, 50.0, "positions told a second, of the filter");
  v("silent_after_s", p.silent_after_s, 0.1, 10.0, "without a sample it is faulty");
  v("silent_reopen_s", p.silent_reopen_s, 0.0, 600.0, "a silent port is opened again; 0: never");
  v("retry_first_s", p.retry_first_s, 0.05, 60.0, "first wait before opening again");
  v("retry_max_s", p.retry_max_s, 0.05, 600.0, "longest wait before opening again");
}

/// What `fields` cannot say: the words allowed in the text fields. The error names the field.
inline base::Result<void> validate(const Params& p) {
  if (p.heading != "field" && p.heading != "orientation" && p.heading != "none") {
    return base::fail(base::Code::Invalid, "heading must be field, orientation or none",
                      {{"heading", "must be field, orientation or none"}});
  }
  if (p.position != "none" && p.position != "filter" && p.position != "gnss") {
    return base::fail(base::Code::Invalid, "position must be none, filter or gnss",
                      {{"position", "must be none, filter or gnss"}});
  }
  return {};
}

}  // namespace roverd::mti
