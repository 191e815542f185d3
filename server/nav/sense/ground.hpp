#pragma once
// Which voxels are ground, which stand on it, which hang above it, and where it ends.
//
//      ▲ z        ┌─┐ overhang: above pass_below_m
//      │          └─┘
//      │   ▪ obstacle: above min_height_m           drop ┌ the next ground lies deeper than
//      │~~~~~~~~~~~~~~~~~ the ground, as laid ~~~~~~~~~~~┘ slope and drop_m allow
//
// 1. The lowest point of every cell; from the body outwards the highest surface below them that
//    rises no more steeply than max_slope (a distance transform with slopes for distances).
// 2. A plane through the voxels near that surface in five by five cells, twice, the second time
//    without what lies beside the first. Where they are few or lie in one line (the rings of a
//    scanner) the slope is drawn towards that of the whole.
// 3. A voxel is judged by its height above the plane of its cell.
// Source of 1: the slope-limited opening of Vosselman, Slope based filtering of laser altimetry
// data (2000); of 2: ridge regression, Hoerl and Kennard (1970).
//
// Not for scanners of a single plane: one line does not tell a slope from a wall.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "nav/sense/params.hpp"
#include "nav/sense/reduce.hpp"

namespace roverd::nav::sense {

class Ground {
 public:
  /// @param range_m half side of the square that is looked at, about the body.
  /// @param body stands on the ground: there it is known.
  Ground(const GroundParams& params, double range_m, const Footprint& body);

  /// Sets Voxel::kind of all that are not Clear to Ground, Obstacle or Overhang. With
  /// GroundParams::drop the edges of steps down are added to the voxels as Kind::Drop. Linear in
  /// the voxels, and about a millisecond for the square.
  void judge(std::vector<Voxel>& voxels);

  /// Height of the ground in B where it was laid by the last judge(); else the highest that it can
  /// be. @param x_m, y_m in B; outside of the square: infinity.
  float height_m(float x_m, float y_m) const noexcept;

 private:
  struct Sums {  // of the voxels' coordinates about the middle of their cell
    float n = 0.0F, x = 0.0F, y = 0.0F, z = 0.0F, xx = 0.0F, xy = 0.0F, yy = 0.0F, xz = 0.0F,
          yz = 0.0F;
    void add(const Sums& o, float dx, float dy) noexcept;
  };
  struct Count {
    std::uint32_t all = 0;
    std::uint32_t low = 0;  ///< near the lowest
  };
  struct Plane {
    float z = 0.0F;  ///< at the middle of the cell
    float a = 0.0F;  ///< slope along x
    float b = 0.0F;
    bool laid = false;
  };
  std::size_t cell(float x, float y) const noexcept;
  float middle(std::size_t i) const noexcept;
  void lowest(const std::vector<Voxel>& voxels);
  void leave_lonely(const std::vector<Voxel>& voxels);
  void spread() noexcept;
  void lay(const std::vector<Voxel>& voxels, bool again);
  Plane fit(std::size_t ix, std::size_t iy) const noexcept;
  void drops(std::vector<Voxel>& voxels) const;

  GroundParams p_;
  Footprint body_;
  float range_m_;
  float cell_m_;
  float slope_;
  std::size_t side_;
  std::vector<float> low_;
  std::vector<float> top_;  ///< the surface of step 1
  std::vector<Sums> sums_;
  std::vector<Plane> planes_;
  std::vector<Count> counts_;
  std::vector<float> limit_;  ///< voxels below it are left out of low_
  std::vector<std::size_t> lonely_;
  std::vector<std::size_t> used_;  ///< cells with voxels
  float slope_x_ = 0.0F;           ///< of the whole
  float slope_y_ = 0.0F;
};

}  // namespace roverd::nav::sense
