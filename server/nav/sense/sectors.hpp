#pragma once
// What one piece of one sensor says of every direction about it: where the nearest obstacle is, and
// how far it was seen to be free. Blind is not free: a stretch is free only where a ray went, low
// enough that something standing there would have met it.
//
//   sensor ●───____            A ray that ends on the ground at D passes the heights between; it
//                  ───___      vouches for the stretch where it is below vouch_m (`seen`), and for
//   ─────────────────────▀▀──  low things where it is below low_m (`low`).
//               seen  low D
//
// For what already stands in the grid each ray is kept as it went, with its heights in O: only one
// that passed through the heights in which something was seen, and clearly beyond it, says that it
// left. One above or below says nothing, however low it is: a bar hangs in the air.

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "nav/sense/reduce.hpp"

namespace roverd::nav::sense {

struct SightedParams {
  bool planar = false;    ///< one plane only: vouches for what reaches into that plane
  bool thin = false;      ///< and by thin beams
  double blind_m = 0.0;   ///< nearer than this to the sensor nothing is seen
  double vouch_m = 0.25;  ///< a thing of this height or more would have been seen
  double low_m = 0.08;    ///< and of this height
  double range_m = 8.0;   ///< of the crop
};

/// One of kSectors directions about the sensor, half a degree wide, from −π.
struct Sector {
  float hit_m = 0.0F;  ///< to the nearest obstacle, from the sensor, in the plane; 0: none
  float far_m = 0.0F;  ///< as far as any ray went, from the sensor
  // Bit i: from i/64 to (i+1)/64 of the range.
  std::uint64_t seen = 0;  ///< free, as far as it was unknown
  std::uint64_t low = 0;   ///< free wholly, down to what is low
};

struct Sectors {
  static constexpr std::size_t kSectors = 720;
  static constexpr std::size_t kSteps = 64;
  std::array<Sector, kSectors> of{};
  float range_m = 8.0F;
  float x_m = 0.0F;  ///< the sensor in B
  float y_m = 0.0F;

  struct Ray {
    float at = 0.0F;      ///< its direction, in sectors from −π
    float end_m = 0.0F;   ///< how far it went, from (x_m, y_m)
    float back_m = 0.0F;  ///< it came from so far behind that place, along its direction
    float from_z_m = 0.0F;
    float end_z_m = 0.0F;  ///< heights in O
    float from_body_m = 0.0F;
    float end_body_m = 0.0F;  ///< heights over the body's plane
    std::uint32_t points = 1;
  };
  std::vector<Ray> rays;  ///< by direction
  std::array<std::uint32_t, kSectors + 1> begin{};
  float half_sectors = 0.0F;  ///< a ray is that wide, to either side
  float blind_m = 0.0F;
  bool planar = false;
  bool thin = false;
  float meets_m = 0.08F;  ///< a ray this low meets what stands there

  enum class Pass : std::uint8_t {
    None,
    Beside,  ///< just outside of the heights
    Along,   ///< within them, and near one of them
    Through  ///< well between them
  };
  /// Heights in O between which something is, and how near to them counts.
  struct Band {
    float low_m = 0.0F;
    float top_m = 0.0F;
    float beside_m = 0.0F;                                      ///< outside of them
    float along_m = 0.0F;                                       ///< within
    float top_body_m = std::numeric_limits<float>::infinity();  ///< no ray higher over the body
  };
  /// How a ray of this direction went through at d_m from the sensor: the one that says most.
  Pass passes(std::size_t sector, float d_m, const Band& band) const noexcept;
  struct Share {
    double met = 0.0;  ///< points of rays that ended there
    double through = 0.0;
  };
  /// What rays between two directions (in sectors from −π) did about d_m: ended within about_m of
  /// it, or went on beyond and were no higher than top_m in O there.
  Share share(double from, double to, float d_m, float about_m, float top_m) const noexcept;
};

/// @param in judged voxels; the rays take one place each, whatever their width. @param
/// half_step_rad of the sight: how wide a ray is.
void sight_sectors(const Reduced& in, float half_step_rad, const SightedParams& params,
                   Sectors& out);

/// The middle of a sector, radians in B.
double bearing_rad(std::size_t sector) noexcept;

}  // namespace roverd::nav::sense
