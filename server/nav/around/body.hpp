#pragma once
// May the body stand here? Asked some hundred thousand times a question, so in three steps: one
// circle about everything, a row of circles that cover the body, and where one of these says no,
// points along the outline in it.
//
// Between two points, and between two poses of a sweep, something could come nearer than both say:
// as both lie at most kApart_m from what was looked at, by Pythagoras the distance asked for grows.

#include <cmath>
#include <cstddef>
#include <vector>

#include "nav/around/field.hpp"

namespace roverd::nav::around {

/// A pose with its heading as a direction.
struct Stand {
  double x_m = 0.0;
  double y_m = 0.0;
  double cos = 1.0;
  double sin = 0.0;

  explicit Stand(const Pose2& pose) noexcept
      : x_m(pose.x_m), y_m(pose.y_m), cos(std::cos(pose.yaw_rad)), sin(std::sin(pose.yaw_rad)) {}
};

class Body {
 public:
  static constexpr double kApart_m = 0.05;

  /// @param field laid and priced
  void set(const sense::Footprint& shape, double least_m, const Field& field);
  /// Where the robot stands it may stand, and about there come no nearer to anything than it is;
  /// turn on the spot there by 3 cm nearer than least_m: it has stopped before something.
  void allow_start(const Pose2& start);

  /// @param as_at_start with what allow_start allows
  bool fits(const Stand& at, bool as_at_start = true) const noexcept;
  bool fits(const Pose2& pose) const noexcept { return fits(Stand{pose}); }
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
  /// Of a row of points, from `first` on, `last` left out.
  struct Run {
    std::size_t first = 0;
    std::size_t last = 0;
  };
  /// The whole body as points.
  struct Points {
    double apart_m = 0.0;
    std::vector<Vec2> outline;  ///< in order
    std::vector<Vec2> inner;    ///< what is small and stands wholly inside is met by these,
    float inner_m = 0.0F;       ///< if it comes so near
  };
  struct Circle {
    Vec2 at;
    float radius_m = 0.0F;
    /// What of the points lies in it.
    struct Part {
      std::vector<Run> outline;
      std::vector<Vec2> inner;
    };
    Part coarse;
    Part dense;
  };
  static void lay(const sense::Footprint& shape, double apart_m, double inner_apart_m, Points& out);
  void cover(const sense::Footprint& shape);
  Circle circle_of(const sense::Footprint& shape, double from, double to) const;
  bool circle_fits(const Stand& at, const Circle& circle, bool borders) const noexcept;
  bool stands(const Stand& at, bool borders) const noexcept;
  bool stands_as_at_start(const Stand& at, bool turns) const noexcept;
  bool part_fits(const Stand& at, const Points& points, const Circle::Part& part, float clear,
                 float room) const noexcept;

  const Field* field_ = nullptr;
  Circle about_;
  std::vector<Circle> cover_;
  Points coarse_;  ///< 2 kApart_m apart
  Points dense_;   ///< a fifth of that, for what is near at the start
  double inner_m_ = 0.0;
  float least_m_ = 0.0F;  ///< from any point of the body to the middle of what stands there
  float sample_m_ = 0.0F;
  float dense_m_ = 0.0F;  ///< as least_m_ for the dense points
  Pose2 start_;
  bool allowed_ = false;
  float start_clear_m_ = 0.0F;
  float start_room_m_ = 0.0F;
};

}  // namespace roverd::nav::around
