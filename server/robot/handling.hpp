#pragma once
// What the tracker is told of the vehicle: what was set, and what was learned in its place.
//
//   parameters ──▶ ┌──────────┐
//   seen, sent ──▶ │ learner  │ ──▶ config.path, and of it the paths of walls and landmarks
//                  └──────────┘     (config.marks): what every tracker reads at its next step
//
// Ways that are laid out before they are driven keep to the parameters: only how they are driven
// follows what was learned. Two values that change places: nothing is allocated. Control thread.

#include <array>
#include <memory>
#include <utility>

#include "nav/estimate/learned.hpp"
#include "nav/identify/vehicle_learner.hpp"
#include "robot/parameter_set.hpp"

namespace roverd::robot {

class Handling {
 public:
  explicit Handling(const ParameterSet& set)
      : path_(set.path), wall_(*set.marks.wall_path), landmark_(*set.marks.landmark_path) {}

  /// Before deciding: what was learned until now holds from here on.
  void see(const nav::VehicleLearner::Seen& seen, const ParameterSet& set);
  /// After it.
  void sent(const base::BodyTwist& twist) noexcept { learner_.sent(twist, set_); }
  /// Armed: nobody knows what was loaded onto it meanwhile.
  void armed() noexcept { learner_.doubt_braking(); }
  void recall(const nav::Learned& known) noexcept;
  /// What a person says was measured takes the place of what was learned.
  void adopt(const nav::Learned& measured) noexcept;
  void forget() noexcept { learner_ = nav::VehicleLearner{}; }
  /// What is worth keeping, added.
  void tell(nav::Learned& known) const noexcept;

  base::VehicleLearned learned() const noexcept;
  /// What was learned of braking, where it is less than `decel_mps2`.
  double braking_mps2(double decel_mps2) const noexcept;

 private:
  /// A setting whose two values change places.
  class Turns {
   public:
    explicit Turns(base::Setting<nav::PathParams> to)
        : to_(std::move(to)),
          held_{std::make_shared<nav::PathParams>(*to_), std::make_shared<nav::PathParams>(*to_)} {}
    const nav::PathParams& used() const noexcept { return *to_; }
    const nav::PathParams& now() const noexcept { return *held_[1]; }
    nav::PathParams& next() noexcept { return *held_[0]; }
    void take() noexcept {
      to_.adopt(held_[0]);
      std::swap(held_[0], held_[1]);
    }

   private:
    base::Setting<nav::PathParams> to_;
    std::array<std::shared_ptr<nav::PathParams>, 2> held_;
  };

  nav::VehicleLearner learner_;
  Turns path_;
  Turns wall_;
  Turns landmark_;
  nav::PathParams set_;
  const void* from_ = nullptr;  ///< the set of parameters that set_ is of
};

}  // namespace roverd::robot
