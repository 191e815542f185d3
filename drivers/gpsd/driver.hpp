#pragma once
// A receiver that a gpsd serves: gpsd's JSON over TCP, read by libgps.
//
//   Down ─start─▶ Opening ─a report─▶ Up ─no position report─▶ Faulty ─a report─▶ Up
//                    ▲  └─ open refused, closed, silent ──────▶ │
//                    └────────────── back-off over ─────────────┘
//
// gpsd itself speaks even when its receiver is silent, so what counts as heard are its TPV, SKY,
// GST and ATT reports. A receiver that repeats one epoch for ever is Faulty (gnss/clock_watch.hpp).
// Positions of 0, 0 and dates of 1980 are no positions and no dates (gnss/blend.hpp).
//
// Measurements: GnssFix, GnssVelocity, Heading, SatellitesInView (gpsd/report.hpp), DriverStatus on
// change and twice a second. libgps only reads lines here: the socket is ours, and nothing waits.
//
// Threads: the device thread only.

#include <string>

#include "base/measurements.hpp"
#include "gnss/blend.hpp"
#include "gnss/clock_watch.hpp"
#include "gpsd/report.hpp"
#include "link/port.hpp"

namespace roverd::gpsd {

struct Params {
  std::string device;  ///< of Source
  base::HeadingSource heading_source = base::HeadingSource::Compass;
  double heading_offset_deg = 0.0;
  double silent_after_s = 2.0;
  double silent_reopen_s = 15.0;
  double retry_first_s = 0.5;
  double retry_max_s = 5.0;
};

class Driver {
 public:
  using MakeLink = link::BytePort::MakeLink;
  using OnMeasurement = link::BytePort::OnMeasurement;

  Driver(std::string name, const Params& params, MakeLink make_link, OnMeasurement on_measurement);

  void start(Time now);
  void tick(Time now);
  void stop(Time now) { port_.stop(now); }
  void restart(Time now);
  base::DriverStatus status(Time now) const { return port_.status(now); }

 private:
  void on_bytes(base::Bytes bytes, Time stamp);
  void on_line(std::string_view line, Time stamp);
  void forget();

  const Params params_;
  const OnMeasurement on_measurement_;
  Lines lines_;
  std::uint64_t too_long_ = 0;  ///< of lines_, as counted
  gnss::Blend blend_;
  gnss::Blend::Counts blended_;  ///< of blend_, as counted
  gnss::ClockWatch clock_;
  Reader reader_;
  bool measured_ = false;  ///< the present line was a measurement
  bool watching_ = false;
  link::BytePort port_;  ///< last: its callbacks use all above
};

}  // namespace roverd::gpsd
