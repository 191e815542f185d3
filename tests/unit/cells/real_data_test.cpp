// Two scans of a multi-beam lidar outdoors, and one revolution of a VLP-16 somewhere else.

#include "real_data.hpp"

#include <gtest/gtest.h>

#include "nav/cells/pcd.hpp"
#include "ply.hpp"
#include "scenes.hpp"

namespace roverd::nav::cells {
namespace {

constexpr const char* kSource = "sensors/clouds/pair-source.ply";
constexpr const char* kTarget = "sensors/clouds/pair-target.ply";
constexpr const char* kMatrix = "sensors/clouds/pair-T_target_source.txt";
constexpr const char* kTurn = "sensors/velodyne/vlp16-one-revolution.pcd";

Cloud points_of(const char* name) {
  return tests::ply_points(tests::real_data_path(name), 4);
}

Eigen::Isometry3d matrix() {
  std::ifstream in(tests::real_data_path(kMatrix));
  Eigen::Matrix4d m;
  for (int i = 0; i < 16; ++i) in >> m(i / 4, i % 4);
  return Eigen::Isometry3d(m);
}

Eigen::Isometry3d moved(const Eigen::Isometry3d& truth, const Eigen::Isometry3d& by) {
  Eigen::Isometry3d out = truth;
  out.linear() = by.linear() * truth.linear();
  out.translation() += by.translation();
  return out;
}

Cloud half_of(const Cloud& cloud, int axis, bool upper) {
  Cloud out;
  for (const auto& p : cloud) {
    if ((p[axis] > 0.0F) == upper) out.push_back(p);
  }
  return out;
}

TEST(CellsRealData, ThePairIsAlignedFromFiftyRandomOffsets) {
  ROVERD_REAL_DATA(path, kSource);
  const Relief target = relief_of(points_of(kTarget));
  const Relief source = relief_of(points_of(kSource));
  ASSERT_GT(source.surfels().size(), 7000U);
  const Eigen::Isometry3d truth = matrix();
  std::mt19937 random(7);
  for (int i = 0; i < 50; ++i) {
    Eigen::Isometry3d by = random_offset(random, 1.0, 10.0);
    // The readme's two starts among them.
    if (i == 0) by = moved(truth, pose(0, 0, 0, 0)).inverse();
    if (i == 1) by = pose(1.0, 0.0, 0.0, 10.0 / 57.29577951);
    const Alignment found = align(source, target, i == 0 ? pose(0, 0, 0, 0) : moved(truth, by));
    const Off wrong = off(found.x_ts, truth);
    EXPECT_LT(wrong.m, 0.02) << i;
    EXPECT_LT(wrong.deg, 0.2) << i;
    EXPECT_EQ(found.verdict, Verdict::Good) << i << " " << to_string(found.verdict);
  }
}

TEST(CellsRealData, FromTooFarItSaysSo) {
  ROVERD_REAL_DATA(path, kSource);
  const Relief target = relief_of(points_of(kTarget));
  const Relief source = relief_of(points_of(kSource));
  const Eigen::Isometry3d truth = matrix();
  std::mt19937 random(11);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  int found_right = 0;
  for (int i = 0; i < 16; ++i) {
    const double reach_m = i % 2 == 0 ? 5.0 : 20.0;
    const Eigen::Isometry3d by = pose(part(random) * reach_m, part(random) * reach_m, 0.0,
                                      part(random) * (i % 2 == 0 ? 1.0 : 3.14));
    const Alignment found = align(source, target, moved(truth, by));
    const Off wrong = off(found.x_ts, truth);
    const bool right = wrong.m < 0.05 && wrong.deg < 0.5;
    found_right += right ? 1 : 0;
    EXPECT_TRUE(right || found.verdict != Verdict::Good)
        << i << ": off by " << wrong.m << " m, " << wrong.deg << " deg";
  }
  EXPECT_GT(found_right, 0);
}

TEST(CellsRealData, HalfAScanIsFoundAndAHalfThatIsMissingIsTold) {
  ROVERD_REAL_DATA(path, kSource);
  const Cloud target = points_of(kTarget);
  const Cloud source = points_of(kSource);
  const Eigen::Isometry3d truth = matrix();
  const Eigen::Isometry3d start = moved(truth, pose(0.6, -0.5, 0.1, 0.1));
  const Relief whole = relief_of(target);
  for (const bool upper : {false, true}) {
    const Alignment found = align(relief_of(half_of(source, 0, upper)), whole, start);
    EXPECT_EQ(found.verdict, Verdict::Good);
    // Halves differ by some centimetres (what moved, what bent the scans), and that is said.
    const Eigen::Vector3d e = found.x_ts.translation() - truth.translation();
    EXPECT_LT(e.norm(), 0.06);
    EXPECT_LT(e.dot(found.covariance.topLeftCorner<3, 3>().inverse() * e), 16.3);  // 99.9 %
  }
  const Alignment missing = align(relief_of(source), relief_of(half_of(target, 1, true)), start);
  EXPECT_EQ(missing.verdict, Verdict::LittleOverlap);
}

TEST(CellsRealData, ARevolutionIsFoundInItselfAndNowhereElse) {
  ROVERD_REAL_DATA(path, kTurn);
  const auto cloud = read_pcd_cloud(tests::read_file(path));
  ASSERT_TRUE(cloud);
  const Relief turn = relief_of(*cloud);
  const Relief pair = relief_of(points_of(kTarget));
  ASSERT_FALSE(pair.surfels().empty());
  const Eigen::Isometry3d here = pose(0, 0, 0, 0);
  std::mt19937 random(5);
  for (int i = 0; i < 20; ++i) {
    const Alignment near = align(turn, turn, random_offset(random, 1.0, 10.0));
    EXPECT_EQ(near.verdict, Verdict::Good) << i;
    EXPECT_LT(off(near.x_ts, here).m, 0.005) << i;
    EXPECT_LT(off(near.x_ts, here).deg, 0.05) << i;
    const Alignment far = align(turn, turn, random_offset(random, 20.0, 180.0));
    EXPECT_TRUE(far.verdict != Verdict::Good || off(far.x_ts, here).m < 0.05) << i;
    const Alignment elsewhere = align(turn, pair, random_offset(random, 20.0, 180.0));
    EXPECT_NE(elsewhere.verdict, Verdict::Good) << i;
  }
}

}  // namespace
}  // namespace roverd::nav::cells
