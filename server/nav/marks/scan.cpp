#include "nav/marks/scan.hpp"

#include <cmath>

#include "nav/sense/mount.hpp"

namespace roverd::nav::marks {

Vec2 placed(const Pose2& ob, Vec2 p) noexcept {
  const double c = std::cos(ob.yaw_rad);
  const double s = std::sin(ob.yaw_rad);
  return {ob.x_m + c * p.x - s * p.y, ob.y_m + s * p.x + c * p.y};
}

base::Result<void> planar_of(const base::Sight& sight, const base::Mount& mount,
                             const sense::PoseHistory& history, double max_range_m, double band_m,
                             PlanarScan& out) {
  out.beams.clear();
  out.eye = {mount.x_m, mount.y_m};
  const double last_s = sight.points.empty() ? 0.0 : sight.points.back().after_s;
  out.stamp = sight.stamp + base::from_seconds(last_s);
  const auto last = history.at(out.stamp);
  if (!last || !history.at(sight.stamp)) {
    return base::fail(base::Code::Unavailable, "the odometry does not reach over the scan");
  }
  out.pose = *last;
  const Eigen::Matrix3d turn = sense::rotation(mount);
  const Pose2 back = sense::inverse(*last);
  out.beams.reserve(sight.points.size());
  for (const base::SightPoint& p : sight.points) {
    const Eigen::Vector3d s(p.x_m, p.y_m, p.z_m);
    if (!s.allFinite()) continue;
    const Eigen::Vector3d b = turn * s;
    if (std::abs(b.z()) > band_m) continue;
    const auto then = history.at(sight.stamp + base::from_seconds(p.after_s));
    if (!then) continue;
    Beam beam;
    beam.range_m = s.norm();
    beam.echo = p.echo == base::Echo::Hit && beam.range_m > 0.0;
    beam.hit = beam.echo && beam.range_m <= max_range_m;
    beam.at = placed(back * *then, {mount.x_m + b.x(), mount.y_m + b.y()});
    out.beams.push_back(beam);
  }
  return {};
}

}  // namespace roverd::nav::marks
