// Two recorded drives through buildings, against the maps drawn from every other scan of them: odd
// scans alone are given and compared. The poses compared with are themselves good to about 2 cm and
// 0.3 deg.

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "atlas/map_files.hpp"
#include "base/angle.hpp"
#include "real_data.hpp"
#include "tools/locate_run.hpp"

namespace {

using namespace roverd;
using nav::place::Field;

std::shared_ptr<const Field> field_of(const std::filesystem::path& words_path,
                                      const std::filesystem::path& picture_path) {
  const auto text = tests::read_file(words_path);
  const auto words = atlas::read_words({reinterpret_cast<const char*>(text.data()), text.size()});
  const auto picture = atlas::read_pgm(tests::read_file(picture_path));
  const auto map = atlas::map_of(*words, *picture);
  return std::make_shared<Field>(*map);
}

/// Odd scans only; the poses compared with are good to 2 cm and 0.3 deg, median: so many sigma.
LocateOptions odd_scans() {
  LocateOptions odd{WhichScans::Odd, WhichScans::Odd};
  odd.truth_m = 0.017;
  odd.truth_rad = base::rad_from_deg(0.44);
  return odd;
}

TEST(RealDrive, ThroughTheOfficeIsFollowed) {
  ROVERD_REAL_DATA(words, "sensors/carmen/intel-map.yaml");
  ROVERD_REAL_DATA(picture, "sensors/carmen/intel-map.pgm");
  ROVERD_REAL_DATA(log, "sensors/carmen/intel-corrected.log.gz");
  const auto scans = scans_of_log(tests::read_file(log));
  ASSERT_TRUE(scans) << scans.error().detail;
  const LocateFigures f = locate_log(field_of(words, picture), *scans, odd_scans());
  SCOPED_TRACE(figures_text(f));
  EXPECT_EQ(f.scored, 455U);
  EXPECT_EQ(f.lost, 0U);
  EXPECT_EQ(f.wrong, 0U);
  EXPECT_LE(f.doubtful, 4U);
  EXPECT_LT(f.median_m, 0.024);
  EXPECT_LT(f.p95_m, 0.065);
  EXPECT_LT(f.max_m, 0.40);
  EXPECT_LT(f.median_deg, 0.30);
  EXPECT_GT(f.within_95, 0.95);
  RecordProperty("figures", figures_text(f));
}

TEST(RealDrive, ThroughTheCorridorIsFollowed) {
  ROVERD_REAL_DATA(words, "sensors/carmen/freiburg-079-map.yaml");
  ROVERD_REAL_DATA(picture, "sensors/carmen/freiburg-079-map.pgm");
  ROVERD_REAL_DATA(log, "sensors/carmen/freiburg-079-corrected.log.gz");
  const auto scans = scans_of_log(tests::read_file(log));
  ASSERT_TRUE(scans) << scans.error().detail;
  const LocateFigures f = locate_log(field_of(words, picture), *scans, odd_scans());
  SCOPED_TRACE(figures_text(f));
  EXPECT_EQ(f.scored, 2395U);
  EXPECT_EQ(f.lost, 0U);
  EXPECT_EQ(f.wrong, 0U);
  EXPECT_LT(f.median_m, 0.025);
  EXPECT_LT(f.p95_m, 0.070);
  EXPECT_LT(f.max_m, 0.40);
  EXPECT_GT(f.within_95, 0.91);
  RecordProperty("figures", figures_text(f));
}

/// Ten of the hundred that `roverd locate --starts 100` tries.
TEST(RealDrive, AStartWithoutAPoseIsRightOrNotTold) {
  ROVERD_REAL_DATA(words, "sensors/carmen/intel-map.yaml");
  ROVERD_REAL_DATA(picture, "sensors/carmen/intel-map.pgm");
  ROVERD_REAL_DATA(log, "sensors/carmen/intel-corrected.log.gz");
  const auto scans = scans_of_log(tests::read_file(log));
  ASSERT_TRUE(scans) << scans.error().detail;
  const StartFigures f =
      start_in_log(field_of(words, picture), *scans, {WhichScans::Odd, WhichScans::Odd}, 10);
  SCOPED_TRACE(figures_text(f));
  EXPECT_EQ(f.starts, 10U);
  EXPECT_EQ(f.wrong, 0U);
  EXPECT_GE(f.right, 9U);
  RecordProperty("figures", figures_text(f));
}

/// Scans of the office in the map of a depot: somewhere in it most hits are near some wall, and no
/// place is called known. Three of the hundred of `roverd locate --starts 100`.
TEST(RealDrive, AStartInAnotherBuildingIsNotTold) {
  ROVERD_REAL_DATA(words, "sensors/maps/depot.yaml");
  ROVERD_REAL_DATA(picture, "sensors/maps/depot.pgm");
  ROVERD_REAL_DATA(log, "sensors/carmen/intel-corrected.log.gz");
  const auto scans = scans_of_log(tests::read_file(log));
  ASSERT_TRUE(scans) << scans.error().detail;
  const StartFigures f = start_in_log(field_of(words, picture), *scans, {}, 3);
  SCOPED_TRACE(figures_text(f));
  EXPECT_EQ(f.starts, 3U);
  EXPECT_EQ(f.untold, 3U);
  RecordProperty("figures", figures_text(f));
}

TEST(Log, WithoutAScanIsRefused) {
  const std::string text = "# nothing\nODOM 0 0 0\nFLASER 3 1\n";
  const auto scans =
      scans_of_log({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  ASSERT_FALSE(scans);
  EXPECT_EQ(scans.error().code, base::Code::Malformed);
  EXPECT_NE(scans.error().detail.find("line 3"), std::string::npos);
}

}  // namespace
