#pragma once
// One scan against one map: the pose at which it fits best near a start, how certain the map makes
// it, and whether what was seen agrees with the map at all.
//
//   fine pose    least squares over the distances of the hits from their walls, across the wall,
//                with robust weights exp(-e^2 / 2 c^2), c shrinking from wide to narrow: what is
//                not in the map loses its say
//   depth        the map's walls stand a little behind or before where this scanner sees them: the
//                map's cells, the scanner's own error, the wall's material. A scanner that looks
//                one way would be pushed by it, so it is found together with the pose, from walls
//                on both sides of the robot, and kept from scan to scan
//   certainty    C = sigma^2 H^-1 of those distances, the beams counted as fewer than they are
//                because neighbours share one wall and one error of the map; directions in which
//                H is nearly empty (along a corridor) get the greatest deviation that is told
//   agreement    hits at a wall; hits behind a wall of the map (crossed: a contradiction); hits
//                where the map has nothing (people, boxes, what is new); hits where nobody ever
//                saw. How near to the walls' lines they are tells a place from one that is only
//                alike: somewhere in a map of another building most hits are near some wall
//
// Sources: Welsch's robust weights, Holland and Welsch 1977; point-to-line: Censi, ICRA 2008.
// Frame G of the map; poses X_GB. Pure.

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "nav/chart/scan.hpp"
#include "nav/place/field.hpp"

namespace roverd::nav::place {

/// A hit, in B, and the direction in which the beam went there.
struct Point {
  float x_m = 0.0F;
  float y_m = 0.0F;
  float ahead = 1.0F;  ///< of unit length
  float left = 0.0F;
};

/// The hits of a scan in the order of the scan, every n-th if there are more than `most`.
std::vector<Point> hits_of(const chart::Scan& scan, std::size_t most);
/// Hits at least `apart_m` from each other, every n-th of those if there are more than `most`: what
/// a search looks at, so that a near wall does not outvote all others.
std::vector<Point> spread_hits(const chart::Scan& scan, double apart_m, std::size_t most);

/// What is known before, by odometry: information about x, y, yaw of the pose, in G.
struct Prior {
  Pose2 pose;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double depth_m = 0.0;              ///< added to every range
  double depth_deviation_m = 0.002;  ///< of it
};

struct MatchParams {
  double wide_m = 0.25;    ///< c of the robust weights at first
  double narrow_m = 0.15;  ///< and at last
  double beam_m = 0.05;    ///< deviation of one hit from its wall: scanner and map together
  double shared = 8.0;     ///< so many neighbouring beams count as one
  double floor_m = 0.015;  ///< no match is surer than that
  double floor_rad = 0.009;
  double widest_m = 2.0;  ///< told where the map says nothing
  double widest_rad = 0.35;
  double empty = 0.03;  ///< share of the strongest information below which a direction has none
};

struct Match {
  Pose2 pose;                  ///< X_GB
  Eigen::Matrix3d covariance;  ///< of x, y (in G) and yaw, by the map alone, without the prior
  double depth_m = 0.0;
  double depth_deviation_m = 0.0;
  std::size_t used = 0;  ///< hits with a wall within reach
  bool settled = false;  ///< the steps came to an end
};

/// @param points at least one.
Match refine(const Field& field, std::span<const Point> points, const Pose2& start,
             const Prior& prior, const MatchParams& p = {});

/// Shares of the hits, together at most 1.
struct Agreement {
  double explained = 0.0;  ///< at a wall
  double crossed = 0.0;    ///< behind one: the beam went through it
  double odd = 0.0;        ///< in the free space of the map
  double unseen = 0.0;     ///< outside of what the map shows, no wall in between
  double log_fit = 0.0;    ///< mean over the hits of ln p(hit); 0 at best
  double close_fit = 0.0;  ///< likewise, where p is sharp: a hit 0.1 m off its wall's line is odd
  std::size_t hits = 0;
};

/// @param most beams that are looked at.
Agreement agreement(const Field& field, const chart::Scan& scan, const Pose2& pose,
                    std::size_t most = 180);

}  // namespace roverd::nav::place
