#include "study/plant_line.hpp"

#include <nlohmann/json.hpp>

#include "base/angle.hpp"
#include "mission/json/json.hpp"
#include "mission/json/object.hpp"
#include "sim/receiver.hpp"

namespace roverd::study {
namespace {

using base::Result;
using mission::Members;
using nlohmann::json;

constexpr double kReach_m = 9900.0;  // what one local frame reaches
constexpr double kMost_mps = 100.0;
constexpr double kMost_radps = 50.0;

Result<sim::ForeignFix> read_fix(const json& value) {
  if (!value.is_object()) {
    return base::fail(base::Code::Invalid, "/gnss must be an object",
                      {{"/gnss", "must be an object"}});
  }
  sim::ForeignFix fix;
  Members members(value, "/gnss");
  members.require("fix");
  const std::string word = members.text("fix").value_or("none");
  if (const auto known = sim::fix_from(word)) {
    fix.fix = *known;
  } else {
    members.complain("fix", "must be rtk_fixed, rtk_float, dgps, gps or none");
  }
  if (fix.fix != base::FixType::None) {
    for (const char* name : {"east_m", "north_m", "sigma_m"}) members.require(name);
  }
  fix.at.east_m = members.number("east_m", -kReach_m, kReach_m).value_or(0.0);
  fix.at.north_m = members.number("north_m", -kReach_m, kReach_m).value_or(0.0);
  fix.sigma_m = members.number("sigma_m", 0.0, 1000.0).value_or(0.0);
  fix.speed_mps = members.number("speed_mps", 0.0, kMost_mps).value_or(0.0);
  fix.course_deg = members.number("course_deg", 0.0, 360.0);
  fix.heading_deg = members.number("heading_deg", 0.0, 360.0);
  fix.age_s = members.number("age_s", 0.0, 5.0).value_or(0.0);
  if (auto good = members.finish(); !good) return tl::unexpected(good.error());
  return fix;
}

/// What it says of its wheels, or what wheels that never slip would show.
void read_wheels(Members& members, const PlantHello& hello, sim::ForeignState& s) {
  const double half_m = hello.steered ? 0.0 : hello.track_width_m / 2.0;
  s.left_mps = members.number("left_mps", -kMost_mps, kMost_mps)
                   .value_or(s.speed_mps - s.yaw_rate_radps * half_m);
  s.right_mps = members.number("right_mps", -kMost_mps, kMost_mps)
                    .value_or(s.speed_mps + s.yaw_rate_radps * half_m);
  s.wheel_rad = members.number("wheel_rad", -1.5, 1.5);
}

}  // namespace

std::string hello_line(const PlantHello& hello) {
  nlohmann::ordered_json line{{"hello", 1},
                              {"vehicle", hello.vehicle},
                              {"seed", hello.seed},
                              {"dt_s", sim::Foreign::kStep_s},
                              {"steered", hello.steered},
                              {"heading_deg", hello.heading_deg}};
  if (hello.steered) {
    line["wheelbase_m"] = hello.wheelbase_m;
  } else {
    line["track_width_m"] = hello.track_width_m;
  }
  return line.dump();
}

std::string order_line(const sim::ForeignOrder& order, bool steered) {
  nlohmann::ordered_json line{
      {"t_s", order.t_s}, {"brake", order.brake}, {"speed_mps", order.speed_mps}};
  if (!steered) line["yaw_rate_radps"] = order.yaw_rate_radps;
  if (steered) line["wheel_rad"] = order.wheel_rad ? json(*order.wheel_rad) : json();
  return line.dump();
}

Result<PlantSaid> read_plant_line(std::string_view line, const PlantHello& hello, bool first) {
  const auto whole = mission::parse_json(line);
  if (!whole) return tl::unexpected(whole.error());
  if (!whole->is_object())
    return base::fail(base::Code::Invalid, "the line must be one JSON object");
  PlantSaid said;
  sim::ForeignState& s = said.state;
  Members members(*whole);
  for (const char* name : {"east_m", "north_m", "heading_deg", "speed_mps", "yaw_rate_radps"}) {
    members.require(name);
  }
  s.at.east_m = members.number("east_m", -kReach_m, kReach_m).value_or(0.0);
  s.at.north_m = members.number("north_m", -kReach_m, kReach_m).value_or(0.0);
  s.yaw_rad = base::yaw_from_heading(members.number("heading_deg", -360.0, 720.0).value_or(0.0));
  s.speed_mps = members.number("speed_mps", -kMost_mps, kMost_mps).value_or(0.0);
  s.yaw_rate_radps = members.number("yaw_rate_radps", -kMost_radps, kMost_radps).value_or(0.0);
  s.lateral_mps = members.number("lateral_mps", -kMost_mps, kMost_mps).value_or(0.0);
  s.roll_rad = base::rad_from_deg(members.number("roll_deg", -80.0, 80.0).value_or(0.0));
  s.pitch_rad = base::rad_from_deg(members.number("pitch_deg", -80.0, 80.0).value_or(0.0));
  read_wheels(members, hello, s);
  s.gyro_radps = members.number("gyro_radps", -kMost_radps, kMost_radps);
  s.compass_deg = members.number("compass_deg", 0.0, 360.0);
  if (first) said.own_gnss = members.flag("own_gnss").value_or(false);
  const json* fix = members.any("gnss");
  if (auto good = members.finish("the line"); !good) return tl::unexpected(good.error());
  if (fix != nullptr && !fix->is_null()) {
    auto read = read_fix(*fix);
    if (!read) return tl::unexpected(read.error());
    s.fix = *read;
  }
  return said;
}

}  // namespace roverd::study
