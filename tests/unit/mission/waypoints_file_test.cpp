#include <algorithm>

#include <gtest/gtest.h>

#include "files.hpp"
#include "mission/formats/formats.hpp"
#include "plans.hpp"

namespace roverd::mission {
namespace {

using base::Code;

TEST(Formats, AreDetectedByContentThenByName) {
  EXPECT_EQ(detect_format("QGC WPL 110\n"), Format::Waypoints);
  EXPECT_EQ(detect_format("\xEF\xBB\xBF\r\n QGC WPL 110"), Format::Waypoints);
  EXPECT_EQ(detect_format("QGC WPL 110\n", "x.plan"), Format::Waypoints);
  EXPECT_EQ(detect_format(R"({ "fileType": "Plan" })", "x.txt"), Format::Plan);
  EXPECT_EQ(detect_format("", "FIELD.PLAN"), Format::Plan);
  EXPECT_EQ(detect_format("", "a.waypoints"), Format::Waypoints);
  EXPECT_EQ(detect_format("<?xml version=\"1.0\"?><gpx>", "a.kml"), Format::Gpx);
  EXPECT_EQ(detect_format("<html>", "a.html"), std::nullopt);
  EXPECT_EQ(detect_format(""), std::nullopt);
  EXPECT_EQ(import_file("hello", std::nullopt).error().code, Code::Unsupported);
  EXPECT_EQ(format_from("waypoints"), Format::Waypoints);
  EXPECT_EQ(format_from("doc"), std::nullopt);
}

TEST(Waypoints, RowsBecomeItemsAndEachIsAccountedFor) {
  const auto file = imported(file_of({
      "3 16 2.5 0.4 0 0 58.3781 26.7291 0 1",  // 1 waypoint
      "3 178 1 0.8 -1 0 0 0 0 1",              // 2 speed
      "3 93 12 -1 -1 -1 0 0 0 1",              // 3 wait
      "3 115 90 0 1 1 0 0 0 1",                // 4 turn, relative
      "3 115 270 0 0 0 0 0 0 1",               // 5 turn, absolute
      "3 177 1 3 0 0 0 0 0 1",                 // 6 jump
      "3 19 7 0 0 0 58.3782 26.7292 0 1",      // 7 loiter time
      "0 20 0 0 0 0 0 0 0 1",                  // 8 home
  }));
  Waypoint first = waypoint_at(58.3781, 26.7291);
  first.hold_s = 2.5;
  first.radius_m = 0.4;
  const Loiter last{58.3782, 26.7292, 7.0, std::nullopt};
  EXPECT_EQ(file.plan.items,
            (std::vector<Item>{first, Speed{0.8}, Wait{12.0}, TurnBy{90.0, std::nullopt},
                               TurnBy{std::nullopt, 270.0}, Jump{1, 3}, last, ReturnHome{}}));
  EXPECT_EQ(file.plan.home, (Home{{58.378, 26.7289}, 61.5}));
  EXPECT_EQ(file.plan.name, "a");
  ASSERT_EQ(file.rows.size(), 9u);
  for (std::size_t i = 0; i < file.rows.size(); ++i) {
    EXPECT_EQ(file.rows[i].row, "line " + std::to_string(i + 2));
    EXPECT_EQ(file.rows[i].outcome, Outcome::Taken) << file.rows[i].reason;
  }
  EXPECT_EQ(file.rows[0].what, "home");
  EXPECT_EQ(row(file, 6).what, "DO_JUMP (177)");
  EXPECT_EQ(row(file, 6).item, 6);
}

TEST(Waypoints, WhatAVehicleOnTheGroundCannotDoIsLeftOutWithTheReason) {
  const auto file = imported(file_of({
      "3 22 15 0 0 0 0 0 5 1",             // 1 take-off
      "3 16 0 0 0 0 58.3781 26.7291 0 1",  // 2
      "3 201 0 0 0 0 58.3 26.7 0 1",       // 3 ROI
      "3 2500 0 0 0 0 0 0 0 1",            // 4 unknown
      "1 16 0 0 0 0 10 20 0 1",            // 5 local frame
      "3 178 1 15 0 0 0 0 0 1",            // 6 15 m/s
      "3 179 1 0 0 0 0 0 0 1",             // 7 set home
      "3 177 99 3 0 0 0 0 0 1",            // 8 jump nowhere
      "3 177 2 0 0 0 0 0 0 1",             // 9 jump zero times
      "3 93 -1 10 0 0 0 0 0 1",            // 10 time of day
  }));
  EXPECT_EQ(file.plan.items, (std::vector<Item>{waypoint_at(58.3781, 26.7291)}));
  for (const std::size_t number : {1u, 3u, 4u, 5u, 6u, 7u, 8u, 9u, 10u}) {
    EXPECT_EQ(row(file, number).outcome, Outcome::LeftOut) << number;
    EXPECT_FALSE(row(file, number).reason.empty()) << number;
    EXPECT_FALSE(row(file, number).item) << number;
  }
  EXPECT_EQ(row(file, 6).reason, "a speed of 15 m/s is not possible");
  EXPECT_EQ(row(file, 8).reason, "there is no row 99");
}

TEST(Waypoints, WhatIsDoneInAnotherWaySaysHow) {
  const auto file = imported(file_of({
      "3 82 0 0 0 0 58.1 26.1 0 1",     // 1 spline
      "3 17 0 0 0 0 58.2 26.2 0 1",     // 2 loiter
      "0 16 0 0 0 0 58.3 26.3 80 1",    // 3 height above sea
      "3 16 0 500 0 90 58.4 26.4 0 0",  // 4 radius, heading, autocontinue
      "3 16 30 0 0 0 0 0 0 1",          // 5 hold here
      "3 112 5 0 0 0 0 0 0 1",          // 6 condition delay
      "3 177 1 -1 0 0 0 0 0 1",         // 7 jump for ever
      "3 177 1 99999 0 0 0 0 0 1",      // 8 many times
  }));
  ASSERT_EQ(file.plan.items.size(), 8u);
  for (const std::size_t number : {1u, 3u, 4u, 5u, 6u, 8u}) {
    EXPECT_EQ(row(file, number).outcome, Outcome::Changed) << number;
    EXPECT_FALSE(row(file, number).reason.empty()) << number;
    EXPECT_EQ(row(file, number).item, static_cast<int>(number));
  }
  EXPECT_EQ(row(file, 7).outcome, Outcome::Taken);
  EXPECT_EQ(row(file, 2).outcome, Outcome::Taken);
  EXPECT_EQ(std::get<Waypoint>(file.plan.items[2]).alt_m, 80.0);
  EXPECT_EQ(file.plan.items[4], Item(Wait{30.0}));
  EXPECT_EQ(file.plan.items[6], Item(Jump{1, 0}));
  EXPECT_EQ(file.plan.items[7], Item(Jump{1, 10'000}));
}

TEST(Waypoints, AJumpLeadsToTheSamePlaceAlthoughRowsBeforeItAreLeftOut) {
  const auto file = imported(file_of({
      "3 22 0 0 0 0 0 0 5 1",        // 1 left out
      "3 16 0 0 0 0 58.1 26.1 0 1",  // 2 → item 1
      "3 201 0 0 0 0 0 0 0 1",       // 3 left out
      "3 16 0 0 0 0 58.2 26.2 0 1",  // 4 → item 2
      "3 177 4 2 0 0 0 0 0 1",       // 5 → item 3, to 2
      "3 177 3 2 0 0 0 0 0 1",       // 6 → item 4, to 2 (row 3 is left out)
      "3 177 5 1 0 0 0 0 0 1",       // 7 → item 5, to 3 (a jump)
      "3 177 8 1 0 0 0 0 0 1",       // 8 itself
      "3 177 9 1 0 0 0 0 0 1",       // 9 itself
      "3 16 0 0 0 0 58.3 26.3 0 1",  // 10 → item 6
  }));
  ASSERT_EQ(file.plan.items.size(), 6u);
  EXPECT_EQ(file.plan.items[2], Item(Jump{2, 2}));
  EXPECT_EQ(file.plan.items[3], Item(Jump{2, 2}));
  EXPECT_EQ(row(file, 6).outcome, Outcome::Changed);
  EXPECT_EQ(file.plan.items[4], Item(Jump{3, 1}));
  EXPECT_EQ(row(file, 8).reason, "it jumps to itself");
}

TEST(Waypoints, ReverseIsTakenOverToTheWaypointsThatFollow) {
  const auto file = imported(file_of({
      "3 16 0 0 0 0 58.1 26.1 0 1",
      "3 194 1 0 0 0 0 0 0 1",
      "3 16 0 0 0 0 58.2 26.2 0 1",
      "3 194 0 0 0 0 0 0 0 1",
      "3 16 0 0 0 0 58.3 26.3 0 1",
  }));
  ASSERT_EQ(file.plan.items.size(), 3u);
  EXPECT_FALSE(std::get<Waypoint>(file.plan.items[0]).reverse);
  EXPECT_TRUE(std::get<Waypoint>(file.plan.items[1]).reverse);
  EXPECT_FALSE(std::get<Waypoint>(file.plan.items[2]).reverse);
  const auto again = imported(export_file(file.plan, Format::Waypoints).content);
  EXPECT_EQ(again.plan.items, file.plan.items);
}

TEST(Waypoints, LineEndsBomBlanksAndCommentsDoNotMatter) {
  std::string text = file_of({"3 16 0 0 0 0 58.3781 26.7291 0 1"});
  const Plan wanted = imported(text).plan;
  std::string crlf;
  std::string cr;
  std::string tabs = text;
  for (const char c : text) {
    crlf += c == '\n' ? "\r\n" : std::string(1, c);
    cr += c == '\n' ? '\r' : c;
  }
  std::replace(tabs.begin() + 12, tabs.end(), ' ', '\t');
  for (const std::string& other :
       {crlf, cr, tabs, "\xEF\xBB\xBF" + text, "\n\n" + text + "\n\n# the end\n",
        text.substr(0, text.size() - 1)}) {
    EXPECT_EQ(imported(other).plan, wanted) << other;
  }
  EXPECT_EQ(imported(text + "# note\n").rows.at(1).what, "NAV_WAYPOINT (16)");
}

TEST(Waypoints, BrokenFilesAreRefusedByLine) {
  EXPECT_EQ(refused("").fields.at(0).pointer, "line 1");
  EXPECT_EQ(refused("QGC WPL 120\n").fields.at(0).pointer, "line 1");
  EXPECT_EQ(refused("\n1 2 3\n").fields.at(0).pointer, "line 2");
  struct Case {
    const char* row;
    const char* part;  // of the detail
  };
  for (const Case& c : std::initializer_list<Case>{
           {"3 16 0 0 0 0 58.3781 26.72", "12 columns, has 10"},
           {"3 16 0 0 0 0 58.3781 26.7291 0 1 9", "has 13"},
           {"3 16 0 0 0 0 north 26.7291 0 1", "latitude must be a number, is \"north\""},
           {"3 16 0 0 0 0 58,3781 26.7291 0 1", "latitude must be a number"},
           {"3 16 0 0 0 0 1e999 26.7291 0 1", "latitude must be a number that fits"},
           {"3 16 0 0 0 0 inf 26.7291 0 1", "latitude must be finite"},
           {"3 16 0 0 0 0 nan 26.7291 0 1", "latitude must be a number from -90 to 90"},
           {"3 16 0 0 0 0 90.1 26.7291 0 1", "latitude must be a number from -90 to 90, is 90.1"},
           {"3 16 0 0 0 0 58 -181 0 1", "longitude must be a number from -180 to 180, is -181"},
           {"3 16.5 0 0 0 0 58 26 0 1", "command must be a whole number"},
           {"-1 16 0 0 0 0 58 26 0 1", "frame must be a whole number"},
           {"3 1e300 0 0 0 0 58 26 0 1", "command must be a whole number"}}) {
    const auto error = refused(file_of({"3 16 0 0 0 0 58.1 26.1 0 1", c.row}));
    EXPECT_EQ(error.code, Code::Invalid);
    ASSERT_EQ(error.fields.size(), 1u) << c.row;
    EXPECT_EQ(error.fields[0].pointer, "line 4");
    EXPECT_NE(error.fields[0].detail.find(c.part), std::string::npos) << error.fields[0].detail;
  }
  EXPECT_NE(refused("QGC WPL 110\n0 0 0 16 0 0 0 0 95 26 0 1\n").detail.find("line 2 latitude"),
            std::string::npos);
  EXPECT_NE(refused("QGC WPL 110\n2 0 3 16 0 0 0 0 5 26 0 1\n1 0 3 16 0 0 0 0 5 26 0 1\n")
                .detail.find("must be more than 2"),
            std::string::npos);
}

TEST(Waypoints, EveryWrongLineIsNamedAtOnce) {
  const auto error = refused(file_of({"3 16 0 0 0 0 95 26 0 1", "x", "3 16 0 0 0 0 5 x 0 1"}));
  ASSERT_EQ(error.fields.size(), 3u);
  std::vector<std::string> places;
  for (const auto& field : error.fields) places.push_back(field.pointer);
  std::sort(places.begin(), places.end());
  EXPECT_EQ(places, (std::vector<std::string>{"line 3", "line 4", "line 5"}));
}

}  // namespace
}  // namespace roverd::mission
