// What GET /sensors tells of one of them: what it saw, and what came over its link and was none.

#include <memory>

#include <gtest/gtest.h>

#include "api/json/words.hpp"

namespace roverd::api {
namespace {

base::Time heard_at(double s) {
  return base::Time{} + base::from_seconds(s);
}

/// One sensor, seen at 9.9 s, and the drivers that are told.
base::Snapshot with_front(std::vector<base::DriverStatus> drivers) {
  base::SensorState front;
  front.name = "front";
  front.kind = "velodyne";
  front.health = base::SensorHealth::Good;
  front.seen = heard_at(9.9);
  front.rate_hz = 10.0;
  front.refused = 2;
  base::Snapshot s;
  s.now = heard_at(10.0);
  s.sensors = std::make_shared<const std::vector<base::SensorState>>(1, front);
  s.drivers = std::move(drivers);
  return s;
}

base::DriverStatus driver(const std::string& name, const base::DriverDetail& detail,
                          std::uint64_t refused) {
  base::DriverStatus d;
  d.name = name;
  d.refused = refused;
  d.detail = std::make_shared<const base::DriverDetail>(detail);
  return d;
}

TEST(SensorWords, ItsOwnDriverTellsWhatWasLostDoubledDamagedAndForeign) {
  base::DriverDetail other;
  other.lost = 99;
  base::DriverDetail own;
  own.lost = 5;
  own.twice = 3;
  own.foreign = 7;
  own.refused_last = "block 3 does not begin with FF EE";
  own.refused_last_at = heard_at(8.5);
  const base::Snapshot s = with_front({driver("gnss", other, 50), driver("front", own, 4)});
  const Json one = sensors_json(s, heard_at(10.0))["items"].at(0);
  EXPECT_EQ(one["lost"], 5);
  EXPECT_EQ(one["duplicates"], 3);
  EXPECT_EQ(one["malformed"], 4);
  EXPECT_EQ(one["foreign"], 7);
  EXPECT_EQ(one["malformed_last"], "block 3 does not begin with FF EE");
  EXPECT_EQ(one["malformed_age_s"], 1.5);
  EXPECT_EQ(one["refused"], 2) << "by the picture, not by the driver";
}

TEST(SensorWords, WithNothingWrongAllCountsAreZero) {
  base::DriverStatus plain;
  plain.name = "front";
  for (const auto& drivers : {std::vector<base::DriverStatus>{}, std::vector{plain}}) {
    const Json one = sensors_json(with_front(drivers), heard_at(10.0))["items"].at(0);
    for (const char* count : {"lost", "duplicates", "malformed", "foreign"}) {
      EXPECT_EQ(one[count], 0) << count;
    }
    EXPECT_TRUE(one["malformed_last"].is_null());
    EXPECT_TRUE(one["malformed_age_s"].is_null());
  }
}

}  // namespace
}  // namespace roverd::api
