#pragma once
// What stands around the robot, as the sense thread hands it to the control thread. Immutable.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "base/sensing.hpp"
#include "base/time.hpp"
#include "nav/marks/view.hpp"
#include "nav/sense/footprint.hpp"
#include "nav/sense/grid.hpp"
#include "nav/sense/marks.hpp"
#include "nav/sense/movers.hpp"
#include "robot/guard/row_watch.hpp"

namespace roverd::robot {

/// The stop by counted rays (nav/sense/rays_rule.hpp): what the last piece of a sensor says.
struct RaysStop {
  std::uint8_t sensor = 0;  ///< as Patch::Cell counts them
  int rays = 0;             ///< shorter than they may be
  nav::sense::Vec2 at{};    ///< the nearest that they met, in O
  base::Time seen;
  double way_m = 0.0;       ///< ahead, from `from` on, until they say stop; 0: they do
  nav::sense::Vec2 from{};  ///< where the body was then, in O
  /// Its sensor need not see, and does not any more, while another one does: what it said is as
  /// good as ground that nobody has seen.
  bool lost = false;
};

struct Surroundings {
  nav::sense::Patch patch;
  nav::sense::Marks marks;  ///< of the patch; empty: the guard looks more slowly
  /// By number, as Patch::Cell counts them. Shared with the snapshots.
  std::shared_ptr<const std::vector<base::SensorState>> sensors;
  std::optional<base::Time> seen;  ///< by any of them, last
  double lasts_s = 0.5;            ///< so long that is believed
  /// Of the sensors whose rays say stop, the one with the nearest. Empty: none does, or the rule is
  /// off.
  std::optional<RaysStop> rays;
  /// Of those whose rays will say stop soon, the one with the least way. Empty: none.
  std::optional<RaysStop> rays_ahead;
  /// Walls, landmarks; null: nobody has looked for them yet.
  std::shared_ptr<const nav::marks::View> beside;
  std::optional<RowSeen> row;             ///< empty: none is asked for, or none is seen
  std::vector<nav::sense::Mover> movers;  ///< who moves, the nearest first by each sensor
};

}  // namespace roverd::robot
