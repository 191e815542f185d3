#include "nav/behave/stops.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angle.hpp"
#include "nav/track/corner.hpp"

namespace roverd::nav {
namespace {

constexpr double kAlongside_m = 1e-3;
/// Less of a turn shows on no map.
constexpr double kLeastTurn_rad = 1e-3;

class StopWalk {
 public:
  StopWalk(const Course& course, std::size_t most) : course_(course), most_(most) {}

  CourseStops walk() {
    const Path& path = course_.path;
    if (path.legs.empty()) return {};
    for (const RouteStep& step : course_.steps) take(step);
    while (leg_ < path.legs.size()) drive(path.legs[leg_++], 0);
    return std::move(out_);
  }

 private:
  void take(const RouteStep& step) {
    switch (step.kind) {
      case StepKind::Go:
        go(step);
        return;
      case StepKind::Face:
        if (step.yaw_rad) face(*step.yaw_rad);
        return;
      case StepKind::Turn:
        if (step.moves_on()) return leave();
        if (step.yaw_rad) {
          face(*step.yaw_rad);
        } else if (yaw_rad_) {
          turn(base::wrap_rad(*yaw_rad_ + step.by), step.by);
        }
        return;
      case StepKind::Home:
      case StepKind::Move:
      case StepKind::Row:
      case StepKind::Wall:
      case StepKind::Landmarks:
      case StepKind::Dock:
        return leave();
      case StepKind::Wait:
      case StepKind::Jump:
      case StepKind::Act:
      case StepKind::Stay:
        return;
    }
  }

  /// To where no plan tells.
  void leave() {
    yaw_rad_.reset();
    elsewhere_ = true;
    places_ = 0;
  }

  void go(const RouteStep& step) {
    const Path& path = course_.path;
    const double to_m = path.vertex_m[step.node] + kAlongside_m;
    if (!begun_) {
      begun_ = true;
      elsewhere_ = false;
      yaw_rad_.reset();
      stop({path.points.front().at, 0.0, step.item});
    }
    ++places_;
    while (leg_ < path.legs.size() && path.legs[leg_].end_m <= to_m) {
      drive(path.legs[leg_++], step.item);
    }
  }

  /// Along a leg, and to its end. @param item that is there; 0: the one before's
  void drive(const Leg& leg, int item) {
    const std::vector<PathPoint>& points = course_.path.points;
    const double back = leg.reverse ? base::kPi : 0.0;
    const auto yaw = [&](std::size_t i) {
      return base::wrap_rad(direction_rad(points[i].at, points[i + 1].at) + back);
    };
    const double begin = yaw(leg.first);
    const bool away = !yaw_rad_ || std::abs(base::angle_diff_rad(*yaw_rad_, begin)) > leg.align_rad;
    if (!elsewhere_ && away && leg.align_rad < base::kPi) face(begin, leg.align_rad);
    // From elsewhere it comes straight to the first place of the leg, from nobody knows where.
    yaw_rad_.reset();
    if (!elsewhere_ || places_ > 1) yaw_rad_ = yaw(leg.last - 1);
    elsewhere_ = false;
    const int last_item = out_.stops.empty() ? 0 : out_.stops.back().item;
    stop({points[leg.last].at, leg.end_m, item > 0 ? item : last_item});
    if (leg.end_yaw_rad) face(*leg.end_yaw_rad);
  }

  void face(double yaw_rad, double above_rad = 0.0) {
    turn(yaw_rad, yaw_rad_ ? base::angle_diff_rad(*yaw_rad_, yaw_rad) : 0.0, above_rad);
  }

  void turn(double to_yaw_rad, double by_rad, double above_rad = 0.0) {
    const bool turns = !yaw_rad_ || std::abs(by_rad) > kLeastTurn_rad;
    if (begun_ && !elsewhere_ && turns && room()) {
      out_.stops.back().turns.push_back({yaw_rad_, to_yaw_rad, by_rad, yaw_rad_ ? 0.0 : above_rad});
    }
    yaw_rad_ = to_yaw_rad;
  }

  void stop(CourseStop at) {
    if (room()) out_.stops.push_back(std::move(at));
  }

  bool room() {
    if (told_ < most_) {
      ++told_;
      return true;
    }
    ++out_.left_out;
    return false;
  }

  const Course& course_;
  std::size_t most_;
  CourseStops out_;
  std::size_t told_ = 0;
  std::size_t leg_ = 0;
  std::optional<double> yaw_rad_;
  bool begun_ = false;
  bool elsewhere_ = false;  ///< not where the last stop is
  std::size_t places_ = 0;  ///< driven to since then
};

}  // namespace

CourseStops stops_of(const Course& course, std::size_t most) {
  return StopWalk(course, most).walk();
}

}  // namespace roverd::nav
