#pragma once
// Range sensors on a byte link (codec.hpp): each good line becomes a base::Sight at once.
//
//   Down ─start─▶ Opening ─line─▶ Up ─silent─▶ Faulty ─line─▶ Up
//                    ▲  └─ open refused, closed ─▶ │
//                    └────── back-off over ────────┘
//
// A range that is refused is unknown, and counted; the others of its line count. A line in which
// every range is refused is none.
//
// Device thread only.

#include <string>

#include "base/sight.hpp"
#include "link/port.hpp"
#include "ranges/codec.hpp"
#include "ranges/fan.hpp"
#include "ranges/params.hpp"

namespace roverd::ranges {

using base::Time;

class Driver {
 public:
  using MakeLink = link::BytePort::MakeLink;
  using OnMeasurement = link::BytePort::OnMeasurement;

  /// @param params valid (validate). @param on_measurement, on_sight called on the device thread.
  Driver(std::string name, const Params& params, MakeLink make_link, OnMeasurement on_measurement,
         base::OnSight on_sight);

  void start(Time now);
  void tick(Time now);
  void stop(Time now) { port_.stop(now); }
  void restart(Time now);
  base::DriverStatus status(Time now) const { return port_.status(now); }

 private:
  void on_line(std::string_view text, Time stamp);
  void tell_facts(const std::vector<Reading>& readings);

  const Params params_;
  const double unit_m_;
  const base::OnSight on_sight_;
  const Fans fans_;
  Lines lines_;
  std::uint64_t count_ = 0;
  link::BytePort port_;  ///< last: its callbacks use all above
};

}  // namespace roverd::ranges
