#include "robot/guard/around.hpp"

#include <cmath>
#include <utility>
#include <variant>
#include <vector>

#include "base/angle.hpp"
#include "robot/safety/fence_guard.hpp"

namespace roverd::robot {
namespace {

using nav::around::Question;
using nav::around::Ring;

constexpr int kCircleCorners = 64;
constexpr double kHolds_m = 0.09;  // what the guard leaves beside it, and a cell's roundness
constexpr double kHere_m = 0.3;
constexpr double kEdge_m = 0.1;

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

/// Nothing has come to be seen on it. Where the robot stands now it cannot be helped.
bool holds(const nav::sense::Patch& patch, const Question& q) {
  if (q.before.empty()) return false;
  std::vector<float> room_m;
  nav::sense::clearance(patch, false, 0.5F, room_m);
  const auto corners = q.body.corners();
  const auto clear = [&](nav::sense::Vec2 p) {
    const auto x = static_cast<std::int32_t>(std::floor(p.x / patch.cell_m)) - patch.x0;
    const auto y = static_cast<std::int32_t>(std::floor(p.y / patch.cell_m)) - patch.y0;
    if (x < 0 || y < 0 || x >= patch.side || y >= patch.side) return false;
    return static_cast<double>(room_m[static_cast<std::size_t>(y * patch.side + x)]) >= kHolds_m;
  };
  for (const nav::around::Place& place : q.before) {
    if (std::hypot(place.pose.x_m - q.pose.x_m, place.pose.y_m - q.pose.y_m) < kHere_m) continue;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const nav::sense::Vec2 a = corners[i];
      const nav::sense::Vec2 along = corners[(i + 1) % corners.size()] - a;
      const int pieces = static_cast<int>(std::sqrt(dot(along, along)) / kEdge_m) + 1;
      for (int k = 0; k < pieces; ++k) {
        const nav::sense::Vec2 p = a + (double(k) / pieces) * along;
        const auto at = place.pose * nav::sense::Pose2{p.x, p.y, 0.0};
        if (!clear({at.x_m, at.y_m})) return false;
      }
    }
  }
  return true;
}

/// Who moves is waited for: ways are laid as if he were not there.
nav::sense::Patch without_movers(const Surroundings& around) {
  // No more than that: a wall beside him stands when he is gone.
  nav::sense::Patch out = around.patch;
  for (const nav::sense::Mover& m : around.movers) {
    const nav::sense::Vec2 at = m.at + base::seconds(out.stamp - m.seen) * m.v_mps;
    for (std::size_t i = 0; i < out.cells.size(); ++i) {
      auto& cell = out.cells[i];
      if (cell.known != nav::sense::Known::Occupied) continue;
      const auto side = static_cast<std::size_t>(out.side);
      const double x = (out.x0 + static_cast<double>(i % side) + 0.5) * out.cell_m - at.x;
      const double y = (out.y0 + static_cast<double>(i / side) + 0.5) * out.cell_m - at.y;
      if (std::hypot(x, y) < m.radius_m + out.cell_m) cell.known = nav::sense::Known::Free;
    }
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
  nav::sense::Patch alone;
  if (!asked->around->movers.empty()) alone = without_movers(*asked->around);
  const nav::sense::Patch& patch = asked->around->movers.empty() ? asked->around->patch : alone;
  if (auto ok = planner.plan(patch, q, out->found); !ok) out->refused = ok.error().detail;
  out->before_holds = holds(patch, q);
  // What is large goes here, and not where the answer is let go.
  auto kept = std::make_shared<AroundQuestion>(*asked);
  kept->around.reset();
  kept->fence.reset();
  out->asked = std::move(kept);
  return out;
}

}  // namespace roverd::robot
