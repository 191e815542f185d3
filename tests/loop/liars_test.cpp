// One sensor lies: the robot notices, says which one it is, and by its true pose it never leaves
// the fence, goes no farther beyond the lie than stated, and does not claim what it does not know.
//
//   ┌───────·──────┐   straight at the fence, along a path with corners, round on a circle; the
//   │       ▲      │   lie begins on the way, and stays
//   └───────┼──────┘

#include "rig.hpp"

namespace roverd::loop {
namespace {

enum class Way { Straight, Corners, Circle };

struct Lie {
  const char* name;
  void (*tell)(sim::Faults&);
  std::optional<base::Sense> named;  ///< who is found to lie; empty: nobody has to be
  double honest_after_s = 3.0;       ///< from then on no claim is better than the truth
  double beyond_m = 12.0;            ///< driven after the lie began, unless it arrives
  /// Beside its way. A gyro's lie is followed until it is more than a slope and its own bias may
  /// explain, 15 deg and more: at 1 m/s two metres.
  double astray_m = 1.0;
  bool stops = false;     ///< it may not go on
  bool antennas = false;  ///< the robot has two of them
};

void PrintTo(const Lie& lie, std::ostream* out) {
  *out << lie.name;
}

using base::Sense;

const Lie kLies[] = {
    {"position_frozen", [](sim::Faults& f) { f.gnss_position_frozen = true; }, Sense::Position, 3.0,
     12.0, 1.0, true},
    {"same_bytes_again", [](sim::Faults& f) { f.gnss_repeats = true; }, Sense::Position, 3.0, 12.0,
     1.0, true},
    {"velocity_frozen", [](sim::Faults& f) { f.gnss_velocity_frozen = true; }, {}},
    {"velocity_aside", [](sim::Faults& f) { f.gnss_velocity_east_mps = 0.4; }, Sense::Velocity},
    {"velocity_ahead", [](sim::Faults& f) { f.gnss_velocity_north_mps = 0.5; }, Sense::Velocity},
    {"gyro_20_dps", [](sim::Faults& f) { f.imu_gyro_extra_dps = 20.0; }, Sense::Gyro, 3.0, 12.0,
     1.5},
    {"gyro_2_dps", [](sim::Faults& f) { f.imu_gyro_extra_dps = 2.0; }, {}, 3.0, 12.0, 2.0},
    {"gyro_minus_5_dps", [](sim::Faults& f) { f.imu_gyro_extra_dps = -5.0; }, Sense::Gyro, 3.0,
     12.0, 2.0},
    {"gyro_ramp", [](sim::Faults& f) { f.imu_gyro_ramp_dps2 = 0.1; }, {}, 3.0, 12.0, 2.0},
    {"gyro_frozen", [](sim::Faults& f) { f.imu_gyro_frozen = true; }, {}},
    {"tracks_double", [](sim::Faults& f) { f.odometry_share = 2.0; }, Sense::Tracks, 3.0, 6.0, 1.0,
     true},
    {"tracks_half", [](sim::Faults& f) { f.odometry_share = 0.45; }, {}, 3.0, 3.0, 1.0, true},
    {"one_track_stuck",
     [](sim::Faults& f) { f.odometry_left_stuck = true; },
     {},
     3.0,
     3.0,
     1.0,
     true},
    {"counter_frozen", [](sim::Faults& f) { f.odometry_frozen = true; }, Sense::Tracks, 3.0, 3.0,
     1.0, true},
    {"antennas_offset", [](sim::Faults& f) { f.antennas_extra_deg = 30.0; }, Sense::Antennas, 3.0,
     12.0, 1.0, false, true},
    {"antennas_frozen",
     [](sim::Faults& f) { f.antennas_frozen = true; },
     {},
     3.0,
     12.0,
     1.0,
     false,
     true},
    {"compass_jump", [](sim::Faults& f) { f.compass_extra_deg = 70.0; }, Sense::Compass},
    {"compass_frozen", [](sim::Faults& f) { f.compass_frozen = true; }, {}},
    {"position_jump", [](sim::Faults& f) { f.gnss_jump_north_m = -6.0; }, Sense::Position, 3.0,
     12.0, 1.0, true},
    {"position_jump_aside", [](sim::Faults& f) { f.gnss_jump_east_m = 2.0; }, Sense::Position, 3.0,
     12.0, 1.0, true},
    {"position_drifts_back", [](sim::Faults& f) { f.gnss_drift_north_mps = -0.3; }, Sense::Position,
     3.0, 12.0, 1.0, true},
    {"position_drifts_aside", [](sim::Faults& f) { f.gnss_drift_east_mps = 0.2; }, Sense::Position,
     3.0, 12.0, 0.6, true},
    {"position_drifts_slowly",
     [](sim::Faults& f) { f.gnss_drift_north_mps = -0.1; },
     {},
     4.0,
     12.0,
     0.5,
     true},
    {"position_creeps_away",
     [](sim::Faults& f) { f.gnss_drift_east_mps = 0.07; },
     {},
     6.0,
     12.0,
     0.5,
     true},
};

struct Seen {
  double clear_m = 1e9;   ///< of the outermost corner of the body, inside the fence
  double beyond_m = 0.0;  ///< driven since the lie began
  double astray_m = 0.0;
  double dishonest_s = 0.0;  ///< longest time of a claim better than the truth
  double worst_m = 0.0;      ///< error of the position while that was claimed
  double named_s = -1.0;     ///< until the first accusation
  std::string who;
  bool arrived = false;
  bool stands = false;
  double off_goal_m = 0.0;
};

class Trial {
 public:
  Trial(const Lie& lie, Way way, double speed_mps, std::uint64_t seed) : lie_(lie), way_(way) {
    RigOptions o;
    o.seed = seed;
    if (lie.antennas) {
      o.plant.gnss.antennas = true;
      o.gnss.heading_source = "dual_antenna";
    }
    body_ = o.robot.vehicle;
    rig_ = std::make_unique<Rig>(o);
    points_ = points(way);
    half_m_ = way == Way::Straight ? 21.8 : 16.0;
    rig_->arm();
    fence();
    rig_->load(rig_->plan_of(points_, speed_mps));
    rig_->start();
    points_.insert(points_.begin(), Metres{0, 0});
  }

  Seen run() {
    Seen seen;
    const double from_m = way_ == Way::Circle ? 8.0 : 7.0;
    if (!rig_->run_until([&] { return rig_->truth().driven_m > from_m; }, 120.0)) {
      ADD_FAILURE() << "it did not get there: " << rig_->state()->mission.reason;
      return seen;
    }
    const double began_m = rig_->truth().driven_m;
    const double began_s = rig_->now_s();
    rig_->fault(lie_.tell);
    double dishonest_since = -1.0;
    for (int i = 0; i < 60 * 50; ++i) {
      rig_->tick();
      const auto s = rig_->state();
      const double off_m = rig_->position_error_m();
      const double claim_m = 3.0 * s->pose->horizontal_sigma_m + 0.15;
      if (off_m <= claim_m) {
        dishonest_since = -1.0;
      } else {
        if (dishonest_since < 0.0) dishonest_since = rig_->now_s();
        seen.dishonest_s = std::max(seen.dishonest_s, rig_->now_s() - dishonest_since);
        seen.worst_m = std::max(seen.worst_m, off_m);
      }
      const auto& votes = s->estimator.votes;
      if (seen.named_s < 0.0 && votes.accusations > 0) {
        seen.named_s = rig_->now_s() - began_s;
        for (std::size_t k = 0; k < base::kSenses; ++k) {
          if (votes.of[k].left_out) seen.who += base::to_string(static_cast<Sense>(k));
        }
        if (votes.undecided) seen.who += "undecided";
      }
      seen.clear_m = std::min(seen.clear_m, clear_m());
      seen.astray_m = std::max(seen.astray_m, astray_m());
      if (rig_->execution() == ExecutionState::Finished) seen.arrived = true;
    }
    seen.beyond_m = rig_->truth().driven_m - began_m;
    seen.stands = rig_->stands();
    seen.off_goal_m = rig_->distance_to_m(points_.back());
    return seen;
  }

  const Rig& rig() const { return *rig_; }

 private:
  static std::vector<Metres> points(Way way) {
    if (way == Way::Straight) return {{0, 20}};
    if (way == Way::Corners) return {{0, 10}, {10, 10}, {10, -5}, {-5, -5}};
    std::vector<Metres> all;
    for (int i = 1; i <= 32; ++i) {
      const double a = base::kPi * i / 16.0;
      all.push_back({8.0 * (1.0 - std::cos(a)), 8.0 * std::sin(a)});
    }
    return all;
  }

  double to_fence(double east_m, double north_m) const {
    const double centre = way_ == Way::Circle ? 8.0 : 0.0;
    const double half = way_ == Way::Circle ? 9.6 : half_m_;
    return half - std::max(std::abs(east_m - centre), std::abs(north_m));
  }

  void fence() {
    auto fence = std::make_shared<mission::Fence>();
    fence->name = "yard";
    const double centre = way_ == Way::Circle ? 8.0 : 0.0;
    const double half = way_ == Way::Circle ? 9.6 : half_m_;
    mission::FencePolygon p;
    for (const Metres m : {Metres{centre - half, -half}, Metres{centre + half, -half},
                           Metres{centre + half, half}, Metres{centre - half, half}}) {
      p.points.push_back(rig_->place(m));
    }
    fence->areas.push_back({mission::AreaKind::Inclusion, p});
    ASSERT_TRUE(rig_->ask(robot::SetFence{rig_->robot.lay_fence(std::move(fence))}));
  }

  double clear_m() const {
    const sim::Truth t = rig_->truth();
    double least = 1e9;
    for (const double x : {0.5 * body_.length_m, -0.5 * body_.length_m}) {
      for (const double y : {0.5 * body_.width_m, -0.5 * body_.width_m}) {
        least = std::min(
            least, to_fence(t.local.east_m + x * std::cos(t.yaw_rad) - y * std::sin(t.yaw_rad),
                            t.local.north_m + x * std::sin(t.yaw_rad) + y * std::cos(t.yaw_rad)));
      }
    }
    return least;
  }

  double astray_m() const {
    const auto p = rig_->truth().local;
    double best = 1e9;
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
      best = std::min(best, RigBase::to_segment(p, points_[i], points_[i + 1]));
    }
    return best;
  }

  const Lie& lie_;
  Way way_;
  nav::VehicleParams body_;
  std::vector<Metres> points_;
  double half_m_ = 0.0;
  std::unique_ptr<Rig> rig_;
};

class Liars : public testing::TestWithParam<Lie> {};
INSTANTIATE_TEST_SUITE_P(Loop, Liars, testing::ValuesIn(kLies),
                         [](const auto& lie) { return std::string(lie.param.name); });

TEST_P(Liars, AreFoundOutBeforeTheFenceAndNothingIsClaimedThatIsNotKnown) {
  const Lie& lie = GetParam();
  for (const Way way : {Way::Straight, Way::Corners, Way::Circle}) {
    for (const double speed_mps : {0.5, 1.0}) {
      Trial trial(lie, way, speed_mps, 1);
      const Seen s = trial.run();
      const std::string where = std::string(way == Way::Straight  ? "straight"
                                            : way == Way::Corners ? "corners"
                                                                  : "circle") +
                                " at " + std::to_string(speed_mps);
      EXPECT_GT(s.clear_m, 0.0) << where;
      EXPECT_LE(s.dishonest_s, lie.honest_after_s) << where << ", " << s.worst_m << " m";
      EXPECT_LE(s.astray_m, lie.astray_m) << where;
      if (lie.stops) {
        EXPECT_TRUE(s.stands) << where;
        EXPECT_LE(s.beyond_m, lie.beyond_m) << where;
      }
      if (lie.named && !s.who.empty()) {
        EXPECT_TRUE(s.who == base::to_string(*lie.named) || s.who == "undecided")
            << where << ": " << s.who;
      }
      if (s.arrived) {
        EXPECT_LT(s.off_goal_m, 0.5) << where;
      }
    }
  }
}

}  // namespace
}  // namespace roverd::loop
