#pragma once
// How well a way was driven: the driven points against the intended path, leg by leg.
//
// Each driven point is matched to one place of the path. The place only grows (by a window, so that
// crossings, parallel lanes and laps on the same ground stay apart) and a leg is left for the next
// one at its end, when the robot drives or points as the next one asks for. Rounded corners count
// as intended; near a stop the nearer of both legs counts, and what is beyond it as distance.
//
//   e > 0: left of the way it drives (reversing: left of where the tail goes)
//
// Means weigh each point by the way driven since the last one, so that standing neither helps nor
// harms. Frames: one local ENU for path and points; angles rad, lengths m. Points at 5 Hz do, and
// rates are taken over 0.2 s whatever the rate of the points, so that runs compare.
// Pure; linear in points; any finite values.

#include <cstddef>
#include <span>
#include <vector>

#include "nav/track/path.hpp"

namespace roverd::nav {

/// Where the robot was; the true pose in a simulation, the estimated one in the field.
struct DrivenPoint {
  double t_s = 0.0;  ///< grows from point to point
  EnuPoint at;
  double yaw_rad = 0.0;
  double speed_mps = 0.0;  ///< forward positive
  double yaw_rate_radps = 0.0;
  bool apart = false;  ///< something else was done before it: the way from the last point is none
};

/// The place on the path of a driven point.
struct Matched {
  double t_s = 0.0;
  double s_m = 0.0;
  double cross_m = 0.0;      ///< e: distance from the path, left positive
  double lateral_m = 0.0;    ///< across the leg's direction only, left positive
  double heading_rad = 0.0;  ///< yaw minus the path's direction; reversing, of the tail
  double weight_m = 0.0;     ///< way driven since the point before
  std::size_t leg = 0;
};

/// Of |e|.
struct CrossTrack {
  double rms_m = 0.0;
  double mean_m = 0.0;
  double p95_m = 0.0;
  double max_m = 0.0;
};

/// At one vertex that turns by more than 10°.
struct CornerMeasure {
  std::size_t vertex = 0;
  double s_m = 0.0;
  double deflection_rad = 0.0;  ///< left positive
  double distance_m = 0.0;      ///< nearest the robot came to the vertex
  double inside_m = 0.0;   ///< farthest from the intended way within 2.5 m of it, to the inside
  double outside_m = 0.0;  ///< to the outside
};

/// One straight of 3 m and more, its first and last metre left out.
struct StraightMeasure {
  double from_m = 0.0;
  double to_m = 0.0;
  double slalom_m = 0.0;  ///< p97.5 − p2.5 of e minus its mean over 6 s
};

struct RunMeasure {
  double time_s = 0.0;  ///< from the first point to the last
  double driven_m = 0.0;
  double matched_m = 0.0;  ///< where on the path it ended
  CrossTrack cross;
  double corner_mean_m = 0.0;  ///< of the corners' distances
  double corner_max_m = 0.0;
  double overshoot_max_m = 0.0;  ///< of the corners' outsides
  double cut_max_m = 0.0;        ///< of the corners' insides
  double slalom_max_m = 0.0;
  double slalom_mean_m = 0.0;
  double heading_rms_rad = 0.0;
  double yaw_accel_rms_radps2 = 0.0;  ///< smoothness in turning
  double jerk_rms_mps3 = 0.0;         ///< smoothness along the way
  double end_m = 0.0;                 ///< from the last point to the end of the path
  std::vector<CornerMeasure> corners;
  std::vector<StraightMeasure> straights;
};

/// Which of the points count.
enum class Counts {
  FromNear,  ///< from the first one within 0.5 m of the begin on; where there is none, all
  All        ///< the way to the path is not among them
};

/// Whose places on the path count. A robot that is metres off by its receiver's error is not on the
/// lane that it happens to stand on, but beside the one that it believed to drive.
using Thought = std::span<const DrivenPoint>;

/// @param from_m where on the path the drive began.
/// @param thought empty: the driven points' own places count; else as many, of the same times
/// @return as many as count; empty for an empty path.
std::vector<Matched> match_run(const Path& path, std::span<const DrivenPoint> driven,
                               double from_m = 0.0, Counts counts = Counts::FromNear,
                               Thought thought = {});

/// One run along a path, one lap of it. @param vertices where the mission's points are: vertex i is
/// passed at path.vertex_m[i]; those at the begin and before it are no corners of this run.
/// @param driven without times in which somebody else drove.
RunMeasure measure_run(const Path& path, std::span<const EnuPoint> vertices,
                       std::span<const DrivenPoint> driven, double from_m = 0.0,
                       Counts counts = Counts::FromNear, Thought thought = {});

}  // namespace roverd::nav
