// Sections of sensors: made by their name, read by their kind, refused with file, line and key.

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "config/settings.hpp"

namespace roverd {
namespace {

/// A configuration of the Bunker with more in it.
base::Result<Settings> with(const std::string& text, std::vector<std::string> overrides = {}) {
  const auto folder =
      std::filesystem::temp_directory_path() /
      ("roverd-sensors-" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) +
       ::testing::UnitTest::GetInstance()->current_test_info()->name());
  std::filesystem::create_directories(folder / "vehicles");
  std::ofstream(folder / "vehicles" / "bunker.toml") << "";
  std::ofstream(folder / "robot.toml") << text;
  auto settings = load_settings({folder / "robot.toml", "bunker", std::move(overrides)});
  std::filesystem::remove_all(folder);
  return settings;
}

std::string refused(const std::string& text) {
  const auto settings = with(text);
  return settings ? "taken" : settings.error().detail;
}

TEST(Sensors, AreReadByTheirKindWithTheirMount) {
  const auto s = with(R"(
[sensors.front]
link = "tcp:10.0.0.2:2111"
frequency_hz = 25
kind = "sick"
x_m = 0.5
yaw_deg = 90
[sensors.top]
kind = "velodyne"
link = "udp:2368"
required = false
[sense.protect]
gap_m = 0.4
)");
  ASSERT_TRUE(s) << s.error().detail;
  ASSERT_EQ(s->sensors.size(), 2u);
  EXPECT_EQ(s->sensors.at("front").sick.frequency_hz, 25.0);
  EXPECT_TRUE(s->sensors.at("front").said.planar());
  EXPECT_NEAR(s->sensors.at("front").said.mount().yaw_rad, base::kPi / 2.0, 1e-12);
  EXPECT_FALSE(s->sensors.at("top").said.required);
  EXPECT_EQ(s->sense.protect.gap_m, 0.4);
}

TEST(Sensors, OfTheCommandLineOverrideTheFile) {
  const auto s = with("[sensors.top]\nkind = \"velodyne\"\nlink = \"udp:2368\"\n",
                      {"sensors.top.link=udp:2400"});
  ASSERT_TRUE(s) << s.error().detail;
  EXPECT_EQ(s->sensors.at("top").said.link, "udp:2400");
}

TEST(Sensors, WhatIsWrongIsRefusedWithItsPlace) {
  EXPECT_NE(refused("[sensors.a]\nkind = \"radar\"\nlink = \"udp:1\"\n").find("robot.toml:2"),
            std::string::npos);
  EXPECT_NE(refused("[sensors.a]\nkind = \"sick\"\n").find("sensors.a.link"), std::string::npos);
  EXPECT_NE(refused("[sensors.a]\nkind = \"velodyne\"\nlink = \"udp:1\"\nfrequency_hz = 5\n")
                .find("unknown key sensors.a.frequency_hz"),
            std::string::npos);
  EXPECT_NE(refused("[sensors.\"A b\"]\nkind = \"sick\"\nlink = \"tcp:a:1\"\n").find("name"),
            std::string::npos);
  EXPECT_NE(refused("[sensors.gnss]\nkind = \"sick\"\nlink = \"tcp:a:1\"\n").find("driver"),
            std::string::npos);
  EXPECT_NE(refused("[sensors.a]\nkind = \"sick\"\nlink = \"tcp:a:1\"\nz_m = -1\n").find("z_m"),
            std::string::npos);
  EXPECT_NE(refused("[sensors.a]\nkind = \"sick\"\nlink = \"listen:9\"\n").find("listen"),
            std::string::npos);
}

TEST(Sensors, WhatFollowsWhenTheyBlockADriveIsOneOfFourWords) {
  const auto s = with("[sense.blocked]\nafter_s = 25\nthen = \"return\"\nresume_blind = true\n");
  ASSERT_TRUE(s) << s.error().detail;
  EXPECT_EQ(s->sense.blocked.after_s, 25.0);
  EXPECT_EQ(s->sense.blocked.then, "return");
  EXPECT_TRUE(s->sense.blocked.resume_blind);
  EXPECT_FALSE(s->sense.blocked.around_at_once);
  const std::string no = refused("[sense.blocked]\nthen = \"jump\"\n");
  EXPECT_NE(no.find("robot.toml:2: sense.blocked.then must be wait"), std::string::npos) << no;
  EXPECT_NE(refused("[sense.blocked]\nafter_s = 0\n").find("after_s"), std::string::npos);
}

TEST(Sensors, TheToolsOutlineStandsBesideItsPoint) {
  const auto s = with("[nav.tool]\nforward_m = -1.0\nlength_m = 0.8\nwidth_m = 1.6\n");
  ASSERT_TRUE(s) << s.error().detail;
  EXPECT_EQ(s->robot.tool.forward_m, -1.0);
  EXPECT_EQ(s->sense.outline.length_m, 0.8);
  EXPECT_EQ(s->sense.outline.width_m, 1.6);
  const std::string no = refused("[nav.tool]\nlength_m = 0.8\n");
  EXPECT_NE(no.find("nav.tool.width_m must be given as well"), std::string::npos) << no;
}

TEST(Sensors, TwoOnOnePortAreRefused) {
  EXPECT_NE(refused(R"(
[sensors.a]
kind = "velodyne"
link = "udp:2368"
[sensors.b]
kind = "velodyne"
link = "udp:2368"
)")
                .find("is that of sensor \"a\", too"),
            std::string::npos);
}

TEST(Sensors, MoreThanSixteenAreRefused) {
  std::string text;
  for (int i = 0; i < 17; ++i) {
    text += "[sensors.s" + std::to_string(i) +
            "]\nkind = \"velodyne\"\nlink = \"udp:" + std::to_string(3000 + i) + "\"\n";
  }
  EXPECT_NE(refused(text).find("more than 16 sensors"), std::string::npos);
}

}  // namespace
}  // namespace roverd
