// The ways home: RTL and SMART_RTL.

#include <cmath>

#include "robot/impl.hpp"

namespace roverd::robot {
namespace {

using base::Code;

constexpr double kLongGap_m = 5.0;   // a piece of the way that was not seen
constexpr double kSameHome_m = 1.0;  // crumbs that begin so near to home end there

std::string metres(double m) {
  return std::to_string(std::lround(m)) + " m";
}

}  // namespace

/// The nearest of home and the rally points that can be reached straight, inside the fence.
std::optional<base::EnuPoint> Robot::Impl::refuge() const {
  std::optional<base::EnuPoint> best;
  const auto offer = [&](base::EnuPoint p) {
    if (best && base::distance_m(pose->at, p) >= base::distance_m(pose->at, *best)) return;
    if (inside(p)) best = p;
  };
  if (const auto h = home_point()) offer(*h);
  if (fence) {
    for (const base::EnuPoint& r : fence->rally) offer(r);
  }
  return best;
}

base::Result<void> Robot::Impl::enter_return() {
  if (auto ok = may_drive_by_itself(); !ok) return ok;
  if (mode == Mode::Rtl) return {};
  if (!home_point() && !(fence && !fence->rally.empty())) {
    return base::fail(Code::Conflict, "there is no home to return to");
  }
  const auto to = refuge();
  if (!to) {
    return base::fail(Code::Conflict,
                      "neither home nor a rally point can be reached straight inside the fence");
  }
  take_over(Mode::Rtl, asker);
  homeward.begin(std::span(&*to, 1), vehicle(), false);
  begin_activity("return");
  activity.goal = estimator.frame()->to_global(*to);
  return {};
}

base::Result<void> Robot::Impl::enter_retrace() {
  if (auto ok = may_drive_by_itself(); !ok) return ok;
  if (mode == Mode::SmartRtl) return {};
  if (crumbs.size() == 0) {
    return base::fail(Code::Conflict,
                      "the way from home is not known: it is kept from arming on, "
                      "where the position is certain enough");
  }
  if (const double gap_m = crumbs.longest_gap_m(); gap_m > kLongGap_m) {
    return base::fail(Code::Conflict, "the driven way is not known over " + metres(gap_m));
  }
  std::vector<base::EnuPoint> way = crumbs.way_back();
  const auto h = home_point();
  if (h && base::distance_m(way.back(), *h) <= kSameHome_m) way.back() = *h;
  base::EnuPoint from = pose->at;
  for (const base::EnuPoint& p : way) {
    if (fence && fence->limits.crosses(from, p)) {
      return base::fail(Code::Conflict, "the driven way leaves the fence");
    }
    from = p;
  }
  take_over(Mode::SmartRtl, asker);
  homeward.begin(way, vehicle(), true);
  begin_activity("retrace");
  activity.goal = estimator.frame()->to_global(way.back());
  return {};
}

void Robot::Impl::drop_crumbs() {
  crumbs.clear();
  crumbs.use(config->modes.crumb_m);
}

}  // namespace roverd::robot
