// What a drill is told, and what it says of a failure.

#include "study/drill.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "source_folder.hpp"

namespace roverd::study {
namespace {

using nlohmann::json;

constexpr double kLat = 58.378020;
constexpr double kLon = 26.728900;

json waypoint(double east_m, double north_m) {
  const base::LocalFrame frame(1, {kLat, kLon});
  const auto at = frame.to_global({east_m, north_m});
  return {{"type", "waypoint"}, {"lat", at.lat}, {"lon", at.lon}};
}

json corner(double east_m, double north_m) {
  json out = waypoint(east_m, north_m);
  out.erase("type");
  return out;
}

json told_settings(const std::string& vehicle = "bunker") {
  const auto settings = load_settings({tests::in_source("config/robot.toml"), vehicle, {}});
  EXPECT_TRUE(settings);
  json out = json::object();
  for (const auto& [key, value] : told(*settings)) {
    std::visit([&out, &name = key](const auto& v) { out[name] = v; }, value);
  }
  return out;
}

/// 60 m north, then 20 m east.
json order(const std::string& vehicle = "bunker") {
  return {{"settings", told_settings(vehicle)},
          {"sim", tests::in_source("config/sim/" + vehicle + ".toml")},
          {"mission",
           {{"id", "m1"},
            {"revision", 3},
            {"plan",
             {{"name", "drill"},
              {"items", {waypoint(0, 0), waypoint(0, 60), waypoint(20, 60)}},
              {"settings", {{"speed_mps", 1.0}}}}}}},
          {"fence", nullptr},
          {"home", corner(0, 0)},
          {"origin", nullptr},
          {"at_m", 30.0},
          {"failures", json::array()}};
}

json fence(double half_m) {
  return {{"name", "around"},
          {"areas",
           {{{"kind", "inclusion"},
             {"polygon",
              {corner(-half_m, -5), corner(25, -5), corner(25, 65), corner(-half_m, 65)}}}}}};
}

std::string pointer_of(const json& document) {
  const auto read = read_drill(document.dump());
  if (read) return "no error";
  return read.error().fields.empty() ? read.error().detail : read.error().fields.front().pointer;
}

DrillResult played(json document, const char* failure) {
  const auto read = read_drill(document.dump());
  EXPECT_TRUE(read) << read.error().detail;
  const auto place = place_of(*read);
  EXPECT_TRUE(place) << place.error().detail;
  const auto result = play(*read, *place, failure);
  EXPECT_TRUE(result) << result.error().detail;
  return *result;
}

TEST(DrillOrder, IsWhatTheRunningProgramTold) {
  // Given settings of which one was changed while the program ran
  json document = order();
  document["settings"]["nav.speed.max_mps"] = 0.7;
  document["fence"] = fence(5.0);
  // When it is read
  const auto read = read_drill(document.dump());
  // Then the changed value holds, and all else is as it was told
  ASSERT_TRUE(read) << read.error().detail;
  EXPECT_DOUBLE_EQ(read->settings.robot.speed.max_mps, 0.7);
  EXPECT_EQ(read->settings.vehicle.name, "bunker");
  EXPECT_EQ(read->mission.revision, 3);
  EXPECT_EQ(read->mission.plan.items.size(), 3U);
  ASSERT_TRUE(read->fence);
  EXPECT_EQ(read->fence->name, "around");
  json again = json::object();
  for (const auto& [key, value] : told(read->settings)) {
    std::visit([&again, &name = key](const auto& v) { again[name] = v; }, value);
  }
  EXPECT_EQ(again, document["settings"]);
}

TEST(DrillOrder, TellsNoLinksAndWithThemNoPasswords) {
  const json settings = told_settings();
  for (const auto& [key, value] : settings.items()) EXPECT_FALSE(key.ends_with(".link")) << key;
}

TEST(DrillOrder, NamesWhatIsWrong) {
  const auto with = [](const char* pointer, json value) {
    json document = order();
    document[json::json_pointer(pointer)] = std::move(value);
    return document;
  };
  EXPECT_EQ(pointer_of(with("/failures", {"drive_link", "meteor"})), "/failures/1");
  EXPECT_EQ(pointer_of(with("/failures", {7})), "/failures/0");
  EXPECT_EQ(pointer_of(with("/failures", "all")), "/failures");
  EXPECT_EQ(pointer_of(with("/at_m", -1.0)), "/at_m");
  EXPECT_EQ(pointer_of(with("/at_m", "middle")), "/at_m");
  EXPECT_EQ(pointer_of(with("/limit_s", 1e6)), "/limit_s");
  EXPECT_EQ(pointer_of(with("/home", {{"lat", 91.0}, {"lon", 0.0}})), "/home/lat");
  EXPECT_EQ(pointer_of(with("/home", 5)), "/home");
  EXPECT_EQ(pointer_of(with("/mission", nullptr)), "/mission");
  EXPECT_EQ(pointer_of(with("/mission/revision", 0)), "/mission/revision");
  EXPECT_EQ(pointer_of(with("/mission/plan/items/1/lat", 100.0)), "/mission/plan/items/1/lat");
  EXPECT_EQ(pointer_of(with("/fence", {{"name", "f"}, {"areas", 3}})), "/fence/areas");
  EXPECT_EQ(pointer_of(with("/settings", json::array())), "/settings");
  EXPECT_EQ(pointer_of(with("/settings/nav.speed.max_mps", json::array())),
            "/settings/nav.speed.max_mps");
  EXPECT_EQ(pointer_of(with("/settings/nav.speed.max_mps", 1e9)), "/settings");
  EXPECT_EQ(pointer_of(with("/settings/nav.warp", 9)), "/settings");
  EXPECT_EQ(pointer_of(with("/more", 1)), "/more");
  for (const char* text : {"", "{", "null", "[]", "{}", "\xff", "{\"sim\": 1}"}) {
    EXPECT_FALSE(read_drill(text)) << text;
  }
}

TEST(DrillOrder, SaysThatAVehicleCannotBeSimulated) {
  json document = order();
  document["sim"] = "/nowhere/walker.toml";
  const auto read = read_drill(document.dump());
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().detail.find("/nowhere/walker.toml"), std::string::npos);
}

TEST(DrillPlace, IsTheMiddleUnlessTheOrderSaysOtherwise) {
  json document = order();
  document["at_m"] = nullptr;
  const auto middle = place_of(*read_drill(document.dump()));
  ASSERT_TRUE(middle);
  EXPECT_NEAR(middle->at_m, 40.0, 0.1);
  EXPECT_NEAR(middle->length_m, 80.0, 0.2);
  EXPECT_NEAR(middle->speed_mps, 1.0, 1e-6);
  // the robot is put down on the way before it, and points along it
  EXPECT_LT(middle->from_m, 35.0);
  EXPECT_GT(middle->from_m, 20.0);
  EXPECT_NEAR(middle->start.heading_deg, 0.0, 0.01);
}

TEST(DrillPlace, RefusesWhatLiesBehindTheEndAndAMissionWithoutAWay) {
  json document = order();
  document["at_m"] = 81.0;
  const auto behind = place_of(*read_drill(document.dump()));
  ASSERT_FALSE(behind);
  EXPECT_EQ(behind.error().fields.front().pointer, "/at_m");
  document = order();
  document["mission"]["plan"]["items"] = json::array({waypoint(0, 0)});
  const auto none = place_of(*read_drill(document.dump()));
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().fields.front().pointer, "/mission_id");
}

TEST(Drill, OfADeadDriveLinkStandsWhereStoppingMdSays) {
  // Given a fence 5 m beside the way
  json document = order();
  document["fence"] = fence(5.0);
  // When the drive link dies at 1 m/s
  const DrillResult r = played(document, "drive_link");
  // Then it stands within the limits of docs/stopping.md, beside its way, inside the fence
  EXPECT_EQ(r.end, DrillEnd::Stands);
  EXPECT_NEAR(r.speed_mps, 1.0, 0.05);
  ASSERT_TRUE(r.zero_s && r.stands_s && r.fence_m);
  EXPECT_LE(*r.zero_s, 0.46);
  EXPECT_LE(*r.stands_s, 1.8);
  EXPECT_GT(r.way_m, 0.5);
  EXPECT_LE(r.way_m, 1.0 * (0.6 + 0.35) + 1.0 / 3.0 + 0.05);
  EXPECT_LT(r.off_way_m, 0.2);
  EXPECT_NEAR(*r.fence_m, 5.0 - 0.39, 0.2);
  EXPECT_EQ(r.mode, "HOLD");
  ASSERT_FALSE(r.said.empty());
  EXPECT_EQ(r.said.front().id, "base_lost");
  // and where it stands is that far from where it began
  EXPECT_NEAR(base::distance_bearing(r.begins.at, r.last.at).distance_m, r.way_m, 0.05);
}

TEST(Drill, OfADeadProgramHasNoModeAndStopsByTheBaseAlone) {
  const DrillResult r = played(order(), "program_killed");
  EXPECT_EQ(r.end, DrillEnd::Stands);
  EXPECT_FALSE(r.zero_s);
  ASSERT_TRUE(r.stands_s);
  EXPECT_LE(*r.stands_s, 1.8);
  EXPECT_TRUE(r.mode.empty());
}

TEST(Drill, SaysThatItGoesOnWhereThatIsChosen) {
  // Given that nobody needs to watch, as delivered, and a short look
  json document = order();
  document["limit_s"] = 10.0;
  const DrillResult on = played(document, "operator_lost");
  EXPECT_EQ(on.end, DrillEnd::GoesOn);
  EXPECT_FALSE(on.stands_s);
  EXPECT_NE(on.reason.find("robot.safety.link_lost is go_on"), std::string::npos) << on.reason;
  EXPECT_NE(on.reason.find("does not stand after 10 s"), std::string::npos) << on.reason;
  // When the running program was told to hold instead
  document["settings"]["robot.safety.link_lost"] = "hold";
  document["settings"]["robot.safety.link_timeout_s"] = 2.0;
  const DrillResult held = played(document, "operator_lost");
  // Then the drill says so
  EXPECT_EQ(held.end, DrillEnd::Stands);
  EXPECT_EQ(held.said.front().id, "link_lost");
  ASSERT_TRUE(held.stands_s);
  EXPECT_LT(*held.stands_s, 4.5);
}

TEST(Drill, ComesHomeWhereThatIsChosen) {
  json document = order();
  document["at_m"] = 10.0;
  document["settings"]["robot.safety.link_lost"] = "return";
  const DrillResult r = played(document, "operator_lost");
  EXPECT_EQ(r.end, DrillEnd::Home);
  EXPECT_LT(base::distance_bearing(r.last.at, {kLat, kLon}).distance_m, 1.0);
}

TEST(Drill, TellsOfAMissionThatWouldNotBeStarted) {
  json document = order();
  document["fence"] = fence(0.5);
  const auto read = read_drill(document.dump());
  ASSERT_TRUE(read);
  const auto result = play(*read, *place_of(*read), "drive_link");
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().detail.find("would refuse to start"), std::string::npos)
      << result.error().detail;
}

TEST(Drill, PlaysWhatTheVehicleHas) {
  // A Bunker has no bumper, a Husky has one
  EXPECT_EQ(played(order(), "bumper").end, DrillEnd::NotPlayed);
  const auto bunker = failures_of(*read_drill(order().dump()));
  const auto husky = failures_of(*read_drill(order("husky").dump()));
  const auto has = [](const auto& list, const char* id) {
    return std::find(list.begin(), list.end(), id) != list.end();
  };
  EXPECT_FALSE(has(bunker, "bumper"));
  EXPECT_TRUE(has(bunker, "second_commander"));
  EXPECT_TRUE(has(husky, "bumper"));
  EXPECT_FALSE(has(husky, "second_commander"));
  const DrillResult hit = played(order("husky"), "bumper");
  EXPECT_EQ(hit.end, DrillEnd::Stands);
  EXPECT_TRUE(hit.estop);
}

TEST(Drill, PlaysEveryFailureThatHasAWord) {
  const auto lines = [] {
    json document = order();
    document["limit_s"] = 5.0;
    document["failures"] = json::array();
    for (const auto& f : base::kDrillFailures) document["failures"].push_back(f.id);
    std::vector<json> out;
    EXPECT_EQ(drill(document.dump(), [&](const std::string& l) { out.push_back(json::parse(l)); }),
              0);
    return out;
  }();
  ASSERT_EQ(lines.size(), base::kDrillFailures.size() + 1);
  EXPECT_NEAR(lines[0]["begins"]["at_m"].get<double>(), 30.0, 1e-9);
  for (std::size_t i = 0; i < base::kDrillFailures.size(); ++i) {
    const json& r = lines[i + 1]["result"];
    EXPECT_EQ(r["failure"], base::kDrillFailures[i].id);
    EXPECT_EQ(r["end"] == "not_played", base::kDrillFailures[i].id == "bumper") << r.dump();
  }
}

TEST(Drill, SaysWhatItRefusesInALineOfItsOwn) {
  std::vector<std::string> lines;
  EXPECT_EQ(drill("{", [&](const std::string& l) { lines.push_back(l); }), 2);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_TRUE(json::parse(lines[0]).contains("error"));
}

}  // namespace
}  // namespace roverd::study
