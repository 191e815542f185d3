#include "base/params.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace roverd::base {
namespace {

struct Sample {
  double lookahead_m = 1.5;
  int retries = 3;
  bool pivot = true;
  std::string law = "pursuit";
};

template <class V>
void fields(V& v, Sample& p) {
  v("lookahead_m", p.lookahead_m, 0.2, 20.0, "shorter is livelier");
  v("retries", p.retries, 0, 10, "then it gives up");
  v("pivot", p.pivot, "turn on the spot");
  v("law", p.law, "which tracker");
}

TEST(Params, KnowTheSideThatIsStricter) {
  EXPECT_TRUE(keeps_safe(Stricter::Any, 1.0, 99.0));
  EXPECT_TRUE(keeps_safe(Stricter::Lower, 1.0, 0.5));
  EXPECT_TRUE(keeps_safe(Stricter::Lower, 1.0, 1.0));
  EXPECT_FALSE(keeps_safe(Stricter::Lower, 1.0, 1.1));
  EXPECT_TRUE(keeps_safe(Stricter::Higher, 1.0, 1.1));
  EXPECT_FALSE(keeps_safe(Stricter::Higher, 1.0, 0.9));
  EXPECT_FALSE(keeps_safe(Stricter::Higher, 1.0, std::nan("")));
  EXPECT_FALSE(keeps_safe(Stricter::Lower, 1.0, std::nan("")));
  EXPECT_TRUE(keeps_safe(Stricter::Higher, false, true));
  EXPECT_FALSE(keeps_safe(Stricter::Higher, true, false));
  EXPECT_FALSE(keeps_safe(Stricter::None, 1.0, 0.5));
  EXPECT_TRUE(keeps_safe(Stricter::None, std::string("stop"), std::string("stop")));
  EXPECT_FALSE(keeps_safe(Stricter::None, std::string("stop"), std::string("skip")));
}

TEST(Params, AreDescribedWithDefaultAndRange) {
  const auto list = describe(Sample{});
  ASSERT_EQ(list.size(), 4u);
  EXPECT_EQ(list[0].name, "lookahead_m");
  EXPECT_EQ(std::get<double>(list[0].value), 1.5);
  EXPECT_EQ(list[0].max, 20.0);
  EXPECT_TRUE(list[1].integer);
}

TEST(Params, AValueInRangeIsSet) {
  Sample p;
  ASSERT_TRUE(set_param(p, "lookahead_m", 2.5));
  EXPECT_EQ(p.lookahead_m, 2.5);
  ASSERT_TRUE(set_param(p, "pivot", false));
  EXPECT_FALSE(p.pivot);
}

TEST(Params, BadValuesNameTheKeyAndChangeNothing) {
  Sample p;
  EXPECT_EQ(set_param(p, "lookahead_m", 0.1).error().detail, "lookahead_m must lie in 0.2 .. 20.0");
  EXPECT_EQ(set_param(p, "lookahead_m", std::nan("")).error().fields.at(0).pointer, "lookahead_m");
  EXPECT_EQ(set_param(p, "retries", 2.5).error().detail, "retries must be a whole number");
  EXPECT_EQ(set_param(p, "pivot", 1.0).error().detail, "pivot must be true or false");
  EXPECT_EQ(set_param(p, "lokahead_m", 1.0).error().detail, "unknown key");
  EXPECT_EQ(p.lookahead_m, 1.5);
  EXPECT_EQ(p.retries, 3);
}

}  // namespace
}  // namespace roverd::base
