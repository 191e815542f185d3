// Who did what, in the file.

#include "people/audit.hpp"

#include <future>
#include <limits>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include "folder.hpp"
#include "store/store.hpp"

namespace roverd::store {
namespace {

using people::Deed;
using people::KeptDeed;

constexpr base::WallTime kMidday{std::chrono::seconds(1'800'000'000)};
constexpr std::int64_t kEnd = std::numeric_limits<std::int64_t>::max();

Deed deed(const std::string& user, const std::string& call, int status = 200) {
  Deed d;
  d.time = kMidday;
  d.user = user;
  d.address = "10.0.0.2";
  d.call = call;
  d.status = status;
  return d;
}

class AuditStore : public testing::Test {
 protected:
  void open(Options options = {}) {
    store_.reset();
    auto opened = Store::open(
        folder_.file(), [](std::function<void()> answer) { answer(); }, std::move(options));
    ASSERT_TRUE(opened) << opened.error().detail;
    store_ = std::move(*opened);
  }
  base::Result<Page<KeptDeed>> list(AuditFilter filter = {}, int limit = 100,
                                    std::int64_t before = kEnd) {
    std::promise<base::Result<Page<KeptDeed>>> answer;
    store_->list_audit(std::move(filter), before, limit,
                       [&](base::Result<Page<KeptDeed>> page) { answer.set_value(page); });
    return answer.get_future().get();
  }
  AuditStretch stretch(std::int64_t after = 0, int limit = 100'000) {
    std::promise<base::Result<AuditStretch>> answer;
    store_->read_audit(after, limit, [&](base::Result<AuditStretch> s) { answer.set_value(s); });
    return answer.get_future().get().value_or(AuditStretch{});
  }
  std::vector<std::string> calls(AuditFilter filter) {
    std::vector<std::string> out;
    const auto page = list(std::move(filter));
    for (const KeptDeed& row : page->items) out.push_back(row.deed.call);
    return out;
  }
  static std::optional<std::int64_t> broken(const AuditStretch& s) {
    return people::first_break(s.before_id, s.before_hash, s.rows);
  }
  void sql(const std::string& text) {
    SQLite::Database db(folder_.file().string(), SQLite::OPEN_READWRITE);
    db.exec(text);
  }

  Folder folder_;
  std::unique_ptr<Store> store_;
};

TEST_F(AuditStore, KeepsEachDeedOnceAndInOrderOverARestart) {
  open();
  store_->add_deed(deed("anna", "POST /vehicle/arm"));
  open();
  store_->add_deed(deed("bert", "DELETE /missions/{id}", 403));
  const AuditStretch all = stretch();
  ASSERT_EQ(all.rows.size(), 2u);
  EXPECT_EQ(all.rows[0].id, 1);
  EXPECT_EQ(all.rows[0].deed.user, "anna");
  EXPECT_EQ(all.rows[0].deed.time, kMidday);
  EXPECT_EQ(all.rows[1].deed.status, 403);
  EXPECT_EQ(broken(all), std::nullopt);
}

TEST_F(AuditStore, FindsByUserAddressCallTimeAndRefusal) {
  open();
  EXPECT_TRUE(list()->items.empty());
  store_->add_deed(deed("anna", "POST /vehicle/arm"));
  store_->add_deed(deed("bert", "POST /vehicle/arm", 403));
  store_->add_deed(deed("", "POST /session", 401));
  Deed later = deed("anna", "DELETE /fences/{id}");
  later.time = kMidday + std::chrono::hours(1);
  later.address = "::1";
  store_->add_deed(later);
  using Calls = std::vector<std::string>;
  EXPECT_EQ(calls({.user = "anna"}), (Calls{"DELETE /fences/{id}", "POST /vehicle/arm"}));
  EXPECT_EQ(calls({.user = ""}), Calls{"POST /session"});
  EXPECT_EQ(calls({.address = "::1"}), Calls{"DELETE /fences/{id}"});
  EXPECT_EQ(calls({.call = "/vehicle"}).size(), 2u);
  EXPECT_TRUE(calls({.call = "%"}).empty());
  EXPECT_EQ(calls({.from = kMidday + std::chrono::seconds(1)}), Calls{"DELETE /fences/{id}"});
  EXPECT_EQ(calls({.to = kMidday + std::chrono::hours(1)}).size(), 3u);
  EXPECT_EQ(calls({.refused = true}).size(), 2u);
  EXPECT_EQ(calls({.user = "bert", .refused = false}), Calls{});
}

TEST_F(AuditStore, IsReadInPages) {
  open();
  for (int i = 0; i < 5; ++i) store_->add_deed(deed("anna", std::to_string(i)));
  const auto first = list({}, 2);
  ASSERT_TRUE(first->next_cursor);
  EXPECT_EQ(first->items[1].id, 4);
  const auto last = list({}, 3, std::stoll(*first->next_cursor));
  EXPECT_EQ(last->items.size(), 3u);
  EXPECT_FALSE(last->next_cursor);
  EXPECT_FALSE(list({}, 0));
  EXPECT_FALSE(list({}, kMaxPage + 1));
  // Stretches hang together.
  const AuditStretch middle = stretch(2, 2);
  EXPECT_EQ(middle.rows.front().id, 3);
  EXPECT_EQ(middle.before_hash, stretch().rows[1].hash);
  EXPECT_EQ(broken(middle), std::nullopt);
}

TEST_F(AuditStore, CannotBeChangedOrCutInItsMiddleBySql) {
  open();
  for (int i = 0; i < 3; ++i) store_->add_deed(deed("anna", "x"));
  (void)stretch();
  EXPECT_THROW(sql("UPDATE audit SET user = 'bert' WHERE id = 2"), SQLite::Exception);
  EXPECT_THROW(sql("DELETE FROM audit WHERE id = 2"), SQLite::Exception);
  EXPECT_THROW(sql("DELETE FROM audit_cut"), SQLite::Exception);
  EXPECT_EQ(stretch().rows.size(), 3u);
}

TEST_F(AuditStore, ShowsWhoeverTookTheTriggersAwayFirst) {
  open();
  for (int i = 0; i < 3; ++i) store_->add_deed(deed("anna", "x"));
  (void)stretch();
  sql("DROP TRIGGER audit_stays_as_it_is; UPDATE audit SET user = 'bert' WHERE id = 2");
  EXPECT_EQ(broken(stretch()), 2);
  sql("DROP TRIGGER audit_goes_from_its_start; DELETE FROM audit WHERE id = 1");
  EXPECT_EQ(broken(stretch()), 1);
}

TEST_F(AuditStore, GivesUpTheOldestForTheRoomAndHangsTogether) {
  open({.queue = 4000, .max_audit_bytes = 400'000});
  // when more comes than may be kept; each row is counted with about 140 bytes
  for (int i = 0; i < 6000; ++i) {
    store_->add_deed(deed("anna", "POST /vehicle/arm"));
    if (i % 1000 == 999) (void)stretch();
  }
  const AuditStretch left = stretch();
  EXPECT_LT(left.rows.size(), 3500u);
  EXPECT_GT(left.rows.size(), 1500u);
  EXPECT_EQ(left.rows.back().id, 6000);
  EXPECT_EQ(left.rows.front().id, left.before_id + 1);
  EXPECT_EQ(broken(left), std::nullopt);
}

TEST_F(AuditStore, TellsHowManyWereLost) {
  open({.queue = 2});
  // given a store that is held up
  std::promise<void> go;
  auto gone = go.get_future().share();
  std::promise<void> held;
  store_->read_active_fence([&](auto) {
    held.set_value();
    gone.wait();
  });
  held.get_future().wait();
  for (int i = 0; i < 5; ++i) store_->add_deed(deed("anna", "x"));
  go.set_value();
  EXPECT_EQ(stretch().rows.size(), 2u);
  // then the next one tells
  store_->add_deed(deed("bert", "y"));
  const AuditStretch all = stretch();
  ASSERT_EQ(all.rows.size(), 4u);
  EXPECT_EQ(all.rows[2].deed.call, "LOST");
  EXPECT_EQ(all.rows[2].deed.times, 3);
  EXPECT_EQ(all.rows[3].deed.user, "bert");
}

}  // namespace
}  // namespace roverd::store
