#pragma once
// What a gpsd says (its JSON lines, read by libgps) as the robot wants to hear it.
//
//   TPV  position, velocity, fix class     SKY  satellites, HDOP     GST  accuracies
//   ATT  heading                           VERSION, DEVICES, WATCH, ERROR … no measurement
//
// gpsd does not say how certain its epx and epy are; they are taken as 1 sigma per axis where GST
// gives none. Pure state, no clock, no socket.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "base/bytes.hpp"
#include "base/measurements.hpp"
#include "base/result.hpp"

struct gps_data_t;

namespace roverd::gpsd {

using base::Time;

/// gpsd://HOST[:PORT][/DEVICE], port 2947 without one.
struct Source {
  std::string address;  ///< "tcp:HOST:PORT"
  std::string device;   ///< "/dev/ttyACM0"; empty: whichever speaks first
};
base::Result<Source> parse_source(const std::string& text);
inline bool is_source(std::string_view text) {
  return text.starts_with("gpsd://");
}
/// What asks gpsd to tell everything, with its line end.
std::string watch_request(const std::string& device);

/// Bytes to whole lines; a longer one than kLongest is thrown away.
class Lines {
 public:
  static constexpr std::size_t kLongest = 10'240;  ///< gpsd's own limit

  template <class OnLine>
  void feed(base::Bytes bytes, OnLine&& on_line) {
    for (const std::uint8_t b : bytes) {
      if (b == '\n') {
        if (!overlong_ && !line_.empty()) on_line(std::string_view(line_));
        line_.clear();
        overlong_ = false;
      } else if (line_.size() >= kLongest) {
        if (!overlong_) ++too_long_;
        overlong_ = true;
      } else if (b != '\r') {
        line_ += static_cast<char>(b);
      }
    }
  }
  void forget() noexcept {
    line_.clear();
    overlong_ = false;
  }
  std::uint64_t too_long() const noexcept { return too_long_; }

 private:
  std::string line_;
  bool overlong_ = false;
  std::uint64_t too_long_ = 0;
};

struct ReaderOptions {
  std::string driver;  ///< name, for the satellites
  std::string device;  ///< others are not heard; empty: the first that tells of a position
  base::HeadingSource heading_source = base::HeadingSource::Compass;
  double heading_offset_deg = 0.0;
};

class Reader {
 public:
  struct Ears {
    std::function<void(const base::Measurement&)> tell;
    std::function<void(std::string_view cause)> refused;
    std::function<void(std::string_view what)> noted;
    std::function<void(std::string_view key, std::string value)> fact;
  };
  Reader(ReaderOptions options, Ears ears);
  ~Reader();
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  /// One line without its end. @return whether gpsd is there: a report that was understood.
  bool take(std::string_view line, Time stamp);
  void reset();
  /// Time of the last position, s since 1970; empty: it told none.
  std::optional<double> clock_s() const noexcept { return clock_s_; }

 private:
  bool ours();
  void on_tpv(Time stamp);
  void on_sky(Time stamp);
  void on_gst(Time stamp);
  void on_att(Time stamp);

  const ReaderOptions options_;
  const Ears ears_;
  const std::unique_ptr<gps_data_t> data_;
  std::string device_;
  std::optional<double> hdop_;
  std::optional<int> used_;
  struct Sigmas {
    Time stamp;
    double east_m, north_m;
  };
  std::optional<Sigmas> gst_;
  std::optional<double> clock_s_;
};

}  // namespace roverd::gpsd
