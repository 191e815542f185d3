#include "sim/surroundings.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angle.hpp"

namespace roverd::sim {
namespace {

constexpr double kKept_s = 2.0;
/// Wheels or tracks stand so far inside the outline.
constexpr double kStands = 0.8;

world::Body body_of(const BodyParams& p) {
  return world::Body::rectangle(p.front_m, p.rear_m, p.width_m, p.height_m, p.clearance_m);
}

}  // namespace

Surroundings::Surroundings(world::World world, const BodyParams& body, Time start)
    : scene_(std::move(world)), witness_(body_of(body)), body_(body), start_(start) {}

void Surroundings::attend(Vehicle& vehicle) {
  vehicle.set_lie([this](base::EnuPoint at, double yaw_rad) { return lie(at, yaw_rad); });
  vehicle.on_step = [this, &vehicle] { follow(vehicle); };
}

void Surroundings::set_on(bool on) {
  on_ = on;
}

world::Pose Surroundings::stand(base::EnuPoint at, double yaw_rad) const {
  const double half_length_m = (body_.front_m + body_.rear_m) / 2.0;
  return scene_.terrain().stand({at.east_m, at.north_m}, yaw_rad, kStands * half_length_m,
                                kStands * body_.width_m / 2.0, body_.front_m - half_length_m);
}

Lie Surroundings::lie(base::EnuPoint at, double yaw_rad) const {
  const world::Pose pose = stand(at, yaw_rad);
  return {-std::tan(pose.pitch_rad), std::tan(pose.roll_rad) / std::cos(pose.pitch_rad), pose.z_m};
}

void Surroundings::follow(const Vehicle& vehicle) {
  const Stance s = vehicle.stance();
  now_s_ = base::seconds(s.time - start_);
  world::Pose pose = stand(s.at, s.yaw_rad);
  if (!on_) {
    pose.z_m = pose.roll_rad = pose.pitch_rad = 0.0;
  }
  trail_.push_back({now_s_, pose});
  while (trail_.front().at_s < now_s_ - kKept_s) trail_.pop_front();
  scene().move_to(moment_, now_s_);
  witness_.step(scene(), moment_, pose, s.speed_mps);
}

world::Pose Surroundings::pose_at(double at_s) const {
  if (trail_.empty()) return {};
  const auto after =
      std::ranges::lower_bound(trail_, at_s, {}, [](const Stood& s) { return s.at_s; });
  if (after == trail_.end()) return trail_.back().pose;
  if (after == trail_.begin()) return after->pose;
  const Stood& a = *std::prev(after);
  const Stood& b = *after;
  const double share = (at_s - a.at_s) / (b.at_s - a.at_s);
  world::Pose out;
  out.x_m = std::lerp(a.pose.x_m, b.pose.x_m, share);
  out.y_m = std::lerp(a.pose.y_m, b.pose.y_m, share);
  out.z_m = std::lerp(a.pose.z_m, b.pose.z_m, share);
  out.roll_rad = std::lerp(a.pose.roll_rad, b.pose.roll_rad, share);
  out.pitch_rad = std::lerp(a.pose.pitch_rad, b.pose.pitch_rad, share);
  out.yaw_rad = a.pose.yaw_rad + share * base::angle_diff_rad(a.pose.yaw_rad, b.pose.yaw_rad);
  return out;
}

}  // namespace roverd::sim
