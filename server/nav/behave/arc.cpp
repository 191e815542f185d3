// A turn that has a radius: forwards, from where the robot is and points.

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/angle.hpp"
#include "nav/behave/executor.hpp"
#include "nav/track/corner.hpp"

namespace roverd::nav {
namespace {

constexpr double kArcPiece_rad = base::kPi / 12.0;
constexpr double kLeastArc_rad = 1e-3;                    // 0 stands for all of it
constexpr double kBraked_rad = base::kPi / 9.0;           // of an arc, at most, as it brakes
constexpr double kEitherWay_rad = 5.0 * base::kPi / 6.0;  // more than this is as far either way

/// From `from` on, by so much. A vehicle that can turns the last bit on the spot.
std::vector<Vertex> arc_of(const Vehicle& from, double by_rad, double radius_m, double speed_mps,
                           bool faces) {
  const double side = by_rad > 0.0 ? 1.0 : -1.0;
  const double out_rad = from.yaw_rad - side * base::kPi / 2.0;  // from its centre to the robot
  const EnuPoint centre{from.at.east_m - radius_m * std::cos(out_rad),
                        from.at.north_m - radius_m * std::sin(out_rad)};
  const int pieces = std::max(1, static_cast<int>(std::ceil(std::abs(by_rad) / kArcPiece_rad)));
  std::vector<Vertex> way;
  way.reserve(static_cast<std::size_t>(pieces) + 1);
  Vertex v;
  v.at = from.at;
  v.speed_mps = speed_mps;
  way.push_back(v);
  v.curvature_1pm = side / radius_m;
  for (int i = 1; i <= pieces; ++i) {
    const double at_rad = out_rad + by_rad * i / pieces;
    v.at = {centre.east_m + radius_m * std::cos(at_rad),
            centre.north_m + radius_m * std::sin(at_rad)};
    v.tangent = i < pieces;
    way.push_back(v);
  }
  if (faces) way.back().yaw_rad = base::wrap_rad(from.yaw_rad + by_rad);
  return way;
}

/// To a heading: from as it points now, whatever was left when it was interrupted, since somebody
/// may have turned it by hand. Only the hand stays where the heading is about behind it.
double arc_to_rad(double from_rad, double to_rad, double left_rad) noexcept {
  const double by_rad = base::angle_diff_rad(from_rad, to_rad);
  const bool other_hand = by_rad * left_rad < 0.0 && std::abs(by_rad) > kEitherWay_rad;
  return other_hand ? by_rad + std::copysign(2.0 * base::kPi, left_rad) : by_rad;
}

/// What is left of it, of which the robot drove some as it braked. More, or back, it was turned by
/// somebody: the rest is driven from there.
double braked_rad(double left_rad, double turned_rad) noexcept {
  if (turned_rad * left_rad <= 0.0 || std::abs(turned_rad) > kBraked_rad) return left_rad;
  return std::copysign(std::max(kLeastArc_rad, std::abs(left_rad) - std::abs(turned_rad)),
                       left_rad);
}

}  // namespace

bool Executor::enter_arc(const RouteStep& step, const Vehicle& vehicle) {
  if (arc_yaw_rad_) left_ = braked_rad(left_, base::angle_diff_rad(*arc_yaw_rad_, vehicle.yaw_rad));
  arc_yaw_rad_.reset();
  const double rest_rad = left_ != 0.0 ? left_ : step.by;
  arc_rad_ = step.yaw_rad ? arc_to_rad(vehicle.yaw_rad, *step.yaw_rad, left_) : rest_rad;
  left_ = 0.0;
  standing_.reset();
  const std::vector<Vertex> way = arc_of(vehicle, arc_rad_, step.radius_m, modes_->move_mps,
                                         turning_on_the_spot(path_params_->vehicle));
  connector_end_ = way.back();
  connector_ = build_path(way, *path_params_);
  rejoin_.reset();
  if (connector_.legs.empty()) {
    reached(step);
    return doing_ != Doing::Nothing;
  }
  doing_ = Doing::Arc;
  drove_ = true;
  tracker_.begin(connector_, 0, 0.0);
  return true;
}

/// By the way that is driven of it; of one that waits, and was driven on as it braked, by how it
/// points now.
double Executor::arc_left_rad(std::optional<double> yaw_rad) const noexcept {
  if (tracker_.path() != &connector_) {
    return arc_yaw_rad_ && yaw_rad
               ? braked_rad(arc_rad_, base::angle_diff_rad(*arc_yaw_rad_, *yaw_rad))
               : arc_rad_;
  }
  const double share = 1.0 - tracker_.s_m() / connector_.length_m();
  return std::copysign(std::max(kLeastArc_rad, std::abs(arc_rad_) * share), arc_rad_);
}

}  // namespace roverd::nav
