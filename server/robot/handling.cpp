#include "robot/handling.hpp"

#include <algorithm>

namespace roverd::robot {

void Handling::see(const nav::VehicleLearner::Seen& seen, const ParameterSet& set) {
  learner_.see(seen);
  const bool changed = from_ != set.whole().get();
  if (changed) {
    from_ = set.whole().get();
    set_ = set->path();
  }
  nav::PathParams& next = path_.next();
  next = changed ? set_ : path_.now();
  if (!learner_.handle(set_, next) && !changed) return;
  wall_.next() = nav::by_sight(next, set->wall.gains, set->sight);
  landmark_.next() = nav::by_sight(next, set->landmarks.gains, set->sight);
  for (Turns* each : {&path_, &wall_, &landmark_}) each->take();
}

void Handling::recall(const nav::Learned& known) noexcept {
  const auto number = [](const std::optional<nav::LearnedValue>& v) {
    return v ? std::optional(base::LearnedNumber{v->value, v->sigma}) : std::nullopt;
  };
  base::VehicleLearned out;
  out.delay_s = number(known.delay_s);
  out.braking_mps2 = number(known.braking_mps2);
  out.acceleration_mps2 = number(known.acceleration_mps2);
  learner_.recall(out);
}

void Handling::adopt(const nav::Learned& measured) noexcept {
  const base::VehicleLearned before = learner_.learned(set_);
  nav::Learned all = measured;
  const auto keep = [](std::optional<nav::LearnedValue>& to,
                       const std::optional<base::LearnedNumber>& known) {
    if (!to && known) to = nav::LearnedValue{known->value, known->sigma};
  };
  keep(all.delay_s, before.delay_s);
  keep(all.braking_mps2, before.braking_mps2);
  keep(all.acceleration_mps2, before.acceleration_mps2);
  learner_ = nav::VehicleLearner{};
  recall(all);
}

void Handling::tell(nav::Learned& known) const noexcept {
  const auto value = [](const std::optional<base::LearnedNumber>& n) {
    return n ? std::optional(nav::LearnedValue{n->value, n->sigma}) : std::nullopt;
  };
  const base::VehicleLearned fresh = learner_.learned_now(set_);
  known.delay_s = value(fresh.delay_s);
  known.braking_mps2 = value(fresh.braking_mps2);
  known.acceleration_mps2 = value(fresh.acceleration_mps2);
}

base::VehicleLearned Handling::learned() const noexcept {
  base::VehicleLearned out = learner_.learned(set_);
  const nav::PathParams& used = path_.used();
  out.delay_used_s = used.track.delay_s;
  out.braking_used_mps2 = used.speed.decel_mps2;
  out.acceleration_used_mps2 = used.speed.accel_mps2;
  out.braking_proved = !used.prove_braking;
  return out;
}

double Handling::braking_mps2(double decel_mps2) const noexcept {
  const auto limit = learner_.braking_limit_mps2();
  return limit ? std::min(decel_mps2, std::max(0.05, 0.9 * *limit)) : decel_mps2;
}

}  // namespace roverd::robot
