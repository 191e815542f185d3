#pragma once
// Drive once, get a map: scan by scan each is laid on what the last ones saw; where the robot comes
// by a place again, the loop is closed and the whole way is bent to agree.
//
//   scan ─▶ laid on the last nodes' points (search round the odometry) ─▶ node, every 0.3 m
//   ten nodes ─▶ laid on places seen long before ─▶ loop, if a second scan agrees ─▶ graph relaxed
//
// A node is a scan whose pose is part of the graph; the scans between hang on the node before them.
// Frame M: the map's; the first scan's odometry is its pose. Pure: no clock, one thread. A scan
// takes a millisecond or two, one that closes loops up to some hundred: not for the control thread.

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "base/result.hpp"
#include "nav/chart/map.hpp"
#include "nav/chart/scan.hpp"
#include "nav/mapping/field.hpp"
#include "nav/mapping/graph.hpp"

namespace roverd::nav::mapping {

struct MapperParams {
  double node_m = 0.3;      ///< a node at least so often
  double node_rad = 0.25;   ///< and when turned so far
  std::size_t local = 20;   ///< nodes whose points the next scan is laid on
  double least_fit = 0.35;  ///< score below which the odometry is believed, not the scan
  /// Deviations of the odometry: per metre driven, of direction per metre and per radian turned.
  double slip = 0.2;
  double drift_radpm = 0.12;
  double drift = 0.1;

  bool loops = true;
  double loop_way_m = 12.0;    ///< driven since: less is no loop
  double loop_reach_m = 8.0;   ///< a place so near may be the same one
  double loop_fit = 0.55;      ///< least score of a loop
  double loop_search_m = 1.5;  ///< around where it seems to be, and 2 % of the way since, ...
  double loop_search_rad = 0.2;
  double loop_most_m = 5.0;  ///< ... up to that
  double loop_strain = 6.0;  ///< deviations from all others beyond which a loop is dropped
};

/// Asked now and then by what takes seconds: true, and it ends soon, unfinished. Empty: never.
using GiveUp = std::function<bool()>;

struct DrawParams {
  double resolution_m = 0.05;
  double farthest_m = 25.0;  ///< beams are cut there
  GiveUp give_up{};
};

class Mapper {
 public:
  /// More are refused: half a gigabyte, some 6 km.
  static constexpr std::size_t kMostNodes = 20'000;
  static constexpr std::size_t kMostScans = 1'000'000;

  explicit Mapper(const MapperParams& params = {}) : p_(params) {}

  /// @param odometry X_OB when the scan was taken; drifts, and never jumps.
  /// @return TooLarge: full, what is there stays; Invalid: a number is not finite
  base::Result<void> add(const chart::Scan& scan, const Pose2& odometry);
  /// No more will come: the last loops. @param give_up becomes true: no further one is looked for
  void finish(const GiveUp& give_up = {});

  /// X_MB of the last scan; of every scan, in order. Those before change when a loop is closed.
  Pose2 pose() const;
  std::vector<Pose2> path() const;

  struct Counts {
    std::size_t scans = 0;
    std::size_t nodes = 0;
    std::size_t unfit = 0;    ///< scans that were not found: the odometry's step was taken
    std::size_t loops = 0;    ///< closed, and still believed
    std::size_t dropped = 0;  ///< loops that contradicted all others
  };
  Counts counts() const;

  /// What was seen, drawn from the nodes' scans. Errors as drawn().
  base::Result<chart::OccupancyMap> draw(const DrawParams& how = {}) const;

 private:
  struct Node {
    chart::Scan scan;
    Points points;       ///< of the scan, thinned, in B
    double way_m = 0.0;  ///< driven until here
  };
  struct Hanging {
    std::size_t node = 0;
    Pose2 x_nb;  ///< from the node's body
  };
  Window window_for(const Pose2& step) const;
  void add_node(const chart::Scan& scan, const Pose2& pose, const Fit& fit);
  void refresh_local();
  Field field_around(std::size_t node) const;
  void close_loops(const GiveUp& give_up);
  void try_loop(std::size_t node, std::size_t place);
  void settle();

  MapperParams p_;
  std::vector<Node> nodes_;
  std::vector<Pose2> poses_;  ///< X_MB of the nodes
  std::vector<Edge> edges_;
  std::vector<Hanging> path_;
  std::optional<Field> local_;  ///< in M
  Pose2 last_odometry_;
  double way_m_ = 0.0;
  std::size_t looked_ = 0;  ///< nodes for which loops were looked for
  std::size_t unfit_ = 0;
  std::size_t dropped_ = 0;
  std::size_t found_ = 0;  ///< loops since the graph was relaxed
};

/// Scans at known poses as a map: occupied where most beams that reach a cell end in it.
/// @return Invalid: no beam; TooLarge: the place is larger than a map may be; Unavailable: given up
base::Result<chart::OccupancyMap> drawn(std::span<const chart::Scan* const> scans,
                                        std::span<const Pose2> poses, const DrawParams& how);

}  // namespace roverd::nav::mapping
