// A vehicle in a world: what the side channel tells of contacts, and what the ground does to it.

#include "sim/surroundings.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "plant.hpp"
#include "sim/config.hpp"
#include "sim/control.hpp"

namespace roverd::sim {
namespace {

using nlohmann::json;

world::World with_a_pole() {
  world::Thing pole;
  pole.kind = world::Kind::Pole;
  pole.name = "post";
  pole.points = {{3.0, 0.0}};
  pole.radius_m = 0.1;
  pole.height_m = 1.0;
  world::World w;
  w.name = "a post";
  w.things = {pole};
  return w;
}

struct Scenery : Plant {
  explicit Scenery(world::World w) : Plant(ideal()), around(std::move(w), BodyParams{}, Time{}) {
    around.attend(bunker);
  }
  json ask(const std::string& line) {
    return json::parse(carry_out(line, bunker, Time{}, &around).line);
  }
  Surroundings around;
};

//  [robot] ───▶ o       3 m to the post, the front 0.51 m ahead
TEST(Surroundings, TellContactsWithTimeAndName) {
  Scenery s(with_a_pole());
  s.enter_can();
  EXPECT_NEAR(s.ask(R"({"get":"truth"})").at("clearance_m").get<double>(), 2.9 - 0.51, 1e-6);
  s.drive(1.0, 0.0, 4s);
  const json told = s.ask(R"({"get":"world"})");
  EXPECT_EQ(told.at("contacts"), 1);
  EXPECT_EQ(told.at("brushes"), 0);
  ASSERT_EQ(told.at("touched").size(), 1u);
  const json& touched = told["touched"][0];
  EXPECT_EQ(touched.at("what"), "post");
  EXPECT_FALSE(touched.at("moving").get<bool>());
  EXPECT_NEAR(touched.at("east_m").get<double>(), 2.39, 0.006) << "within one step";
  EXPECT_NEAR(touched.at("speed_mps").get<double>(), 1.0, 0.01);
  EXPECT_EQ(json::parse(truth_line(s.truth(), Time{}, &s.around)).at("contacts"), 1);
  EXPECT_TRUE(s.ask(R"({"forget":true})").at("ok").get<bool>());
  EXPECT_EQ(s.ask(R"({"get":"truth"})").at("contacts"), 0);
}

TEST(Surroundings, SwitchedOffNothingIsThereToTouch) {
  Scenery s(with_a_pole());
  s.ask(R"({"world":false})");
  s.enter_can();
  s.drive(1.0, 0.0, 4s);
  const json told = s.ask(R"({"get":"world"})");
  EXPECT_FALSE(told.at("world").get<bool>());
  EXPECT_EQ(told.at("contacts"), 0);
}

/// Ann would walk after a day; told to, she walks at once, into the robot that stands.
TEST(Surroundings, SomebodyWalksWhenTold) {
  world::World yard;
  world::Thing ann;
  ann.kind = world::Kind::Person;
  ann.name = "Ann";
  ann.points = {{3.0, 0.0}, {-3.0, 0.0}};
  ann.motion = world::Motion::Once;
  ann.start_s = 86'400.0;
  yard.things = {ann};
  Scenery s(yard);
  s.wait(3s);
  EXPECT_EQ(s.ask(R"({"get":"world"})").at("contacts"), 0);
  EXPECT_EQ(s.ask(R"({"walk":"Bob"})").at("error"), "nobody of that name walks: Bob");
  EXPECT_EQ(s.ask(R"({"walk":1})").at("error"), "walk must be the name of a person or an animal");
  EXPECT_TRUE(s.ask(R"({"walk":"Ann"})").at("ok").get<bool>());
  s.wait(1s);
  EXPECT_EQ(s.ask(R"({"get":"world"})").at("contacts"), 0) << "1.2 m of 2.3";
  s.wait(2s);
  EXPECT_EQ(s.ask(R"({"get":"world"})").at("contacts"), 1);
}

TEST(Surroundings, WithoutAWorldTheSideChannelSaysSo) {
  Plant plant(ideal());
  const auto say = [&](const char* line) { return carry_out(line, plant.bunker, Time{}).line; };
  EXPECT_EQ(say(R"({"world":true})"), R"({"error":"there is no world: world"})");
  EXPECT_EQ(say(R"({"get":"world"})"), R"({"error":"get must be truth, faults, radio or params"})");
}

TEST(Surroundings, TheVehicleLeansAsTheGroundLies) {
  world::World w;
  w.ground.slope_rad = base::rad_from_deg(10.0);
  w.ground.uphill_rad = 0.0;  // rises to the east, where the robot drives
  Scenery s(w);
  s.enter_can();
  s.drive(0.5, 0.0, 2s);
  EXPECT_NEAR(base::deg_from_rad(s.truth().pitch_rad), 10.0, 1e-6) << "nose up";
  EXPECT_NEAR(s.truth().roll_rad, 0.0, 1e-9);
  const world::Pose pose = s.around.pose_at(s.around.now_s());
  EXPECT_NEAR(pose.pitch_rad, -base::rad_from_deg(10.0), 1e-9) << "down positive";
  EXPECT_NEAR(pose.z_m, pose.x_m * std::tan(base::rad_from_deg(10.0)), 1e-9);
}

TEST(Surroundings, KnowWhereTheBodyWasBetweenItsSteps) {
  Scenery s(with_a_pole());
  s.enter_can();
  s.drive(1.0, 0.0, 2s);
  const double now = s.around.now_s();
  const double here = s.around.pose_at(now).x_m;
  EXPECT_NEAR(s.around.pose_at(now - 0.0125).x_m, here - 0.0125, 1e-5);
  EXPECT_EQ(s.around.pose_at(now + 1.0).x_m, here);
}

TEST(SensorTables, AreReadStrictly) {
  Config c;
  const auto error = [&](const char* text) {
    const auto done = read_config(c, text, "sim.toml");
    return done ? std::string("taken") : done.error().detail;
  };
  ASSERT_EQ(error("[world]\nfile = \"random:3\"\n[[sensor]]\nkind = \"vlp16\"\nx_m = 0.1\n"
                  "[[sensor]]\nname = \"front\"\nrate_hz = 50\nstep_deg = 0.5\n"),
            "taken");
  EXPECT_EQ(c.world, "random:3");
  ASSERT_EQ(c.sensors.size(), 2u);
  EXPECT_EQ(c.sensors[0].name, "vlp16");
  EXPECT_EQ(c.sensors[0].far_m, 100.0) << "usual for its kind";
  EXPECT_EQ(c.sensors[1].rate_hz, 50.0);
  EXPECT_TRUE(apply_override(c, "sensor.front.x_m=0.4"));
  EXPECT_EQ(c.sensors[1].x_m, 0.4);
  EXPECT_EQ(apply_override(c, "sensor.rear.x_m=0.4").error().detail,
            "--set sensor.rear.x_m=0.4: unknown key sensor.rear.x_m");

  EXPECT_EQ(error("[[sensor]]\nkind = \"sonar\"\n"),
            "sim.toml:1: sensor.kind must be lms, vlp16, depth, range, vision or picture");
  EXPECT_EQ(error("[[sensor]]\nkind = \"vlp16\"\nreturns = \"both\"\n"),
            "sim.toml:1: sensor.returns must be strongest, last or dual");
  EXPECT_EQ(error("[[sensor]]\nkind = \"lms\"\nreturns = \"dual\"\n"),
            "sim.toml:1: sensor.returns is a vlp16's");
  EXPECT_EQ(error("[[sensor]]\nrange_m = 3\n"), "sim.toml:2: unknown key sensor.range_m");
  EXPECT_EQ(error("[[sensor]]\nrate_hz = 500\n"),
            "sim.toml:2: sensor.rate_hz must lie in 0.1 .. 100.0");
  EXPECT_EQ(error("[[sensor]]\n[[sensor]]\n"), "sim.toml:2: sensor.name lms is there twice");
  EXPECT_EQ(
      error(
          "[[sensor]]\nname=\"a\"\nport=\"tcp:2111\"\n[[sensor]]\nname=\"b\"\nport=\"tcp:2111\"\n"),
      "sim.toml:4: sensor.port tcp:2111 is a's");
  EXPECT_EQ(error("[[sensor]]\nport=\"udp:5000\"\n"),
            "sim.toml:1: sensor.port must be tcp or pty, udp is a vlp16's and a vision program's");
  EXPECT_EQ(error("[world]\nfile = 3\n"), "sim.toml:2: world.file must be text");
  EXPECT_EQ(c.sensors.size(), 2u) << "refused texts change nothing";
  EXPECT_TRUE(load_world("random:3:moving"));
  EXPECT_EQ(
      load_world("random:3:fast").error().detail,
      "random:3:fast: must be random:N or random:N:KIND with static, moving, grass or crowded");
  EXPECT_EQ(load_world("/nowhere.json").error().detail, "cannot read the world /nowhere.json");
}

TEST(SensorFaults, AreSwitchedLikeAllOthers) {
  Plant plant(ideal());
  const auto say = [&](const char* line) { return carry_out(line, plant.bunker, Time{}).line; };
  EXPECT_EQ(say(R"({"fault":{"sensor":"front","sensor_silent":true,"rain_per_m":0.02}})"),
            R"({"ok":true})");
  EXPECT_TRUE(plant.bunker.faults().see.sensor_silent);
  EXPECT_EQ(plant.bunker.faults().see.rain_per_m, 0.02);
  EXPECT_EQ(say(R"({"fault":{"dirt_share":2}})"),
            R"({"error":"dirt_share must lie in 0.0 .. 1.0"})");
}

}  // namespace
}  // namespace roverd::sim
