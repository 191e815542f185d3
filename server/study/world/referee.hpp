#pragma once
// Who knows the truth: what was touched and whose it was, what the guard stopped for and whether
// that stands there, and how far before it the robot stands.
//
// A contact is ours when braking from the first sight would have avoided it. That is tried: from
// the begin of the unbroken sight of the thing (a gap of a second breaks it; of who moves, not
// before he set out for there; of what stands, from the first sight of it within 0.2 m of where it
// was touched: the far end of a wall does not tell where this one is) the body goes on as it did
// for sense.protect.delay_s, then along the same way slower and slower, as decel_mps2 and
// turn_decel_radps2 let it, and stands. What moves goes on as it does. If they meet until a second
// after the true contact, no brakes would have avoided it. So whoever walks into the way of a robot
// that saw him coming counts; that he was not in the way yet, in time for the brakes, is said:
//
//   way since it was where it was touched  ≤  u·delay + u·max(v / 2a, ω / 2α),   u = |v| +
//   |ω|·reach

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/sensing.hpp"
#include "nav/sense/params.hpp"
#include "sim/surroundings.hpp"
#include "sim/world/sensor.hpp"
#include "study/world/worlds.hpp"

namespace roverd::study {

class Referee {
 public:
  /// @param pass_below_m what hangs higher is no obstacle.
  /// @param ground what hangs higher, or rises no higher than grass, is no obstacle.
  /// @param plane_m over the ground: all its sensors look along it; 0: not so.
  Referee(const sim::Surroundings& around, const nav::sense::ProtectParams& brakes,
          const nav::sense::GroundParams& ground, double plane_m);

  /// A sensor's piece came. @param mount of the sensor
  void saw(const std::vector<sim::world::Sweep>& sweeps, const sim::world::Pose& mount,
           double now_s);
  /// Every 10 ms.
  void look();
  /// Once a tick of the robot. @param obstacle of its snapshot
  void heed(const std::optional<base::Obstacle>& obstacle);
  /// From now on it counts.
  void begin();
  /// Into the run, at its end.
  void report(WorldRun& run);

  double driven_m() const noexcept { return driven_m_; }
  /// It stands since; 0 while it moves.
  double stands_s() const noexcept;
  bool stopped() const noexcept { return stopping_; }
  /// What somebody at the sticks sees: bearing of the nearest thing, left positive.
  std::optional<double> nearest_rad() const;

 private:
  struct Was {
    double at_s;
    sim::world::Pose pose;
    double v_mps;
    double w_radps;
    double way_m;  ///< of the outline so far
  };
  struct Met {
    float at_s = -1e9F;
    sim::world::Cause cause = sim::world::Cause::Nothing;
  };

  void judge(const sim::world::Witness::Seen& seen);
  bool beside_plane(int thing, const sim::world::Pose& pose, double at_s) const;
  /// Middles of the squares of 5 cm under the body in which something of it rises over from_m.
  std::vector<sim::world::Vec2> places_touched(int thing, const sim::world::Pose& pose, double at_s,
                                               double from_m) const;
  /// Since a beam met it there last, many went through the very place: it lies beside their plane.
  bool looked_through(int thing, const sim::world::Pose& pose, double at_s);
  void passes(sim::world::Vec2 from, sim::world::Vec2 to);
  bool low_as_grass(int thing, const sim::world::Pose& pose, double at_s) const;
  /// What of it was touched reaches between these heights over the body's plane.
  bool reaches(int thing, const sim::world::Pose& pose, double at_s, double from_m,
               double to_m) const;
  /// Begin of the unbroken sight before the contact; of who moves, not before he set out. Empty:
  /// never seen, or he was not any more; of what stands: never seen about there.
  std::optional<double> in_sight_since_s(int number, const sim::world::Pose& pose,
                                         double touched_s) const;
  std::optional<double> place_seen_since_s(int number, const sim::world::Pose& pose,
                                           double at_s) const;
  bool comes_to_it(int number, const Was& now) const;
  bool brakes_avoid(int thing, double from_s, double touched_s) const;
  double there_since_s(int thing, const sim::world::Pose& pose, double at_s) const;
  std::size_t index_at(double at_s) const;
  StopSeen stop_of(const base::Obstacle& obstacle);
  std::string cause_of(const base::Obstacle& obstacle, const sim::world::Pose& there,
                       bool& needless);
  double room_m(int thing) const;
  /// Number of the map's cell; kNowhere: outside.
  static std::size_t map_cell(double x_m, double y_m) noexcept;

  const sim::Surroundings& around_;
  const nav::sense::ProtectParams brakes_;
  const double pass_below_m_;
  const double grass_m_;  ///< what rises no higher is told from the ground by nobody
  const double plane_m_;
  double reach_m_ = 0.5;
  std::vector<Was> trail_;
  std::vector<std::vector<double>> sights_;  ///< of each thing, when beams met it
  std::vector<std::size_t> beams_;           ///< that met it
  /// Of each thing that stands: the cells of kMapCell_m where beams met it, and when first.
  std::vector<std::map<std::pair<int, int>, double>> places_;
  std::vector<Met> met_;  ///< of each cell of the map
  /// Beams from nearby that went on, since one met a thing there; no more than are asked for.
  std::vector<std::uint8_t> through_;
  std::size_t hard_ = 0;
  std::size_t soft_ = 0;
  std::size_t soft_before_ = 0;
  double driven_m_ = 0.0;
  double began_s_ = 0.0;
  bool counts_ = false;
  std::vector<TouchSeen> touches_;
  std::vector<StopSeen> stops_;
  std::size_t slows_ = 0;
  bool stopping_ = false;
  double stopped_at_m_ = 0.0;  ///< of the outline's way
  bool slowing_ = false;
  bool measured_ = false;  ///< where it stands at this stop
  double still_since_s_ = 0.0;
  std::vector<int> blamed_;  ///< things that do not move, where the guard said that one stands
};

}  // namespace roverd::study
