#include <gtest/gtest.h>

#include "api/json/words.hpp"

namespace roverd::api {
namespace {

using namespace std::chrono_literals;

TEST(TrailWords, IsPiecesOfPositionsAndAgesInJson) {
  const base::LocalFrame field(1, {58.378, 26.729});
  services::Trail trail;
  base::Snapshot s;
  for (const double north_m : {0.0, 1.0, 50.0}) {
    s = {};
    s.now = base::Time(1h) + base::from_seconds(north_m);
    s.wall = base::WallTime(1'700'000'000s) + base::from_seconds(north_m);
    s.pose.emplace();
    s.pose->stamp = s.now;
    s.pose->global = field.to_global({0.0, north_m});
    trail.take(s);
  }
  const Json json = trail_json(trail, s);
  EXPECT_EQ(json["time"], "2023-11-14T22:14:10.000Z");
  ASSERT_EQ(json["estimated"].size(), 2u);
  EXPECT_EQ(json["estimated"][0].size(), 2u);
  EXPECT_EQ(json["estimated"][0][0], Json({58.378, 26.729, 50.0}));
  EXPECT_EQ(json["estimated"][0][1][2], 49.0);
  EXPECT_EQ(json["estimated"][1][0][2], 0.0);
  EXPECT_EQ(json["received"], Json::array());
}

}  // namespace
}  // namespace roverd::api
