#pragma once
// The bumper on a byte link.
//
//   Down ─start─▶ Opening ─intact line─▶ Up ─silent─▶ Faulty ─intact line─▶ Up
//                    ▲  └─ open refused, closed ───────▶ │
//                    └───────── back-off over ───────────┘
//
// Each intact line becomes a base::Bumper at once; the robot latches the emergency stop at the
// first one that is pressed. Whenever it is not Up its status lists a hazard: a robot whose bumper
// is enabled and cannot be heard does not move.
//
// Device thread only.

#include <string>

#include "bumper/codec.hpp"
#include "bumper/params.hpp"
#include "link/port.hpp"

namespace roverd::bumper {

using base::Time;

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
  void forget();

  const Params params_;
  const OnMeasurement on_measurement_;
  Decoder decoder_;
  std::uint64_t damaged_ = 0;  ///< of decoder_, as counted
  link::BytePort port_;        ///< last: its callbacks use all above
};

}  // namespace roverd::bumper
