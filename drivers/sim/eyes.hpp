#pragma once
// What simulated sensors say: shots made into the bytes of the devices. Pure: time is an argument,
// the sockets are the caller's.
//
//   lms     CoLa A or B, as it is asked; scans once they are subscribed to
//   vlp16   data packets of 24 firings, strongest or last return; of 12 firings with both
//   range   lines of metres, "1.234"; nothing within reach: "oor"
//   depth   depth images of docs/cloud-format.md, millimetres along the optical axis
//   picture a stream of JPEG pictures over HTTP, as an IP camera's (picture_voice.hpp)
//   vision  what a camera's program recognises in an image (vision_voice.hpp), a datagram each

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/bytes.hpp"
#include "cloud/codec.hpp"
#include "sick/commands.hpp"
#include "sick/scan.hpp"
#include "sim/picture_voice.hpp"
#include "sim/surroundings.hpp"
#include "sim/world/sensor.hpp"
#include "velodyne/codec.hpp"

namespace roverd::sim {

/// One LMS1xx as its client sees it: answers to requests, and scans of sweeps. Who has logged in
/// may set frequency and resolution (as an LMS1xx has them), the part of the field that is sent,
/// and what a scan holds; others are refused. It forgets all of it when it is restarted.
class LmsVoice {
 public:
  /// @param begin_s when it was switched on: its clock's zero.
  LmsVoice(const world::SensorParams& p, double begin_s)
      : usual_(p), params_(p), begin_s_(begin_s) {}

  /// Bytes from the client. @return the answers, in the dialect that was asked in.
  std::vector<std::uint8_t> receive(base::Bytes bytes);
  /// Empty: nobody subscribed.
  std::vector<std::uint8_t> say(const world::Sweep& sweep, const world::SensorFaults& faults);
  void restart(double now_s);
  /// With what was set of it: how the beams are to be cast from now on.
  const world::SensorParams& wanted() const noexcept { return params_; }

 private:
  std::vector<std::uint8_t> answer(const sick::Telegram& telegram, const sick::Words& words);
  std::vector<std::uint8_t> refused(int code) const;
  std::vector<std::uint8_t> set(const sick::Telegram& telegram, const sick::Words& words);
  std::vector<std::uint8_t> set_scan(sick::Fields& fields);
  bool sends(std::int32_t angle_e4deg) const noexcept;

  const world::SensorParams usual_;
  world::SensorParams params_;
  double begin_s_;
  sick::Framer framer_;
  sick::Dialect dialect_ = sick::Dialect::B;
  bool subscribed_ = false;
  bool logged_in_ = false;
  std::optional<sick::OutputRange> range_;  ///< empty: the whole field
  sick::DataConfig data_;
  std::uint16_t telegrams_ = 0;
  std::uint16_t scans_ = 0;
};

/// A data packet of a vlp16's sweep, stamped with the sweep's time.
/// @param first firing of the sweep that it begins with; with dual return it holds 12 firings, else
/// 24.
std::vector<std::uint8_t> vlp16_packet(const world::Sweep& sweep, velodyne::ReturnMode mode,
                                       std::size_t first = 0);
/// Of a depth sensor. @param at_s on the camera's clock.
std::vector<std::uint8_t> depth_frame(const world::SensorParams& p, const world::Sweep& sweep,
                                      double at_s, bool good);
/// "1.234\\n"
std::vector<std::uint8_t> range_line(const world::Sweep& sweep);

/// A sensor with its voice, its faults and its delay.
class Eye {
 public:
  Eye(const world::SensorParams& p, std::uint64_t seed, double begin_s);

  const world::SensorParams& params() const noexcept { return sensor_.params(); }
  /// Runs up to now: what is due to leave goes to `say`, in order.
  void advance(const Surroundings& around, const world::SensorFaults& all,
               const std::function<void(base::Bytes)>& say);
  /// Bytes from the host. @return the answer; may be empty.
  std::vector<std::uint8_t> receive(base::Bytes bytes);
  /// Its connection is to be cut (fault sensor_restart).
  bool cut() const noexcept { return cut_; }

 private:
  struct Waiting {
    double due_s;
    std::vector<std::uint8_t> bytes;
  };
  void speak(const Surroundings& around, const world::SensorFaults& faults);
  void speak_vlp16(double late_s);
  void wait(double due_s, std::vector<std::uint8_t> bytes);
  void take_wanted();

  const std::uint64_t seed_;
  world::Sensor sensor_;
  std::optional<LmsVoice> lms_;
  std::optional<PictureVoice> picture_;
  world::Sweep sweep_;
  std::deque<Waiting> waiting_;
  bool cut_ = false;
};

}  // namespace roverd::sim
