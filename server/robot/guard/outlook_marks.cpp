// What people are shown of landmarks, walls and of what cameras told.

#include <algorithm>
#include <cmath>

#include "nav/sense/mount.hpp"
#include "robot/guard/outlook.hpp"

namespace roverd::robot {
namespace {

using nav::marks::placed;
using nav::sense::Vec2;

/// A point of S in B.
Outlook::CameraSpot spot_of(const base::VisionPoint& p, const Image& image, double age_s) {
  const Eigen::Vector3d b =
      nav::sense::rotation(image.mount) * Eigen::Vector3d(p.x_m, p.y_m, p.z_m);
  return {image.seen->sensor, image.mount.x_m + b.x(), image.mount.y_m + b.y(),
          image.mount.z_m + b.z(), age_s};
}

void tell_image(Outlook& out, const Image& image) {
  const double age_s = base::seconds(out.stamp - image.seen->stamp);
  for (const base::VisionPoint& p : image.seen->obstacles) {
    if (out.spots.size() == Outlook::kMostSpots) break;
    out.spots.push_back(spot_of(p, image, age_s));
  }
  for (const base::VisionPlane& p : image.seen->planes) {
    if (out.planes.size() == Outlook::kMostPlanes) break;
    const Eigen::Vector3d n = nav::sense::rotation(image.mount) *
                              Eigen::Vector3d(p.normal.x_m, p.normal.y_m, p.normal.z_m);
    out.planes.push_back({spot_of(p.centre, image, age_s), n.x(), n.y(), n.z(), p.size});
  }
}

}  // namespace

void tell_marks(Outlook& out, const nav::marks::View* marks, const std::vector<Image>& images) {
  for (const Image& image : images) tell_image(out, image);
  if (marks == nullptr) return;
  const nav::sense::Pose2 bo = nav::sense::inverse({out.at.x_m, out.at.y_m, out.at.yaw_rad});
  for (const nav::marks::Landmark& l : marks->landmarks) {
    const Vec2 at = placed(bo, l.at);
    out.landmarks.push_back({l.id, l.name, at.x, at.y, l.sigma_m, l.radius_m, l.by_scan,
                             l.by_vision, l.believed, base::seconds(out.stamp - l.seen_at)});
  }
  std::ranges::sort(out.landmarks, {},
                    [](const Outlook::Mark& m) { return std::hypot(m.ahead_m, m.left_m); });
  for (const nav::marks::Wall& w : marks->walls) {
    if (w.seen.empty()) continue;
    const Vec2 from = placed(bo, w.at(w.seen.front().from_m));
    const Vec2 to = placed(bo, w.at(w.seen.back().to_m));
    out.walls.push_back({w.id, w.source == nav::marks::Source::Vision, w.believed,
                         std::abs(w.distance_m({out.at.x_m, out.at.y_m})), from.x, from.y, to.x,
                         to.y, w.sigma_m, base::seconds(out.stamp - w.seen_at)});
  }
}

}  // namespace roverd::robot
