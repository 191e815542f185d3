#pragma once
// Who moves: what one sensor sees, followed from piece to piece.
//
//   obstacles, without what has stood for kStill_s ─▶ things up to 1.6 m wide ─▶ tracks ─▶ movers
//
// Who walks in dust or rain is half hidden by it, and the rest of him comes and goes: there, what
// is held back (Passing) beside an obstacle counts where it is the most of a thing.
//
// Of a track the four sides of its box (along x and y of O) are kept for 0.7 s, and a straight line
// is laid through each. A side that is uncovered by and by, or hidden, moves while the thing
// stands; so both opposite sides must go the same way, faster than kLeast_mps beyond twice what
// their lines are unsure of, and most of the places that it left must have been seen free: what
// slides along behind a gap, as the robot passes, left nothing free. Who comes towards the sensor
// hides the places that he leaves, and nobody may have looked there since: of him most of those
// that he came to must have been seen free before, which nothing does that only comes into sight.
// That is believed of scanners of one plane alone: what a cloud's rows meet of a standing thing
// changes too much.
//
// Who leaves a sensor's view, or enters it, shows one side only: his velocity is kept meanwhile,
// and taken over from another sensor that sees him there.
//
// Velocities are of O, which drifts by far less than anybody walks. Not shared between threads.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/time.hpp"
#include "nav/sense/footprint.hpp"
#include "nav/sense/grid.hpp"
#include "nav/sense/reduce.hpp"

namespace roverd::nav::sense {

/// Somebody who moves, as he was seen last.
struct Mover {
  Vec2 at{};               ///< the middle of what was seen of him, in O
  Vec2 v_mps{};            ///< in O
  double radius_m = 0.3;   ///< all that was seen lies within it
  double sigma_mps = 0.1;  ///< of the velocity, by the scatter of what was seen
  std::uint8_t sensor = 0;
  base::Time seen;
};

class Movers {
 public:
  static constexpr double kLeast_mps = 0.3;  ///< slower, it stands
  static constexpr double kStill_s = 1.5;    ///< a place that is taken for so long
  static constexpr double kLost_s = 0.5;     ///< not seen for so long, he is forgotten
  static constexpr std::size_t kMost = 8;    ///< told at most, the nearest to the body

  /// @param range_m what is farther from the body is not followed
  /// @param planar one plane looks: who comes towards it is told, too
  explicit Movers(double range_m, bool planar = true);

  /// Once a piece, in order, judged. @param before the grid without that piece
  void meet(const Reduced& in, const Grid& before);
  /// And then. @param grid after that piece @param others told by other sensors
  void see(const Grid& grid, std::span<const Mover> others = {});
  /// Adds those that are seen to move. @param sensor its number
  void tell(base::Time now, std::uint8_t sensor, std::vector<Mover>& out) const;
  void forget() noexcept;

 private:
  static constexpr std::uint32_t kMostHidden = 3;  ///< times what is believed of him
  struct Place {
    std::uint32_t piece = 0;  ///< that met it last
    std::int32_t thing = 0;   ///< of that piece; -1: still
    float first_s = 0.0F;     ///< since when it is taken
    float last_s = -1e9F;
    bool was_free = false;  ///< before it was taken
  };
  struct Cell {
    std::int32_t x = 0;
    std::int32_t y = 0;
  };
  struct Box {
    double x0 = 1e9, x1 = -1e9, y0 = 1e9, y1 = -1e9;
    std::uint32_t points = 0;
    bool leaves_out(Vec2 p) const noexcept;
    Vec2 mid() const noexcept { return {0.5 * (x0 + x1), 0.5 * (y0 + y1)}; }
  };
  struct Parts {
    std::uint32_t believed = 0;
    std::uint32_t held_back = 0;
    /// Most of it is held back, but not so much that it is hardly more than that: a plume.
    bool half_hidden() const noexcept {
      return held_back >= believed && held_back <= kMostHidden * believed;
    }
  };
  struct Sample {
    double at_s = 0.0;
    Box box;
    std::array<Vec2, 4> points{};    ///< of what was seen
    std::array<bool, 4> was_free{};  ///< the place of each, before it was taken
    std::size_t size = 0;
  };
  struct Track {
    std::vector<Sample> samples;  ///< the oldest first
    Box box;
    Vec2 v{};
    double sigma = 0.0;
    double seen_s = 0.0;
    int moving = 0;  ///< estimates in a row that say so; of who moves: less 3 for each that denies
    bool moves = false;
    double agreed_s = 0.0;  ///< when its sides last went the same way
  };

  std::size_t index(std::int32_t x, std::int32_t y) const noexcept;
  Place& place(std::int32_t x, std::int32_t y) noexcept { return places_[index(x, y)]; }
  static Cell cell_at(Vec2 p) noexcept;
  bool still_about(std::int32_t x, std::int32_t y) noexcept;
  void count_from(base::Time begin);
  void gather(const Reduced& in, const Grid& before);
  void part();
  void follow(const Grid& grid, std::span<const Mover> others);
  const Mover* seen_elsewhere(const Track& track, std::span<const Mover> others) const noexcept;
  void estimate(Track& track, const Grid& grid) const;
  /// Something was met there, in the last pieces.
  bool met_lately(Vec2 p) const noexcept;
  bool left_free(const Track& track, const Grid& grid) const;
  static bool came_onto_free(const Track& track) noexcept;

  double range_m_;
  bool planar_;
  std::uint32_t mask_;
  std::vector<Place> places_;
  std::uint32_t piece_ = 0;
  bool begun_ = false;
  base::Time begin_;
  double now_s_ = 0.0;
  base::Time stamp_;          ///< of this piece
  bool met_ = false;          ///< it is in order
  std::vector<Cell> cells_;   ///< of this piece, that are not still
  std::vector<Vec2> points_;  ///< voxels of this piece, in O
  std::vector<Cell> of_;      ///< the cell of each
  std::size_t believed_ = 0;  ///< of them, the first; the others are held back
  std::vector<Parts> parts_;  ///< of each thing
  std::vector<Box> things_;
  std::vector<std::vector<Vec2>> spread_;  ///< some points of each thing
  std::vector<Cell> open_;
  std::vector<Track> tracks_;
  Vec2 body_{};
  Vec2 eye_{};  ///< the sensor
};

}  // namespace roverd::nav::sense
