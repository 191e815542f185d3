#pragma once
// A vision program on a datagram link (codec.hpp), one port for each camera. It sends by itself;
// nothing is sent to it.
//
//   Down ─start─▶ Opening ─datagram─▶ Up ─silent─▶ Faulty ─datagram─▶ Up
//                    ▲  └─── open refused, closed ──▶ │
//                    └───────── back-off over ────────┘
//
// A malformed datagram is refused as a whole and counted by its cause; the newest one stands in
// the facts with field and byte. It is no sign of life.
//
// Device thread only.

#include <string>

#include "base/vision.hpp"
#include "link/port.hpp"
#include "vision/codec.hpp"
#include "vision/params.hpp"

namespace roverd::vision {

using base::Time;

class Driver {
 public:
  using MakeLink = link::BytePort::MakeLink;
  using OnMeasurement = link::BytePort::OnMeasurement;

  /// @param params valid (validate). @param on_measurement, on_vision called on the device thread.
  Driver(std::string name, const Params& params, MakeLink make_link, OnMeasurement on_measurement,
         base::OnVision on_vision);

  void start(Time now) { port_.start(now); }
  void tick(Time now);
  void stop(Time now) { port_.stop(now); }
  void restart(Time now);
  base::DriverStatus status(Time now) const { return port_.status(now); }

 private:
  void on_datagram(Bytes bytes, Time stamp);
  std::string silence() const;

  const Params params_;
  const base::OnVision on_vision_;
  std::uint64_t count_ = 0;
  bool refused_last_ = false;  ///< what came last was malformed
  link::BytePort port_;        ///< last: its callbacks use all above
};

}  // namespace roverd::vision
