#pragma once
// What one piece of one sensor says of every direction about it: where the nearest obstacle is, and
// how far it was seen to be free. Blind is not free: a stretch is free only where a ray went, low
// enough that something standing there would have met it.
//
//   sensor ●───____            A ray that ends on the ground at D passes the heights between; it
//                  ───___      vouches for the stretch where it is below vouch_m (`seen`), and for
//   ─────────────────────▀▀──  low things where it is below low_m (`low`).
//               seen  low D

#include <array>
#include <cstdint>
#include <vector>

#include "nav/sense/reduce.hpp"

namespace roverd::nav::sense {

struct SightedParams {
  bool planar = false;    ///< one plane only: vouches for what reaches into that plane
  double blind_m = 0.0;   ///< nearer than this to the sensor nothing is seen
  double vouch_m = 0.25;  ///< a thing of this height or more would have been seen
  double low_m = 0.08;    ///< and of this height
  double range_m = 8.0;   ///< of the crop
};

/// One of kSectors directions about the sensor, half a degree wide, from −π.
struct Sector {
  float hit_m = 0.0F;  ///< to the nearest obstacle, from the sensor, in the plane; 0: none
  // Bit i: from i/64 to (i+1)/64 of the range.
  std::uint64_t seen = 0;  ///< free, as far as it was unknown
  std::uint64_t tall = 0;  ///< free wholly, so that what is tall is gone
  std::uint64_t low = 0;   ///< the same for what is low
};

struct Sectors {
  static constexpr std::size_t kSectors = 720;
  static constexpr std::size_t kSteps = 64;
  std::array<Sector, kSectors> of{};
  float range_m = 8.0F;
  float x_m = 0.0F;  ///< the sensor in B
  float y_m = 0.0F;
  float tall_m = 0.0F;  ///< obstacles of this height are gone where `tall` says so
};

/// @param in judged voxels. @param half_step_rad of the sight: how wide a ray is.
void sight_sectors(const Reduced& in, float half_step_rad, const SightedParams& params,
                   Sectors& out);

/// The middle of a sector, radians in B.
double bearing_rad(std::size_t sector) noexcept;

}  // namespace roverd::nav::sense
