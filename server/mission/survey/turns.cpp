#include "mission/survey/turns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "base/angle.hpp"

namespace roverd::mission::survey {
namespace {

enum class Bend { Left, Straight, Right };

struct Word {
  std::array<Bend, 3> bends;
  std::array<double, 3> lengths;  ///< in radii

  double length() const noexcept { return lengths[0] + lengths[1] + lengths[2]; }
};

double turn_of(double angle_rad) noexcept {
  const double full = 2.0 * base::kPi;
  const double wrapped = std::fmod(angle_rad, full);
  const double positive = wrapped < 0.0 ? wrapped + full : wrapped;
  // What is a full turn but for rounding is none.
  constexpr double kGrace = 1e-9;
  return full - positive < kGrace ? 0.0 : positive;
}

/// The six words of Dubins for a start at the origin that looks along the first axis after a turn
/// by `a`, and an end at distance d (in radii) that looks along it after a turn by `b`.
std::vector<Word> words_for(double d, double a, double b) {
  const double sa = std::sin(a);
  const double sb = std::sin(b);
  const double ca = std::cos(a);
  const double cb = std::cos(b);
  const double cab = std::cos(a - b);
  std::vector<Word> out;
  using enum Bend;
  if (const double q = 2.0 + d * d - 2.0 * cab + 2.0 * d * (sa - sb); q >= 0.0) {
    const double t = std::atan2(cb - ca, d + sa - sb);
    out.push_back({{Left, Straight, Left}, {turn_of(t - a), std::sqrt(q), turn_of(b - t)}});
  }
  if (const double q = 2.0 + d * d - 2.0 * cab + 2.0 * d * (sb - sa); q >= 0.0) {
    const double t = std::atan2(ca - cb, d - sa + sb);
    out.push_back({{Right, Straight, Right}, {turn_of(a - t), std::sqrt(q), turn_of(t - b)}});
  }
  if (const double q = -2.0 + d * d + 2.0 * cab + 2.0 * d * (sa + sb); q >= 0.0) {
    const double p = std::sqrt(q);
    const double t = std::atan2(-ca - cb, d + sa + sb) - std::atan2(-2.0, p);
    out.push_back({{Left, Straight, Right}, {turn_of(t - a), p, turn_of(t - b)}});
  }
  if (const double q = -2.0 + d * d + 2.0 * cab - 2.0 * d * (sa + sb); q >= 0.0) {
    const double p = std::sqrt(q);
    const double t = std::atan2(ca + cb, d - sa - sb) - std::atan2(2.0, p);
    out.push_back({{Right, Straight, Left}, {turn_of(a - t), p, turn_of(b - t)}});
  }
  if (const double c = (6.0 - d * d + 2.0 * cab + 2.0 * d * (sa - sb)) / 8.0; std::abs(c) <= 1.0) {
    const double p = turn_of(2.0 * base::kPi - std::acos(c));
    const double t = turn_of(a - std::atan2(ca - cb, d - sa + sb) + p / 2.0);
    out.push_back({{Right, Left, Right}, {t, p, turn_of(a - b - t + p)}});
  }
  if (const double c = (6.0 - d * d + 2.0 * cab + 2.0 * d * (sb - sa)) / 8.0; std::abs(c) <= 1.0) {
    const double p = turn_of(2.0 * base::kPi - std::acos(c));
    const double t = turn_of(-a - std::atan2(ca - cb, d + sa - sb) + p / 2.0);
    out.push_back({{Left, Right, Left}, {t, p, turn_of(b - a - t + p)}});
  }
  return out;
}

class Pen {
 public:
  Pen(const Pose& from, double radius_m, double step_m)
      : pose_(from), radius_m_(radius_m), step_m_(step_m) {}

  /// @param length_m along the way; below 0: backwards
  void draw(Bend bend, double length_m) {
    const bool reverse = length_m < 0.0;
    const double way_m = std::abs(length_m);
    constexpr double kNothing_m = 1e-6;
    if (way_m < kNothing_m) return;
    const int pieces = bend == Bend::Straight ? 1 : static_cast<int>(std::ceil(way_m / step_m_));
    const double piece_m = length_m / pieces;
    for (int i = 0; i < pieces; ++i) {
      const double turn =
          bend == Bend::Straight ? 0.0 : piece_m / radius_m_ * (bend == Bend::Left ? 1.0 : -1.0);
      // The chord of the piece, along the direction in its middle.
      const double chord_m =
          turn == 0.0 ? piece_m
                      : 2.0 * radius_m_ * std::sin(turn / 2.0) * (bend == Bend::Left ? 1.0 : -1.0);
      const double middle = pose_.yaw_rad + turn / 2.0;
      pose_.at = pose_.at + EnuPoint{chord_m * std::cos(middle), chord_m * std::sin(middle)};
      pose_.yaw_rad += turn;
      points_.push_back({pose_.at, reverse});
    }
  }
  std::vector<TurnPoint> take() { return std::move(points_); }
  const Pose& pose() const noexcept { return pose_; }

 private:
  Pose pose_;
  const double radius_m_;
  const double step_m_;
  std::vector<TurnPoint> points_;
};

/// Arc by a quarter turn, backwards past each other, arc by a quarter turn.
std::optional<std::vector<TurnPoint>> fishtail(const Pose& a, const Pose& b, double radius_m,
                                               double step_m) {
  constexpr double kOpposite_rad = 0.02;
  if (std::abs(base::angle_diff_rad(a.yaw_rad + base::kPi, b.yaw_rad)) > kOpposite_rad) return {};
  const EnuPoint way = b.at - a.at;
  const double c = std::cos(a.yaw_rad);
  const double s = std::sin(a.yaw_rad);
  const double ahead_m = way.east_m * c + way.north_m * s;
  const double left_m = way.north_m * c - way.east_m * s;
  const double back_m = 2.0 * radius_m - std::abs(left_m);
  if (back_m <= 0.0) return {};  // the arcs alone are wide enough
  const Bend bend = left_m > 0.0 ? Bend::Left : Bend::Right;
  Pen pen(a, radius_m, step_m);
  const double quarter_m = radius_m * base::kPi / 2.0;
  pen.draw(Bend::Straight, std::max(0.0, ahead_m));
  pen.draw(bend, quarter_m);
  pen.draw(Bend::Straight, -back_m);
  pen.draw(bend, quarter_m);
  pen.draw(Bend::Straight, std::max(0.0, -ahead_m));
  return pen.take();
}

Pose moved(const Pose& p, double ahead_m) noexcept {
  return {p.at + EnuPoint{ahead_m * std::cos(p.yaw_rad), ahead_m * std::sin(p.yaw_rad)}, p.yaw_rad};
}

/// The same place, seen by who drives backwards.
Pose turned(const Pose& p) noexcept {
  return {p.at, p.yaw_rad + base::kPi};
}

std::vector<Word> words_between(const Pose& a, const Pose& b, double radius_m) {
  const EnuPoint way = b.at - a.at;
  const double direction = std::atan2(way.north_m, way.east_m);
  const double d = std::hypot(way.east_m, way.north_m) / radius_m;
  return words_for(d, turn_of(a.yaw_rad - direction), turn_of(b.yaw_rad - direction));
}

/// Empty: each formula has its corner cases, and what does not arrive is none.
std::vector<TurnPoint> drawn(const Word& word, const Pose& a, const Pose& b, double radius_m,
                             double step_m) {
  Pen pen(a, radius_m, step_m);
  for (std::size_t i = 0; i < 3; ++i) pen.draw(word.bends[i], word.lengths[i] * radius_m);
  const double miss_m = base::distance_m(pen.pose().at, b.at);
  const double miss_rad = std::abs(base::angle_diff_rad(pen.pose().yaw_rad, b.yaw_rad));
  constexpr double kGood = 1e-3;
  if (miss_m > kGood * std::max(1.0, radius_m) || miss_rad > kGood) return {};
  return pen.take();
}

/// A straight, a word of arcs, a straight; each forwards or backwards.
struct Shunt {
  double first_m = 0.0;  ///< from a; below 0: backwards
  double last_m = 0.0;   ///< to b, likewise
  bool reverse = false;  ///< the arcs are driven backwards
  Word word{};
  double cost_m = 0.0;
};

/// Before and behind it the way goes forwards.
double cost_m(const Shunt& s, double radius_m) noexcept {
  constexpr double kChange = 3.0;  // in radii
  bool back = false;
  int changes = 0;
  const auto next = [&](bool reverse) {
    if (reverse != back) ++changes;
    back = reverse;
  };
  if (s.first_m != 0.0) next(s.first_m < 0.0);
  next(s.reverse);
  if (s.last_m != 0.0) next(s.last_m < 0.0);
  next(false);
  return std::abs(s.first_m) + std::abs(s.last_m) +
         (s.word.length() + kChange * changes) * radius_m;
}

std::vector<Shunt> shunts_between(const Pose& a, const Pose& b, double radius_m) {
  constexpr double kRadii[] = {-4.0, -3.0, -2.0, -1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5, 2.0, 3.0};
  std::vector<Shunt> out;
  for (const double first : kRadii) {
    for (const double last : kRadii) {
      const Pose from = moved(a, first * radius_m);
      const Pose to = moved(b, -last * radius_m);
      for (const bool reverse : {false, true}) {
        for (const Word& word : reverse ? words_between(turned(from), turned(to), radius_m)
                                        : words_between(from, to, radius_m)) {
          out.push_back({first * radius_m, last * radius_m, reverse, word, 0.0});
          out.back().cost_m = cost_m(out.back(), radius_m);
        }
      }
    }
  }
  std::ranges::stable_sort(out, {}, &Shunt::cost_m);
  return out;
}

std::vector<TurnPoint> drawn(const Shunt& s, const Pose& a, const Pose& b, double radius_m,
                             double step_m) {
  const Pose from = moved(a, s.first_m);
  const Pose to = moved(b, -s.last_m);
  auto arcs = s.reverse ? drawn(s.word, turned(from), turned(to), radius_m, step_m)
                        : drawn(s.word, from, to, radius_m, step_m);
  if (arcs.empty()) return {};
  std::vector<TurnPoint> out;
  if (s.first_m != 0.0) out.push_back({from.at, s.first_m < 0.0});
  for (TurnPoint& p : arcs) out.push_back({p.at, s.reverse});
  if (s.last_m != 0.0) out.push_back({b.at, s.last_m < 0.0});
  return out;
}

}  // namespace

std::vector<std::vector<TurnPoint>> turns_between(const Pose& a, const Pose& b, double radius_m,
                                                  double step_m) {
  auto words = words_between(a, b, radius_m);
  std::sort(words.begin(), words.end(),
            [](const Word& x, const Word& y) { return x.length() < y.length(); });
  std::vector<std::vector<TurnPoint>> out;
  for (const Word& word : words) {
    auto way = drawn(word, a, b, radius_m, step_m);
    if (!way.empty()) out.push_back(std::move(way));
  }
  if (auto tail = fishtail(a, b, radius_m, step_m)) out.push_back(std::move(*tail));
  return out;
}

std::vector<TurnPoint> turn_reversing(
    const Pose& a, const Pose& b, double radius_m, double step_m,
    const std::function<bool(const std::vector<TurnPoint>&)>& fits) {
  for (const Shunt& shunt : shunts_between(a, b, radius_m)) {
    auto way = drawn(shunt, a, b, radius_m, step_m);
    if (!way.empty() && fits(way)) return way;
  }
  return {};
}

}  // namespace roverd::mission::survey
