#pragma once
// Scenes of a robot that drives past landmarks: what their parameters may change shows in one of
// them.

#include <vector>

#include "wall_scenes.hpp"

namespace roverd::robot {

inline mission::Plan some_landmarks() {
  mission::Plan plan;
  plan.name = "landmarks";
  mission::Landmarks landmarks;
  landmarks.name = mission::kAnyLandmark;
  landmarks.side = mission::Side::Left;
  plan.items.emplace_back(landmarks);
  return plan;
}

inline const std::vector<Scene> kLandmarkScenes = {
    {"past poles, a thick one and a pair among them",
     [](Walk& w) {
       const auto poles = look_along_walls(w, {});
       poles->posts = {{2.5, 0.7, 0.1}, {5.0, 0.9, 0.08}, {7.0, 0.6, 0.4},
                       {9.0, 0.7, 0.1}, {9.0, 1.4, 0.1},  {12.0, 0.9, 0.1}};
       w.run(8.0);
       w.go(some_landmarks());
       w.run(2.0);
       w.change();
       w.run(26.0);
     },
     creep_beside_walls},
    {"past poles, one of them carried away, beside something thin",
     [](Walk& w) {
       const auto poles = look_along_walls(w, {{14.0, -4.0, 14.0, 4.0}});
       poles->posts = {{2.5, 0.7, 0.1}, {4.0, 0.75, 0.016}, {8.0, 0.7, 0.1}};
       w.run(8.0);
       w.go(some_landmarks());
       w.run(4.0);
       w.change();
       w.run(2.0);
       poles->posts.pop_back();
       w.run(12.0);
     },
     creep_beside_walls},
    {"past poles that stand now nearer, now farther",
     [](Walk& w) {
       const auto poles = look_along_walls(w, {});
       poles->posts = {{2.5, 0.7, 0.1}, {5.0, 1.5, 0.1}, {7.5, 0.6, 0.1}, {10.0, 1.5, 0.1}};
       w.run(8.0);
       w.go(some_landmarks());
       w.run(2.0);
       w.change();
       w.run(20.0);
     },
     creep_beside_walls},
};

}  // namespace roverd::robot
