#include <algorithm>
#include <utility>

#include "base/log.hpp"
#include "store/events.hpp"
#include "store/store_impl.hpp"

namespace roverd::store {

using base::Error;
using base::Result;

namespace {
constexpr base::Duration kLook = std::chrono::seconds(2);
}  // namespace

Store::Impl::Impl(std::unique_ptr<Database> database, Options options_)
    : db(std::move(database)), options(std::move(options_)) {
  thread = std::thread([this] { run(); });
}

Store::Impl::~Impl() {
  {
    std::lock_guard lock(mutex);
    closing = true;
  }
  news.notify_one();
  thread.join();
}

void Store::Impl::forget() {
  const auto done = guarded([&]() -> Result<void> {
    missions.forget_deleted(options.clock() - options.keep_deleted);
    return {};
  });
  static base::LogLimit limit(10.0);
  if (!done && limit.due()) {
    base::log(base::Level::Warning, "store", "what is old cannot be forgotten",
              {{"reason", done.error().detail}});
  }
}

bool Store::Impl::tidy() {
  const base::WallTime now = options.clock();
  // A clock that was never set knows no ages.
  const auto before = [&](base::Duration keep) {
    const bool known = keep > base::Duration::zero() && now >= base::kYoungest;
    return known ? std::optional(now - keep) : std::nullopt;
  };
  const auto step = kept([&]() -> Result<bool> {
    const auto spare = runs.spare(before(options.keep_runs_for), options.max_run_bytes);
    if (!spare) {
      if (const auto old = before(options.keep_events_for)) {
        forget_events(db->connection, *old);
      }
      return false;
    }
    if (auto done = runs.remove(spare->id); !done) return tl::unexpected<Error>(done.error());
    if (tidied.runs++ == 0) tidied.first = spare->id;
    tidied.last = spare->id;
    tidied.bytes += spare->bytes;
    return true;
  });
  if (step) return *step;
  static base::LogLimit limit(600.0);  // why it fails, the state of the disk tells
  if (limit.due()) {
    base::log(base::Level::Warning, "store", "old runs and events cannot be removed",
              {{"reason", step.error().detail}});
  }
  return false;
}

void Store::Impl::tell_tidied() {
  const auto done = std::exchange(tidied, {});
  if (done.runs == 0 || !options.tell) return;
  const std::string first = std::to_string(done.first);
  const std::string which = done.runs == 1 ? "run " + first + " was"
                                           : std::to_string(done.runs) + " runs, " + first +
                                                 " to " + std::to_string(done.last) + ", were";
  std::string why;
  if (options.keep_runs_for > base::Duration::zero()) {
    why = "older than " + std::to_string(options.keep_runs_for / std::chrono::hours(24)) + " days";
  }
  if (options.max_run_bytes > 0) {
    why += std::string(why.empty() ? "" : ", or ") + "beyond " +
           std::to_string(options.max_run_bytes / 1'000'000) + " MB";
  }
  options.tell(
      {options.clock(), base::Severity::Info, "runs_removed",
       which + " removed (about " + std::to_string((done.bytes + 500) / 1000) + " kB): " + why});
}

void Store::Impl::close_runs() {
  const auto done = guarded([&]() -> Result<void> {
    runs.close_interrupted();
    return {};
  });
  if (done) return;
  base::log(base::Level::Warning, "store", "interrupted runs cannot be closed",
            {{"reason", done.error().detail}});
}

void Store::Impl::run() {
  forget();
  close_runs();
  bool tidying = true;
  look();
  std::vector<base::Event> new_events;
  std::vector<people::Deed> new_deeds;
  std::deque<std::function<void()>> todo;
  base::Time looked = base::steady_now();
  base::Time tidied_at = looked;
  for (;;) {
    if (tidying) {
      tidying = tidy();
      if (!tidying) tell_tidied();
      tidied_at = base::steady_now();
    }
    {
      std::unique_lock lock(mutex);
      const auto wait = tidying ? base::Duration::zero() : std::min(kLook, options.tidy_every);
      const bool asked = news.wait_for(lock, wait, [this] {
        return closing || !jobs.empty() || !events.empty() || !deeds.empty();
      });
      // Closing, and all is done.
      if (asked && jobs.empty() && events.empty() && deeds.empty()) return;
      new_events.swap(events);
      new_deeds.swap(deeds);
      if (!jobs.empty()) {
        todo.push_back(std::move(jobs.front()));
        jobs.pop_front();
      }
    }
    // Events first: whoever asks for the list after adding one finds it there.
    if (!new_events.empty()) write(new_events);
    new_events.clear();
    if (!new_deeds.empty()) write_deeds(new_deeds);
    new_deeds.clear();
    for (auto& job : todo) {
      try {
        job();
      } catch (const std::exception& bug) {  // no memory, not even for the answer
        base::log(base::Level::Error, "store", "an answer failed", {{"what", bug.what()}});
      }
    }
    todo.clear();
    if (base::steady_now() - tidied_at >= options.tidy_every) tidying = true;
    if (base::steady_now() - looked >= kLook) {
      look();
      looked = base::steady_now();
    }
  }
}

void Store::Impl::set_trouble(std::string trouble) {
  std::lock_guard lock(mutex);
  storage.trouble = std::move(trouble);
}

bool Store::Impl::is_trouble(const Error& error) noexcept {
  return error.code == base::Code::Unavailable;
}

tl::unexpected<Error> Store::Impl::not_kept(std::string gone) {
  gone += ": nothing is kept any more; put it back and start roverd again";
  set_trouble(gone);
  return tl::unexpected<Error>({base::Code::Unavailable, std::move(gone), {}});
}

void Store::Impl::look() {
  std::string trouble = db->place.gone();
  if (trouble.empty()) trouble = db->place.unwritable();
  bool try_it = false;
  {
    std::lock_guard lock(mutex);
    try_it = trouble.empty() && !storage.trouble.empty();
  }
  if (try_it) {
    // The smallest change there is: the first page, as it was.
    const auto done = guarded([&]() -> Result<void> {
      SQLite::Transaction transaction(db->connection, SQLite::TransactionBehavior::IMMEDIATE);
      const int version = db->connection.execAndGet("PRAGMA user_version").getInt();
      db->connection.exec("PRAGMA user_version = " + std::to_string(version));
      transaction.commit();
      return {};
    });
    if (!done) trouble = done.error().detail;
  }
  const auto free_bytes = db->place.free_bytes();
  std::lock_guard lock(mutex);
  storage = {base::steady_now(), std::move(trouble), free_bytes};
}

StorageState Store::storage() const {
  std::lock_guard lock(impl_->mutex);
  return impl_->storage;
}

void Store::Impl::write(const std::vector<base::Event>& list) {
  const auto done = kept([&]() -> Result<void> {
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

Result<std::unique_ptr<Store>> Store::open(const std::filesystem::path& file, Deliver deliver,
                                           Options options) {
  auto db = open_database(file, migrations(), options.max_bytes);
  if (!db) return tl::unexpected<Error>(std::move(db).error());
  return std::unique_ptr<Store>(
      new Store(std::make_shared<Impl>(std::move(*db), std::move(options)), std::move(deliver)));
}

std::unique_ptr<Store> Store::desk(Deliver deliver) const {
  return std::unique_ptr<Store>(new Store(impl_, std::move(deliver)));
}

Store::Store(std::shared_ptr<Impl> impl, Deliver deliver)
    : impl_(std::move(impl)), deliver_(std::move(deliver)) {}
Store::~Store() = default;

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
  impl_->ask(deliver_, std::move(reply), [impl = impl_.get(), after_id, level, limit] {
    return store::list_events(impl->db->connection, after_id, level, limit);
  });
}

}  // namespace roverd::store
