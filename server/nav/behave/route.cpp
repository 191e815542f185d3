#include "nav/behave/route.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angle.hpp"
#include "mission/circle.hpp"
#include "nav/behave/mark_sight.hpp"
#include "nav/behave/text.hpp"
#include "nav/track/corner.hpp"
#include "nav/track/tool.hpp"

namespace roverd::nav {
namespace {

using base::FieldError;
using mission::AtEnd;

constexpr double kNodeEvery_rad = base::kPi / 12.0;  // of a circle
constexpr double kMostCircled_m = 50'000.0;
constexpr double kMostPlaces = 200'000.0;  // as many as a mission may have items

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
                 step.kind == StepKind::Move || step.kind == StepKind::Turn ||
                 step.kind == StepKind::Stay || step.by_sight();
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
    if (auto led = lead_by_tool(); !led) return tl::unexpected(led.error());
    find_home_ends();
    return std::move(route_);
  }

 private:
  Course& forth() { return route_.forth; }

  static bool belongs_before(StepKind kind) {
    return kind == StepKind::Wait || kind == StepKind::Face || kind == StepKind::Act ||
           kind == StepKind::Stay;
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

  bool until(const mission::Until& said, std::optional<EnuPoint>& out) {
    if (!said.lat || !said.lon) return true;
    out = place({*said.lat, *said.lon}, pointer_);
    return out.has_value();
  }

  void add(const mission::Waypoint& w) {
    const auto at = place(w.at, pointer_);
    if (!at) return;
    RouteNode node{
        *at, w.speed_mps.value_or(speed_mps_), w.radius_m.value_or(0.0), w.reverse, w.turn, item_};
    go(node).seconds = std::max(0.0, w.hold_s.value_or(0.0));
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
    std::optional<double> yaw_rad;
    if (l.heading_deg) yaw_rad = base::yaw_from_heading(*l.heading_deg);
    go_facing({at, speed_mps_, 0.0, false, mission::Turn::Auto, item_}, yaw_rad, 0.0);
  }
  void add(const mission::MapPoint& p) {
    if (!plan_.frame || !plan_.frame->lies) {
      return refuse("counts from a map, and nobody knows where that lies");
    }
    const base::MapLies& lies = *plan_.frame->lies;
    const auto at = place(mission::place_on_earth(lies, p), pointer_);
    if (!at) return;
    std::optional<double> yaw_rad;
    if (p.yaw_deg) yaw_rad = base::wrap_rad(lies.yaw_rad + base::rad_from_deg(*p.yaw_deg));
    go_facing({*at, p.speed_mps.value_or(speed_mps_), p.radius_m.value_or(0.0), p.reverse,
               mission::Turn::Auto, item_},
              yaw_rad, std::max(0.0, p.hold_s.value_or(0.0)));
  }
  /// To a place, to point there so. A steered vehicle comes to it on a straight.
  void go_facing(const RouteNode& node, std::optional<double> to_rad, double hold_s) {
    leave_circle();
    const double yaw_rad = to_rad.value_or(0.0);
    if (to_rad && params_.vehicle.steered()) {
      const double run_m =
          (node.reverse ? -1.0 : 1.0) * std::max(2.0, 1.5 * min_radius_m(params_.vehicle));
      RouteNode before = node;
      before.at = node.at - EnuPoint{run_m * std::cos(yaw_rad), run_m * std::sin(yaw_rad)};
      forth().steps.push_back(
          {.kind = StepKind::Go, .item = item_, .node = forth().nodes.size(), .silent = true});
      forth().nodes.push_back(before);
    }
    const bool turns = to_rad && !params_.vehicle.steered();
    forth().steps.push_back({.kind = StepKind::Go,
                             .item = item_,
                             .node = forth().nodes.size(),
                             .seconds = turns ? 0.0 : hold_s,
                             .silent = turns});
    forth().nodes.push_back(node);
    if (!turns) return;
    const bool holds = hold_s > 0.0;
    forth().steps.push_back(
        {.kind = StepKind::Face, .item = item_, .yaw_rad = yaw_rad, .silent = holds});
    if (holds) {
      forth().steps.push_back({.kind = StepKind::Wait, .item = item_, .seconds = hold_s});
    }
  }
  void add(const mission::Move& m) {
    not_back_and_forth("a move");
    forth().steps.push_back({.kind = StepKind::Move, .item = item_, .by = m.forward_m});
  }
  void add(const mission::TurnBy& t) {
    if (params_.tool.pulled()) {
      return refuse("with a trailer (nav.tool.trailer_m) nothing turns from where it stands");
    }
    const double least_m = min_radius_m(params_.vehicle);
    if (params_.vehicle.steered() && !t.radius_m) {
      return refuse("this vehicle cannot turn on the spot; with a radius_m it drives an arc");
    }
    if (t.radius_m && *t.radius_m < least_m) {
      return refuse("is a turn too narrow for this vehicle: its radius_m must be at least " +
                    tenths_text(least_m));
    }
    not_back_and_forth("a turn");
    if (t.radius_m) leave_circle();
    RouteStep step{.kind = StepKind::Turn, .item = item_, .radius_m = t.radius_m.value_or(0.0)};
    if (t.heading_deg) step.yaw_rad = base::yaw_from_heading(*t.heading_deg);
    // Compass turns count clockwise.
    if (t.turn_deg) step.by = -base::rad_from_deg(*t.turn_deg);
    forth().steps.push_back(std::move(step));
  }
  void add(const mission::Row& r) {
    if (params_.tool.pulled()) return refuse("with a trailer no row is driven by sight");
    not_back_and_forth("a row");
    const double half_m = 0.5 * params_.vehicle.width_m;
    if (r.side != mission::RowSide::Both && r.gap_m && *r.gap_m <= half_m) {
      return refuse("is driven " + tenths_text(*r.gap_m) +
                    " beside its plants: this vehicle would drive over them");
    }
    RowToDrive row;
    row.order.sides = r.side == mission::RowSide::Left    ? rows::Sides::Left
                      : r.side == mission::RowSide::Right ? rows::Sides::Right
                                                          : rows::Sides::Both;
    row.order.seeing =
        r.seeing == mission::RowSeeing::Rays ? rows::Seeing::Rays : rows::Seeing::Line;
    if (r.gap_m) row.order.gap_m = *r.gap_m;
    row.speed_mps = r.speed_mps;
    row.distance_m = r.distance_m;
    if (!until(r.until, row.until)) return;
    leave_circle();
    forth().steps.push_back({.kind = StepKind::Row, .item = item_, .row = row});
  }
  void add(const mission::Wall& w) {
    if (params_.tool.pulled()) return refuse("with a trailer no wall is driven along by sight");
    if (w.distance_m && *w.distance_m <= touches_wall_m(params_.vehicle)) {
      return refuse("is driven " + tenths_text(*w.distance_m) +
                    " from its wall: this vehicle would touch it");
    }
    not_back_and_forth("a wall");
    WallToDrive wall{w.side == mission::Side::Left ? marks::Side::Left : marks::Side::Right,
                     w.distance_m,
                     w.speed_mps,
                     w.length_m,
                     by_of(w.source),
                     w.landmarks_first};
    if (!until(w.until, wall.until)) return;
    leave_circle();
    forth().steps.push_back({.kind = StepKind::Wall, .item = item_, .wall = wall});
  }
  void add(const mission::Landmarks& l) {
    if (params_.tool.pulled()) return refuse("with a trailer no landmarks are passed by sight");
    if (l.offset_m && std::abs(*l.offset_m) <= touches_landmark_m(params_.vehicle)) {
      return refuse("passes landmarks at " + tenths_text(std::abs(*l.offset_m)) +
                    ": this vehicle would drive over them");
    }
    not_back_and_forth("a way past landmarks");
    LandmarksToPass pass;
    const bool on_right = l.offset_m ? *l.offset_m > 0.0 : l.side == mission::Side::Right;
    pass.side = on_right ? marks::Side::Right : marks::Side::Left;
    if (l.offset_m) pass.offset_m = std::abs(*l.offset_m);
    pass.name = l.name == mission::kAnyLandmark ? "" : l.name;
    pass.speed_mps = l.speed_mps;
    if (l.count.value_or(0) > 0) pass.count = l.count;
    pass.by = by_of(l.source);
    leave_circle();
    forth().steps.push_back({.kind = StepKind::Landmarks, .item = item_, .landmarks = pass});
  }
  void add(const mission::Dock& d) {
    if (params_.tool.pulled()) return refuse("with a trailer no tag is docked at");
    if (params_.vehicle.steered()) {
      return refuse("docks at a tag: this vehicle cannot turn on the spot");
    }
    not_back_and_forth("a dock");
    leave_circle();
    forth().steps.push_back(
        {.kind = StepKind::Dock, .item = item_, .dock = DockToCome{d.tag, d.stand_off_m}});
  }
  void add(const mission::Action& a) {
    forth().steps.push_back({.kind = StepKind::Act,
                             .item = item_,
                             .action = a.name,
                             .arguments = a.arguments.empty() ? "" : a.arguments.dump()});
  }
  void add(const mission::Loiter& l) {
    RouteStep stay{.kind = StepKind::Stay, .item = item_, .seconds = l.seconds.value_or(0.0)};
    stay.within_m = l.within_m();
    stay.endless = !l.seconds;
    if (const auto at = l.at()) {
      stay.place = place(*at, pointer_);
      if (!stay.place) return;
      go({.at = *stay.place, .speed_mps = speed_mps_, .item = item_}).silent = true;
    }
    forth().steps.push_back(std::move(stay));
  }
  void add(const mission::Circle& c) {
    const auto centre = place(c.at, pointer_);
    if (!centre) return;
    const bool steered = params_.vehicle.steered();
    const std::size_t stations = mission::stations_of(c);
    if (c.radius_m < min_radius_m(params_.vehicle)) {
      return refuse("is a circle too narrow for this vehicle: its radius must be at least " +
                    tenths_text(min_radius_m(params_.vehicle)));
    }
    if (steered && stations > 0) {
      return refuse("has stations to turn on the spot: this vehicle cannot");
    }
    const mission::CircleWay way = mission::circle_way(c, *centre, before_circle());
    circled_m_ += way.length_m();
    if (circled_m_ > kMostCircled_m) return refuse("the mission's circles are longer than 50 km");
    const double places = std::abs(way.sweep_rad) / kNodeEvery_rad + 3.0 * double(stations);
    if (double(forth().steps.size()) + places > kMostPlaces) {
      return refuse("the mission's circles have too many places to drive by");
    }
    RouteNode node{.at = way.entry(),
                   .speed_mps = c.speed_mps.value_or(speed_mps_),
                   .item = item_,
                   .tangent = way.tangent || steered,
                   .halt = !way.tangent && !steered};
    if (steered && !way.tangent) lead_in(way, node);
    go(node).silent = true;
    round(c, way, stations, node);
    if (steered) leave_ = LeadOut{way, node.speed_mps};
  }

  /// Where the way to a circle begins, as far as a plan tells.
  std::optional<EnuPoint> before_circle() const {
    const auto& steps = route_.forth.steps;
    for (auto step = steps.rbegin(); step != steps.rend(); ++step) {
      if (step->kind == StepKind::Go) return route_.forth.nodes[step->node].at;
      const bool elsewhere = step->kind == StepKind::Home || step->moves_on() || step->by_sight() ||
                             (step->kind == StepKind::Stay && !step->place);
      if (elsewhere || step->kind == StepKind::Jump) return std::nullopt;
    }
    return route_.home;
  }

  /// A steered vehicle comes onto a circle only along it.
  void lead_in(const mission::CircleWay& way, RouteNode node) {
    const double run_m = std::max(2.0, 1.5 * min_radius_m(params_.vehicle));
    node.at = beside(way, 0.0, -run_m);
    node.tangent = false;
    go(node).silent = true;
  }

  /// On the tangent at a place of the circle, so far along the way.
  static EnuPoint beside(const mission::CircleWay& way, double along_rad, double by_m) {
    const double side = way.sweep_rad > 0.0 ? 1.0 : -1.0;
    const double yaw_rad = way.from_rad + along_rad + side * base::kPi / 2.0;
    const EnuPoint on = way.at(along_rad);
    return {on.east_m + by_m * std::cos(yaw_rad), on.north_m + by_m * std::sin(yaw_rad)};
  }

  void round(const mission::Circle& c, const mission::CircleWay& way, std::size_t stations,
             RouteNode node) {
    const double side = way.sweep_rad > 0.0 ? 1.0 : -1.0;
    const double each_rad = stations > 0 ? 2.0 * base::kPi / c.stations.value_or(1) : 0.0;
    const double whole_rad = std::abs(way.sweep_rad);
    double done_rad = 0.0;
    for (std::size_t k = 1; done_rad < whole_rad - 1e-6; ++k) {
      const double stop_rad = k <= stations ? std::min(whole_rad, each_rad * double(k)) : whole_rad;
      const double arc_rad = stop_rad - done_rad;
      const int pieces = static_cast<int>(std::ceil(arc_rad / kNodeEvery_rad - 1e-9));
      for (int i = 1; i <= pieces; ++i) {
        const double to_rad = done_rad + arc_rad * i / pieces;
        node.at = way.at(side * to_rad);
        node.curvature_1pm = side / way.radius_m;
        const bool end = to_rad > whole_rad - 1e-6;
        const bool station = i == pieces && k <= stations;
        node.halt = station || (end && !params_.vehicle.steered());
        node.tangent = !node.halt;
        RouteStep& step = go(node);
        step.silent = !end || station;
      }
      done_rad = stop_rad;
      if (k <= stations) {
        station(way, side * done_rad, c.hold_s.value_or(0.0), done_rad > whole_rad - 1e-6);
      }
    }
  }

  /// Turns to the centre and holds.
  void station(const mission::CircleWay& way, double at_rad, double hold_s, bool last) {
    const double yaw_rad = base::wrap_rad(way.from_rad + at_rad + base::kPi);
    forth().steps.push_back({.kind = StepKind::Face,
                             .item = item_,
                             .yaw_rad = yaw_rad,
                             .silent = !last || hold_s > 0.0});
    if (hold_s > 0.0) {
      forth().steps.push_back(
          {.kind = StepKind::Wait, .item = item_, .seconds = hold_s, .silent = !last});
    }
  }

  RouteStep& go(const RouteNode& node) {
    leave_circle();
    forth().steps.push_back({.kind = StepKind::Go, .item = item_, .node = forth().nodes.size()});
    forth().nodes.push_back(node);
    return forth().steps.back();
  }

  /// A steered vehicle goes on straight before it bends to what comes next.
  void leave_circle() {
    const auto out = std::exchange(leave_, std::nullopt);
    if (!out) return;
    const double run_m = std::max(2.0, 2.5 * min_radius_m(params_.vehicle));
    const int item = forth().nodes.back().item;
    forth().steps.push_back(
        {.kind = StepKind::Go, .item = item, .node = forth().nodes.size(), .silent = true});
    forth().nodes.push_back({.at = beside(out->way, out->way.sweep_rad, run_m),
                             .speed_mps = out->speed_mps,
                             .item = item});
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
      // The way off a circle belongs to the circle.
      while (step.target < forth().steps.size() &&
             forth().steps[step.target].item < jump_items_[k]) {
        ++step.target;
      }
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
      vertices.back().curvature_1pm = n.curvature_1pm;
      vertices.back().tangent = n.tangent;
    }
    for (std::size_t i = 0; i < course.steps.size(); ++i) {
      const RouteStep& step = course.steps[i];
      if (step.kind != StepKind::Go) continue;
      const bool on = i + 1 < course.steps.size() && course.steps[i + 1].kind == StepKind::Go;
      const RouteNode& node = course.nodes[step.node];
      vertices[step.node].stop = !on || step.seconds > 0.0 || node.halt;
      const bool round = node.tangent || node.halt || node.curvature_1pm != 0.0;
      const bool bends = node.turn == mission::Turn::Auto ||
                         (node.turn == mission::Turn::Arc && params_.vehicle.steered());
      vertices[step.node].dense = bends && !round;
    }
    return build_path(vertices, point_params(params_));
  }

  /// With a tool the vehicle itself goes beside the places of the mission.
  base::Result<void> lead_by_tool() {
    if (!params_.tool.fitted()) return {};
    for (Course* course : {&route_.forth, &route_.back}) {
      course->point_path = std::move(course->path);
      const std::vector<double>& places_m = course->point_path.vertex_m;
      double at_m = 0.0;
      auto led = led_way(course->point_path, params_, at_m);
      if (!led) {
        const auto node = std::lower_bound(places_m.begin(), places_m.end() - 1, at_m);
        const int item = course->nodes[std::size_t(node - places_m.begin())].item;
        const std::string pointer = "/items/" + std::to_string(item - 1);
        return base::fail(base::Code::Invalid, pointer + " " + led.error().detail,
                          {{pointer, led.error().detail}});
      }
      course->path = std::move(*led);
      if (course->path.legs.empty()) continue;
      for (std::size_t i = 0; i < course->nodes.size(); ++i) {
        course->nodes[i].at = course->path.at(course->path.vertex_m[i]);
      }
    }
    return {};
  }

  /// The same way in the other direction. What is done at a
  /// waypoint belongs to the one before it, a speed and
  /// "reverse" to the way between two waypoints.
  void turn_round() {
    Course& back = route_.back;
    const Course& there = route_.forth;
    back.nodes.assign(there.nodes.rbegin(), there.nodes.rend());
    back.nodes.front().curvature_1pm = 0.0;
    for (std::size_t i = 1; i < back.nodes.size(); ++i) {
      const RouteNode& way = there.nodes[there.nodes.size() - i];
      back.nodes[i].speed_mps = way.speed_mps;
      back.nodes[i].reverse = way.reverse;
      back.nodes[i].curvature_1pm = -way.curvature_1pm;
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
    tell_circles_last(back);
    back.path = path_of(back);
  }

  /// Whichever way round, a circle counts when all of it is driven.
  void tell_circles_last(Course& course) const {
    for (std::size_t i = 0; i < course.steps.size(); ++i) {
      const int item = course.steps[i].item;
      const auto& what = plan_.items[static_cast<std::size_t>(item - 1)];
      if (!std::holds_alternative<mission::Circle>(what)) continue;
      course.steps[i].silent = i + 1 < course.steps.size() && course.steps[i + 1].item == item;
    }
  }

  double pause_s(const RouteStep& step) const {
    const double turn_radps = params_.pivot.max_rate_radps;
    switch (step.kind) {
      case StepKind::Go:
      case StepKind::Wait:
        return step.seconds;
      case StepKind::Stay:
        return step.endless ? std::numeric_limits<double>::infinity() : step.seconds;
      case StepKind::Move:
        return std::abs(step.by) / std::max(0.1, params_.speed.creep_mps);
      case StepKind::Face:
      case StepKind::Turn:
        return (step.yaw_rad ? base::kPi / 2.0 : std::abs(step.by)) /
               (step.moves_on() ? std::max(0.1, params_.speed.creep_mps) / step.radius_m
                                : turn_radps);
      case StepKind::Row:  // how long it is, shows on the way
        if (!step.row->distance_m) break;
        return *step.row->distance_m / std::max(0.1, step.row->speed_mps.value_or(speed_mps_));
      case StepKind::Wall:
        if (!step.wall->length_m) break;
        return *step.wall->length_m / std::max(0.1, step.wall->speed_mps.value_or(speed_mps_));
      case StepKind::Landmarks:
      case StepKind::Dock:
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
      } else if (step.moves_on() || step.by_sight()) {
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

  struct LeadOut {
    mission::CircleWay way;
    double speed_mps = 0.0;
  };

  const mission::Plan& plan_;
  const base::LocalFrame& frame_;
  const PathParams& params_;
  Route route_;
  double speed_mps_ = 0.0;
  int item_ = 0;
  double circled_m_ = 0.0;
  std::optional<LeadOut> leave_;  ///< of the circle that was laid last
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
