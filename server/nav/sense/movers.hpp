#pragma once
// Who moves: what one sensor sees, followed from piece to piece.
//
//   things (things.hpp) up to 1.6 m wide ─▶ tracks ─▶ movers
//
// Of a track the four sides of its box (along x and y of O) are kept for 0.7 s, and a straight line
// is laid through each. A side that is uncovered by and by, or hidden, moves while the thing
// stands; so both opposite sides must go the same way, faster than kLeast_mps beyond twice what
// their lines are unsure of, and most of the places that it left must have been seen free: what
// slides along behind a gap, as the robot passes, left nothing free. Who comes towards the sensor
// hides the places that he leaves, and nobody may have looked there since: of him most of those
// that he came to must have been seen free before, which nothing does that only comes into sight.
//
// What a cloud's rows meet of a standing thing changes more than what one plane meets. So that is
// believed of a cloud only where at least ten voxels of him go at the sensor. And as a cloud sees
// no ground near its own foot, it is believed as well, wherever he came to, of a thing no wider
// than a person, of many voxels, that has gone as one for half of its own depth.
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
#include "nav/sense/things.hpp"

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
  static constexpr double kLeast_mps = 0.2;  ///< slower, it stands
  static constexpr double kLost_s = 0.5;     ///< not seen for so long, he is forgotten
  static constexpr std::size_t kMost = 8;    ///< told at most, the nearest to the body

  /// @param range_m what is farther from the body is not followed
  /// @param planar one plane looks
  explicit Movers(double range_m, bool planar = true);

  /// Once a piece, in order, judged. @param before the grid without that piece
  void meet(const Reduced& in, const Grid& before);
  /// And then. @param grid after that piece @param others told by other sensors
  void see(const Grid& grid, std::span<const Mover> others = {});
  /// Adds those that are seen to move. @param sensor its number
  void tell(base::Time now, std::uint8_t sensor, std::vector<Mover>& out) const;
  void forget() noexcept;

 private:
  struct Sample {
    double at_s = 0.0;
    Box box;
    std::array<Vec2, 4> points{};    ///< of what was seen
    std::array<bool, 4> was_free{};  ///< the place of each, before it was taken
    std::size_t size = 0;
  };
  struct Track {
    std::vector<Sample> samples;  ///< the oldest first
    std::vector<Sample> before;   ///< some of those that are too old for a line
    Box box;
    Vec2 v{};
    double sigma = 0.0;
    double seen_s = 0.0;
    int moving = 0;  ///< estimates in a row that say so; of who moves: less 3 for each that denies
    bool moves = false;
    double agreed_s = 0.0;  ///< when its sides last went the same way
  };

  void count_from(base::Time begin);
  void follow(const Grid& grid, std::span<const Mover> others);
  const Mover* seen_elsewhere(const Track& track, std::span<const Mover> others) const noexcept;
  void keep(Track& track) const;
  void estimate(Track& track, const Grid& grid) const;
  bool left_free(const Track& track, const Grid& grid) const;
  bool is_somebody(const Track& track) const noexcept;
  static bool came_onto_free(const Track& track) noexcept;

  bool planar_;
  Things things_;
  bool begun_ = false;
  base::Time begin_;
  double now_s_ = 0.0;
  base::Time stamp_;  ///< of this piece
  bool met_ = false;  ///< it is in order
  std::vector<Track> tracks_;
  std::vector<Vec2> told_;  ///< the middles of those who move
  Vec2 body_{};
  Vec2 eye_{};  ///< the sensor
};

}  // namespace roverd::nav::sense
