#include "sim/world/contact.hpp"

#include <algorithm>
#include <numbers>

namespace roverd::sim::world {
namespace {

constexpr double kLeft_m = 0.05;  ///< a contact is over when there is so much room

/// The body's outline in E.
std::vector<Vec2> placed(const Body& body, const Pose& pose) {
  const double c = std::cos(pose.yaw_rad);
  const double s = std::sin(pose.yaw_rad);
  std::vector<Vec2> out;
  out.reserve(body.outline.size());
  for (const Vec2 p : body.outline) {
    out.push_back({pose.x_m + c * p.x - s * p.y, pose.y_m + s * p.x + c * p.y});
  }
  return out;
}

/// Height of the plane that the body stands on, elsewhere.
double plane_m(const Pose& pose, Vec2 at) {
  const double c = std::cos(pose.yaw_rad);
  const double s = std::sin(pose.yaw_rad);
  const Vec2 off{at.x - pose.x_m, at.y - pose.y_m};
  const double forward = c * off.x + s * off.y;
  const double left = -s * off.x + c * off.y;
  return pose.z_m - std::tan(pose.pitch_rad) * forward +
         std::tan(pose.roll_rad) / std::cos(pose.pitch_rad) * left;
}

class Finder {
 public:
  enum class Leaves { Give, Count };
  Finder(const Pose& pose, const Body& body, double reach_m, Leaves leaves = Leaves::Give)
      : pose_(pose), body_(body), leaves_(leaves), outline_(placed(body, pose)) {
    out_.clearance_m = reach_m;
  }

  double half_m() const noexcept {
    double far = 0.0;
    for (const Vec2 p : body_.outline) far = std::max(far, length(p));
    return far;
  }

  void see(const Shape& shape) {
    const Vec2 at{shape.x, shape.y};
    const double plane = plane_m(pose_, at);
    const Section section = section_of(shape, plane + body_.clearance_m, plane + body_.height_m);
    if (!section.any) return;
    const double off_m = length(at - Vec2{pose_.x_m, pose_.y_m}) - shape.reach_m() - half_m_;
    if (off_m > out_.clearance_m) return;
    const bool soft = shape.density_pm > 0.0F;
    const double room_m = distance_m(outline_, section);
    if (room_m <= 0.0) touch({static_cast<int>(shape.thing), soft, shape.moving});
    if (!soft || leaves_ == Leaves::Count) nearer(room_m, static_cast<int>(shape.thing), at);
  }

  void see(const Drop& drop) {
    const double room_m = distance_m(outline_, drop.points);
    if (room_m <= 0.0) touch({kGround, false, false});
    nearer(room_m, kGround, drop.points.front());
  }

  Contact result() {
    std::ranges::stable_sort(out_.touches, {}, [](const Touch& t) { return t.soft; });
    return std::move(out_);
  }

 private:
  void nearer(double room_m, int thing, Vec2 at) {
    if (room_m >= out_.clearance_m) return;
    out_.clearance_m = std::max(0.0, room_m);
    out_.nearest = thing;
    const double bearing = std::atan2(at.y - pose_.y_m, at.x - pose_.x_m) - pose_.yaw_rad;
    out_.bearing_rad = std::remainder(bearing, 2.0 * std::numbers::pi);
  }
  void touch(const Touch& one) {
    for (Touch& t : out_.touches) {
      if (t.thing != one.thing) continue;
      t.soft = t.soft && one.soft;
      return;
    }
    out_.touches.push_back(one);
  }

  const Pose& pose_;
  const Body& body_;
  const Leaves leaves_;
  const std::vector<Vec2> outline_;
  const double half_m_ = half_m();
  Contact out_;
};

}  // namespace

Body Body::rectangle(double front_m, double rear_m, double width_m, double height_m,
                     double clearance_m) {
  const double half = width_m / 2.0;
  return {{{front_m, half}, {-rear_m, half}, {-rear_m, -half}, {front_m, -half}},
          height_m,
          clearance_m};
}

Contact contact(const Scene& scene, const Moment& moment, const Pose& pose, const Body& body,
                double reach_m) {
  Finder finder(pose, body, reach_m);
  scene.near({pose.x_m, pose.y_m}, finder.half_m() + reach_m, moment,
             [&](const Shape& shape) { finder.see(shape); });
  for (const Drop& drop : scene.terrain().drops()) finder.see(drop);
  return finder.result();
}

double room_m(const Scene& scene, const Moment& moment, const Pose& pose, const Body& body,
              int thing, double reach_m) {
  Finder finder(pose, body, reach_m, Finder::Leaves::Count);
  scene.near({pose.x_m, pose.y_m}, finder.half_m() + reach_m, moment, [&](const Shape& shape) {
    if (static_cast<int>(shape.thing) == thing) finder.see(shape);
  });
  return finder.result().clearance_m;
}

std::vector<Witness::Seen> Witness::step(const Scene& scene, const Moment& moment, const Pose& pose,
                                         double speed_mps) {
  now_ = contact(scene, moment, pose, body_);
  least_m_ = std::min(least_m_, now_.clearance_m);
  std::vector<Seen> begun;
  for (const Touch& t : now_.touches) {
    const auto known = std::ranges::find(held_, t.thing, &Held::thing);
    if (known != held_.end() && (t.soft || !known->soft)) continue;
    if (known != held_.end()) {
      known->soft = false;  // first its leaves, now its stem
    } else {
      held_.push_back({t.thing, t.soft});
    }
    ++(t.soft ? soft_ : hard_);
    begun.push_back({moment.at_s, t.thing, t.soft, t.moving, speed_mps, {pose.x_m, pose.y_m}});
  }
  if (!held_.empty()) {
    Body wider = body_;
    for (Vec2& p : wider.outline) {
      p = {p.x + (p.x < 0.0 ? -kLeft_m : kLeft_m), p.y + (p.y < 0.0 ? -kLeft_m : kLeft_m)};
    }
    const Contact around = contact(scene, moment, pose, wider, kLeft_m);
    std::erase_if(held_, [&](const Held& h) {
      return std::ranges::find(around.touches, h.thing, &Touch::thing) == around.touches.end();
    });
  }
  seen_.insert(seen_.end(), begun.begin(), begun.end());
  if (seen_.size() > kKept) seen_.erase(seen_.begin(), seen_.end() - kKept);
  return begun;
}

void Witness::forget() {
  held_.clear();
  seen_.clear();
  now_ = {};
  hard_ = soft_ = 0;
  least_m_ = 1e9;
}

}  // namespace roverd::sim::world
