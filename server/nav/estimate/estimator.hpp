#pragma once
// Where the robot is, which way it points, how fast it goes, and how sure that is.
//
//   tracks (50 Hz) ─▶ predict ─────────────▶ belief ─▶ pose(now)
//   position, velocity, heading ─▶ gate ─▶ update, formed at the moment they tell of
//
// Heading:   unknown ──compass, two antennas, or course while moving──▶ known
//            known ──velocity contradicts it for 2 s──▶ known (set from course; a counted reset)
// Position:  none ──first usable fix (makes the local frame)──▶ known
//            known ──rejected for 10 s, or by 25 m for 1 s──▶ known (set; a counted reset)
//
// Standing (tracks still for 0.5 s) the yaw is held, and the position too unless the fix is RTK
// fixed: noise would make them wander. Refused and counted: values that are not finite, stamps that
// are doubled, out of order or in the future.
//
// Not thread-safe; no allocation; nothing here reads a clock.

#include <cstdint>
#include <optional>

#include "base/measurements.hpp"
#include "base/snapshot.hpp"
#include "nav/estimate/ekf.hpp"
#include "nav/estimate/gnss_quality.hpp"
#include "nav/estimate/history.hpp"
#include "nav/estimate/params.hpp"

namespace roverd::nav {

using base::Time;

class Estimator {
 public:
  explicit Estimator(const EstimateParams& params);
  /// Other parameters, for what comes; what was learned stays.
  void use(const EstimateParams& params) noexcept { params_ = params; }

  /// Works in this frame from the first fix on. Only before there is a pose; ignored later.
  void use_frame(const base::LocalFrame& frame) noexcept;
  /// Id of the frame that a first fix makes. @param id not 0.
  void next_frame_id(std::uint32_t id) noexcept { next_frame_id_ = id; }

  /// Takes one measurement. Kinds that say nothing of motion are ignored.
  /// @param now of this tick; a later stamp (by more than 50 ms) is refused.
  void take(const base::Measurement& m, Time now) noexcept;
  /// Once a tick, after the measurements: coasts when the tracks are silent.
  void advance(Time now) noexcept;

  /// Empty until the first usable fix. Without a known heading the yaw sigma is π.
  std::optional<base::Pose> pose(Time now) const;
  const std::optional<base::LocalFrame>& frame() const noexcept { return frame_; }
  base::EstimatorHealth health() const noexcept;
  const Belief& belief() const noexcept { return belief_; }

  bool heading_known() const noexcept { return heading_known_; }
  bool standing() const noexcept { return standing_; }
  /// Stamp of the last position that was fused.
  std::optional<Time> last_position() const noexcept { return last_fused_; }
  double yaw_scale() const noexcept { return belief_.x(kYawScale); }
  double pull_1pm() const noexcept { return belief_.x(kPull); }

 private:
  void take(const base::GnssFix& fix);
  void take(const base::GnssVelocity& velocity);
  void take(const base::Heading& heading);
  void take(const base::WheelTravel& travel);
  void take(const base::BaseMotion& motion);

  bool in_order(std::optional<Time>& last, Time stamp) noexcept;
  void step(const Travel& travel, Time stamp) noexcept;
  void watch_standing(Time stamp) noexcept;
  void set_drift(const Drift& drift) noexcept;
  bool settled(const base::GnssFix& fix) noexcept;
  void first_fix(const base::GnssFix& fix, const GnssQuality& q);
  void fuse_position(const base::GnssFix& fix, const GnssQuality& q) noexcept;
  void position_refused(const base::GnssFix& fix, const GnssQuality& q, double off_m) noexcept;
  void reset_position(base::EnuPoint at, const GnssQuality& q) noexcept;
  void fuse_velocity(const base::GnssVelocity& velocity, double sigma_mps) noexcept;
  void fuse_course(const base::GnssVelocity& velocity, double sigma_mps) noexcept;
  void velocity_refused(const base::GnssVelocity& v, double ahead_mps, double sigma_mps) noexcept;
  void set_heading(double yaw_rad, double sigma_rad) noexcept;
  void reject() noexcept { ++rejected_; }
  template <int M>
  bool apply(const Observation<M>& o) noexcept;
  bool has_odometry(Time at) const noexcept;
  Coast coast(Time now) const noexcept;

  EstimateParams params_;
  Belief belief_;
  History history_;
  std::optional<base::LocalFrame> frame_;
  std::uint32_t next_frame_id_ = 1;
  bool located_ = false;
  bool heading_known_ = false;
  bool standing_ = false;
  bool has_moved_ = false;

  Time now_{};                     ///< of this tick
  std::optional<Time> filter_at_;  ///< the belief's time
  Past sums_;                      ///< travel since the start
  Time moved_at_{};                ///< last time the tracks moved
  base::BodyTwist tracks_{};       ///< present speed by the tracks, unscaled
  std::optional<Time> tracks_at_;
  std::optional<base::GnssVelocity> velocity_;

  std::optional<Time> last_travel_, last_motion_, last_fix_, last_velocity_, last_heading_;
  std::optional<Time> last_fused_, last_heading_fused_;
  std::optional<Time> position_off_since_, velocity_off_since_, compass_off_since_;
  std::optional<Time> far_off_since_;
  base::FixType fix_type_ = base::FixType::None;
  Time fix_type_since_{};
  std::optional<double> alt_msl_m_;
  Drift drift_{};
  std::uint64_t rejected_ = 0;
  std::uint64_t resets_ = 0;
};

}  // namespace roverd::nav
