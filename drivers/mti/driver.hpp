#pragma once
// An Xsens MTi (or MTi-G) on a byte link.
//
//   Down ─start─▶ Opening ─intact sample─▶ Up ─silent, frozen─▶ Faulty ─intact sample─▶ Up
//                    ▲  └─ open refused, closed, silent ────────▶ │
//                    └─────────────── back-off over ──────────────┘
//
// Silence alone does not close the port before silent_reopen_s; a link that can try other baud
// rates does so whenever nothing that came was a message for silent_after_s and a second.
//
// Measurements: Inertial, Attitude, Heading, and of an MTi-G on request GnssFix, GnssVelocity and
// SatellitesInView (mti/interpreter.hpp); DriverStatus on change and twice a second. received
// counts whole MTData2 messages that were used, refused everything that was not believed, each by
// its cause. Facts: what the unit says of itself, its answers to the configuration, its filter's
// state.
//
// It writes nothing to the unit but what mti/setup.hpp says, and only with params.configure.
//
// Threads: the device thread only.

#include <memory>
#include <string>

#include "base/measurements.hpp"
#include "link/port.hpp"
#include "mti/interpreter.hpp"
#include "mti/params.hpp"
#include "mti/setup.hpp"
#include "mti/xbus.hpp"

namespace roverd::mti {

class Driver {
 public:
  using MakeLink = link::BytePort::MakeLink;
  using OnMeasurement = link::BytePort::OnMeasurement;

  /// @param params valid (validate).
  Driver(std::string name, const Params& params, MakeLink make_link, OnMeasurement on_measurement);

  void start(Time now);
  /// 20 to 50 times a second: requests, time-outs, back-off, status.
  void tick(Time now);
  void stop(Time now) { port_.stop(now); }
  void restart(Time now);
  base::DriverStatus status(Time now) const { return port_.status(now); }
  const Framer::Counts& framing() const noexcept { return framer_.counts(); }

 private:
  void on_bytes(Bytes bytes, Time stamp);
  void on_message(const Message& message, Time stamp);
  void forget();
  void check_silence(Time now);
  void talk(Time now);
  void count_framing();
  void say_status();

  const Params params_;
  Framer framer_;
  Framer::Counts counted_;  ///< of framer_, as told
  Setup setup_;
  Interpreter interpreter_;
  bool was_open_ = false;
  bool heard_here_ = false;  ///< an intact message at this baud rate
  Time tuned_{};
  std::optional<Time> begun_;  ///< bytes of a message that is not complete wait since then
  std::optional<std::uint32_t> status_told_;
  link::BytePort port_;  ///< last: its callbacks use all above
};

}  // namespace roverd::mti
