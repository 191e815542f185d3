#pragma once
// Settings of the GNSS driver.

#include <string>

#include "base/params.hpp"

namespace roverd::gnss {

struct Params {
  std::string heading_source = "compass";
  double heading_offset_deg = 0.0;
  double silent_after_s = 2.0;
  double silent_reopen_s = 15.0;
  double epoch_timeout_s = 0.25;
  double retry_first_s = 0.5;
  double retry_max_s = 5.0;
  double baseline_m = 0.0;
  double baseline_tolerance_pct = 5.0;
  bool ubx_configure = false;
  bool ubx_keep = false;
  std::string ubx_port = "usb";
  double ubx_rate_hz = 5.0;
};

template <class V>
void fields(V& v, Params& p) {
  v("heading_source", p.heading_source,
    "compass or dual_antenna: what HDT and THS are; a compass may be far off");
  v("heading_offset_deg", p.heading_offset_deg, -180.0, 180.0,
    "added to the receiver's heading: the mounting angle of its antennas");
  v("silent_after_s", p.silent_after_s, 0.5, 60.0, "without an intact sentence it is faulty");
  v("silent_reopen_s", p.silent_reopen_s, 0.0, 600.0,
    "a silent port is opened again after this; 0: never (recordings with gaps)");
  v("epoch_timeout_s", p.epoch_timeout_s, 0.02, 2.0,
    "an epoch without its last sentence is used after this");
  v("retry_first_s", p.retry_first_s, 0.05, 60.0, "first wait before opening again");
  v("retry_max_s", p.retry_max_s, 0.05, 600.0, "longest wait before opening again");
  v("baseline_m", p.baseline_m, 0.0, 10.0,
    "distance of the two antennas of a moving-base pair (NAV-RELPOSNED); 0: one antenna. Its "
    "heading points from the base's antenna to the rover's; heading_offset_deg turns it forward");
  v("baseline_tolerance_pct", p.baseline_tolerance_pct, 0.5, 50.0,
    "a pair measured longer or shorter by more than this gives no heading");
  v("ubx_configure", p.ubx_configure,
    "tell a u-blox receiver to send NAV-PVT, NAV-HPPOSLLH, NAV-COV and NAV-RELPOSNED and to take "
    "corrections, on the port that we are connected to");
  v("ubx_keep", p.ubx_keep, "the receiver keeps what it is told, also without power");
  v("ubx_port", p.ubx_port, "which of the receiver's ports that is: usb, uart1 or uart2");
  v("ubx_rate_hz", p.ubx_rate_hz, 1.0, 25.0, "how often it measures once configured");
}

/// What `fields` cannot say: the words allowed in the text fields. The error names the field.
base::Result<void> validate(const Params& params);

}  // namespace roverd::gnss
