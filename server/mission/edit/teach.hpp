#pragma once
// Teach-in: a driven way becomes a mission. Which samples become points, and what mission the
// points make; where they are kept is the store's. Time is an argument; pure but for its memory.
//
//   samples, 20 Hz ─▶ Sampler ─▶ points: every step_m, at each change of heading or direction
//   points ─▶ mission_of ─▶ waypoints with speed and direction, simplified
//
// Nothing is recorded while the position is not to be trusted: the next point then has a gap before
// it, and the mission crosses that in a straight line.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "base/time.hpp"
#include "mission/plan.hpp"

namespace roverd::mission {

inline constexpr std::size_t kMaxTaughtPoints = 100'000;

struct TeachSettings {
  double step_m = 1.0;        ///< 0.05 … 100: a point at least this often
  double heading_deg = 10.0;  ///< 1 … 180: and where the heading has changed by this
  double tolerance_m = 0.03;  ///< 0 … 10: the mission may pass beside the points; 0: all of them
  double sigma_max_m = 0.5;   ///< 0.01 … 50: less certain positions are not recorded
  friend bool operator==(const TeachSettings&, const TeachSettings&) = default;
};

struct TeachSample {
  base::Time stamp;
  LatLon at;
  double yaw_rad = 0.0;
  double speed_mps = 0.0;  ///< along the body, backwards negative
  bool trusted = false;    ///< fresh, and certain enough
};

struct TaughtPoint {
  LatLon at;
  double heading_deg = 0.0;  ///< compass, of the body
  double speed_mps = 0.0;    ///< mean on the way here, while it moved; never negative
  bool reverse = false;      ///< came here backwards
  bool gap = false;          ///< what lies before was not recorded
  friend bool operator==(const TaughtPoint&, const TaughtPoint&) = default;
};

class Sampler {
 public:
  explicit Sampler(const TeachSettings& settings) : settings_(settings) {}

  /// @return the points that this sample completes, in order; seldom more than one.
  std::vector<TaughtPoint> take(const TeachSample& sample);
  /// Where it stands now, if that is not a point already. Recording may go on after it.
  std::vector<TaughtPoint> finish();
  /// The next point has a gap before it. For a pause, and after a restart.
  void interrupt() noexcept;

 private:
  struct Last {
    LatLon at;
    double yaw_rad = 0.0;
  };
  TaughtPoint point_here() const;
  void begin_leg();

  TeachSettings settings_;
  std::optional<TeachSample> now_;  ///< the last trusted one
  std::optional<Last> point_;       ///< the last point
  bool gap_ = false;
  bool reverse_ = false;
  double driven_m_ = 0.0;  ///< since the last point
  double moving_s_ = 0.0;
};

/// Metres between the points, without the gaps.
double taught_length_m(const std::vector<TaughtPoint>& points);

/// At least two different points; else Conflict.
base::Result<Plan> mission_of(const std::vector<TaughtPoint>& points, const std::string& name,
                              double tolerance_m);

}  // namespace roverd::mission
