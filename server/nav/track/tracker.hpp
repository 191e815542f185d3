#pragma once
// Drives one leg after another of a path.
//
//   begin ─▶ Settle ──points away──▶ Pivot ──aligned──▶ Track ───end near──▶ Stop ──standing──▶
//   Done
//              │                        ▲                 │ ▲                 │ │            ▲
//              └──────── aligned ───────┼─────────────────┘ └── too short ────┘ │            │
//                                       └── Settle ◀── points far away ─── Track└─▶ Turn ────┘
//                                                                  the leg's end has a heading
//   begin_turn ─▶ Settle ─▶ Turn ─▶ Done
//
// Track steers by one of the laws of nav/track/law.hpp. The pose is predicted over the actuation
// delay with the commands already sent, so that steering does not weave; what turns the robot
// without being commanded is learned and countered (nav/track/observer.hpp). Steering goes first:
// where the turn rate saturates, the speed gives way. Progress along the path only grows and is
// looked for in a window around its place: crossings and parallel lanes do not confuse it.
// An arrival is latched: a leg that is done stays done wherever noise carries the pose.
// Control thread; no allocation after construction.

#include <array>
#include <cstddef>
#include <optional>
#include <utility>

#include "base/geo.hpp"
#include "base/setting.hpp"
#include "base/snapshot.hpp"
#include "nav/track/law.hpp"
#include "nav/track/observer.hpp"
#include "nav/track/path.hpp"
#include "nav/track/rules.hpp"

namespace roverd::nav {

/// The vehicle as the tracker needs it.
struct Vehicle {
  EnuPoint at;
  double yaw_rad = 0.0;
  double yaw_sigma_rad = 0.0;
  double speed_mps = 0.0;       ///< over ground, forward positive
  double yaw_rate_radps = 0.0;  ///< over ground
  double odometry_scale = 1.0;  ///< true over track speed
  double yaw_scale = 1.0;       ///< true over track turn rate
  double pull_1pm = 0.0;        ///< turn per metre on straight tracks
  double sigma_m = 0.0;         ///< of the position
  double roll_rad = 0.0;        ///< right side down positive; 0 where nothing tells
  double pitch_rad = 0.0;       ///< nose up positive; likewise
  /// It does not drive where it points: for each metre it moves so far to its left (to its right
  /// reversing), and by this vector, whichever way it points.
  double crab = 0.0;
  EnuPoint slide;
};

/// The angle from where it points to where it goes; reversing, from where its tail points. Left
/// positive, at most 0.5 rad: more is no side slip.
double course_off_rad(const Vehicle& v, bool reverse) noexcept;

/// It leans more than a turn on the spot is allowed at.
bool too_steep_to_turn(const Vehicle& v, const SlopeParams& p) noexcept;

enum class TrackPhase { Idle, Settle, Pivot, Track, Stop, Turn, Done };

struct TrackOutput {
  base::BodyTwist command;  ///< for the base: track speed and track turn rate
  SpeedReason reason = SpeedReason::Standing;
};

class Tracker {
 public:
  /// Other parameters act at the next step, also while driving; paths keep the limits they were
  /// built with.
  explicit Tracker(base::Setting<PathParams> params) : params_(std::move(params)) {}

  /// Starts or goes on with `leg` at arc length s. `path` must outlive the drive.
  void begin(const Path& path, std::size_t leg, double s_m) noexcept;
  /// Turns on the spot to a yaw, without any path. A steered vehicle is Done at once.
  void begin_turn(double yaw_rad) noexcept;
  void reset() noexcept;
  /// Goes on as it goes, on another path that is the same here. `path` must outlive the drive.
  void move_to(const Path& path, std::size_t leg, double s_m) noexcept;

  /// One control step. @param limit_mps cuts the speed ("position_uncertain"). A pose that is not
  /// finite stops the robot.
  TrackOutput step(const Vehicle& vehicle, double limit_mps, double dt_s) noexcept;

  TrackPhase phase() const noexcept { return phase_; }
  const Path* path() const noexcept { return path_; }
  std::size_t leg() const noexcept { return leg_; }
  double s_m() const noexcept { return s_m_; }
  /// The way's own limit here, braking for what follows left out; empty: it follows none.
  std::optional<double> set_mps() const noexcept {
    if (path_ == nullptr || leg_ >= path_->legs.size()) return std::nullopt;
    return path_->points[path_->segment_at(leg_now(), s_m_, segment_)].segment_mps;
  }
  /// Positive: the vehicle is left of the way it drives.
  double cross_track_m() const noexcept { return cross_track_m_; }
  /// The turn on the spot takes longer than nav.pivot.timeout_s, or may not begin.
  bool turn_timed_out() const noexcept {
    return too_steep_ || turning_s_ > params_->pivot.timeout_s;
  }
  /// It would have to turn on the spot where it leans more than nav.slope.pivot_deg: it stands.
  bool too_steep() const noexcept { return too_steep_; }
  /// What turns the robot without being commanded.
  double yaw_disturbance_radps() const noexcept { return observer_.radps(); }

 private:
  struct Projection {
    double s_m = 0.0;
    double cross_m = 0.0;
    double tangent_rad = 0.0;
    std::size_t segment = 0;
  };

  const Leg& leg_now() const noexcept { return path_->legs[leg_]; }
  Projection project(EnuPoint at, double s_m, double ahead_m) const noexcept;
  EnuPoint point_ahead(const Projection& from, double by_m) const noexcept;
  double bend_ahead_1pm(const Projection& from, double speed_mps) const noexcept;
  Vehicle predict(const Vehicle& now, double dt_s) const noexcept;
  base::BodyTwist sent_before(double age_s, double dt_s) const noexcept;
  double facing_error(const Vehicle& v, const Projection& on) const noexcept;
  SpeedLimit profile(double s_m) const noexcept;
  void prove_braking(SpeedLimit& limit) noexcept;

  TrackOutput settle(const Vehicle& v, double dt_s) noexcept;
  TrackOutput pivot(const Vehicle& v, double dt_s) noexcept;
  TrackOutput turn(const Vehicle& v, double dt_s) noexcept;
  TrackOutput turn_by(double error_rad, double error_soon_rad, const Vehicle& v,
                      double dt_s) noexcept;
  TrackOutput track(const Vehicle& v, double limit_mps, double dt_s) noexcept;
  TrackOutput stop(const Vehicle& v, double dt_s) noexcept;
  TrackOutput drive(const Vehicle& v, SpeedLimit limit, double curvature_1pm, double dt_s) noexcept;
  /// Ground twist to command, with saturation: steering first, speed gives way.
  TrackOutput command(const Vehicle& v, double speed_mps, double rate_radps,
                      SpeedReason reason) noexcept;
  double law_1pm(const Vehicle& soon, const Projection& on, double speed_mps) const noexcept;
  double steer(double wanted_1pm, double heading_rad, double dt_s) noexcept;
  SpeedLimit limits(const Vehicle& v, double limit_mps, double curvature_1pm,
                    double course_error_rad) noexcept;
  double speed_up_or_down(double limit_mps, double dt_s) noexcept;
  bool slight(const Vehicle& v, double error_rad) const noexcept;
  bool may_pivot(const Vehicle& v) noexcept;
  bool still(const Vehicle& v, double dt_s) noexcept;
  void enter(TrackPhase phase) noexcept;

  base::Setting<PathParams> params_;
  const Path* path_ = nullptr;
  std::size_t leg_ = 0;
  std::size_t segment_ = 0;
  double s_m_ = 0.0;
  double cross_track_m_ = 0.0;
  double turn_to_rad_ = 0.0;
  TrackPhase phase_ = TrackPhase::Idle;
  double still_s_ = 0.0;
  double astray_s_ = 0.0;
  double turning_s_ = 0.0;
  double down_rad_ = 0.0;  ///< the way goes down by, where it drives
  bool too_steep_ = false;
  std::optional<double> proof_mps_;  ///< down to it the brakes are tried on this leg
  bool creeping_ = false;
  bool saturated_ = false;
  double speed_mps_ = 0.0;   ///< last commanded over ground
  double rate_radps_ = 0.0;  ///< likewise, as wanted
  double accel_mps2_ = 0.0;  ///< of the commanded speed's size
  double wheel_rad_ = 0.0;   ///< steered vehicles: where the wheels were told to point
  double unturned_s_ = 0.0;  ///< so long they need to where they should
  YawObserver observer_;

  std::array<base::BodyTwist, 64>
      sent_{};  ///< what the commands make of ground without disturbance
  std::size_t sent_at_ = 0;
};

}  // namespace roverd::nav
