// Clouds into cells, and the cells as a file.

#include "nav/cells/cell_map.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "nav/cells/map_file.hpp"
#include "nav/cells/pcd.hpp"

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

/// How many slots are looked at for each key, on the average, where each takes the next free one.
double mean_probes(const std::vector<std::uint64_t>& keys, int bits) {
  std::vector<bool> taken(std::size_t{1} << bits);
  double probes = 0.0;
  for (const std::uint64_t key : keys) {
    std::size_t at = first_slot(key, bits);
    for (probes += 1.0; taken[at]; probes += 1.0) at = (at + 1) & (taken.size() - 1);
    taken[at] = true;
  }
  return probes / static_cast<double>(keys.size());
}

TEST(KeyTable, FindsTheCellsOfGroundWallsAndSpaceAtOnce) {
  const std::array<CellIndex, 4> sizes = {
      {{600, 600, 1}, {600, 1, 600}, {1, 600, 600}, {70, 70, 70}}};
  for (const CellIndex& size : sizes) {
    // Given the cells of a block about the origin, in a table that is two thirds full,
    std::vector<std::uint64_t> keys;
    for (int x = 0; x < size.x; ++x) {
      for (int y = 0; y < size.y; ++y) {
        for (int z = 0; z < size.z; ++z) keys.push_back(key_of({x - size.x / 2, y, z}));
      }
    }
    // then hardly one waits behind others.
    EXPECT_LT(mean_probes(keys, 19), 2.5) << size.x << " x " << size.y << " x " << size.z;
  }
}

TEST(KeyTable, KeepsEveryKeyWhileItGrows) {
  KeyTable table(1);
  for (std::int32_t i = 0; i < 5000; ++i) {
    EXPECT_EQ(table.find_or_add(key_of({i, -i, 7}), i), i);
  }
  for (std::int32_t i = 0; i < 5000; ++i) ASSERT_EQ(table.find(key_of({i, -i, 7})), i);
  EXPECT_EQ(table.find(key_of({0, 0, 8})), -1);
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
  const auto again = read_map(write_map(map), 0.5);
  ASSERT_TRUE(again) << again.error().detail;
  double points = 0.0;
  for (const Cell& c : again->cells()) points += c.points;
  EXPECT_EQ(points, 5000.0);
  // A mean on the edge of its cube may change the cube when it is rounded, no more.
  EXPECT_NEAR(double(again->cells().size()), double(map.cells().size()), 3.0);
  EXPECT_LT((again->cells()[0].mean_m - map.cells()[0].mean_m).norm(), 1e-5);
  EXPECT_LT((covariance_m2(again->cells()[0]) - covariance_m2(map.cells()[0])).norm(), 1e-5);
}

/// A cloud in text; its rows are x, y and z.
std::vector<std::uint8_t> text_cloud(const std::vector<std::string>& rows,
                                     const std::string& viewpoint = "0 0 0 1 0 0 0") {
  const std::string n = std::to_string(rows.size());
  std::string text = "FIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nWIDTH " + n + "\nHEIGHT 1\nVIEWPOINT " +
                     viewpoint + "\nDATA ascii\n";
  for (const std::string& row : rows) text += row + "\n";
  return {text.begin(), text.end()};
}

TEST(MapFile, CountsWhatIsLeftOutAndSeesThatTheSensorWasMoved) {
  std::vector<std::string> rows(300, "1 2 3");
  rows[7] = "nan 0 0";
  rows[8] = "0 inf 0";
  rows[9] = "0 0 9e9";
  const auto read = read_whole_map(text_cloud(rows, "1 0 0 1 0 0 0"), 0.2);
  ASSERT_TRUE(read) << read.error().detail;
  EXPECT_EQ(read->map.cells().size(), 1U);
  EXPECT_EQ(read->map.cells()[0].points, 297.0);
  EXPECT_EQ(read->points, 300U);
  EXPECT_EQ(read->no_number, 2U);
  EXPECT_EQ(read->too_far, 1U);
  EXPECT_TRUE(read->viewpoint);
  EXPECT_EQ(left_out(*read), (std::vector<std::string>{
                                 "2 points that are no numbers", "1 point too far from the origin",
                                 "VIEWPOINT: the points are taken as they stand"}));
  EXPECT_TRUE(left_out(*read_whole_map(text_cloud({"1 2 3"}), 0.2)).empty());
}

TEST(MapFile, TakesNoCellWhoseSumsWouldBecomeInfinite) {
  // Given: a file with a usual cell and three of more points, or wider, than any can be.
  const std::string head =
      "FIELDS x y z points xx xy xz yy yz zz\nSIZE 4 4 4 4 4 4 4 4 4 4\n"
      "TYPE F F F F F F F F F F\nWIDTH 4\nHEIGHT 1\nDATA ascii\n";
  const std::string text = head +
                           "1 2 3 5 0.01 0 0 0.01 0 0.01\n1 2 3 3e38 0 0 0 0 0 0\n"
                           "1 2 3 5 3e38 0 0 0 0 0\n1 2 3 5 0 -3e38 0 0 0 0\n";
  // When: it is read, written, and read.
  const auto read = read_whole_map(std::vector<std::uint8_t>(text.begin(), text.end()), 0.2);
  ASSERT_TRUE(read) << read.error().detail;
  EXPECT_EQ(read->no_number, 3U);
  const auto again = read_map(write_map(read->map), 0.2);
  // Then
  ASSERT_TRUE(again) << again.error().detail;
  ASSERT_EQ(again->cells().size(), 1U);
  EXPECT_EQ(again->cells()[0].points, 5.0);
}

TEST(MapFile, RefusesWhatWouldLoseAPartOfTheMap) {
  // Half of the points in national coordinates; points that are no numbers do not count.
  const auto half = read_whole_map(
      text_cloud({"0 0 0", "nan 0 0", "500000 6470000 60", "1 0 0", "500001 6470000 60"}), 0.2);
  ASSERT_FALSE(half);
  EXPECT_EQ(half.error().detail,
            "2 of 4 points lie too far from the origin (one at x 500000, y 6470000, z 60 m; the "
            "cells reach 210 km): take a corner of the site off all of them");
  // Four cells where three are the most, in whatever form they come.
  const std::vector<Eigen::Vector3f> four = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 0}, {3, 0, 0}};
  for (const PcdData data : {PcdData::Ascii, PcdData::Binary, PcdData::Compressed}) {
    const auto file = write_pcd(pcd_table(four), data);
    ASSERT_TRUE(file);
    const auto cut = read_whole_map(*file, 0.2, 3);
    ASSERT_FALSE(cut);
    EXPECT_EQ(cut.error().code, base::Code::TooLarge);
    EXPECT_EQ(cut.error().detail,
              "there is more in it than 3 cells can hold, each with an edge of 20 cm: cut it to "
              "where the robot drives");
    EXPECT_TRUE(read_whole_map(*file, 0.2, 4));
  }
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
