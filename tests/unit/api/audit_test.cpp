#include "api/audit.hpp"

#include <gtest/gtest.h>

namespace roverd::api {
namespace {

constexpr people::Now kNow{base::Time(std::chrono::hours(1)), base::WallTime{}};

class AuditTest : public testing::Test {
 protected:
  void answer(const std::string& target, http::status status) {
    Call call;
    call.request = Request{http::verb::delete_, target, 11};
    call.operation = "/missions/{id}";
    call.named = "anna";
    audit.answered(call, Response{status, 11}, kNow);
  }

  std::vector<people::Deed> kept;
  Audit audit{[this](people::Deed deed) { kept.push_back(std::move(deed)); }};
};

TEST_F(AuditTest, ManyThingsDoneAtOnceKeepWhoDidThemAndToWhat) {
  const std::size_t many = Audit::kKinds + 100;
  for (std::size_t i = 0; i < many; ++i) {
    answer("/api/v1/missions/" + std::to_string(i), http::status::no_content);
  }
  ASSERT_EQ(kept.size(), many);
  EXPECT_EQ(kept.back().user, "anna");
  EXPECT_EQ(kept.back().target, "/api/v1/missions/" + std::to_string(many - 1));
}

TEST_F(AuditTest, TheSameDoneAgainIsOneRowWithItsNumberAfterAWhile) {
  for (int i = 0; i < 40; ++i) answer("/api/v1/missions/a", http::status::no_content);
  EXPECT_EQ(kept.size(), 1u);
  audit.sweep(kNow.mono + Audit::kTogether);
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_EQ(kept[0].times + kept[1].times, 40);
}

}  // namespace
}  // namespace roverd::api
