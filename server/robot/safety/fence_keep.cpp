#include "robot/safety/fence_keep.hpp"

#include <cmath>

namespace roverd::robot {
namespace {

using base::Code;

constexpr std::size_t kMostHomeEnds = 100;

}  // namespace

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

base::Result<void> FenceKeep::mission_inside(const CompiledMission& mission, const nav::StartAt& at,
                                             const Start& start) const {
  if (!fence_) return {};
  if (!compared(&mission)) {
    return base::fail(
        Code::Conflict,
        "fence and mission came at the same moment and are being compared: try again");
  }
  const std::string& objection =
      mission.fence_id == fence_->id ? mission.fence_objection : fence_->objection;
  if (!objection.empty()) return base::fail(Code::Conflict, objection);
  if (auto ok = ways_home_inside(mission, start); !ok) return ok;
  const std::size_t step = nav::first_step(mission.route, at, start.here);
  const auto target = nav::first_target(mission.route, step, start.home);
  if (target && !inside(start.here, *target, start.margin_m)) {
    return base::fail(Code::Conflict, "the way to the first point leaves the fence");
  }
  return {};
}

/// Home may have been set anew since the mission was compared with the fence.
base::Result<void> FenceKeep::ways_home_inside(const CompiledMission& mission,
                                               const Start& start) const {
  const std::vector<base::EnuPoint>& ends = mission.route.home_ends;
  if (!start.home || ends.empty()) return {};
  if (ends.size() > kMostHomeEnds) {
    return base::fail(Code::Conflict, "the mission drives home more than " +
                                          std::to_string(kMostHomeEnds) +
                                          " times: too often to be compared with the fence");
  }
  for (const base::EnuPoint& end : ends) {
    if (fence_->limits.clearance_m(end, *start.home) < start.margin_m) {
      return base::fail(Code::Conflict, "the mission's way home leaves the fence");
    }
  }
  return {};
}

bool FenceKeep::compared(const CompiledMission* mission) const noexcept {
  return !fence_ || mission == nullptr || mission->fence_id == fence_->id ||
         fence_->mission_id == mission->id;
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
          is_laid ? "the fence is reached: only the way back inside is open"
                  : "the fence is not laid out in the robot's map"};
}

base::FenceState FenceKeep::state(const std::optional<base::Pose>& pose,
                                  const std::optional<base::LocalFrame>& frame,
                                  const CompiledMission* mission) const {
  base::FenceState s;
  s.name = fence_->fence->name;
  if (!frame || frame->id() != fence_->frame_id || !pose) return s;
  const double clear_m = fence_->limits.clearance_m(pose->at);
  s.inside = clear_m > 0.0;
  if (std::isfinite(clear_m)) s.distance_m = clear_m;
  s.compared = compared(mission);
  return s;
}

}  // namespace roverd::robot
