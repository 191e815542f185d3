#pragma once
// A GNSS receiver that speaks NMEA 0183, u-blox UBX or both on a byte stream. A sentence below is
// a UBX frame as well.
//
//   Down ─start─▶ Opening ─intact sentence─▶ Up ─2 s without one─▶ Faulty ─intact sentence─▶ Up
//                    ▲  └─open refused, closed, 2 s without one ──▶ │
//                    └───────────────── back-off over ──────────────┘
//   any ─stop─▶ Down
//
// Silence alone does not close the port; it is opened again when it stays silent for
// silent_reopen_s. Faulty says which silence: "no bytes" (cable, power) or "bytes but no sentence"
// (baud rate, another device on this port), or that the receiver repeats one epoch for ever
// (ClockWatch): nothing it says then is used. A link that can try other baud rates does so.
//
// A receiver that is up and sends no position message (satellites only, say) is told by the fact
// "no_position".
//
// Measurements: GnssFix, GnssVelocity, Heading (gnss/epoch.hpp, gnss/ubx_epoch.hpp and
// gnss/blend.hpp say how), SatellitesInView (gnss/sky.hpp), DriverStatus on change and twice a
// second; received counts decoded sentences, refused the damaged ones and those of a standing
// clock; its DriverDetail has the counts by cause, and who the receiver is.
//
// It writes nothing to the receiver but corrections and what gnss/ubx_setup.hpp says.
//
// Threads: the device thread only.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/measurements.hpp"
#include "base/result.hpp"
#include "gnss/blend.hpp"
#include "gnss/clock_watch.hpp"
#include "gnss/decoder.hpp"
#include "gnss/epoch.hpp"
#include "gnss/params.hpp"
#include "gnss/sky.hpp"
#include "gnss/ubx_epoch.hpp"
#include "gnss/ubx_setup.hpp"
#include "link/port.hpp"

namespace roverd::gnss {

class Driver {
 public:
  using MakeLink = link::BytePort::MakeLink;
  using OnMeasurement = link::BytePort::OnMeasurement;

  /// @param params valid (validate).
  Driver(std::string name, const Params& params, MakeLink make_link, OnMeasurement on_measurement);

  /// Opens at once; a failure shows as Faulty and is tried again.
  void start(Time now);
  /// 20 to 50 times a second: time-outs, back-off, incomplete epochs, status.
  void tick(Time now);
  /// Closes, and is Down. Idempotent.
  void stop(Time now);
  void restart(Time now);

  /// Correction frames for the receiver, oldest first, appended to the vector; called in tick().
  /// Empty: there are none. What the port has no room for is dropped and counted.
  using Frames = std::vector<std::vector<std::uint8_t>>;
  std::function<void(Frames&)> take_corrections;

  base::DriverStatus status(Time now) const { return port_.status(now); }
  const SentenceCounts& counts() const noexcept { return decoder_.counts(); }
  const Framer::Counts& framing() const noexcept { return decoder_.framing(); }

 private:
  void begin(Time now);
  void check_silence(Time now);
  void on_bytes(Bytes bytes, Time stamp);
  std::uint64_t intact() const noexcept { return counts().intact() + counts().ubx; }
  void tell(const base::Measurement& m);
  void complete(base::DriverStatus& status) const;
  void take(const Sentence& sentence, Time stamp);
  void take(const ubx::Message& message, Time stamp);
  void clock_stands(Time stamp);
  void after_bytes(std::uint64_t intact_before, Time stamp);
  void forget_epochs();
  void retune(Time now);
  void talk(Time now);
  void correct();
  std::map<std::string, std::uint64_t> causes() const;

  const Params params_;
  const OnMeasurement on_measurement_;
  Decoder decoder_;
  Blend blend_;
  EpochAssembler epochs_;
  UbxEpochs ubx_epochs_;
  Sky sky_;
  UbxSetup setup_;
  ClockWatch clock_;
  ClockWatch ubx_clock_;
  std::uint64_t frozen_ = 0;            ///< sentences of a standing clock
  std::uint64_t ubx_before_ = 0;        ///< frames before the link was opened
  std::uint64_t corrections_ = 0;       ///< frames handed to the receiver
  std::uint64_t corrections_lost_ = 0;  ///< for which its port had no room
  std::uint64_t sent_ = 0;              ///< requests to the receiver
  Time last_byte_{};                    ///< or the opening
  Time last_intact_{};                  ///< or the opening
  Time retuned_{};                      ///< or the opening
  Time last_fix_{};                     ///< told, with a position or without; or the opening
  bool no_position_ = false;
  link::BytePort port_;  ///< last: its callbacks use all above
};

}  // namespace roverd::gnss
