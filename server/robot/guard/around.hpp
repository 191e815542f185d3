#pragma once
// A way around what stands before a mission: what the control thread asks, and what another thread
// answers, which may take its time.
//
//   control ──AroundQuestion──▶ Robot::around_questions() ─▶ answer_around() ─▶
//   Robot::around_answers() ──▶ control
//
// Both are immutable once handed over.

#include <cstdint>
#include <memory>
#include <string>

#include "base/geo.hpp"
#include "nav/around/around.hpp"
#include "nav/sense/odometry.hpp"
#include "robot/guard/surroundings.hpp"

namespace roverd::robot {

struct LaidFence;

struct AroundQuestion {
  std::uint64_t id = 0;
  std::shared_ptr<const Surroundings> around;
  nav::around::Question question;          ///< but for the fence
  std::shared_ptr<const LaidFence> fence;  ///< null: none
  base::LocalFrame frame{1, {}};           ///< the robot's, L
  nav::sense::Pose2 local;                 ///< X_OL at the moment of the question
  double from_m = 0.0;                     ///< arc length of the way at the question's first point
  std::uint64_t way_id = 0;                ///< nav::Executor::way_id
  std::uint64_t fence_id = 0;              ///< 0: no fence
  int item = 0;                            ///< that the route's end must be come to for; 0: none
};

struct AroundAnswer {
  std::shared_ptr<const AroundQuestion> asked;  ///< without `around` and `fence`
  nav::around::Answer found;
  bool before_holds = false;  ///< what is being driven (Question::before) is free as it was
  std::string refused;        ///< why the question was none; empty: it was
};

/// X_LB as a pose in the odometry's frame, and back.
nav::sense::Pose2 to_odometry(const nav::sense::Pose2& local, base::EnuPoint at,
                              double yaw_rad) noexcept;

/// Any thread; as long as nav::around::Planner::plan takes.
std::shared_ptr<const AroundAnswer> answer_around(nav::around::Planner& planner,
                                                  std::shared_ptr<const AroundQuestion> asked);

}  // namespace roverd::robot
