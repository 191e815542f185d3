#pragma once
// Which fence holds, as the robot is to know it: laid out in its map, and again when that begins or
// another fence is chosen. The services' thread.

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "base/snapshot.hpp"
#include "robot/robot.hpp"

namespace roverd::services {

class FenceKeeper {
 public:
  explicit FenceKeeper(robot::Robot& robot) : robot_(robot) {}

  /// From now on. @param fence null: none. @param held called once it holds, on the thread that
  /// hands out the robot's answers; what was chosen before it and does not hold yet never will
  void use(std::shared_ptr<const mission::Fence> fence, robot::Reply held) {
    fence_ = std::move(fence);
    if (held_) held_(base::fail(base::Code::Conflict, "another fence was chosen meanwhile"));
    held_ = std::move(held);
    due_ = true;
    lay();
  }
  /// Every sample: lays it out when the robot's map has begun, when a mission was loaded at the
  /// same moment and neither was compared with the other, or when there was no room before.
  void look(const base::Snapshot& s) {
    const std::uint32_t frame = s.frame ? s.frame->id() : 0;
    if (fence_ && (frame != frame_ || (s.fence && !s.fence->compared))) due_ = true;
    frame_ = frame;
    if (due_) lay();
  }
  const std::shared_ptr<const mission::Fence>& fence() const noexcept { return fence_; }

 private:
  void lay() {
    due_ = !robot_.request(robot::SetFence{robot_.lay_fence(fence_)}, base::Time::max(), held_);
    if (!due_) held_ = nullptr;
  }

  robot::Robot& robot_;
  std::shared_ptr<const mission::Fence> fence_;
  robot::Reply held_;  ///< waits for room
  std::uint32_t frame_ = 0;
  bool due_ = false;
};

}  // namespace roverd::services
