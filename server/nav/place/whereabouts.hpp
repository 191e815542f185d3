#pragma once
// The map in use, and where on the earth the robot is by it: what sensors saw and how the body
// moved in, states and fixes for the estimator out.
//
//   Odometry ─▶ PoseHistory ┐
//   Sight, 10 a second ─────┴▶ scan ─▶ Tracker ─▶ X_MB ─anchor─▶ base::PlaceState
//
// Of a map in three dimensions a sensor of several rows is looked at as a cloud, 4 a second
// (CellTracker); the whole map is searched in its plane, and what was found there is where the
// cloud is looked for.
//
// How M lies on the earth is its anchor: where its origin is, and which way its x axis looks. A map
// without one is laid where the satellites see the robot when its place in the map is known, as
// surely as they are; where none are heard, at the origin of the local map (nav.estimate.map_lat,
// map_lon), x to the east; without that, where a person has said that the robot stands, once its
// place in the map is known, until satellites that are sure (kSure_m, kLay_rad) see it. Where there
// is none of these, the place in the map is told, and no fix.
//
// Satellites that are good enough save the search: the tracker begins where they see the robot, and
// believes it only if the scan fits there. What a person tells is taken likewise.
//
// One object, one thread; time is an argument.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/geo.hpp"
#include "base/measurements.hpp"
#include "base/sight.hpp"
#include "nav/place/cell_tracker.hpp"
#include "nav/place/tracker.hpp"
#include "nav/sense/odometry.hpp"

namespace roverd::nav::place {

struct MapAnchor {
  base::LatLon at;             ///< of the map's origin, x = y = 0
  double yaw_rad = 0.0;        ///< of its x axis: from east, left positive
  double sigma_m = 0.3;        ///< how well that is known, 1 sigma; at least 0
  double yaw_sigma_rad = 0.0;  ///< likewise of yaw_rad

  bool operator==(const MapAnchor&) const = default;
};

/// Immutable, shared between threads.
struct MapInUse {
  std::string name;
  std::uint32_t number = 1;            ///< another one each time that a map is taken into use
  std::shared_ptr<const Field> field;  ///< of its plane
  std::shared_ptr<const cells::Relief> relief;  ///< null: it has no third dimension
  std::optional<MapAnchor> anchor;
};

/// What the estimator believes of the body, at its stamp.
struct Believed {
  base::Time stamp;
  base::LatLon at;
  double yaw_rad = 0.0;
  double sigma_m = 0.0;
  double yaw_sigma_rad = 0.0;
  bool by_satellites = false;  ///< by positions of now; else by anything
};

/// A person's word, of now. Deviations as Tracker::set_pose has them.
struct Word {
  base::LatLon at;
  std::optional<double> yaw_rad;  ///< empty: any
  bool both = true;  ///< place and heading were said; else one of them is only believed
};

struct WhereaboutsParams {
  TrackerParams tracker;
  chart::ScanParams scan;
  CloudParams cloud;
  std::optional<base::LatLon> local_origin;  ///< of the local map
  /// Names of sensors, the best to look through first; others come behind them.
  std::vector<std::string> eyes;
};

class Whereabouts {
 public:
  static constexpr double kEvery_s = 0.09;
  static constexpr double kCloudEvery_s = 0.24;
  /// So sure satellites have to be for a start, and for laying a map.
  static constexpr double kSure_m = 1.5;
  static constexpr double kSure_rad = 0.2;
  /// A map that is laid askew turns every course in it: surer of the heading than for a start.
  static constexpr double kLay_rad = 0.03;
  static constexpr double kAgain_s = 3.0;  ///< the next start by satellites, doubled each time
  static constexpr double kAgainAtMost_s = 60.0;
  /// A tap is off by so much (1 sigma).
  static constexpr double kTap_m = 0.5;
  static constexpr double kTap_rad = 0.26;
  /// In the number of a map that was laid by satellites after a person's word had laid it.
  static constexpr std::uint32_t kLaidAnew = 0x8000'0000U;

  explicit Whereabouts(const WhereaboutsParams& params = {}) : p_(params) {}

  /// From now on this one; null: none. @return what is to be told of it
  /// @param same_place the one in use was changed a little: the robot is looked for first where it
  /// was in it, by the odometry since
  base::PlaceState use(std::shared_ptr<const MapInUse> map, base::Time now,
                       bool same_place = false);
  const std::shared_ptr<const MapInUse>& map() const noexcept { return map_; }
  /// How the map in use lies on the earth: its own anchor, or what was found. Empty: not known.
  const std::optional<MapAnchor>& anchor() const noexcept { return anchor_; }

  void moved(const sense::Odometry& o) noexcept { (void)history_.push(o); }
  /// @return false: no map is in use, or nobody knows where it lies: then it does not tell where in
  /// the map the robot is, but the map is laid by it when that is known, if it was place and
  /// heading and what is believed since is still sure (kSure_m, kTap_rad)
  bool told(const Word& word);
  /// One sensor is looked through: the best of WhereaboutsParams::eyes that is heard. Where it has
  /// told nothing for a second, the next one.
  /// @return empty: no map is in use, it came too soon after the last one, another sensor is
  /// looked through, or nothing can be made of it.
  std::optional<base::PlaceState> see(const base::Sight& sight, const base::Mount& mount,
                                      const std::optional<Believed>& believed);

 private:
  void start_by_satellites(const Believed& b, base::Time stamp);
  void lay(const Pose2& in_map, base::Time stamp, const std::optional<Believed>& believed);
  std::optional<MapAnchor> laid_by(const Believed& believed, const Pose2& in_map,
                                   base::Time stamp) const;
  void say_that_it_lies_nowhere(base::PlaceState& state) const;
  Pose2 on_map(base::LatLon at, double yaw_rad) const;
  std::size_t rank_of(const std::string& sensor, bool rows) const noexcept;
  bool looks_through(const base::Sight& sight, base::Time end) const noexcept;
  void start_near(const Pose2& in_map, double deviation_m, double deviation_rad, bool asked);
  bool searches() const noexcept;
  struct Look {
    Told told;
    Pose2 odometry;
  };
  std::optional<Look> look(const base::Sight& sight, const base::Mount& mount,
                           const std::optional<Believed>& believed);
  std::optional<Look> look_at_rows(const base::Sight& sight, const base::Mount& mount,
                                   const std::optional<Believed>& believed);
  base::PlaceState tell(const Look& look, const std::optional<Believed>& believed);
  void stay_at(const Pose2& in_map, const Pose2& odometry);
  base::PlaceFix fix_of(const Fix& fix, std::uint32_t found) const;

  WhereaboutsParams p_;
  std::shared_ptr<const MapInUse> map_;
  std::optional<Tracker> tracker_;
  std::optional<CellTracker> cells_;  ///< of a map in three dimensions
  std::optional<MapAnchor> anchor_;
  bool said_ = false;  ///< where the robot stands, of a map that lay nowhere
  bool laid_by_word_ = false;
  sense::PoseHistory history_;
  std::string eye_;        ///< the sensor that is looked through
  bool eye_rows_ = false;  ///< and as a cloud
  std::optional<base::Time> eye_seen_;
  std::optional<base::Time> taken_;
  struct Seen {
    Pose2 in_map;
    Pose2 odometry;
  };
  std::optional<Seen> fitted_;         ///< when a scan did last
  std::uint32_t number_ = 0;           ///< of what lies as it lay: an edit keeps it
  std::uint32_t found_before_ = 0;     ///< by the trackers of the same number before this one
  std::uint32_t found_ = 0;            ///< with this one's
  std::optional<base::Time> started_;  ///< by satellites, since it was known
  double again_s_ = kAgain_s;
};

}  // namespace roverd::nav::place
