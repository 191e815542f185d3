#pragma once
// The world around a vehicle, and the truth about both: what the body stands on, what it touches,
// and where it was while a sensor looked. Pure: no clock, no socket.

#include <deque>
#include <string>
#include <string_view>

#include "sim/vehicle.hpp"
#include "sim/world/contact.hpp"
#include "sim/world/scene.hpp"
#include "sim/world/sensor.hpp"

namespace roverd::sim {

class Surroundings {
 public:
  /// @param start when the world's time begins.
  Surroundings(world::World world, const BodyParams& body, Time start);

  /// Lets the vehicle feel the ground, and follows it from now on: call once. Both must live as
  /// long as the vehicle runs.
  void attend(Vehicle& vehicle);

  /// Off: level ground and nothing on it, for eyes and for touches alike; the vehicle keeps its
  /// footing, so that it does not fall.
  void set_on(bool on);
  bool on() const noexcept { return on_; }
  /// A person or an animal of that name.
  bool has_mover(std::string_view name) const { return scene_.mover(name).has_value(); }
  /// Whoever is called so begins the path now, from its first point.
  void let_walk(std::string_view name) { scene_.begin_walk(name, now_s_); }

  const world::Scene& scene() const noexcept { return on_ ? scene_ : nothing_; }
  const world::Witness& witness() const noexcept { return witness_; }
  void forget_contacts() { witness_.forget(); }
  /// World's time, seconds since its start.
  double now_s() const noexcept { return now_s_; }

  /// Where the body was, between its steps; before and after what is kept (2 s): the end of it.
  world::Pose pose_at(double at_s) const;

  /// How the ground lies under the vehicle there.
  Lie lie(base::EnuPoint at, double yaw_rad) const;

 private:
  struct Stood {
    double at_s;
    world::Pose pose;
  };
  void follow(const Vehicle& vehicle);
  world::Pose stand(base::EnuPoint at, double yaw_rad) const;

  world::Scene scene_;
  world::Scene nothing_;
  world::Moment moment_;
  world::Witness witness_;
  const BodyParams body_;
  const Time start_;
  std::deque<Stood> trail_;
  double now_s_ = 0.0;
  bool on_ = true;
};

}  // namespace roverd::sim
