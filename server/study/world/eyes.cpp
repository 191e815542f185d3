#include "study/world/eyes.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace roverd::study {
namespace {

using base::Echo;
using sim::world::Cause;
using sim::world::Shot;
using sim::world::Sweep;

constexpr double kEyeDegree = std::numbers::pi / 180.0;

base::SightPoint point(const Shot& s, double range_m, Echo echo, double after_s) {
  const auto b = static_cast<double>(s.bearing_rad);
  const auto e = static_cast<double>(s.elevation_rad);
  base::SightPoint p;
  p.x_m = static_cast<float>(range_m * std::cos(e) * std::cos(b));
  p.y_m = static_cast<float>(range_m * std::cos(e) * std::sin(b));
  p.z_m = static_cast<float>(range_m * std::sin(e));
  p.after_s = static_cast<float>(after_s);
  p.intensity = static_cast<std::uint16_t>(100.0F * s.intensity);
  p.ring = s.ring;
  p.echo = echo;
  return p;
}

base::Time at(double s) {
  return base::Time{base::from_seconds(s)};
}

/// To what the device counts in.
double rounded(double range_m, double unit_m) {
  return std::round(range_m / unit_m) * unit_m;
}

EyeSetup eye(const char* name, const char* kind, double rate_hz) {
  EyeSetup out;
  const bool lidar = std::string_view(kind) == "vlp16";
  out.seen = sim::world::usual(kind);
  out.seen.name = name;
  out.seen.rate_hz = rate_hz;
  out.said.said.kind = lidar ? "velodyne" : "sick";
  out.said.said.link = lidar ? "udp:2368" : "tcp:192.168.0.1:2111";
  out.said.said.rate_hz = rate_hz;
  return out;
}

void put(EyeSetup& one, double x_m, double z_m, double yaw_deg) {
  one.seen.x_m = one.said.said.x_m = x_m;
  one.seen.z_m = one.said.said.z_m = z_m;
  one.seen.yaw_deg = one.said.said.yaw_deg = yaw_deg;
}

}  // namespace

std::vector<EyeSetup> usual_eyes(const sim::BodyParams& body, bool lidar) {
  constexpr double kScanner_hz = 50.0;
  constexpr double kLidar_hz = 10.0;
  constexpr double kScannerUp_m = 0.30;
  EyeSetup front = eye("front", "lms", kScanner_hz);
  put(front, body.front_m, kScannerUp_m, 0.0);
  EyeSetup other;
  if (lidar) {
    other = eye("top", "vlp16", kLidar_hz);
    put(other, 0.5 * (body.front_m - body.rear_m), body.height_m + 0.4, 0.0);
  } else {
    other = eye("back", "lms", kScanner_hz);
    put(other, -body.rear_m, kScannerUp_m, 180.0);
  }
  return {front, other};
}

base::Sight scan_of(const sim::world::SensorParams& p, const Sweep& sweep, double clear_to_m) {
  base::Sight out;
  out.sensor = p.name;
  out.stamp = at(sweep.at_s);
  out.count = sweep.count;
  out.half_step_rad = static_cast<float>(p.step_deg * kEyeDegree / 2.0);
  out.clear_to_m = static_cast<float>(clear_to_m);
  out.window = sweep.blocked        ? base::Window::Blocked
               : sweep.dirty > 0.0F ? base::Window::Dirty
                                    : base::Window::Clean;
  out.points.reserve(sweep.shots.size());
  for (const Shot& s : sweep.shots) {
    const bool dazzled = s.cause == Cause::Sun || (s.cause == Cause::Window && s.range_m <= 0.0F);
    const double range_m = rounded(static_cast<double>(s.range_m), 1e-3);
    const auto after_s = static_cast<double>(s.after_s);
    if (range_m >= 0.016) {  // smaller ones are reserved words
      out.points.push_back(point(s, range_m, Echo::Hit, after_s));
    } else if (!dazzled && range_m <= 0.0 && clear_to_m > 0.0) {
      out.points.push_back(point(s, clear_to_m, Echo::Clear, after_s));
    } else {
      out.points.push_back(point(s, 1.0, Echo::Unknown, after_s));
    }
  }
  return out;
}

WorldEye::WorldEye(const EyeSetup& setup, std::uint64_t seed)
    : sensor_(setup.seen, seed, 0.0, kLidarThin),
      clear_to_m_(setup.said.said.kind == "velodyne" ? setup.said.velodyne.clear_to_m
                                                     : setup.said.sick.clear_to_m) {}

void WorldEye::advance(const sim::Surroundings& around, const sim::world::SensorFaults& all,
                       const std::function<void(const Told&)>& tell) {
  const sim::world::SensorFaults faults = sim::world::faults_of(all, name());
  const double now_s = around.now_s();
  if (faults.sensor_silent) {
    sensor_.skip_to(now_s);
    waiting_.clear();
    turn_.reset();
    packets_.clear();
    return;
  }
  const double latency_s = sensor_.params().latency_s + faults.sensor_latency_s;
  while (sensor_.next_s() <= now_s) {
    Sweep sweep;
    sensor_.sweep(
        around.scene(), [&](double at_s) { return around.pose_at(at_s); }, faults, sweep);
    if (sensor_.params().kind == "vlp16") {
      take_packet(std::move(sweep), latency_s);
      continue;
    }
    Told one;
    one.due_s = sweep.until_s + latency_s;
    one.sight = std::make_shared<const base::Sight>(scan_of(sensor_.params(), sweep, clear_to_m_));
    one.sweeps.push_back(std::move(sweep));
    waiting_.push_back(std::move(one));
  }
  while (!waiting_.empty() && waiting_.front().due_s <= now_s) {
    tell(waiting_.front());
    waiting_.pop_front();
  }
}

/// A turn ends where the azimuth falls back to 0: as drivers/velodyne/revolutions.hpp. The packet
/// in which it does so belongs to the new one: its first firings come 1.3 ms late.
void WorldEye::take_packet(Sweep&& sweep, double latency_s) {
  if (sweep.shots.empty()) return;
  const double first_rad =
      std::fmod(4.0 * std::numbers::pi - static_cast<double>(sweep.shots.front().bearing_rad),
                2.0 * std::numbers::pi);
  if (turn_ && first_rad < last_rad_) {
    Told one;
    one.due_s = sweep.until_s + latency_s;
    one.sight = std::move(turn_);
    one.sweeps = std::move(packets_);
    waiting_.push_back(std::move(one));
    packets_.clear();
    turn_.reset();
  }
  last_rad_ = first_rad;
  if (!turn_) {
    turn_ = std::make_shared<base::Sight>();
    turn_->sensor = name();
    turn_->stamp = at(sweep.at_s);
    turn_->count = turns_++;
    turn_->clear_to_m = static_cast<float>(clear_to_m_);
    const double step_rad =
        2.0 * std::numbers::pi * sensor_.params().rate_hz * sim::world::kVlpFiring_s * kLidarThin;
    turn_->half_step_rad = static_cast<float>(step_rad / 2.0);
  }
  const double began_s = base::seconds(turn_->stamp.time_since_epoch());
  for (const Shot& s : sweep.shots) {
    const bool second = s.second_m > 0.0F && s.second_intensity > s.intensity;
    const double range_m = rounded(static_cast<double>(second ? s.second_m : s.range_m), 2e-3);
    const double after_s = sweep.at_s - began_s + static_cast<double>(s.after_s);
    const Echo none = clear_to_m_ > 0.0 ? Echo::Clear : Echo::Unknown;
    if (range_m > 0.0) {
      turn_->points.push_back(point(s, range_m, Echo::Hit, after_s));
    } else {
      turn_->points.push_back(point(s, clear_to_m_ > 0.0 ? clear_to_m_ : 1.0, none, after_s));
    }
  }
  packets_.push_back(std::move(sweep));
}

}  // namespace roverd::study
