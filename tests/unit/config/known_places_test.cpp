// Things whose place is known: by the configuration, and in the file of those that people entered.

#include "config/known_places.hpp"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "base/angle.hpp"
#include "base/geo.hpp"

namespace roverd {
namespace {

base::KnownPlace gate() {
  base::KnownPlace out;
  out.name = "gate";
  out.at = {58.378, 26.729};
  out.tag = 5;
  out.yaw_rad = base::yaw_from_heading(180.0);
  out.sigma_m = 0.03;
  return out;
}

TEST(KnownPlacesFile, ComesBackAsItWasWritten) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("known_places." + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const auto file = folder / "known_places.json";
  ASSERT_TRUE(read_known_places(file)) << "missing, it holds none";
  base::KnownPlace pole;
  pole.name = "pole";
  pole.at = {58.379, 26.73};
  ASSERT_TRUE(write_known_places(file, {gate(), pole}));
  const auto back = read_known_places(file);
  ASSERT_TRUE(back);
  ASSERT_EQ(back->size(), 2u);
  EXPECT_EQ((*back)[0].tag, 5);
  EXPECT_NEAR(*(*back)[0].yaw_rad, -base::kPi / 2.0, 1e-9);
  EXPECT_NEAR((*back)[0].sigma_m, 0.03, 1e-12);
  EXPECT_FALSE((*back)[1].tag || (*back)[1].yaw_rad);
  EXPECT_EQ((*back)[1].at.lat, 58.379);
  std::filesystem::remove_all(folder);
}

TEST(KnownPlacesFile, OneThatIsDamagedIsRefusedAndNamesWhere) {
  EXPECT_FALSE(known_places_from("{\"known_places\": ["));
  EXPECT_FALSE(known_places_from("[]"));
  std::string text = known_places_text({gate(), gate()});
  text.replace(text.rfind("58.378"), 6, "98.378");
  const auto wrong = known_places_from(text);
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().detail.find("known_places/1"), std::string::npos);
}

TEST(KnownPlacesConfigured, StandByLatitudeOrFromTheLocalMap) {
  nav::EstimateParams estimate;
  KnownPlaceSections said;
  said["gate"].tag = 5;
  said["gate"].east_m = 3.0;
  said["gate"].north_m = 4.0;
  const auto no_map = check(said, estimate);
  ASSERT_FALSE(no_map);
  EXPECT_EQ(no_map.error().fields.front().pointer, "known_places.gate.lat");
  estimate.map_lat = 58.378;
  estimate.map_lon = 26.729;
  ASSERT_TRUE(check(said, estimate));
  const auto made = known_places_of(said, estimate);
  ASSERT_EQ(made.size(), 1u);
  EXPECT_TRUE(made[0].configured);
  EXPECT_NEAR(base::distance_bearing({58.378, 26.729}, made[0].at).distance_m, 5.0, 1e-3);
  said["door"] = said["gate"];
  EXPECT_FALSE(check(said, estimate)) << "two have tag 5";
  said["door"].tag = -1;
  said["door"].heading_deg = 90.0;
  EXPECT_FALSE(check(said, estimate)) << "a pole looks nowhere";
}

}  // namespace
}  // namespace roverd
