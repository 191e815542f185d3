// A map of ROS's own and two recordings of CARMEN.

#include "real_data.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "atlas/carmen.hpp"
#include "atlas/map_files.hpp"
#include "atlas/unpack.hpp"
#include "base/angle.hpp"

namespace {

using namespace roverd;

std::string text_of(const std::filesystem::path& path) {
  const auto bytes = tests::read_file(path);
  return {bytes.begin(), bytes.end()};
}

TEST(RealMap, TheDepotGoesThroughUsUnchanged) {
  ROVERD_REAL_DATA(words_path, "sensors/maps/depot.yaml");
  ROVERD_REAL_DATA(picture_path, "sensors/maps/depot.pgm");
  const auto words = atlas::read_words(text_of(words_path));
  ASSERT_TRUE(words) << words.error().detail;
  const auto file = tests::read_file(picture_path);
  const auto picture = atlas::read_pgm(file);
  ASSERT_TRUE(picture) << picture.error().detail;
  const auto map = atlas::map_of(*words, *picture);
  ASSERT_TRUE(map);
  EXPECT_EQ(map->columns(), 604);
  EXPECT_EQ(map->rows(), 307);
  const auto cells = map->cells();
  EXPECT_EQ(std::count(cells.begin(), cells.end(), 100), 5947);
  EXPECT_EQ(std::count(cells.begin(), cells.end(), 0), 170587);
  EXPECT_EQ(std::count(cells.begin(), cells.end(), -1), 8894);
  EXPECT_EQ(atlas::write_words(*words), text_of(words_path));
  const auto again = atlas::picture_of(*map, *words);
  ASSERT_TRUE(again);
  EXPECT_EQ(atlas::write_pgm(*again), file);
}

void odometry_as_derived(const std::filesystem::path& log, const std::filesystem::path& table,
                         std::size_t scans) {
  std::vector<atlas::CarmenScan> read;
  atlas::CarmenReader reader([&](const atlas::CarmenScan& s) { read.push_back(s); });
  atlas::Unpacker unpacker([&](base::Bytes b) { reader.feed(b); });
  ASSERT_TRUE(unpacker.feed(tests::read_file(log)));
  ASSERT_TRUE(unpacker.finish());
  reader.finish();
  ASSERT_EQ(read.size(), scans);
  EXPECT_EQ(reader.refused(), 0U) << reader.first_refused();
  std::ifstream in(table);
  std::string line;
  std::getline(in, line);
  for (const atlas::CarmenScan& scan : read) {
    ASSERT_TRUE(std::getline(in, line));
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    double index = 0.0;
    double time_s = 0.0;
    double v[6] = {};
    words >> index >> time_s;
    for (double& value : v) words >> value;
    EXPECT_NEAR(scan.odometry.x_m, v[0], 1e-3) << line;
    EXPECT_NEAR(scan.odometry.y_m, v[1], 1e-3) << line;
    EXPECT_NEAR(base::angle_diff_rad(scan.odometry.yaw_rad, v[2]), 0.0, 1e-4) << line;
    EXPECT_NEAR(scan.pose.x_m, v[3], 1e-4);
    EXPECT_NEAR(scan.time_s, time_s, 1e-3);
    if (testing::Test::HasFailure()) return;
  }
}

TEST(RealLog, OdometryOfTheOfficeIsChainedAsDerived) {
  ROVERD_REAL_DATA(log, "sensors/carmen/intel-corrected.log.gz");
  ROVERD_REAL_DATA(table, "sensors/carmen/intel-odometry.csv");
  odometry_as_derived(log, table, 910);
}

TEST(RealLog, OdometryOfTheCorridorIsChainedAsDerived) {
  ROVERD_REAL_DATA(log, "sensors/carmen/freiburg-079-corrected.log.gz");
  ROVERD_REAL_DATA(table, "sensors/carmen/freiburg-079-odometry.csv");
  odometry_as_derived(log, table, 4791);
}

}  // namespace
