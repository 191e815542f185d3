// The chain of what was done.

#include "people/audit.hpp"

#include <gtest/gtest.h>

namespace roverd::people {
namespace {

Deed arm() {
  Deed d;
  d.time = base::WallTime(std::chrono::seconds(1'800'000'000));
  d.user = "anna";
  d.credential = "session 0a1b";
  d.address = "10.0.0.2";
  d.call = "POST /vehicle/arm";
  d.target = "/api/v1/vehicle/arm";
  d.status = 200;
  return d;
}

/// Three rows in a chain, from the very first.
std::vector<KeptDeed> three() {
  std::vector<KeptDeed> rows;
  std::string last(kFirstHash);
  for (std::int64_t id = 1; id <= 3; ++id) {
    Deed deed = arm();
    deed.status = 200 + static_cast<int>(id);
    last = chained(last, id, deed);
    rows.push_back({id, deed, last});
  }
  return rows;
}

TEST(AuditChain, IsWholeAsItWasWritten) {
  EXPECT_EQ(first_break(0, kFirstHash, three()), std::nullopt);
  EXPECT_EQ(first_break(0, kFirstHash, {}), std::nullopt);
}

TEST(AuditChain, BreaksAtTheRowWhoseAnyFieldWasChanged) {
  const std::vector<void (*)(KeptDeed&)> forgeries = {
      [](KeptDeed& row) { row.id = 7; },
      [](KeptDeed& row) { row.deed.time += std::chrono::nanoseconds(1); },
      [](KeptDeed& row) { row.deed.user = "bert"; },
      [](KeptDeed& row) { row.deed.credential = "session 0a1c"; },
      [](KeptDeed& row) { row.deed.address = "10.0.0.3"; },
      [](KeptDeed& row) { row.deed.call = "POST /vehicle/disarm"; },
      [](KeptDeed& row) { row.deed.target = "/api/v1/vehicle/disarm"; },
      [](KeptDeed& row) { row.deed.status = 403; },
      [](KeptDeed& row) { row.deed.detail = "no"; },
      [](KeptDeed& row) { row.deed.times = 2; },
      [](KeptDeed& row) { row.hash.back() = row.hash.back() == '0' ? '1' : '0'; },
  };
  for (std::size_t i = 0; i < forgeries.size(); ++i) {
    auto rows = three();
    forgeries[i](rows[1]);
    EXPECT_EQ(first_break(0, kFirstHash, rows), 2) << "forgery " << i;
  }
}

TEST(AuditChain, BreaksWhereARowIsMissingAddedOrSwapped) {
  auto missing = three();
  missing.erase(missing.begin() + 1);
  EXPECT_EQ(first_break(0, kFirstHash, missing), 2);
  auto swapped = three();
  std::swap(swapped[0], swapped[1]);
  EXPECT_EQ(first_break(0, kFirstHash, swapped), 1);
  auto first_gone = three();
  first_gone.erase(first_gone.begin());
  EXPECT_EQ(first_break(0, kFirstHash, first_gone), 1);
  // Cut at its start as we do it, it is whole from there.
  EXPECT_EQ(first_break(1, three()[0].hash, first_gone), std::nullopt);
}

TEST(AuditChain, TextThatMovesFromOneFieldToTheNextIsAnotherRow) {
  Deed a = arm();
  a.user = "ann";
  a.credential = "a session";
  Deed b = arm();
  b.user = "anna";
  b.credential = " session";
  EXPECT_NE(chained("", 1, a), chained("", 1, b));
}

TEST(AuditText, IsKeptShortPlainAndWhole) {
  Deed d = arm();
  d.target = "/a\r\n\x1b[31m\x7f/b";
  d.detail = std::string(299, 'x') + "\xC3\xA4";     // the last sign would be cut in two
  d.user = "\xff\xC3(\xED\xA0\x80\xF0\x9F\x9A\x9C";  // no UTF-8, but the tractor at its end
  const Deed kept = tidied(d);
  EXPECT_EQ(kept.target, "/a???[31m?/b");
  EXPECT_EQ(kept.detail, std::string(299, 'x'));
  EXPECT_EQ(kept.user,
            "??"
            "(???\xF0\x9F\x9A\x9C");
  EXPECT_EQ(kept.status, 200);
}

}  // namespace
}  // namespace roverd::people
