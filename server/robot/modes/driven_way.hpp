#pragma once
// The way that was driven since the first arming, for SMART_RTL and for those who ask where it
// leads.
//
//   nothing ──armed──▶ laid: every tick that is armed, and disarmed while the wheels turn
//                        │ home moves on purpose
//                        └──▶ nothing, and laid anew from there
//
// A robot that is carried lays none; the piece that it misses is a gap. Control thread.

#include <cstdint>
#include <memory>
#include <utility>

#include "base/snapshot.hpp"
#include "nav/behave/breadcrumbs.hpp"
#include "robot/modes/way_home.hpp"

namespace roverd::robot {

class DrivenWayKeeper {
 public:
  explicit DrivenWayKeeper(double accuracy_m) : crumbs_(accuracy_m) {}

  /// From here on; @param accuracy_m holds from now on.
  void begin_anew(double accuracy_m) noexcept {
    crumbs_.clear();
    crumbs_.use(accuracy_m);
  }

  /// Once a tick. @param resets of the estimate so far. @param fence null: none
  void lay(const base::Pose& pose, bool armed, bool wheels_turn, std::uint64_t resets,
           const LaidFence* fence) {
    if (!armed && !(crumbs_.size() > 0 && wheels_turn)) return;
    const bool jumped = resets != resets_;
    resets_ = resets;
    crumbs_.take(pose.at, pose.horizontal_sigma_m, jumped,
                 [fence](base::EnuPoint a, base::EnuPoint b) {
                   return fence == nullptr || !fence->limits.crosses(a, b);
                 });
  }

  DrivenWay way(std::uint32_t frame_id) const {
    return {frame_id, crumbs_.way_back(), crumbs_.longest_gap_m()};
  }

  /// Null: whoever asks knows it already. @param told kept by him
  std::shared_ptr<const DrivenWay> news(std::uint64_t& told, std::uint32_t frame_id) const {
    if (crumbs_.changes() == told) return nullptr;
    told = crumbs_.changes();
    DrivenWay news{frame_id, {}, crumbs_.longest_gap_m()};
    news.crumbs = crumbs_.crumbs();
    news.accuracy_m = crumbs_.accuracy_m();
    return std::make_shared<const DrivenWay>(std::move(news));
  }

 private:
  nav::Breadcrumbs crumbs_;
  std::uint64_t resets_ = 0;
};

}  // namespace roverd::robot
