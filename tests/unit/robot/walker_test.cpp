// The robot's whole machine (modes, arming, e-stop, radio, sticks, losses) walked at random in
// simulated time. At every tick, whatever came before:
//
//   nothing moves   unless armed, without e-stop, with a base that speaks and listens
//                   while the radio drives, from the first tick after it is seen
//                   unless a person holds a stick that was let go since the last thing that began,
//                   or gave the word to what drives by itself since it last stood in HOLD
//                   beyond the fence
//   a disarmed robot is never told that it may
//
// The model below knows what was asked and what the state shows, nothing of the code. Seeds and
// steps are stated: WALK_SEEDS=500 makes ten million steps.

#include <array>
#include <cstdlib>
#include <random>

#include "field.hpp"
#include "robot/safety/fence_guard.hpp"

namespace roverd::robot {
namespace {

using base::Mode;
using std::chrono::milliseconds;

constexpr int kSteps = 20'000;  // of a seed: 400 s
constexpr double kYard_m = 12.0;

class Chance {
 public:
  explicit Chance(unsigned seed) : engine_(seed) {}
  bool of(double p) { return std::uniform_real_distribution<>(0.0, 1.0)(engine_) < p; }
  double between(double a, double b) { return std::uniform_real_distribution<>(a, b)(engine_); }
  int below(int n) { return std::uniform_int_distribution<>(0, n - 1)(engine_); }

 private:
  std::mt19937 engine_;
};

/// A hand on a stick, as it looks from outside.
struct StickHand {
  enum class Does { Nothing, Free, Pushes } does = Does::Nothing;
  base::BodyTwist twist;
  Time said{};   ///< its last push
  Time freed{};  ///< last heard with sticks in the middle and dead-man off
};

class Walker : public Field {
 public:
  explicit Walker(unsigned seed) : chance_(seed), seed_(seed) {
    run(8.0);
    lay_yard();
    const auto loaded = load(plan_of({{0, 6}, {6, 6}, {6, -6}}));
    EXPECT_TRUE(loaded) << loaded.error().detail;
    look();
  }

  void walk(int steps) {
    for (int i = 0; i < steps && violations.empty(); ++i) {
      if (chance_.of(0.02)) ask_something();
      if (chance_.of(0.004)) break_something();
      if (chance_.of(0.01)) mend_everything();
      for (std::size_t k = 0; k < hands_.size(); ++k) use(k, i);
      tick();
      judge(i);
    }
  }

  std::vector<std::string> violations;
  long by_itself = 0;  ///< ticks of motion
  long by_hand = 0;
  long by_radio = 0;

 private:
  void lay_yard() {
    auto yard = std::make_shared<mission::Fence>();
    yard->name = "yard";
    mission::FencePolygon p;
    for (const base::EnuPoint c :
         {base::EnuPoint{-kYard_m, -kYard_m}, base::EnuPoint{kYard_m, -kYard_m},
          base::EnuPoint{kYard_m, kYard_m}, base::EnuPoint{-kYard_m, kYard_m}}) {
      p.points.push_back(kFrame.to_global(c));
    }
    yard->areas.push_back({mission::AreaKind::Inclusion, p});
    EXPECT_TRUE(ask(SetFence{robot.lay_fence(yard)}));
  }

  // ---- what comes from outside ----

  void request(Command asked, bool word) {
    robot.request(std::move(asked), now + milliseconds(500), [this, word](base::Result<void> r) {
      if (r && word) word_ = now;
    });
  }

  void ask_something() {
    const base::EnuPoint to{chance_.between(-14, 14), chance_.between(-14, 14)};
    GoTo goal;
    goal.at = kFrame.to_global(to);
    MoveBy move;
    move.forward_m = chance_.between(-3, 3);
    MoveBy turn;
    turn.turn_rad = chance_.between(-3, 3);
    static constexpr Mode kAsked[] = {Mode::Manual,   Mode::Manual, Mode::Hold,     Mode::Auto,
                                      Mode::Guided,   Mode::Rtl,    Mode::SmartRtl, Mode::Acro,
                                      Mode::Steering, Mode::Simple};
    switch (chance_.below(20)) {
      case 0:
      case 1:
      case 2:
      case 3:
        return request(Arm{}, false);
      case 4:
        return request(Disarm{}, false);
      case 5:
        return request(Estop{"the walker"}, false);
      case 6:
      case 7:
      case 8:
        return request(ResetEstop{}, false);
      case 9:
      case 10:
      case 11:
        return request(SetMode{kAsked[chance_.below(std::size(kAsked))]}, true);
      case 12:
      case 13:
        return request(StartMission{"m", 1}, true);
      case 14:
        return request(PauseMission{}, false);
      case 15:
        return request(ResumeMission{}, true);
      case 16:
        return request(ResumeActivity{}, true);
      case 17:
        return request(chance_.of(0.2) ? Command(StopMission{}) : Command(SkipItem{}), true);
      case 18:
        return request(goal, true);
      default:
        return request(chance_.of(0.5) ? move : turn, true);
    }
  }

  void break_something() {
    switch (chance_.below(12)) {
      case 0:
        base_speaks = false;
        break;
      case 1:
        radio_speaks = false;
        break;
      case 2:
        radio_counts = false;
        break;
      case 3:
        gnss_speaks = false;
        break;
      case 4:
        fix = base::FixType::None;
        break;
      case 5:
      case 6:
        swb = base::Switch::Down;
        break;
      case 7:
        control_mode = chance_.of(0.5) ? base::ControlMode::Standby : base::ControlMode::Radio;
        break;
      case 8:
        vehicle_state = chance_.of(0.5) ? base::VehicleState::Estop : base::VehicleState::Exception;
        break;
      case 9:
        radio_lost = true;
        break;
      case 10:
        obeys = false;
        does = {};
        break;
      default:
        charge_pct = chance_.between(0, 30);
        break;
    }
  }

  void mend_everything() {
    base_speaks = radio_speaks = radio_counts = gnss_speaks = obeys = true;
    fix = base::FixType::RtkFixed;
    swb = base::Switch::Up;
    control_mode = base::ControlMode::Can;
    vehicle_state = base::VehicleState::Normal;
    radio_lost = false;
    charge_pct = 80.0;
  }

  void use(std::size_t k, int i) {
    StickHand& hand = hands_[k];
    if (chance_.of(0.01)) {
      static constexpr StickHand::Does kDoes[] = {StickHand::Does::Nothing, StickHand::Does::Free,
                                                  StickHand::Does::Free, StickHand::Does::Pushes,
                                                  StickHand::Does::Pushes};
      hand.does = kDoes[chance_.below(std::size(kDoes))];
      hand.twist = {chance_.between(-1.2, 1.2), chance_.between(-1, 1)};
    }
    if (i % 5 != 0 || hand.does == StickHand::Does::Nothing) return;
    const bool pushes = hand.does == StickHand::Does::Pushes;
    const Drive drive{pushes ? hand.twist : base::BodyTwist{}, pushes, k + 1, now};
    robot.request(drive, now + milliseconds(250), {});
    (pushes ? hand.said : hand.freed) = now;
  }

  // ---- what must hold ----

  void look() { seen_ = robot.snapshot(); }

  void judge(int i) {
    const auto before = seen_;
    look();
    const base::Snapshot& s = *seen_;
    if (s.mode != before->mode || s.armed != before->armed || s.estop != before->estop ||
        s.control == base::Driver::Radio) {
      began_ = now;
    }
    // What stands in HOLD, and what the radio interrupted but a mission, waits for a word.
    const bool waits = s.mode == Mode::Hold || !s.armed || s.estop ||
                       (s.control == base::Driver::Radio && s.mode != Mode::Auto);
    const bool may = word_ && (!waited_ || *word_ >= *waited_);
    if (waits) waited_ = now;

    radio_since_ = swb != base::Switch::Up && radio_speaks && base_speaks ? radio_since_ + 1 : 0;
    const auto want = [&](bool holds, const char* what) {
      if (holds) return;
      violations.push_back("seed " + std::to_string(seed_) + " step " + std::to_string(i) + ": " +
                           what + ", mode " + std::string(base::to_string(s.mode)));
    };
    want(s.armed || !command.enabled, "disarmed, and told that it may move");
    if (s.control == base::Driver::Radio) ++by_radio;
    const double off_m = std::max(std::abs(at.east_m), std::abs(at.north_m));
    want(off_m <= kYard_m, "it has left the fence");
    if (!moves()) return;
    want(s.armed, "it moves disarmed");
    want(!s.estop, "it moves with the emergency stop latched");
    want(radio_since_ < 2, "it moves while the radio drives");
    const double silent_s = base::seconds(now - heard_);
    want(silent_s <= 0.45, "it moves though the base is silent");
    if (s.control == base::Driver::Teleop) {
      ++by_hand;
      bool held = false;
      for (const StickHand& hand : hands_) {
        held = held || (base::seconds(now - hand.said) <= 0.52 && hand.freed >= began_ &&
                        hand.said > hand.freed);
      }
      want(held, "nobody holds a stick that was let go before");
    } else {
      ++by_itself;
      want(s.control == base::Driver::Autonomy, "it moves, and nobody drives");
      want(may, "it drives by itself, and nobody gave the word");
    }
  }

 public:
  void tick() {
    if (base_speaks) heard_ = now + milliseconds(20);
    Field::tick();
  }

 private:
  Chance chance_;
  unsigned seed_;
  std::array<StickHand, 2> hands_;
  std::shared_ptr<const base::Snapshot> seen_;
  std::optional<Time> word_;    ///< the last one that the robot took
  std::optional<Time> waited_;  ///< for one
  Time began_{};
  Time heard_{};
  int radio_since_ = 0;
};

TEST(Walker, WhateverComesNothingMovesThatMustNot) {
  const char* asked = std::getenv("WALK_SEEDS");
  const int seeds = asked != nullptr ? std::atoi(asked) : 20;
  long by_itself = 0;
  long by_hand = 0;
  long by_radio = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    Walker walker(static_cast<unsigned>(seed));
    walker.walk(kSteps);
    for (const std::string& v : walker.violations) ADD_FAILURE() << v;
    by_itself += walker.by_itself;
    by_hand += walker.by_hand;
    by_radio += walker.by_radio;
  }
  std::printf("%d seeds of %d steps: %ld moved by themselves, %ld by hand, %ld under the radio\n",
              seeds, kSteps, by_itself, by_hand, by_radio);
  // It was somewhere.
  EXPECT_GT(by_itself, 500L * seeds);
  EXPECT_GT(by_hand, 150L * seeds);
  EXPECT_GT(by_radio, 200L * seeds);
}

}  // namespace
}  // namespace roverd::robot
