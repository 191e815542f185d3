// Every key by which the robot's seeing is set stands in docs/sense-keys.md, as the code has it;
// and the vehicle from which its rules come has them.

#include <cstdio>
#include <fstream>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "config/settings.hpp"
#include "source_folder.hpp"

namespace roverd {
namespace {

std::string text_of(const base::ParamValue& value) {
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* word = std::get_if<std::string>(&value)) return *word;
  char text[32];
  std::snprintf(text, sizeof text, "%g", std::get<double>(value));
  return text;
}

/// The row of one key.
std::string row(const std::string& key, const base::ParamInfo& info) {
  std::string range;
  if (info.min && info.max) range = text_of(*info.min) + " to " + text_of(*info.max);
  std::string says;
  for (const char c : info.description) says += c == '|' ? std::string("\\|") : std::string(1, c);
  return "| `" + key + "` | " + text_of(info.value) + " | " + range + " | " + says + " |";
}

std::multiset<std::string> rows_of_the_page() {
  std::multiset<std::string> out;
  std::ifstream in(tests::in_source("docs/sense-keys.md"));
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("| `")) out.insert(line);
  }
  return out;
}

struct Rows {
  std::multiset<std::string> out;

  template <class P>
  void operator()(const std::string& section, const P& params) {
    for (const auto& info : base::describe(params)) {
      out.insert(row(section.empty() ? info.name : section + "." + info.name, info));
    }
  }
};

TEST(SenseKeys, AllStandInThePageAsTheyAreAndNoOthers) {
  Rows rows;
  SenseSettings sense;
  sections(rows, sense);
  robot::Config guard;
  rows("sense.rays", guard.rays);
  rows("sense.protect", guard.protect);
  rows("sense.blocked", guard.blocked);
  rows("nav.row", guard.row);
  rows("nav.rows", guard.rows);
  rows("nav.sight", guard.sight);
  rows("nav.wall", guard.wall);
  rows("nav.landmarks", guard.landmarks);
  rows("nav.tag_dock", guard.tag_dock);
  rows("", SensorSettings{});
  rows("", cloud::Params{});
  rows("", v4l2::Params{});
  rows("", ranges::Params{});
  rows("", sick::Params{});
  rows("", velodyne::Params{});
  rows("", vision::Params{});
  const auto page = rows_of_the_page();
  for (const std::string& line : rows.out) {
    EXPECT_EQ(page.count(line), rows.out.count(line)) << "in docs/sense-keys.md is missing:\n"
                                                      << line;
  }
  for (const std::string& line : page) {
    EXPECT_GT(rows.out.count(line), 0U) << "docs/sense-keys.md tells of what there is not:\n"
                                        << line;
  }
}

TEST(SenseKeys, TheHuskyHasTheRulesOfTheBerryRows) {
  const auto s = load_settings({tests::in_source("config/robot.toml"), "husky", {}});
  ASSERT_TRUE(s) << s.error().detail;
  EXPECT_EQ(s->sense.reduce.max_range_m, 8.0);
  EXPECT_EQ(s->sense.reduce.voxel_m, 0.05);
  // The planar scan out of its depth camera, and the stop by counted rays.
  const nav::sense::RaysParams& rays = s->robot.rays;
  EXPECT_EQ(rays.fan_deg, 34.0);
  EXPECT_EQ(rays.step_deg, 1.0);
  EXPECT_EQ(rays.band_m, 0.30);
  EXPECT_EQ(rays.far_m, 3.0);
  EXPECT_EQ(rays.far_as_m, 4.0);
  EXPECT_EQ(rays.stop_fan_deg, 15.94);
  EXPECT_EQ(rays.stop_m, 0.70);
  EXPECT_EQ(rays.stop_rays, 5);
}

TEST(SenseKeys, TheExampleOfTheHuskysCameraIsTaken) {
  const auto s = load_settings({tests::in_source("config/robot.toml"),
                                "husky",
                                {"sensors.camera.kind=depth", "sensors.camera.fx=385",
                                 "sensors.camera.link=v4l2:/dev/video2", "sensors.camera.x_m=0.45",
                                 "sensors.camera.z_m=0.5", "sensors.camera.rate_hz=15"}});
  ASSERT_TRUE(s) << s.error().detail;
  EXPECT_EQ(s->sensors.at("camera").depth.fx, 385.0);
  EXPECT_EQ(s->sensors.at("camera").said.mount().x_m, 0.45);
}

}  // namespace
}  // namespace roverd
