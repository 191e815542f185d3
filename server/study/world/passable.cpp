#include "study/world/passable.hpp"

#include <array>
#include <cmath>
#include <queue>
#include <utility>
#include <vector>

#include "base/angle.hpp"

namespace roverd::study {
namespace {

using sim::world::Body;
using sim::world::Pose;
using sim::world::Vec2;

constexpr double kSquare_m = 0.1;
constexpr double kBeyond_m = 1.0;  // the end, and behind the begin
struct Step {
  int along, left;
};
// In order of their directions, from ahead to the left.
constexpr std::array<Step, 16> kSteps{{{1, 0},
                                       {2, 1},
                                       {1, 1},
                                       {1, 2},
                                       {0, 1},
                                       {-1, 2},
                                       {-1, 1},
                                       {-2, 1},
                                       {-1, 0},
                                       {-2, -1},
                                       {-1, -1},
                                       {-1, -2},
                                       {0, -1},
                                       {1, -2},
                                       {1, -1},
                                       {2, -1}}};

class Search {
 public:
  Search(const sim::world::Scene& scene, Body body, const Passage& passage)
      : scene_(scene),
        moment_(scene.at(0.0)),
        bare_(body),
        roomy_(wider(std::move(body), passage.room_m)),
        passage_(passage) {
    const base::EnuPoint way = passage.to - passage.from;
    length_m_ = std::hypot(way.east_m, way.north_m);
    yaw_rad_ = std::atan2(way.north_m, way.east_m);
    columns_ = static_cast<int>((length_m_ + 2.0 * kBeyond_m) / kSquare_m) + 1;
    half_rows_ = static_cast<int>(passage.side_m / kSquare_m);
    seen_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(2 * half_rows_ + 1) *
                 kSteps.size());
  }

  bool finds() {
    const int begin = static_cast<int>(std::lround(kBeyond_m / kSquare_m));
    const int end = begin + static_cast<int>(std::lround(length_m_ / kSquare_m));
    add({begin, 0, 0});
    while (!next_.empty()) {
      const State s = next_.front();
      next_.pop();
      if (s.column == end && s.row == 0) return true;
      // Half of the way to the next direction or place, and all of it.
      for (const int turn : {1, 15}) {
        const int to = (s.direction + turn) % 16;
        const double half =
            direction_rad(s.direction) +
            0.5 * base::angle_diff_rad(direction_rad(s.direction), direction_rad(to));
        if (free(s.column, s.row, half)) add({s.column, s.row, to});
      }
      const Step d = kSteps[static_cast<std::size_t>(s.direction)];
      for (const int sign : {1, -1}) {
        if (free(s.column + 0.5 * sign * d.along, s.row + 0.5 * sign * d.left,
                 direction_rad(s.direction))) {
          add({s.column + sign * d.along, s.row + sign * d.left, s.direction});
        }
      }
    }
    return false;
  }

 private:
  struct State {
    int column, row, direction;
  };

  /// Its outline is a rectangle or a ring about the origin: each corner farther out by so much.
  static Body wider(Body body, double by_m) {
    for (Vec2& c : body.outline) {
      c.x += std::copysign(by_m, c.x);
      c.y += std::copysign(by_m, c.y);
    }
    return body;
  }
  static double direction_rad(int direction) {
    const Step d = kSteps[static_cast<std::size_t>(direction)];
    return std::atan2(d.left, d.along);
  }
  void add(State s) {
    if (s.column < 0 || s.column >= columns_ || std::abs(s.row) > half_rows_) return;
    const auto rows = static_cast<std::size_t>(2 * half_rows_ + 1);
    const std::size_t index =
        (static_cast<std::size_t>(s.column) * rows + static_cast<std::size_t>(s.row + half_rows_)) *
            kSteps.size() +
        static_cast<std::size_t>(s.direction);
    if (seen_[index]) return;
    seen_[index] = true;
    if (free(s.column, s.row, direction_rad(s.direction))) next_.push(s);
  }
  bool free(double column, double row, double direction_rad) const {
    const double along_m = column * kSquare_m - kBeyond_m;
    const double left_m = row * kSquare_m;
    for (const Vec2 c : bare_.outline) {
      const double aside_m = left_m + c.x * std::sin(direction_rad) + c.y * std::cos(direction_rad);
      if (std::abs(aside_m) > passage_.side_m) return false;
    }
    Pose at;
    at.x_m = passage_.from.east_m + along_m * std::cos(yaw_rad_) - left_m * std::sin(yaw_rad_);
    at.y_m = passage_.from.north_m + along_m * std::sin(yaw_rad_) + left_m * std::cos(yaw_rad_);
    at.yaw_rad = base::wrap_rad(yaw_rad_ + direction_rad);
    return sim::world::contact(scene_, moment_, at, roomy_, 0.1).touches.empty();
  }

  const sim::world::Scene& scene_;
  sim::world::Moment moment_;
  Body bare_;
  Body roomy_;
  Passage passage_;
  double length_m_ = 0.0;
  double yaw_rad_ = 0.0;
  int columns_ = 0;
  int half_rows_ = 0;
  std::vector<bool> seen_;
  std::queue<State> next_;
};

}  // namespace

bool passable(const sim::world::Scene& scene, const Body& body, const Passage& passage) {
  return Search(scene, body, passage).finds();
}

}  // namespace roverd::study
