#pragma once
// The third dimension of a drive: clouds of a lidar, each hung on the way that the Mapper laid.
//
//   way in the plane (loops closed) ─▶ x y yaw ─┐
//   how the body lay ──────────────▶ roll pitch ┼▶ heights agree where two saw the same ground
//   odometry's height ─────────────▶ z ─────────┘  ─▶ each laid on those before it ─▶ cells
//
// What one cloud alone saw, and what most saw through, is left out: who walks behind the robot.
// Frames: B the body at a cloud's stamp, M the map's, z up; the first cloud's body is at height 0.
// Pure: no clock, one thread. Laying takes some 40 ms a cloud: not for the control thread.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "base/result.hpp"
#include "nav/cells/cell_map.hpp"
#include "nav/mapping/mapper.hpp"
#include "nav/sense/odometry.hpp"

namespace roverd::nav::mapping {

struct CloudsParams {
  double every_m = 1.0;      ///< driven from one that is kept to the next
  double farthest_m = 25.0;  ///< of points from the body: beyond, rings lie too far apart
  double thin_m = 0.1;       ///< of the points in a cube of that edge one is kept
};

/// Where a cloud was taken.
struct CloudAt {
  std::size_t scan = 0;  ///< the Mapper's scan that it hangs on, ...
  sense::Pose2 since;    ///< ... and the way from that scan's body to the cloud's, by the odometry
  sense::Lie3 lie;       ///< of the cloud's body; z of the odometry, which drifts
  Eigen::Vector3f eye_m = Eigen::Vector3f::Zero();  ///< where the lidar stood, in B
  double way_m = 0.0;                               ///< driven until there
};

/// Two clouds that saw the same ground: how much higher b's body stands than a's.
struct Rise {
  std::size_t a = 0;
  std::size_t b = 0;
  double m = 0.0;
  double sigma_m = 1.0;
};

class Clouds {
 public:
  /// More are refused: 240 MB, some two kilometres.
  static constexpr std::size_t kMostPoints = 20'000'000;

  explicit Clouds(const CloudsParams& params = {}) : p_(params) {}

  /// After so long a way the next one is wanted.
  bool wants(double way_m) const noexcept;
  /// @param points in B; those that are no numbers are left out
  /// @return TooLarge: full, what is there stays
  base::Result<void> add(std::span<const Eigen::Vector3f> points, const CloudAt& at);
  std::size_t size() const noexcept { return clouds_.size(); }

  /// @param path of the Mapper's scans, X_MB in the plane
  /// @return Invalid: there is no cloud, or nothing was seen twice; Unavailable: given up
  base::Result<cells::CellMap> laid(std::span<const sense::Pose2> path, double cell_m,
                                    const GiveUp& give_up = {}) const;
  /// Where laid() puts the bodies, X_MB; of each cloud, in order. Errors as laid().
  base::Result<std::vector<Eigen::Isometry3d>> settled(std::span<const sense::Pose2> path,
                                                       double cell_m,
                                                       const GiveUp& give_up = {}) const;

 private:
  struct Kept {
    cells::Cloud points;
    CloudAt at;
  };
  std::vector<Rise> rises(std::span<const Eigen::Isometry3d> poses) const;
  Eigen::Isometry3d on_those_before(std::span<const Eigen::Isometry3d> poses, std::size_t i,
                                    double cell_m) const;
  CloudsParams p_;
  std::vector<Kept> clouds_;
  std::size_t points_ = 0;
};

/// Heights that agree best with all; the first is 0. A rise that contradicts the others loses its
/// pull. @param rises tie each to another, sigmas positive. Pure.
std::vector<double> levelled(std::size_t count, std::span<const Rise> rises);

}  // namespace roverd::nav::mapping
