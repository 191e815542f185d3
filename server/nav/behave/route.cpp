#include "nav/behave/route.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "nav/track/corner.hpp"

namespace roverd::nav {
namespace {

using base::FieldError;
using mission::AtEnd;

class Layout {
 public:
  Layout(const mission::Plan& plan, const base::LocalFrame& frame, const PathParams& params)
      : plan_(plan), frame_(frame), params_(params) {
    speed_mps_ = plan.settings.speed_mps.value_or(params.speed.default_mps);
    route_.speed_mps = speed_mps_;
    route_.at_end = plan.settings.at_end;
    route_.corridor_m = plan.settings.corridor_m;
    route_.times = std::max(0, plan.settings.times.value_or(0));
    route_.items = static_cast<int>(plan.items.size());
  }

  base::Result<Route> lay() {
    if (plan_.home) route_.home = place(plan_.home->at, "/home");
    for (std::size_t i = 0; i < plan_.items.size(); ++i) {
      item_ = static_cast<int>(i) + 1;
      pointer_ = "/items/" + std::to_string(i);
      first_step_.push_back(forth().steps.size());
      std::visit([this](const auto& item) { add(item); }, plan_.items[i]);
    }
    resolve_jumps();
    const bool drives =
        std::any_of(forth().steps.begin(), forth().steps.end(), [](const RouteStep& step) {
          return step.kind == StepKind::Go || step.kind == StepKind::Home ||
                 step.kind == StepKind::Move || step.kind == StepKind::Turn;
        });
    if (problems_.empty() && !drives) {
      problems_.push_back({"/items", "the mission has no waypoint"});
    }
    if (!problems_.empty()) {
      return base::fail(base::Code::Invalid, problems_[0].pointer + " " + problems_[0].detail,
                        problems_);
    }
    route_.jumps = jump_items_.size();
    forth().path = path_of(forth());
    if (route_.at_end == AtEnd::BackAndForth) turn_round();
    for (Course* course : {&route_.forth, &route_.back}) add_pauses(*course);
    find_home_ends();
    return std::move(route_);
  }

 private:
  Course& forth() { return route_.forth; }

  static bool belongs_before(StepKind kind) {
    return kind == StepKind::Wait || kind == StepKind::Face || kind == StepKind::Act;
  }

  void refuse(std::string detail) { problems_.push_back({pointer_, std::move(detail)}); }

  std::optional<EnuPoint> place(base::LatLon at, const std::string& pointer) {
    if (!base::is_valid(at)) {
      problems_.push_back({pointer, "is not a position on earth"});
      return std::nullopt;
    }
    const double far_m = base::distance_bearing(frame_.origin(), at).distance_m;
    if (far_m > base::LocalFrame::kReach_m) {
      problems_.push_back({pointer, "lies " + std::to_string(std::lround(far_m / 1000.0)) +
                                        " km from the robot's map; at most 10 km are possible"});
      return std::nullopt;
    }
    return frame_.to_local(at);
  }

  void add(const mission::Waypoint& w) {
    const auto at = place(w.at, pointer_);
    if (!at) return;
    RouteNode node{
        *at, w.speed_mps.value_or(speed_mps_), w.radius_m.value_or(0.0), w.reverse, w.turn, item_};
    const double hold_s = std::max(0.0, w.hold_s.value_or(0.0));
    forth().steps.push_back({StepKind::Go, item_, forth().nodes.size(), hold_s});
    forth().nodes.push_back(node);
  }
  void add(const mission::Wait& w) {
    forth().steps.push_back({.kind = StepKind::Wait, .item = item_, .seconds = w.seconds});
  }
  void add(const mission::Speed& s) { speed_mps_ = s.speed_mps; }
  void add(const mission::ReturnHome&) {
    forth().steps.push_back({.kind = StepKind::Home, .item = item_});
  }
  void add(const mission::Jump& j) {
    if (j.item < 1 || j.item > route_.items) {
      refuse("jumps to item " + std::to_string(j.item) + " of " + std::to_string(route_.items));
    } else if (j.times < 0) {
      refuse("cannot repeat " + std::to_string(j.times) + " times");
    } else if (route_.at_end == AtEnd::BackAndForth) {
      refuse("a jump cannot be driven back and forth");
    }
    forth().steps.push_back({.kind = StepKind::Jump, .item = item_, .times = j.times});
    jump_items_.push_back(j.item);
  }
  /// Measured from the mission's home, else from where the map began.
  void add(const mission::Local& l) {
    const EnuPoint origin = route_.home.value_or(EnuPoint{});
    const EnuPoint at = origin + EnuPoint{l.east_m, l.north_m};
    if (!(std::hypot(at.east_m, at.north_m) <= base::LocalFrame::kReach_m)) {
      return refuse("lies more than 10 km from the robot's map");
    }
    RouteNode node{at, speed_mps_, 0.0, false, mission::Turn::Auto, item_};
    const bool faces = l.heading_deg.has_value();
    const double yaw_rad = base::yaw_from_heading(l.heading_deg.value_or(0.0));
    if (faces && params_.vehicle.steered()) {
      const double run_m = std::max(2.0, 1.5 * min_radius_m(params_.vehicle));
      RouteNode before = node;
      before.at = {at.east_m - run_m * std::cos(yaw_rad), at.north_m - run_m * std::sin(yaw_rad)};
      forth().steps.push_back(
          {.kind = StepKind::Go, .item = item_, .node = forth().nodes.size(), .silent = true});
      forth().nodes.push_back(before);
    }
    forth().steps.push_back({.kind = StepKind::Go,
                             .item = item_,
                             .node = forth().nodes.size(),
                             .silent = faces && !params_.vehicle.steered()});
    forth().nodes.push_back(node);
    if (faces && !params_.vehicle.steered()) {
      forth().steps.push_back({.kind = StepKind::Face, .item = item_, .yaw_rad = yaw_rad});
    }
  }
  void add(const mission::Move& m) {
    not_back_and_forth("a move");
    forth().steps.push_back({.kind = StepKind::Move, .item = item_, .by = m.forward_m});
  }
  void add(const mission::TurnBy& t) {
    if (params_.vehicle.steered()) return refuse("this vehicle cannot turn on the spot");
    not_back_and_forth("a turn");
    RouteStep step{.kind = StepKind::Turn, .item = item_};
    if (t.heading_deg) step.yaw_rad = base::yaw_from_heading(*t.heading_deg);
    // Compass turns count clockwise.
    if (t.turn_deg) step.by = -base::rad_from_deg(*t.turn_deg);
    forth().steps.push_back(std::move(step));
  }
  void add(const mission::Action& a) {
    forth().steps.push_back({.kind = StepKind::Act,
                             .item = item_,
                             .action = a.name,
                             .arguments = a.arguments.empty() ? "" : a.arguments.dump()});
  }
  void not_back_and_forth(const char* what) {
    if (route_.at_end == AtEnd::BackAndForth) {
      refuse(std::string(what) + " cannot be driven back and forth");
    }
  }
  template <class Other>
  void add(const Other& other) {
    refuse("items of type " + std::string(mission::type_name(mission::Item(other))) +
           " are not available yet");
  }

  void resolve_jumps() {
    if (!problems_.empty()) return;
    std::size_t k = 0;
    for (RouteStep& step : forth().steps) {
      if (step.kind != StepKind::Jump) continue;
      step.target = first_step_[static_cast<std::size_t>(jump_items_[k] - 1)];
      step.node = k++;
    }
  }

  /// Where the order of driving is not simply "the next waypoint", the robot stops.
  Path path_of(const Course& course) const {
    std::vector<Vertex> vertices;
    vertices.reserve(course.nodes.size());
    for (const RouteNode& n : course.nodes) {
      const double through = n.radius_m > 0.0 ? n.radius_m : params_.track.through_deviation_m;
      vertices.push_back(
          {n.at, n.speed_mps, n.reverse, false, n.turn,
           n.turn == mission::Turn::Through ? through : params_.track.corner_deviation_m});
    }
    for (std::size_t i = 0; i < course.steps.size(); ++i) {
      const RouteStep& step = course.steps[i];
      if (step.kind != StepKind::Go) continue;
      const bool on = i + 1 < course.steps.size() && course.steps[i + 1].kind == StepKind::Go;
      vertices[step.node].stop = !on || step.seconds > 0.0;
    }
    return build_path(vertices, params_);
  }

  /// The same way in the other direction. What is done at a
  /// waypoint belongs to the one before it, a speed and
  /// "reverse" to the way between two waypoints.
  void turn_round() {
    Course& back = route_.back;
    const Course& there = route_.forth;
    back.nodes.assign(there.nodes.rbegin(), there.nodes.rend());
    for (std::size_t i = 1; i < back.nodes.size(); ++i) {
      const RouteNode& way = there.nodes[there.nodes.size() - i];
      back.nodes[i].speed_mps = way.speed_mps;
      back.nodes[i].reverse = way.reverse;
    }
    for (std::size_t end = there.steps.size(); end > 0;) {
      std::size_t begin = end - 1;
      while (begin > 0 && belongs_before(there.steps[begin].kind)) --begin;
      const bool before_any = belongs_before(there.steps[begin].kind);
      for (std::size_t i = begin; i < end && !before_any; ++i) {
        RouteStep step = there.steps[i];
        if (step.kind == StepKind::Go) step.node = there.nodes.size() - 1 - step.node;
        back.steps.push_back(step);
      }
      end = begin;
    }
    back.path = path_of(back);
  }

  double pause_s(const RouteStep& step) const {
    const double turn_radps = params_.pivot.max_rate_radps;
    switch (step.kind) {
      case StepKind::Go:
      case StepKind::Wait:
        return step.seconds;
      case StepKind::Move:
        return std::abs(step.by) / std::max(0.1, params_.speed.creep_mps);
      case StepKind::Face:
      case StepKind::Turn:
        return (step.yaw_rad ? base::kPi / 2.0 : std::abs(step.by)) / turn_radps;
      case StepKind::Home:
      case StepKind::Jump:
      case StepKind::Act:
        break;
    }
    return 0.0;
  }

  void add_pauses(Course& course) const {
    course.pauses_s.assign(course.steps.size() + 1, 0.0);
    for (std::size_t i = course.steps.size(); i > 0; --i) {
      course.pauses_s[i - 1] = course.pauses_s[i] + pause_s(course.steps[i - 1]);
    }
  }

  /// From where the mission drives home, and where to from there. After a move nobody knows.
  void find_home_ends() {
    std::optional<EnuPoint> before;
    bool at_home = false;
    for (const RouteStep& step : forth().steps) {
      if (step.kind == StepKind::Go) {
        before = forth().nodes[step.node].at;
        if (at_home) route_.home_ends.push_back({*before, step.item});
        at_home = false;
      } else if (step.kind == StepKind::Move) {
        before.reset();
        at_home = false;
      } else if (step.kind == StepKind::Home) {
        if (before) route_.home_ends.push_back({*before, step.item});
        before.reset();
        at_home = true;
      }
    }
    if (route_.at_end == AtEnd::Return && before) route_.home_ends.push_back({*before, 0});
  }

  const mission::Plan& plan_;
  const base::LocalFrame& frame_;
  const PathParams& params_;
  Route route_;
  double speed_mps_ = 0.0;
  int item_ = 0;
  std::string pointer_;
  std::vector<std::size_t> first_step_;  ///< of each item
  std::vector<int> jump_items_;
  std::vector<FieldError> problems_;
};

}  // namespace

base::Result<Route> lay_route(const mission::Plan& plan, const base::LocalFrame& frame,
                              const PathParams& params) {
  return Layout(plan, frame, params).lay();
}

}  // namespace roverd::nav
