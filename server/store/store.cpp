#include "store/store.hpp"

#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

#include "base/log.hpp"
#include "store/database.hpp"
#include "store/events.hpp"
#include "store/fences.hpp"
#include "store/missions.hpp"
#include "store/routes.hpp"
#include "store/teach.hpp"

namespace roverd::store {

using base::Code;
using base::Error;
using base::Result;

/// The queue and the thread. Everything under `mutex` is touched by many threads, the rest by the
/// store's thread alone.
struct Store::Impl {
  std::unique_ptr<Database> db;
  Deliver deliver;
  Options options;
  Missions missions{db->connection};
  Fences fences{db->connection};

  std::mutex mutex;  // leaf
  std::condition_variable news;
  std::deque<std::function<void()>> jobs;
  std::vector<base::Event> events;
  bool closing = false;
  std::atomic<std::uint64_t> lost_events{0};
  std::thread thread{};

  Impl(std::unique_ptr<Database> database, Deliver deliver_, Options options_)
      : db(std::move(database)), deliver(std::move(deliver_)), options(std::move(options_)) {
    thread = std::thread([this] { run(); });
  }

  ~Impl() {
    {
      std::lock_guard lock(mutex);
      closing = true;
    }
    news.notify_one();
    thread.join();
  }

  template <class T>
  void answer(Reply<T> reply, Result<T> result) {
    // Shared, because std::function wants copies and a plan may be large.
    auto kept = std::make_shared<Result<T>>(std::move(result));
    deliver([reply = std::move(reply), kept = std::move(kept)] { reply(std::move(*kept)); });
  }

  /// Queues `work` (called as work() on the store's thread, gives Result<T>).
  template <class T, class Work>
  void ask(Reply<T> reply, Work work) {
    {
      std::lock_guard lock(mutex);
      if (jobs.size() < options.queue) {
        jobs.push_back([this, reply = std::move(reply), work = std::move(work)]() mutable {
          answer(std::move(reply), guarded([&]() -> Result<T> { return work(); }));
        });
        news.notify_one();
        return;
      }
    }
    answer<T>(std::move(reply),
              base::fail(Code::Unavailable, "the store is busy: its queue of " +
                                                std::to_string(options.queue) + " calls is full"));
  }

  /// What was deleted too long ago. If that fails it stays until the next time.
  void forget() {
    const auto done = guarded([&]() -> Result<void> {
      missions.forget_deleted(options.clock() - options.keep_deleted);
      return {};
    });
    static base::LogLimit limit(10.0);
    if (!done && limit.due()) {
      base::log(base::Level::Warning, "store", "deleted missions cannot be forgotten",
                {{"reason", done.error().detail}});
    }
  }

  void run() {
    forget();
    std::vector<base::Event> new_events;
    std::deque<std::function<void()>> todo;
    for (;;) {
      {
        std::unique_lock lock(mutex);
        news.wait(lock, [this] { return closing || !jobs.empty() || !events.empty(); });
        if (jobs.empty() && events.empty()) return;  // closing, and all is done
        new_events.swap(events);
        if (!jobs.empty()) {
          todo.push_back(std::move(jobs.front()));
          jobs.pop_front();
        }
      }
      // Events first: whoever asks for the list after adding one finds it there.
      if (!new_events.empty()) write(new_events);
      new_events.clear();
      for (auto& job : todo) job();
      todo.clear();
    }
  }

  void write(const std::vector<base::Event>& list) {
    const auto done = guarded([&]() -> Result<void> {
      write_events(db->connection, list, options.max_events);
      return {};
    });
    if (done) return;
    lost_events += list.size();
    static base::LogLimit limit(10.0);
    if (limit.due()) {
      base::log(base::Level::Error, "store", "events are lost",
                {{"count", std::to_string(list.size())}, {"reason", done.error().detail}});
    }
  }
};

Result<std::unique_ptr<Store>> Store::open(const std::filesystem::path& file, Deliver deliver,
                                           Options options) {
  auto db = open_database(file, migrations(), options.max_bytes);
  if (!db) return tl::unexpected<Error>(std::move(db).error());
  return std::unique_ptr<Store>(
      new Store(std::make_unique<Impl>(std::move(*db), std::move(deliver), std::move(options))));
}

Store::Store(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Store::~Store() = default;

void Store::list_missions(int limit, std::string cursor, Reply<Page<MissionSummary>> reply,
                          Filter filter) {
  impl_->ask(std::move(reply),
             [impl = impl_.get(), limit, cursor = std::move(cursor), filter = std::move(filter)] {
               if (filter.which == Which::Deleted) impl->forget();
               return impl->missions.list(limit, cursor, filter);
             });
}

void Store::restore_mission(std::string id, std::int64_t expected, Change change,
                            Reply<StoredMission> reply) {
  impl_->ask(std::move(reply),
             [impl = impl_.get(), id = std::move(id), expected, change = std::move(change)] {
               return impl->missions.restore(id, expected, change, impl->options.clock());
             });
}

void Store::describe_mission(std::string id, std::int64_t expected, Description description,
                             Change change, Reply<StoredMission> reply) {
  impl_->ask(std::move(reply), [impl = impl_.get(), id = std::move(id), expected,
                                description = std::move(description), change = std::move(change)] {
    return impl->missions.describe(id, expected, description, change, impl->options.clock());
  });
}

void Store::copy_mission(std::string id, std::optional<std::string> name, Change change,
                         Reply<StoredMission> reply) {
  impl_->ask(std::move(reply), [impl = impl_.get(), id = std::move(id), name = std::move(name),
                                change = std::move(change)] {
    return impl->missions.copy(id, name, change, impl->options.clock());
  });
}

void Store::create_mission(mission::Plan plan, Change change, Reply<StoredMission> reply) {
  impl_->ask(std::move(reply),
             [impl = impl_.get(), plan = std::move(plan), change = std::move(change)]() mutable {
               return impl->missions.create(std::move(plan), change, impl->options.clock());
             });
}

void Store::read_mission(std::string id, Reply<StoredMission> reply) {
  impl_->ask(std::move(reply),
             [impl = impl_.get(), id = std::move(id)] { return impl->missions.read(id); });
}

void Store::read_revision(std::string id, std::int64_t revision, Reply<StoredMission> reply) {
  impl_->ask(std::move(reply), [impl = impl_.get(), id = std::move(id), revision] {
    return impl->missions.read_revision(id, revision);
  });
}

void Store::replace_mission(std::string id, std::int64_t expected, mission::Plan plan,
                            Change change, Reply<StoredMission> reply) {
  impl_->ask(std::move(reply), [impl = impl_.get(), id = std::move(id), expected,
                                plan = std::move(plan), change = std::move(change)]() mutable {
    return impl->missions.replace(id, expected, std::move(plan), change, impl->options.clock());
  });
}

void Store::split_mission(std::string id, std::int64_t expected, mission::Plan first,
                          mission::Plan rest, Change change, Reply<Halves> reply) {
  impl_->ask(std::move(reply),
             [impl = impl_.get(), id = std::move(id), expected, first = std::move(first),
              rest = std::move(rest), change = std::move(change)]() mutable {
               return impl->missions.split(id, expected, std::move(first), std::move(rest), change,
                                           impl->options.clock());
             });
}

void Store::delete_mission(std::string id, std::int64_t expected, Change change,
                           Reply<void> reply) {
  impl_->ask(std::move(reply),
             [impl = impl_.get(), id = std::move(id), expected, change = std::move(change)] {
               auto done = impl->missions.remove(id, expected, change, impl->options.clock());
               if (done) impl->forget();
               return done;
             });
}

void Store::list_revisions(std::string id, int limit, std::string cursor,
                           Reply<Page<RevisionSummary>> reply) {
  impl_->ask(std::move(reply),
             [impl = impl_.get(), id = std::move(id), limit, cursor = std::move(cursor)] {
               return impl->missions.list_revisions(id, limit, cursor);
             });
}

void Store::revert_mission(std::string id, std::int64_t expected, std::int64_t to_revision,
                           Change change, Reply<StoredMission> reply) {
  impl_->ask(std::move(reply), [impl = impl_.get(), id = std::move(id), expected, to_revision,
                                change = std::move(change)] {
    return impl->missions.revert(id, expected, to_revision, change, impl->options.clock());
  });
}

void Store::list_fences(int limit, std::string cursor, Reply<Page<FenceSummary>> reply) {
  impl_->ask(std::move(reply), [impl = impl_.get(), limit, cursor = std::move(cursor)] {
    return impl->fences.list(limit, cursor);
  });
}

void Store::create_fence(mission::Fence fence, Change change, Reply<StoredFence> reply) {
  impl_->ask(std::move(reply),
             [impl = impl_.get(), fence = std::move(fence), change = std::move(change)]() mutable {
               return impl->fences.create(std::move(fence), change, impl->options.clock());
             });
}

void Store::create_route_map(RouteMap map, Reply<RouteMap> reply) {
  impl_->ask(std::move(reply), [impl = impl_.get(), map = std::move(map)]() mutable {
    return store::create_route_map(impl->db->connection, std::move(map), impl->options.clock());
  });
}

void Store::list_route_maps(int limit, std::string cursor, Reply<Page<RouteMapSummary>> reply) {
  impl_->ask(std::move(reply), [impl = impl_.get(), limit, cursor = std::move(cursor)] {
    return store::list_route_maps(impl->db->connection, limit, cursor);
  });
}

void Store::read_route_map(std::string id, Reply<RouteMap> reply) {
  impl_->ask(std::move(reply), [impl = impl_.get(), id = std::move(id)] {
    return store::read_route_map(impl->db->connection, id);
  });
}

void Store::delete_route_map(std::string id, Reply<void> reply) {
  impl_->ask(std::move(reply), [impl = impl_.get(), id = std::move(id)] {
    return store::delete_route_map(impl->db->connection, id);
  });
}

void Store::begin_teach(TeachRecord record, Reply<void> reply) {
  impl_->ask(std::move(reply), [impl = impl_.get(), record = std::move(record)] {
    return store::begin_teach(impl->db->connection, record);
  });
}

void Store::add_teach_points(std::vector<mission::TaughtPoint> points, Reply<void> reply) {
  impl_->ask(std::move(reply), [impl = impl_.get(), points = std::move(points)] {
    return store::add_teach_points(impl->db->connection, points);
  });
}

void Store::read_teach(Reply<std::optional<TeachRecord>> reply) {
  impl_->ask(std::move(reply), [impl = impl_.get()]() -> Result<std::optional<TeachRecord>> {
    return store::read_teach(impl->db->connection);
  });
}

void Store::discard_teach(Reply<void> reply) {
  impl_->ask(std::move(reply), [impl = impl_.get()]() -> Result<void> {
    SQLite::Transaction transaction(impl->db->connection, SQLite::TransactionBehavior::IMMEDIATE);
    clear_teach(impl->db->connection);
    transaction.commit();
    return {};
  });
}

void Store::finish_teach(mission::Plan plan, Change change, Reply<StoredMission> reply) {
  impl_->ask(std::move(reply),
             [impl = impl_.get(), plan = std::move(plan), change = std::move(change)]() mutable {
               return impl->missions.create(std::move(plan), change, impl->options.clock(),
                                            Missions::Teach::Ends);
             });
}

void Store::read_fence(std::string id, Reply<StoredFence> reply) {
  impl_->ask(std::move(reply),
             [impl = impl_.get(), id = std::move(id)] { return impl->fences.read(id); });
}

void Store::read_fence_revision(std::string id, std::int64_t revision, Reply<StoredFence> reply) {
  impl_->ask(std::move(reply), [impl = impl_.get(), id = std::move(id), revision] {
    return impl->fences.read_revision(id, revision);
  });
}

void Store::replace_fence(std::string id, std::int64_t expected, mission::Fence fence,
                          Change change, Reply<StoredFence> reply) {
  impl_->ask(std::move(reply), [impl = impl_.get(), id = std::move(id), expected,
                                fence = std::move(fence), change = std::move(change)]() mutable {
    return impl->fences.replace(id, expected, std::move(fence), change, impl->options.clock());
  });
}

void Store::delete_fence(std::string id, std::int64_t expected, Change change, Reply<void> reply) {
  impl_->ask(std::move(reply),
             [impl = impl_.get(), id = std::move(id), expected, change = std::move(change)] {
               return impl->fences.remove(id, expected, change, impl->options.clock());
             });
}

void Store::revert_fence(std::string id, std::int64_t expected, std::int64_t to_revision,
                         Change change, Reply<StoredFence> reply) {
  impl_->ask(std::move(reply), [impl = impl_.get(), id = std::move(id), expected, to_revision,
                                change = std::move(change)] {
    return impl->fences.revert(id, expected, to_revision, change, impl->options.clock());
  });
}

void Store::list_fence_revisions(std::string id, int limit, std::string cursor,
                                 Reply<Page<RevisionSummary>> reply) {
  impl_->ask(std::move(reply),
             [impl = impl_.get(), id = std::move(id), limit, cursor = std::move(cursor)] {
               return impl->fences.list_revisions(id, limit, cursor);
             });
}

void Store::activate_fence(std::optional<std::string> id, Reply<std::optional<StoredFence>> reply) {
  impl_->ask(std::move(reply),
             [impl = impl_.get(), id = std::move(id)] { return impl->fences.activate(id); });
}

void Store::read_active_fence(Reply<std::optional<StoredFence>> reply) {
  impl_->ask(std::move(reply), [impl = impl_.get()] { return impl->fences.active(); });
}

void Store::add_event(base::Event event) {
  {
    std::lock_guard lock(impl_->mutex);
    if (impl_->events.size() >= impl_->options.queue) {
      ++impl_->lost_events;
      return;
    }
    impl_->events.push_back(std::move(event));
  }
  impl_->news.notify_one();
}

std::uint64_t Store::lost_events() const noexcept {
  return impl_->lost_events.load(std::memory_order_relaxed);
}

void Store::list_events(std::int64_t after_id, base::Severity level, int limit,
                        Reply<Page<StoredEvent>> reply) {
  impl_->ask(std::move(reply), [impl = impl_.get(), after_id, level, limit] {
    return store::list_events(impl->db->connection, after_id, level, limit);
  });
}

}  // namespace roverd::store
