// What the fence says: before something begins, and at every tick.

#include <cmath>
#include <utility>

#include "robot/impl.hpp"

namespace roverd::robot {
namespace {

using base::Code;
using base::Driver;
using base::Severity;

constexpr std::size_t kMostHomeEnds = 100;

}  // namespace

/// The straight way there, against the fence.
base::Result<void> Robot::Impl::inside(base::EnuPoint to) const {
  if (!fence) return {};
  const double margin_m = config->kept_fence().margin_m + kFenceAllowance_m;
  if (may_drive(fence->limits, pose->at, to, margin_m)) return {};
  return base::fail(Code::Conflict, "the way there leaves the fence");
}

base::Result<void> Robot::Impl::mission_inside(const nav::StartAt& at) const {
  if (!fence) return {};
  if (!compared()) {
    return base::fail(
        Code::Conflict,
        "fence and mission came at the same moment and are being compared: try again");
  }
  const std::string& objection =
      mission->fence_id == fence->id ? mission->fence_objection : fence->objection;
  if (!objection.empty()) return base::fail(Code::Conflict, objection);
  if (auto ok = way_home_inside(); !ok) return ok;
  const std::size_t step = nav::first_step(mission->route, at, pose->at);
  const auto target = nav::first_target(mission->route, step, home_point());
  if (target && !inside(*target)) {
    return base::fail(Code::Conflict, "the way to the first point leaves the fence");
  }
  return {};
}

/// The comparison is long and made on other threads; whoever keeps the fence sees in the snapshot
/// that it is due.
bool Robot::Impl::compared() const noexcept {
  return !fence || !mission || mission->fence_id == fence->id || fence->mission_id == mission->id;
}

/// Home may have been set anew since the mission was compared with the fence.
base::Result<void> Robot::Impl::way_home_inside() const {
  const auto to = home_point();
  const std::vector<base::EnuPoint>& ends = mission->route.home_ends;
  if (!to || ends.empty()) return {};
  if (ends.size() > kMostHomeEnds) {
    return base::fail(Code::Conflict, "the mission drives home more than " +
                                          std::to_string(kMostHomeEnds) +
                                          " times: too often to be compared with the fence");
  }
  const double margin_m = config->kept_fence().margin_m + kFenceAllowance_m;
  for (const base::EnuPoint& end : ends) {
    if (fence->limits.clearance_m(end, *to) < margin_m) {
      return base::fail(Code::Conflict, "the mission's way home leaves the fence");
    }
  }
  return {};
}

base::Result<void> Robot::Impl::handle(const SetFence& c) {
  retire(std::exchange(fence, c.fence));
  fence_unpublished = true;
  fence_told = false;
  event(Severity::Info, "fence_set",
        fence ? "fence \"" + fence->fence->name + "\" holds" : std::string("no fence holds"));
  return {};
}

base::FenceState Robot::Impl::fence_state() const {
  base::FenceState s;
  s.name = fence->fence->name;
  const bool laid = estimator.frame() && estimator.frame()->id() == fence->frame_id;
  if (!laid || !pose) return s;
  const double clear_m = fence->limits.clearance_m(pose->at);
  s.inside = clear_m > 0.0;
  if (std::isfinite(clear_m)) s.distance_m = clear_m;
  s.compared = compared();
  return s;
}

/// The last word: what would not stop inside the fence does not leave.
base::DriveCommand Robot::Impl::keep_inside(base::DriveCommand command) {
  fence_stops = false;
  if (!fence || !pose || command.twist.linear_mps == 0.0) return command;
  const bool laid = estimator.frame() && estimator.frame()->id() == fence->frame_id;
  base::BodyTwist twist = command.twist;
  const double driven = pose->speed_mps.value_or(0.0);
  if (driven * twist.linear_mps > 0.0 && std::abs(driven) > std::abs(twist.linear_mps)) {
    twist.linear_mps = driven;
  }
  const bool by_hand = !by_itself();
  if (laid ? may_move(fence->limits, *pose, twist, by_hand, config->kept_fence()) : by_hand) {
    fence_told = false;
    return command;
  }
  fence_stops = true;
  const std::string why = laid ? "the fence is reached: only the way back inside is open"
                               : "the fence is not laid out in the robot's map";
  assessment.conditions.push_back({"fence", why});
  if (!fence_told) event(Severity::Warning, "fence", why);
  fence_told = true;
  speed_reason = "fence";
  if (!by_hand) {
    const bool mission_ran = mode == Mode::Auto;
    hold(why);
    if (mission_ran) event(Severity::Warning, "mission_paused", why);
    driver = Driver::None;
  }
  command.twist = {};
  return command;
}

}  // namespace roverd::robot
