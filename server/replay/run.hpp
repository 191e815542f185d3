#pragma once
// A recorded run through the drivers' codecs and the estimator, without a clock: the time is the
// recordings' own, so that the same files and settings give the same numbers, bit by bit.
//
//   files ─ by their stamps ─▶ memory links ─▶ drivers ─▶ estimator, a tick every 20 ms ─▶ poses
//
// A recording may go on in X.002.log, X.003.log …: they are found beside it and played after it.

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/measurements.hpp"
#include "base/result.hpp"
#include "base/sight.hpp"
#include "base/snapshot.hpp"
#include "config/settings.hpp"

namespace roverd {

/// One line of the track.
struct ReplayPose {
  double t_s = 0.0;                    ///< since the run's beginning
  std::optional<base::WallTime> wall;  ///< where the recordings have dates
  base::Pose pose;
  base::FixType fix = base::FixType::None;  ///< of the receiver's last word
};

/// What the estimator made of one kind of input.
struct ReplayInput {
  std::uint64_t taken = 0;  ///< measurements
  std::uint64_t used = 0;   ///< that were compared with what was expected
  std::uint64_t rejected = 0;
  double nis_sum = 0.0;     ///< of the used ones
  double square_sum = 0.0;  ///< of their innovations: m2, (m/s)2 or rad2
  double largest = 0.0;
};

struct ReplayReport {
  double duration_s = 0.0;
  std::uint64_t items = 0;  ///< frames and pieces of byte streams
  std::uint64_t poses = 0;  ///< of all ticks
  double way_m = 0.0;
  std::map<std::string, ReplayInput> inputs;    ///< position, velocity, compass, heading …
  base::EstimatorHealth health;                 ///< at the end
  std::vector<base::DriverStatus> drivers;      ///< at the end
  std::vector<std::string> files;               ///< by driver, as they were played
  std::vector<std::string> by_device;           ///< of them: paced by the device's own time
  std::vector<std::string> left_out;            ///< sentences: recordings that nobody here hears
  std::map<std::string, std::uint64_t> sights;  ///< by sensor: scans, turns, images
};

struct ReplayPlan {
  std::vector<std::string> files;
  double every_s = 0.1;      ///< between two poses told; 0: every tick
  base::OnSight on_sight{};  ///< what sensors saw; null: it is counted only
};

/// @param on_pose called in order. Errors: a file that is missing, damaged or no recording, two of
/// a kind, recordings of different runs; what was told before a damaged place stays told.
base::Result<ReplayReport> run_replay(const ReplayPlan& plan, const Settings& settings,
                                      const std::function<void(const ReplayPose&)>& on_pose);

/// Text of the command's output. Numbers have fixed digits.
std::string csv_head();
std::string csv_line(const ReplayPose& pose);
/// "# …" lines.
std::string report_text(const ReplayReport& report);
/// A FeatureCollection with one line; `report` as its member when given.
std::string geojson_text(const std::vector<ReplayPose>& poses, const ReplayReport* report);

/// roverd replay FILE… [--report] [--format csv|geojson] [--every S] [--config FILE]
/// [--vehicle NAME] [--set KEY=VALUE].
struct ReplayCommand {
  ReplayPlan plan{};
  SettingsSource source{.config = "config/robot.toml", .vehicle = {}, .overrides = {}};
  bool report = false;
  bool geojson = false;
};
/// @return exit code: 0, 1 the output cannot be written, 2 wrong settings or files.
int replay(const ReplayCommand& command);

}  // namespace roverd
