#pragma once
// The sensors vote: all that tells of the motion is listened to, whether it is used or not, and
// compared; the one that contradicts the others is named.
//
//   tracks, gyro, position, velocity, compass, antennas ─▶ Facts ─compare─▶ Table ─Jury─▶ who is
//   out
//
// Silent: not heard for 1 s; it has no voice. Tracks that were silent for 0.5 s begin anew. Frozen:
// the same value for 1 s and 5 times, and the tracks moved meanwhile. Not thread-safe, no
// allocation, nothing here reads a clock.

#include <array>
#include <optional>

#include "nav/vote/decide.hpp"
#include "nav/vote/run_off.hpp"

namespace roverd::nav {

/// What the estimator believes, and knows of the vehicle, at this tick.
struct Belonging {
  double yaw_rad = 0.0;
  double yaw_sigma_rad = base::kPi;
  double scale = 1.0;
  double scale_sigma = 1.0;
  double pull_1pm = 0.0;
  double pull_sigma_1pm = 0.0;
  double gyro_bias_sigma_radps = 0.0;
  double arm_m = 0.0;
  base::EnuPoint arm;       ///< to the antenna, as it leans: ahead and to the left of the centre, m
  base::EnuPoint downhill;  ///< ahead and to the left, tangents, as it is told to lean
  double downhill_sigma = 0.2;   ///< 0.2: nothing tells it
  double yaw_scale = 0.8;        ///< true turn over that of the tracks, where there is no gyro
  bool positions_proved = true;  ///< they were driven with for long enough
};

class Votes {
  using EnuPoint = base::EnuPoint;

 public:
  static constexpr double kSilent_s = 1.0;

  /// @param ahead_m, turn_rad since the last call, as the tracks measure it.
  void tracks(double ahead_m, double turn_rad, Time stamp) noexcept;
  /// The same of a base that tells nothing: what it was told to do. It has no voice, and says only
  /// which way it is going.
  void told_to(double ahead_m, double turn_rad) noexcept;
  /// @param rate_radps of the heading, without the bias. @param raw as the device told it.
  void gyro(double rate_radps, double raw, Time stamp) noexcept;
  /// @param taken when the receiver was there.
  void position(const Spot& spot, int fix_class, Time stamp) noexcept;
  /// @param slower_than_mps 0, or all that was told of it: no direction.
  void velocity(base::EnuPoint mps, double sigma_mps, Time taken, Time stamp,
                double slower_than_mps = 0.0) noexcept;
  /// Compass or antennas.
  void heading(Sense s, double yaw_rad, double sigma_rad, Time taken, Time stamp) noexcept;

  /// Once a tick. @return who was left out just now.
  std::optional<Sense> step(const Belonging& b, double sigmas, double return_s, Time now) noexcept;

  /// How far positions that are RTK fixed have run away from the velocity at the last look, of what
  /// proves it (1). Where it cannot be judged it is forgotten within about a second.
  double apart() const noexcept { return apart_; }
  /// How far positions have run off from tracks and gyro, of what proves it (1): see RunOff.
  /// It contradicts the tracks then, unless the velocity already contradicts the position.
  double off_course() const noexcept { return run_off_.proved(); }
  bool out(Sense s) const noexcept { return jury_.out(s); }
  /// When the one that was left out was first seen to contradict the others.
  Time seen(Sense s) const noexcept { return jury_.seen(s); }
  /// A moment before that it agreed well with all the others.
  bool agreed_before(Sense s) const noexcept { return jury_.agreed_before(s); }
  const base::Votes& told() const noexcept { return jury_.votes(); }
  /// A person says that all is well: everybody is heard again, from now on.
  void acquit_all(Time now) noexcept {
    jury_.acquit_all(now);
    apart_ = 0.0;
    run_off_.forget();
  }

 private:
  /// Does it say anything new?
  struct Repeats {
    double a = 0.0;
    double b = 0.0;
    int times = 0;
    std::optional<Time> since;
    double path_m = 0.0;  ///< of the tracks, when it began
    double turn_rad = 0.0;
  };

  void say(Sense s, double a, double b, Time stamp) noexcept;
  bool frozen(Sense s, Time now) const noexcept;
  void bear(Sense s, double yaw_rad, const Bearing& about, double ref_rad) noexcept;
  bool one_way(double path_m, double ahead_m) const noexcept;
  bool way_known(const Moment& from, const Moment& to) const noexcept;
  double turned_rad(const Moment& from, const Moment& to) const noexcept;
  double scatter_mps(EnuPoint mps) noexcept;
  void count(double ahead_m, double turn_rad) noexcept;
  void course_of(const Pace& pace) noexcept;
  void course_of_spots() noexcept;
  void follow_reference(Time now) noexcept;
  bool gyro_leads(Time now) const noexcept;
  bool spots_come(Time now) const noexcept;
  void look_for_run_off(const Table& table, Time now) noexcept;
  void tell_run_off(Table& table) const noexcept;

  Facts facts_;
  Moment sums_;
  double all_turned_rad_ = 0.0;  ///< all turning of the tracks, either way
  double gyro_rate_radps_ = 0.0;
  bool led_by_gyro_ = false;
  std::optional<int> fix_class_;
  std::array<std::optional<Time>, kSenses> heard_;
  std::array<Repeats, kSenses> repeats_;
  Belonging belief_;
  double dead_ahead_m_ = 0.0;  ///< of ahead_m, laid out already
  double dead_turn_rad_ = 0.0;
  double dead_gyro_rad_ = 0.0;
  std::optional<Time> looked_;
  bool spot_is_new_ = false;
  bool spot_waited_ = false;
  double scatter_m2ps2_ = 0.0;  ///< of velocities about the line through their neighbours, per axis
  double apart_ = 0.0;
  RunOff run_off_;
  Jury jury_;
};

}  // namespace roverd::nav
