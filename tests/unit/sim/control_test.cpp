// The side channel's lines: what they do, and that bad ones change nothing.

#include "sim/control.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "plant.hpp"

namespace roverd::sim {
namespace {

using nlohmann::json;

struct Channel : Plant {
  std::string say(const std::string& line) { return carry_out(line, bunker, Time{}).line; }
  json ask(const std::string& line) { return json::parse(say(line)); }
  std::string error(const std::string& line) { return ask(line).value("error", "none"); }
};

TEST(Control, ATruthLineSaysEverythingInThePublicUnits) {
  Channel c;
  c.enter_can();
  c.drive(0.5, 0.1, 4s);
  const json t = json::parse(truth_line(c.truth(), Time{}));
  EXPECT_NEAR(t.at("t_s").get<double>(), 4.005, 1e-9);
  EXPECT_NEAR(t.at("speed_mps").get<double>(), 0.5, 1e-3);
  EXPECT_NEAR(t.at("yaw_rate_dps").get<double>(), 0.1 * 180.0 / base::kPi, 0.1);
  EXPECT_NEAR(t.at("heading_deg").get<double>(), base::heading_from_yaw(c.truth().yaw_rad), 1e-9);
  EXPECT_EQ(t.at("control_mode"), "can");
  EXPECT_EQ(t.at("vehicle_state"), "normal");
  EXPECT_EQ(t.at("commands"), 200);
  for (const char* key : {"lat", "lon", "east_m", "north_m", "battery_pct", "driven_m"}) {
    EXPECT_TRUE(t.at(key).is_number()) << key;
  }
}

TEST(Control, FaultsParametersAndChargeAreSet) {
  Channel c;
  EXPECT_EQ(c.say(R"({"set":{"gnss_outage":true,"drive.slip":0.3,"battery_pct":40}})"),
            R"({"ok":true})");
  EXPECT_TRUE(c.bunker.faults().gnss_outage);
  EXPECT_EQ(c.bunker.params().drive.slip, 0.3);
  EXPECT_EQ(c.truth().battery_pct, 40.0);
  EXPECT_EQ(c.say(R"({"fault":{"estop":true,"gnss_fix":"gps"}})"), R"({"ok":true})");
  EXPECT_TRUE(c.bunker.faults().estop);
  EXPECT_EQ(c.bunker.faults().gnss_fix, "gps");
}

TEST(Control, TheRadioIsSetLeverByLever) {
  Channel c;
  EXPECT_EQ(c.say(R"({"radio":{"swb":"middle","right_ud":0.5}})"), R"({"ok":true})");
  EXPECT_EQ(c.say(R"({"radio":{"vra":-1,"swa":"down"}})"), R"({"ok":true})");
  EXPECT_EQ(c.bunker.radio().swb, base::Switch::Middle);
  EXPECT_EQ(c.bunker.radio().right_ud, 0.5);
  EXPECT_EQ(c.bunker.radio().vra, -1.0);
  EXPECT_EQ(c.ask(R"({"get":"radio"})").at("swa"), "down");
  EXPECT_EQ(c.say(R"({"radio":{"on":false}})"), R"({"ok":true})");
  EXPECT_FALSE(c.bunker.radio().on);
}

TEST(Control, ThePoseIsSetInEitherFrameAndKeepsWhatIsMissing) {
  Channel c;
  EXPECT_EQ(c.say(R"({"pose":{"east_m":10,"north_m":-5,"heading_deg":180}})"), R"({"ok":true})");
  EXPECT_NEAR(c.truth().local.east_m, 10.0, 1e-6);
  EXPECT_EQ(c.say(R"({"pose":{"heading_deg":0}})"), R"({"ok":true})");
  EXPECT_NEAR(c.truth().local.east_m, 10.0, 1e-6);
  EXPECT_NEAR(c.truth().yaw_rad, base::kPi / 2.0, 1e-9);
  EXPECT_EQ(c.say(R"({"pose":{"lat":58.37802,"lon":26.7289}})"), R"({"ok":true})");
  EXPECT_NEAR(c.truth().local.east_m, 0.0, 1e-6);
}

TEST(Control, AnswersCarryWhatWasAskedForAndTheId) {
  Channel c;
  const json t = c.ask(R"({"id":"a7","get":"truth"})");
  EXPECT_EQ(t.at("id"), "a7");
  EXPECT_TRUE(t.at("ok"));
  EXPECT_EQ(t.at("control_mode"), "standby");
  EXPECT_EQ(c.ask(R"({"get":"faults"})").at("gnss_outage"), false);
  EXPECT_EQ(c.ask(R"({"get":"params"})").at("drive.track_width_m"), 0.6);
  EXPECT_EQ(c.ask(R"({"id":8,"bogus":1})"), json({{"id", 8}, {"error", "unknown key bogus"}}));
}

TEST(Control, TheRateOfTheTruthIsTheConnections) {
  Channel c;
  const auto answer = carry_out(R"({"set":{"truth_hz":50}})", c.bunker, Time{});
  EXPECT_EQ(answer.truth_hz, 50.0);
  EXPECT_EQ(c.error(R"({"set":{"truth_hz":1e-9}})"), "truth_hz must be 0 or at least 0.1");
  EXPECT_EQ(c.error(R"({"set":{"truth_hz":1000}})"), "truth_hz must lie in 0.0 .. 200.0");
}

TEST(Control, APowerCycleIsCarriedOut) {
  Channel c;
  c.enter_can();
  EXPECT_EQ(c.say(R"({"power_cycle":true})"), R"({"ok":true})");
  EXPECT_EQ(c.truth().control_mode, base::ControlMode::Standby);
}

TEST(Control, BadLinesSayWhy) {
  Channel c;
  for (const char* line : {"", "nonsense", "[]", "7", "{\"set\":", "{\"a\":\xff}", "null"}) {
    EXPECT_EQ(c.error(line), "a line must be one JSON object") << line;
  }
  EXPECT_EQ(c.error(R"({"set":{"gnss_outtage":true}})"), "unknown key gnss_outtage");
  EXPECT_EQ(c.error(R"({"set":{"drive.slipp":1}})"), "unknown key drive.slipp");
  EXPECT_EQ(c.error(R"({"set":[1]})"), "set must be an object");
  EXPECT_EQ(c.error(R"({"set":{"estop":1}})"), "estop must be true or false");
  EXPECT_EQ(c.error(R"({"set":{"estop":null}})"), "estop must be a number, a text or true/false");
  EXPECT_EQ(c.error(R"({"set":{"loss_to_base":2}})"), "loss_to_base must lie in 0.0 .. 1.0");
  EXPECT_EQ(c.error(R"({"set":{"gnss_fix":"rtk"}})"),
            "gnss_fix must be rtk_fixed, rtk_float, dgps, gps, none or empty");
  EXPECT_EQ(c.error(R"({"radio":{"swx":"up"}})"), "unknown key swx");
  EXPECT_EQ(c.error(R"({"radio":{"swa":"middle"}})"), "swa must be up, down or unknown");
  EXPECT_EQ(c.error(R"({"radio":{"swb":2}})"), "swb must be up, middle, down or unknown");
  EXPECT_EQ(c.error(R"({"radio":{"vra":1.5}})"), "vra must lie in -1.0 .. 1.0");
  EXPECT_EQ(c.error(R"({"pose":{"lat":91}})"), "lat must lie in -90.0 .. 90.0");
  EXPECT_EQ(c.error(R"({"pose":{"lat":"x"}})"), "lat must be a number");
  EXPECT_EQ(c.error(R"({"pose":{"lat":58,"east_m":1}})"),
            "pose takes lat, lon or east_m, north_m, not both");
  EXPECT_EQ(c.error(R"({"get":"pose"})"), "get must be truth, faults, radio or params");
  EXPECT_EQ(c.error(R"({"power_cycle":1})"), "power_cycle must be true or false");
}

TEST(Control, ALineIsDoneAsAWholeOrNotAtAll) {
  Channel c;
  EXPECT_EQ(c.error(R"({"fault":{"estop":true},"radio":{"swb":"down"},"set":{"x":1}})"),
            "unknown key x");
  EXPECT_FALSE(c.bunker.faults().estop);
  EXPECT_EQ(c.bunker.radio().swb, base::Switch::Up);
}

TEST(Control, DeepNestingIsOnlyABadLine) {
  Channel c;
  EXPECT_EQ(c.error(std::string(60000, '[')), "a line must be one JSON object");
  EXPECT_EQ(c.error("{\"set\":" + std::string(30000, '[') + std::string(30000, ']') + "}"),
            "set must be an object");
}

}  // namespace
}  // namespace roverd::sim
