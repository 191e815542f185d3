// Clouds into cells, and the cells as a file.

#include "nav/cells/cell_map.hpp"

#include <limits>
#include <random>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "nav/cells/map_file.hpp"

namespace roverd::nav::cells {
namespace {

Cloud random_cloud(std::size_t points, float half_m, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(-half_m, half_m);
  Cloud out(points);
  for (auto& p : out) p = {place(random), place(random), place(random)};
  return out;
}

TEST(CellMap, KeepsNumberMeanAndSpreadOfEachCubesPoints) {
  // Given points in one cube, far from the origin, in two pieces,
  Cloud cloud = random_cloud(500, 0.4F, 1);
  for (auto& p : cloud) p += Eigen::Vector3f(1000.5F, -2000.5F, 0.5F);
  CellMap map(1.0);
  const std::span<const Eigen::Vector3f> all(cloud);
  map.add(all.first(123));
  map.add(all.subspan(123));
  // then there is one cell, as if computed at once.
  ASSERT_EQ(map.cells().size(), 1U);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& p : cloud) mean += p.cast<double>() / 500.0;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const auto& p : cloud) {
    const Eigen::Vector3d d = p.cast<double>() - mean;
    covariance += d * d.transpose() / 500.0;
  }
  EXPECT_EQ(map.cells()[0].points, 500.0);
  EXPECT_LT((map.cells()[0].mean_m - mean).norm(), 1e-9);
  EXPECT_LT((covariance_m2(map.cells()[0]) - covariance).norm(), 1e-9);
}

TEST(CellMap, CoarserCellsAreThoseOfThePoints) {
  const Cloud cloud = random_cloud(20'000, 3.0F, 2);
  CellMap fine(0.25);
  CellMap coarse(1.0);
  fine.add(cloud);
  coarse.add(cloud);
  const CellMap merged = fine.coarser(4);
  ASSERT_EQ(merged.cells().size(), coarse.cells().size());
  double points = 0.0;
  double spread = 0.0;
  for (const Cell& c : merged.cells()) points += c.points;
  for (const Cell& c : merged.cells()) spread += c.spread_m2[0];
  for (const Cell& c : coarse.cells()) spread -= c.spread_m2[0];
  EXPECT_EQ(points, 20'000.0);
  EXPECT_NEAR(spread, 0.0, 1e-6);
}

TEST(CellMap, CountsWhatIsNoPoint) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  constexpr float kEndless = std::numeric_limits<float>::infinity();
  CellMap map(0.1);
  const Cloud cloud = {{0, 0, 0}, {kNone, 0, 0}, {0, kEndless, 0}, {0, 0, -1e6F}, {-0.05F, 0, 0}};
  const auto added = map.add(cloud);
  EXPECT_EQ(added.taken, 2U);
  EXPECT_EQ(added.no_number, 3U);
  EXPECT_EQ(added.no_room, 0U);
  EXPECT_EQ(map.cells().size(), 2U);  // floor, not towards zero
}

TEST(MapFile, GivesBackTheMap) {
  CellMap map(0.5);
  map.add(random_cloud(5000, 10.0F, 3));
  const auto file = write_map(map);
  ASSERT_TRUE(file);
  const auto again = read_map(*file, 0.5);
  ASSERT_TRUE(again) << again.error().detail;
  double points = 0.0;
  for (const Cell& c : again->cells()) points += c.points;
  EXPECT_EQ(points, 5000.0);
  // A mean on the edge of its cube may change the cube when it is rounded, no more.
  EXPECT_NEAR(double(again->cells().size()), double(map.cells().size()), 3.0);
  EXPECT_LT((again->cells()[0].mean_m - map.cells()[0].mean_m).norm(), 1e-5);
  EXPECT_LT((covariance_m2(again->cells()[0]) - covariance_m2(map.cells()[0])).norm(), 1e-5);
}

TEST(MapFile, RefusesAFileWithoutOnePoint) {
  const std::string text =
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\nDATA ascii\nnan nan nan\n";
  const auto map = read_map(std::vector<std::uint8_t>(text.begin(), text.end()), 0.2);
  ASSERT_FALSE(map);
  EXPECT_EQ(map.error().detail, "not one point of the file is a number");
}

//   As a surveyor's program writes them: national coordinates.
TEST(MapFile, PointsThatLieTooFarFromTheOriginAreToldAsSuch) {
  const std::string text =
      "VERSION .7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\n"
      "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ascii\n500000 6470000 60\n500001 6470000 60\n";
  const auto map = read_map(std::vector<std::uint8_t>(text.begin(), text.end()), 0.2);
  ASSERT_FALSE(map);
  EXPECT_EQ(map.error().detail,
            "all points lie too far from the origin (one at x 500000, y 6470000, z 60 m; the cells "
            "reach 210 km): take a corner of the site off all of them");
}

}  // namespace
}  // namespace roverd::nav::cells
