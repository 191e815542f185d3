#pragma once
// The ground under the vehicle: pure functions of the place, the parameters and the seed. Whoever
// comes back to a place finds it as it was.

#include <cstdint>

#include "base/geo.hpp"
#include "sim/motion.hpp"
#include "sim/params.hpp"

namespace roverd::sim {

/// What the ground is like where the vehicle stands now.
struct Footing {
  double roll_rad = 0.0;   ///< right side down positive
  double pitch_rad = 0.0;  ///< nose up positive
  double ahead = 0.0;      ///< metres up for each horizontal metre ahead
  double leftward = 0.0;   ///< the same to the left
  double left_slip = 0.0;  ///< further share of either track's travel that is lost
  double right_slip = 0.0;
  double crab = 0.0;      ///< further share of the way that slides to the right
  double rut_rad = 0.0;   ///< turn for each metre of way, left positive
  double height_m = 0.0;  ///< above the start
};

/// How the ground of a world lies under the vehicle.
struct Lie {
  double ahead = 0.0;     ///< metres up for each horizontal metre ahead
  double leftward = 0.0;  ///< the same to the left
  double height_m = 0.0;
};
/// The footing on such ground: its slope in place of the field's plane.
Footing on_ground(Footing footing, const Lie& lie);

/// 0..1, smooth, the same whenever asked. @param layer keeps several fields apart.
double field_at(std::uint64_t seed, int layer, base::EnuPoint at, double patch_m);

Footing footing_at(const Params& p, std::uint64_t seed, base::EnuPoint at, double yaw_rad);

/// About p.trees.share of the places, all of them at 1.
bool under_trees(const TreesParams& p, std::uint64_t seed, base::EnuPoint at);

/// The drive as it is there, with its load. @param speed_mps ahead, signed: uphill braking gains
/// what acceleration loses.
DriveParams drive_on(const DriveParams& p, const GroundParams& ground, const Footing& footing,
                     double speed_mps);

/// What becomes of the motion that tracks or wheels want: sliding, ruts, and its part along the
/// horizontal plane. @param travel_mps mean of the tracks' speeds, without sign.
GroundMotion slid(GroundMotion wanted, const Params& p, const Footing& footing, double travel_mps);

}  // namespace roverd::sim
