#pragma once
// A GNSS receiver that speaks NMEA 0183 on a byte stream.
//
//   Down ─start─▶ Opening ─intact sentence─▶ Up ─2 s without one─▶ Faulty ─intact sentence─▶ Up
//                    ▲  └─open refused, closed, 2 s without one ──▶ │
//                    └───────────────── back-off over ──────────────┘
//   any ─stop─▶ Down
//
// Silence alone does not close the port; it is opened again when it stays silent for
// silent_reopen_s. Faulty says which silence: "no bytes" (cable, power) or "bytes but no sentence"
// (baud rate, binary protocol only, another device on this port), or that the receiver repeats one
// epoch for ever (ClockWatch): nothing it says then is used.
//
// Measurements: GnssFix, GnssVelocity, Heading (gnss/epoch.hpp says how), DriverStatus on change
// and twice a second; received counts decoded sentences, refused the damaged ones and those of a
// standing clock; its DriverDetail has the counts by cause.
//
// Threads: the device thread only.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "base/measurements.hpp"
#include "base/result.hpp"
#include "gnss/clock_watch.hpp"
#include "gnss/decoder.hpp"
#include "gnss/epoch.hpp"
#include "gnss/params.hpp"
#include "link/lifecycle.hpp"
#include "link/link.hpp"

namespace roverd::gnss {

class Driver {
 public:
  /// Called until it succeeds; the link is then kept and opened and closed as needed.
  using MakeLink = std::function<base::Result<std::unique_ptr<link::ByteLink>>()>;
  using OnMeasurement = std::function<void(const base::Measurement&)>;

  /// @param params valid (validate).
  Driver(std::string name, const Params& params, MakeLink make_link, OnMeasurement on_measurement);
  ~Driver();
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

  /// Opens at once; a failure shows as Faulty and is tried again.
  void start(Time now);
  /// 20 to 50 times a second: time-outs, back-off, incomplete epochs, status.
  void tick(Time now);
  /// Closes, and is Down. Idempotent.
  void stop(Time now);
  void restart(Time now);

  base::DriverStatus status(Time now) const;
  const SentenceCounts& counts() const noexcept { return decoder_.counts(); }
  const Framer::Counts& framing() const noexcept { return decoder_.framing(); }

 private:
  void open(Time now);
  void fail(const std::string& reason, Time now);
  void check_silence(Time now);
  void report(Time now);
  void on_bytes(Bytes bytes, Time stamp);
  void take(const Sentence& sentence, Time stamp);
  void after_bytes(std::uint64_t intact_before, Time stamp);
  std::map<std::string, std::uint64_t> causes() const;

  const std::string name_;
  const Params params_;
  const MakeLink make_link_;
  const OnMeasurement on_measurement_;
  std::unique_ptr<link::ByteLink> link_;
  link::Lifecycle life_;
  Decoder decoder_;
  EpochAssembler epochs_;
  ClockWatch clock_;
  std::uint64_t frozen_ = 0;  ///< sentences of a standing clock
  bool open_ = false;
  Time now_{};          ///< of the last call, for callbacks that carry no time
  Time last_byte_{};    ///< or the opening
  Time last_intact_{};  ///< or the opening
  std::optional<Time> last_received_;
};

}  // namespace roverd::gnss
