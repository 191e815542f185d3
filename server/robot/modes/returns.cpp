// The ways home: RTL and SMART_RTL.

#include "robot/impl.hpp"

namespace roverd::robot {
namespace {

using base::Code;

}  // namespace

WayHome Robot::Impl::way_home(Mode mode) const {
  const WayHomeFacts facts{pose->at, home_point(), fence.get(), way_margin_m()};
  if (mode == Mode::Rtl) return straight_home(facts);
  return driven_home(facts, driven.way(estimator.frame()->id()));
}

base::Result<void> Robot::Impl::enter_home(Mode to) {
  if (auto ok = may_drive_by_itself(true); !ok) return ok;
  if (machine.mode() == to) return go_on();
  const WayHome found = way_home(to);
  if (!found.refusal.empty()) return base::fail(Code::Conflict, found.refusal);
  begin_home(ModeCause::Chosen, to, found, asker);
  return {};
}

void Robot::Impl::begin_home(ModeCause cause, Mode to, const WayHome& found,
                             const std::string& why) {
  change_mode(cause, why, to);
  self_driving.go_home(found.way, to == Mode::SmartRtl, vehicle(),
                       estimator.frame()->to_global(found.way.back()), found.length_m(pose->at));
}

/// A failsafe asks for it. Where there is no way home the robot stays where it is.
void Robot::Impl::go_back(const std::string& why) {
  const bool was_auto = machine.mode() == Mode::Auto;
  WayHome found;
  found.refusal = "the position is not known";
  if (pose) found = way_home(Mode::Rtl);
  if (!found.refusal.empty()) {
    const std::string both = why + ", and there is no way home: " + found.refusal;
    hold(both);
    event(base::Severity::Warning, was_auto ? "mission_paused" : "stopped", both);
    return;
  }
  begin_home(ModeCause::Return, Mode::Rtl, found, why);
  if (was_auto) event(base::Severity::Warning, "mission_paused", why);
  event(base::Severity::Warning, "returns", "the robot returns home: " + why);
}

/// What RTL or SMART_RTL would do now, by the same rules.
base::Result<WayHomePreview> Robot::way_home(base::Mode mode) const {
  if (mode != base::Mode::Rtl && mode != base::Mode::SmartRtl) {
    return base::fail(Code::Invalid, "only RTL and SMART_RTL lead home");
  }
  WayHomePreview out;
  const auto state = impl_->snapshot.get();
  if (!state || !state->pose || !state->frame) {
    out.reason = "the position is not known";
    return out;
  }
  const base::LocalFrame& frame = *state->frame;
  WayHomeFacts facts;
  facts.here = state->pose->at;
  const bool near =
      state->home &&
      base::distance_bearing(frame.origin(), *state->home).distance_m <= base::LocalFrame::kReach_m;
  if (near) facts.home = frame.to_local(*state->home);
  const auto fence = impl_->shared_fence.get();
  if (fence && fence->frame_id == frame.id()) facts.fence = fence.get();
  facts.margin_m = impl_->shared_config.get()->kept_fence().margin_m + kFenceAllowance_m;
  const auto driven = impl_->shared_way.get();
  const bool known = driven && driven->frame_id == frame.id();
  const WayHome found = mode == base::Mode::Rtl ? straight_home(facts)
                                                : driven_home(facts, known ? *driven : DrivenWay{});
  // What forbids any drive comes first: the way may be all right.
  out.reason = state->autonomy_refusal.empty() ? found.refusal : state->autonomy_refusal;
  out.possible = out.reason.empty();
  if (found.way.empty()) return out;
  out.end = to_string(found.end);
  out.target = frame.to_global(found.way.back());
  out.distance_m = found.length_m(facts.here);
  out.line.reserve(found.way.size() + 1);
  out.line.push_back(state->pose->global);
  for (const base::EnuPoint& p : found.way) out.line.push_back(frame.to_global(p));
  return out;
}

void Robot::Impl::lay_way() {
  const bool wheels_turn = world.motion && world.motion->twist != base::BodyTwist{};
  driven.lay(*pose, arm.armed(), wheels_turn, estimator.health().resets, fence.get());
}

void Robot::Impl::begin_way_anew() {
  driven.begin_anew(config->modes.crumb_m);
}

}  // namespace roverd::robot
