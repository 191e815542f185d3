// What keeps people safe is not relaxed while the robot may move, and whoever starts a mission sees
// what was. What shapes a mission's way reaches one that is loaded.

#include <set>

#include "field.hpp"
#include "robot/compile.hpp"
#include "robot/safety/fence_guard.hpp"

namespace roverd::robot {
namespace {

TEST(SafetyParameters, ArmedChangeOnlyToTheStricterSide) {
  Field f;
  f.drive_mission();
  const auto of = [&](const char* name, base::ParamValue value) {
    const auto done = f.ask(SetParameter{name, std::move(value)});
    if (done) return std::string("done");
    EXPECT_EQ(done.error().code, base::Code::Conflict);
    return done.error().detail;
  };
  EXPECT_EQ(
      of("robot.fence.margin_m", 0.05),
      "robot.fence.margin_m keeps people safe: while the robot is armed it is only raised (it "
      "is 0.1); disarm first");
  EXPECT_EQ(of("robot.safety.base_timeout_s", 2.0),
            "robot.safety.base_timeout_s keeps people safe: while the robot is armed it is only "
            "lowered (it is 0.4); disarm first");
  EXPECT_EQ(of("robot.safety.radio_required", false),
            "robot.safety.radio_required keeps people safe: while the robot is armed it is only "
            "switched on (it is true); disarm first");
  EXPECT_EQ(of("nav.behave.unreachable", std::string("skip")),
            "nav.behave.unreachable keeps people safe: while the robot is armed it stays as it is; "
            "disarm first");
  EXPECT_NE(of("nav.speed.max_mps", 1.5), "done");
  EXPECT_NE(of("robot.manual.max_mps", 3.0), "done");
  EXPECT_EQ(f.robot.config()->fence.margin_m, 0.1);
  EXPECT_EQ(f.robot.config()->speed.max_mps, 1.2);
  EXPECT_FALSE(f.has_event("safety_parameter"));

  EXPECT_EQ(of("robot.fence.margin_m", 0.5), "done");
  EXPECT_EQ(of("robot.safety.base_timeout_s", 0.3), "done");
  EXPECT_EQ(of("nav.speed.max_mps", 0.6), "done");
  EXPECT_EQ(of("nav.track.damping", 1.2), "done");  // no safety parameter: either way
  EXPECT_EQ(of("nav.track.damping", 0.8), "done");
  EXPECT_EQ(f.robot.config()->fence.margin_m, 0.5);
  // And not back, before somebody disarms.
  EXPECT_NE(of("robot.fence.margin_m", 0.1), "done");
  ASSERT_TRUE(f.ask(Disarm{}));
  EXPECT_EQ(of("robot.fence.margin_m", 0.05), "done");
}

TEST(SafetyParameters, AChangeIsAnEventThatTellsWhoAndFromWhatToWhat) {
  Field f;
  f.run(1.0);
  ASSERT_TRUE(f.ask(SetParameter{"robot.safety.spin_s", 5.0, "anna"}));
  ASSERT_TRUE(f.ask(SetParameter{"nav.track.damping", 1.2, "anna"}));
  ASSERT_TRUE(f.ask(SetParameter{"vehicle.width_m", 0.9, "anna", true}));
  const auto told = [&](const std::string& kind, std::size_t nth) {
    for (const base::Event& e : f.events) {
      if (e.kind == kind && nth-- == 0) {
        const bool loud = e.level == base::Severity::Warning;
        return e.detail + (loud ? "!" : "");
      }
    }
    return std::string("none");
  };
  EXPECT_EQ(told("safety_parameter", 0),
            "robot.safety.spin_s was changed from 3.0 to 5.0 by anna!");
  EXPECT_EQ(told("parameter", 0), "nav.track.damping was changed from 0.9 to 1.2 by anna");
  EXPECT_EQ(told("safety_parameter", 1),
            "vehicle.width_m will change at the next start from 0.778 to 0.9 by anna!");
  EXPECT_EQ(f.robot.config()->vehicle.width_m, 0.778);
}

TEST(SafetyParameters, GeometryForTheNextStartIsRefusedWhileArmedToo) {
  Field f;
  f.drive_mission();
  const auto done = f.ask(SetParameter{"vehicle.width_m", 0.5, {}, true});
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().detail,
            "vehicle.width_m keeps people safe: while the robot is armed it stays as it is; disarm "
            "first");
}

/// The mark stands in the one table; what stands there for safety's sake has one even if nobody
/// thought of it.
TEST(SafetyParameters, AreAllOfTheSectionsThatAreThereForSafetysSake) {
  const std::set<std::string> all{"robot.safety", "robot.fence", "robot.arming",
                                  "robot.manual", "vehicle",     "radio"};
  int marked = 0;
  for (const Parameter& p : Field{}.robot.parameters()) {
    if (p.info.stricter != base::Stricter::Any) ++marked;
    if (all.contains(p.section)) {
      EXPECT_NE(p.info.stricter, base::Stricter::Any) << p.section << "." << p.info.name;
    }
    if (p.section == "robot.fence" || p.section == "robot.manual") {
      EXPECT_NE(p.info.stricter, base::Stricter::None) << p.section << "." << p.info.name;
    }
  }
  EXPECT_GT(marked, 60);
}

TEST(SafetyParameters, ThatAreNotAsTheProfileSaysAreFoundBeforeAStart) {
  Config files;
  Config with_line = files;
  with_line.safety.radio_required = false;  // --set
  Field f(with_line);
  f.robot.reviewed(files);
  f.run(1.0);
  ASSERT_TRUE(f.ask(SetParameter{"robot.fence.margin_m", 0.02}));
  ASSERT_TRUE(f.ask(SetParameter{"nav.speed.max_mps", 0.9}));
  ASSERT_TRUE(f.ask(SetParameter{"nav.track.damping", 1.2}));
  f.run(0.1);
  std::vector<std::string> told;
  for (const mission::Finding& found : f.robot.changed_safety()) {
    EXPECT_EQ(found.severity, mission::Severity::Warning);
    EXPECT_EQ(found.code, "safety_parameter");
    told.push_back(found.detail);
  }
  EXPECT_EQ(
      told,
      (std::vector<std::string>{
          "the safety parameter nav.speed.max_mps is 0.9, the vehicle's profile says 1.2 (this is "
          "stricter)",
          "the safety parameter robot.safety.radio_required is false, the vehicle's profile says "
          "true",
          "the safety parameter robot.fence.margin_m is 0.02, the vehicle's profile says 0.1"}));
  ASSERT_TRUE(f.ask(SetParameter{"robot.fence.margin_m", 0.1}));
  f.run(0.1);
  EXPECT_EQ(f.robot.changed_safety().size(), 2u);
  EXPECT_TRUE(Field{}.robot.changed_safety().empty());
}

/// A corner in the middle of a mission, by its deviation.
const std::vector<base::EnuPoint> kCorner{{0, 3}, {0, 9}, {4, 13}, {4, 20}};

TEST(WayParameters, ALoadedMissionThatIsNotInHandIsLaidAnew) {
  Field f;
  f.run(8.0);
  ASSERT_TRUE(f.load(plan_of(kCorner)));
  EXPECT_FALSE(f.state()->mission.laid_by_old);
  ASSERT_TRUE(f.ask(SetParameter{"nav.track.corner_deviation_m", 0.4}));
  f.run(0.1);
  EXPECT_TRUE(f.state()->mission.laid_by_old);
  const auto compiled = f.robot.compile(*f.robot.loaded());
  ASSERT_TRUE(compiled);
  ASSERT_TRUE(f.ask(LayAnew{*compiled}));
  f.run(0.1);
  EXPECT_FALSE(f.state()->mission.laid_by_old);
  EXPECT_EQ(f.execution(), ExecutionState::Loaded);
  EXPECT_TRUE(f.has_event("mission_laid_anew"));
  // A parameter that lays no way changes nothing about it.
  ASSERT_TRUE(f.ask(SetParameter{"nav.track.damping", 1.2}));
  f.run(0.1);
  EXPECT_FALSE(f.state()->mission.laid_by_old);
}

TEST(WayParameters, AMissionInHandKeepsItsWayAndAFinishedOneStaysFinished) {
  Field f;
  f.drive_mission();
  ASSERT_TRUE(f.ask(SetParameter{"nav.pivot.angle_deg", 60.0}));
  f.run(0.1);
  EXPECT_TRUE(f.state()->mission.laid_by_old);
  auto compiled = f.robot.compile(*f.robot.loaded());
  ASSERT_TRUE(compiled);
  const auto running = f.ask(LayAnew{*compiled});
  ASSERT_FALSE(running);
  EXPECT_EQ(running.error().detail, "the mission is running: its way stays as it is");
  ASSERT_TRUE(f.ask(PauseMission{}));
  EXPECT_FALSE(f.ask(LayAnew{*compiled}));
  ASSERT_TRUE(f.ask(StopMission{}));
  const std::string reason = f.state()->mission.reason;
  ASSERT_TRUE(f.ask(LayAnew{*compiled}));
  f.run(0.1);
  EXPECT_EQ(f.execution(), ExecutionState::Aborted);
  EXPECT_EQ(f.state()->mission.reason, reason);
  EXPECT_FALSE(f.state()->mission.laid_by_old);
  // Of another mission, or of none, nothing is laid.
  ASSERT_TRUE(f.load(plan_of(kCorner), 2));
  EXPECT_FALSE(f.ask(LayAnew{*compiled}));
  EXPECT_FALSE(f.ask(LayAnew{nullptr}));
}

/// A square of 12 m, and a mission that keeps 0.9 m to it.
TEST(FenceMargin, AStartComparesWithTheMarginAsItIs) {
  Field f;
  f.run(8.0);
  auto fence = std::make_shared<mission::Fence>();
  fence->name = "yard";
  mission::FencePolygon p;
  for (const base::EnuPoint c : {base::EnuPoint{-6, -6}, base::EnuPoint{6, -6},
                                 base::EnuPoint{6, 6}, base::EnuPoint{-6, 6}}) {
    p.points.push_back(kFrame.to_global(c));
  }
  fence->areas.push_back({mission::AreaKind::Inclusion, p});
  ASSERT_TRUE(f.ask(SetFence{f.robot.lay_fence(fence)}));
  ASSERT_TRUE(f.load(plan_of({{0, 2}, {0, 4.5}})));
  f.run(0.1);
  EXPECT_TRUE(f.state()->fence->compared);
  EXPECT_TRUE(f.robot.objections({"m", 1}).empty());
  ASSERT_TRUE(f.ask(Arm{}));
  ASSERT_TRUE(f.ask(SetParameter{"robot.fence.margin_m", 2.0}));
  f.run(0.1);
  EXPECT_FALSE(f.state()->fence->compared);
  ASSERT_EQ(f.robot.objections({"m", 1}).size(), 1u);
  const auto early = f.ask(StartMission{"m", 1});
  ASSERT_FALSE(early);
  EXPECT_EQ(early.error().detail, "fence and mission are being compared: try again");
  // As the fence's keeper does it.
  ASSERT_TRUE(f.ask(SetFence{f.robot.lay_fence(fence)}));
  f.run(0.1);
  EXPECT_TRUE(f.state()->fence->compared);
  const auto outside = f.ask(StartMission{"m", 1});
  ASSERT_FALSE(outside);
  EXPECT_NE(outside.error().detail.find("fence"), std::string::npos) << outside.error().detail;
  EXPECT_EQ(outside.error().fields.at(0).pointer, "/items/1");
}

}  // namespace
}  // namespace roverd::robot
