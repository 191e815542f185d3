#include "api/json/words.hpp"

#include <memory>

#include <gtest/gtest.h>

#include "api/api.hpp"
#include "api/metrics.hpp"
#include "api/problem.hpp"
#include "base/angle.hpp"

namespace roverd::api {
namespace {

using namespace std::chrono_literals;

base::Time at(base::Duration since_start) {
  return base::Time(since_start);
}

TEST(VehicleWords, WhatIsUnknownIsNullAndStale) {
  // Given a robot that has heard nothing yet,
  const Json v = vehicle_json(base::Snapshot{}, "bunker", at(10s));
  // then no number is made up.
  for (const char* group : {"position", "attitude", "gnss", "base", "battery", "rc"}) {
    EXPECT_EQ(v[group]["stale"], true) << group;
    EXPECT_TRUE(v[group]["age_s"].is_null()) << group;
  }
  EXPECT_TRUE(v["position"]["lat"].is_null());
  EXPECT_TRUE(v["position"]["heading_deg"].is_null());
  EXPECT_TRUE(v["battery"]["battery_v"].is_null());
  EXPECT_TRUE(v["position"]["speed_mps"].is_null());
  for (const char* name : {"id", "current_item", "distance_left_m", "eta_s"}) {
    EXPECT_TRUE(v["mission"][name].is_null()) << name;
  }
  EXPECT_TRUE(v["home"].is_null());
  EXPECT_TRUE(v["compass_bias_deg"].is_null());
  EXPECT_EQ(v["gnss"]["fix"], "none");
  EXPECT_EQ(v["mode"], "HOLD");
  EXPECT_EQ(v["control"], "none");
}

TEST(VehicleWords, YawBecomesHeadingAndRadiansDegrees) {
  // Given a robot that looks north-east and turns left,
  //   N   ↗ yaw +π/4, heading 45
  //   └─ E
  const auto kept = std::make_unique<base::Snapshot>();  // GCC 12 warns of one on the stack
  base::Snapshot& s = *kept;
  s.pose.emplace();
  s.pose->stamp = at(9'900ms);
  s.pose->global = {58.378020123456, 26.728900987654};
  s.pose->yaw_rad = base::kPi / 4;
  s.pose->yaw_rate_radps = 0.1;
  s.pose->yaw_sigma_rad = base::rad_from_deg(0.5);
  s.pose->heading_sigma_rad = base::rad_from_deg(2.0);
  s.pose->speed_mps = -0.25;
  s.pose->source = "gnss+odometry";
  const Json p = vehicle_json(s, "bunker", at(10s))["position"];
  EXPECT_EQ(p["heading_deg"], 45.0);
  EXPECT_EQ(p["yaw_rate_dps"], 5.73);
  EXPECT_EQ(p["heading_accuracy_deg"], 2.0);
  EXPECT_EQ(p["speed_mps"], -0.25);
  EXPECT_EQ(p["lat"], 58.378020123);  // 9 decimals
  EXPECT_EQ(p["lon"], 26.728900988);
  EXPECT_EQ(p["age_s"], 0.1);
  EXPECT_EQ(p["stale"], false);
  // A hair west of north must not round to 360.
  s.pose->yaw_rad = base::kPi / 2 + 1e-6;
  EXPECT_EQ(vehicle_json(s, "bunker", at(10s))["position"]["heading_deg"], 0.0);
}

TEST(VehicleWords, AHeadingThatNobodyKnowsIsNullAndTheAdviceSaysWhatHelps) {
  base::Snapshot s;
  s.pose = base::Pose{};
  s.pose->heading_known = false;
  s.pose->heading_sigma_rad = base::kPi;
  s.pose->ellipse = {1.5, 0.5, base::kPi / 2.0};
  s.estimator.advice = "drive 3 m straight to find the heading";
  const Json v = vehicle_json(s, "bunker", at(10s));
  EXPECT_TRUE(v["position"]["heading_deg"].is_null());
  EXPECT_TRUE(v["position"]["heading_accuracy_deg"].is_null());
  EXPECT_EQ(v["position"]["ellipse"]["major_m"], 1.5);
  EXPECT_EQ(v["position"]["ellipse"]["orientation_deg"], 0.0);
  EXPECT_EQ(v["estimator"]["alignment"], "unknown");
  EXPECT_EQ(v["estimator"]["advice"], "drive 3 m straight to find the heading");
  EXPECT_TRUE(v["estimator"]["gyro_bias_dps"].is_null());
  EXPECT_TRUE(v["estimator"]["innovations"]["position_m"].is_null());
  EXPECT_TRUE(v["estimator"]["anchor"].is_null());
  // What is known, in the compass's sense: clockwise.
  s.estimator.last_reset = base::EstimateReset{"heading", {3.0, 4.0}, 0.1, 0.0, 0.0, at(8s)};
  s.estimator.compass = {base::Innovation{-0.1, 2.5}, 7, std::nullopt, base::Refusal::Jump};
  s.now = at(10s);
  const Json e = vehicle_json(s, "bunker", at(10s))["estimator"];
  EXPECT_EQ(e["last_reset"]["moved_m"], 5.0);
  EXPECT_EQ(e["last_reset"]["turned_deg"], 5.73);
  EXPECT_EQ(e["last_reset"]["age_s"], 2.0);
  EXPECT_EQ(e["innovations"]["compass_deg"], 5.73);
  EXPECT_EQ(e["innovations"]["compass_nis"], 2.5);
  EXPECT_EQ(e["rejected"]["compass"], 7);
}

TEST(VehicleWords, WhatWasLearnedStandsBesideWhatWasSet) {
  base::Snapshot s;
  s.learned.delay_s = base::LearnedNumber{0.3124, 0.0081};
  s.learned.delay_set_s = 0.15;
  s.learned.delay_used_s = 0.3124;
  s.learned.braking_set_mps2 = 0.6;
  s.learned.braking_used_mps2 = 0.3;
  const Json l = vehicle_json(s, "bunker", at(10s))["learned"];
  EXPECT_EQ(l["delay_s"], 0.312);
  EXPECT_EQ(l["delay_sigma_s"], 0.008);
  EXPECT_EQ(l["delay_set_s"], 0.15);
  EXPECT_TRUE(l["braking_mps2"].is_null());
  EXPECT_EQ(l["braking_used_mps2"], 0.3);
  EXPECT_EQ(l["braking_proved"], false);
}

TEST(VehicleWords, OldValuesStayVisibleAndAreMarked) {
  base::Snapshot s;
  s.base = base::BaseStatus{};
  s.base->stamp = at(9s);
  s.base->battery_v = 48.2;
  const Json v = vehicle_json(s, "bunker", at(10s));
  EXPECT_EQ(v["base"]["stale"], true);  // 1 s is long for 50 frames a second
  EXPECT_EQ(v["base"]["age_s"], 1.0);
  EXPECT_EQ(v["battery"]["battery_v"], 48.2);
  EXPECT_EQ(v["battery"]["stale"], false);  // but not for a voltage
}

TEST(VehicleWords, ASpeedThatNobodyTellsAnyMoreIsUnknown) {
  const auto kept = std::make_unique<base::Snapshot>();
  base::Snapshot& s = *kept;
  s.pose.emplace();
  s.base = base::BaseStatus{};
  s.base->stamp = at(9'900ms);
  s.motion = base::BaseMotion{at(9'900ms), {0.5, 0.0}};
  EXPECT_EQ(vehicle_json(s, "bunker", at(10s))["base"]["speed_mps"], 0.5);
  EXPECT_TRUE(vehicle_json(s, "bunker", at(10s))["position"]["speed_mps"].is_null());
  // Its state still comes, its motion does not.
  s.motion->stamp = at(9s);
  const Json v = vehicle_json(s, "bunker", at(10s));
  EXPECT_TRUE(v["base"]["speed_mps"].is_null());
  EXPECT_TRUE(v["base"]["yaw_rate_dps"].is_null());
  EXPECT_EQ(v["base"]["stale"], false);
}

TEST(VehicleWords, LocalisationSaysInShortWhatTheMapInUseSays) {
  const auto kept = std::make_unique<base::Snapshot>();
  base::Snapshot& s = *kept;
  const Json none = vehicle_json(s, "bunker", at(10s))["localisation"];
  EXPECT_EQ(none["state"], "unknown");
  EXPECT_TRUE(none["source"].is_null());
  EXPECT_TRUE(none["accuracy"].is_null());
  s.pose.emplace();
  s.pose->source = "map+odometry";
  s.place.emplace();
  s.place->stamp = at(9'900ms);
  s.place->sigma_m = 0.021;
  for (const auto& [phase, word] : {std::pair{base::PlacePhase::Known, "tracking"},
                                    {base::PlacePhase::Searching, "searching"},
                                    {base::PlacePhase::Lost, "lost"}}) {
    s.place->phase = phase;
    const Json now = vehicle_json(s, "bunker", at(10s))["localisation"];
    EXPECT_EQ(now["state"], word);
    EXPECT_EQ(now["source"], "map+odometry");
    EXPECT_EQ(now["accuracy"], 0.021);
    EXPECT_EQ(now["age_s"], 0.1);
  }
}

TEST(RowWords, InShortTheyAreNullWhereNoneIsDrivenOrSeen) {
  EXPECT_TRUE(row_now_json(std::nullopt)["offset_m"].is_null());
  EXPECT_TRUE(row_now_json(std::nullopt)["item"].is_null());
  base::RowState row;
  row.item = 3;
  row.side = "both";
  EXPECT_TRUE(row_now_json(row)["certainty"].is_null());
  EXPECT_EQ(row_now_json(row)["item"], 3);
  row.seen.emplace();
  row.seen->offset_m = -0.04;
  row.seen->angle_rad = 0.1;
  row.seen->certainty = 0.75;
  row.seen->width_m = 1.9;
  const Json seen = row_now_json(row);
  EXPECT_EQ(seen["offset_m"], -0.04);
  EXPECT_NEAR(seen["angle_deg"].get<double>(), -5.73, 0.01) << "clockwise";
  EXPECT_EQ(seen["certainty"], 0.75);
  EXPECT_EQ(seen["width_m"], 1.9);
}

TEST(VehicleWords, AMessageIsAboutOneKilobyte) {
  base::Snapshot s;
  s.pose.emplace();
  s.gnss = base::GnssFix{};
  s.base = base::BaseStatus{};
  s.radio = base::RadioState{};
  Json v = vehicle_json(s, "bunker", at(1s));
  EXPECT_LT(v["estimator"].dump().size(), 1300u);
  v.erase("estimator");
  EXPECT_LT(v["learned"].dump().size(), 350u);
  v.erase("learned");
  EXPECT_LT(v.dump().size(), 2500u);
}

TEST(DriverWords, TellRatesAgesAndCounts) {
  base::Snapshot s;
  s.drivers.push_back({at(10s), "gnss", base::DriverPhase::Up, "", 120, 3, 0, at(9'800ms)});
  s.drivers.push_back({at(10s), "bunker", base::DriverPhase::Failed, "hangs", 0, 0, 0});
  const Json list = drivers_json(s, {{"gnss", 5.04}}, at(10s));
  EXPECT_EQ(list["items"][0]["name"], "bunker");
  EXPECT_EQ(list["items"][0]["state"], "failed");
  EXPECT_TRUE(list["items"][0]["rate_hz"].is_null());
  const Json& gnss = list["items"][1];
  EXPECT_EQ(gnss["state"], "up");
  EXPECT_EQ(gnss["rate_hz"], 5.0);
  EXPECT_EQ(gnss["age_s"], 0.2);
  EXPECT_EQ(gnss["refused"], 3);
  EXPECT_TRUE(list["next_cursor"].is_null());
  EXPECT_EQ(list["items"][0]["counts"], Json::object()) << "nothing is told yet";
}

TEST(DriverWords, WhatWasRefusedAndWhatIsDangerousIsNamed) {
  base::DriverStatus driver;
  driver.stamp = at(10s);
  driver.name = "bunker";
  driver.phase = base::DriverPhase::Up;
  driver.link = "can:can0";
  base::DriverDetail detail;
  detail.counts = {{"0x221 too short", 3}};
  detail.rates_hz = {{"0x221", 49.96}};
  detail.facts = {{"protocol", "V2"}};
  detail.hazards = {"somebody else sends motion commands (0x111)"};
  driver.detail = std::make_shared<const base::DriverDetail>(std::move(detail));
  const Json one = driver_json(driver, std::nullopt, at(10s));
  EXPECT_EQ(one["link"]["address"], "can:can0");
  EXPECT_EQ(one["counts"]["0x221 too short"], 3);
  EXPECT_EQ(one["rates_hz"]["0x221"], 50.0);
  EXPECT_EQ(one["facts"]["protocol"], "V2");
  EXPECT_EQ(one["hazards"][0], "somebody else sends motion commands (0x111)");
}

TEST(MissionWords, HomeIsNullWhenThereIsNone) {
  store::StoredMission m;
  m.id = "abc";
  m.revision = 2;
  m.plan.name = "field";
  mission::Waypoint waypoint;
  waypoint.at = {58.1, 26.1};
  m.plan.items.push_back(waypoint);
  const Json out = mission_json(m);
  EXPECT_TRUE(out["home"].is_null());
  EXPECT_EQ(out["items"][0]["type"], "waypoint");
  EXPECT_EQ(out["items"][0]["lat"], 58.1);
  EXPECT_EQ(out["revision"], 2);
}

TEST(Metrics, TheLatenessHistogramIsCumulative) {
  // Given two wake-ups below 1 us, one below 4 us, one beyond everything,
  auto s = std::make_shared<base::Snapshot>();
  s->loop.lateness_log2_us[0] = 2;
  s->loop.lateness_log2_us[2] = 1;
  s->loop.lateness_log2_us[19] = 1;
  const std::string text = metrics_text({.snapshot = s, .net = {}, .version = "1.0"});
  EXPECT_NE(text.find("roverd_loop_lateness_seconds_bucket{le=\"1e-06\"} 2\n"), std::string::npos);
  EXPECT_NE(text.find("roverd_loop_lateness_seconds_bucket{le=\"4e-06\"} 3\n"), std::string::npos);
  EXPECT_NE(text.find("roverd_loop_lateness_seconds_bucket{le=\"+Inf\"} 4\n"), std::string::npos);
  EXPECT_NE(text.find("roverd_loop_lateness_seconds_count 4\n"), std::string::npos);
  EXPECT_NE(text.find("roverd_info{version=\"1.0\"} 1\n"), std::string::npos);
}

TEST(Problems, StandInTheDocumentAsTheyAreAnswered) {
  Json told = Json::array();
  for (const ProblemKind& kind : problem_kinds()) {
    told.push_back({{"status", kind.status},
                    {"slug", kind.slug},
                    {"title", kind.title},
                    {"meaning", kind.meaning}});
  }
  EXPECT_EQ(Json::parse(openapi_text())["x-problems"], told);
}

}  // namespace
}  // namespace roverd::api
