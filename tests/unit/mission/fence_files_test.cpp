// Fences and rally points in files of missions, and home in the first row: ArduPilot's ways of
// writing them, with the sentences of MAVLink's and ArduPilot's documents.

#include <gtest/gtest.h>

#include "files.hpp"
#include "mission/formats/formats.hpp"
#include "plans.hpp"

namespace roverd::mission {
namespace {

std::string wpl(const std::vector<std::string>& rows) {
  std::string text = "QGC WPL 110\n";
  for (std::size_t i = 0; i < rows.size(); ++i) text += std::to_string(i) + "\t" + rows[i] + "\n";
  return text;
}

std::vector<Outcome> outcomes(const ImportedFile& file) {
  std::vector<Outcome> out;
  for (const FileRow& r : file.rows) out.push_back(r.outcome);
  return out;
}

const std::vector<LatLon> kTriangle{{58.0, 26.0}, {58.0, 26.01}, {58.01, 26.01}};

// MAVLink, MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION (5001): "param1 Vertex Count: Polygon vertex
// count". MAV_CMD_NAV_FENCE_CIRCLE_EXCLUSION (5004): "param1 Radius".
TEST(FenceRows, BecomeAFenceWithItsCirclesAndRallyPoints) {
  const auto file = imported(wpl({
                                 "1 0 16 0 0 0 0 58.005 26.005 60 1",      // home
                                 "0 3 5001 3 0 0 0 58 26 0 1",             // corners
                                 "0 3 5001 3 0 0 0 58 26.01 0 1",          //
                                 "0 3 5001 3 0 0 0 58.01 26.01 0 1",       //
                                 "0 3 5002 3 0 0 0 58.001 26.002 0 1",     //
                                 "0 3 5002 3 0 0 0 58.001 26.003 0 1",     //
                                 "0 3 5002 3 0 0 0 58.002 26.003 0 1",     //
                                 "0 3 5004 12.5 0 0 0 58.001 26.001 0 1",  //
                                 "0 3 5003 90 0 0 0 58.1 26.1 0 1",        //
                                 "0 3 5000 0 0 0 0 58 26 0 1",             // where to return to
                                 "0 3 5100 0 0 0 0 58.003 26.004 15 1",    //
                             }),
                             "yard.waypoints");
  EXPECT_TRUE(file.plan.items.empty());
  EXPECT_EQ(file.plan.home, std::nullopt);  // of a mission that is not there
  ASSERT_TRUE(file.fence);
  EXPECT_EQ(file.fence->name, "yard");
  ASSERT_EQ(file.fence->areas.size(), 4u);
  EXPECT_EQ(file.fence->areas[0], (FenceArea{AreaKind::Inclusion, FencePolygon{kTriangle}}));
  EXPECT_EQ(file.fence->areas[1].kind, AreaKind::Exclusion);
  EXPECT_EQ(file.fence->areas[2],
            (FenceArea{AreaKind::Exclusion, FenceCircle{{58.001, 26.001}, 12.5}}));
  EXPECT_EQ(file.fence->areas[3],
            (FenceArea{AreaKind::Inclusion, FenceCircle{{58.1, 26.1}, 90.0}}));
  EXPECT_EQ(file.fence->rally, (std::vector<RallyPoint>{{{58.003, 26.004}, 15.0}}));
  using enum Outcome;
  EXPECT_EQ(outcomes(file), (std::vector{LeftOut, Taken, Taken, Taken, Taken, Taken, Taken, Taken,
                                         Changed, LeftOut, Taken}));
  EXPECT_EQ(file.rows[1].what, "FENCE_POLYGON_VERTEX_INCLUSION (5001)");
  for (std::size_t i = 0; i < file.rows.size(); ++i) {
    EXPECT_EQ(file.rows[i].row, "line " + std::to_string(i + 2));
  }
}

TEST(FenceRows, StandBesideAMission) {
  const auto file =
      imported(wpl({"0 3 5001 3 0 0 0 58 26 0 1", "0 3 5001 3 0 0 0 58 26.01 0 1",
                    "0 3 5001 3 0 0 0 58.01 26.01 0 1", "0 3 16 0 0 0 0 58.001 26.002 0 1"}));
  EXPECT_EQ(file.plan.items, (std::vector<Item>{waypoint_at(58.001, 26.002)}));
  EXPECT_EQ(file.plan.home, std::nullopt);
  EXPECT_EQ(file.fence->areas.size(), 1u);
  EXPECT_EQ(file.rows.back().item, 1);
}

TEST(FenceRows, ThatBreakOffOrCannotBeAreRefusedByTheirLine) {
  const auto place = [](const std::vector<std::string>& rows) {
    const auto error = refused(wpl(rows));
    return error.fields.empty() ? error.detail
                                : error.fields[0].pointer + ": " + error.fields[0].detail;
  };
  EXPECT_EQ(place({"0 3 5001 3 0 0 0 58 26 0 1", "0 3 5001 3 0 0 0 58 26.01 0 1"}),
            "line 2: begins a polygon of 3 corners, of which only 2 are there");
  EXPECT_EQ(place({"0 3 5001 0 0 0 0 58 26 0 1"}),
            "line 2: parameter 1 must be the number of corners of the polygon, 3 to 10000");
  EXPECT_EQ(place({"0 3 5002 3 0 0 0 58 26 0 1", "0 3 5001 3 0 0 0 58 26.01 0 1"}).substr(0, 6),
            "line 2");
  EXPECT_EQ(place({"0 3 5003 -1 0 0 0 58 26 0 1"}).substr(0, 6), "line 2");
  EXPECT_EQ(place({"0 3 5100 0 0 0 0 95 26 0 1"}),
            "line 2: latitude must be a number from -90 to 90, is 95");
  // a figure that crosses itself
  EXPECT_EQ(place({"0 3 5001 4 0 0 0 58 26 0 1", "0 3 5001 4 0 0 0 58.01 26.01 0 1",
                   "0 3 5001 4 0 0 0 58 26.01 0 1", "0 3 5001 4 0 0 0 58.01 26 0 1"})
                .substr(0, 6),
            "line 2");
}

// ArduPilot, "Mission Command List": "the first waypoint is always the home position"; other ground
// stations begin with the first command (MAVLink, "File formats": "INDEX CURRENT_WP COORD_FRAME
// COMMAND …" without a word of home).
TEST(FirstRow, IsHomeOnlyIfItIsWrittenAsOne) {
  const std::string point = "0 3 16 0 0 0 0 58.1 26.1 0 1";
  EXPECT_EQ(imported(wpl({"1 0 16 0 0 0 0 58 26 60 1", point})).plan.home,
            (Home{{58.0, 26.0}, 60.0}));
  EXPECT_TRUE(imported(wpl({"0 0 16 0 0 0 0 58 26 60 1", point})).plan.home);
  // a take-off
  const auto flies = imported(wpl({"1 3 22 0 0 0 0 58 26 10 1", point}));
  EXPECT_EQ(flies.plan.home, std::nullopt);
  EXPECT_EQ(flies.rows[0].what, "NAV_TAKEOFF (22)");
  EXPECT_EQ(flies.rows[0].outcome, Outcome::LeftOut);
  // a waypoint above home, and one with a hold
  for (const char* first : {"1 3 16 0 0 0 0 58 26 0 1", "1 0 16 5 0 0 0 58 26 0 1"}) {
    const auto file = imported(wpl({first, point}));
    EXPECT_EQ(file.plan.home, std::nullopt);
    EXPECT_EQ(positions(file.plan), (std::vector<LatLon>{{58.0, 26.0}, {58.1, 26.1}}));
    EXPECT_EQ(file.rows[0].reason.find("it is not written as a home") != std::string::npos, true);
  }
  // a jump to it leads to the item that it became
  const auto jumps = imported(wpl({"1 3 16 0 0 0 0 58 26 0 1", point, "0 3 177 0 2 0 0 0 0 0 1"}));
  EXPECT_EQ(jumps.plan.items.at(2), Item(Jump{1, 2}));
}

TEST(NothingToDrive, IsRefusedAndSaysWhy) {
  EXPECT_EQ(refused(wpl({"1 0 16 0 0 0 0 58 26 60 1"})).detail, "the file has nothing to drive");
  EXPECT_EQ(refused(wpl({"1 3 22 0 0 0 0 58 26 60 1", "0 3 178 1 2 0 0 0 0 0 1"})).detail,
            "the file has nothing to drive: line 2, NAV_TAKEOFF (22): a ground vehicle does not "
            "take off");
  EXPECT_EQ(refused("QGC WPL 110\n").code, base::Code::Invalid);
}

// ArduPilot, "Geo-Fencing in Plane" (before MAVLink's fence type): "the first line is the return
// point, then the points of the fence, the last of which must be the same as the first".
TEST(FenceText, TheOlderFormIsRead) {
  const auto file = imported(
      "#saved by Mission Planner 1.2.3\r\n58.003\t26.004\r\n58 26\r\n58 26.01\r\n58.01 26.01\r\n58 "
      "26\r\n",
      "yard.txt");
  EXPECT_EQ(file.format, Format::Fence);
  ASSERT_TRUE(file.fence);
  EXPECT_EQ(file.fence->name, "yard");
  ASSERT_EQ(file.fence->areas.size(), 1u);
  EXPECT_EQ(file.fence->areas[0], (FenceArea{AreaKind::Inclusion, FencePolygon{kTriangle}}));
  EXPECT_TRUE(file.plan.items.empty());
  using enum Outcome;
  EXPECT_EQ(outcomes(file), (std::vector{LeftOut, LeftOut, Taken, Taken, Taken, Taken}));
}

TEST(FenceText, WhatIsNotClosedIsClosedAndToldButIsNoFenceByItself) {
  const std::string open = "58.003 26.004\n58 26\n58 26.01\n58.01 26.01\n";
  EXPECT_EQ(imported(open, "x.txt").format, Format::Csv);
  const auto file = imported(open, "x.fen");
  EXPECT_EQ(file.format, Format::Fence);
  EXPECT_EQ(file.fence->areas.size(), 1u);
  EXPECT_EQ(file.rows.back().outcome, Outcome::Changed);
  EXPECT_EQ(refused("58.003 26.004\n58 26\n58 26.01\n", Format::Fence).fields.at(0).pointer,
            "line 2");
  EXPECT_EQ(refused("58.003 26.004\n58 x\n", Format::Fence).fields.at(0).pointer, "line 2");
  EXPECT_EQ(refused("", Format::Fence).fields.at(0).pointer, "line 1");
}

// ArduPilot, "Rally Points": files of lines "RALLY lat lon alt break_alt land_dir flags".
TEST(FenceText, RallyPointsAreRead) {
  const auto file =
      imported("#saved\nRALLY\t58.01\t26.01\t15.5\t40.0\t0.0\t0\nRALLY 58 26 20000\n");
  EXPECT_EQ(file.fence->rally,
            (std::vector<RallyPoint>{{{58.01, 26.01}, 15.5}, {{58.0, 26.0}, std::nullopt}}));
  EXPECT_EQ(file.rows.back().reason, "its height cannot be kept");
  EXPECT_EQ(refused("RALLY 58\n", Format::Fence).fields.at(0).pointer, "line 1");
}

// QGroundControl, "Plan file format": "geoFence … version: The version for the geofence plan
// format. Currently 2"; "rallyPoints … version 2".
TEST(PlanVersions, UnknownOnesAreRefusedAndOldOnesLeftOut) {
  const auto plan = [](const std::string& mission_version, const std::string& sections) {
    return R"({"fileType":"Plan","version":1,"mission":{"version":)" + mission_version +
           R"(,"items":[{"type":"SimpleItem","command":16,"frame":3,"params":[0,0,0,null,58,26,0]}]})" +
           sections + "}";
  };
  const auto place = [](const std::string& text) {
    return refused(text, Format::Plan).fields.at(0).pointer;
  };
  EXPECT_EQ(place(plan("3", "")), "/mission/version");
  EXPECT_EQ(place(plan("2", R"(,"geoFence":{"version":3,"polygons":[]})")), "/geoFence/version");
  EXPECT_EQ(place(plan("2", R"(,"rallyPoints":{"version":"2","points":[]})")),
            "/rallyPoints/version");
  const auto old = imported(plan("2", R"(,"geoFence":{"version":1,"polygon":[[58,26]]})"));
  EXPECT_FALSE(old.fence);
  EXPECT_EQ(old.rows.back().outcome, Outcome::LeftOut);
  EXPECT_EQ(old.rows.back().reason, "is of version 1: only version 2 can be read");
}

// The same: "TransectStyleComplexItem … Items: Array of mission item objects …,
// VisualTransectPoints: Array of coordinates"; "Survey … polygon: The survey polygon".
TEST(PlanTransects, WithoutItemsTheirLinesAreTakenAndWithoutThoseTheirField) {
  const auto plan = [](const std::string& inside) {
    return R"({"fileType":"Plan","version":1,"mission":{"version":2,"items":[{"type":"ComplexItem",)"
           R"("complexItemType":"survey","version":5,)" +
           inside + "}]}}";
  };
  const auto lines = imported(plan(
      R"("TransectStyleComplexItem":{"version":1,"Items":[],"VisualTransectPoints":[[58,26],[58.001,26]]})"));
  EXPECT_EQ(positions(lines.plan), (std::vector<LatLon>{{58.0, 26.0}, {58.001, 26.0}}));
  EXPECT_EQ(lines.rows.back().row,
            "/mission/items/0/TransectStyleComplexItem/VisualTransectPoints/1");
  const auto field = imported(plan(R"("polygon":[[58,26],[58,26.01],[58.01,26.01]])"));
  ASSERT_EQ(field.areas.size(), 1u);
  EXPECT_EQ(field.areas[0].rings.at(0), kTriangle);
  EXPECT_EQ(refused(plan(R"("TransectStyleComplexItem":{"version":9,"Items":[]})"), Format::Plan)
                .fields.at(0)
                .pointer,
            "/mission/items/0/TransectStyleComplexItem/version");
}

}  // namespace
}  // namespace roverd::mission
