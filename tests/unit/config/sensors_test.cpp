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
  EXPECT_EQ(s->robot.protect.gap_m, 0.4);
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

/// The sensor that maps are looked for with must be there, on, and see walls.
TEST(Sensors, TheOneForMapsMustBeOneThatLooksAround) {
  const std::string sees = "[sensors.front]\nkind = \"sick\"\nlink = \"tcp:a:1\"\n";
  const std::string map = "[map]\nsensor = \"front\"\n";
  const auto s = with(map + sees);
  ASSERT_TRUE(s) << s.error().detail;
  EXPECT_EQ(s->map.sensor, "front");
  EXPECT_NE(refused(map).find("map.sensor names no sensor"), std::string::npos) << refused(map);
  EXPECT_NE(refused(map + sees + "enabled = false\n").find("not enabled"), std::string::npos);
  EXPECT_NE(refused(map + "[sensors.front]\nkind = \"vision\"\nlink = \"udp:5005\"\n")
                .find("sees no walls"),
            std::string::npos);
}

TEST(Sensors, WhatFollowsWhenTheyBlockADriveIsOneOfFourWords) {
  const auto s = with("[sense.blocked]\nafter_s = 25\nthen = \"return\"\nresume_blind = true\n");
  ASSERT_TRUE(s) << s.error().detail;
  EXPECT_EQ(s->robot.blocked.after_s, 25.0);
  EXPECT_EQ(s->robot.blocked.then, "return");
  EXPECT_TRUE(s->robot.blocked.resume_blind);
  EXPECT_FALSE(s->robot.blocked.around_at_once);
  const std::string no = refused("[sense.blocked]\nthen = \"jump\"\n");
  EXPECT_NE(no.find("robot.toml:2: sense.blocked.then must be wait"), std::string::npos) << no;
  EXPECT_NE(refused("[sense.blocked]\nafter_s = 0\n").find("after_s"), std::string::npos);
}

TEST(Sensors, TheStopByCountedRaysIsOffUntilItIsSet) {
  EXPECT_FALSE(with("")->robot.rays.enabled);
  const auto s =
      with("[sense.rays]\nenabled = true\ninstead = true\nstop_m = 0.9\nstop_rays = 7\n");
  ASSERT_TRUE(s) << s.error().detail;
  EXPECT_TRUE(s->robot.rays.enabled);
  EXPECT_TRUE(s->robot.rays.instead);
  EXPECT_EQ(s->robot.rays.stop_m, 0.9);
  EXPECT_EQ(s->robot.rays.stop_rays, 7);
  EXPECT_EQ(s->robot.rays.stop_fan_deg, 15.94);
  const std::string no = refused("[sense.rays]\nenabled = true\nstop_m = 3.5\n");
  EXPECT_NE(no.find("robot.toml:3: sense.rays.stop_m must not be more than far_m"),
            std::string::npos)
      << no;
  EXPECT_NE(refused("[sense.rays]\ninstead = true\n").find("sense.rays.instead needs enabled"),
            std::string::npos);
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

/// Two sensors of their kinds on their links, and more of the configuration.
std::string together(const std::string& a, const std::string& b, const std::string& more = "") {
  return refused(more + "[sensors.a]\n" + a + "[sensors.b]\n" + b);
}

TEST(Sensors, TwoOnOnePortAreRefusedWithBothKeys) {
  const std::string lidar = "kind = \"velodyne\"\nlink = \"udp:2368\"\n";
  const std::string twice = together(lidar, lidar);
  EXPECT_NE(twice.find("robot.toml:6: sensors.b.link takes UDP port 2368, which sensors.a.link "
                       "(udp:2368) has, too"),
            std::string::npos)
      << twice;
  // The same port, said otherwise.
  EXPECT_NE(together(lidar, "kind = \"velodyne\"\nlink = \"udp:2368:192.168.1.201:2368\"\n")
                .find("takes UDP port 2368, which sensors.a.link"),
            std::string::npos);
  EXPECT_NE(
      together(lidar, "kind = \"velodyne\"\nlink = \"udp:02368\"\n").find("takes UDP port 2368"),
      std::string::npos);
  // A peer alone is heard at some other port: no lidar sends there.
  EXPECT_NE(together(lidar, "kind = \"velodyne\"\nlink = \"udp:127.0.0.1:2368\"\n")
                .find("sensors.b.link must name the port here, too"),
            std::string::npos);
  EXPECT_EQ(together(lidar, "kind = \"velodyne\"\nlink = \"udp:2369\"\n"), "taken");
  // One that is not there takes nothing.
  EXPECT_EQ(together(lidar, lidar + "enabled = false\n"), "taken");
}

TEST(Sensors, OneDeviceOrPortForTwoIsRefusedAlsoOfADriverOrTheServer) {
  const std::string lidar = "kind = \"velodyne\"\nlink = \"udp:2368\"\n";
  const std::string rangers = "kind = \"ranges\"\nlink = \"serial:/dev/ttyUSB7:115200\"\n";
  EXPECT_NE(together(rangers, "kind = \"ranges\"\nlink = \"serial:/dev/ttyUSB7:9600\"\n")
                .find("sensors.b.link takes /dev/ttyUSB7, which sensors.a.link"),
            std::string::npos);
  EXPECT_NE(together(lidar, rangers,
                     "[drivers.gnss]\nenabled = true\nlink = \"serial:/dev/ttyUSB7:auto\"\n")
                .find("sensors.b.link takes /dev/ttyUSB7, which drivers.gnss.link "
                      "(serial:/dev/ttyUSB7:auto) has, too"),
            std::string::npos);
  const std::string camera = "kind = \"cloud\"\nlink = \"listen:7001\"\n";
  EXPECT_NE(together(camera, camera).find("takes TCP port 7001, which sensors.a.link"),
            std::string::npos);
  EXPECT_NE(together(lidar, camera, "[server]\nport = 7001\n")
                .find("takes TCP port 7001, which server.port"),
            std::string::npos);
  const std::string scanner = "kind = \"sick\"\nlink = \"tcp:10.0.0.2:2111\"\n";
  EXPECT_NE(together(scanner, scanner).find("sensors.b.link is the same that sensors.a.link"),
            std::string::npos);
  EXPECT_EQ(together(scanner, "kind = \"sick\"\nlink = \"tcp:10.0.0.3:2111\"\n"), "taken");
  // Another name of the same device.
  const auto folder = std::filesystem::temp_directory_path();
  const auto real = folder / "roverd-sensors-device";
  const auto other = folder / "roverd-sensors-by-id";
  std::ofstream(real) << "";
  std::error_code ec;
  std::filesystem::remove(other, ec);
  std::filesystem::create_symlink(real, other);
  EXPECT_NE(together("kind = \"ranges\"\nlink = \"serial:" + real.string() + ":9600\"\n",
                     "kind = \"ranges\"\nlink = \"serial:" + other.string() + ":9600\"\n")
                .find("roverd-sensors-device, which sensors.a.link"),
            std::string::npos);
  std::filesystem::remove(other);
  std::filesystem::remove(real);
}

TEST(Sensors, AKindIsHeardByItsOwnLinksOnly) {
  const auto of = [](const std::string& kind, const std::string& link) {
    const std::string more = kind == "depth" ? "fx = 525\n" : "";
    return refused("[sensors.a]\nkind = \"" + kind + "\"\nlink = \"" + link + "\"\n" + more);
  };
  EXPECT_NE(of("velodyne", "tcp:10.0.0.2:2368")
                .find("robot.toml:3: sensors.a.link must be udp:PORT or udp:PORT:HOST:PORT for the "
                      "kind velodyne, is \"tcp:10.0.0.2:2368\""),
            std::string::npos);
  for (const auto& [kind, link] :
       std::vector<std::pair<std::string, std::string>>{{"sick", "udp:2111"},
                                                        {"sick", "listen:2111"},
                                                        {"velodyne", "serial:/dev/ttyUSB0:9600"},
                                                        {"vision", "tcp:10.0.0.2:7101"},
                                                        {"cloud", "udp:7001"},
                                                        {"cloud", "listen:0"},
                                                        {"cloud", "listen:65536"},
                                                        {"ranges", "tcp:10.0.0.2:1"},
                                                        {"depth", "/dev/video0"},
                                                        {"depth", "v4l2:video0"},
                                                        {"depth", "tcp:10.0.0.2:1"},
                                                        {"cloud", "nonsense"}}) {
    EXPECT_NE(of(kind, link).find("sensors.a.link must"), std::string::npos) << kind << link;
  }
  for (const auto& [kind, link] :
       std::vector<std::pair<std::string, std::string>>{{"sick", "tcp:10.0.0.2:2111"},
                                                        {"sick", "replay:a.raw"},
                                                        {"velodyne", "udp:2368"},
                                                        {"velodyne", "replay:a.pcap"},
                                                        {"cloud", "listen:7001"},
                                                        {"cloud", "tcp:10.0.0.2:7001"},
                                                        {"ranges", "serial:/dev/ttyUSB0:9600"},
                                                        {"depth", "v4l2:/dev/video2"}}) {
    EXPECT_EQ(of(kind, link), "taken") << kind << link;
  }
}

TEST(Sensors, ADepthCameraHasItsOwnSettingsAndThoseOfItsDriver) {
  const auto s = with(R"(
[sensors.face]
kind = "depth"
link = "v4l2:/dev/video2"
width = 1280
height = 720
fx = 640.5
depth_unit_m = 0.0005
decimate = 4
)");
  ASSERT_TRUE(s) << s.error().detail;
  const Sensor& face = s->sensors.at("face");
  EXPECT_EQ(face.depth.width, 1280);
  EXPECT_EQ(face.depth.fx, 640.5);
  EXPECT_EQ(face.cloud.decimate, 4);
  EXPECT_FALSE(face.said.planar());
  EXPECT_TRUE(as_heard(face).same_clock);
  EXPECT_GE(as_heard(face).max_points, 1280 * 720);
  EXPECT_NE(refused("[sensors.face]\nkind = \"depth\"\nlink = \"v4l2:/dev/video2\"\n")
                .find("sensors.face.fx must be said"),
            std::string::npos);
}

TEST(Sensors, AVisionProgramTellsWhatItRecognisedAndIsNoPartOfThePicture) {
  const std::string front = "[sensors.front]\nkind = \"vision\"\nlink = \"udp:7101\"\n";
  const auto s = with(front + "latency_s = 0.3\nyaw_deg = 20\nx_m = 0.2\n");
  ASSERT_TRUE(s) << s.error().detail;
  EXPECT_EQ(s->sensors.at("front").vision.latency_s, 0.3);
  EXPECT_FALSE(s->sensors.at("front").said.ranging());
  EXPECT_NE(refused(front + "pitch_deg = 5\n").find("sensors.front.pitch_deg must be 0"),
            std::string::npos);
  EXPECT_NE(refused(front + "[sensors.side]\nkind = \"vision\"\nlink = \"udp:7101\"\n")
                .find("takes UDP port 7101"),
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
