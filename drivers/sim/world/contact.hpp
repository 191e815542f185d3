#pragma once
// The truth about touching: what a body standing at a pose touches, and how much room it has. Exact
// in plan; heights are those over the plane that the body stands on. Pure.

#include <string>
#include <vector>

#include "sim/world/scene.hpp"

namespace roverd::sim::world {

struct Body {
  std::vector<Vec2> outline;  ///< in plan, x forward, y left, about the body's origin
  double height_m = 0.5;      ///< what is higher passes over it
  double clearance_m = 0.05;  ///< what is lower passes under it

  /// front_m, rear_m: from the origin forwards and backwards, positive.
  static Body rectangle(double front_m, double rear_m, double width_m, double height_m,
                        double clearance_m);
};

struct Touch {
  int thing = kNothing;  ///< number in World::things; kGround: over the edge of a drop
  bool soft = false;     ///< leaves only
  bool moving = false;   ///< it moves by itself
};

struct Contact {
  std::vector<Touch> touches;  ///< each thing once, hard before soft
  /// To the nearest solid or edge that the body could touch; 0 while it touches. At most the reach.
  double clearance_m = 0.0;
  int nearest = kNothing;
  /// Where the nearest lies from the body's origin, roughly: bearing of its middle, left positive.
  double bearing_rad = 0.0;
  bool hard() const noexcept { return !touches.empty() && !touches.front().soft; }
};

/// @param pose of the body's origin, as Terrain::stand tells it. @param moment of that time.
/// @param reach_m how far to look for what is near.
Contact contact(const Scene& scene, const Moment& moment, const Pose& pose, const Body& body,
                double reach_m = 3.0);

/// To one thing, as clearance_m, its leaves as well. At most reach_m.
double room_m(const Scene& scene, const Moment& moment, const Pose& pose, const Body& body,
              int thing, double reach_m);

/// Follows a drive and counts. A thing counts again once it was left by 5 cm.
class Witness {
 public:
  explicit Witness(Body body) : body_(std::move(body)) {}

  struct Seen {
    double at_s = 0.0;
    int thing = kNothing;
    bool soft = false;
    bool moving = false;
    double speed_mps = 0.0;  ///< of the body, signed
    Vec2 at;                 ///< of the body's origin
  };
  /// Once a step. @return contacts that began with it.
  std::vector<Seen> step(const Scene& scene, const Moment& moment, const Pose& pose,
                         double speed_mps);

  const Body& body() const noexcept { return body_; }
  std::size_t hard() const noexcept { return hard_; }
  std::size_t soft() const noexcept { return soft_; }
  const Contact& now() const noexcept { return now_; }
  double least_m() const noexcept { return least_m_; }  ///< smallest clearance so far
  /// The last ones, oldest first, at most kKept.
  const std::vector<Seen>& seen() const noexcept { return seen_; }
  void forget();  ///< begins anew

  static constexpr std::size_t kKept = 100;

 private:
  struct Held {
    int thing;
    bool soft;
  };
  Body body_;
  std::vector<Held> held_;
  std::vector<Seen> seen_;
  Contact now_;
  std::size_t hard_ = 0;
  std::size_t soft_ = 0;
  double least_m_ = 1e9;
};

}  // namespace roverd::sim::world
