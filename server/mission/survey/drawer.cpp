#include "mission/survey/drawer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angle.hpp"

namespace roverd::mission::survey {
namespace {

constexpr double kSamePlace_m = 0.01;
constexpr double kStub = 0.3;  // of an arc's chord

double yaw_of(EnuPoint from, EnuPoint to) noexcept {
  return std::atan2(to.north_m - from.north_m, to.east_m - from.east_m);
}

/// Where on a ring one is.
struct OnRing {
  std::size_t edge = 0;  ///< from point `edge` to the next
  EnuPoint at;
};

OnRing nearest_on(const Ring& ring, EnuPoint p) noexcept {
  OnRing best{0, ring.front()};
  double best_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const EnuPoint a = ring[i];
    const EnuPoint ab = ring[(i + 1) % ring.size()] - a;
    const EnuPoint ap = p - a;
    const double square = ab.east_m * ab.east_m + ab.north_m * ab.north_m;
    const double dot = ap.east_m * ab.east_m + ap.north_m * ab.north_m;
    const double share = square > 0.0 ? std::clamp(dot / square, 0.0, 1.0) : 0.0;
    const EnuPoint at{a.east_m + share * ab.east_m, a.north_m + share * ab.north_m};
    const double far_m = base::distance_m(p, at);
    if (far_m >= best_m) continue;
    best_m = far_m;
    best = {i, at};
  }
  return best;
}

}  // namespace

Drawer::Drawer(const Ways& ways, const Manner& manner) : ways_(ways), manner_(manner) {
  // sagitta = r (1 − cos(φ/2))
  const double share =
      std::clamp(1.0 - manner_.sagitta_m / std::max(manner_.radius_m, 1e-3), -1.0, 1.0);
  constexpr double kMost_rad = 0.7;
  step_m_ = manner_.radius_m * std::clamp(2.0 * std::acos(share), 0.05, kMost_rad);
}

std::optional<EnuPoint> Drawer::at() const noexcept {
  return points_.empty() ? std::nullopt : std::optional(points_.back().at);
}

void Drawer::put(EnuPoint at, Turn turn, bool reverse) {
  if (!points_.empty()) {
    PathPoint& last = points_.back();
    if (base::distance_m(last.at, at) < kSamePlace_m && last.reverse == reverse) {
      if (turn == Turn::Pivot) last.turn = turn;
      return;
    }
    const double yaw = yaw_of(last.at, at);
    yaw_rad_ = reverse ? yaw + base::kPi : yaw;
  }
  points_.push_back({at, reverse, turn});
}

/// The shortest turn that stays inside; with changes of direction where none does at one go.
bool Drawer::arc_to(const Pose& to) {
  const Pose from{points_.back().at, yaw_rad_};
  const auto fits = [&](const std::vector<TurnPoint>& way) {
    EnuPoint before = from.at;
    return std::all_of(way.begin(), way.end(), [&](const TurnPoint& p) {
      const bool free = ways_.clear(before, p.at);
      before = p.at;
      return free;
    });
  };
  const auto turns = turns_between(from, to, manner_.radius_m, step_m_);
  const auto first = std::find_if(turns.begin(), turns.end(), fits);
  const auto way =
      first != turns.end() ? *first : turn_reversing(from, to, manner_.radius_m, step_m_, fits);
  if (way.empty()) return false;
  for (const TurnPoint& p : way) put(p.at, Turn::Arc, p.reverse);
  yaw_rad_ = to.yaw_rad;
  return true;
}

void Drawer::reach(const Pose& to) {
  if (points_.empty()) {
    put(to.at, Turn::Auto);
    yaw_rad_ = to.yaw_rad;
    return;
  }
  const bool arcs = manner_.turn == SurveyTurn::Arc;
  if (arcs) {
    constexpr double kStraight_rad = 0.01;
    const bool there = base::distance_m(points_.back().at, to.at) < kSamePlace_m &&
                       std::abs(base::angle_diff_rad(yaw_rad_, to.yaw_rad)) < kStraight_rad;
    if (there || arc_to(to)) return;
  }
  const auto corners = ways_.way(points_.back().at, to.at);
  if (!arcs && !points_.empty()) points_.back().turn = Turn::Pivot;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const bool last = i + 1 == corners.size();
    put(corners[i], !arcs && last ? Turn::Pivot : Turn::Auto);
  }
}

void Drawer::line(EnuPoint from, EnuPoint to) {
  const double yaw = base::distance_m(from, to) < kSamePlace_m ? yaw_rad_ : yaw_of(from, to);
  reach({from, yaw});
  put(to, manner_.turn == SurveyTurn::Arc ? Turn::Arc : Turn::Pivot);
}

void Drawer::round(const Ring& ring, EnuPoint start) {
  OnRing here = nearest_on(ring, at().value_or(start));
  const std::size_t n = ring.size();
  if (manner_.turn == SurveyTurn::Arc) {
    // A chord of some centimetres shows another direction than those beside it.
    const std::size_t next = (here.edge + 1) % n;
    if (base::distance_m(here.at, ring[next]) < kStub * step_m_) here = {next, ring[next]};
    if (base::distance_m(here.at, ring[here.edge]) < kStub * step_m_) here.at = ring[here.edge];
  }
  const Turn turn = manner_.turn == SurveyTurn::Arc ? Turn::Arc : Turn::Auto;
  reach({here.at, yaw_of(here.at, ring[(here.edge + 1) % n])});
  for (std::size_t k = 1; k <= n; ++k) put(ring[(here.edge + k) % n], turn);
  put(here.at, turn);
}

}  // namespace roverd::mission::survey
