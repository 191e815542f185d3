#pragma once
// From the points of one Sight to voxels in the body frame B at one time: mounted, moved, cropped,
// without the own body, thinned.
//
//   p_B(ref) = X_B(ref)O X_OB(t) (R p_S + t_S),   t = stamp + after_s
//
// X_OB is the pose in the plane and how the body lies (odometry.hpp): a bump within a lidar's turn
// is taken out, as far as the attitude is known.
//
// The reference is the time of the last point. The way of the body in between is taken in steps of
// 2 ms: at 1.3 m/s 1.3 mm, at 1 rad/s and 8 m 8 mm.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/sight.hpp"
#include "nav/sense/footprint.hpp"
#include "nav/sense/odometry.hpp"
#include "nav/sense/params.hpp"

namespace roverd::nav::sense {

/// What a voxel was found to be.
enum class Kind : std::uint8_t {
  Obstacle,  ///< before anything judged it: something is there
  Ground,
  Overhang,  ///< passed below
  Drop,      ///< the ground ends here
  Passing,   ///< held back: not yet seen often enough (rain, dust)
  Clear,     ///< nothing is there: rays went as far as this
};

/// The mean of the points in one cube. B at the reference time, metres.
struct Voxel {
  float x_m = 0.0F;
  float y_m = 0.0F;
  float z_m = 0.0F;
  std::uint32_t points = 0;
  Kind kind = Kind::Obstacle;
  std::uint16_t from = 0;  ///< where its first ray came from: Reduced::from_m
};

/// Where every point went. The sum of all but `points` is `points`.
struct Counts {
  std::uint32_t points = 0;
  std::uint32_t kept = 0;
  std::uint32_t clear = 0;    ///< no echo, and vouched for; or beyond the crop
  std::uint32_t unknown = 0;  ///< no echo that tells anything
  std::uint32_t bad = 0;      ///< not a number, infinite, or in the sensor itself
  std::uint32_t body = 0;
  std::uint32_t outside = 0;  ///< above or below the crop
};

struct Reduced {
  base::Time stamp;                          ///< the reference
  Pose2 pose;                                ///< X_OB then
  Lie3 lie;                                  ///< likewise
  std::array<float, 3> origin_m{};           ///< of the sensor, in B
  std::vector<std::array<float, 3>> from_m;  ///< where it was on the way to there; may be empty
  std::vector<Voxel> voxels;                 ///< Obstacle and Clear only
  Counts counts;
};

/// Keeps its buffers from sight to sight. Not shared between threads.
class Reducer {
 public:
  /// A larger piece is refused: memory is bounded by it.
  static constexpr std::size_t kMaxPoints = 1'000'000;

  /// @param pulled within it everything is the robot, too
  Reducer(const ReduceParams& params, const Footprint& body,
          const std::optional<Footprint>& pulled = {});

  /// @param mount passed check_mount. @param history must reach from Sight::stamp to its last
  /// point, else the piece is refused (Unavailable). @param out its buffers are used again.
  base::Result<void> reduce(const base::Sight& sight, const base::Mount& mount,
                            const PoseHistory& history, Reduced& out);

 private:
  struct Slot {
    std::uint32_t key = 0;  ///< 0: empty
    std::uint32_t at = 0;   ///< index of the voxel
  };
  struct Knot {
    std::array<float, 9> r{};
    std::array<float, 3> t{};
  };
  base::Result<void> lay_knots(const base::Sight& sight, const base::Mount& mount,
                               const PoseHistory& history, Reduced& out);
  void points(const base::Sight& sight, Reduced& out);
  bool is_body(float x, float y, float z) const noexcept;
  std::uint32_t find(std::uint32_t key, std::vector<Voxel>& voxels);
  void grow(const std::vector<Voxel>& voxels);

  ReduceParams p_;
  Footprint body_;
  std::optional<Footprint> pulled_;
  std::vector<Knot> knots_;
  double first_s_ = 0.0;
  std::vector<Slot> slots_;
  std::vector<std::uint32_t> keys_;  ///< of the voxels, for growing
};

}  // namespace roverd::nav::sense
