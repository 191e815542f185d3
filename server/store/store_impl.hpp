#pragma once
// The store's queue and its thread, for the files that put calls into it.

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "store/database.hpp"
#include "store/fences.hpp"
#include "store/folder_watch.hpp"
#include "store/missions.hpp"
#include "store/runs.hpp"
#include "store/store.hpp"

namespace roverd::store {

/// Everything under `mutex` is touched by many threads, the rest by the store's thread alone.
struct Store::Impl {
  std::unique_ptr<Database> db;
  Options options;
  Missions missions{db->connection};
  Fences fences{db->connection};
  Runs runs{db->connection};

  std::mutex mutex;  // leaf
  std::condition_variable news;
  std::deque<std::function<void()>> jobs;
  std::vector<base::Event> events;
  std::vector<people::Deed> deeds;
  bool closing = false;
  std::atomic<std::uint64_t> lost_events{0};
  std::atomic<std::uint64_t> lost_deeds{0};  ///< since it was told
  /// After so many rows it is looked whether the oldest must go.
  static constexpr std::size_t kCutEvery = 1000;
  std::size_t deeds_since_cut = kCutEvery;  ///< store's thread; at first they are counted
  StorageState storage{};                   ///< under the mutex
  struct {
    int runs = 0;
    std::int64_t bytes = 0;
    std::int64_t first = 0;  ///< ids
    std::int64_t last = 0;
  } tidied{};  ///< since it was told; store's thread
  std::thread thread{};

  Impl(std::unique_ptr<Database> database, Options options_);
  ~Impl();
  /// What was deleted too long ago. If that fails it stays until the next time.
  void forget();
  /// One step of what age and room demand, so that calls are served in between.
  /// @return there may be more to do
  bool tidy();
  void tell_tidied();
  void close_runs();
  void run();
  /// How the disk is; after a failure it tries whether a change would be kept again.
  void look();
  void set_trouble(std::string trouble);
  /// Runs `work` where it can be kept: a file that is gone takes every change, and loses it.
  template <class Work>
  auto kept(Work&& work) -> decltype(work()) {
    if (std::string gone = db->place.gone(); !gone.empty()) return not_kept(std::move(gone));
    const int before = db->connection.getTotalChanges();
    auto result = guarded(work);
    if (!result) {
      if (is_trouble(result.error())) set_trouble(result.error().detail);
    } else if (db->connection.getTotalChanges() != before) {
      if (std::string gone = db->place.gone(); !gone.empty()) return not_kept(std::move(gone));
      set_trouble({});
    }
    return result;
  }
  tl::unexpected<base::Error> not_kept(std::string gone);
  static bool is_trouble(const base::Error& error) noexcept;
  void write(const std::vector<base::Event>& list);
  void write_deeds(const std::vector<people::Deed>& list);

  template <class T>
  void answer(const Deliver& deliver, Reply<T> reply, base::Result<T> result) {
    // Shared, because std::function wants copies and a plan may be large.
    auto kept = std::make_shared<base::Result<T>>(std::move(result));
    deliver([reply = std::move(reply), kept = std::move(kept)] { reply(std::move(*kept)); });
  }

  /// Queues `work` (called as work() on the store's thread, gives base::Result<T>).
  template <class T, class Work>
  void ask(const Deliver& deliver, Reply<T> reply, Work work) {
    {
      std::lock_guard lock(mutex);
      if (jobs.size() < options.queue) {
        jobs.push_back([this, deliver, reply = std::move(reply), work = std::move(work)]() mutable {
          answer(deliver, std::move(reply), kept([&]() -> base::Result<T> { return work(); }));
        });
        news.notify_one();
        return;
      }
    }
    answer<T>(
        deliver, std::move(reply),
        base::fail(base::Code::Unavailable, "the store is busy: its queue of " +
                                                std::to_string(options.queue) + " calls is full"));
  }
};

}  // namespace roverd::store
