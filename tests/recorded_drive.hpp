#pragma once
// The recordings of CARMEN as drives: scans with the odometry as it was, and the pose that somebody
// found afterwards.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "atlas/carmen.hpp"
#include "atlas/unpack.hpp"
#include "nav/mapping/mapper.hpp"
#include "real_data.hpp"

namespace roverd::tests {

struct RecordedDrive {
  std::vector<nav::chart::Scan> scans;
  std::vector<nav::sense::Pose2> odometry;
  std::vector<nav::sense::Pose2> truth;
  double length_m = 0.0;
  double time_s = 0.0;

  explicit RecordedDrive(const std::filesystem::path& path) {
    double began_s = 0.0;
    atlas::CarmenReader reader([&](const atlas::CarmenScan& s) {
      if (truth.empty()) {
        began_s = s.time_s;
      } else {
        length_m += std::hypot(s.pose.x_m - truth.back().x_m, s.pose.y_m - truth.back().y_m);
      }
      time_s = s.time_s - began_s;
      scans.push_back(atlas::scan_of(s, {}));
      odometry.push_back(s.odometry);
      truth.push_back(s.pose);
    });
    atlas::Unpacker unpacker([&](base::Bytes part) { reader.feed(part); });
    if (unpacker.feed(read_file(path)) && unpacker.finish()) reader.finish();
  }

  /// The whole way's: root mean square and worst, metres.
  struct Error {
    double rms_m = 0.0;
    double worst_m = 0.0;
  };
  Error error_of(const std::vector<nav::sense::Pose2>& path) const {
    Error e;
    for (std::size_t i = 0; i < path.size(); ++i) {
      const double d = std::hypot(path[i].x_m - truth[i].x_m, path[i].y_m - truth[i].y_m);
      e.rms_m += d * d / double(path.size());
      e.worst_m = std::max(e.worst_m, d);
    }
    e.rms_m = std::sqrt(e.rms_m);
    return e;
  }
};

}  // namespace roverd::tests
