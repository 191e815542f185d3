#pragma once
// Logs of CARMEN, the form in which many old recordings of laser scanners are kept. Text, a record
// a line, metres and radians:
//
//   ODOM x y theta tv rv accel t host t'
//   FLASER n r1 … rn x y theta odom_x odom_y odom_theta t host t'
//
// FLASER: n beams over the half circle ahead, from right to left, the first at -90 deg; 181 or 361
// of them reach +90 deg, 180 or 360 end one step before. Both triples of a "corrected" log are the
// pose that somebody found afterwards; the ODOM line behind it repeats that pose, and the following
// ones go on from there. So the odometry is chained here: step by step between ODOM lines, nothing
// where a line only repeats the scan's pose. RLASER, TRUEPOS, PARAM, SYNC, NEFF and # lines are
// passed over. Stamps may jump back or be 0: they are told as they stand.
// Source: the head of the logs themselves ("message formats defined"), CARMEN's logger.
//
// Pure; pieces of any size, at most one line of 64 KiB is kept. What cannot be read is counted.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "nav/chart/scan.hpp"
#include "nav/sense/odometry.hpp"

namespace roverd::atlas {

struct CarmenScan {
  std::uint64_t line = 0;      ///< in the file, from 1
  double time_s = 0.0;         ///< as stamped
  nav::sense::Pose2 odometry;  ///< chained, from the first scan's pose on; drifts
  nav::sense::Pose2 pose;      ///< the scan's first triple: of a corrected log the truth
  float first_rad = 0.0F;      ///< of the first beam; left positive
  float step_rad = 0.0F;
  std::vector<float> ranges_m;  ///< as told; from about 80 m on nothing was seen
};

/// What was hit, by a scanner that stands on the origin of the body and looks ahead. Beams that saw
/// nothing are left out: these scanners give the same value for "far" and for "dazzled".
/// @param stamp the log's own are not to be trusted.
nav::chart::Scan scan_of(const CarmenScan& scan, base::Time stamp);

class CarmenReader {
 public:
  static constexpr std::size_t kLongestLine = 64 * 1024;
  static constexpr std::size_t kMostBeams = 4096;
  using OnScan = std::function<void(const CarmenScan&)>;

  explicit CarmenReader(OnScan on_scan) : on_scan_(std::move(on_scan)) {}

  void feed(base::Bytes part);
  /// No more will come; a last line without its end is read.
  void finish();

  std::uint64_t scans() const noexcept { return scans_; }
  std::uint64_t odometry_lines() const noexcept { return odometry_lines_; }
  /// Lines that should be records and are not.
  std::uint64_t refused() const noexcept { return refused_; }
  /// The first of them: "line 12: …"; empty: none.
  const std::string& first_refused() const noexcept { return first_refused_; }

 private:
  void line_done();
  /// @return what is wrong; null: nothing.
  const char* odometry_record(std::string_view words);
  const char* scan_record(std::string_view words);

  OnScan on_scan_;
  std::string line_;
  bool too_long_ = false;
  std::uint64_t lines_ = 0;
  std::uint64_t scans_ = 0;
  std::uint64_t odometry_lines_ = 0;
  std::uint64_t refused_ = 0;
  std::string first_refused_;
  CarmenScan scan_;
  std::optional<nav::sense::Pose2> last_;      ///< the ODOM line before
  std::optional<nav::sense::Pose2> repeated_;  ///< pose of the scan just before this line
  nav::sense::Pose2 chained_;
  bool begun_ = false;  ///< chained_ began at the first scan's pose
};

}  // namespace roverd::atlas
