#pragma once
// The newest of everything the drivers said, and since when. Control thread only.

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "base/measurements.hpp"
#include "base/snapshot.hpp"
#include "robot/safety/battery_gauge.hpp"
#include "robot/safety/receiver_clock.hpp"

namespace roverd::robot {

using base::Time;

struct World {
  std::optional<base::GnssFix> gnss;
  std::optional<base::GnssVelocity> gnss_velocity;
  std::optional<base::Attitude> attitude;
  std::optional<base::PlaceState> place;
  std::vector<base::SatellitesInView> satellites;  ///< one for each receiver
  std::optional<base::BaseStatus> base;
  std::optional<base::BaseMotion> motion;
  std::optional<base::SteeringState> steering;
  std::optional<base::BatteryState> battery;
  std::vector<base::MotorState> motors;
  std::optional<base::LightState> lights;
  std::optional<base::Heading> compass;   ///< as shown
  std::optional<base::Heading> antennas;  ///< likewise
  std::optional<base::Bumper> bumper;
  /// Where it was hit, until the robot has latched its stop: a hit shorter than a tick counts too.
  std::optional<std::string> bumper_hit;
  std::optional<base::RadioState> radio;
  std::optional<base::OperatorLink> operators;
  std::vector<base::DriverStatus> drivers;
  std::vector<base::HostProblem> host;  ///< what is wrong with this computer

  base::Switch swb = base::Switch::Unknown;  ///< last position between detents
  std::optional<Time> radio_counted;         ///< when the radio's counter last changed
  std::optional<Time> gnss_good_since;       ///< usable fixes without a gap from then on
  std::optional<Time> gnss_broke;            ///< when there was none last
  const char* gnss_broke_by = "";            ///< a static text: "it had no fix"
  ReceiverClock receiver_clock;
  std::optional<Time> base_heard;  ///< any word from it

  BatteryGauge gauge;                ///< speaks while the battery itself tells nothing
  std::optional<Time> battery_told;  ///< by the battery itself

  static constexpr int kMotors = 8;
  static constexpr std::size_t kReceivers = 4;

  void take(base::Measurement&& m) {
    std::visit([this](auto& value) { put(std::move(value)); }, m);
  }

  /// No usable fix for 2 s ends the healthy time.
  void forget_stale(Time now) noexcept {
    if (gnss && now - gnss->stamp > std::chrono::seconds(2)) end_good("it was silent", now);
  }

 private:
  void end_good(const char* why, Time when) noexcept {
    gnss_good_since.reset();
    gnss_broke = when;
    gnss_broke_by = why;
  }
  void put(base::GnssFix&& m) {
    receiver_clock.take(m.utc, m.stamp);
    const bool usable = m.position && m.fix >= base::FixType::Single;
    if (!usable) end_good("it had no fix", m.stamp);
    if (usable && !gnss_good_since) gnss_good_since = m.stamp;
    gnss = m;
  }
  void put(base::GnssVelocity&& m) { gnss_velocity = m; }
  void put(base::BaseStatus&& m) {
    base_heard = m.stamp;
    base = std::move(m);
    if (battery_told && base->stamp - *battery_told < std::chrono::seconds(10)) return;
    if (const auto charge = gauge.step(*base)) battery = charge;
  }
  void put(base::BaseMotion&& m) {
    if (!m.assumed) base_heard = m.stamp;
    motion = m;
  }
  void put(base::WheelTravel&& m) { base_heard = m.stamp; }
  void put(base::Heading&& m) {
    (m.source == base::HeadingSource::Compass ? compass : antennas) = m;
  }
  void put(base::Inertial&&) {}
  void put(base::Attitude&& m) { attitude = m; }
  void put(base::PlaceState&& m) { place = std::move(m); }
  void put(base::SatellitesInView&& m) {
    for (base::SatellitesInView& known : satellites) {
      if (known.driver != m.driver) continue;
      known = std::move(m);
      return;
    }
    if (satellites.size() < kReceivers) satellites.push_back(std::move(m));
  }
  void put(base::SteeringState&& m) { steering = m; }
  void put(base::BatteryState&& m) {
    battery_told = m.stamp;
    battery = std::move(m);
  }
  void put(base::MotorState&& m) {
    if (m.motor < 1 || m.motor > kMotors) return;
    const auto at = std::find_if(motors.begin(), motors.end(),
                                 [&](const base::MotorState& k) { return k.motor >= m.motor; });
    if (at != motors.end() && at->motor == m.motor) {
      *at = std::move(m);
    } else {
      motors.insert(at, std::move(m));
    }
  }
  void put(base::LightState&& m) { lights = m; }
  void put(base::Bumper&& m) {
    if (m.pressed) bumper_hit = m.where;
    bumper = std::move(m);
  }
  void put(base::RadioState&& m) {
    if (m.swb != base::Switch::Unknown) swb = m.swb;
    if (!radio || radio->count != m.count) radio_counted = m.stamp;
    radio = m;
  }
  void put(base::OperatorLink&& m) { operators = m; }
  void put(base::HostStatus&& m) { host = std::move(m.problems); }
  void put(base::DriverStatus&& m) {
    for (base::DriverStatus& known : drivers) {
      if (known.name != m.name) continue;
      known = std::move(m);
      return;
    }
    if (drivers.size() < 64) drivers.push_back(std::move(m));
  }
};

}  // namespace roverd::robot
