#pragma once
// What a frame shows, as points in S (x ahead, y left, z up):
//
//   depth d at (u, v):  d · (1, −(u − cx) / fx, −(v − cy) / fy)
//   range r at angle a: r · (cos a, sin a, 0)
//   a cloud's points as they are; optical ones (x right, y down, z ahead) turned
//
// A pose moves the points from the camera's axes into those of its mount. Directions of depth
// images and ranges in which nothing was seen become Clear or Unknown (Params::clear_to_m); points
// of a cloud that are none have no direction and are counted only.
//
// Rays of a depth image are kept: one of each column, one of each row, their sum is the pixel's.
// Pure state; bounded by the frame.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/sight.hpp"
#include "cloud/codec.hpp"
#include "cloud/params.hpp"

namespace roverd::cloud {

using Vec3 = std::array<float, 3>;

/// Axes and place of the camera in the frame of its mount.
struct Stand {
  Vec3 x{1.0F, 0.0F, 0.0F};
  Vec3 y{0.0F, 1.0F, 0.0F};
  Vec3 z{0.0F, 0.0F, 1.0F};
  Vec3 at{};
  friend bool operator==(const Stand&, const Stand&) = default;
};
/// Rolled, then pitched, then yawed, then moved (as base::Mount says).
Stand stand_of(const std::optional<base::Mount>& pose) noexcept;

class Eye {
 public:
  explicit Eye(const Params& params) : params_(params) {}

  struct Seen {
    std::uint64_t directions = 0;
    std::uint64_t missing = 0;  ///< of them
  };
  /// Sets points, half_step_rad, clear_to_m and good of the sight.
  Seen look(const Frame& frame, base::Sight& sight);

 private:
  struct Rays {
    std::uint16_t width = 0;
    std::uint16_t height = 0;
    std::array<float, 4> lens{};
    Stand stand;
    std::vector<Vec3> columns;
    std::vector<Vec3> rows;
  };

  Seen look_at(const Cloud& cloud, bool optical, const Stand& stand, base::Sight& sight) const;
  Seen look_at(const Depth& depth, const Stand& stand, base::Sight& sight);
  Seen look_at(const Ranges& ranges, const Stand& stand, base::Sight& sight) const;
  void prepare(const Depth& depth, const Stand& stand);
  bool put_missing(const Vec3& ray, const Vec3& at, base::Sight& sight) const;
  bool put(const Vec3& ray, float scale, float range_m, const Stand& stand,
           base::Sight& sight) const;

  const Params params_;
  Rays rays_;
};

}  // namespace roverd::cloud
