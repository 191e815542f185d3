#pragma once
// May the body stand here? Asked some hundred thousand times a question, so in three steps: one
// circle about everything, a row of circles that cover the body, and where these say no, points
// along its outline.
//
// Between two points, and between two poses of a sweep, something could come nearer than both say:
// as both lie at most kApart_m from what was looked at, by Pythagoras the distance asked for grows.

#include <vector>

#include "nav/around/field.hpp"

namespace roverd::nav::around {

class Body {
 public:
  static constexpr double kApart_m = 0.05;

  /// @param field laid and priced
  void set(const sense::Footprint& shape, double least_m, const Field& field);
  /// Where the robot stands it may stand, and about there come no nearer to anything.
  void allow_start(const Pose2& start);

  bool fits(const Pose2& pose) const noexcept;
  /// Of what stands there only, without borders and the allowance of the start.
  bool clears(const Pose2& pose) const noexcept;
  /// Something stands within the outline.
  static bool touches(const sense::Patch& patch, const sense::Footprint& shape, const Pose2& pose);
  double inner_m() const noexcept { return inner_m_; }
  /// What the outline keeps to the middle of what stands there, if asked about any cell's middle.
  double least_m() const noexcept {
    return static_cast<double>(sample_m_) - 0.7072 * field_->cell_m();
  }

 private:
  struct Circle {
    Vec2 at;
    float radius_m = 0.0F;
  };
  bool circles_fit(const Pose2& pose, double c, double s, bool borders) const noexcept;

  bool all_clear(const Pose2& pose, const std::vector<Vec2>& points, float clear,
                 float room) const noexcept;

  const Field* field_ = nullptr;
  std::vector<Circle> cover_;
  std::vector<Vec2> outline_;  ///< 2 kApart_m apart
  std::vector<Vec2> dense_;    ///< a fifth of that, for what is near at the start
  std::vector<Vec2> inner_;    ///< within: what is small and stands wholly inside is met by these
  std::vector<Vec2> dense_inner_;
  Circle about_;
  double inner_m_ = 0.0;
  double reach_m_ = 0.0;
  float least_m_ = 0.0F;  ///< from any point of the body to the middle of what stands there
  float sample_m_ = 0.0F;
  Pose2 start_;
  bool allowed_ = false;
  float start_clear_m_ = 0.0F;
  float start_room_m_ = 0.0F;
};

}  // namespace roverd::nav::around
