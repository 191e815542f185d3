// Goals, moves and targets that nobody can drive to are refused whole, and say why.

#include <limits>

#include "field.hpp"

namespace roverd::robot {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kEndless = std::numeric_limits<double>::infinity();

/// Armed, in HOLD, where its map begins.
class Goals : public testing::Test {
 protected:
  void SetUp() override {
    f.run(8.0);
    const auto armed = f.ask(Arm{});
    ASSERT_TRUE(armed) << armed.error().detail;
  }

  static GoTo at(double east_m, double north_m) {
    GoTo g;
    g.local = base::EnuPoint{east_m, north_m};
    return g;
  }
  SetTarget target(double east_m, double north_m) const {
    SetTarget t;
    t.local = base::EnuPoint{east_m, north_m};
    t.asked = f.now;
    return t;
  }

  void refuses(Command command, base::Code code, const std::string& word) {
    const auto answer = f.ask(std::move(command));
    ASSERT_FALSE(answer) << word;
    EXPECT_EQ(answer.error().code, code) << answer.error().detail;
    EXPECT_NE(answer.error().detail.find(word), std::string::npos) << answer.error().detail;
    f.run(0.2);
    EXPECT_FALSE(f.moves()) << word;
    EXPECT_EQ(f.state()->mode, Mode::Hold) << word;
  }

  Field f;
};

TEST_F(Goals, WithNumbersThatAreNoneAreRefused) {
  for (const double bad : {kNan, kEndless, -kEndless}) {
    refuses(at(bad, 1.0), base::Code::Invalid, "finite");
    refuses(at(1.0, bad), base::Code::Invalid, "finite");
    GoTo turned = at(1.0, 1.0);
    turned.yaw_rad = bad;
    refuses(turned, base::Code::Invalid, "finite");
    GoTo fast = at(1.0, 1.0);
    fast.speed_mps = bad;
    refuses(fast, base::Code::Invalid, "finite");
    for (std::optional<double> MoveBy::*member :
         {&MoveBy::forward_m, &MoveBy::turn_rad, &MoveBy::yaw_rad, &MoveBy::speed_mps}) {
      MoveBy move;
      move.forward_m = 1.0;
      move.*member = bad;
      refuses(move, base::Code::Invalid, "finite");
    }
    SetTarget late = target(3.0, 0.0);
    late.age_s = bad;
    refuses(late, base::Code::Invalid, "finite");
    for (double SetTarget::*member : {&SetTarget::a_m, &SetTarget::b_m}) {
      SetTarget aside = target(3.0, 0.0);
      aside.*member = bad;
      refuses(aside, base::Code::Invalid, "finite");
    }
    SetTarget east = target(3.0, 0.0);
    east.velocity_mps = base::EnuPoint{bad, 0.0};
    refuses(east, base::Code::Invalid, "finite");
    SetTarget north = target(3.0, 0.0);
    north.velocity_mps = base::EnuPoint{0.0, bad};
    refuses(north, base::Code::Invalid, "finite");
  }
}

TEST_F(Goals, BeyondTheMapAreRefused) {
  const double far_m = base::LocalFrame::kReach_m + 1.0;
  refuses(at(far_m, 0.0), base::Code::Invalid, "10 km");
  refuses(at(0.0, -far_m), base::Code::Invalid, "10 km");
  refuses(at(0.8 * far_m, 0.8 * far_m), base::Code::Invalid, "10 km");
  EXPECT_TRUE(f.ask(at(0.0, base::LocalFrame::kReach_m - 1.0)));
  EXPECT_EQ(f.state()->mode, Mode::Guided);
}

TEST_F(Goals, ThatSayNothingAreRefused) {
  refuses(GoTo{}, base::Code::Invalid, "a position, or a heading and a speed");
  GoTo heading;
  heading.yaw_rad = 1.0;
  refuses(heading, base::Code::Invalid, "a position, or a heading and a speed");
  refuses(SetTarget{}, base::Code::Invalid, "position");
}

TEST_F(Goals, ATargetOfTomorrowOrOfLongAgoIsRefused) {
  SetTarget tomorrow = target(3.0, 0.0);
  tomorrow.asked = f.now + std::chrono::seconds(1);
  refuses(tomorrow, base::Code::Invalid, "future");
  SetTarget old = target(3.0, 0.0);
  old.age_s = 60.0;
  refuses(old, base::Code::Late, "too long ago");
}

TEST_F(Goals, OfTwoTurnsTheOneByAnAngleIsMade) {
  MoveBy turn;
  turn.turn_rad = 0.5;
  turn.yaw_rad = f.yaw_rad - 1.0;
  const double before = f.yaw_rad;
  ASSERT_TRUE(f.ask(turn));
  f.run(10.0);
  EXPECT_FALSE(f.moves());
  EXPECT_NEAR(base::wrap_rad(f.yaw_rad - before), 0.5, 0.05);
}

}  // namespace
}  // namespace roverd::robot
