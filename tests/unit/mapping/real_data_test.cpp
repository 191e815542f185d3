// An office and a corridor with rooms, recorded by robots whose odometry is off by 26 and 38 m.

#include "real_data.hpp"

#include <gtest/gtest.h>

#include "recorded_drive.hpp"

namespace roverd::nav::mapping {
namespace {

void map_it(const std::filesystem::path& path, std::size_t scans, double length_m) {
  const tests::RecordedDrive drive(path);
  ASSERT_EQ(drive.scans.size(), scans);
  EXPECT_NEAR(drive.length_m, length_m, 1.0);
  EXPECT_GT(drive.error_of(drive.odometry).rms_m, 20.0);
  Mapper mapper;
  for (std::size_t i = 0; i < scans; ++i) {
    ASSERT_TRUE(mapper.add(drive.scans[i], drive.odometry[i]));
  }
  mapper.finish();
  const auto counts = mapper.counts();
  EXPECT_GT(counts.loops, 50U);
  EXPECT_LT(counts.unfit, 5U);
  // The aim is 0.3 % of the length for the whole way; here its worst pose is held to half of that.
  EXPECT_LT(drive.error_of(mapper.path()).worst_m, 0.0015 * drive.length_m);
  const auto map = mapper.draw();
  ASSERT_TRUE(map) << map.error().detail;
  EXPECT_GT(map->columns() * map->rows(), 200'000);
}

TEST(MappingRealData, AnOffice) {
  ROVERD_REAL_DATA(path, "sensors/carmen/intel-corrected.log.gz");
  map_it(path, 910, 500.0);
}

TEST(MappingRealData, ACorridorWithRooms) {
  ROVERD_REAL_DATA(path, "sensors/carmen/freiburg-079-corrected.log.gz");
  map_it(path, 4791, 422.0);
}

}  // namespace
}  // namespace roverd::nav::mapping
