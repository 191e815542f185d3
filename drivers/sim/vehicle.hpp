#pragma once
// A simulated vehicle as the program and the tests see it: what all of them have in common. Each
// has its own kinematics and wire, and a true pose that only tests look at. None knows anything of
// the navigation it is to judge.
//
//   command on the wire ─▶ motors, tracks or wheels ─▶ slip ─▶ true pose ─▶ GNSS, compass
//                             └─▶ what the device reports
//
// No thread, no clock: advance_to(t) runs fixed inner steps of 5 ms up to t. The same parameters,
// seed, start and inputs at the same times give the same frames and bytes.

#include <cstdint>
#include <functional>
#include <optional>
#include <utility>

#include "base/bytes.hpp"
#include "base/geo.hpp"
#include "base/measurements.hpp"
#include "base/result.hpp"
#include "base/time.hpp"
#include "sim/battery.hpp"
#include "sim/foreign.hpp"
#include "sim/ground.hpp"
#include "sim/imu.hpp"
#include "sim/motion.hpp"
#include "sim/params.hpp"
#include "sim/radio.hpp"
#include "sim/receiver.hpp"

namespace roverd::sim {

using base::Bytes;
using base::CanFrame;
using base::Time;

struct Start {
  base::LatLon at{58.378020, 26.728900};
  double heading_deg = 40.0;
  Time time{};            ///< the plant's time begins here
  base::WallTime wall{};  ///< what the receiver calls UTC at `time`
};

/// What is really so. Local metres: ENU at the start (east and north of `Start::at`).
struct Truth {
  Time time;
  base::LatLon at;
  base::EnuPoint local;
  double yaw_rad = 0.0;         ///< (−π, π]
  double roll_rad = 0.0;        ///< right side down positive, as the slope leans it
  double pitch_rad = 0.0;       ///< nose up positive
  base::BodyTwist twist;        ///< over ground, at the body's origin
  double lateral_mps = 0.0;     ///< likewise, to the left
  double left_track_mps = 0.0;  ///< what the encoders see; of a car: the driven wheels
  double right_track_mps = 0.0;
  double wheel_rad = 0.0;  ///< of a car: where the front wheels really stand, left positive
  double driven_m = 0.0;   ///< way of the body's origin since the start
  double battery_pct = 0.0;
  base::ControlMode control_mode = base::ControlMode::Standby;
  base::VehicleState vehicle_state = base::VehicleState::Normal;
  std::uint64_t commands = 0;  ///< motion commands that reached the vehicle
};

/// As Truth, without what costs geodesy: for whoever looks at every step.
struct Stance {
  Time time;
  base::EnuPoint at;
  double yaw_rad = 0.0;
  double speed_mps = 0.0;
};

class Vehicle {
 public:
  static constexpr base::Duration kStep = std::chrono::milliseconds(5);

  virtual ~Vehicle() = default;
  Vehicle(const Vehicle&) = delete;
  Vehicle& operator=(const Vehicle&) = delete;

  /// Called from within advance_to, stamped with the time at which the sentences of one epoch
  /// leave. May be empty.
  std::function<void(Bytes, Time)> on_gnss;
  /// The same of the inertial unit's messages.
  std::function<void(Bytes, Time)> on_imu;
  /// Called after each step. May be empty.
  std::function<void()> on_step;
  /// From the host to the inertial unit.
  void receive_imu(Bytes bytes) { imu_.receive(bytes); }

  /// Runs whole steps until the next one would end after `now`; an earlier `now` does nothing.
  void advance_to(Time now);

  Truth truth() const;
  Stance stance() const noexcept { return {now_, at_, yaw_rad_, twist_.linear_mps}; }
  const base::LocalFrame& frame() const noexcept { return frame_; }  ///< ENU at the start

  const Radio& radio() const noexcept { return radio_; }
  void set_radio(const Radio& radio) { radio_ = radio; }
  const Faults& faults() const noexcept { return faults_; }
  /// A changed gnss_jump_* starts its duration anew; when it is over all three are zero again.
  /// Unknown word in gnss_fix: an error, no change.
  base::Result<void> set_faults(const Faults& faults);
  const Params& params() const noexcept { return params_; }
  /// Takes effect at the next step; start values (battery.start_pct, [device]) do not.
  void set_params(const Params& params) { params_ = params; }

  /// From now on that one moves instead of our own tracks or wheels; it must outlive this.
  void set_foreign(Foreign* foreign) noexcept { foreign_ = foreign; }

  /// From now on it stands on this ground, not on the plane of its parameters; slip, ruts and trees
  /// stay. Not with a foreign one.
  void set_lie(std::function<Lie(base::EnuPoint at, double yaw_rad)> lie) { lie_ = std::move(lie); }

  /// @param percent is cut to 0..100.
  void set_battery_pct(double percent) { battery_.set_charge_pct(percent); }
  /// Puts the vehicle somewhere else, standing. @param at valid.
  void place(base::LatLon at, double heading_deg);
  /// Odometer and counters begin anew, latched errors go, mode as after power-up.
  void power_cycle();

 protected:
  Vehicle(const Params& params, std::uint64_t seed, const Start& start);

  /// What one step of the motors does.
  struct Moved {
    GroundMotion ground;
    double power_w = 0.0;             ///< drawn from the battery
    double motor_difference_a = 0.0;  ///< right minus left: disturbs the compass
    double travel_mps = 0.0;          ///< mean of both tracks' speeds, without sign
  };
  virtual Moved drive(double dt_s) = 0;
  /// After each step: what leaves on the wire now.
  virtual void report() = 0;
  /// Motors, wire and modes into the truth.
  virtual void describe(Truth& truth) const = 0;
  /// Motors stand, at once.
  virtual void halt() = 0;
  virtual void restart() = 0;

  /// Null without one. Otherwise it gets the order, twice as seldom as steps are made.
  const ForeignState* foreign_moved(const ForeignOrder& order);
  /// Of what is wanted, what the motors reach with this battery.
  double reach() const noexcept { return battery_.reach(params_.battery); }
  /// The drive in this step: as it stands in the parameters, with its load, on this ground.
  const DriveParams& drive_now() const noexcept { return drive_now_; }
  Time now() const noexcept { return now_; }
  std::int64_t steps() const noexcept { return steps_; }
  /// Reports with a period of so many steps; the phases spread the load.
  bool every(int period, int phase) const noexcept { return steps_ % period == phase; }
  bool radio_heard() const noexcept {
    return radio_.on && !faults_.radio_loss && !faults_.radio_freeze;
  }
  const Battery& battery() const noexcept { return battery_; }
  void clear_error_bits(unsigned bits) noexcept {
    faults_.error_bits = static_cast<int>(static_cast<unsigned>(faults_.error_bits) & ~bits);
  }

 private:
  void step();
  Footing footing() const;
  void move(const Moved& moved, double dt_s);
  void follow(const ForeignState& shown, double dt_s);
  void measure(const BodyState& body, double motor_difference_a);

  Params params_;
  const std::uint64_t seed_;
  const Start start_;
  const base::LocalFrame frame_;
  Battery battery_;
  Jitter jitter_;
  Receiver receiver_;
  Imu imu_;
  Radio radio_;
  Faults faults_;
  Time now_;
  std::optional<Time> jump_until_;
  std::int64_t steps_ = 0;
  base::EnuPoint at_;
  double yaw_rad_;
  double driven_m_ = 0.0;
  base::BodyTwist twist_;
  double lateral_mps_ = 0.0;
  DriveParams drive_now_;
  Footing footing_;
  std::function<Lie(base::EnuPoint, double)> lie_;
  Foreign* foreign_ = nullptr;
};

}  // namespace roverd::sim
