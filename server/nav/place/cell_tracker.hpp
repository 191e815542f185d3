#pragma once
// Where the robot is in a map of cells in three dimensions, from cloud to cloud: what tracker.hpp
// is for a map of the plane. The phases, and when a place is lost, are the same.
//
//   cloud in B, how B lies ─▶ cells ─▶ align() from where the odometry says it is ─▶ X_MB
//
// The place is found near a told one only: within about a metre and fifteen degrees. Whoever
// searches the whole map does it in its plane (Whereabouts), and tells what was found there.
//
// What comes out for the estimator is a measurement by the map alone. Where the map holds some
// direction loosely (a bare corridor) the odometry holds it, and the covariance tells it as open.
// What of the cloud is new to the map is left out, as long as half of it is known.
//
// One object, one thread. Time and odometry are arguments. Frames: M the map, z up, its x and y
// those of poses; B the body, O the odometry's.

#include <cstdint>
#include <memory>
#include <optional>

#include "base/sensing.hpp"
#include "base/sight.hpp"
#include "nav/cells/align.hpp"
#include "nav/cells/relief.hpp"
#include "nav/place/tracker.hpp"
#include "nav/sense/odometry.hpp"

namespace roverd::nav::place {

/// What was seen of one turn.
struct Cloud {
  base::Time stamp;     ///< of the last point
  cells::Cloud points;  ///< in B at the stamp
  sense::Lie3 lie;      ///< of B then
};

struct CloudParams {
  double nearest_m = 0.8;    ///< from the sensor: the robot itself, and who walks beside it
  double farthest_m = 40.0;  ///< rings lie too far apart there
};

/// It looks along several rows: a lidar whose clouds say where the robot is.
bool has_rows(const base::Sight& sight) noexcept;

/// Hits only, each carried along the odometry to the stamp. Empty: the odometry does not reach it,
/// the device says that its data are not good, or there is no hit. Pure.
std::optional<Cloud> cloud_of(const base::Sight& sight, const base::Mount& mount,
                              const sense::PoseHistory& odometry, const CloudParams& p = {});

class CellTracker {
 public:
  /// @param map not null; cells of the size in which clouds are to be matched
  explicit CellTracker(std::shared_ptr<const cells::Relief> map, const TrackerParams& params = {});

  /// Starts near a pose that somebody told, X_MB at the time of the next cloud.
  void set_pose(const Pose2& in_map, double deviation_m, double deviation_rad);
  void forget();

  /// @param odometry X_OB at the cloud's stamp. A cloud that is not newer than the one before is
  /// left out. Of Told `agreement` says the share that was found (explained) and `candidates`
  /// nothing.
  Told feed(const Cloud& cloud, const Pose2& odometry);

  Phase phase() const noexcept { return phase_; }
  bool searches() const noexcept { return phase_ == Phase::Searching || phase_ == Phase::Lost; }

 private:
  cells::Alignment lay(const cells::Relief& seen, const Eigen::Isometry3d& start) const;
  void track(const Cloud& cloud, const Pose2& step, Told& told);
  std::string_view misfit(const cells::Alignment& a, const Pose2& at) const;
  Told answer(Told told) const;

  std::shared_ptr<const cells::Relief> map_;
  TrackerParams p_;
  Phase phase_ = Phase::Searching;
  Reckoned now_;      ///< X_MB
  double z_m_ = 0.0;  ///< of B in M
  std::optional<base::Time> last_stamp_;
  Pose2 last_odometry_;
  double last_lie_z_m_ = 0.0;
  bool told_ = false;    ///< set_pose since the last cloud that fitted
  bool fitted_ = false;  ///< a cloud did since the pose was told
  std::uint32_t resets_ = 0;
};

}  // namespace roverd::nav::place
