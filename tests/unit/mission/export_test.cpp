#include <algorithm>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/tangent_plane.hpp"
#include "files.hpp"
#include "mission/formats/formats.hpp"
#include "plans.hpp"
#include "real_data.hpp"

namespace roverd::mission {
namespace {

using nlohmann::json;

TEST(Export, PlansOfWaypointsWaitsSpeedsTurnsAndJumpsComeBackEqual) {
  RandomPlans plans(7);
  for (int i = 0; i < 100; ++i) {
    const Plan plan = plans.next_simple(1 + i % 30);
    for (const Format format : {Format::Plan, Format::Waypoints}) {
      const auto file = export_file(plan, format);
      const auto again = import_file(file.content, std::nullopt, file.file_name);
      ASSERT_TRUE(again) << again.error().detail;
      EXPECT_EQ(again->plan, plan);
      EXPECT_TRUE(file.rows.empty());
    }
  }
}

TEST(Export, AnyPlanIsWrittenSuchThatItsPositionsComeBack) {
  RandomPlans plans(99);
  for (int i = 0; i < 200; ++i) {
    Plan plan = plans.next(1 + i % 40);
    plan.items.emplace_back(waypoint_at(58.0, 26.0));  // something to drive
    for (const Format format : {Format::Plan, Format::Waypoints}) {
      const auto file = export_file(plan, format);
      const auto again = import_file(file.content, std::nullopt, file.file_name);
      ASSERT_TRUE(again) << again.error().detail;
      EXPECT_EQ(positions(again->plan), positions(plan));
    }
  }
}

TEST(Export, WhatTheFormatCannotHoldIsReportedByItem) {
  const Plan plan = plan_with_every_item();
  const auto file = export_file(plan, Format::Plan);
  std::vector<int> left_out;
  std::vector<int> changed;
  for (const FileRow& r : file.rows) {
    if (!r.item) continue;
    EXPECT_EQ(r.row, "/items/" + std::to_string(*r.item - 1));
    (r.outcome == Outcome::LeftOut ? left_out : changed).push_back(*r.item);
  }
  EXPECT_EQ(left_out, (std::vector<int>{3, 4, 5, 10, 11, 12, 13, 14, 16, 23, 24, 25, 26}));
  EXPECT_EQ(changed, (std::vector<int>{1, 20, 22}));
  EXPECT_EQ(file.rows.back().what, "back_and_forth");
}

TEST(Export, PointsOfAMapAreWrittenWhereItLies) {
  // Given: two points of a map that lies somewhere, its x axis to the east, and a wait.
  Plan plan;
  plan.name = "shed";
  plan.frame = MissionMap{"shed", base::MapLies{{58.0, 26.0}, 0.0}};
  plan.items = {MapPoint{.x_m = 1.0}, MapPoint{.x_m = 4.0, .hold_s = 2.0}, Wait{5.0}};
  const Plan laid = laid_on_earth(plan, *plan.frame->lies);
  for (const Format format : kFormats) {
    if (!is_written(format)) continue;
    // When
    const auto file = export_file(plan, format);
    // Then: it holds their places, and each is told once, with the map.
    const auto again = import_file(file.content, std::nullopt, file.file_name);
    ASSERT_TRUE(again) << to_string(format) << " " << again.error().detail;
    const auto there = positions(again->plan);
    const auto wanted = positions(laid);
    ASSERT_EQ(there.size(), 2u) << to_string(format);
    for (std::size_t i = 0; i < there.size(); ++i) {
      EXPECT_LT(base::distance_m(base::TangentPlane(there[i]).to_local(wanted[i]), {}), 0.001)
          << to_string(format);
    }
    const auto told = std::ranges::count_if(file.rows, [](const FileRow& row) {
      return row.what == "map_point" && row.outcome == Outcome::Changed &&
             row.reason.starts_with("a point of the map \"shed\", written as a waypoint");
    });
    EXPECT_EQ(told, 2) << to_string(format);
    EXPECT_EQ(std::ranges::count(file.rows, std::string("frame"), &FileRow::what), 0);
  }
}

TEST(Export, OfAPointOfAMapItIsToldWhereItsHeadingIsLost) {
  Plan plan;
  plan.name = "shed";
  plan.frame = MissionMap{"shed", base::MapLies{{58.0, 26.0}, 0.0}};
  plan.items = {MapPoint{.x_m = 1.0, .yaw_deg = 0.0}, MapPoint{.x_m = 4.0}};
  const std::string reason =
      "a point of the map \"shed\", written as a waypoint where that lies by now";
  const auto file = export_file(plan, Format::GeoJson);
  ASSERT_EQ(file.rows.size(), 2u);
  EXPECT_EQ(file.rows[0].reason, reason + "; its heading is lost");
  EXPECT_EQ(file.rows[1].reason, reason);
}

TEST(Export, AWaypointsOwnSpeedIsCommandedBeforeItAndTakenBackAfterIt) {
  Plan plan;
  plan.name = "x";
  plan.settings.speed_mps = 1.0;
  Waypoint slow = waypoint_at(58.2, 26.2);
  slow.speed_mps = 0.4;
  plan.items = {waypoint_at(58.1, 26.1), slow, waypoint_at(58.3, 26.3), Jump{2, 1}};
  const auto again = imported(export_file(plan, Format::Waypoints).content);
  EXPECT_EQ(again.plan.items, (std::vector<Item>{Speed{1.0}, waypoint_at(58.1, 26.1), Speed{0.4},
                                                 waypoint_at(58.2, 26.2), Speed{1.0},
                                                 waypoint_at(58.3, 26.3), Jump{3, 1}}));
}

TEST(Export, AMissionWithoutHomeComesBackWithoutOne) {
  Plan plan;
  plan.name = "x";
  plan.items = {waypoint_at(58.1, 26.1)};
  for (const Format format : {Format::Plan, Format::Waypoints}) {
    const auto file = export_file(plan, format);
    EXPECT_EQ(file.rows.at(0).what, "home");
    EXPECT_EQ(imported(file.content, "x.any").plan, plan);
  }
}

TEST(Export, TheEndBecomesALastCommand) {
  Plan plan;
  plan.name = "x";
  plan.items = {waypoint_at(58.1, 26.1)};
  plan.settings.at_end = AtEnd::Return;
  EXPECT_EQ(imported(export_file(plan, Format::Waypoints).content).plan.items.back(),
            Item(ReturnHome{}));
  plan.settings.at_end = AtEnd::Repeat;
  EXPECT_EQ(imported(export_file(plan, Format::Waypoints).content).plan.items.back(),
            Item(Jump{1, 0}));
}

TEST(Export, ACorridorIsToldAsLeftOut) {
  Plan plan;
  plan.name = "x";
  plan.items = {waypoint_at(58.1, 26.1)};
  plan.settings.corridor_m = 0.5;
  for (const Format format : {Format::Plan, Format::Waypoints}) {
    const auto file = export_file(plan, format);
    EXPECT_TRUE(std::any_of(file.rows.begin(), file.rows.end(), [](const auto& row) {
      return row.what == "corridor" && row.outcome == Outcome::LeftOut;
    }));
  }
}

TEST(Export, APlanFileHasWhatQGroundControlAsksFor) {
  const auto file = export_file(plan_with_every_item(), Format::Plan);
  const json root = json::parse(file.content);
  EXPECT_EQ(root.at("fileType"), "Plan");
  EXPECT_EQ(root.at("version"), 1);
  EXPECT_EQ(root.at("groundStation"), "QGroundControl");
  EXPECT_EQ(root.at("mission").at("version"), 2);
  EXPECT_EQ(root.at("mission").at("vehicleType"), 10);
  EXPECT_EQ(root.at("mission").at("firmwareType"), 3);
  EXPECT_EQ(root.at("mission").at("plannedHomePosition").size(), 3u);
  EXPECT_EQ(root.at("geoFence").at("version"), 2);
  EXPECT_EQ(root.at("rallyPoints").at("version"), 2);
  int number = 0;
  for (const json& item : root.at("mission").at("items")) {
    EXPECT_EQ(item.at("doJumpId"), ++number);
    EXPECT_EQ(item.at("params").size(), 7u);
    EXPECT_EQ(item.at("type"), "SimpleItem");
  }
}

TEST(Export, WaypointRowsHaveTwelveColumnsAndAtLeastEightDecimals) {
  Plan plan;
  plan.name = "x";
  plan.home = Home{{58.5, 26.25}, std::nullopt};
  plan.items = {waypoint_at(58.123456789, -1e-9)};
  EXPECT_EQ(export_file(plan, Format::Waypoints).content,
            "QGC WPL 110\n"
            "0\t1\t0\t16\t0.00000000\t0.00000000\t0.00000000\t0.00000000\t58.50000000\t26.25000000"
            "\t0.000000\t1\n"
            "1\t0\t3\t16\t0.00000000\t0.00000000\t0.00000000\t0.00000000\t58.123456789"
            "\t-0.000000001\t0.000000\t1\n");
}

TEST(Export, FileNamesAreSafeInAHeader) {
  Plan plan;
  for (const auto& [name, wanted] : std::initializer_list<std::pair<const char*, const char*>>{
           {"Lower field", "Lower_field.plan"},
           {"../../etc/passwd", "etc_passwd.plan"},
           {"a\"b;c\r\nd", "a_b_c_d.plan"},
           {"„õ“", "mission.plan"}}) {
    plan.name = name;
    EXPECT_EQ(export_file(plan, Format::Plan).file_name, wanted);
  }
}

TEST(RealFiles, TheQGroundControlPlanComesBackWithTheSamePositions) {
  ROVERD_REAL_DATA(path, "mission-sitl.plan");
  const auto bytes = tests::read_file(path);
  const std::string text(bytes.begin(), bytes.end());
  const auto file = import_file(text, std::nullopt, "mission-sitl.plan");
  ASSERT_TRUE(file) << file.error().detail;
  EXPECT_EQ(file->plan.name, "mission-sitl");
  EXPECT_EQ(file->plan.home, (Home{{-35.363261, 149.1652299}, 584.04}));
  const std::vector<LatLon> wanted{{-35.36256542276401, 149.16525136037512},
                                   {-35.36266166697202, 149.1641248325614},
                                   {-35.362008003718415, 149.16351540625385},
                                   {-35.362273115811924, 149.164369628518},
                                   {-35.36200381, 149.16511265}};
  EXPECT_EQ(positions(file->plan), wanted);
  ASSERT_EQ(file->rows.size(), 9u);  // a copter's plan; home, cruise speed, six items
  const auto row = [&](const std::string& what) {
    const auto at = std::find_if(file->rows.begin(), file->rows.end(),
                                 [&](const auto& known) { return known.what == what; });
    return at == file->rows.end() ? std::nullopt : std::optional(at->outcome);
  };
  EXPECT_EQ(row("vehicle type"), Outcome::Changed);
  EXPECT_EQ(row("NAV_TAKEOFF (22)"), Outcome::LeftOut);
  for (const Format format : {Format::Plan, Format::Waypoints}) {
    const auto out = export_file(file->plan, format);
    EXPECT_EQ(import_file(out.content, std::nullopt, "mission-sitl").value().plan, file->plan);
  }
}

TEST(RealFiles, TheWaypointsOfARoverComeBackWithTheSamePositions) {
  ROVERD_REAL_DATA(path, "mission-rover-basic.waypoints");
  const auto bytes = tests::read_file(path);
  const std::string text(bytes.begin(), bytes.end());
  const auto file = import_file(text, std::nullopt, "mission-rover-basic.waypoints");
  ASSERT_TRUE(file) << file.error().detail;
  const std::vector<LatLon> wanted{{40.071214, -105.230131},
                                   {40.071075, -105.229987},
                                   {40.071214, -105.229419},
                                   {40.071437, -105.229490}};
  EXPECT_EQ(positions(file->plan), wanted);
  EXPECT_EQ(file->plan.home, (Home{{40.071375, -105.229789}, -0.05}));
  EXPECT_EQ(file->plan.items.back(), Item(ReturnHome{}));
  for (const FileRow& r : file->rows) EXPECT_EQ(r.outcome, Outcome::Taken) << r.reason;
  for (const Format format : {Format::Plan, Format::Waypoints}) {
    const auto out = export_file(file->plan, format);
    EXPECT_EQ(import_file(out.content, std::nullopt, "mission-rover-basic").value().plan,
              file->plan);
  }
}

}  // namespace
}  // namespace roverd::mission
