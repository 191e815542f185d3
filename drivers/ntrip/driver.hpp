#pragma once
// Corrections from an NTRIP caster, for the receiver.
//
//   Down ─start─▶ Opening ─first intact RTCM3 frame─▶ Up ─silent, closed─▶ Faulty
//                    ▲ └─refused, no answer, closed ────────────────────────▶│
//                    └──── the first caster in the list whose wait is over ──┘
//
// The casters are tried in their order. One that fails waits retry_first_s, doubled up to
// retry_max_s each time, and starts anew once it gave corrections; one that refuses the login waits
// retry_max_s at once. A caster further down the list is left after return_after_s for the first
// one above it whose wait is over; if that one fails, it is used again. Where the mountpoint is
// missing or unknown, the caster's table is read and named in the facts.
//
// A caster that wants the login as a Digest (RFC 7616) is asked again at once in that way.
//
// Frames with a right CRC go to on_frame unchanged; message numbers, bytes and faults are counted
// in the DriverStatus. A login is never in a status, an error or a log.
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
#include "link/lifecycle.hpp"
#include "link/link.hpp"
#include "ntrip/caster.hpp"
#include "ntrip/params.hpp"
#include "ntrip/reply.hpp"
#include "rtcm/framer.hpp"
#include "rtcm/rtcm2.hpp"

namespace roverd::ntrip {

using base::Bytes;
using base::Time;

class Driver {
 public:
  /// @param address Caster::address().
  using MakeLink =
      std::function<base::Result<std::unique_ptr<link::ByteLink>>(const std::string& address)>;
  using OnMeasurement = std::function<void(const base::Measurement&)>;

  struct Doors {
    MakeLink make_link;
    OnMeasurement on_measurement;          ///< DriverStatus only
    std::function<bool(Bytes)> on_frame;   ///< @return false: no room for it
    std::function<base::GnssFix()> where;  ///< the receiver's last fix
  };

  /// @param casters at least one.
  Driver(std::string name, const Params& params, std::vector<Caster> casters, Doors doors);
  ~Driver();
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

  void start(Time now);
  /// 20 to 50 times a second.
  void tick(Time now);
  void stop(Time now);
  void restart(Time now);

  base::DriverStatus status(Time now) const;

 private:
  /// Asking: the request is to be sent once connected. Waiting: for the answer.
  enum class Stage { Closed, Asking, Waiting, Streaming };
  struct Turn {
    Time not_before{};
    double wait_s = 0.0;
    std::optional<Challenge> challenge{};  ///< how it wants the login; empty: by Basic
    int challenged = 0;                    ///< times in a row
  };

  void open_next(Time now);
  void ask(Time now);
  void on_bytes(Bytes bytes, Time now);
  void on_reply(Time now);
  void on_refused(Time now);
  void on_table(Time now);
  void on_frame(const rtcm::Frame& frame, Time now);
  void check_silence(Time now);
  void tell_position(Time now);
  void look_up_the_list(Time now);
  void fail(const std::string& reason, Time now, bool wait_long = false);
  void close();
  bool caster_said_nothing() const noexcept;
  void report(Time now);
  std::map<std::string, std::uint64_t> tallies() const;

  const std::string name_;
  const Params params_;
  const std::vector<Caster> casters_;
  const Doors doors_;
  std::vector<Turn> turns_;  ///< of the casters
  std::size_t at_ = 0;       ///< the caster in use, or tried last
  std::unique_ptr<link::ByteLink> link_;
  std::unique_ptr<link::ByteLink> old_;  ///< closed inside its own callback; freed at the next tick
  link::Lifecycle life_;
  Stage stage_ = Stage::Closed;
  Time since_{};  ///< of the stage; of Streaming: the last intact frame
  Reply reply_;
  rtcm::Framer framer_;
  rtcm::Rtcm2Ear other_;             ///< of this connection
  std::uint64_t frames_before_ = 0;  ///< this connection
  std::optional<Time> stuck_since_;  ///< a frame has begun and is not complete
  Time streaming_since_{};
  std::uint64_t returns_ = 0;  ///< to a caster further up
  Time told_{};
  bool told_once_ = false;
  std::string mountpoints_;  ///< of the table read last
  std::map<int, std::uint64_t> by_number_;
  std::map<int, Time> heard_;
  std::uint64_t frames_ = 0;
  std::uint64_t lost_ = 0;  ///< no room at the receiver
  std::uint64_t bytes_ = 0;
  std::uint64_t positions_ = 0;
  std::uint64_t connections_ = 0;
  std::optional<Time> last_frame_;
  Time now_{};
};

}  // namespace roverd::ntrip
