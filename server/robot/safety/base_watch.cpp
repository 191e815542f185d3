#include "robot/safety/base_watch.hpp"

#include <algorithm>

namespace roverd::robot {

base::BodyTwist possible(const base::BodyTwist& told, const Config& config) noexcept {
  const double v = config.vehicle.max_speed_mps;
  const double w = config.vehicle.steered() ? 0.0 : config.speed.max_yaw_rate_radps;
  return {std::clamp(told.linear_mps, -v, v), std::clamp(told.angular_radps, -w, w)};
}

BaseWatch::News BaseWatch::step(const Facts& f, Time now) noexcept {
  News news;
  const bool listens = base_listens(f.world);
  const bool waits = f.armed && !f.radio && !listens;
  if (!waits) waited_since_.reset();
  if (waits && !waited_since_) waited_since_ = now;

  const bool in_charge = f.armed && f.sent.enabled && !f.radio;
  if (!in_charge) in_charge_since_.reset();
  if (in_charge && !in_charge_since_) in_charge_since_ = now;
  const bool settled = in_charge_since_ && now - *in_charge_since_ > kSettled;
  const bool well = f.world.base && f.world.base->vehicle_state == base::VehicleState::Normal;
  left_ = settled && listened_ && !listens && well;
  news.left = left_;
  if (left_) gone_ = true;
  news.back = gone_ && listens;
  if (listens || !f.armed) gone_ = false;
  if (settled && listens && !listened_) obedience_.heard();
  listened_ = listens;

  const bool was_lost = obedience_.lost();
  std::optional<base::BodyTwist> does;
  const bool told = f.world.motion && !f.world.motion->assumed &&
                    base::seconds(now - f.world.motion->stamp) <= f.params.base_timeout_s;
  if (told) does = f.world.motion->twist;
  obedience_.step(in_charge ? f.possible : base::BodyTwist{}, does, now, f.params.follow_timeout_s);
  news.disobeys = !was_lost && obedience_.lost();
  news.obeys = was_lost && !obedience_.lost();
  return news;
}

}  // namespace roverd::robot
