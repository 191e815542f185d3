// What no sensor has seen, on the way of a sweep.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "nav/sense/protect_parts.hpp"

namespace roverd::nav::sense {

namespace {

/// A piece of the outline that goes outwards, as looks at steps of a cell.
struct Front {
  Vec2 a;  ///< of its edge
  Vec2 e;
  int looks = 0;  ///< on the whole edge
  int first = 0;  ///< of this piece
  int last = 0;
  Vec2 middle{};
  double half_m = 0.0;
  int free_before = 0;  ///< no look of it meets the unknown before this step
};

constexpr int kPiece = 6;  // looks: as long as that, a piece is told free from afar
constexpr std::size_t kFronts = 64;

struct Fronts {
  std::array<Front, kFronts> of{};
  std::size_t size = 0;
};

void add_front(Fronts& out, Front f, int first, int last) noexcept {
  const auto at = [&f](int n) { return f.a + (static_cast<double>(n) / f.looks) * f.e; };
  f.first = first;
  f.last = last;
  const Vec2 along = at(last) - at(first);
  f.middle = 0.5 * (at(first) + at(last));
  f.half_m = 0.5 * std::hypot(along.x, along.y);
  out.of[out.size++] = f;
}

/// Only sides that go outwards, and of those what does (a turn). In the outline's order.
Fronts fronts_of(const Footprint& body, const Drive& d, double cell_m) noexcept {
  const auto corners = body.corners();
  double round_m = 0.0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec2 e = corners[k + 1 == corners.size() ? 0 : k + 1] - corners[k];
    round_m += std::hypot(e.x, e.y);
  }
  // With fewer pieces than there is room for, however large the body.
  const double room = static_cast<double>(kFronts - 2 * Footprint::kMaxCorners);
  const int piece = std::max(kPiece, static_cast<int>(round_m / cell_m / room) + 1);
  Fronts out;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    Front f;
    f.a = corners[k];
    f.e = corners[k + 1 == corners.size() ? 0 : k + 1] - f.a;
    const double length = std::hypot(f.e.x, f.e.y);
    const Vec2 normal{f.e.y / length, -f.e.x / length};
    f.looks = static_cast<int>(length / cell_m) + 1;
    // Along an edge the speed outwards changes evenly: what goes outwards is one stretch.
    int first = -1;
    int last = -1;
    for (int n = 0; n <= f.looks; ++n) {
      const Vec2 q = f.a + (static_cast<double>(n) / f.looks) * f.e;
      const Vec2 v{d.twist.linear_mps - d.twist.angular_radps * q.y, d.twist.angular_radps * q.x};
      if (dot(v, normal) <= 1e-6) continue;
      if (first < 0) first = n;
      last = n;
    }
    for (int n = first; first >= 0 && n <= last; n += piece) {
      add_front(out, f, n, std::min(n + piece - 1, last));
    }
  }
  return out;
}

struct Look {
  const Picture& seen;
  const Pose2& pose;
  const Pose2 back;  ///< X_BO
  const Footprint& body;
  const Spared* spared;
};

/// The first of a piece's looks that meets what nobody has seen, the body at a pose X_OB that it
/// will have. What is spared goes to the dock.
bool meets_unseen(const Look& by, const Front& f, const Pose2& at, double c, double s, double t_s,
                  Nearest& best, Nearest& dock) noexcept {
  const Patch& patch = by.seen.patch;
  for (int n = f.first; n <= f.last; ++n) {
    const Vec2 q = f.a + (static_cast<double>(n) / f.looks) * f.e;
    const auto ix =
        static_cast<std::int32_t>(std::floor((at.x_m + c * q.x - s * q.y) / patch.cell_m));
    const auto iy =
        static_cast<std::int32_t>(std::floor((at.y_m + s * q.x + c * q.y) / patch.cell_m));
    const bool unknown = by.seen.marks != nullptr ? by.seen.marks->unknown(ix, iy)
                                                  : patch.at(ix, iy).known == Known::Unknown;
    if (!unknown) continue;
    // Where the body stands now it need not have been seen.
    const Pose2 now = by.back * Pose2{(ix + 0.5) * patch.cell_m, (iy + 0.5) * patch.cell_m, 0.0};
    const Vec2 there{now.x_m, now.y_m};
    if (by.body.distance_m(there) <= 0.0) continue;
    const Patch::Cell cell = patch.at(ix, iy);
    if (is_spared(by.spared, there, cell.known)) {
      nearer(dock, t_s, there, cell);
      continue;
    }
    best = {t_s, there, cell};
    return true;
  }
  return false;
}

}  // namespace

// A piece of the outline about which all is seen as far as it goes in some steps is not looked at
// in those.
Nearest nearest_unseen(const Picture& seen, const Pose2& pose, const Footprint& body,
                       const Drive& d, const Spared* spared, Nearest& dock) noexcept {
  const double cell_m = seen.patch.cell_m;
  const double speed =
      std::abs(d.twist.linear_mps) + std::abs(d.twist.angular_radps) * body.reach_m();
  const int steps = std::min(400, static_cast<int>(speed * d.horizon_s / cell_m) + 1);
  const double step_m = speed * d.horizon_s / steps;
  const Look by{seen, pose, inverse(pose), body, spared};
  Fronts fronts = fronts_of(body, d, cell_m);
  Nearest best;
  for (int i = 1; i <= steps;) {
    const double t = d.horizon_s * i / steps;
    const Pose2 at = pose * along(d.twist.linear_mps, d.twist.angular_radps, t);
    const double c = std::cos(at.yaw_rad);
    const double s = std::sin(at.yaw_rad);
    int next = steps + 1;
    for (std::size_t k = 0; k < fronts.size; ++k) {
      Front& f = fronts.of[k];
      if (f.free_before <= i) {
        f.free_before = i + 1;
        const Vec2 m{at.x_m + c * f.middle.x - s * f.middle.y,
                     at.y_m + s * f.middle.x + c * f.middle.y};
        const int about =
            seen.marks == nullptr
                ? 0
                : seen.marks->seen_about(static_cast<std::int32_t>(std::floor(m.x / cell_m)),
                                         static_cast<std::int32_t>(std::floor(m.y / cell_m)));
        // A cell for where in theirs the middle and a look lie.
        const double spare_m = (about - 1) * cell_m - f.half_m;
        if (spare_m > 1e-6) {
          f.free_before = i + 1 + static_cast<int>((spare_m - 1e-6) / step_m);
        } else if (meets_unseen(by, f, at, c, s, d.horizon_s * (i - 1) / steps, best, dock)) {
          return best;
        }
      }
      next = std::min(next, f.free_before);
    }
    i = next;
  }
  return best;
}

}  // namespace roverd::nav::sense
