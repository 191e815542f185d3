// Where it slipped, told and forgotten.

#include <future>

#include "house.hpp"

namespace roverd::test {
namespace {

class SlipsApi : public HouseTest {
 protected:
  SlipsApi() : HouseTest(House::Vehicle::Whole, {.data = write}) {}

  /// Two places of an earlier life.
  static void write(const std::filesystem::path& file) {
    auto store = store::Store::open(file, [](std::function<void()> answer) { answer(); });
    ASSERT_TRUE(store);
    for (int i = 0; i < 2; ++i) {
      store::Slip slip;
      slip.at = {58.378 + 0.001 * i, 26.729};
      slip.time = base::WallTime(std::chrono::seconds(1'780'000'000 + i));
      slip.kind = i == 0 ? store::SlipKind::Dug : store::SlipKind::Side;
      slip.percent = 100.0 - 84.75 * i;
      std::promise<bool> kept;
      (*store)->note_slip(slip, [&kept](auto done) { kept.set_value(done.has_value()); });
      ASSERT_TRUE(kept.get_future().get());
    }
  }
};

TEST_F(SlipsApi, AreListedByTimeAndPlaceAndForgotten) {
  const auto all = call("GET", "/slips");
  ASSERT_EQ(all.status, 200u);
  ASSERT_EQ(all.body["items"].size(), 2u);
  EXPECT_EQ(all.body["items"][0]["kind"], "side");
  EXPECT_EQ(all.body["items"][0]["percent"], 15.3);
  EXPECT_EQ(all.body["items"][1]["kind"], "dug");
  EXPECT_EQ(all.body["items"][1]["times"], 1);
  const auto page = call("GET", "/slips?limit=1");
  ASSERT_EQ(page.body["items"].size(), 1u);
  const std::string cursor = page.body["next_cursor"];
  const auto rest = call("GET", "/slips?limit=1&cursor=" + cursor);
  ASSERT_EQ(rest.body["items"].size(), 1u);
  EXPECT_EQ(rest.body["items"][0]["kind"], "dug");
  EXPECT_TRUE(rest.body["next_cursor"].is_null());
  const std::string time = all.body["items"][1]["time"];
  EXPECT_EQ(call("GET", "/slips?since=" + time).body["items"].size(), 1u);
  EXPECT_EQ(call("GET", "/slips?bbox=26.7,58.377,26.8,58.3785").body["items"].size(), 1u);
  EXPECT_EQ(call("DELETE", "/slips").status, 204u);
  EXPECT_TRUE(call("GET", "/slips").body["items"].empty());
}

TEST_F(SlipsApi, AnswerWhatCannotBeAskedWithItsName) {
  for (const char* query : {"since=yesterday", "bbox=1,2,3", "bbox=1,2,3,4,5", "bbox=1,50,2,40",
                            "bbox=a,b,c,d", "bbox=-200,0,0,1"}) {
    const auto bad = call("GET", std::string("/slips?") + query);
    EXPECT_EQ(bad.status, 422u) << query;
  }
  EXPECT_EQ(call("GET", "/slips?cursor=nonsense").status, 400u);
}

}  // namespace
}  // namespace roverd::test
