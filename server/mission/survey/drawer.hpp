#pragma once
// The path of a survey, drawn piece by piece; each piece is joined to the one before without
// leaving the area.

#include <optional>
#include <vector>

#include "mission/survey/survey.hpp"
#include "mission/survey/turns.hpp"
#include "mission/survey/ways.hpp"

namespace roverd::mission::survey {

struct PathPoint {
  EnuPoint at;
  bool reverse = false;
  Turn turn = Turn::Auto;  ///< here
};

class Drawer {
 public:
  struct Manner {
    SurveyTurn turn = SurveyTurn::Pivot;
    double radius_m = 0.0;
    double sagitta_m = 0.02;  ///< of the chords of arcs
  };

  /// @param ways must outlive it
  Drawer(const Ways& ways, const Manner& manner);

  /// A straight line that does work.
  void line(EnuPoint from, EnuPoint to);
  /// Once round, from the place nearest to where the path is (or to `start`), back to there.
  void round(const Ring& ring, EnuPoint start);

  const std::vector<PathPoint>& points() const noexcept { return points_; }
  std::optional<EnuPoint> at() const noexcept;

 private:
  void reach(const Pose& to);
  bool arc_to(const Pose& to);
  void put(EnuPoint at, Turn turn, bool reverse = false);

  const Ways& ways_;
  const Manner manner_;
  double step_m_ = 1.0;
  std::vector<PathPoint> points_;
  double yaw_rad_ = 0.0;  ///< at the last point
};

}  // namespace roverd::mission::survey
