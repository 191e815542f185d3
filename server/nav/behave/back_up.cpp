// A stop that was overshot.

#include <cmath>

#include "base/angle.hpp"
#include "nav/behave/executor.hpp"
#include "nav/track/corner.hpp"
#include "nav/track/rules.hpp"

namespace roverd::nav {
namespace {

constexpr double kBackUp_m = 3.0;     // a stop that was overshot by more is not backed up to
constexpr double kBesideWay_m = 0.3;  // nor one beside which it stands
constexpr double kBesideCar_m = 0.1;  // a car cannot come back to its way on so little of it
const double kAskewCar_rad = base::rad_from_deg(10.0);

}  // namespace

/// Brakes that were worse than known carried it beyond the stop, along its way: it backs up to it,
/// once, and knows better the next time.
bool Executor::back_up(const Vehicle& vehicle, double off_m) {
  const Path& path = *tracker_.path();
  const Leg& leg = path.legs[tracker_.leg()];
  const EnuPoint stop = path.points[leg.last].at;
  const double way_rad = direction_rad(path.points[leg.last - 1].at, stop);
  const BodyPoint behind = to_body(vehicle.at, stop, way_rad);
  const bool car = path_params_->vehicle.steered();
  const double beside_m = car ? kBesideCar_m : kBesideWay_m;
  const bool beyond = behind.x_m > 0.0 && std::abs(behind.y_m) < beside_m;
  if (backed_up_ || !beyond || off_m > kBackUp_m) return false;
  const double faces = std::cos(vehicle.yaw_rad - direction_rad(vehicle.at, stop));
  const double askew = std::abs(std::cos(vehicle.yaw_rad - way_rad));
  if (car && askew < std::cos(kAskewCar_rad)) return false;
  standing_.reset();
  if (!lay_connector(
          {stop, path_params_->speed.creep_mps, faces < 0.0, false, mission::Turn::Auto, 0.1},
          vehicle)) {
    return false;
  }
  backed_up_ = true;
  return true;
}

}  // namespace roverd::nav
