// Power cuts, full disks, full queues, foreign readers.

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <set>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "folder.hpp"

namespace roverd::store {
namespace {

using base::Code;

/// Runs `body` in a process of its own that ends by _exit; 0 is good. The store's thread lives
/// there only, so nothing of this process is copied half.
template <class Body>
pid_t in_child(Body body) {
  const pid_t child = ::fork();
  if (child == 0) {
    int code = 99;
    try {
      code = body();
    } catch (...) {
    }
    ::_exit(code);
  }
  return child;
}

TEST(Durability, EveryAcknowledgedSaveIsThereAfterTheProcessWasKilled) {
  for (int round = 0; round < 5; ++round) {
    Folder folder;
    // given a process that saves missions, telling us of each save that was acknowledged
    int pipe_fds[2];
    ASSERT_EQ(::pipe(pipe_fds), 0);
    const pid_t child = in_child([&] {
      ::close(pipe_fds[0]);
      auto store = open_store(folder.file());
      for (int i = 0;; ++i) {
        const auto made = create(*store, plan_named("m" + std::to_string(i), 50));
        if (!made) return 1;
        if (::write(pipe_fds[1], made->id.data(), made->id.size()) != 12) return 2;
      }
    });
    ::close(pipe_fds[1]);
    // when it is killed in the middle of that
    std::set<std::string> acknowledged;
    char id[12];
    const int enough = 5 + 7 * round;
    while (static_cast<int>(acknowledged.size()) < enough) {
      ASSERT_EQ(::read(pipe_fds[0], id, sizeof id), 12);
      acknowledged.emplace(id, sizeof id);
    }
    ::kill(child, SIGKILL);
    while (::read(pipe_fds[0], id, sizeof id) == 12) acknowledged.emplace(id, sizeof id);
    ::close(pipe_fds[0]);
    ::waitpid(child, nullptr, 0);
    // then all of them can be read, and at most the one being saved came on top
    auto store = open_store(folder.file());
    for (const std::string& one : acknowledged) {
      const auto found = read(*store, one);
      ASSERT_TRUE(found) << found.error().detail;
      EXPECT_EQ(found->plan.items.size(), 50u);
    }
    const auto page = list(*store, kMaxPage);
    EXPECT_LE(page->items.size(), acknowledged.size() + 1);
  }
}

TEST(Durability, WhenTheSpaceIsUsedUpASaveIsRefusedAndNothingChanged) {
  Folder folder;
  Options options;
  options.max_bytes = 400'000;
  auto store = open_store(folder.file(), options);
  const std::string id = create(*store, plan_named("small", 3))->id;
  const auto refused = replace(*store, id, 1, noisy_plan("large", 40'000));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::Unavailable);
  EXPECT_EQ(refused.error().detail, "the disk is full, nothing was changed");
  EXPECT_EQ(read(*store, id)->plan.name, "small");
  EXPECT_EQ(revisions(*store, id, 10)->items.size(), 1u);
  EXPECT_TRUE(replace(*store, id, 1, plan_named("small again", 3)));
}

TEST(Durability, ADiskThatTakesNoMoreBytesIsAnErrorNotACrash) {
  Folder folder;
  const pid_t child = in_child([&] {
    auto store = open_store(folder.file());
    const auto made = create(*store, plan_named("before", 3));
    if (!made) return 1;
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{200'000, 200'000};
    if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) return 2;
    const auto refused = create(*store, noisy_plan("large", 40'000));
    if (refused || refused.error().code != Code::Unavailable) return 3;
    if (!read(*store, made->id)) return 4;
    return list(*store, 10)->items.size() == 1 ? 0 : 5;
  });
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  // and with space again the file is whole
  EXPECT_EQ(list(*open_store(folder.file()), 10)->items.size(), 1u);
}

TEST(Durability, AFileHeldByAnotherProgramIsUnavailableAndWorksAgainAfterwards) {
  Folder folder;
  auto store = open_store(folder.file());
  {
    // The store may still be writing what its start asks for.
    SQLite::Database other(folder.file().string(), SQLite::OPEN_READWRITE, 5000);
    other.exec("BEGIN IMMEDIATE");
    const auto refused = create(*store, plan_named("x"));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, Code::Unavailable);
    EXPECT_EQ(refused.error().detail,
              "the database is held by another program, nothing was changed");
  }
  EXPECT_TRUE(create(*store, plan_named("x")));
}

TEST(Durability, AStoredPlanThatCannotBeReadIsAnErrorThatNamesIt) {
  Folder folder;
  std::string id;
  {
    auto store = open_store(folder.file());
    id = create(*store, plan_named("x"))->id;
  }
  SQLite::Database(folder.file().string(), SQLite::OPEN_READWRITE)
      .exec("UPDATE revisions SET plan = '{\"name\":'");
  auto store = open_store(folder.file());
  const auto found = read(*store, id);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, Code::Unavailable);
  EXPECT_NE(found.error().detail.find(id), std::string::npos);
}

/// Keeps the store's thread inside an answer until open() is called.
class Door {
 public:
  void wait() {
    std::unique_lock lock(mutex_);
    entered_ = true;
    news_.notify_all();
    news_.wait(lock, [this] { return open_; });
  }
  void wait_until_entered() {
    std::unique_lock lock(mutex_);
    news_.wait(lock, [this] { return entered_; });
  }
  void open() {
    std::lock_guard lock(mutex_);
    open_ = true;
    news_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable news_;
  bool entered_ = false;
  bool open_ = false;
};

TEST(Queue, AFullOneAnswersUnavailableAtOnceAndTheOthersAreStillServed) {
  Folder folder;
  Options options;
  options.queue = 3;
  auto store = open_store(folder.file(), options);
  Door door;
  std::atomic<int> served{0};
  store->list_missions(1, "", [&](const auto&) { door.wait(); });
  door.wait_until_entered();
  for (int i = 0; i < 3; ++i) {
    store->list_missions(1, "", [&](const auto& page) { served += page ? 1 : 0; });
  }
  std::optional<base::Error> refused;
  store->list_missions(1, "", [&](const auto& page) { refused = page.error(); });
  ASSERT_TRUE(refused);  // before anything else was served
  EXPECT_EQ(refused->code, Code::Unavailable);
  EXPECT_EQ(refused->detail, "the store is busy: its queue of 3 calls is full");
  for (int i = 0; i < 5; ++i) store->add_event({});
  EXPECT_EQ(store->lost_events(), 2u);
  door.open();
  store.reset();  // drains
  EXPECT_EQ(served, 3);
}

TEST(Queue, ClosingAnswersWhatWasAskedBefore) {
  Folder folder;
  std::vector<std::string> made;
  {
    auto store = open_store(folder.file());
    for (int i = 0; i < 20; ++i) {
      store->create_mission(plan_named("m"), {}, [&](auto m) { made.push_back(m->id); });
    }
  }
  EXPECT_EQ(made.size(), 20u);
  EXPECT_EQ(list(*open_store(folder.file()), 100)->items.size(), 20u);
}

TEST(Queue, AnswersGoThroughDeliver) {
  Folder folder;
  std::mutex mutex;
  std::vector<std::function<void()>> waiting;
  bool answered = false;
  {
    auto store = Store::open(folder.file(), [&](std::function<void()> work) {
                   std::lock_guard lock(mutex);
                   waiting.push_back(std::move(work));
                 }).value();
    store->list_missions(1, "", [&](const auto&) { answered = true; });
  }
  EXPECT_FALSE(answered);
  ASSERT_EQ(waiting.size(), 1u);
  waiting[0]();
  EXPECT_TRUE(answered);
}

}  // namespace
}  // namespace roverd::store
