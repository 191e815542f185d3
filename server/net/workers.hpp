#pragma once
// Threads beside the web thread, for what would hold it up: reading and writing large files, plans,
// reports. Three lanes, so that a small thing never waits behind a large one, nor that behind one
// of tens of megabytes, which takes seconds; each is bounded. They run below the web's and the
// control loop's priority.
//
//   web ─run─▶ lane (bounded) ─▶ work, on a thread of the lane ─post─▶ then, on the web thread
//
// What `work` holds is destroyed on the lane's thread: to free a hundred thousand items takes
// longer than the web may be kept.

#include <array>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include <boost/asio/io_context.hpp>

namespace roverd::net {

/// Slow: one at once, for what takes seconds and hundreds of megabytes.
enum class Lane { Small, Large, Slow };

class Workers {
 public:
  /// So many may wait in a lane, besides those at work.
  static constexpr std::size_t kSmallWaiting = 64;
  static constexpr std::size_t kLargeWaiting = 8;
  static constexpr std::size_t kSlowWaiting = 8;

  explicit Workers(boost::asio::io_context& web);
  /// Ends the threads after what they are at; what waits is dropped.
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// Any thread. @param then may be empty. @return false: the lane is full; nothing was taken.
  bool run(Lane lane, std::function<void()> work, std::function<void()> then);
  /// Any thread. Never refused: for the answer to what was done already, and for what is only to be
  /// freed.
  void must_run(Lane lane, std::function<void()> work, std::function<void()> then);
  /// Any thread. How many of a lane wait to be begun.
  [[nodiscard]] std::size_t waiting(Lane lane) const;
  /// How many large things are done at once.
  static unsigned large_at_once();
  /// Waits for what is at work, and drops the rest. Idempotent.
  void stop();

 private:
  struct Job {
    std::function<void()> work;
    std::function<void()> then;
  };
  struct Queue {
    std::deque<Job> jobs;
    std::condition_variable news;
    std::size_t most = 0;
  };

  static std::size_t place(Lane lane) { return static_cast<std::size_t>(lane); }
  Queue& queue(Lane lane) { return queues_[place(lane)]; }
  bool put(Lane lane, Job job, bool must);
  void serve(Queue& queue, int niceness) noexcept;
  using Shared = std::shared_ptr<std::function<void()>>;
  bool hand_over(std::function<void()>& then, Shared& shared) noexcept;

  boost::asio::io_context& web_;
  mutable std::mutex mutex_;  // leaf
  std::array<Queue, 3> queues_;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace roverd::net
