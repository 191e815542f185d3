#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "files.hpp"
#include "mission/formats/formats.hpp"
#include "plans.hpp"

namespace roverd::mission {
namespace {

using base::Code;
using nlohmann::json;

/// A .plan with these items.
std::string plan_file(const std::string& items, const std::string& mission_members = "") {
  return R"({"fileType":"Plan","version":1,"groundStation":"QGroundControl","mission":{"version":2,)" +
         mission_members + R"("plannedHomePosition":[58.378,26.7289,61.5],"items":[)" + items +
         "]}}";
}
std::string simple_item(int command, int jump_id, const std::string& params) {
  return R"({"type":"SimpleItem","autoContinue":true,"frame":3,"command":)" +
         std::to_string(command) + R"(,"doJumpId":)" + std::to_string(jump_id) + R"(,"params":[)" +
         params + "]}";
}

TEST(QgcPlan, SimpleItemsBecomeItems) {
  const auto file = imported(plan_file(simple_item(22, 1, "15,0,0,null,0,0,5") + "," +
                                           simple_item(16, 2, "3,0,0,null,58.3781,26.7291,5") +
                                           "," + simple_item(177, 3, "2,4,0,0,0,0,0") + "," +
                                           simple_item(20, 4, "0,0,0,0,0,0,0"),
                                       R"("vehicleType":10,"cruiseSpeed":1.5,)"),
                             "/home/anna/Lower field.plan");
  EXPECT_EQ(file.format, Format::Plan);
  EXPECT_EQ(file.plan.name, "Lower field");
  EXPECT_EQ(file.plan.settings.speed_mps, 1.5);
  Waypoint waypoint = waypoint_at(58.3781, 26.7291);
  waypoint.alt_m = 5.0;
  waypoint.hold_s = 3.0;
  EXPECT_EQ(file.plan.items, (std::vector<Item>{waypoint, Jump{1, 4}, ReturnHome{}}));
  ASSERT_EQ(file.rows.size(), 6u);
  EXPECT_EQ(file.rows[2].row, "/mission/items/0");
  EXPECT_EQ(file.rows[2].outcome, Outcome::LeftOut);
  EXPECT_EQ(file.rows[3].item, 1);
}

TEST(QgcPlan, ASurveyIsTakenAsTheItemsItCarries) {
  const std::string survey =
      R"({"type":"ComplexItem","complexItemType":"survey","TransectStyleComplexItem":{"Items":[)" +
      simple_item(16, 1, "0,0,0,null,58.1,26.1,30") + "," + simple_item(206, 2, "25,0,1,0,0,0,0") +
      "," + simple_item(16, 3, "0,0,0,null,58.2,26.2,30") +
      R"(]}},{"type":"ComplexItem","complexItemType":"StructureScan"})";
  const auto file = imported(plan_file(survey));
  EXPECT_EQ(positions(file.plan), (std::vector<LatLon>{{58.1, 26.1}, {58.2, 26.2}}));
  EXPECT_EQ(file.rows[1].what, "survey");
  EXPECT_EQ(file.rows[1].outcome, Outcome::Changed);
  EXPECT_EQ(file.rows[2].outcome, Outcome::LeftOut);
  EXPECT_EQ(file.rows[3].row, "/mission/items/0/TransectStyleComplexItem/Items/0");
}

/// One that every plan needs: something to drive.
std::string a_waypoint() {
  return simple_item(16, 1, "0,0,0,null,58.3781,26.7291,0");
}

json fenced_plan() {
  json root = json::parse(plan_file(a_waypoint()));
  root["geoFence"] = {
      {"version", 2},
      {"breachReturn", {58.0, 26.0, 0}},
      {"circles",
       {{{"circle", {{"center", {58.0, 26.001}}, {"radius", 12.5}}}, {"inclusion", false}}}},
      {"polygons",
       {{{"polygon", {{58.0, 26.0}, {58.0, 26.01}, {58.01, 26.01}, {58.0, 26.0}}},
         {"inclusion", true}}}}};
  root["rallyPoints"] = {{"points", {{58.001, 26.002, 15}}}, {"version", 2}};
  return root;
}

TEST(QgcPlan, FencesAndRallyPointsAreTakenAndWritten) {
  const auto file = imported(fenced_plan().dump());
  ASSERT_TRUE(file.fence);
  EXPECT_EQ(file.fence->name, file.plan.name);
  ASSERT_EQ(file.rows.size(), 6u);
  EXPECT_EQ(file.rows[2].row, "/geoFence/polygons/0");
  for (std::size_t i = 2; i < 5; ++i) EXPECT_EQ(file.rows[i].outcome, Outcome::Taken);
  EXPECT_EQ(file.rows[5].row, "/geoFence/breachReturn");
  EXPECT_EQ(file.rows[5].outcome, Outcome::LeftOut);
  // The figure was closed in the file; here it is not.
  EXPECT_EQ(file.fence->areas.at(0),
            (FenceArea{AreaKind::Inclusion,
                       FencePolygon{{{58.0, 26.0}, {58.0, 26.01}, {58.01, 26.01}}}}));
  EXPECT_EQ(file.fence->areas.at(1),
            (FenceArea{AreaKind::Exclusion, FenceCircle{{58.0, 26.001}, 12.5}}));
  EXPECT_EQ(file.fence->rally.at(0), (RallyPoint{{58.001, 26.002}, 15.0}));
  const auto again = imported(export_file(file.plan, Format::Plan, &*file.fence).content);
  EXPECT_EQ(again.fence->areas, file.fence->areas);
  EXPECT_EQ(again.fence->rally, file.fence->rally);
  EXPECT_FALSE(imported(export_file(file.plan, Format::Plan).content).fence);
}

TEST(QgcPlan, AFenceThatCannotBeIsRefusedByPointer) {
  const auto pointer = [](const char* place, const json& value) {
    json root = fenced_plan();
    root[json::json_pointer(place)] = value;
    return refused(root.dump(), Format::Plan).fields.at(0).pointer;
  };
  const json crossed = {{58.0, 26.0}, {58.01, 26.01}, {58.0, 26.01}, {58.01, 26.0}};
  EXPECT_EQ(pointer("/geoFence/polygons/0/polygon", crossed), "/geoFence/polygons/0");
  EXPECT_EQ(pointer("/geoFence/polygons/0", 1), "/geoFence/polygons/0/polygon");
  EXPECT_EQ(pointer("/geoFence/polygons/0/polygon/1", "x"), "/geoFence/polygons/0/polygon/1");
  EXPECT_EQ(pointer("/geoFence/polygons/0/inclusion", 3), "/geoFence/polygons/0/inclusion");
  EXPECT_EQ(pointer("/geoFence/circles/0/circle/radius", -1), "/geoFence/circles/0");
  EXPECT_EQ(pointer("/geoFence/circles/0/circle/center", 5), "/geoFence/circles/0/circle/center");
  EXPECT_EQ(pointer("/geoFence/circles", json::array_t(101, 1)), "/geoFence/circles");
  EXPECT_EQ(pointer("/rallyPoints/points/0", {95.0, 0.0, 0.0}), "/rallyPoints/points/0");
}

TEST(QgcPlan, ASpeedMadeForFlyingIsNotTaken) {
  for (const char* members :
       {R"("vehicleType":2,"cruiseSpeed":1.5,)", R"("vehicleType":10,"cruiseSpeed":15,)"}) {
    const auto file = imported(plan_file(a_waypoint(), members));
    EXPECT_FALSE(file.plan.settings.speed_mps);
    EXPECT_EQ(file.rows[1].outcome, Outcome::LeftOut);
  }
  const auto copter = imported(plan_file(a_waypoint(), R"("vehicleType":2,)"));
  EXPECT_EQ(copter.rows.at(1).row, "/mission/vehicleType");
  EXPECT_EQ(copter.rows.at(1).outcome, Outcome::Changed);
}

TEST(QgcPlan, BrokenFilesAreRefusedByPointerOrLine) {
  const auto pointer = [](const std::string& text) {
    const auto error = refused(text, Format::Plan);
    EXPECT_EQ(error.code, Code::Invalid) << error.detail;
    return error.fields.empty() ? std::string("none") : error.fields[0].pointer;
  };
  EXPECT_EQ(pointer(""), "line 1");
  EXPECT_EQ(pointer("{\n \"fileType\": \"Plan\",\n oops }"), "line 3");
  EXPECT_EQ(pointer(plan_file("").substr(0, 60)), "line 1");
  EXPECT_EQ(pointer("[]"), "");
  EXPECT_EQ(pointer(R"({"fileType":"Mission"})"), "/fileType");
  EXPECT_EQ(pointer(R"({"fileType":"Plan","version":2})"), "/version");
  EXPECT_EQ(pointer(R"({"fileType":"Plan","version":1})"), "/mission");
  EXPECT_EQ(pointer(R"({"fileType":"Plan","version":1,"mission":{}})"), "/mission/items");
  EXPECT_EQ(pointer(plan_file("3")), "/mission/items/0");
  EXPECT_EQ(pointer(plan_file(R"({"type":"Other"})")), "/mission/items/0/type");
  EXPECT_EQ(pointer(plan_file(R"({"type":"SimpleItem"})")), "/mission/items/0/command");
  EXPECT_EQ(pointer(plan_file(R"({"type":"SimpleItem","command":16})")), "/mission/items/0/params");
  EXPECT_EQ(pointer(plan_file(simple_item(16, 1, "0,0,0,0,95,26,0"))), "/mission/items/0/params/4");
  EXPECT_EQ(pointer(plan_file(simple_item(16, 1, "0,0,0,0,5,null,0"))),
            "/mission/items/0/params/5");
  EXPECT_EQ(pointer(plan_file(simple_item(16, 1, "0,0,0,0,5,1e999,0"))),
            "/mission/items/0/params/5");
  EXPECT_EQ(pointer(plan_file(simple_item(16, 1, "0,0,0,0,\"5\",6,0"))), "/mission/items/0/params");
  EXPECT_EQ(
      pointer(
          R"({"fileType":"Plan","version":1,"mission":{"items":[],"plannedHomePosition":[99,0,0]}})"),
      "/mission/plannedHomePosition/0");
}

}  // namespace
}  // namespace roverd::mission
