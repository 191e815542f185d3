// Which questions are none.
#include "nav/around/check.hpp"

#include <cmath>
#include <string>

namespace roverd::nav::around {

namespace {

using base::Code;
using base::Result;

constexpr std::size_t kRoute = 4000;
constexpr std::size_t kFence = 10'000;
constexpr double kFarthest_m = 1e6;

Result<void> refuse(const char* pointer, std::string detail, Code code = Code::Invalid) {
  return base::fail(code, "the question is none", {{pointer, std::move(detail)}});
}

bool finite(const Vec2& p) noexcept {
  return std::abs(p.x) <= kFarthest_m && std::abs(p.y) <= kFarthest_m;  // false for NaN
}

Result<void> check_rings(const std::vector<Ring>& rings, const char* pointer,
                         std::size_t& corners) {
  for (const Ring& r : rings) {
    if (r.size() < 3) return refuse(pointer, "an area has three corners at least");
    corners += r.size();
    if (corners > kFence) return refuse(pointer, "more than 10,000 corners", Code::TooLarge);
    for (const Vec2& p : r) {
      if (!finite(p)) return refuse(pointer, "a corner is not finite");
    }
  }
  return {};
}

Result<void> check_patch(const sense::Patch& patch, const Question& q) {
  if (!(patch.cell_m >= 0.02 && patch.cell_m <= 0.2)) {
    return refuse("/patch/cell_m", "0.02 to 0.2 m");
  }
  if (patch.side < 16 || patch.side > 1024) return refuse("/patch/side", "16 to 1024 cells");
  const auto side = static_cast<std::size_t>(patch.side);
  if (patch.cells.size() != side * side) return refuse("/patch/cells", "a square of side x side");
  const double x = q.pose.x_m / patch.cell_m - patch.x0;
  const double y = q.pose.y_m / patch.cell_m - patch.y0;
  if (!(x >= 0.0 && y >= 0.0 && x < patch.side && y < patch.side)) {
    return refuse("/pose", "outside of the patch");
  }
  return {};
}

}  // namespace

Result<void> check(const sense::Patch& patch, const Question& q) {
  const auto within = [](double v, double low, double high) { return v >= low && v <= high; };
  if (!finite({q.pose.x_m, q.pose.y_m}) || !std::isfinite(q.pose.yaw_rad)) {
    return refuse("/pose", "not finite");
  }
  if (auto r = check_patch(patch, q); !r) return r;
  if (!within(q.kinematics.min_radius_m, 0.0, 50.0)) {
    return refuse("/kinematics/min_radius_m", "0 to 50 m");
  }
  if (!q.kinematics.pivots && q.kinematics.min_radius_m < 0.1) {
    return refuse("/kinematics/min_radius_m", "0.1 m at least for what does not pivot");
  }
  if (q.route.size() > kRoute) return refuse("/route", "more than 4,000 points", Code::TooLarge);
  for (const Vec2& p : q.route) {
    if (!finite(p)) return refuse("/route", "a point is not finite");
  }
  if (!within(q.here_m, 0.0, 1e6)) return refuse("/here_m", "0 or more");
  if (!within(q.left_m, 0.1, 1000.0)) return refuse("/left_m", "0.1 to 1,000 m");
  if (!within(q.right_m, 0.1, 1000.0)) return refuse("/right_m", "0.1 to 1,000 m");
  if (!within(q.fence_margin_m, 0.0, 2.0)) return refuse("/fence_margin_m", "0 to 2 m");
  if (!within(q.least_m, 0.02, 1.0)) return refuse("/least_m", "0.02 to 1 m");
  if (!within(q.wanted_m, q.least_m, 2.0)) return refuse("/wanted_m", "least_m to 2 m");
  if (!within(q.unknown_cost, 1.0, 10.0)) return refuse("/unknown_cost", "1 to 10");
  if (!within(q.rejoin_within_m, 0.5, 50.0)) return refuse("/rejoin_within_m", "0.5 to 50 m");
  std::size_t corners = 0;
  if (auto r = check_rings(q.keep_in, "/keep_in", corners); !r) return r;
  return check_rings(q.keep_out, "/keep_out", corners);
}

}  // namespace roverd::nav::around
