#include "nav/place/search.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/angle.hpp"
#include "nav/chart/cell.hpp"

namespace roverd::nav::place {

namespace {

struct Square {
  std::int32_t column = 0;
  std::int32_t row = 0;
};

/// The points at one heading, as squares relative to where the robot stands.
std::vector<Square> turned(const Field& field, std::span<const Point> points, double x_m,
                           double y_m, double yaw_rad) {
  std::vector<Square> out;
  out.reserve(points.size());
  const double c = std::cos(yaw_rad);
  const double s = std::sin(yaw_rad);
  const double per_m = 1.0 / field.square_m();
  for (const Point& p : points) {
    out.push_back({chart::whole_cell((x_m + c * p.x_m - s * p.y_m) * per_m),
                   chart::whole_cell((y_m + s * p.x_m + c * p.y_m) * per_m)});
  }
  return out;
}

/// Sum of the fits when everything is moved; at a level: of the best in the square of moves.
std::uint32_t fit_at(const Field& field, const std::vector<Square>& squares, int level,
                     std::int32_t columns, std::int32_t rows) noexcept {
  std::uint32_t sum = 0;
  for (const Square& s : squares) sum += field.fit(level, s.column + columns, s.row + rows);
  return sum;
}

/// A square of moves at one heading.
struct Node {
  double bound = 0.0;
  std::uint32_t heading = 0;
  std::int32_t columns = 0;
  std::int32_t rows = 0;
};

bool better(const Node& a, const Node& b) noexcept {
  return a.bound > b.bound;
}

/// The four or fewer squares of a square, best first.
struct Quarters {
  std::array<Node, 4> of{};
  std::size_t count = 0;

  void add(const Node& n) noexcept {
    std::size_t at = count++;
    for (; at > 0 && n.bound > of[at - 1].bound; --at) of[at] = of[at - 1];
    of[at] = n;
  }
};

class WindowSearch {
 public:
  WindowSearch(const Field& field, std::span<const Point> points, const Pose2& middle,
               const WindowParams& p)
      : field_(field),
        p_(p),
        middle_(middle),
        unit_(1.0 / (255.0 * static_cast<double>(points.size()))) {
    half_ = static_cast<std::int32_t>(std::ceil(p.half_m / field.square_m()));
    const int turns = static_cast<int>(std::ceil(p.half_rad / p.step_rad));
    for (int i = -turns; i <= turns; ++i) {
      const double off = i * p.step_rad;
      offs_.push_back(off);
      headings_.push_back(turned(field, points, middle.x_m, middle.y_m, middle.yaw_rad + off));
    }
  }

  Found run() {
    constexpr int kLevel = 3;  // eight squares
    constexpr std::int32_t kStep = 1 << kLevel;
    std::vector<Node> nodes;
    for (std::uint32_t h = 0; h < headings_.size(); ++h) {
      for (std::int32_t c = -half_; c <= half_; c += kStep) {
        for (std::int32_t r = -half_; r <= half_; r += kStep)
          nodes.push_back(node(kLevel, h, c, r));
      }
    }
    std::sort(nodes.begin(), nodes.end(), better);
    best_.bound = 0.0;
    for (const Node& n : nodes) {
      if (n.bound <= best_.bound) break;
      descend(n, kLevel);
    }
    Found found{middle_, best_.bound};
    if (best_.bound > 0.0) {
      found.pose = {middle_.x_m + best_.columns * field_.square_m(),
                    middle_.y_m + best_.rows * field_.square_m(),
                    base::wrap_rad(middle_.yaw_rad + offs_[best_.heading])};
    }
    return found;
  }

 private:
  Node node(int level, std::uint32_t h, std::int32_t c, std::int32_t r) const {
    const std::int32_t size = (1 << level) - 1;
    const double fit = unit_ * fit_at(field_, headings_[h], level, c, r);
    // The move of the square that is nearest to the middle.
    const double dc = std::clamp(0, c, c + size) * field_.square_m() / p_.half_m;
    const double dr = std::clamp(0, r, r + size) * field_.square_m() / p_.half_m;
    const double dh = offs_[h] / p_.half_rad;
    return {fit - p_.edge_cost * (dc * dc + dr * dr + dh * dh), h, c, r};
  }

  void descend(const Node& n, int level) {
    if (level == 0) {
      if (n.bound > best_.bound) best_ = n;
      return;
    }
    const std::int32_t half = 1 << (level - 1);
    Quarters quarters;
    for (const std::int32_t c : {n.columns, n.columns + half}) {
      for (const std::int32_t r : {n.rows, n.rows + half}) {
        if (c > half_ || r > half_) continue;
        quarters.add(node(level - 1, n.heading, c, r));
      }
    }
    for (std::size_t i = 0; i < quarters.count; ++i) {
      if (quarters.of[i].bound > best_.bound) descend(quarters.of[i], level - 1);
    }
  }

  const Field& field_;
  const WindowParams& p_;
  Pose2 middle_;
  double unit_;
  std::int32_t half_ = 0;
  std::vector<double> offs_;
  std::vector<std::vector<Square>> headings_;
  Node best_;
};

class WholeSearch {
 public:
  WholeSearch(const Field& field, std::span<const Point> points, const WholeParams& p)
      : field_(field), p_(p), unit_(1.0 / (255.0 * static_cast<double>(points.size()))) {
    const int turns = std::max(1, static_cast<int>(std::ceil(2.0 * base::kPi / p.step_rad)));
    for (int i = 0; i < turns; ++i) {
      yaws_.push_back(2.0 * base::kPi * i / turns);
      headings_.push_back(turned(field, points, 0.0, 0.0, yaws_.back()));
    }
  }

  Whole run() {
    constexpr int kLevel = Field::kLevels - 2;
    constexpr std::int32_t kStep = 1 << kLevel;
    threshold_ = p_.least_fit;
    std::vector<Node> nodes;
    for (std::uint32_t h = 0; h < headings_.size(); ++h) {
      for (std::int32_t c = 0; c < field_.square_columns(); c += kStep) {
        for (std::int32_t r = 0; r < field_.square_rows(); r += kStep) {
          const Node n = node(kLevel, h, c, r);
          if (n.bound > threshold_) nodes.push_back(n);
        }
      }
    }
    std::sort(nodes.begin(), nodes.end(), better);
    for (const Node& n : nodes) {
      if (n.bound <= threshold_ || looks_ > p_.most_looks) break;
      descend(n, kLevel);
    }
    Whole whole;
    whole.complete = looks_ <= p_.most_looks;
    choose(whole.found);
    return whole;
  }

 private:
  Node node(int level, std::uint32_t h, std::int32_t c, std::int32_t r) {
    ++looks_;
    return {unit_ * fit_at(field_, headings_[h], level, c, r), h, c, r};
  }

  void descend(const Node& n, int level) {
    if (level == 0) {
      keep(n);
      return;
    }
    const std::int32_t half = 1 << (level - 1);
    Quarters quarters;
    for (const std::int32_t c : {n.columns, n.columns + half}) {
      for (const std::int32_t r : {n.rows, n.rows + half}) {
        quarters.add(node(level - 1, n.heading, c, r));
      }
    }
    for (std::size_t i = 0; i < quarters.count; ++i) {
      if (quarters.of[i].bound <= threshold_ || looks_ > p_.most_looks) return;
      descend(quarters.of[i], level - 1);
    }
  }

  void keep(const Node& n) {
    leaves_.push_back(n);
    threshold_ = std::max(threshold_, n.bound - p_.below_best);
    constexpr std::size_t kFull = 200'000;
    if (leaves_.size() < kFull) return;
    // Too many alike: keep the better half and look for nothing worse.
    std::nth_element(leaves_.begin(), leaves_.begin() + kFull / 2, leaves_.end(), better);
    leaves_.resize(kFull / 2);
    threshold_ = std::max(threshold_, leaves_.back().bound);
  }

  void choose(std::vector<Found>& out) {
    std::sort(leaves_.begin(), leaves_.end(), better);
    for (const Node& n : leaves_) {
      if (n.bound <= threshold_ - 1e-12 || out.size() >= p_.most) break;
      const Pose2 pose{n.columns * field_.square_m(), n.rows * field_.square_m(),
                       base::wrap_rad(yaws_[n.heading])};
      const bool alike = std::any_of(out.begin(), out.end(), [&](const Found& f) {
        return std::hypot(f.pose.x_m - pose.x_m, f.pose.y_m - pose.y_m) < p_.apart_m &&
               std::abs(base::angle_diff_rad(f.pose.yaw_rad, pose.yaw_rad)) < p_.apart_rad;
      });
      if (!alike) out.push_back({pose, n.bound});
    }
  }

  const Field& field_;
  const WholeParams& p_;
  double unit_;
  std::vector<double> yaws_;
  std::vector<std::vector<Square>> headings_;
  std::vector<Node> leaves_;
  double threshold_ = 0.0;
  std::uint64_t looks_ = 0;
};

}  // namespace

Found search_window(const Field& field, std::span<const Point> points, const Pose2& middle,
                    const WindowParams& p) {
  if (points.empty()) return {middle, 0.0};
  return WindowSearch(field, points, middle, p).run();
}

Whole search_whole(const Field& field, std::span<const Point> points, const WholeParams& p) {
  if (points.empty()) return {};
  return WholeSearch(field, points, p).run();
}

}  // namespace roverd::nav::place
