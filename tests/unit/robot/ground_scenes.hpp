#pragma once
// Scenes of the ground, of starts beside the way and of other people's points; see scenes.hpp.

#include <string>
#include <utility>
#include <vector>

#include "failsafe_scenes.hpp"

namespace roverd::robot {

/// From now on it leans so.
inline void lean(Walk& w, double roll_rad, double pitch_rad) {
  w.more = [&w, roll_rad, pitch_rad] {
    w.robot.measurements().put(base::Attitude{w.now, roll_rad, pitch_rad});
  };
}

inline const std::vector<Scene> kGroundScenes = {
    {"downhill",
     [](Walk& w) {
       lean(w, 0.05, -0.17);
       w.run(8.0);
       w.go(plan_of({{0, 6}, {5, 6}}));
       w.run(1.0);
       w.change();
       w.run(25.0);
     }},
    {"a turn on the spot where it is steep",
     [](Walk& w) {
       lean(w, 0.30, 0.02);
       w.run(8.0);
       w.go(plan_of({{0, 4}, {4, 4}, {4, 8}}));
       w.run(1.0);
       w.change();
       w.run(40.0);
     },
     [](Config& c) {
       c.safety.tilt_stop_deg = 40.0;
       c.safety.tilt_warn_deg = 39.0;
     }},
    {"a start beside the way",
     [](Walk& w) {
       w.run(8.0);
       w.change();
       w.go(plan_of({{0.4, -1.5}, {0.4, 12}, {6, 12}}));
       w.run(10.0);
     }},
    {"a start with a plain receiver",
     [](Walk& w) {
       w.fix = base::FixType::Single;
       w.fix_sigma_m = 0.6;
       w.run(8.0);
       w.change();
       w.go(plan_of({{0.4, -1.5}, {0.4, 12}, {6, 12}}));
       w.run(10.0);
     }},
    {"a trailer",
     [](Walk& w) {
       w.run(8.0);
       w.change();
       w.go(plan_of({{0, 4}, {6, 8}, {12, 8}}));
       w.run(15.0);
     },
     [](Config& c) { c.tool.trailer_m = 1.0; }},
    {"dense points",
     [](Walk& w) {
       w.run(8.0);
       w.change();
       std::vector<base::EnuPoint> points{{0, 2}};
       for (int i = 1; i < 30; ++i) points.push_back({i % 2 == 0 ? 0.03 : -0.03, 2.0 + 0.3 * i});
       w.go(plan_of(points));
       w.run(12.0);
     }},
    {"stuck, and turned slowly",
     [](Walk& w) {
       w.run(8.0);
       w.go(plan_of({{0, 6}, {4, 6}}));
       w.run(3.0);
       w.change();
       w.obeys = false;
       w.does = {0.0, 0.012};
       w.run(45.0);
     },
     [](Config& c) { c.safety.follow_timeout_s = 100.0; }},
    {"set anew twice",
     [](Walk& w) {
       w.fix = base::FixType::RtkFloat;
       w.fix_sigma_m = 0.1;
       w.run(8.0);
       w.go(plan_of({{0, 20}, {0, 60}}));
       w.run(14.0);  // or its positions are not proved
       w.change();
       w.receiver_off = {0.8, 0.0};
       w.run(16.0);
       (void)w.ask(ResumeMission{});
       w.run(17.0);
       w.receiver_off = {1.6, 0.0};
       w.run(18.0);
     }},
    {"strong currents turn the compass",
     [](Walk& w) {
       w.more = [&w] {
         const double a = 2.0 + 9.0 * std::abs(w.command.twist.linear_mps);
         w.robot.measurements().put(base::MotorState{w.now, 1, {}, a, {}, {}, {}, {}, {}});
         w.robot.measurements().put(base::MotorState{w.now, 2, {}, 0.2 * a, {}, {}, {}, {}, {}});
       };
       w.run(8.0);
       (void)w.ask(Arm{});
       w.change();
       (void)w.ask(SetMode{Mode::Manual});
       for (int i = 0; i < 4; ++i) {
         w.stick(0.9, 0.3, 2.0);
         w.stick(0.2, -0.3, 2.0);
       }
     },
     [](Config& c) {
       c.estimate.compass_left_deg_per_a = 2.0;
       c.estimate.compass_right_deg_per_a = -2.0;
       c.estimate.compass_current_sigma_deg_per_a = 0.5;
     }},
};

}  // namespace roverd::robot
