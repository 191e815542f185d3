#pragma once
// Random ground about a straight route, and the shortest way through it by a planner of another
// kind: Dijkstra over places 10 cm apart and sixteen headings, the body with its margin laid on
// every cell as it is.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <random>
#include <vector>

#include "scene.hpp"

namespace roverd::nav::around::tests {

constexpr double kGoal_m = 9.2;

/// Poles, boxes and walls between 1.4 and 8 m ahead, one on the route.
inline void strew(Scene& s, std::uint64_t seed, int things, double half_m) {
  std::mt19937_64 random(seed);
  const auto in = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const double reach = std::min(half_m, 9.5);
  for (int i = 0; i < things; ++i) {
    const double x = in(1.6, 7.2);
    const double y = i == 0 ? in(-0.3, 0.3) : in(-reach, reach);
    const double kind = in(0.0, 1.0);
    if (kind < 0.4) {
      s.pole(x, y, in(0.05, 0.3));
    } else if (kind < 0.8) {
      s.box(x, y - in(0.1, 0.5), x + in(0.1, 0.8), y + in(0.1, 0.5));
    } else {
      s.box(x, y, x + in(0.05, 0.2), y + in(0.5, 2.0));
    }
  }
}

/// @return metres from the origin to (kGoal_m, 0), never more than the shortest way with this
/// margin that keeps the corridor; infinity: there is none
class Reference {
 public:
  Reference(const Footprint& body, double margin_m) : body_(body) {
    constexpr std::array<std::array<int, 2>, 4> kOctant{{{1, 0}, {2, 1}, {1, 1}, {1, 2}}};
    for (int k = 0; k < 16; ++k) {
      const auto& o = kOctant[static_cast<std::size_t>(k % 4)];
      std::array<int, 2> d{o[0], o[1]};
      for (int q = 0; q < k / 4; ++q) d = {-d[1], d[0]};
      step_[static_cast<std::size_t>(k)] = d;
      const Pose2 pose{0.0, 0.0, std::atan2(d[1], d[0])};
      // A thing in the cell (x, y) of 5 cm keeps these places, relative to the middle of a place.
      const int reach = static_cast<int>((body.reach_m() + margin_m) / 0.05) + 2;
      for (int y = -reach; y <= reach; ++y) {
        for (int x = -reach; x <= reach; ++x) {
          if (to_square(body, pose, 0.05 * x, 0.05 * y, 0.05) < margin_m) {
            kept_[static_cast<std::size_t>(k)].push_back({x, y});
          }
        }
      }
    }
  }

  double shortest_m(const Scene& s, double half_m) {
    constexpr int n = 200;
    const auto index = [](int x, int y, int k) {
      return (static_cast<std::size_t>(y) * n + static_cast<std::size_t>(x)) * 16 +
             static_cast<std::size_t>(k);
    };
    taken_.assign(n * n * 16, 0);
    for (int k = 0; k < 16; ++k) {
      double low = 1e9;
      double high = -1e9;
      const auto& d = step_[static_cast<std::size_t>(k)];
      const double yaw = std::atan2(d[1], d[0]);
      double side = 0.0;
      for (const Vec2 c : body_.corners()) {
        const double y = std::sin(yaw) * c.x + std::cos(yaw) * c.y;
        low = std::min(low, y);
        high = std::max(high, y);
        side = std::max(side, std::hypot(c.x, c.y));
      }
      for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x) {
          const double py = (y - 100) * 0.1;
          const double px = (x - 100) * 0.1;
          const bool out = py + low < -half_m || py + high > half_m || px < -2.0 ||
                           px > 10.0 - side || std::abs(py) > 10.0 - side;
          if (out) taken_[index(x, y, k)] = 1;
        }
      }
    }
    for (std::int32_t cy = -200; cy < 200; ++cy) {
      for (std::int32_t cx = -200; cx < 200; ++cx) {
        if (s.patch.at(cx, cy).known != Known::Occupied) continue;
        // Things that are surrounded by others keep nothing that these do not.
        for (int k = 0; k < 16; ++k) {
          for (const auto& [dx, dy] : kept_[static_cast<std::size_t>(k)]) {
            const int fx = cx - dx + 200;  // in 5 cm
            const int fy = cy - dy + 200;
            if ((fx | fy) & 1) continue;
            const int x = fx / 2;
            const int y = fy / 2;
            if (x < 0 || y < 0 || x >= n || y >= n) continue;
            taken_[index(x, y, k)] = 1;
          }
        }
      }
    }
    return search(index);
  }

 private:
  template <class Index>
  double search(const Index& index) {
    constexpr int n = 200;
    constexpr float kNone = 1e9F;
    way_.assign(taken_.size(), kNone);
    using Entry = std::pair<float, std::uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    const auto put = [&](int x, int y, int k, float way) {
      if (x < 0 || y < 0 || x >= n || y >= n) return;
      const std::size_t i = index(x, y, k);
      if (taken_[i] != 0 || way >= way_[i]) return;
      way_[i] = way;
      open.emplace(way, static_cast<std::uint32_t>(i));
    };
    put(100, 100, 0, 0.0F);
    const int goal_x = 100 + static_cast<int>(kGoal_m * 10.0);
    while (!open.empty()) {
      const auto [way, i] = open.top();
      open.pop();
      if (way > way_[i]) continue;
      const int k = static_cast<int>(i % 16);
      const int x = static_cast<int>(i / 16) % n;
      const int y = static_cast<int>(i / 16) / n;
      // Sixteen directions are at most 1/cos(13.3°) longer than all of them.
      if (x == goal_x && y == 100 && k == 0) return static_cast<double>(way) / 1.0275;
      put(x, y, (k + 1) % 16, way + 1e-4F);
      put(x, y, (k + 15) % 16, way + 1e-4F);
      const auto& d = step_[static_cast<std::size_t>(k)];
      put(x + d[0], y + d[1], k,
          way + 0.1F * std::hypot(static_cast<float>(d[0]), static_cast<float>(d[1])));
    }
    return std::numeric_limits<double>::infinity();
  }

  Footprint body_;
  std::array<std::array<int, 2>, 16> step_{};
  std::array<std::vector<std::pair<int, int>>, 16> kept_;
  std::vector<std::uint8_t> taken_;
  std::vector<float> way_;
};

}  // namespace roverd::nav::around::tests
