// The ways home: RTL and SMART_RTL.

#include "robot/impl.hpp"

namespace roverd::robot {
namespace {

using base::Code;

}  // namespace

WayHomeFacts Robot::Impl::way_home_facts() const {
  return {pose->at, home_point(), fence.get(), config->kept_fence().margin_m + kFenceAllowance_m};
}

DrivenWay Robot::Impl::driven() const {
  return {estimator.frame() ? estimator.frame()->id() : 0, crumbs.way_back(),
          crumbs.longest_gap_m()};
}

void Robot::Impl::begin_return(Mode to, const WayHome& home_way, std::string_view kind) {
  take_over(to, asker);
  homeward.begin(home_way.way, vehicle(), to == Mode::SmartRtl);
  begin_activity(kind);
  activity.goal = estimator.frame()->to_global(home_way.way.back());
  activity.distance_m = home_way.length_m(pose->at);
}

base::Result<void> Robot::Impl::enter_return() {
  if (auto ok = may_drive_by_itself(); !ok) return ok;
  if (mode == Mode::Rtl) return held.waits() ? handle(ResumeActivity{}) : base::Result<void>{};
  const WayHome found = straight_home(way_home_facts());
  if (!found.refusal.empty()) return base::fail(Code::Conflict, found.refusal);
  begin_return(Mode::Rtl, found, "return");
  return {};
}

base::Result<void> Robot::Impl::enter_retrace() {
  if (auto ok = may_drive_by_itself(); !ok) return ok;
  if (mode == Mode::SmartRtl) return held.waits() ? handle(ResumeActivity{}) : base::Result<void>{};
  const WayHome found = driven_home(way_home_facts(), driven());
  if (!found.refusal.empty()) return base::fail(Code::Conflict, found.refusal);
  begin_return(Mode::SmartRtl, found, "retrace");
  return {};
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
  const auto driven = impl_->driven_way.get();
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

void Robot::Impl::drop_crumbs() {
  crumbs.clear();
  crumbs.use(config->modes.crumb_m);
}

}  // namespace roverd::robot
