#pragma once
// The route ahead: what of it is blocked, and where behind that it may be joined.

#include <span>
#include <vector>

#include "nav/around/body.hpp"
#include "nav/around/search.hpp"

namespace roverd::nav::around {

class Ahead {
 public:
  void look(const Question& q, const Lane& lane, const Field& field, const Body& body);

  /// The robot is on the route, and nothing stands on it as far as the window goes.
  bool clear() const noexcept { return clear_; }
  /// It is blocked up to its very end, where the mission wants to stand.
  bool target_lost() const noexcept { return lost_; }
  double blocked_from_m() const noexcept { return from_m_; }
  double blocked_to_m() const noexcept { return to_m_; }
  /// How far the window reaches along the route.
  double end_m() const noexcept { return end_m_; }
  /// That is the route's end.
  bool ends() const noexcept { return ends_; }
  void give_up_targets() noexcept { targets_.clear(); }
  std::span<const Target> targets() const noexcept { return targets_; }

 private:
  void find_blocked(const Question& q, const Lane& lane, const Body& body);

  bool clear_ = false;
  bool lost_ = false;
  bool ends_ = false;
  double from_m_ = 0.0;
  double to_m_ = 0.0;
  double end_m_ = 0.0;
  std::vector<Target> targets_;
};

}  // namespace roverd::nav::around
