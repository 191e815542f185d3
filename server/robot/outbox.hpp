#pragma once
// What waits to leave the control thread. Nothing is lost because a reader holds a lock for a
// moment; what does not fit stays for the next tick. Replies are as many as commands were taken;
// events beyond 256 drop the oldest, and that is counted.

#include <cstdint>
#include <deque>
#include <string>
#include <utility>

#include "base/inbox.hpp"
#include "base/snapshot.hpp"
#include "robot/robot.hpp"

namespace roverd::robot {

class Outbox {
 public:
  static constexpr std::size_t kEvents = 256;
  /// So many answers waiting: nobody drains them; no more commands are taken.
  static constexpr std::size_t kReplies = 256;
  static constexpr std::size_t kEdits = 16;

  base::Inbox<PendingReply> replies{1024};
  base::Inbox<base::Event> events{1024};
  base::Inbox<MissionEdit> edits{64};
  base::Inbox<TeachWish> wishes{64};

  void reply(Reply to, base::Result<void> result, std::shared_ptr<const void> left = nullptr) {
    if (to || left) {
      waiting_replies_.push_back({std::move(to), std::move(result), std::move(left)});
    }
  }

  void event(base::WallTime wall, base::Severity level, const char* kind, std::string detail) {
    if (waiting_events_.size() >= kEvents) {
      waiting_events_.pop_front();
      ++dropped_;
    }
    waiting_events_.push_back({wall, level, kind, std::move(detail)});
  }

  /// @return false: too many wait.
  bool edit(MissionEdit edit) {
    if (waiting_edits_.size() >= kEdits) return false;
    waiting_edits_.push_back(std::move(edit));
    return true;
  }

  /// @return false: too many wait.
  bool teach(TeachWish wish) {
    if (waiting_wishes_.size() >= kEdits) return false;
    waiting_wishes_.push_back(wish);
    return true;
  }

  bool full() const noexcept { return waiting_replies_.size() >= kReplies; }

  /// @return true if something was handed over.
  bool flush() {
    bool any = false;
    while (!waiting_replies_.empty() && replies.try_offer(waiting_replies_.front())) {
      waiting_replies_.pop_front();
      any = true;
    }
    while (!waiting_events_.empty() && events.try_offer(waiting_events_.front())) {
      waiting_events_.pop_front();
      any = true;
    }
    while (!waiting_edits_.empty() && edits.try_offer(waiting_edits_.front())) {
      waiting_edits_.pop_front();
      any = true;
    }
    while (!waiting_wishes_.empty() && wishes.try_offer(waiting_wishes_.front())) {
      waiting_wishes_.pop_front();
      any = true;
    }
    return any;
  }

  std::uint64_t dropped() const noexcept { return dropped_; }

 private:
  std::deque<PendingReply> waiting_replies_;
  std::deque<base::Event> waiting_events_;
  std::deque<MissionEdit> waiting_edits_;
  std::deque<TeachWish> waiting_wishes_;
  std::uint64_t dropped_ = 0;
};

}  // namespace roverd::robot
