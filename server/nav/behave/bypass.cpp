// The executor and what stands on its way: what lies ahead, and how it goes on behind.

#include <algorithm>
#include <utility>

#include "nav/behave/executor.hpp"

namespace roverd::nav {
namespace {

std::vector<EnuPoint> sampled(const Path& path, double from_m, double to_m) {
  std::vector<EnuPoint> out;
  for (double s_m = from_m; s_m < to_m; s_m += WayAhead::kStep_m) out.push_back(path.at(s_m));
  out.push_back(path.at(to_m));
  return out;
}

bool inside_smooth(const Path& path, std::size_t node) noexcept {
  return std::any_of(path.smoothed.begin(), path.smoothed.end(),
                     [&](const SmoothStretch& s) { return s.first < node && node < s.last; });
}

}  // namespace

bool Executor::must_come_to(const RouteStep& step) const noexcept {
  if (step.silent || params_->unreachable == "skip") return false;
  return !inside_smooth(course_->path, step.node);
}

std::optional<WayAhead> Executor::ahead(EnuPoint here, double reach_m) const {
  if (!running() || stays_ || by_odometry()) return std::nullopt;
  WayAhead out;
  if (doing_ == Doing::Connector) {
    if (connector_end_.reverse || connector_.points.empty()) return std::nullopt;
    const EnuPoint to = connector_.points.back().at;
    const double far_m = base::distance_m(here, to);
    if (far_m < WayAhead::kStep_m) return std::nullopt;
    const double part = std::min(1.0, reach_m / far_m);
    const int pieces = static_cast<int>(part * far_m / WayAhead::kStep_m) + 1;
    for (int i = 0; i <= pieces; ++i) {
      const double t = part * i / pieces;
      out.way.push_back({here.east_m + t * (to.east_m - here.east_m),
                         here.north_m + t * (to.north_m - here.north_m)});
    }
    out.at_end = part >= 1.0;
    const RouteStep* step = step_now();
    if (out.at_end && step != nullptr) out.item = step->item;
    return out;
  }
  if (doing_ != Doing::Path) return std::nullopt;
  const Path& path = course_->path;
  const bool tracking = tracker_.path() == &path;
  const std::size_t leg_at = tracking ? tracker_.leg() : leg_;
  if (leg_at >= path.legs.size() || path.legs[leg_at].reverse) return std::nullopt;
  const Leg& leg = path.legs[leg_at];
  out.from_m = tracking ? tracker_.s_m() : s_m_;
  double end_m = std::min(leg.end_m, out.from_m + reach_m);
  out.at_end = end_m >= leg.end_m;
  for (std::size_t i = at_; i < course_->steps.size(); ++i) {
    const RouteStep& step = course_->steps[i];
    if (step.kind != StepKind::Go) break;
    const double at_m = path.vertex_m[step.node];
    if (at_m > end_m) break;
    out.item = step.item;
    if (at_m <= out.from_m || !must_come_to(step)) continue;
    end_m = at_m;
    out.at_end = true;
    break;
  }
  if (!out.at_end) out.item = 0;
  if (end_m - out.from_m < WayAhead::kStep_m) return std::nullopt;
  out.way = sampled(path, out.from_m, end_m);
  return out;
}

void Executor::bypass(double from_m, double to_m, EnuPoint here) {
  if (!running()) return;
  interrupt();
  if (doing_ != Doing::Path) return go_on(here);
  const Path& path = course_->path;
  const std::size_t leg_at = std::min(leg_, path.legs.size() - 1);
  to_m = std::clamp(to_m, s_m_, path.legs[leg_at].end_m);
  for (const RouteStep* step = step_now(); step != nullptr && step->kind == StepKind::Go;
       step = step_now()) {
    const double at_m = path.vertex_m[step->node];
    if (at_m >= to_m || at_m > path.legs[leg_at].end_m - 1e-6) break;
    if (at_m < from_m) {
      reached(*step);
      continue;
    }
    if (!step->silent) {
      notices_.push_back({Notice::Kind::ItemMissed, step->item,
                          "left out: the robot drove around what stands there"});
    }
    pass(*step);
  }
  s_m_ = to_m;
  leg_ = leg_at;
  standing_.reset();
  go_on(here);
}

}  // namespace roverd::nav
