#pragma once
// What was seen around the robot, kept along the odometry: cells of 5 cm fixed in O. Bounded: what
// is left behind goes, and of too many the oldest.

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "nav/rows/scan.hpp"

namespace roverd::nav::rows {

/// Something that was seen more than once.
struct Mark {
  double x_m = 0.0;  ///< in O
  double y_m = 0.0;
  double ago_m = 0.0;  ///< so much way was driven since it was seen last
};

class Marks {
 public:
  static constexpr double kCell_m = 0.05;
  static constexpr std::size_t kMost = 20'000;

  /// @param reach_m farther from the robot nothing is kept
  void take(const RowScan& scan, double reach_m);
  /// @param out its buffer is used again. In the order in which they came.
  void read(std::vector<Mark>& out) const;
  void clear() noexcept;
  /// Driven since the last clear(), as the odometry says.
  double way_m() const noexcept { return way_m_; }

 private:
  struct Cell {
    double x_m = 0.0;
    double y_m = 0.0;
    double at_m = 0.0;  ///< way at which it was hit last
    std::uint16_t hits = 0;
  };
  void drop_far(const sense::Pose2& body, double reach_m);

  std::vector<Cell> cells_;
  std::unordered_map<std::uint64_t, std::uint32_t> where_;
  double way_m_ = 0.0;
  double dropped_at_m_ = 0.0;
  bool begun_ = false;
  sense::Pose2 last_;
};

}  // namespace roverd::nav::rows
