#include "nav/chart/scan.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "nav/chart/carrier.hpp"
#include "nav/sense/mount.hpp"

namespace roverd::nav::chart {

namespace {

using base::Echo;
using sense::Pose2;

}  // namespace

std::optional<Scan> scan_of(const base::Sight& sight, const base::Mount& mount,
                            const sense::PoseHistory& odometry, const ScanParams& p) {
  if (!sight.good || sight.points.empty() || p.most == 0) return std::nullopt;
  const double end_s = last_s(sight);
  Scan scan;
  scan.stamp = sight.stamp + base::from_seconds(end_s);
  const auto reference = odometry.at(scan.stamp);
  if (!reference) return std::nullopt;
  Carrier carrier(odometry, sight.stamp, *reference);
  scan.eye_x_m = static_cast<float>(mount.x_m);
  scan.eye_y_m = static_cast<float>(mount.y_m);
  const Eigen::Matrix3d turned = sense::rotation(mount);
  const std::size_t step = (sight.points.size() + p.most - 1) / p.most;
  scan.beams.reserve(sight.points.size() / step + 1);
  for (std::size_t i = 0; i < sight.points.size(); i += step) {
    const base::SightPoint& s = sight.points[i];
    if (s.echo == Echo::Unknown) continue;
    const Eigen::Vector3d in_sensor(s.x_m, s.y_m, s.z_m);
    const double range = in_sensor.norm();
    if (!(range >= p.nearest_m && std::isfinite(range))) continue;
    const bool near = range <= p.farthest_m;
    const Eigen::Vector3d in_body =
        turned * (near ? in_sensor : in_sensor * (p.farthest_m / range));
    const double height = in_body.z() + mount.z_m;
    if (!(height >= p.lowest_m && height <= p.highest_m)) continue;
    if (!(s.after_s >= 0.0F && s.after_s <= end_s)) continue;
    const auto then = carrier.at(s.after_s);
    if (!then) continue;
    const Pose2 at = *then * Pose2{in_body.x() + mount.x_m, in_body.y() + mount.y_m, 0.0};
    scan.beams.push_back(
        {static_cast<float>(at.x_m), static_cast<float>(at.y_m), s.echo == Echo::Hit && near});
  }
  if (scan.beams.empty()) return std::nullopt;
  return scan;
}

}  // namespace roverd::nav::chart
