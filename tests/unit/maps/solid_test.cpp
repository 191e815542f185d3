// Maps in three dimensions as files, and the plane of them.

#include "maps/solid.hpp"

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "maps/files.hpp"

namespace roverd::maps {
namespace {

using nav::cells::Cloud;
using nav::chart::kFree;
using nav::chart::kOccupied;
using nav::chart::kUnknown;

Cloud block(double x0, double x1, double y0, double y1, double z0, double z1) {
  Cloud out;
  for (double x = x0; x <= x1; x += 0.1) {
    for (double y = y0; y <= y1; y += 0.1) {
      for (double z = z0; z <= z1; z += 0.1) {
        out.emplace_back(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
      }
    }
  }
  return out;
}

nav::chart::Cell at(const nav::chart::OccupancyMap& map, double x, double y) {
  return map.at(*map.cell_of(x, y));
}

//   ground 8 m x 4 m that rises by 1 m; a wall; a beam 2.4 m over it, and nothing beyond
TEST(SolidTest, ThePlaneHasWhatStandsTheGroundAndWhatNobodySaw) {
  nav::cells::CellMap solid(kSolidCell_m);
  Cloud ground = block(0, 8, 0, 4, 0, 0);
  for (auto& p : ground) p.z() = 0.125F * p.x();
  solid.add(ground);
  solid.add(block(4, 4, 0, 2, 0.6, 2.5));
  solid.add(block(0, 8, 3, 3.1, 3.5, 3.5));
  const auto plane = plane_of(solid);
  ASSERT_TRUE(plane) << plane.error().detail;
  EXPECT_EQ(plane->resolution_m(), 0.05);
  int wall = 0;
  for (double y = 0.1; y < 1.9; y += 0.05) {
    bool there = false;
    for (double x = 3.9; x < 4.12; x += 0.05) there |= at(*plane, x, y) == kOccupied;
    wall += there ? 1 : 0;
  }
  EXPECT_GE(wall, 33) << "of 36: a wall, not a row of dots";
  EXPECT_EQ(at(*plane, 2.0, 1.0), kFree);
  EXPECT_EQ(at(*plane, 7.0, 1.0), kFree) << "on the slope";
  EXPECT_EQ(at(*plane, 2.0, 3.05), kFree) << "it is passed below";
  EXPECT_EQ(at(*plane, 8.9, 1.0), kUnknown);
}

TEST(SolidTest, AStrayPointFarAwayIsRefusedAndSoIsNothing) {
  nav::cells::CellMap solid(kSolidCell_m);
  EXPECT_EQ(plane_of(solid).error().code, base::Code::Invalid);
  solid.add(block(0, 1, 0, 1, 0, 0));
  solid.add(Cloud{{50'000.0F, 90'000.0F, 0.0F}});
  EXPECT_EQ(plane_of(solid).error().code, base::Code::TooLarge);
}

TEST(SolidTest, AFileIsReadAsAMapAndWhatIsWrongWithItIsSaidWithItsName) {
  const auto folder = std::filesystem::temp_directory_path() / "roverd-solid-test";
  std::filesystem::create_directories(folder);
  const auto file = folder / "Yard.PCD";
  const auto write = [&](const std::string& text) { std::ofstream(file) << text; };
  const std::string head =
      "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\n"
      "POINTS 2\nDATA ascii\n";
  write(head + "1 2 0\n3 4 1.5\n");
  EXPECT_TRUE(is_solid(file));
  const auto plane = read_map_files(file);
  ASSERT_TRUE(plane) << plane.error().detail;
  EXPECT_EQ(at(*plane, 1.0, 2.0), kFree);
  write(head + "1 2 0\n3 four 1.5\n");
  const auto wrong = read_map_files(file);
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().detail.find("Yard.PCD"), std::string::npos) << wrong.error().detail;
  EXPECT_NE(wrong.error().detail.find("line 11"), std::string::npos) << wrong.error().detail;
  EXPECT_EQ(read_solid(folder / "none.pcd").error().code, base::Code::NotFound);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace roverd::maps
