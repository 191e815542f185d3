#include "nav/behave/mark_sight.hpp"

#include <algorithm>
#include <cmath>

namespace roverd::nav {
namespace {

constexpr double kStraightBehind_m = 0.5;  // the way to look along begins so far behind the robot
constexpr double kSeenSigma_rad = 0.02;

}  // namespace

std::optional<marks::By> by_of(std::optional<mission::SightSource> source) noexcept {
  if (!source) return std::nullopt;
  return *source == mission::SightSource::Scan     ? marks::By::Scan
         : *source == mission::SightSource::Vision ? marks::By::Vision
                                                   : marks::By::Auto;
}

Vehicle by_odometry(const marks::Pose2& body, const Vehicle& vehicle) noexcept {
  Vehicle v = vehicle;
  v.at = {body.x_m, body.y_m};
  v.yaw_rad = body.yaw_rad;
  v.yaw_sigma_rad = std::min(v.yaw_sigma_rad, kSeenSigma_rad);
  v.slide = {};
  v.crab = 0.0;
  return v;
}

PathParams by_sight(PathParams path, const marks::SteerGains& gains, const SightParams& sight) {
  TrackParams& t = path.track;
  // The laws know lengths: path_frame steers by 1/L² for an offset and by 2·damping/L for a
  // direction, pure_pursuit by 2/L².
  const double shorter = std::sqrt(gains.offset);
  t.settle_min_m /= shorter;
  t.settle_time_s /= shorter;
  t.damping *= gains.heading / shorter;
  t.lookahead_min_m /= shorter;
  t.lookahead_time_s /= shorter;
  t.lookahead_max_m /= shorter;
  t.stanley_gain_1ps *= gains.offset;
  path.speed.max_yaw_rate_radps = std::min(path.speed.max_yaw_rate_radps, sight.max_yaw_rate_radps);
  return path;
}

marks::Way straight_on(const marks::Pose2& body, double ahead_m, double speed_mps) {
  marks::Way way;
  for (const double at_m : {-kStraightBehind_m, ahead_m}) {
    const marks::Vec2 at = marks::placed(body, {at_m, 0.0});
    Vertex v;
    v.at = {at.x, at.y};
    v.speed_mps = speed_mps;
    way.vertices.push_back(v);
  }
  way.here_m = kStraightBehind_m;
  return way;
}

}  // namespace roverd::nav
