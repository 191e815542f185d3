#pragma once
// A SICK scanner (LMS1xx, LMS5xx, TiM) on a byte link, CoLa A or CoLa B.
//
//   Down ─start─▶ Opening ─scan─▶ Up ─no scan for silent_after_s, closed─▶ Faulty
//                    ▲  └─ refused, no answer in either dialect ─────────▶ │
//                    └──────────────────── back-off over ──────────────────┘
//
// What it sees goes to on_sight, DriverStatus to on_measurement on change and twice a second.
// received counts scans that were used, refused everything that was not believed, each by its
// cause. A scan that comes twice is used once. Gaps of the scan counter are lost scans, and gaps of
// Sight::count.
//
// Times: the scanner's own clock, fitted to the arrivals (base/sample_clock.hpp), tells when the
// telegram was sent; the scan began so much before as the scanner says, at least so long as its
// beams take: the last one was measured before it was sent.
//
// Facts: dialect, configuration and its refusals, the scanner's names, status, window, what a scan
// holds. A scanner that says that it is not well is Up; its scans say good = false.
//
// It writes nothing but what sick/setup.hpp says.
//
// Threads: the device thread only.

#include <memory>
#include <optional>
#include <string>

#include "base/sample_clock.hpp"
#include "base/sight.hpp"
#include "link/port.hpp"
#include "sick/params.hpp"
#include "sick/scan.hpp"
#include "sick/setup.hpp"
#include "sick/sight.hpp"

namespace roverd::sick {

using base::Time;

class Driver {
 public:
  using MakeLink = link::BytePort::MakeLink;
  using OnMeasurement = link::BytePort::OnMeasurement;

  /// @param params valid (validate).
  Driver(std::string name, const Params& params, MakeLink make_link, OnMeasurement on_measurement,
         base::OnSight on_sight);

  void start(Time now);
  /// 20 to 50 times a second: requests, time-outs, back-off, status.
  void tick(Time now);
  void stop(Time now) { port_.stop(now); }
  void restart(Time now);
  base::DriverStatus status(Time now) const { return port_.status(now); }
  const Framer::Counts& framing() const noexcept { return framer_.counts(); }

 private:
  void forget();
  void begin(Time now);
  void on_bytes(Bytes bytes, Time stamp);
  void on_telegram(const Telegram& telegram, Time stamp);
  void take(const Scan& scan, Time stamp);
  bool is_new(const Scan& scan);
  Time began(const Scan& scan, const Beams& beams, Time stamp);
  void talk(Time now);
  void try_other_dialect(Time now);
  void check_silence(Time now);
  void count_framing();
  void say_facts(const Scan& scan, const Beams& beams);
  void measure_rate(Time now);

  const Params params_;
  const base::OnSight on_sight_;
  Framer framer_;
  Framer::Counts counted_;  ///< of framer_, as told
  Setup setup_;
  Dialect dialect_;          ///< the one to begin with
  bool asked_here_ = false;  ///< over this connection
  bool heard_here_ = false;
  bool tried_other_ = false;
  Time sent_{};                ///< the last request, or the opening
  std::optional<Time> ready_;  ///< scans are due since
  std::optional<Time> begun_;  ///< bytes of a telegram that is not complete wait since then

  struct Last {
    std::uint16_t scan_count;
    std::uint32_t start_us;
    std::uint32_t sent_us;
  };
  std::optional<Last> last_;
  base::SampleClock<1> clock_{false};
  std::uint64_t count_ = 0;  ///< of the next sight
  std::optional<Beams> beams_;
  std::optional<std::array<std::uint8_t, 2>> status_told_;
  std::uint32_t serial_told_ = 0;
  double missing_ = 1.0;
  std::uint64_t taken_ = 0;  ///< scans since rate_from_
  std::optional<Time> rate_from_;
  double rate_hz_ = 0.0;
  link::BytePort port_;  ///< last: its callbacks use all above
};

}  // namespace roverd::sick
