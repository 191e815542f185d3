#pragma once
// The ground as a height over each place. Pure, no state but what it was made of.
//
//   h(x, y) = plane + Σ unevenness (value noise, eased) + Σ bumps − depth inside of a drop

#include <cstdint>
#include <optional>
#include <vector>

#include "sim/world/vec.hpp"
#include "sim/world/world.hpp"

namespace roverd::sim::world {

class Terrain {
 public:
  Terrain() = default;
  /// Of more than eight uneven layers the first eight count.
  Terrain(const Ground& ground, std::uint64_t seed);

  /// Up, above the level of the start's plane.
  double height_m(Vec2 at) const noexcept;
  /// The same without drops: where it was before somebody dug.
  double surface_m(Vec2 at) const noexcept;
  /// Depth of the drop there; 0 outside of all.
  double depth_m(Vec2 at) const noexcept;

  struct Met {
    double range_m = 0.0;
    double cosine = 1.0;  ///< of the angle between the ray and the ground's normal
  };
  /// Where a ray first meets the ground, at most so far away. Within 1 mm of the height function,
  /// except that a crest which sticks out by less than about 1 % of its layer's height may be
  /// missed. @param dir unit. @param raise_m grass: the ground as if so much higher.
  std::optional<Met> meet(Vec3 from, Vec3 dir, double max_m, double raise_m) const noexcept;

  /// As a vehicle stands: the plane through its wheels' places. @param half_length_m,
  /// half_width_m of them about the middle, which is ahead_m before the body's origin.
  Pose stand(Vec2 at, double yaw_rad, double half_length_m, double half_width_m,
             double ahead_m = 0.0) const noexcept;

  bool has_drops() const noexcept { return !drops_.empty(); }
  const std::vector<Drop>& drops() const noexcept { return drops_; }

 private:
  struct Layer {
    double height_m;
    double per_m;  ///< 1 / patch
    std::uint64_t seed;
  };
  struct Sides {
    Vec2 low, high;
  };
  struct Squares;
  double detail_m(Vec2 at, Squares& squares) const noexcept;
  std::optional<double> march(Vec3 from, Vec3 dir, double begin_m, double max_m,
                              double shift_m) const noexcept;
  const Drop* drop_at(Vec2 at) const noexcept;
  double facing(Vec3 dir, Vec2 at) const noexcept;

  double rise_x_ = 0.0;  ///< of the plane, metres up a metre
  double rise_y_ = 0.0;
  double low_m_ = 0.0;  ///< what the detail adds to the plane lies in low .. high
  double high_m_ = 0.0;
  double steep_ = 0.0;   ///< no detail is steeper
  double step_m_ = 1e9;  ///< a march may always go so far at once
  std::vector<Layer> layers_;
  std::vector<Bump> bumps_;
  std::vector<Drop> drops_;
  std::vector<Sides> drop_sides_;
};

/// Even-odd rule; on the edge either may be told.
bool inside(const std::vector<Vec2>& polygon, Vec2 at) noexcept;

}  // namespace roverd::sim::world
