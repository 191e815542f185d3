#include "services/desk.hpp"

#include <exception>
#include <utility>

#include "base/log.hpp"

namespace roverd::services {
namespace {

void done_safely(const Desk::Work& work) {
  try {
    work();
  } catch (const std::exception& bug) {
    base::log(base::Level::Error, "services", "work failed", {{"what", bug.what()}});
  }
}

}  // namespace

Desk::Desk() : pile_(std::make_shared<Pile>()) {}

Desk::~Desk() {
  stop();
}

void Desk::start(base::Duration period, Work beat) {
  thread_ = std::thread([this, period, beat = std::move(beat)] { run(period, beat); });
}

void Desk::stop() {
  std::deque<Work> dropped;  // freed outside the lock: what it holds may post
  {
    std::lock_guard lock(pile_->mutex);
    pile_->closed = true;
    dropped.swap(pile_->works);
  }
  pile_->news.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Desk::put(Pile& pile, Work work) {
  {
    std::lock_guard lock(pile.mutex);
    if (pile.closed) return;
    pile.works.push_back(std::move(work));
  }
  pile.news.notify_one();
}

Desk::Poster Desk::poster() const {
  return [pile = pile_](Work work) { put(*pile, std::move(work)); };
}

void Desk::run(base::Duration period, const Work& beat) {
  auto next = std::chrono::steady_clock::now() + period;
  std::unique_lock lock(pile_->mutex);
  while (!pile_->closed) {
    pile_->news.wait_until(lock, next, [&] { return pile_->closed || !pile_->works.empty(); });
    if (pile_->closed) return;
    Work work;
    const bool beats = std::chrono::steady_clock::now() >= next;  // also when work never ends
    if (!beats) {
      if (pile_->works.empty()) continue;
      work = std::move(pile_->works.front());
      pile_->works.pop_front();
    }
    lock.unlock();
    done_safely(beats ? beat : work);
    work = nullptr;
    if (beats) next = std::chrono::steady_clock::now() + period;
    lock.lock();
  }
}

}  // namespace roverd::services
