#pragma once
// Which fence holds, as the robot is to know it: laid out in its map, and again when that begins or
// another fence is chosen. What else is to be kept out of (the forbidden areas of a map) counts as
// a part of the fence, and is one where none is chosen. The services' thread.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/snapshot.hpp"
#include "mission/fence/fence.hpp"
#include "robot/robot.hpp"

namespace roverd::services {

class FenceKeeper {
 public:
  explicit FenceKeeper(robot::Robot& robot) : robot_(robot) {}

  /// From now on. @param fence null: none. @param held called once it holds, on the thread that
  /// hands out the robot's answers; what was chosen before it and does not hold yet never will
  void use(std::shared_ptr<const mission::Fence> fence, robot::Reply held) {
    chosen_ = std::move(fence);
    join();
    if (held_) held_(base::fail(base::Code::Conflict, "another fence was chosen meanwhile"));
    held_ = std::move(held);
    due_ = true;
    lay();
  }
  /// From now on, beside the fence. @param areas exclusions, each as check_fence wants them; empty:
  /// nothing. @param name of the fence that they are where none is chosen
  void keep_out(std::vector<mission::FenceArea> areas, std::string name) {
    if (areas == keep_out_ && (areas.empty() || name == name_)) return;
    keep_out_ = std::move(areas);
    name_ = std::move(name);
    join();
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
  /// All that holds; null: nothing does.
  const std::shared_ptr<const mission::Fence>& fence() const noexcept { return fence_; }
  /// Any thread. Of what is to be kept out of: areas that do not hold, for with those of the chosen
  /// fence they are more than a fence may have.
  std::size_t left_out() const noexcept { return left_out_; }

 private:
  void join() {
    fence_ = chosen_;
    left_out_ = 0;
    if (keep_out_.empty()) return;
    auto all = std::make_shared<mission::Fence>();
    if (chosen_) *all = *chosen_;
    if (!chosen_) all->name = name_;
    std::size_t corners = 0;
    for (const mission::FenceArea& area : all->areas) corners += corners_of(area);
    std::size_t left_out = 0;
    for (const mission::FenceArea& area : keep_out_) {
      const std::size_t more = corners_of(area);
      if (all->areas.size() == mission::kMaxAreas || corners + more > mission::kMaxFencePoints) {
        ++left_out;
        continue;
      }
      corners += more;
      all->areas.push_back(area);
    }
    left_out_ = left_out;
    fence_ = std::move(all);
  }
  static std::size_t corners_of(const mission::FenceArea& area) {
    const auto* polygon = std::get_if<mission::FencePolygon>(&area.shape);
    return polygon != nullptr ? polygon->points.size() : 0;
  }
  void lay() {
    due_ = !robot_.request(robot::SetFence{robot_.lay_fence(fence_)}, base::Time::max(), held_);
    if (!due_) held_ = nullptr;
  }

  robot::Robot& robot_;
  std::shared_ptr<const mission::Fence> chosen_;
  std::vector<mission::FenceArea> keep_out_;
  std::string name_;
  std::shared_ptr<const mission::Fence> fence_;  ///< both
  robot::Reply held_;                            ///< waits for room
  std::atomic<std::size_t> left_out_{0};
  std::uint32_t frame_ = 0;
  bool due_ = false;
};

}  // namespace roverd::services
