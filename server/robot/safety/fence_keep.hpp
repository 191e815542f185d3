#pragma once
// The fence that holds: what it says before something begins, and at every tick.
//
//   None ──set──▶ Holds ──would not stop inside──▶ Stops ──what is asked leads back──▶ Holds
//
// Inside is asked of a fence that is laid in the robot's frame; one that is not forbids every drive
// without hands. Control thread.

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "base/drive_command.hpp"
#include "nav/behave/executor.hpp"
#include "robot/compile.hpp"
#include "robot/safety/fence_guard.hpp"

namespace roverd::robot {

class FenceKeep {
 public:
  /// @return the one before, for whoever frees it.
  std::shared_ptr<const LaidFence> set(std::shared_ptr<const LaidFence> fence) noexcept {
    told_ = false;
    return std::exchange(fence_, std::move(fence));
  }
  const LaidFence* get() const noexcept { return fence_.get(); }
  const std::shared_ptr<const LaidFence>& shared() const noexcept { return fence_; }
  /// Nothing holds, or it is laid in this frame.
  bool laid(const std::optional<base::LocalFrame>& frame) const noexcept {
    return !fence_ || (frame && frame->id() == fence_->frame_id);
  }

  /// The straight way there. @param margin_m that a way keeps
  base::Result<void> inside(base::EnuPoint from, base::EnuPoint to, double margin_m) const;
  /// May the robot drive by itself from here at all?
  base::Result<void> may_begin(base::EnuPoint here,
                               const std::optional<base::LocalFrame>& frame) const;

  struct Start {
    nav::Stand stand;
    std::optional<base::EnuPoint> home;
    double margin_m = 0.0;
    const nav::PathParams& path;
    const nav::BehaveParams& behave;
  };
  /// Nothing of the list that check, load and preview show (robot/safety/start_check.hpp).
  base::Result<void> may_start(const CompiledMission& mission, const nav::StartAt& at,
                               const Start& start) const;
  /// The comparison with a mission is long and made on other threads. @param mission null: none
  /// @param margin_m Config::way_margin_m as it is now
  bool compared(const CompiledMission* mission, double margin_m) const noexcept;

  struct Verdict {
    bool stops = false;
    bool newly = false;  ///< not told yet
    std::string why;
  };
  /// The last word on a command: what would not stop inside does not leave.
  Verdict judge(const base::BodyTwist& twist, const base::Pose& pose,
                const std::optional<base::LocalFrame>& frame, bool by_hand,
                const FenceParams& params);

  /// The last command that was judged would have crossed it.
  bool stops() const noexcept { return told_; }

  /// A fence holds.
  base::FenceState state(const std::optional<base::Pose>& pose,
                         const std::optional<base::LocalFrame>& frame,
                         const CompiledMission* mission, double margin_m) const;

 private:
  std::shared_ptr<const LaidFence> fence_;
  bool told_ = false;
};

}  // namespace roverd::robot
