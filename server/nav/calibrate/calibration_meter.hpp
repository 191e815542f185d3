#pragma once
// What a guided calibration drive measures, from what it is told of the drive and what it sees.
//
//   Stretch ── from standing to standing ──▶ speed scale, turn scale, side bias, steering zero
//   Ramp, Stop ── what the base shows ─────▶ acceleration, braking
//   all of it ── told against seen ────────▶ delays (a learner of its own: what ordinary driving
//                                            taught, or teaches, stays out of it)
//   headings ── against pose or way ───────▶ compass, antennas
//
// Control thread; no allocation; nothing here reads a clock.

#include <array>
#include <optional>

#include "base/calibration.hpp"
#include "nav/calibrate/slope_trace.hpp"
#include "nav/calibrate/turn_fit.hpp"
#include "nav/estimate/askew_watch.hpp"
#include "nav/identify/vehicle_learner.hpp"
#include "nav/track/tracker.hpp"

namespace roverd::nav {

/// One tick's view.
struct CalibrationSight {
  VehicleLearner::Seen seen;
  Vehicle vehicle;
  bool turn_measured = false;           ///< the yaw rate is a gyro's, or the base's own word
  std::optional<base::BodyTwist> told;  ///< what the base shows, or else what it was told to do
  base::Time told_stamp{};
  std::optional<double> compass_rad;   ///< as shown, newer than the tick before
  std::optional<double> antennas_rad;  ///< likewise
};

/// In use when the drive begins.
struct CalibrationBefore {
  double delay_s = 0.0;
  double braking_mps2 = 0.0;
  double acceleration_mps2 = 0.0;
  double speed_scale = 1.0;
  double turn_scale = 1.0;
  double side_bias_1pm = 0.0;
  double antennas_offset_rad = 0.0;
  double compass_offset_rad = 0.0;
  bool tells_speed = true;  ///< the vehicle itself, by what it measures
};

class CalibrationMeter {
 public:
  void begin(base::CalibrationKind kind, const CalibrationBefore& before, const PathParams& set);

  // Of the drive, in this order at each tick.
  void see(const CalibrationSight& sight) noexcept;
  void sent(const base::BodyTwist& twist) noexcept;

  // What it does. A stretch begins and ends where it stands.
  void stretch_begins() noexcept;
  /// @param straight along one line: its ends tell the way
  void stretch_ends(bool straight) noexcept;
  void straight_begins() noexcept;  ///< within a stretch that turned before
  /// It weaves at an even speed. Only that tells the delay of turning: where it pulls to a side, or
  /// is steered, a speed that changes turns it, too.
  void weaves(bool now) noexcept { weaves_ = now; }
  void ramp_begins(double to_mps, double accel_mps2) noexcept;
  void ramp_ends() noexcept;
  void stop_begins() noexcept;
  void stop_ends() noexcept;

  /// Fills `out` with what this kind measures. @return how many
  std::size_t tell(std::array<base::CalibrationValue, base::kQuantities>& out) const noexcept;

 private:
  using Value = base::CalibrationValue;
  Value learned(base::Quantity q) const noexcept;
  Value driven(base::Quantity q) const noexcept;
  Value turned(base::Quantity q) const noexcept;
  Value shown(base::Quantity q) const noexcept;
  void see_headings(const CalibrationSight& sight) noexcept;
  void see_course(double antennas_rad) noexcept;

  base::CalibrationKind kind_ = base::CalibrationKind::Drive;
  CalibrationBefore before_;
  PathParams set_;
  VehicleLearner learner_;
  TurnFit turns_;
  SlopeTrace trace_;
  Looks stops_, ramps_, scales_;
  bool ramp_limited_ = false;
  double ramp_asked_mps2_ = 0.0;
  double scale_noise_ = 0.0;
  enum class Trace { None, Ramp, Stop } tracing_ = Trace::None;

  Vehicle now_;
  bool seen_ = false;
  bool weaves_ = false;
  base::Time told_at_{};
  double told_mps_ = 0.0;
  bool shows_ = false;  ///< the base tells its speed
  double turned_rad_ = 0.0, told_rad_ = 0.0, told_m_ = 0.0;

  struct Mark {
    EnuPoint at;
    double turned_rad = 0.0, told_rad = 0.0, told_m = 0.0;
  };
  Mark mark() const noexcept { return {now_.at, turned_rad_, told_rad_, told_m_}; }
  Mark stretch_, straight_;
  bool on_straight_ = false;

  // Compass: shown minus true.
  double c_n_ = 0.0, c_about_ = 0.0, c_sum_ = 0.0, c_squares_ = 0.0;
  // Antennas.
  AskewWatch askew_;
  struct Chord {
    EnuPoint from;
    double sum = 0.0;
    double about = 0.0;
    int n = 0;
    double told_m = 0.0;
  };
  std::optional<Chord> chord_;
};

}  // namespace roverd::nav
