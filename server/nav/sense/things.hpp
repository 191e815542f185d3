#pragma once
// What stands by itself in one sensor's view: its voxels, parted into things, piece by piece. Of
// movers.hpp, which follows them.
//
//   voxels ─▶ cells of 0.1 m of O ─▶ less what has stood for kStill_s ─▶ cells that hang together
//
// What has stood for long is left out, for whoever walks along a wall would be one with it. But of
// somebody who stood so himself and steps away only that part would be seen that is out of where he
// stood, for half a second. A sensor that looks ten times a second has no half second for that: a
// small thing that reaches out on one side and has left places on another is new as a whole.
//
// Who walks in dust or rain is half hidden by it, and the rest of him comes and goes: there, what
// is held back (Passing) beside an obstacle counts where it is the most of a thing.
//
// Seconds are the owner's. Not shared between threads.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "nav/sense/footprint.hpp"
#include "nav/sense/grid.hpp"
#include "nav/sense/reduce.hpp"

namespace roverd::nav::sense {

/// All points of a thing lie in it. Along x and y of O.
struct Box {
  static constexpr double kLeft_m = 0.12;   ///< so far outside of it a place was left
  static constexpr double kWidest_m = 1.6;  ///< of somebody

  double x0 = 1e9, x1 = -1e9, y0 = 1e9, y1 = -1e9;
  std::uint32_t points = 0;

  /// Not in the box, nor near its sides.
  bool leaves_out(Vec2 p) const noexcept;
  bool wide() const noexcept { return x1 - x0 > kWidest_m || y1 - y0 > kWidest_m; }
  Vec2 mid() const noexcept { return {0.5 * (x0 + x1), 0.5 * (y0 + y1)}; }
};

class Things {
 public:
  static constexpr double kStill_s = 1.5;   ///< a place that is taken for so long
  static constexpr std::size_t kMost = 64;  ///< more are left out

  /// @param range_m what is farther from the body is left out @param wakes what stood for long is
  /// told again as soon as it steps away; else half a second later
  Things(double range_m, bool wakes);

  /// Once a piece, in order, judged. @param before the grid without that piece @param now_s of the
  /// piece, later than the last @param told in O, the middles of those who are known to move
  void meet(const Reduced& in, const Grid& before, double now_s, std::span<const Vec2> told);
  void forget() noexcept;
  /// From the next piece on its seconds begin so much later.
  void count_from(double by_s) noexcept;

  std::size_t size() const noexcept { return boxes_.size(); }
  const Box& box(std::size_t thing) const noexcept { return boxes_[thing]; }
  std::span<const Vec2> points(std::size_t thing) const noexcept { return spread_[thing]; }
  /// Something was met there, in the last pieces.
  bool met_lately(Vec2 p) const noexcept { return met_within(p, kLately); }
  bool met_now(Vec2 p) const noexcept { return met_within(p, 1); }
  /// Before it was taken.
  bool was_free(Vec2 p) const noexcept;

 private:
  static constexpr std::uint32_t kLately = 2;  ///< pieces: what was met in the last ones is taken
  static constexpr std::uint32_t kMostHidden = 3;  ///< times what is believed of him
  struct Place {
    std::uint32_t piece = 0;   ///< that met it last
    std::uint32_t looked = 0;  ///< piece in which all of its thing was gathered last
    std::int32_t thing = 0;    ///< of that piece; -1: still
    float first_s = 0.0F;      ///< since when it is taken
    float last_s = -1e9F;
    bool was_free = false;  ///< before it was taken
  };
  struct Cell {
    std::int32_t x = 0;
    std::int32_t y = 0;
  };
  struct Parts {
    std::uint32_t believed = 0;
    std::uint32_t held_back = 0;
    /// Most of it is held back, but not so much that it is hardly more than that: a plume.
    bool half_hidden() const noexcept {
      return held_back >= believed && held_back <= kMostHidden * believed;
    }
  };

  std::size_t index(std::int32_t x, std::int32_t y) const noexcept;
  Place& place(std::int32_t x, std::int32_t y) noexcept { return places_[index(x, y)]; }
  static Cell cell_at(Vec2 p) noexcept;
  bool met_within(Vec2 p, std::uint32_t pieces) const noexcept;
  bool still_about(std::int32_t x, std::int32_t y) noexcept;
  void gather(const Reduced& in, const Grid& before);
  void wake(std::span<const Vec2> told);
  void gather_whole(const Cell& first);
  Box about_whole() const noexcept;
  bool vacated_about(const Box& box) noexcept;
  void part();

  double range_m_;
  bool wakes_;
  std::uint32_t mask_;
  std::vector<Place> places_;
  std::uint32_t piece_ = 0;
  double now_s_ = 0.0;
  std::vector<Cell> cells_;   ///< of this piece, that are not still
  std::vector<Vec2> points_;  ///< voxels of this piece, in O
  std::vector<Cell> of_;      ///< the cell of each
  std::size_t believed_ = 0;  ///< of them, the first; the others are held back
  std::vector<Parts> parts_;  ///< of each thing
  std::vector<Box> boxes_;
  std::vector<std::vector<Vec2>> spread_;  ///< the points of each thing
  std::vector<Cell> open_;
  std::vector<Cell> whole_;
  std::vector<Cell> woken_;
};

}  // namespace roverd::nav::sense
