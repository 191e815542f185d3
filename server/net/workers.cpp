#include "net/workers.hpp"

#include <algorithm>
#include <utility>

#include <boost/asio/post.hpp>
#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>

namespace roverd::net {

namespace {

constexpr int kSmallNice = 5;
constexpr int kLargeNice = 10;
/// Large things at once: what they hold in memory counts as often.
constexpr unsigned kMostLarge = 4;

/// Behind the web and the control loop wherever they want to run. Not SCHED_IDLE: one that is kept
/// from running for long while it holds the allocator's lock would hold up the web after all.
void step_back(int niceness) noexcept {
  const sched_param none{};
  (void)pthread_setschedparam(pthread_self(), SCHED_BATCH, &none);
  (void)setpriority(PRIO_PROCESS, 0, niceness);  // Linux: of this thread alone
}

}  // namespace

Workers::Workers(boost::asio::io_context& web) : web_(web) {
  queue(Lane::Small).most = kSmallWaiting;
  queue(Lane::Large).most = kLargeWaiting;
  queue(Lane::Slow).most = kSlowWaiting;
  const unsigned large = large_at_once();
  threads_.emplace_back([this] { serve(queue(Lane::Small), kSmallNice); });
  threads_.emplace_back([this] { serve(queue(Lane::Slow), kLargeNice); });
  for (unsigned i = 0; i < large; ++i) {
    threads_.emplace_back([this] { serve(queue(Lane::Large), kLargeNice); });
  }
}

unsigned Workers::large_at_once() {
  return std::clamp(std::thread::hardware_concurrency() / 4, 1U, kMostLarge);
}

std::size_t Workers::waiting(Lane lane) const {
  std::lock_guard lock(mutex_);
  return queues_[place(lane)].jobs.size();
}

Workers::~Workers() {
  stop();
}

bool Workers::put(Lane lane, Job job, bool must) {
  Queue& to = queue(lane);
  {
    std::lock_guard lock(mutex_);
    if (stopping_) return true;  // dropped, as all that waits
    if (!must && to.jobs.size() >= to.most) return false;
    to.jobs.push_back(std::move(job));
  }
  to.news.notify_one();
  return true;
}

bool Workers::run(Lane lane, std::function<void()> work, std::function<void()> then) {
  return put(lane, {std::move(work), std::move(then)}, false);
}

void Workers::must_run(Lane lane, std::function<void()> work, std::function<void()> then) {
  put(lane, {std::move(work), std::move(then)}, true);
}

/// What it holds is let go on the web thread, too: what is left here is empty then.
bool Workers::hand_over(std::function<void()>& then, Shared& shared) noexcept {
  try {
    if (!shared) shared = std::make_shared<std::function<void()>>(std::move(then));
    boost::asio::post(web_, [shared] {
      const auto call = std::exchange(*shared, nullptr);
      call();
    });
    return true;
  } catch (...) {
    return false;
  }
}

void Workers::serve(Queue& queue, int niceness) noexcept {
  pthread_setname_np(pthread_self(), "worker");
  step_back(niceness);
  std::unique_lock lock(mutex_);
  while (true) {
    queue.news.wait(lock, [&] { return stopping_ || !queue.jobs.empty(); });
    if (stopping_) return;
    Job job = std::move(queue.jobs.front());
    queue.jobs.pop_front();
    lock.unlock();
    try {
      job.work();
    } catch (...) {
      // No room for it: `then` finds nothing done.
    }
    job.work = nullptr;  // here, not on the web thread
    Shared shared;
    while ((job.then || shared) && !hand_over(job.then, shared)) {  // memory comes back
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    job = {};
    lock.lock();
  }
}

void Workers::stop() {
  std::deque<Job> dropped;
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;
    for (Queue& q : queues_) {
      std::move(q.jobs.begin(), q.jobs.end(), std::back_inserter(dropped));
      q.jobs.clear();
    }
  }
  for (Queue& q : queues_) q.news.notify_all();
  for (std::thread& thread : threads_) {
    if (thread.joinable()) thread.join();
  }
}

}  // namespace roverd::net
