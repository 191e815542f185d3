#pragma once
// A scene, and those in which a failsafe sees something.

#include <vector>

#include "walk.hpp"

namespace roverd::robot {

struct Scene {
  const char* name;
  void (*play)(Walk&);
  void (*prepare)(Config&) = [](Config&) {};
};

inline std::vector<Scene> joined(std::vector<Scene> some, const std::vector<Scene>& more) {
  some.insert(some.end(), more.begin(), more.end());
  return some;
}

inline const std::vector<Scene> kFailsafeScenes = {
    {"every operator goes away",
     [](Walk& w) {
       w.robot.measurements().put(base::OperatorLink{w.now, 1});
       w.run(8.0);
       w.go(plan_of({{0, 30}}));
       w.run(1.0);
       w.robot.measurements().put(base::OperatorLink{w.now, 1});
       w.change();
       w.run(15.0);
     },
     [](Config& c) { c.safety.link_lost = "hold"; }},
    {"a slope",
     [](Walk& w) {
       w.more = [&w] { w.robot.measurements().put(base::Attitude{w.now, 0.45, 0.45}); };
       w.run(8.0);
       w.change();
       (void)w.ask(Arm{});
       (void)w.ask(SetMode{Mode::Manual});
       w.stick(0.5, 0.0, 2.0);
     }},
    {"a driver falls and gets up",
     [](Walk& w) {
       w.run(8.0);
       w.change();
       for (int i = 0; i < 4; ++i) {
         base::DriverStatus d;
         d.name = "gnss";
         for (const auto phase : {base::DriverPhase::Up, base::DriverPhase::Faulty}) {
           d.stamp = w.now;
           d.phase = phase;
           w.robot.measurements().put(d);
           w.run(0.5);
         }
       }
     }},
    {"far from home with little charge",
     [](Walk& w) {
       w.charge_pct = 80.0;
       w.run(8.0);
       w.more = [&w] { w.robot.measurements().put(base::BaseMotion{w.now, {60.0, 0.0}}); };
       w.run(4.0);
       w.charge_pct = 70.0;
       w.run(0.2);
       w.more = nullptr;
       w.run(8.0);
       w.go(plan_of({{0, 30}}));
       w.run(6.0);
       w.change();
       w.charge_pct = 8.0;
       w.run(6.0);
     }},
    {"a hand on the speed falls silent",
     [](Walk& w) {
       w.run(8.0);
       w.go(plan_of({{0, 30}}));
       w.run(1.0);
       for (int i = 0; i < 20; ++i) {
         if (i == 10) w.change();
         w.robot.request(Throttle{1.0, true}, w.now + std::chrono::milliseconds(250), {});
         w.run(0.1);
       }
       w.run(3.0);
     }},
};

}  // namespace roverd::robot
