#pragma once
// A camera's program that sends what it sees over TCP (docs/cloud-format.md): it connects to a port
// of ours, or listens on one of its own; the link knows which.
//
//   Down ─start─▶ Opening ─frame─▶ Up ─silent─▶ Faulty ─frame─▶ Up
//                    ▲  └─ open refused, closed ─▶ │
//                    └────── back-off over ────────┘
//
// Each frame becomes a base::Sight at once, stamped by the sender's own clock (base::LeastDelay).
// Frames that were lost leave a gap in Sight::count; one that comes twice is dropped.
//
// Device thread only.

#include <optional>
#include <string>

#include "base/least_delay.hpp"
#include "base/sight.hpp"
#include "cloud/codec.hpp"
#include "cloud/eye.hpp"
#include "cloud/params.hpp"
#include "link/port.hpp"

namespace roverd::cloud {

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
  void on_bytes(Bytes bytes, Time stamp);
  void on_frame(const Frame& frame, Time arrival);
  bool follows(const Header& header);
  Time measured_at(const Header& header, Time arrival);
  void tell_health(const Frame& frame, const Eye::Seen& seen);
  void count_refused();
  bool in_ground(const Header& header) const noexcept;

  const Params params_;
  const base::OnSight on_sight_;
  Decoder decoder_;
  Eye eye_;
  base::LeastDelay delay_;
  Time forgot_{};  ///< what had come of a frame, because it took too long
  std::optional<std::int64_t> last_ns_;
  std::optional<std::uint32_t> last_sequence_;
  std::uint64_t count_ = 0;
  std::map<std::string, std::uint64_t> refused_;  ///< of decoder_, as counted
  link::BytePort port_;                           ///< last: its callbacks use all above
};

}  // namespace roverd::cloud
