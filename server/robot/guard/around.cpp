#include "robot/guard/around.hpp"

#include <cmath>
#include <utility>
#include <variant>

#include "base/angle.hpp"
#include "robot/safety/fence_guard.hpp"

namespace roverd::robot {
namespace {

using nav::around::Question;
using nav::around::Ring;

constexpr int kCircleCorners = 64;

nav::sense::Vec2 in_odometry(const AroundQuestion& asked, base::LatLon at) {
  const base::EnuPoint p = asked.frame.to_local(at);
  const auto o = to_odometry(asked.local, p, 0.0);
  return {o.x_m, o.y_m};
}

/// Inside of the circle where it keeps in, outside where it keeps out: always to the safe side.
Ring ring_of(const AroundQuestion& asked, const mission::FenceArea& area) {
  Ring out;
  if (const auto* polygon = std::get_if<mission::FencePolygon>(&area.shape)) {
    for (const base::LatLon& at : polygon->points) out.push_back(in_odometry(asked, at));
    return out;
  }
  const auto& circle = std::get<mission::FenceCircle>(area.shape);
  const nav::sense::Vec2 mid = in_odometry(asked, circle.center);
  const bool out_of = area.kind == mission::AreaKind::Exclusion;
  const double r_m =
      out_of ? circle.radius_m / std::cos(base::kPi / kCircleCorners) : circle.radius_m;
  for (int i = 0; i < kCircleCorners; ++i) {
    const double a = 2.0 * base::kPi * i / kCircleCorners;
    out.push_back({mid.x + r_m * std::cos(a), mid.y + r_m * std::sin(a)});
  }
  return out;
}

}  // namespace

nav::sense::Pose2 to_odometry(const nav::sense::Pose2& local, base::EnuPoint at,
                              double yaw_rad) noexcept {
  return local * nav::sense::Pose2{at.east_m, at.north_m, yaw_rad};
}

std::shared_ptr<const AroundAnswer> answer_around(nav::around::Planner& planner,
                                                  std::shared_ptr<const AroundQuestion> asked) {
  auto out = std::make_shared<AroundAnswer>();
  Question q = asked->question;
  if (asked->fence && asked->fence->fence) {
    for (const mission::FenceArea& area : asked->fence->fence->areas) {
      const bool in = area.kind == mission::AreaKind::Inclusion;
      (in ? q.keep_in : q.keep_out).push_back(ring_of(*asked, area));
    }
  }
  if (auto ok = planner.plan(asked->around->patch, q, out->found); !ok) {
    out->refused = ok.error().detail;
  }
  // What is large goes here, and not where the answer is let go.
  auto kept = std::make_shared<AroundQuestion>(*asked);
  kept->around.reset();
  kept->fence.reset();
  out->asked = std::move(kept);
  return out;
}

}  // namespace roverd::robot
