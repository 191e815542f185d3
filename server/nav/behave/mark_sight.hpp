#pragma once
// What is common to the items that are driven by what is seen of walls and landmarks (nav/marks),
// in the frame O of the odometry: their parameters, what they are told, how they begin. Pure.

#include <optional>

#include "base/params.hpp"
#include "base/setting.hpp"
#include "mission/plan.hpp"
#include "nav/marks/params.hpp"
#include "nav/marks/view.hpp"
#include "nav/marks/ways.hpp"
#include "nav/tags/params.hpp"
#include "nav/tags/tag_book.hpp"
#include "nav/track/tracker.hpp"

namespace roverd::nav {

/// Section [nav.sight]: along walls and past landmarks.
struct SightParams {
  double speed_mps = 0.6;
  double creep_mps = 0.2;
  double entry_m = 2.0;
  double old_s = 0.6;
  double wait_s = 5.0;
  double max_yaw_rate_radps = 5.0;
};

template <class V>
void fields(V& v, SightParams& p) {
  v("speed_mps", p.speed_mps, 0.05, 3.0, "along a wall or past landmarks whose item says no speed");
  v("creep_mps", p.creep_mps, 0.05, 1.0, "towards a wall or landmark that is not seen yet");
  v("entry_m", p.entry_m, 0.0, 20.0,
    "so far it creeps straight on until it sees the wall or a landmark");
  v("old_s", p.old_s, 0.2, 3.0,
    base::lower_is_stricter(
        "an older view stops it; so does a side without a wall, or no landmark, for so long"));
  v("wait_s", p.wait_s, 0.0, 600.0,
    "standing without a wall or landmark for so long, the item has failed");
  v("max_yaw_rate_radps", p.max_yaw_rate_radps, 0.1, 5.0,
    "it turns no faster there, nor faster than nav.speed.max_yaw_rate_radps");
}

/// What [nav.track] and [nav.speed] are along walls or past landmarks. Of gains of 1 and no limit
/// of its own it is what it was.
PathParams by_sight(PathParams path, const marks::SteerGains& gains, const SightParams& sight);

/// What counts as a landmark is no thicker: the default of nav.landmarks.max_radius_m.
inline constexpr double kLandmarkRadius_m = 0.25;
/// This near to a wall, or less, the vehicle's middle cannot be driven along it.
inline double touches_wall_m(const VehicleParams& vehicle) noexcept {
  return 0.5 * vehicle.width_m;
}
/// Likewise past a landmark, told to its middle.
inline double touches_landmark_m(const VehicleParams& vehicle) noexcept {
  return 0.5 * vehicle.width_m + kLandmarkRadius_m;
}

struct MarkSettings {
  base::Setting<SightParams> sight{};
  base::Setting<marks::WallParams> walls{};
  base::Setting<marks::LandmarkParams> landmarks{};
  base::Setting<tags::TagDockParams> tag_dock{};
  /// by_sight() of the two; empty: as every other way is driven.
  std::optional<base::Setting<PathParams>> wall_path{};
  std::optional<base::Setting<PathParams>> landmark_path{};
};

/// What is known of walls and landmarks at one tick.
struct MarkSight {
  const marks::View* view = nullptr;  ///< null: nothing was looked at yet
  base::Time now;
  marks::Pose2 body;                    ///< X_OB now
  const tags::TagBook* tags = nullptr;  ///< null: no camera of this robot reads tags

  /// @param eyes one of these has looked lately; 0: anyone
  bool fresh(const SightParams& params, marks::Eyes eyes = 0) const noexcept {
    return view != nullptr && view->looked_since(now - base::from_seconds(params.old_s), eyes);
  }
  /// Somebody whose word counts has looked lately.
  bool fresh(const SightParams& params, marks::By by) const noexcept {
    return view != nullptr && view->told(by) && fresh(params, view->eyes_by(by));
  }
};

/// Empty: as the parameters say.
std::optional<marks::By> by_of(std::optional<mission::SightSource> source) noexcept;

/// Whose word it is that an item by sight is driven by right now.
struct ToldBy {
  bool scan = false;
  bool vision = false;
};

/// The vehicle in O: its place and direction by the odometry, which is sure of what is seen by it.
/// @param body X_OB
Vehicle by_odometry(const marks::Pose2& body, const Vehicle& vehicle) noexcept;
inline Vehicle by_odometry(const MarkSight& sight, const Vehicle& vehicle) noexcept {
  return by_odometry(sight.body, vehicle);
}
/// Straight on from here, until something is seen.
marks::Way straight_on(const marks::Pose2& body, double ahead_m, double speed_mps);

}  // namespace roverd::nav
