// Courses and disturbances as files say them.

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "source_folder.hpp"
#include "study/study.hpp"

namespace roverd::study {
namespace {

base::Result<std::string> no_file(const std::string& name) {
  return base::fail(base::Code::NotFound, "cannot read " + name);
}

std::string courses_problem(const std::string& text) {
  const auto read = read_courses(text, no_file);
  return read ? "" : read.error().detail;
}

std::string disturbances_problem(const std::string& text) {
  const auto read = read_disturbances(text);
  return read ? "" : read.error().detail;
}

TEST(StudyFiles, ACourseHasPointsSpeedHeadingAndTurn) {
  const auto read = read_courses(
      R"({"courses": [{"name": "a", "points": [[0, 0], [0, 5.5], [3, 5]], "closed": true,
          "speed_mps": 1.5, "start_heading_deg": 90, "turn": "arc", "reverse": true}]})",
      no_file);
  ASSERT_TRUE(read) << read.error().detail;
  const Course& c = read->at(0);
  EXPECT_EQ(c.name, "a");
  ASSERT_EQ(c.points.size(), 4u);
  EXPECT_EQ(c.points[1].north_m, 5.5);
  EXPECT_EQ(c.points[3].east_m, 0.0);
  EXPECT_EQ(c.speed_mps, 1.5);
  EXPECT_EQ(c.start_heading_deg, 90.0);
  EXPECT_EQ(c.turn, mission::Turn::Arc);
  EXPECT_TRUE(c.reverse);
}

//  a quarter circle of 10 m, and points of it with noise: another one for each seed, but always the
//  same for one
TEST(StudyFiles, ACourseMayBeNoisyPointsOfArcs) {
  const auto read = read_courses(
      R"({"courses": [{"name": "a", "arcs": [[15.708, -0.1]], "every_m": 0.5, "noise_m": 0.01}]})",
      no_file);
  ASSERT_TRUE(read) << read.error().detail;
  const Course& c = read->at(0);
  EXPECT_NEAR(c.points.back().east_m, 10.0, 1e-3);
  EXPECT_NEAR(c.points.back().north_m, 10.0, 1e-3);
  const base::LocalFrame frame(1, {58.378, 26.729});
  const mission::Plan plan = plan_of(c, frame, 1);
  ASSERT_EQ(plan.items.size(), 33u);
  EXPECT_EQ(plan, plan_of(c, frame, 1));
  EXPECT_NE(plan, plan_of(c, frame, 2));
  for (const auto& item : plan.items) {
    const auto at = frame.to_local(std::get<mission::Waypoint>(item).at);
    EXPECT_NEAR(std::hypot(at.east_m - 10.0, at.north_m), 10.0, 0.06);
  }
  EXPECT_EQ(courses_problem(R"({"courses": [{"name": "a", "arcs": [[0, 1]]}]})"),
            "/courses/0/arcs/0 must be [length_m, curvature_1pm]");
  EXPECT_EQ(courses_problem(R"({"courses": [{"name": "a", "arcs": [[1, 1]], "taught": true}]})"),
            "/courses/0 must have every_m with noise_m and taught");
}

TEST(StudyFiles, ACourseMayBeAMissionsFile) {
  const std::string mission = R"({"name": "m", "items": [{"type": "waypoint", "lat": 58, "lon": 26},
      {"type": "waypoint", "lat": 58.0001, "lon": 26}]})";
  const std::string text = R"({"courses": [{"name": "a", "mission": "m.json"}]})";
  const auto read = read_courses(text, [&](const std::string& name) {
    EXPECT_EQ(name, "m.json");
    return base::Result<std::string>(mission);
  });
  ASSERT_TRUE(read) << read.error().detail;
  ASSERT_TRUE(read->at(0).plan);
  EXPECT_EQ(read->at(0).plan->items.size(), 2u);
  EXPECT_EQ(courses_problem(text), "cannot read m.json");
}

TEST(StudyFiles, WhatIsWrongInACourseIsNamed) {
  const auto with = [](const std::string& members) {
    return R"({"courses": [{"name": "a", )" + members + "}]}";
  };
  const std::string points = R"("points": [[0, 0], [1, 0]])";
  EXPECT_EQ(courses_problem("{").rfind("not JSON at byte 1", 0), 0u);
  EXPECT_EQ(courses_problem("[]"), " must be an object with the member courses");
  EXPECT_EQ(courses_problem(R"({"courses": []})"), "/courses must be a list of at least one");
  EXPECT_EQ(courses_problem(R"({"courses": [7]})"), "/courses/0 must be an object");
  EXPECT_EQ(courses_problem(R"({"courses": [{"points": []}]})"), "/courses/0/name is required");
  EXPECT_EQ(courses_problem(with(R"("speed_mps": 1)")),
            "/courses/0 must have points, arcs or mission");
  EXPECT_EQ(courses_problem(with(R"("points": [[0, 0]])")),
            "/courses/0/points must be a list of two points or more");
  EXPECT_EQ(courses_problem(with(R"("points": [[0, 0], [1]])")),
            "/courses/0/points/1 must be [east_m, north_m]");
  EXPECT_EQ(courses_problem(with(R"("points": [[0, 0], [1, 99999]])")),
            "/courses/0/points/1 must be [east_m, north_m]");
  EXPECT_EQ(courses_problem(with(points + R"(, "speed_mps": 99)")),
            "/courses/0/speed_mps must be from 0.05 to 10, is 99");
  EXPECT_EQ(courses_problem(with(points + R"(, "turn": "wide")")),
            "/courses/0/turn must be auto, pivot, arc or through");
  EXPECT_EQ(courses_problem(with(points + R"(, "colour": 1)")),
            "/courses/0/colour is not a known member");
  EXPECT_EQ(courses_problem(R"({"courses": [{"name": "a", "points": [[0, 0], [1, 0]]},
                                            {"name": "a", "points": [[0, 0], [1, 0]]}]})"),
            "/courses/1/name is there twice");
}

TEST(StudyFiles, ADisturbanceSetsTheSimulatorAndTheRobot) {
  const auto read = read_disturbances(
      R"({"disturbances": [{"name": "d", "sim": {"drive.slip": 0.2, "gnss.profile": "float"},
          "robot": {"nav.track.law": "stanley", "nav.track.delay_s": 0.25},
          "start_off_m": 3, "start_turn_deg": 180}]})");
  ASSERT_TRUE(read) << read.error().detail;
  const Disturbance& d = read->at(0);
  ASSERT_EQ(d.sim.size(), 2u);
  EXPECT_EQ(d.sim[0].first, "drive.slip");
  EXPECT_EQ(std::get<double>(d.sim[0].second), 0.2);
  EXPECT_EQ(d.robot, (std::vector<std::string>{"nav.track.delay_s=0.25", "nav.track.law=stanley"}));
  EXPECT_EQ(d.start_off_m, 3.0);
  EXPECT_EQ(d.start_turn_deg, 180.0);
}

TEST(StudyFiles, ADisturbanceMayComeLaterAndStartBesideTheWay) {
  const auto read = read_disturbances(
      R"({"disturbances": [{"name": "d", "start_offset_m": [-2, 0.5], "start_heading_off_deg": -30,
          "later": [{"after_s": 12, "sim": {"drive.crab": 0.1}, "fault": {"gnss_jump_east_m": 3}},
                    {"after_s": 20, "fault": {"gnss_silent": true}}]}]})");
  ASSERT_TRUE(read) << read.error().detail;
  const Disturbance& d = read->at(0);
  EXPECT_EQ(d.start_forward_m, -2.0);
  EXPECT_EQ(d.start_left_m, 0.5);
  EXPECT_EQ(d.start_heading_off_deg, -30.0);
  ASSERT_EQ(d.later.size(), 2u);
  EXPECT_EQ(d.later[0].after_s, 12.0);
  EXPECT_EQ(d.later[0].sim.at(0).first, "drive.crab");
  EXPECT_EQ(std::get<double>(d.later[0].fault.at(0).second), 3.0);
  EXPECT_EQ(d.later[1].fault.at(0).first, "gnss_silent");
}

TEST(StudyFiles, WhatIsWrongInADisturbanceIsNamed) {
  const auto with = [](const std::string& members) {
    return R"({"disturbances": [{"name": "d", )" + members + "}]}";
  };
  EXPECT_EQ(disturbances_problem(with(R"("sim": {"drive.slipp": 1})")),
            "/disturbances/0/sim unknown key drive.slipp");
  EXPECT_EQ(disturbances_problem(with(R"("sim": {"drive.slip": 2})")),
            "/disturbances/0/sim drive.slip must lie in 0.0 .. 0.9");
  EXPECT_EQ(disturbances_problem(with(R"("sim": {"drive.slip": [1]})")),
            "/disturbances/0/sim/drive.slip must be a number, a text or true/false");
  EXPECT_EQ(disturbances_problem(with(R"("start_offset_m": [1])")),
            "/disturbances/0/start_offset_m must be [forward_m, left_m], at most 100 m");
  EXPECT_EQ(disturbances_problem(with(R"("later": [{"fault": {"estop": true}}])")),
            "/disturbances/0/later/0/after_s is required");
  EXPECT_EQ(disturbances_problem(with(R"("later": [{"after_s": 1, "fault": {"stop": true}}])")),
            "/disturbances/0/later/0/fault stop: unknown key");
  EXPECT_EQ(disturbances_problem(with(R"("later": [{"after_s": 1, "fault": {"gnss_fix": "x"}}])")),
            "/disturbances/0/later/0/fault gnss_fix: no fix has this name");
  EXPECT_EQ(disturbances_problem(with(R"("later": [{"after_s": 1, "sim": {"drive.slip": 2}}])")),
            "/disturbances/0/later/0/sim drive.slip must lie in 0.0 .. 0.9");
  EXPECT_EQ(disturbances_problem(with(R"("robot": 5)")),
            "/disturbances/0 sim and robot are objects");
}

TEST(StudyFiles, ThoseThatAreShippedCanBeRead) {
  const auto text = [](const std::filesystem::path& path) {
    std::ifstream in(path);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  const std::filesystem::path folder = tests::in_source("config");
  for (const auto& file : std::filesystem::directory_iterator(folder / "courses")) {
    const auto read = read_courses(text(file.path()), no_file);
    EXPECT_TRUE(read) << file.path() << ": " << read.error().detail;
  }
  for (const auto& file : std::filesystem::directory_iterator(folder / "disturbances")) {
    const auto read = read_disturbances(text(file.path()));
    EXPECT_TRUE(read) << file.path() << ": " << read.error().detail;
  }
}

}  // namespace
}  // namespace roverd::study
