#pragma once
// Where the robot is, which way it points, how fast it goes, and how sure that is.
//
//   tracks (50 Hz), gyro ─▶ predict ────────▶ belief ─▶ pose(now)
//   position, velocity, heading ─▶ gate ─▶ update, formed at the moment they tell of
//
// Yaw rate:  the gyro's while it is fresh (0.1 s), otherwise the tracks'
// Heading:   unknown ──compass, two antennas, operator, or course while moving──▶ known
//            known ──velocity contradicts it for 2 s (5 s with a gyro)──▶ known (a counted reset)
// Position:  none ──first usable fix (makes the local frame), or the operator──▶ known
//            known ──rejected for 10 s, or by 25 m for 1 s──▶ known (set; a counted reset)
// Fix class: better ──▶ the estimate moves to it at 0.25 m/s at most; worse ──▶ it stays, and the
//            receiver's offset is open
//
// Map:       a place in a map (base::PlaceState) is a source like the satellites, and one of them
//            leads. The map does where they are not fixed; satellites that are fixed, and mean the
//            same place, where they are; each where the other is silent. Meanwhile what the other
//            says beside it is learned: the receiver's drift, or by how much the map's anchor is
//            off. When the lead changes, the estimate moves to the new one at 0.1 m/s at most.
//            A map that is refused for 1 s while no satellites speak is believed (a counted reset).
//            Where what is seen does not fit the place that a person told, or fits nowhere any
//            more, and neither satellites nor known places have told it since: 5 m uncertain
//
// Landmark:  things whose place is known (nav/estimate/landmark.hpp) correct the estimate while
//            neither fixed satellites nor a map lead, by 0.1 m/s at most; no number of looks makes
//            it surer than the place of one is known
//
// Standing (tracks still for 0.5 s, and the gyro too) the yaw is held, the gyro's bias learned (not
// while single counts of the tracks say that it may creep), and the position held unless the fix is
// RTK fixed: noise would make them wander. Refused and counted by cause: values that are not
// finite, stamps that are doubled, out of order or in the future, fixes beyond the limits of
// GnssLimits, receivers that disagree.
//
// Everything is also put to the vote (nav/vote): a sensor that contradicts the others is left out
// until it agrees again, and what it may have spoiled is uncertain by as much as they differed.
//
// Not thread-safe; no allocation; nothing here reads a clock.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

#include "base/measurements.hpp"
#include "base/setting.hpp"
#include "base/snapshot.hpp"
#include "nav/estimate/arrival.hpp"
#include "nav/estimate/askew_watch.hpp"
#include "nav/estimate/coarse_walk.hpp"
#include "nav/estimate/ekf.hpp"
#include "nav/estimate/fix_trust.hpp"
#include "nav/estimate/gnss_quality.hpp"
#include "nav/estimate/gyro.hpp"
#include "nav/estimate/history.hpp"
#include "nav/estimate/landmark.hpp"
#include "nav/estimate/learned.hpp"
#include "nav/estimate/map_offset.hpp"
#include "nav/estimate/noise_watch.hpp"
#include "nav/estimate/params.hpp"
#include "nav/estimate/receivers.hpp"
#include "nav/estimate/shift_watch.hpp"
#include "nav/estimate/slip_watch.hpp"
#include "nav/estimate/tilt.hpp"
#include "nav/estimate/wander_watch.hpp"
#include "nav/vote/votes.hpp"

namespace roverd::nav {

using base::Time;

class Estimator {
 public:
  /// What is believed at first follows from the parameters at construction
  /// (kBelievedAtFirst); all else acts from the next measurement on.
  explicit Estimator(base::Setting<EstimateParams> params);

  /// What another life of this program learned, before the first measurement. Values beyond what
  /// update() allows, and those less certain than the parameters' own, are left out.
  void recall(const Learned& learned) noexcept;
  /// What a person says was measured of the vehicle: believed from now on.
  void adopt(const Learned& learned) noexcept;
  /// All that was learned of the vehicle itself is as at the first start.
  void forget_vehicle() noexcept;
  /// What is worth keeping. Empty: not learned, or not again since it was recalled.
  Learned learned() const noexcept;

  /// Works in this frame from the first fix on. Only before there is a pose; ignored later.
  void use_frame(const base::LocalFrame& frame) noexcept;
  /// Id of the frame that a first fix makes. @param id not 0.
  void next_frame_id(std::uint32_t id) noexcept { next_frame_id_ = id; }

  /// Takes one measurement. Kinds that say nothing of motion are ignored.
  /// @param now of this tick; a later stamp (by more than 50 ms) is refused.
  void take(const base::Measurement& m, Time now) noexcept;
  /// Once a tick, after the measurements: coasts when the tracks are silent.
  void advance(Time now) noexcept;

  /// The operator says where the robot stands, or which way it points, or both. Needs a frame.
  /// @param at in frame(). @param yaw_rad finite. Counted as a reset.
  void place(std::optional<base::EnuPoint> at, std::optional<double> yaw_rad) noexcept;
  /// The operator says that the robot stands at a known point: the receiver's positions are moved
  /// accordingly until the fix class changes (for 2 s). Needs a pose. Counted as a reset.
  void anchor(base::EnuPoint at, std::optional<int> item) noexcept;
  void drop_anchor() noexcept;
  /// How what was seen of a known place compares with what is believed. Empty: nothing is believed
  /// yet, or it was seen too long ago (1 s), or is not finite.
  std::optional<LandmarkLook> compare(const LandmarkSight& sight, Time now) const noexcept;
  /// Corrects the estimate by it. @return false: it does not fit (kLandmarkGate2), cannot be
  /// compared, or nobody needs it; nothing changed.
  bool correct(const LandmarkSight& sight, Time now) noexcept;
  /// The first position and heading, where there are none yet, by a known place.
  /// @return false: there is a position, or no frame, or it is too old or not finite; nothing
  /// changed.
  bool begin(const LandmarkPose& seen, Time now) noexcept;
  /// Makes a frame with its origin there, where there is none.
  void need_frame(const base::LatLon& at) noexcept {
    if (!frame_) frame_.emplace(next_frame_id_, at);
  }
  bool located() const noexcept { return located_; }
  /// Fixed satellites or a map lead: known places are compared only.
  bool needs_no_landmark() const noexcept;
  /// Are positions that moved for good a question to a person (health().base_shift), or simply the
  /// new ones? A robot that nobody drives may be carried.
  void ask_about_shifts(bool ask) noexcept { asks_about_shifts_ = ask; }
  /// The answer. Keep: the place is the old one, the positions are moved back as by an anchor.
  /// Otherwise the new one is taken. Without a shift nothing happens. Counted as a reset.
  void settle_shift(bool keep) noexcept;
  /// A person confirms that the two antennas are mounted askew by what was measured
  /// (health().antennas_askew): from now on it is taken from their headings.
  void correct_antennas() noexcept;
  /// A person confirms an offset that was measured otherwise: left positive, all of it.
  void correct_antennas_by(double offset_rad) noexcept;
  /// What they say is taken as it is again.
  void uncorrect_antennas() noexcept;
  /// Tracks that spun counted a way that was not driven: the position may be off by so much, and
  /// the next usable fix decides, even while standing. No reset by itself.
  void doubt_position(double sigma_m) noexcept;
  /// A person has looked: sensors that were left out are heard again.
  void acquit_all() noexcept {
    votes_.acquit_all(now_);
    differed_m_ = 0.0;
  }
  /// The estimate was set anew by so much, and nobody knows whether that was right: no claim is
  /// better, until trust().
  void distrust(double moved_m, double turned_rad) noexcept {
    distrust_m_ = std::max(distrust_m_, moved_m);
    distrust_rad_ = std::max(distrust_rad_, turned_rad);
  }
  void trust() noexcept { distrust_m_ = distrust_rad_ = differed_m_ = 0.0; }

  /// Empty until the first usable fix. Without a known heading the yaw sigma is π.
  std::optional<base::Pose> pose(Time now) const;
  const std::optional<base::LocalFrame>& frame() const noexcept { return frame_; }
  base::EstimatorHealth health() const noexcept;
  const Belief& belief() const noexcept { return belief_; }

  bool heading_known() const noexcept { return heading_known_; }
  base::Alignment alignment() const noexcept;
  bool standing() const noexcept { return standing_; }
  /// The yaw rate comes from a gyro.
  bool gyro() const noexcept { return gyro_used_; }
  /// So long, at most, until it is known whether the receiver's positions wander.
  double wander_unknown_s() const noexcept { return wander_watch_.unknown_s(); }
  /// Stamp of the last position that was fused, or told by the operator.
  std::optional<Time> last_position() const noexcept { return last_fused_; }
  double yaw_scale() const noexcept { return belief_.x(kYawScale); }
  double pull_1pm() const noexcept { return belief_.x(kPull); }
  /// Where it drives beside where it points, for each metre (see Belief): to its left, and in ENU.
  double crab() const noexcept { return belief_.x(kCrab); }
  base::EnuPoint slide() const noexcept { return {belief_.x(kSlideE), belief_.x(kSlideN)}; }
  /// All turning since the start, without the jumps of corrections; not wrapped.
  double turned_rad() const noexcept { return sums_.turned_rad; }
  /// All way since the start, backwards negative, likewise.
  double driven_m() const noexcept { return sums_.ahead_m; }
  /// By a device, or by gyro and accelerometer; empty: nothing tells.
  std::optional<base::Attitude> attitude(Time now) const noexcept { return tilt_.at(now); }

 private:
  using Input = base::InputHealth;
  static constexpr base::Duration kOdometryGone = std::chrono::milliseconds(300);
  static constexpr base::Duration kGnssGone = std::chrono::milliseconds(2000);
  /// A stamp that lies farther ahead is none.
  static constexpr base::Duration kFuture = std::chrono::milliseconds(50);
  static constexpr double kApproach_mps = 0.25;   ///< to a better fix class: slower than it steers
  static constexpr double kArrived_m = 0.02;      ///< at another source: no limit any more
  static constexpr double kTakeOver_m = 25.0;     ///< satellites after a map, farther off: a jump
  static constexpr double kSlideAtFirst = 0.015;  ///< 1 sigma, each way
  /// Of the crab. A robot that drives beside where it points shows it only against two antennas;
  /// else what it points to is found by where it drives.
  static constexpr double kCrabSeen = 0.05;
  static constexpr double kCrabUnseen = 0.03;
  /// 1 sigma of what the heading is said to be uncertain by for it: tracks crab by up to 10 % of
  /// their way, on a slope by more.
  static constexpr double kAside_rad = 0.08;
  static constexpr double kAsidePerGrade_rad = 0.1;
  struct Arm {  ///< from the body's origin to the antenna, in ENU
    double east_m, north_m;
  };

  void take(const base::GnssFix& told);
  void take(const base::GnssVelocity& velocity);
  void take(const base::Heading& heading);
  void take(const base::Inertial& inertial);
  void take(const base::Attitude& attitude);
  void take(const base::WheelTravel& travel);
  void take(const base::BaseMotion& motion);
  void take(const base::MotorState& motor);
  void take(const base::PlaceState& told);

  bool in_order(Input& input, std::optional<Time>& last, Time stamp) noexcept;
  void refuse(Input& input, base::Refusal why) noexcept;
  template <int M>
  bool apply(Input& input, const Observation<M>& o) noexcept;

  // estimator.cpp, tracks.cpp: time, tracks, gyro
  void step(const Travel& travel, Time stamp) noexcept;
  void doubt_assumed(double dt_s) noexcept;
  void watch_standing(const Travel& travel, Time stamp) noexcept;
  bool gyro_stands(Time stamp) const noexcept;
  void learn_gyro_bias(Time stamp) noexcept;
  void learn_tracks(const Travel& travel) noexcept;
  void remember(Time stamp) noexcept;
  Slip slip() const noexcept;
  bool has_odometry(Time at) const noexcept;
  Coast coast(Time now) const noexcept;
  void watch_alignment() noexcept;
  bool settled_in(std::optional<Time> since) const noexcept;

  // heading.cpp
  void first_heading(double yaw_rad, double sigma_rad, bool compass) noexcept;
  void fuse_compass(const base::Heading& heading, const StateVector& at) noexcept;
  bool askew(const base::Heading& heading) noexcept;
  void fuse_antennas(const base::Heading& heading, const StateVector& at) noexcept;
  void set_heading(double yaw_rad, double sigma_rad) noexcept;
  double shown_bias_rad(const StateVector& x) const noexcept;

  // position.cpp
  void change_class(const base::GnssFix& fix, const GnssQuality& q) noexcept;
  void first_fix(const base::GnssFix& fix, const GnssQuality& q);
  void fuse_position(const base::GnssFix& fix, const GnssQuality& q) noexcept;
  void approach(Observation<2>& o) noexcept;
  base::GnssFix worth(const base::GnssFix& told) noexcept;
  void widen(GnssQuality& q) noexcept;
  bool shifted(const base::GnssFix& fix, const GnssQuality& q) noexcept;
  double suspected_m(const GnssQuality& q) const noexcept;
  double suspected_course() const noexcept;
  double doubt_after_s(const GnssQuality& q) const noexcept;
  void watch_slip(const Observation<2>& o, double yaw_rad, Time stamp) noexcept;
  void position_refused(const base::GnssFix& fix, const GnssQuality& q, double off_m) noexcept;
  void reset_position(base::EnuPoint at, const GnssQuality& q) noexcept;
  base::EnuPoint local(const base::GnssFix& fix) const noexcept;
  Arm arm(double yaw_rad) const noexcept;
  base::OverGround over_ground(double speed_mps, double yaw_rate_radps) const noexcept;
  template <class M>
  Time taken_at(const M& m) const noexcept;

  // place.cpp
  bool map_is_fresh() const noexcept;
  bool satellites_lead() const noexcept;
  double map_floor_m() const noexcept;
  double map_floor_rad() const noexcept;
  void first_place(const base::PlaceFix& fix, Time stamp) noexcept;
  void follow_satellites(const base::PlaceFix& fix, Time stamp) noexcept;
  struct Since {
    base::EnuPoint way;
    double turned_rad = 0.0;
  };
  Since driven_since(const StateVector& then, double yaw_rad) const noexcept;
  void ask_north(base::PlaceFix& fix) noexcept;
  void watch_denial(const base::PlaceState& told) noexcept;
  void lead_by_map(Time stamp) noexcept;
  void fuse_place(const base::PlaceFix& fix, Time stamp) noexcept;
  void fuse_place_heading(const base::PlaceFix& fix, const StateVector& at,
                          double since_s) noexcept;
  bool believable(const Observation<2>& o, const base::PlaceFix& fix,
                  double yaw_rad) const noexcept;
  void share_with_anchor(Observation<2>& o) noexcept;
  void weaken(Observation<2>& o, double since_s) noexcept;
  static void only_the_place(Observation<2>& o) noexcept;
  void place_refused(const base::PlaceFix& fix, Time stamp, base::EnuPoint off) noexcept;
  void forget_refused() noexcept;
  bool satellites_object(base::EnuPoint off) const noexcept;
  bool beside_the_map(const base::GnssFix& fix, const GnssQuality& q) noexcept;
  bool learn_beside_the_map(base::EnuPoint off, const base::GnssFix& fix,
                            const GnssQuality& q) noexcept;

  // landmark.cpp
  Observation<2> place_of(const LandmarkSight& s, const StateVector& at) const noexcept;
  void turn_by(const LandmarkSight& s, const StateVector& at, double together) noexcept;
  void lead_after_landmarks(const base::GnssFix& fix, const GnssQuality& q) noexcept;

  // velocity.cpp
  void fuse_velocity(const base::GnssVelocity& velocity, double sigma_mps) noexcept;
  void fuse_course(const base::GnssVelocity& velocity, double sigma_mps) noexcept;
  void fuse_vector(const base::GnssVelocity& velocity, double sigma_mps, const Past& at,
                   const base::BodyTwist& odometry) noexcept;
  bool align(const base::GnssVelocity& velocity, double sigma_mps, const Past& at,
             const base::BodyTwist& odometry) noexcept;
  void velocity_refused(const base::GnssVelocity& v, double ahead_mps, double sigma_mps) noexcept;

  // contradiction.cpp
  void vote(Time now) noexcept;
  void spoil(base::Sense liar) noexcept;
  bool outvoted(base::Sense s, Input& input) noexcept;
  bool proved() const noexcept;
  void count_as_proof(Time stamp) noexcept;
  double spoiled_way_m(const base::Difference& off) const noexcept;
  double claimed_m(const Belief& b) const noexcept;
  double unknown_m() const noexcept;
  double unknown_rad() const noexcept;
  double aside_rad() const noexcept;

  // positioning.cpp
  void move(base::EnuPoint to, double sigma_m) noexcept;
  void note_reset(std::string_view what, const Belief& before) noexcept;
  std::string_view advice() const noexcept;

  base::Setting<EstimateParams> params_;
  Belief belief_;
  History history_;
  Gyro gyro_;
  Tilt tilt_;
  Arrival arrival_;
  Receivers receivers_;
  Votes votes_;
  SlipWatch slip_watch_;
  ShiftWatch shift_watch_;
  AskewWatch askew_watch_;
  double askew_way_m_ = 0.0;  ///< counted_m_ when it was last asked
  bool asks_about_shifts_ = false;
  bool vague_ = true;       ///< the place was, when the fixed solution began
  double doubted_m_ = 0.0;  ///< what of the position's sigma is doubt since its source was left out
  double distrust_m_ = 0.0;
  double distrust_rad_ = 0.0;
  double differed_m_ = 0.0;         ///< by what sensors contradicted each other, fading
  double proving_s_ = 0.0;          ///< for so long it drove with positions, without a gap
  std::optional<Time> proving_at_;  ///< by the last one of them
  std::optional<Time> voted_;       ///< when it was looked at last
  double refused_m_ = 0.0;          ///< how far off the position is that is refused now
  std::optional<double> claimed_when_off_m_;  ///< when positions began to be refused
  std::optional<base::LocalFrame> frame_;
  std::uint32_t next_frame_id_ = 1;
  bool located_ = false;
  bool heading_known_ = false;
  bool standing_ = false;
  bool has_moved_ = false;
  bool gyro_used_ = false;
  bool approaching_ = false;  ///< a better fix class, slowly
  bool placed_ = false;
  base::Alignment alignment_ = base::Alignment::Unknown;

  Time now_{};                     ///< of this tick
  std::optional<Time> filter_at_;  ///< the belief's time
  Past sums_;                      ///< travel since the start
  Travel untold_;                  ///< travel of which gyro and tracks were not compared yet
  double untold_turned_rad_ = 0.0;
  double free_m_ = 0.0;
  double counted_m_ = 0.0;  ///< all way, either direction
  struct Crept {
    double ahead_m = 0.0;
    double half_m = 0.0;  ///< of the difference between the tracks
  };
  Crept crept_;               ///< since the tracks moved last; fades
  Time moved_at_{};           ///< last time the tracks moved, or the gyro turned
  Time bias_learned_at_{};    ///< likewise for the gyro's bias
  base::BodyTwist tracks_{};  ///< present speed by the tracks, unscaled
  std::optional<Time> tracks_at_;
  std::optional<base::GnssVelocity> velocity_;
  double late_s_ = 0.0;  ///< of the last fix, beyond the usual latency

  struct Current {
    double ampere = 0.0;
    std::optional<Time> stamp;
  };
  Current left_, right_;  ///< motor currents as the compass feels them

  std::optional<Time> last_travel_, last_motion_, last_fix_, last_velocity_;
  std::optional<Time> last_compass_, last_antennas_, last_inertial_, last_fused_;
  std::optional<Time> located_since_, heading_since_, pivot_at_;
  std::optional<Time> position_off_since_, velocity_off_since_, compass_off_since_;
  std::optional<Time> antennas_off_since_, far_off_since_, anchor_off_since_;
  FixTrust fix_trust_;
  NoiseWatch noise_watch_;
  WanderWatch wander_watch_;
  bool wandered_ = false;  ///< positions do, and the belief knows it
  base::FixType fused_type_ = base::FixType::None;
  CoarseWalk coarse_walk_;
  base::FixType anchor_type_ = base::FixType::None;
  Time approach_until_{};
  double approach_mps_ = kApproach_mps;

  std::optional<Time> last_place_;       ///< stamp of the map's last word
  std::optional<Time> last_by_map_;      ///< when one was fused
  std::optional<Time> last_satellites_;  ///< when a position of theirs was fused
  std::optional<Time> lead_until_;       ///< the map leads since lately: slowly, at most until then
  /// The last position of satellites while the map leads, taken or not.
  struct Beside {
    Time at;
    base::EnuPoint off;  ///< from the estimate
    double sigma_m = 0.0;
  };
  std::optional<Beside> beside_;
  std::optional<Time> offset_learned_at_;
  std::optional<Time> map_off_since_;
  std::optional<Time> map_refused_at_;
  int map_refused_ = 0;
  std::uint32_t map_ = 0;
  std::uint32_t map_found_ = 0;
  MapOffset map_offset_;            ///< of health().map_offset
  double map_yaw_sigma_rad_ = 0.0;  ///< of the map's own heading on the earth
  bool north_asked_ = false;        ///< satellites were heard beside this map
  double north_said_rad_ = 0.0;     ///< by which a person's word of north may be wrong; 0: none
  bool denial_counted_ = false;     ///< what the map denies is in the claim
  std::optional<Time> last_by_landmark_;  ///< when one was fused
  std::optional<Time> by_landmark_at_;    ///< when one was to be
  bool landmarks_led_ = false;            ///< since a fixed position was fused
  double landmark_room_s_ = 0.0;          ///< of the speed at which they may move the estimate
  std::optional<double> alt_msl_m_;
  Drift drift_{};

  base::EstimatorHealth health_;  ///< counts and inputs; the rest is filled in when asked
};

/// When the receiver measured what has this stamp.
template <class M>
Time Estimator::taken_at(const M& m) const noexcept {
  return m.stamp - base::from_seconds(m.latency_s.value_or(params_->gnss_latency_s + late_s_));
}

/// Updates the belief and the recent past; notes the innovation, used or not.
template <int M>
bool Estimator::apply(Input& input, const Observation<M>& o) noexcept {
  StateVector change;
  double nis = 0.0;
  const bool used = update(belief_, o, change, nis);
  if (std::isfinite(nis)) {
    input.innovation = base::Innovation{M == 1 ? o.innovation(0) : o.innovation.norm(), nis};
  }
  if (used) history_.shift(change);
  return used;
}

}  // namespace roverd::nav
