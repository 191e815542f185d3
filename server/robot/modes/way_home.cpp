#include "robot/modes/way_home.hpp"

#include <cmath>

namespace roverd::robot {
namespace {

constexpr double kLongGap_m = 5.0;   // a piece of the way that was not seen
constexpr double kSameHome_m = 1.0;  // a way that begins so near to home ends there

bool reaches(const WayHomeFacts& f, base::EnuPoint to) noexcept {
  return f.fence == nullptr || may_drive(f.fence->limits, f.here, to, f.margin_m);
}

}  // namespace

std::string_view to_string(HomeEnd end) noexcept {
  switch (end) {
    case HomeEnd::Home:
      return "home";
    case HomeEnd::Rally:
      return "rally_point";
    case HomeEnd::Begin:
      return "begin_of_way";
  }
  return "";
}

double WayHome::length_m(base::EnuPoint here) const noexcept {
  double sum = 0.0;
  for (const base::EnuPoint& p : way) {
    sum += base::distance_m(here, p);
    here = p;
  }
  return sum;
}

/// The nearest of home and the rally points that can be reached straight, inside the fence.
WayHome straight_home(const WayHomeFacts& f) {
  WayHome out;
  const auto offer = [&](base::EnuPoint p, HomeEnd end) {
    const bool farther = !out.way.empty() &&
                         base::distance_m(f.here, p) >= base::distance_m(f.here, out.way.front());
    if (farther || !reaches(f, p)) return;
    out.way.assign(1, p);
    out.end = end;
  };
  const bool rally = f.fence != nullptr && !f.fence->rally.empty();
  if (!f.home && !rally) {
    out.refusal = "there is no home to return to";
    return out;
  }
  if (f.home) offer(*f.home, HomeEnd::Home);
  if (rally) {
    for (const base::EnuPoint& r : f.fence->rally) offer(r, HomeEnd::Rally);
  }
  if (!out.way.empty()) return out;
  // Whoever looks is shown what stands in the way.
  if (f.home) out.way.assign(1, *f.home);
  out.refusal = "neither home nor a rally point can be reached straight inside the fence";
  return out;
}

WayHome driven_home(const WayHomeFacts& f, const DrivenWay& driven) {
  WayHome out;
  out.end = HomeEnd::Begin;
  out.way = driven.crumbs.empty() ? driven.back : nav::way_back(driven.crumbs, driven.accuracy_m);
  if (out.way.empty()) {
    out.refusal =
        "the way from home is not known: it is kept from arming on, "
        "where the position is certain enough";
    return out;
  }
  if (f.home && base::distance_m(out.way.back(), *f.home) <= kSameHome_m) {
    out.way.back() = *f.home;
    out.end = HomeEnd::Home;
  }
  if (driven.longest_gap_m > kLongGap_m) {
    out.refusal = "the driven way is not known over " +
                  std::to_string(std::lround(driven.longest_gap_m)) + " m";
    return out;
  }
  base::EnuPoint from = f.here;
  for (const base::EnuPoint& p : out.way) {
    if (f.fence != nullptr && f.fence->limits.crosses(from, p)) {
      out.refusal = "the driven way leaves the fence";
      return out;
    }
    from = p;
  }
  return out;
}

}  // namespace roverd::robot
