#pragma once
// What an MTi measures, as the robot wants to hear it: in the body's axes, at the body's origin,
// stamped with the time of the sample.
//
//   Inertial    of each message with a rate of turn or an acceleration; what clipped is left out.
//               The centripetal part of the lever arm is taken off the acceleration (the part of
//               an angular acceleration is not: its noise would be larger than itself)
//   Attitude    of a quaternion, else of Euler angles, while the unit calls its orientation valid
//   Heading     of the magnetic field, levelled by that attitude (without one by the acceleration,
//               smoothed over 2 s), or of the unit's orientation; at most heading_hz
//   GnssFix, GnssVelocity     of the unit's filter, at its own place minus the lever arm, at most
//               position_hz; or of its receiver, at the antenna
//   SatellitesInView          of its receiver
//
// The receiver's messages come 40 ms to 2.5 s after the samples that they tell of, with those
// samples' time: they are stamped so, told with their true latency (none), and move nothing else.
//
// A failed self-test, a sample time that stands still or goes back, 0, 0, dates before this
// software was written, a field that is not the earth's: refused by name, never told. What is of no
// use, is noted. Axes: mti/rotation.hpp. Pure state; one thread.

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "base/measurements.hpp"
#include "mti/data2.hpp"
#include "mti/params.hpp"
#include "mti/rotation.hpp"
#include "mti/sample_clock.hpp"

namespace roverd::mti {

/// What one message says, gathered from its packets; in the sensor's and the unit's own axes.
struct Sample {
  std::optional<std::uint32_t> count;  ///< sample time fine
  std::optional<std::uint16_t> number;
  std::optional<Status> status;
  std::optional<Vec3> rate_S;
  std::optional<Vec3> accel_S;
  std::optional<Vec3> field_S;
  std::optional<Mat3> R_ES;
  std::optional<base::LatLon> at;
  std::optional<double> height_ellipsoid_m;
  std::optional<Vec3> velocity_E;
  std::optional<Utc> utc;
  std::optional<GnssPvt> pvt;
  std::optional<Satellites> satellites;
};

class Interpreter {
 public:
  struct Ears {
    std::function<void(const base::Measurement&)> tell;
    std::function<void(std::string_view cause, std::uint64_t more)> refused;
    std::function<void(std::string_view what, std::uint64_t more)> noted;
  };
  /// Horizontal and whole strength of a field that is believed, of the field at calibration.
  static constexpr double kFieldMin = 0.4;
  static constexpr double kFieldMax = 2.0;
  static constexpr double kFlatFieldMin = 0.05;

  /// @param name of the driver, for the satellites. @param params valid.
  Interpreter(std::string name, const Params& params, Ears ears);

  /// One MTData2 payload. @return whether it is the unit's present word; false: all of it refused.
  bool take(Bytes payload, Time arrival);
  /// A pause: what was heard before is worth nothing any more, but a unit that stood still before
  /// it stands still after it.
  void forget();
  /// Another unit, or one that began anew.
  void reset();

  const std::optional<Status>& status() const noexcept { return status_; }
  /// The last message was refused because its sample time stood still.
  bool frozen() const noexcept { return frozen_; }

 private:
  Sample gather(const Data2& data) const;
  void gather_numbers(Sample& s, const Packet& packet, const Numbers& n) const;
  std::optional<Time> time_of(const Sample& s, Time arrival);
  std::optional<Time> time_of_receiver(const Sample& s, Time arrival);
  void count_lost(const Sample& s);
  void learn(const Sample& s, Time stamp);
  void tell_inertial(const Sample& s, Time stamp);
  void tell_attitude(const Sample& s, Time stamp);
  void tell_heading(const Sample& s, Time stamp);
  void tell_filter(const Sample& s, Time stamp);
  void tell_receiver(const GnssPvt& pvt, Time stamp);
  void tell_satellites(const Satellites& satellites, Time stamp);
  void tell_fix(base::GnssFix fix);
  base::FixType filter_fix(Time stamp) const;
  std::optional<double> magnetic_heading_deg(const Vec3& field_S);
  bool oriented() const noexcept { return !status_ || status_->orientation_valid(); }
  bool clipped(unsigned first_bit) const noexcept;
  base::BodyVector body(const Vec3& v_S) const noexcept;

  const std::string name_;
  const Params params_;
  const Ears ears_;
  const Mat3 R_BS_;
  const Vec3 arm_B_;
  SampleClock clock_;
  bool frozen_ = false;
  std::optional<double> latency_s_;  ///< of the present message; empty: it came without a time
  std::optional<std::uint32_t> pvt_count_;
  std::optional<std::uint16_t> number_;
  std::optional<Status> status_;
  std::optional<Mat3> R_EB_;  ///< while the unit tells its orientation
  std::optional<Vec3> rate_B_;
  std::optional<Vec3> slow_accel_B_;  ///< smoothed, for levelling
  Time slow_at_{};
  std::optional<GnssPvt> pvt_;
  Time pvt_at_{};
  std::optional<Time> heading_at_;
  std::optional<Time> position_at_;
};

}  // namespace roverd::mti
