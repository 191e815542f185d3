#pragma once
// Where the ground lies that somebody has seen: what a scanner of one plane meets on a hill is told
// from what stands there.
//
//   a cloud's ground ─▶ the lowest of it in cells of kCell_m, for a while, in O ─▶ a plane's echo
//   from kInside_m below to low_m above the lowest of three by three cells is ground (of seven by
//   seven, where these are not known); from those about it the ground may rise to it by kSteepest
//
// Only a sensor that lays the ground tells it (ground.hpp): a bank that is too steep is none, and
// where nobody saw the ground a plane's echo stays an obstacle. A ring on the face of a low thing
// whose foot is hidden, or between two rings, is laid as ground as well. So it is learned outwards
// in every direction, from the body's plane on:
//
//   ●     the first kMostLow_m over that plane at most; each next kRough_m at most over a surface
//   ▭     that starts in the plane and rises by kSteepest from the lowest seen before it, and over
//   ══1═══2══▏ ═══3═   the line from the ground before it to ground behind it: on a face there is
//                      none, or it is too low
//
// Ground that is known and seen again within kRough_m of its height is known anew, wherever the
// body stands and leans by then: a robot that turned towards a hill, or pitches before it, has the
// hill well above its plane. That never raises the height.
//
// What came to stand on ground that was known is higher than the lowest there. An echo farther
// below the ground shows that the heights do not agree; it stays an obstacle, too.
//
// Heights in O drift as the robot drives, hardly while it stands or turns on the spot: ground is
// known for kKnown_m of way or kKnown_s, and the less of the one the more of the other has passed.
// And only while something tells how the body leans (Lie3::told): when nothing does, all of it is
// forgotten. Not shared between threads.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "base/time.hpp"
#include "nav/sense/reduce.hpp"

namespace roverd::nav::sense {

class Hills {
 public:
  static constexpr double kCell_m = 0.1;
  /// At least half of it, and less than all of it: in two halves each cell keeps its lowest.
  static constexpr double kKnown_s = 30.0;
  static constexpr double kKnown_m = 10.0;
  static constexpr float kInside_m = 0.15F;
  static constexpr float kSteepest = 0.15F;  ///< rise over way
  static constexpr float kRough_m = 0.05F;
  static constexpr double kMostLow_m = 0.08;
  static constexpr float kStands_m = 0.25F;
  static constexpr float kBeside_m = 0.8F;
  static constexpr float kWide_m = 1.0F;
  /// Farther from where the odometry began nothing is ground.
  static constexpr double kFarthest_m = 1e7;

  /// @param range_m what lies farther from the body is not asked. @param low_m what a plane meets
  /// so high over the lowest ground is grass; 0.18 m at most: what is hidden in taller grass a
  /// plane still tells
  Hills(double range_m, double low_m);

  /// Of a piece whose ground was judged.
  void learn(const Reduced& in);
  /// Of any piece, before it is judged: the robot drives on while nobody tells ground.
  void drive(const Reduced& in) noexcept;
  /// Of a cloud, judged, before it is learned: what was laid as ground, but rises more than
  /// kStands_m over ground that is known there, is set to Obstacle. @return how many
  std::size_t deny(Reduced& in) const;
  /// Of one plane: sets what is an Obstacle and lies on known ground to Ground. @return how many
  std::size_t judge(Reduced& in) const;
  /// Something that is so high in O is the ground there, as far as that is known. @param x_m, y_m
  /// in O
  bool is_ground(double x_m, double y_m, float z_m, base::Time now) const noexcept;
  /// It would be ground if it were grass: no ground is known near by, and it is low over what is
  /// known within 0.6 m.
  bool may_be_grass(double x_m, double y_m, float z_m, base::Time now) const noexcept;
  /// What stands there is as thin as grass: it is ground over what is known within 0.6 m, for as
  /// long as ground is known.
  void grows(double x_m, double y_m, base::Time now) noexcept;
  /// It is no grass (any more).
  void stands(double x_m, double y_m) noexcept;
  /// grows() was said of it, and not stands() since.
  bool grown_at(double x_m, double y_m, base::Time now) const noexcept;
  void forget() noexcept;

 private:
  static constexpr std::int32_t kNever = std::numeric_limits<std::int32_t>::min();
  struct Place {
    std::int32_t x = 0;  ///< places share memory with those a window farther on
    std::int32_t y = 0;
    std::int32_t half = kNever;  ///< in which it was seen last
    float z_m = 0.0F;            ///< the lowest then
    float before_m = 0.0F;       ///< and in the half before
  };
  struct Grown {
    std::int32_t x = 0;
    std::int32_t y = 0;
    std::int32_t half = kNever;
  };
  bool lies_on(float ground_m, float z_m) const noexcept;
  bool is_grown(std::int32_t x, std::int32_t y, std::int32_t half) const noexcept;
  static constexpr std::size_t kDirections = 180;
  static constexpr float kStep_m = 0.1F;
  /// kStep_m of a direction, from the body's origin outwards.
  std::size_t step_of(const Voxel& v) const noexcept;
  /// Sets highest_ of each step: what lies no higher is ground.
  void look_out(const Reduced& in) noexcept;
  void look_out(std::size_t direction) noexcept;
  /// The first ground of a direction is of a hill, whatever is hidden before it.
  bool on_wide_ground(std::size_t direction) const noexcept;
  /// Into lowest_ and first_.
  void meet(const Voxel& v, const Reduced& in) noexcept;
  /// Known ground that is seen again, as high as it was, is known anew; its height does not rise.
  static void renew(Place& p, std::int32_t x, std::int32_t y, std::int32_t half,
                    float z_m) noexcept;
  std::size_t index(std::int32_t x, std::int32_t y) const noexcept;
  /// To here, once, however many sensors tell the ground and whose piece is late.
  void count_way(const Reduced& in) noexcept;
  /// Which half of what is known for a while this is, by time and way.
  std::int32_t half_of(base::Time t) const noexcept;
  /// Of the cells so far about it, each with the rise from there; infinity: none is known.
  float lowest_about(std::int32_t x, std::int32_t y, std::int32_t half,
                     std::int32_t cells) const noexcept;
  std::optional<float> lowest_m(std::int32_t x, std::int32_t y, std::int32_t half) const noexcept;

  float low_m_;
  std::int32_t mask_;
  std::size_t steps_;           ///< of each direction
  std::vector<float> lowest_;   ///< ground of the piece, over the body's plane; infinity: none
  std::vector<float> highest_;  ///< minus infinity: nothing is ground there
  struct First {
    float out_m = 0.0F;  ///< nearest of the ground, from the body's origin; 0: none
    float z_m = 0.0F;
    float falls = 0.0F;  ///< the ray that met it, per metre; not positive: it is not known
  };
  std::vector<First> first_;  ///< of each direction
  std::vector<Place> places_;
  std::vector<Grown> grown_;  ///< by the same index
  bool begun_ = false;
  base::Time begin_;
  Pose2 last_;          ///< X_OB until which the way is counted
  base::Time last_at_;  ///< and when that was
  double way_m_ = 0.0;  ///< since it began
};

}  // namespace roverd::nav::sense
