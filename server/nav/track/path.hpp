#pragma once
// A path on the ground: a polyline with rounded corners, cut into legs that end in a stop.
//
//      v0 ────────╮            leg 0: v0 … v2 (v1 rounded, passed without stopping)
//                 v1           at v2 the robot stops and turns on the spot
//                 │
//      v3 ◀────── v2           leg 1: v2 … v3
//
// Metres in one local frame. Immutable after build_path; sizes of 10⁵ points are fine: everything
// that runs in the control loop looks at a window around its place.

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "base/geo.hpp"
#include "mission/plan.hpp"
#include "nav/track/params.hpp"
#include "nav/track/slope.hpp"

namespace roverd::nav {

using base::EnuPoint;

/// What limits the speed at a place; the text names it to the operator.
enum class SpeedReason {
  Item,
  Bend,
  Approach,
  Creep,
  Heading,
  Turn,
  Steer,
  Accel,
  Slow,
  Slope,
  Pivot,
  Stopping,
  Standing
};
std::string_view to_string(SpeedReason r) noexcept;  // item bend approach creep heading …

/// One corner of the wanted way.
struct Vertex {
  EnuPoint at;
  double speed_mps = 0.5;  ///< of the way that leads here
  bool reverse = false;    ///< the way that leads here is driven backwards
  bool stop = false;       ///< stop here
  mission::Turn turn = mission::Turn::Auto;
  double deviation_m = 0.1;         ///< allowed between vertex and rounded corner
  std::optional<double> yaw_rad{};  ///< at the path's end or a stop: point so before it counts
  bool dense = false;  ///< may be one of many points of a smooth way (nav/track/smooth.hpp)
  /// Of the way that leads here, left positive; 0: straight. Not for dense ones.
  double curvature_1pm = 0.0;
  bool tangent = false;  ///< the way goes on here without a corner: between a straight and an arc
};

struct PathPoint {
  EnuPoint at;
  double s_m = 0.0;            ///< arc length from the path's start
  double curvature_1pm = 0.0;  ///< of the segment that begins here; left positive
  double segment_mps = 0.0;    ///< limit on the segment that begins here
  double speed_mps = 0.0;      ///< limit at this point, so that all later ones can be kept
  double plan_mps = 0.0;       ///< what speeding up from the leg's start allows of it
  double plan_s = 0.0;         ///< time from the path's start, stops and turns on the spot included
  SpeedReason segment_reason = SpeedReason::Item;
  SpeedReason reason = SpeedReason::Item;  ///< of speed_mps
};

/// Points [first, last]; first < last. Its end is a stop.
struct Leg {
  std::size_t first = 0;
  std::size_t last = 0;
  bool reverse = false;
  double start_m = 0.0;
  double end_m = 0.0;
  double align_rad = 0.0;  ///< pointing away by more than this at its start, the robot pivots first
  std::optional<double> end_yaw_rad{};  ///< to be turned to on the spot before it is done
};

/// Vertices [first, last] that are driven as one smooth curve.
struct SmoothStretch {
  std::size_t first = 0;
  std::size_t last = 0;
  double deviation_m = 0.0;  ///< the curve and the polyline are nowhere farther apart
};

struct Path {
  std::vector<PathPoint> points;
  std::vector<Leg> legs;
  std::vector<SmoothStretch> smoothed;
  std::vector<double> vertex_m;  ///< arc length at which each vertex counts as passed

  double length_m() const noexcept { return points.empty() ? 0.0 : points.back().s_m; }
  /// The leg that leads on from s; the one that ends there counts as done. legs.size() at the end.
  std::size_t leg_from(double s_m) const noexcept;
  /// Index of the segment's first point. @param near a guess.
  std::size_t segment_at(const Leg& leg, double s_m, std::size_t near) const noexcept;
  EnuPoint at(double s_m) const noexcept;
  /// Direction of the path within a leg, arcs taken as such; beyond its ends as there.
  /// @param near a guess.
  double yaw_rad(const Leg& leg, double s_m, std::size_t near) const noexcept;
  /// Planned time that is left from s to the end.
  double left_s(double s_m) const noexcept;
};

struct PathParams {
  TrackParams track;
  SpeedParams speed;
  PivotParams pivot;
  VehicleParams vehicle{};
  SlopeParams slope{};
  ToolParams tool{};
  /// speed.decel_mps2 is a guess: the next stop is begun with a short braking that shows what the
  /// brakes can, as early as half of it needs.
  bool prove_braking = false;
};

/// Vertices nearer than 1 mm to each other are one. Fewer than two different ones: a path without
/// legs. A corner is
///   straight on below 2°, rounded with radius d/(1/cos(θ/2) − 1) up to the pivot angle (always for
///   turn arc and through, as far as the neighbours leave room), else a stop with a turn on the
///   spot. An arc cannot reverse: above 150° it is a pivot as well. A steered vehicle never turns
///   on the spot; what is too sharp for it becomes a swing (nav/track/corner.hpp).
/// Dense vertices that may be so are smoothed first (nav/track/smooth.hpp).
/// Speed limits: item, bends (nav/track/profile.hpp), and braking for what follows.
/// Pure; any finite points. Time and memory linear.
Path build_path(std::span<const Vertex> vertices, const PathParams& params);

}  // namespace roverd::nav
