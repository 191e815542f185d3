#pragma once
// The way of a loaded mission was laid out by the parameters of that moment. When some of them
// change it is laid out anew, as soon as the mission is not in hand; while it is, it stays as it
// is. The services' thread.

#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "base/snapshot.hpp"
#include "robot/robot.hpp"

namespace roverd::services {

class WayKeeper {
 public:
  using Done = std::function<void(base::Result<void>)>;

  explicit WayKeeper(robot::Robot& robot) : robot_(robot) {}

  /// Now. @param done what the robot did, on the thread that hands out its answers; at once if
  /// there is nothing to lay out
  void lay(const Done& done) {
    const auto mission = robot_.loaded();
    if (!mission) return done({});
    auto compiled = robot_.compile(*mission);
    if (!compiled) return done(tl::unexpected(std::move(compiled.error())));
    if (robot_.request(robot::LayAnew{std::move(*compiled)}, base::Time::max(), done)) return;
    done(base::fail(base::Code::Unavailable, "too many commands wait for the robot"));
  }

  /// Every sample.
  void look(const base::Snapshot& s) {
    using State = base::ExecutionState;
    const State state = s.mission.state;
    const bool in_hand =
        state == State::Running || state == State::Paused || state == State::Blocked;
    if (!s.mission.laid_by_old || in_hand) return;
    if (tried_ && s.now - *tried_ < kAgain) return;
    tried_ = s.now;
    lay([](const base::Result<void>&) {});  // if it was not done, the next try does it
  }

 private:
  static constexpr base::Duration kAgain = std::chrono::seconds(1);

  robot::Robot& robot_;
  std::optional<base::Time> tried_;
};

}  // namespace roverd::services
