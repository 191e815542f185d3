#pragma once
// The sense chain, one piece of one sensor after the other:
//
//   Sight ─▶ Reducer ─▶ Ground ─▶ Persist ─▶ Sectors ─▶ Grid ─▶ Patch, Polar, run lengths
//             voxels    (clouds)   rain        free      all sensors
//
// To be run on the sense thread; nothing in it is shared. What others need is copied out as a
// Patch.

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"
#include "base/sight.hpp"
#include "nav/sense/footprint.hpp"
#include "nav/sense/grass.hpp"
#include "nav/sense/grid.hpp"
#include "nav/sense/ground.hpp"
#include "nav/sense/health.hpp"
#include "nav/sense/hills.hpp"
#include "nav/sense/movers.hpp"
#include "nav/sense/params.hpp"
#include "nav/sense/persist.hpp"
#include "nav/sense/reduce.hpp"
#include "nav/sense/sectors.hpp"

namespace roverd::nav::sense {

/// One ranging sensor of the robot.
struct SensorSetup {
  std::string name;  ///< Sight::sensor
  base::Mount mount;
  bool planar = false;   ///< one plane: its points are obstacles
  bool thin = false;     ///< planar, by thin beams: but what lies on known ground (hills.hpp)
  bool needed = true;    ///< blind, it stops what drives by itself
  double blind_m = 0.0;  ///< nearer than this it sees nothing
  PersistParams persist{};
  HealthParams health{};
};

struct ChainParams {
  ReduceParams reduce{};
  GroundParams ground{};
  GridParams grid{};
  std::optional<Footprint> pulled{};  ///< what is seen within it is a trailer, wherever it stands
  double vouch_m = 0.25;  ///< clouds: a thing this high would have been seen where it says free
};

class Chain {
 public:
  static constexpr std::size_t kMaxSensors = 32;

  /// Every mount is checked, every name is there once, at most kMaxSensors; the error names the
  /// sensor and the field.
  static base::Result<Chain> of(ChainParams params, std::vector<SensorSetup> sensors,
                                const Footprint& body, base::Time now);

  /// @return the number of the sensor; an error if it is none of ours, or the piece is of no use:
  /// then nothing but its health changed.
  base::Result<std::size_t> take(const base::Sight& sight, const PoseHistory& history,
                                 base::Time now);

  /// What the last piece that was taken became; for the planar scan and the page.
  const Reduced& last() const noexcept { return reduced_; }
  const Grid& grid() const noexcept { return grid_; }
  const SensorSetup& sensor(std::size_t i) const noexcept { return eyes_[i].setup; }
  std::size_t sensors() const noexcept { return eyes_.size(); }
  Fitness health(std::size_t i, base::Time now) const { return eyes_[i].health.at(now); }
  /// Name and reason of the first needed sensor that is blind; empty: all see.
  std::optional<std::string> blind(base::Time now) const;
  /// Who moves, by all sensors: whom two of them see is told twice. @param out is cleared
  void movers(base::Time now, std::vector<Mover>& out) const;
  /// The odometry began anew: the grid is unknown again.
  void forget() noexcept;

 private:
  struct EyeOf {
    SensorSetup setup;
    SightedParams sighted;
    Persist persist;
    HealthWatch health;
    Movers movers;
    Grass grass;  ///< of one plane with thin beams
  };
  Chain(const ChainParams& params, const Footprint& body);

  ChainParams p_;
  Reducer reducer_;
  Ground ground_;
  Hills hills_;
  Grid grid_;
  Reduced reduced_;
  std::unique_ptr<Sectors> sectors_ = std::make_unique<Sectors>();
  std::vector<EyeOf> eyes_;
  std::vector<Mover> others_;  ///< told by the other sensors
};

}  // namespace roverd::nav::sense
