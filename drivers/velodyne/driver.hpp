#pragma once
// A VLP-16 on a datagram link (UDP 2368), its position packets on a second one (UDP 8308) where
// wanted. The sensor sends by itself; nothing is sent to it.
//
//   Down ─start─▶ Opening ─whole turn─▶ Up ─no whole turn─▶ Faulty ─whole turn─▶ Up
//                    ▲  └─ open refused, closed ───────────▶ │
//                    └────────── back-off over ──────────────┘
//
// Every turn is told, parts of turns too (revolutions.hpp); the health stands in the facts: rpm,
// share of directions without a return, mode, product; losses in the counts. Position packets are
// for looking at only: their absence is no fault.
//
// Device thread only.

#include <memory>
#include <string>

#include "base/sight.hpp"
#include "link/port.hpp"
#include "velodyne/codec.hpp"
#include "velodyne/params.hpp"
#include "velodyne/revolutions.hpp"

namespace roverd::velodyne {

class Driver {
 public:
  using MakeLink = link::BytePort::MakeLink;
  using OnMeasurement = link::BytePort::OnMeasurement;

  /// @param params valid (validate). @param on_measurement, on_sight called on the device thread.
  /// @param make_position empty: position packets are not listened to.
  Driver(std::string name, const Params& params, MakeLink make_link, OnMeasurement on_measurement,
         base::OnSight on_sight, MakeLink make_position = {});
  ~Driver();
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

  void start(Time now);
  void tick(Time now);
  void stop(Time now);
  void restart(Time now);
  base::DriverStatus status(Time now) const { return port_.status(now); }
  const Revolutions::Counts& counts() const noexcept { return revolutions_.counts(); }

 private:
  void on_packet(Bytes datagram, Time stamp);
  void on_turn(const Turn& turn);
  void on_position(Bytes datagram);
  void listen_position();
  void close_position() noexcept;
  void complete(base::DriverStatus& status) const;

  const Params params_;
  const base::OnSight on_sight_;
  const MakeLink make_position_;
  std::unique_ptr<link::ByteLink> position_;
  Revolutions revolutions_;
  // Of the packet that is being read.
  Time stamp_{};
  Product product_ = Product::Vlp16;
  ReturnMode mode_ = ReturnMode::Strongest;
  bool heard_packet_ = false;
  link::BytePort port_;  ///< last: its callbacks use all above
};

}  // namespace roverd::velodyne
