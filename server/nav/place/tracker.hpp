#pragma once
// Where the robot is in a map of the plane, from scan to scan.
//
//             set_pose                    two bad scans, and 1 m of them
//   Searching ---------> Tracking --bad scan--> Doubtful ------------------> Lost
//       |  decided          ^  <---good scan---    |                          |
//       +-------------------+----------------------+---- decided, set_pose ---+
//
//   Searching  the pose is not known: every place that fits is followed until one is left
//   Tracking   each scan is matched near where the odometry says that the robot is
//   Doubtful   what is seen does not fit there; odometry carries the pose, nothing is told
//   Lost       the place is not known any more; it is searched as in Searching, and people are told
//              "lost: drive by hand to a known place, or tap where the robot is"
//
// A good scan among bad ones does not make the place right: in a map of another building every
// third one fits somewhere near. So a metre of good ones makes up for half a metre of bad ones
// only, and a place that did not hold for 10 m before it was lost was none: the next one that the
// search finds has to stand twice as firm against "nowhere in this map" (start.hpp), then four
// times, eight times at most.
//
// A tap on the map is a start with its own uncertainty, looked up around it, and not believed when
// the scan does not fit there. Where it fits at another place around it as well (two bays of a
// hall), it is Searching until the scans of some way have decided between them.
//
// What comes out for the estimator is a measurement by the map alone: the odometry only says where
// to look and holds the directions that the map leaves open, which the covariance tells as open.
//
// One object, one thread. Time and odometry are arguments. Frames: M the map, B the body, O the
// odometry's own (drifts, never jumps).

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "nav/chart/scan.hpp"
#include "nav/place/field.hpp"
#include "nav/place/match.hpp"
#include "nav/place/search.hpp"
#include "nav/place/start.hpp"

namespace roverd::nav::place {

enum class Phase : std::uint8_t { Searching, Tracking, Doubtful, Lost };
std::string_view to_string(Phase p) noexcept;  // searching tracking doubtful lost

struct TrackerParams {
  WindowParams window;
  MatchParams match;
  StartParams start;
  std::size_t search_points = 90;
  std::size_t match_points = 720;
  double slip_share = 0.10;       ///< deviation of the odometry, of the way driven
  double slip_m = 0.05;           ///< and at each step
  double turn_share = 0.12;       ///< of the angle turned
  double turn_per_m_rad = 0.04;   ///< of the way driven
  double turn_rad = 0.04;         ///< and at each step
  double least_explained = 0.60;  ///< share of the hits at walls below which a scan is bad
  double most_crossed = 0.35;     ///< share of the hits behind walls above which it is
  std::size_t least_hits = 20;    ///< fewer say nothing
  double lost_after_m = 1.0;      ///< of bad scans
  double made_up = 0.5;           ///< of bad way, by as much way of good scans
  double held_after_m = 10.0;     ///< of good scans: the map is the right one
  double rival = 8.0;             ///< of the told place over another one near it, in evidence
  std::uint32_t lost_after = 2;   ///< bad scans at least
};

/// The measurement for the estimator.
struct Fix {
  base::Time stamp;
  Pose2 pose;                  ///< X_MB at the stamp
  Eigen::Matrix3d covariance;  ///< of x, y in M (m^2) and yaw (rad^2); positive definite
};

/// What is known after a scan.
struct Told {
  base::Time stamp;
  Phase phase = Phase::Searching;
  std::optional<Pose2> pose;   ///< X_MB; while Doubtful by odometry alone; empty: not known
  std::optional<Fix> fix;      ///< only while Tracking, of a scan that fits
  Agreement agreement;         ///< of this scan at the pose
  std::size_t candidates = 0;  ///< places still followed while searching
  bool fitted = false;         ///< a scan fitted since the pose was told; else it is a guess
  bool denied = false;         ///< enough is seen where somebody said that it is, and does not fit
  std::uint32_t resets = 0;    ///< how often the pose was taken anew: it may have jumped then
  std::string_view reason;     ///< one phrase for people
};

/// A pose, how sure it is, and the bad scans since it was.
struct Reckoned {
  Pose2 pose;                                            ///< of B, in the frame of the map's poses
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of x, y, yaw in that frame
  double bad_m = 0.0;
  std::uint32_t bad_scans = 0;

  /// As a person says it. The place counts as unsure by 0.05 to 1 m, the turn by 0.02 rad to a
  /// sixth of a turn, whatever is said.
  void begin(const Pose2& at, double deviation_m, double deviation_rad) noexcept;
  /// Along the odometry since the scan before, with its slip.
  void go(const Pose2& step, const TrackerParams& p);
  /// @return Doubtful, or Lost
  Phase bad(const Pose2& step, const TrackerParams& p) noexcept;
  void good(const Pose2& step, const TrackerParams& p) noexcept;
};

class Tracker {
 public:
  explicit Tracker(std::shared_ptr<const Field> field, const TrackerParams& params = {});

  /// Starts near a pose that somebody told, X_MB at the time of the next scan.
  /// @param deviation_m, deviation_rad how sure that is; the search reaches three times as far, at
  /// least as far as it always does, at most 3 m and half a turn.
  void set_pose(const Pose2& in_map, double deviation_m, double deviation_rad);
  /// While it is searched: looks there with the next scan, X_MB at its time. Where that does not
  /// fit, the search goes on as if nothing had been said. Else ignored.
  void suggest(const Pose2& in_map, double deviation_m, double deviation_rad);
  /// Starts without any pose.
  void forget();

  /// @param odometry X_OB at the scan's stamp; what is not finite is refused. A scan that is not
  /// newer than the one before is left out.
  Told feed(const chart::Scan& scan, const Pose2& odometry);

  Phase phase() const noexcept { return phase_; }
  const Field& field() const noexcept { return *field_; }
  const TrackerParams& params() const noexcept { return p_; }

 private:
  void track(const chart::Scan& scan, const Pose2& step, Told& told);
  void search(const chart::Scan& scan, const Pose2& step, Told& told);
  bool tries(const chart::Scan& scan, Told& told);
  void begin_at(const Pose2& in_map, double deviation_m, double deviation_rad);
  bool searches() const noexcept { return phase_ == Phase::Searching || phase_ == Phase::Lost; }
  bool has_rival(const chart::Scan& scan, const std::vector<Point>& few,
                 const std::vector<Point>& hits, const Match& match, double log_fit,
                 const WindowParams& window) const;
  void bad(const Pose2& step);
  Told answer(Told told) const;

  std::shared_ptr<const Field> field_;
  TrackerParams p_;
  struct Suggested {
    Pose2 in_map;
    double deviation_m, deviation_rad;
  };

  Phase phase_ = Phase::Searching;
  std::optional<Suggested> suggested_;
  Reckoned now_;  ///< X_GB
  GlobalStart start_;
  std::optional<base::Time> last_stamp_;
  Pose2 last_odometry_;
  double depth_m_ = 0.0;  ///< of the walls of this map for this scanner (match.hpp)
  double depth_deviation_m_ = 0.0;
  bool told_ = false;    ///< set_pose since the last scan: the window is wide
  bool fitted_ = false;  ///< a scan since the pose was told or found
  double held_m_ = 0.0;  ///< way of good scans since the pose was told or found
  double doubt_ = 1.0;   ///< of the map: GlobalStart::doubt
  std::uint32_t resets_ = 0;
};

/// What people are told to do where the place is lost.
inline constexpr std::string_view kLostWords =
    "lost: drive by hand to a known place, or tap where the robot is";

/// The words about what is odd with a scan; empty: it fits.
std::string_view misfit(const Agreement& a, const TrackerParams& p) noexcept;

}  // namespace roverd::nav::place
