#include "field.hpp"

namespace roverd::robot {
namespace {

TEST(Arming, IsRefusedWithEveryFailingCheckNamed) {
  Field f;
  f.base_speaks = f.radio_speaks = f.gnss_speaks = false;
  f.run(1.0);
  const auto refused = f.ask(Arm{});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, base::Code::Conflict);
  std::vector<std::string> named;
  for (const auto& field : refused.error().fields) named.push_back(field.pointer);
  for (const char* id : {"gnss_fix", "position_accuracy", "base_link", "base_state", "radio"}) {
    EXPECT_TRUE(std::count(named.begin(), named.end(), std::string("/checks/") + id) == 1) << id;
  }
  EXPECT_FALSE(f.state()->armed);
  EXPECT_FALSE(f.state()->ready_to_arm);
}

TEST(Arming, NeedsAFixThatHasLasted) {
  Field f;
  f.run(3.0);
  EXPECT_FALSE(f.check("gnss_fix").ok);
  EXPECT_NE(f.check("gnss_fix").detail.find("waiting"), std::string::npos);
  f.run(3.0);
  EXPECT_TRUE(f.check("gnss_fix").ok);
  EXPECT_TRUE(f.ask(Arm{}));
  EXPECT_TRUE(f.state()->armed);
  EXPECT_TRUE(f.command.enabled);
  EXPECT_TRUE(f.has_event("armed"));
  EXPECT_TRUE(f.state()->home);
}

TEST(Arming, AReceiverThatSendsNoPositionsIsNamedByItsCheck) {
  Field f;
  f.gnss_speaks = false;
  f.run(1.0);
  EXPECT_EQ(f.check("gnss_fix").detail, "no GNSS receiver has been heard");
  base::DriverStatus receiver;
  receiver.stamp = f.now;
  receiver.name = "gnss";
  receiver.phase = base::DriverPhase::Up;
  auto detail = std::make_shared<base::DriverDetail>();
  detail->facts["no_position"] = "the receiver sends no position message";
  receiver.detail = detail;
  f.robot.measurements().put(receiver);
  f.run(0.1);
  EXPECT_FALSE(f.check("gnss_fix").ok);
  EXPECT_EQ(f.check("gnss_fix").detail, "the receiver sends no position message");
}

TEST(Arming, OneBadThingAtATimeIsEnoughToRefuse) {
  struct Case {
    const char* id;
    void (*spoil)(Field&);
  };
  const Case cases[] = {
      {"gnss_fix", [](Field& f) { f.satellites = 4; }},
      {"gnss_fix", [](Field& f) { f.fix = base::FixType::None; }},
      {"gnss_fix", [](Field& f) { f.gnss_speaks = false; }},
      {"base_link", [](Field& f) { f.base_speaks = false; }},
      {"base_state", [](Field& f) { f.vehicle_state = base::VehicleState::Exception; }},
      {"base_state", [](Field& f) { f.vehicle_state = base::VehicleState::Unknown; }},
      {"radio", [](Field& f) { f.radio_speaks = false; }},
      {"radio", [](Field& f) { f.radio_counts = false; }},
      {"radio", [](Field& f) { f.radio_lost = true; }},
      {"radio", [](Field& f) { f.swb = base::Switch::Middle; }},
      {"radio", [](Field& f) { f.control_mode = base::ControlMode::Radio; }},
      {"battery", [](Field& f) { f.charge_pct = 5.0; }},
  };
  for (const Case& c : cases) {
    Field f;
    f.run(8.0);
    ASSERT_TRUE(f.state()->ready_to_arm);
    c.spoil(f);
    f.run(3.0);
    EXPECT_FALSE(f.check(c.id).ok) << c.id;
    const auto refused = f.ask(Arm{});
    ASSERT_FALSE(refused) << c.id;
    EXPECT_TRUE(
        std::any_of(refused.error().fields.begin(), refused.error().fields.end(),
                    [&](const auto& e) { return e.pointer == std::string("/checks/") + c.id; }))
        << c.id;
  }
}

//   Indoors: to make a map, or to be found in one.
TEST(Arming, ByHandNeedsNoPositionAndNothingDrivesByItselfBeforeThereIsOne) {
  Field f;
  f.fix = base::FixType::None;
  f.run(8.0);
  ASSERT_FALSE(f.ask(Arm{}));
  ASSERT_TRUE(f.ask(Arm{.by_hand = true}));
  f.run(0.1);
  EXPECT_TRUE(f.state()->armed);
  EXPECT_TRUE(f.state()->armed_by_hand);
  EXPECT_TRUE(f.ask(SetMode{Mode::Manual}));
  const auto refused = f.ask(SetMode{Mode::Guided});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().detail.find("by hand only"), std::string::npos)
      << refused.error().detail;
  // when: the position is known; then it is as any armed robot
  f.fix = base::FixType::RtkFixed;
  f.run(15.0);
  const auto asked = f.ask(SetMode{Mode::Guided});
  EXPECT_TRUE(asked || asked.error().detail.find("by hand only") == std::string::npos);
  // when: all else must be well all the same
  Field silent;
  silent.fix = base::FixType::None;
  silent.run(8.0);
  silent.base_speaks = false;
  silent.run(3.0);
  EXPECT_FALSE(silent.ask(Arm{.by_hand = true}));
}

TEST(Arming, AnUncertainHeadingOrNoMissionOnlyWarns) {
  Field f;
  f.run(8.0);
  EXPECT_FALSE(f.check("heading").ok);
  EXPECT_EQ(f.check("heading").severity, base::Severity::Warning);
  EXPECT_NE(f.check("heading").detail.find("creep"), std::string::npos);
  EXPECT_FALSE(f.check("mission").ok);
  EXPECT_TRUE(f.state()->ready_to_arm);
}

TEST(Arming, ARadioIsNotAskedForWhereTheConfigurationSaysSo) {
  Config config;
  config.safety.radio_required = false;
  Field f(config);
  f.radio_speaks = false;
  f.run(8.0);
  EXPECT_TRUE(f.ask(Arm{}));
}

TEST(Arming, DisarmStopsAndPausesTheMission) {
  Field f;
  f.drive_mission();
  ASSERT_TRUE(f.ask(Disarm{}));
  EXPECT_FALSE(f.moves());
  EXPECT_FALSE(f.command.enabled);
  EXPECT_EQ(f.execution(), ExecutionState::Paused);
  EXPECT_EQ(f.state()->mode, Mode::Hold);
  EXPECT_TRUE(f.ask(Disarm{}));  // again: nothing to do
}

}  // namespace
}  // namespace roverd::robot
