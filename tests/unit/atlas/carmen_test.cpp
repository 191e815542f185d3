// Logs of CARMEN: records, the chained odometry, and lines that are none.

#include "atlas/carmen.hpp"

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace {

using namespace roverd;
using atlas::CarmenReader;
using atlas::CarmenScan;

struct Log {
  std::vector<CarmenScan> scans;
  CarmenReader reader{[this](const CarmenScan& s) { scans.push_back(s); }};

  explicit Log(std::string_view text, std::size_t piece = 1000) {
    const base::Bytes bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    for (std::size_t at = 0; at < bytes.size(); at += piece) {
      reader.feed(bytes.subspan(at, std::min(piece, bytes.size() - at)));
    }
    reader.finish();
  }
};

// The corrected pose is one metre off the odometry: the odometry goes on from it, the jump is none.
constexpr std::string_view kCorrected =
    "# message formats defined: PARAM SYNC ODOM FLASER\n"
    "PARAM robot_frontlaser_offset 0.0 nohost 0\n"
    "ODOM 0 0 0 0 0 0 0.1 pippo 0.1\n"
    "ODOM 0.5 0 0 0 0 0 0.2 pippo 0.2\n"
    "FLASER 4 1 2 3 81.9 1.5 0 0 1.5 0 0 0.25 pippo 0.25\n"
    "NEFF 0.5\n"
    "ODOM 1.5 0 0 0 0 0 0 pippo 0\n"
    "ODOM 1.7 0 0 0 0 0 0.3 pippo 0.3\n"
    "ODOM 1.9 0.1 0 0 0 0 0.4 pippo 0.4\n"
    "FLASER 5 1 2 3 4 5 2.9 0 0 2.9 0 0 0.2 pippo 0.2";

TEST(Carmen, OdometryIsChainedOverTheJumpsOfTheCorrection) {
  for (const std::size_t piece : {1000U, 7U, 1U}) {
    const Log log(kCorrected, piece);
    ASSERT_EQ(log.scans.size(), 2U);
    EXPECT_EQ(log.reader.refused(), 0U);
    EXPECT_EQ(log.reader.odometry_lines(), 5U);
    EXPECT_DOUBLE_EQ(log.scans[0].odometry.x_m, 1.5) << "begins at the first pose";
    EXPECT_NEAR(log.scans[1].odometry.x_m, 1.9, 1e-12);
    EXPECT_NEAR(log.scans[1].odometry.y_m, 0.1, 1e-12);
    EXPECT_DOUBLE_EQ(log.scans[1].pose.x_m, 2.9);
    EXPECT_DOUBLE_EQ(log.scans[1].time_s, 0.2) << "stamps are told as they stand";
    EXPECT_EQ(log.scans[1].line, 10U);
  }
}

TEST(Carmen, BeamsLieOverTheHalfCircleAhead) {
  const Log log(kCorrected);
  EXPECT_FLOAT_EQ(log.scans[0].first_rad, -1.5707964F);
  EXPECT_FLOAT_EQ(log.scans[0].step_rad, 0.78539816F) << "four beams end one step before +90";
  EXPECT_FLOAT_EQ(log.scans[1].step_rad, 0.78539816F) << "five reach it";
  EXPECT_FLOAT_EQ(log.scans[0].ranges_m.at(3), 81.9F);
}

TEST(Carmen, BrokenRecordsAreCountedAndTheFirstIsNamed) {
  const Log log(
      "ODOM 1 2\n"
      "ODOM 1 2 x 0 0 0 0 h 0\n"
      "FLASER 3 1 2\n"
      "FLASER 99999 1\n"
      "FLASER -1 1\n"
      "FLASER 1.5 1\n"
      "FLASER 1 nan 0 0 0 0 0 0 0 h 0\n"
      "FLASER 1 2 0 0 0 0 0 0\n"
      "\n\r\nNOISE\n"
      "FLASER 1 2 0 0 0 0 0 0 7 h 7\r\n");
  EXPECT_EQ(log.reader.refused(), 8U);
  EXPECT_EQ(log.reader.first_refused(), "line 1: ODOM without x, y and theta");
  ASSERT_EQ(log.scans.size(), 1U);
  EXPECT_DOUBLE_EQ(log.scans[0].time_s, 7.0);
}

TEST(Carmen, AnEndlessLineIsDropped) {
  const std::string log = "FLASER 1 " + std::string(200'000, '1') + "\n" + std::string(kCorrected);
  const Log read(log);
  EXPECT_EQ(read.reader.refused(), 1U);
  EXPECT_EQ(read.reader.first_refused(), "line 1: longer than 64 KiB");
  EXPECT_EQ(read.scans.size(), 2U);
}

}  // namespace
