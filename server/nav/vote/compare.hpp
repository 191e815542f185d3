#pragma once
// Two sensors at a time, over windows of some seconds: what each makes of the same turn and the
// same way, and whether that can both be true.
//
//   turn   gyro, tracks, course of the velocity, course of the positions, compass, antennas
//   way    positions and velocity as vectors; either against the tracks by length
//   heading (not its change)   antennas against a course
//
// A limit is `sigmas` times what both may honestly err, and a floor:
// | sensor    | turn over W seconds                     | way over W seconds                      |
// | gyro      | 0.5 deg + 0.5 % + its bias's sigma · W  |                                         |
// | tracks    | 0.25 to 1.25 of what they say,          | 0.65 to 1.4 of what they say times the  |
// |           |   and the learned pull, ± 3 deg and 0.2 |   learned scale; 0.45 to 1.3 unlearned; |
// |           |   rad/m: one side slips by 15 % more    |   the antenna swings by arm · turn      |
// | velocity  | sigma/speed of each course, arm ·       | its noise, and 0.01 m/s · W (0.03      |
// |           |   rate/speed, 1 deg; after a turn 11 deg|   without RTK)                          |
// |           |   at most: it slides down a slope       |                                         |
// | position  | of chords over 2 s                      | sigma at both ends, its class's drift   |
// | compass   | 8 deg; not for 6 s after a pivot        |                                         |
// | antennas  | as told                                 |                                         |
// Fixed positions are compared with the velocity over 1 to 16 s too, by the line through all of
// both (RunApart): a drift of 0.1 m/s shows within 2 s. Noise is what a sensor tells of itself, and
// no less than how much it scatters. The arm is the antenna's, and 0.15 m by which a skid steer's
// centre of rotation wanders. The tracks' room is wide on purpose: slip is ordinary. Wheels that
// spin while positions and velocity both see the robot stand are SpinWatch's matter (robot/safety):
// what the tracks counted then is not judged here. Nor is what they did not tell: a window ends
// with their last word, and begins anew after they were silent.
//
// Pure.

#include <array>
#include <cstddef>
#include <optional>

#include "base/geo.hpp"
#include "base/snapshot.hpp"
#include "nav/vote/curve.hpp"

namespace roverd::nav {

using base::Difference;
using base::kSenses;
using base::Sense;

constexpr std::size_t index_of(Sense s) noexcept {
  return static_cast<std::size_t>(s);
}

/// Tracks may be told of five times a second: what is later than their last word is not known.
inline constexpr double kTracksLate_s = 0.2;

/// A position as the receiver tells it.
struct Spot {
  Time t;  ///< when it was there
  base::EnuPoint at;
  double sigma_m = 0.0;  ///< white, per axis
  double drift_m = 0.0;  ///< slow, within drift_s
  double drift_s = 60.0;
  int run = 0;  ///< another one: another fix class, or a gap
};

/// A velocity, and what it adds up to.
struct Pace {
  Time t;
  base::EnuPoint mps;
  double sigma_mps = 0.0;
  base::EnuPoint sum_m;
  int run = 0;                   ///< another one: a gap
  double every_s = 0.2;          ///< since the one before
  double slower_than_mps = 0.0;  ///< all that was told, where no direction was; else 0
  double vague_m = 0.0;          ///< of sum_m: so long a way was told without a direction, at most
};

/// A direction against the curve's reference.
struct Bearing {
  Time t;
  double off_rad = 0.0;    ///< less the reference's turn, continuous
  double sigma_rad = 0.0;  ///< of this one, from one to the next
  double bias_rad = 0.0;   ///< that others beside it have too
};

using Bearings = Ring<Bearing, 128>;

/// All that is compared.
struct Facts {
  Curve curve;
  Ring<Spot, 128> spots;
  Ring<Pace, 128> paces;
  std::array<Bearings, kSenses> bearings;  ///< of those that know a direction
  double gyro_bias_sigma_radps = 0.0;
  double arm_m = 0.0;  ///< from the centre of rotation to the antenna, at most
  bool rtk = false;
  std::array<bool, kSenses> heard{};
  /// What was told before is not compared: it lied then.
  std::array<std::optional<Time>, kSenses> from{};
  std::optional<Time> pivoted;    ///< last time that it turned on the spot
  std::optional<Time> tracks_at;  ///< their last word
  std::optional<Time> spun;       ///< last time that the wheels seemed to spin
};

/// The worst comparison of two.
struct Finding {
  bool judged = false;
  Difference off;
  double limit = 1.0;
  double ratio() const noexcept;  ///< > 1: they contradict each other
  double heading_off_rad = 0.0;   ///< what it makes doubtful
  double way_off_m = 0.0;
};

/// Every two of them; symmetric.
struct Table {
  std::array<std::array<Finding, kSenses>, kSenses> of{};
  /// Of position and velocity, the way by tracks, heading and gyro speaks for the velocity.
  bool for_velocity = false;
  /// Positions and velocity see it stand while the wheels turn.
  bool spins = false;
  /// Of its limit: how far positions that are RTK fixed have run away from the velocity. None: it
  /// could not be judged.
  std::optional<double> apart;
  /// Beyond the limit, and they go on doing so: it is no single step.
  bool runs_apart = false;
  /// The receiver runs off from tracks and gyro as no ground slides (RunOff).
  bool runs_off = false;
  /// Positions have not been driven with for long enough to believe them against anybody.
  bool unproved = false;

  const Finding& between(Sense a, Sense b) const noexcept { return of[index_of(a)][index_of(b)]; }
  bool judged(Sense a, Sense b) const noexcept { return between(a, b).judged; }
  bool contradict(Sense a, Sense b) const noexcept {
    return judged(a, b) && between(a, b).ratio() > 1.0;
  }
  void put(Sense a, Sense b, const Finding& finding) noexcept;
};

/// @param sigmas of the limits.
Table compare(const Facts& facts, double sigmas) noexcept;

}  // namespace roverd::nav
