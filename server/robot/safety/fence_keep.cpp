#include "robot/safety/fence_keep.hpp"

#include <cmath>
#include <vector>

#include "robot/safety/start_check.hpp"

namespace roverd::robot {
namespace {

using base::Code;

}  // namespace

const std::optional<mission::Finding>* legs_of(const CompiledMission& mission,
                                               const LaidFence& fence, double margin_m) noexcept {
  if (mission.fence_id == fence.id && mission.fence_margin_m == margin_m) {
    return &mission.fence_objection;
  }
  const bool known = fence.mission_id == mission.id && fence.margin_m == margin_m;
  return known ? &fence.objection : nullptr;
}

base::Result<void> FenceKeep::inside(base::EnuPoint from, base::EnuPoint to,
                                     double margin_m) const {
  if (!fence_ || may_drive(fence_->limits, from, to, margin_m)) return {};
  return base::fail(Code::Conflict, "the way there leaves the fence");
}

base::Result<void> FenceKeep::may_begin(base::EnuPoint here,
                                        const std::optional<base::LocalFrame>& frame) const {
  if (!laid(frame)) {
    return base::fail(Code::Conflict,
                      "the fence is not laid out in the robot's map yet: try again");
  }
  if (fence_ && !(fence_->limits.clearance_m(here) > 0.0)) {
    return base::fail(Code::Conflict,
                      "the robot stands outside of the fence: drive it back by hand");
  }
  return {};
}

base::Result<void> FenceKeep::may_start(const CompiledMission& mission, const nav::StartAt& at,
                                        const Start& start) const {
  if (!compared(&mission, start.margin_m)) {
    return base::fail(Code::Conflict, "fence and mission are being compared: try again");
  }
  const std::optional<mission::Finding>* legs = nullptr;
  if (fence_) legs = legs_of(mission, *fence_, start.margin_m);
  const std::vector<mission::Finding> found =
      start_findings({.route = mission.route,
                      .limits = fence_ ? &fence_->limits : nullptr,
                      .legs = legs,
                      .margin_m = start.margin_m,
                      .path = start.path,
                      .behave = start.behave,
                      .stand = start.stand,
                      .home = start.home,
                      .at = at});
  if (found.empty()) return {};
  std::vector<base::FieldError> fields;
  for (const mission::Finding& f : found) fields.push_back({f.pointer, f.detail});
  return base::fail(Code::Conflict, mission::sentence(found.front()), std::move(fields));
}

bool FenceKeep::compared(const CompiledMission* mission, double margin_m) const noexcept {
  return !fence_ || mission == nullptr || legs_of(*mission, *fence_, margin_m) != nullptr;
}

FenceKeep::Verdict FenceKeep::judge(const base::BodyTwist& asked, const base::Pose& pose,
                                    const std::optional<base::LocalFrame>& frame, bool by_hand,
                                    const FenceParams& params) {
  if (!fence_ || asked.linear_mps == 0.0) return {};
  base::BodyTwist twist = asked;
  const double driven_mps = pose.speed_mps.value_or(0.0);
  if (driven_mps * twist.linear_mps > 0.0 && std::abs(driven_mps) > std::abs(twist.linear_mps)) {
    twist.linear_mps = driven_mps;
  }
  const bool is_laid = laid(frame);
  if (is_laid ? may_move(fence_->limits, pose, twist, by_hand, params) : by_hand) {
    told_ = false;
    return {};
  }
  const bool newly = !std::exchange(told_, true);
  return {true, newly,
          is_laid ? "the fence, or an area to keep out of, is reached: only the way back is open"
                  : "the fence is not laid out in the robot's map"};
}

base::FenceState FenceKeep::state(const std::optional<base::Pose>& pose,
                                  const std::optional<base::LocalFrame>& frame,
                                  const CompiledMission* mission, double margin_m) const {
  base::FenceState s;
  s.name = fence_->fence->name;
  if (!frame || frame->id() != fence_->frame_id || !pose) return s;
  const double clear_m = fence_->limits.clearance_m(pose->at);
  s.inside = clear_m > 0.0;
  if (std::isfinite(clear_m)) s.distance_m = clear_m;
  s.compared = compared(mission, margin_m);
  return s;
}

}  // namespace roverd::robot
