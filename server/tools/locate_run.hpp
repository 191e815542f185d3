#pragma once
// A recorded log against a map: where the tracker says that the robot was, compared with where the
// log says that it was. What `roverd locate` prints, and what tests and measurements look at.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "atlas/carmen.hpp"
#include "base/result.hpp"
#include "nav/chart/map.hpp"
#include "nav/place/tracker.hpp"

namespace roverd {

enum class WhichScans : std::uint8_t { All, Odd, Even };

struct LocateOptions {
  WhichScans use = WhichScans::All;    ///< given to the tracker, counted from 0
  WhichScans score = WhichScans::All;  ///< compared with the log's poses
  bool with_start = true;              ///< the log's first pose is told
  /// How sure the log's poses are, 1 sigma along x, along y and of the heading: counted with the
  /// certainty that is judged by them. 0: they are the truth.
  double truth_m = 0.0;
  double truth_rad = 0.0;
  nav::place::TrackerParams tracker{};
};

/// Of the scored scans.
struct LocateFigures {
  std::size_t scans = 0;   ///< in the log
  std::size_t used = 0;    ///< by the tracker
  std::size_t scored = 0;  ///< of them compared
  std::size_t fixes = 0;   ///< of those that gave a pose
  std::size_t doubtful = 0;
  std::size_t lost = 0;   ///< times that the tracker called itself lost
  std::size_t wrong = 0;  ///< fixes off by more than 1 m or 20 deg
  double median_m = 0.0;
  double p95_m = 0.0;
  double max_m = 0.0;
  double median_deg = 0.0;
  double p95_deg = 0.0;
  double nees = 0.0;       ///< mean of e' C^-1 e over three values: 3 where C is honest; in C what
                           ///< the log's poses are unsure of, too
  double within_95 = 0.0;  ///< share of e' C^-1 e below 7.81, its 95 % point
  double match_p50_ms = 0.0;
  double match_p99_ms = 0.0;
  std::size_t started_after = 0;  ///< used scans until the first fix
};

/// All scans of a log, plain or packed by gzip. @return Malformed: broken packing, or no scan in
/// it.
base::Result<std::vector<atlas::CarmenScan>> scans_of_log(base::Bytes file);

/// Reads the clock for the times of a match only.
LocateFigures locate_log(std::shared_ptr<const nav::place::Field> field,
                         const std::vector<atlas::CarmenScan>& scans, const LocateOptions& options);

/// Starts without a pose from places of a log that are drawn by chance.
struct StartFigures {
  std::size_t starts = 0;
  std::size_t right = 0;    ///< the first pose that was told is right, and came within kScans
  std::size_t later = 0;    ///< right, and came within kMostScans
  std::size_t wrong = 0;    ///< off by more than 1 m or 20 deg: a wrong place called right
  std::size_t untold = 0;   ///< none within kMostScans
  double median_scans = 0;  ///< until it was told
  double median_ms = 0.0;   ///< of one start, all its scans
  static constexpr std::size_t kScans = 10;
  static constexpr std::size_t kMostScans = 60;
};

/// @param starts each with a tracker of its own, at a scan with kMostScans more behind it. Of the
/// scans those of options.use are given. The same seed draws the same places.
StartFigures start_in_log(std::shared_ptr<const nav::place::Field> field,
                          const std::vector<atlas::CarmenScan>& scans, const LocateOptions& options,
                          std::size_t starts);

/// A line a figure.
std::string figures_text(const LocateFigures& f);
std::string figures_text(const StartFigures& f);

}  // namespace roverd
