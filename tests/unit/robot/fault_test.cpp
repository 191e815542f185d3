// An exception inside a tick: nothing moves, and everybody is told.

#include "field.hpp"

namespace roverd::robot {
namespace {

std::vector<std::string> details_of(const Field& f, const std::string& kind) {
  std::vector<std::string> out;
  for (const base::Event& e : f.events) {
    if (e.kind == kind) out.push_back(e.detail);
  }
  return out;
}

TEST(Faults, AnExceptionDisarmsPausesAndIsToldAndCounted) {
  Field f;
  f.drive_mission();
  EXPECT_EQ(f.state()->loop.faults, 0u);
  f.send_throws = true;
  f.tick();
  f.send_throws = false;
  EXPECT_FALSE(f.state()->armed) << "others see it at once";
  EXPECT_EQ(f.state()->loop.faults, 1u);
  EXPECT_EQ(f.state()->mode, Mode::Hold);
  EXPECT_EQ(f.execution(), ExecutionState::Paused);
  const auto told = details_of(f, "loop_fault");
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0],
            "an exception ended a tick of the control loop, and the robot is disarmed: "
            "the wire is cut");
  // It goes on ticking, and drives again once somebody says so.
  f.tick();
  EXPECT_FALSE(f.command.enabled);
  EXPECT_FALSE(f.moves());
  ASSERT_TRUE(f.ask(Arm{}));
  ASSERT_TRUE(f.ask(ResumeMission{}));
  f.run(3.0);
  EXPECT_TRUE(f.moves());
  EXPECT_EQ(f.state()->loop.faults, 1u);
}

TEST(Faults, OneAtEveryTickIsCountedEachTimeAndToldEveryTenSeconds) {
  Field f;
  f.run(1.0);
  f.send_throws = true;
  f.run(25.0);
  EXPECT_EQ(f.state()->loop.faults, 1250u);
  EXPECT_EQ(details_of(f, "loop_fault").size(), 3u);
  EXPECT_EQ(details_of(f, "loop_fault")[0],
            "an exception ended a tick of the control loop: the wire is cut");
}

TEST(DriverEvents, ADriverThatIsTriedAgainAndAgainIsToldToBeDownOnce) {
  Field f;
  const auto says = [&](base::DriverPhase phase, const std::string& reason) {
    base::DriverStatus s;
    s.stamp = f.now;
    s.name = "camera";
    s.phase = phase;
    s.reason = reason;
    f.robot.measurements().put(s);
    f.tick();
  };
  using Phase = base::DriverPhase;
  // Given: an optional camera that is not there: opened and refused every few seconds.
  for (int i = 0; i < 5; ++i) {
    says(Phase::Opening, "waiting for a frame");
    says(Phase::Faulty, i % 2 == 0 ? "connection refused" : "no frame");
  }
  // Then: one event says so.
  EXPECT_EQ(details_of(f, "driver_down"), std::vector<std::string>{"camera: connection refused"});
  // When: it comes and goes. Then: it is told again, once.
  says(Phase::Up, "");
  says(Phase::Faulty, "no frame");
  says(Phase::Opening, "waiting for a frame");
  says(Phase::Faulty, "no frame");
  EXPECT_EQ(details_of(f, "driver_up"), std::vector<std::string>{"camera is up"});
  EXPECT_EQ(details_of(f, "driver_down"),
            (std::vector<std::string>{"camera: connection refused", "camera: no frame"}));
}

}  // namespace
}  // namespace roverd::robot
