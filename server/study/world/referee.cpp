#include "study/world/referee.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "sim/world/contact.hpp"
#include "study/world/comers.hpp"

namespace roverd::study {
namespace {

namespace world = sim::world;

constexpr double kMoves_mps = 0.02;  // of the outline
constexpr double kBeside_m = 0.25;   // a thing so near to what the guard blames is what it means
constexpr double kThere_m = 0.05;
constexpr double kMap_m = 40.0;  // half side
constexpr double kMapCell_m = 0.1;
constexpr auto kMapSide = static_cast<std::size_t>(2.0 * kMap_m / kMapCell_m);
constexpr double kSightEvery_s = 0.09;
constexpr double kUnbroken_s = 1.0;
constexpr double kAfterwards_s = 1.0;
constexpr double kAnew_m = 0.05;
constexpr double kRoomMost_m = 1.0;  // what is farther is told so
constexpr double kStandsFor_s = 0.3;
constexpr double kOverIt_m = 0.1;      // over what the guard lets pass above
constexpr double kUnderIt_m = 0.02;    // what is lower is ground to it
constexpr double kAbout_m = 0.2;       // of a place that was touched
constexpr double kThrough_m = 5.0;     // beams lie no farther from each other than a pole is wide
constexpr double kBefore_m = 0.2;      // where it was met
constexpr std::uint8_t kThrough = 30;  // several scans
constexpr std::size_t kNowhere = ~std::size_t{0};
constexpr double kSightReach_m = 8.0;  // farther nothing is looked at

std::string_view word_of(world::Cause cause) {
  switch (cause) {
    case world::Cause::Thing:
      return "edge";  // of something near, but no thing is there
    case world::Cause::Ground:
      return "ground";
    case world::Cause::Mixed:
      return "mixed";
    case world::Cause::Rain:
      return "rain";
    case world::Cause::Dust:
      return "dust";
    case world::Cause::Window:
      return "window";
    default:
      return "nothing";
  }
}

bool touches_any(const world::Scene& scene, const world::Moment& moment, const world::Pose& pose,
                 const world::Body& body) {
  return !world::contact(scene, moment, pose, body, 0.01).touches.empty();
}

std::pair<int, int> cell_of(double x_m, double y_m) {
  return {static_cast<int>(std::floor(x_m / kMapCell_m)),
          static_cast<int>(std::floor(y_m / kMapCell_m))};
}

world::Body grown(world::Body body, double by_m) {
  for (world::Vec2& p : body.outline) {
    p = {p.x + (p.x < 0.0 ? -by_m : by_m), p.y + (p.y < 0.0 ? -by_m : by_m)};
  }
  return body;
}

}  // namespace

Referee::Referee(const sim::Surroundings& around, const nav::sense::ProtectParams& brakes,
                 const nav::sense::GroundParams& ground, double plane_m)
    : around_(around),
      brakes_(brakes),
      pass_below_m_(ground.pass_below_m),
      grass_m_(ground.min_height_m + ground.rough_m),
      plane_m_(plane_m),
      met_(kMapSide * kMapSide),
      through_(met_.size()) {
  reach_m_ = 0.0;
  for (const world::Vec2 p : around_.witness().body().outline) {
    reach_m_ = std::max(reach_m_, std::hypot(p.x, p.y));
  }
  sights_.resize(around_.scene().world().things.size());
  beams_.resize(sights_.size());
  places_.resize(sights_.size());
}

std::size_t Referee::map_cell(double x_m, double y_m) noexcept {
  constexpr double kPerCell = 1.0 / kMapCell_m;
  const double column = (x_m + kMap_m) * kPerCell;
  const double row = (y_m + kMap_m) * kPerCell;
  constexpr auto kSide = static_cast<double>(kMapSide);
  if (!(column >= 0.0 && column < kSide && row >= 0.0 && row < kSide)) return kNowhere;
  return static_cast<std::size_t>(row) * kMapSide + static_cast<std::size_t>(column);
}

void Referee::saw(const std::vector<world::Sweep>& sweeps, const world::Pose& mount, double now_s) {
  for (const world::Sweep& sweep : sweeps) {
    const world::Frame sensor = world::Frame(around_.pose_at(sweep.at_s)) * world::Frame(mount);
    for (const world::Shot& s : sweep.shots) {
      const auto b = static_cast<double>(s.bearing_rad);
      const auto e = static_cast<double>(s.elevation_rad);
      const auto place = [&](double m) {
        return sensor * world::Vec3{m * std::cos(e) * std::cos(b), m * std::cos(e) * std::sin(b),
                                    m * std::sin(e)};
      };
      const auto range_m = static_cast<double>(s.range_m);
      const bool goes_on = s.cause == world::Cause::Nothing || range_m > kThrough_m;
      const world::Vec3 end = place(goes_on ? kThrough_m + kBefore_m : range_m);
      if (goes_on || range_m > 0.0) passes({sensor.p.x, sensor.p.y}, {end.x, end.y});
      if (range_m <= 0.0 || range_m > kSightReach_m) continue;
      const world::Vec3 at = place(range_m);
      if (const std::size_t cell = map_cell(at.x, at.y); cell != kNowhere) {
        met_[cell] = {static_cast<float>(now_s), s.cause};
        if (s.cause == world::Cause::Thing) through_[cell] = 0;
      }
      if (s.thing < 0 || s.cause != world::Cause::Thing) continue;
      const auto thing = static_cast<std::size_t>(s.thing);
      std::vector<double>& seen = sights_[thing];
      ++beams_[thing];
      places_[thing].try_emplace(cell_of(at.x, at.y), now_s);
      if (seen.empty() || now_s - seen.back() > kSightEvery_s) seen.push_back(now_s);
    }
  }
}

void Referee::passes(world::Vec2 from, world::Vec2 to) {
  if (plane_m_ <= 0.0) return;  // nobody asks: looked_through
  const double far_m = world::length(to - from);
  const world::Vec2 step = kMapCell_m / far_m * (to - from);
  const double until_m = std::min(far_m - kBefore_m, kThrough_m);
  world::Vec2 at = from;
  for (double m = kMapCell_m; m < until_m; m += kMapCell_m) {
    at = at + step;
    const std::size_t cell = map_cell(at.x, at.y);
    if (cell != kNowhere && through_[cell] < kThrough) ++through_[cell];
  }
}

bool Referee::looked_through(int thing, const world::Pose& pose, double at_s) {
  if (plane_m_ <= 0.0) return false;  // a lidar's beams go over what is low
  const auto touched = places_touched(thing, pose, at_s, kUnderIt_m);
  return !touched.empty() && std::ranges::all_of(touched, [this](const world::Vec2& at) {
    const std::size_t cell = map_cell(at.x, at.y);
    return cell != kNowhere && through_[cell] >= kThrough;
  });
}

void Referee::begin() {
  counts_ = true;
  began_s_ = around_.now_s();
  hard_ = around_.witness().hard();
  soft_before_ = around_.witness().soft();
}

void Referee::look() {
  const double now_s = around_.now_s();
  const world::Pose pose = around_.pose_at(now_s);
  Was was{now_s, pose, 0.0, 0.0, 0.0};
  if (!trail_.empty()) {
    const Was& before = trail_.back();
    const double dt_s = now_s - before.at_s;
    if (dt_s <= 0.0) return;
    const double along = std::cos(pose.yaw_rad) * (pose.x_m - before.pose.x_m) +
                         std::sin(pose.yaw_rad) * (pose.y_m - before.pose.y_m);
    was.v_mps = along / dt_s;
    was.w_radps = base::angle_diff_rad(before.pose.yaw_rad, pose.yaw_rad) / dt_s;
    was.way_m = before.way_m + (std::abs(was.v_mps) + std::abs(was.w_radps) * reach_m_) * dt_s;
    if (counts_) driven_m_ += std::abs(along);
  }
  trail_.push_back(was);
  const double moves_mps = std::abs(was.v_mps) + std::abs(was.w_radps) * reach_m_;
  if (moves_mps > kMoves_mps) still_since_s_ = now_s;
  const auto& witness = around_.witness();
  soft_ = witness.soft();
  if (witness.hard() == hard_) return;
  const auto& seen = witness.seen();
  std::size_t fresh = witness.hard() - hard_;
  hard_ = witness.hard();
  for (std::size_t i = seen.size(); i-- > 0 && fresh > 0;) {
    if (seen[i].soft) continue;
    --fresh;
    if (counts_) judge(seen[i]);
  }
}

double Referee::stands_s() const noexcept {
  return around_.now_s() - still_since_s_;
}

std::size_t Referee::index_at(double at_s) const {
  const auto after = std::ranges::lower_bound(trail_, at_s, {}, &Was::at_s);
  const auto i = static_cast<std::size_t>(after - trail_.begin());
  return std::min(i, trail_.size() - 1);
}

/// The time since which the thing has been where the body touched it.
double Referee::there_since_s(int thing, const world::Pose& pose, double at_s) const {
  const world::Body body = grown(around_.witness().body(), kThere_m);
  world::Moment moment;
  double since_s = at_s;
  for (double t = at_s; t > 0.0; t -= 0.05) {
    around_.scene().move_to(moment, t);
    const auto there = world::contact(around_.scene(), moment, pose, body, 0.01);
    if (std::ranges::find(there.touches, thing, &world::Touch::thing) == there.touches.end()) break;
    since_s = t;
  }
  return since_s;
}

bool Referee::reaches(int thing, const world::Pose& pose, double at_s, double from_m,
                      double to_m) const {
  world::Body slab = grown(around_.witness().body(), 0.02);
  slab.clearance_m = from_m;
  slab.height_m = to_m;
  world::Moment moment;
  around_.scene().move_to(moment, at_s);
  const auto there = world::contact(around_.scene(), moment, pose, slab, 0.01);
  return std::ranges::find(there.touches, thing, &world::Touch::thing) != there.touches.end();
}

/// Of what was touched nothing reaches into the scanners' plane there: it lies beneath, or hangs
/// above.
bool Referee::beside_plane(int thing, const world::Pose& pose, double at_s) const {
  constexpr double kUneven_m = 0.03;
  return plane_m_ > 0.0 && !reaches(thing, pose, at_s, plane_m_ - kUneven_m, plane_m_ + kUneven_m);
}

/// Looked for everywhere below the body, over its own plane there.
std::vector<world::Vec2> Referee::places_touched(int thing, const world::Pose& pose, double at_s,
                                                 double from_m) const {
  std::vector<world::Vec2> out;
  if (thing < 0) return out;
  constexpr double kStep_m = 0.05;
  const world::Body whole = grown(around_.witness().body(), 0.02);
  const world::Body little =
      world::Body::rectangle(0.5 * kStep_m, 0.5 * kStep_m, kStep_m, whole.height_m, from_m);
  const auto [rear, front] = std::ranges::minmax(whole.outline, {}, &world::Vec2::x);
  const auto [right, left] = std::ranges::minmax(whole.outline, {}, &world::Vec2::y);
  const world::Frame body(pose);
  world::Moment moment;
  around_.scene().move_to(moment, at_s);
  for (double x = rear.x; x <= front.x; x += kStep_m) {
    for (double y = right.y; y <= left.y; y += kStep_m) {
      const world::Vec3 at = body * world::Vec3{x, y, 0.0};
      const world::Pose there{at.x, at.y, at.z, 0.0, 0.0, pose.yaw_rad};
      const auto met = world::contact(around_.scene(), moment, there, little, 0.01).touches;
      if (std::ranges::find(met, thing, &world::Touch::thing) != met.end()) {
        out.push_back({at.x, at.y});
      }
    }
  }
  return out;
}

/// The uphill corner of a low box, say. The ground is laid through the middle of the grass.
bool Referee::low_as_grass(int thing, const world::Pose& pose, double at_s) const {
  return thing >= 0 && places_touched(thing, pose, at_s, grass_m_).empty();
}

std::optional<double> Referee::place_seen_since_s(int number, const world::Pose& pose,
                                                  double at_s) const {
  const auto touched = places_touched(number, pose, at_s, kUnderIt_m);
  std::optional<double> since_s;
  for (const auto& [cell, first_s] : places_[static_cast<std::size_t>(number)]) {
    if (since_s && first_s >= *since_s) continue;
    const world::Vec2 seen{(cell.first + 0.5) * kMapCell_m, (cell.second + 0.5) * kMapCell_m};
    const bool about = std::ranges::any_of(touched, [&](const world::Vec2& at) {
      return std::hypot(seen.x - at.x, seen.y - at.y) <= kAbout_m;
    });
    if (about) since_s = first_s;
  }
  return since_s;
}

std::optional<double> Referee::in_sight_since_s(int number, const world::Pose& pose,
                                                double touched_s) const {
  if (number < 0) return std::nullopt;
  const auto& seen = sights_[static_cast<std::size_t>(number)];
  if (seen.empty()) return std::nullopt;
  const world::Thing& thing = around_.scene().world().things[static_cast<std::size_t>(number)];
  // What stands does not leave; and what was seen once is known.
  if (!world::moves(thing.kind)) return place_seen_since_s(number, pose, touched_s);
  if (touched_s - seen.back() > kUnbroken_s) return std::nullopt;
  std::size_t i = seen.size() - 1;
  while (i > 0 && seen[i] - seen[i - 1] <= kUnbroken_s) --i;
  return std::max(seen[i], set_out_s(thing, touched_s));
}

bool Referee::brakes_avoid(int thing, double from_s, double touched_s) const {
  constexpr double kStep_s = 0.02;
  const double brakes_s = from_s + brakes_.delay_s;
  if (brakes_s >= touched_s) return false;
  const Was& begin = trail_[index_at(brakes_s)];
  const double u = std::abs(begin.v_mps) + std::abs(begin.w_radps) * reach_m_;
  const double lasts_s = std::max({std::abs(begin.v_mps) / brakes_.decel_mps2,
                                   std::abs(begin.w_radps) / brakes_.turn_decel_radps2, 1e-3});
  world::Moment moment;
  for (double t = brakes_s; t <= touched_s + kAfterwards_s; t += kStep_s) {
    const double for_s = std::min(t - brakes_s, lasts_s);
    const double way_m = begin.way_m + u * (for_s - 0.5 * for_s * for_s / lasts_s);
    const auto at = std::ranges::lower_bound(trail_, way_m, {}, &Was::way_m);
    const world::Pose& pose = at == trail_.end() ? trail_.back().pose : at->pose;
    around_.scene().move_to(moment, t);
    const auto there =
        world::contact(around_.scene(), moment, pose, around_.witness().body(), 0.01);
    if (std::ranges::find(there.touches, thing, &world::Touch::thing) != there.touches.end()) {
      return false;
    }
  }
  return true;
}

/// It stands; or drives away from who touches it.
bool Referee::comes_to_it(int number, const Was& now) const {
  if (std::abs(now.v_mps) + std::abs(now.w_radps) * reach_m_ < kMoves_mps) return true;
  if (number < 0) return false;
  const world::Thing& thing = around_.scene().world().things[static_cast<std::size_t>(number)];
  if (!world::moves(thing.kind)) return false;
  const world::Vec2 off =
      world::on_path(thing, now.at_s).at - world::Vec2{now.pose.x_m, now.pose.y_m};
  const double c = std::cos(now.pose.yaw_rad);
  const double s = std::sin(now.pose.yaw_rad);
  return nears_mps(around_.witness().body().outline, {c * off.x + s * off.y, c * off.y - s * off.x},
                   {now.v_mps, now.w_radps}) < -kMoves_mps;
}

void Referee::judge(const world::Witness::Seen& seen) {
  const Was& now = trail_[index_at(seen.at_s)];
  TouchSeen out;
  out.at_s = seen.at_s - began_s_;
  out.thing = around_.scene().name_of(seen.thing);
  out.speed_mps = now.v_mps;
  out.yaw_rate_radps = now.w_radps;
  out.at = {seen.at.x, seen.at.y};
  if (seen.thing >= 0) {
    out.height_m = around_.scene().world().things[static_cast<std::size_t>(seen.thing)].height_m;
    out.beams = beams_[static_cast<std::size_t>(seen.thing)];
  }
  const auto since_s = in_sight_since_s(seen.thing, now.pose, seen.at_s);
  if (since_s) out.seen_before_s = seen.at_s - *since_s;
  if (comes_to_it(seen.thing, now)) {
    out.blame = Blame::Standing;
  } else if (!since_s) {
    out.blame = Blame::Unseen;
  } else if (!brakes_avoid(seen.thing, *since_s, seen.at_s)) {
    out.blame = Blame::Late;
  } else {
    const bool beside = beside_plane(seen.thing, now.pose, seen.at_s) ||
                        low_as_grass(seen.thing, now.pose, seen.at_s) ||
                        (!seen.moving && looked_through(seen.thing, now.pose, seen.at_s));
    out.blame = beside ? Blame::Beside : Blame::Ours;
  }
  if (since_s) {
    const double there_s = seen.moving ? there_since_s(seen.thing, now.pose, seen.at_s) : -1e9;
    const Was& then = trail_[index_at(std::max(*since_s, there_s))];
    const double u = std::abs(then.v_mps) + std::abs(then.w_radps) * reach_m_;
    const double brake_s = std::max(0.5 * std::abs(then.v_mps) / brakes_.decel_mps2,
                                    0.5 * std::abs(then.w_radps) / brakes_.turn_decel_radps2);
    out.needed_m = u * (brakes_.delay_s + brake_s);
    out.way_m = now.way_m - then.way_m;
    out.crossed = out.blame == Blame::Ours && out.way_m <= out.needed_m;
  }
  touches_.push_back(std::move(out));
}

void Referee::heed(const std::optional<base::Obstacle>& obstacle) {
  const auto action = obstacle ? obstacle->action : base::GuardAction::None;
  const bool slow = action == base::GuardAction::Slow;
  if (slow && !slowing_ && !stopping_ && counts_) ++slows_;
  slowing_ = slow;
  const bool stop = action == base::GuardAction::Stop;
  // One that only asks whether the way is clear by now, and has not moved, still stands.
  const double way_m = trail_.empty() ? 0.0 : trail_.back().way_m;
  if (stop && !stopping_ && counts_ && (stops_.empty() || way_m > stopped_at_m_ + kAnew_m)) {
    measured_ = false;
    stops_.push_back(stop_of(*obstacle));
  }
  if (stop) stopped_at_m_ = way_m;
  stopping_ = stop;
  if (!stop || measured_ || stops_.empty() || stands_s() < kStandsFor_s) return;
  measured_ = true;
  StopSeen& last = stops_.back();
  if (last.cause != "thing") return;
  // Of what it stopped for; of several so near to one another, the nearest.
  for (const int thing : blamed_) {
    const double room = room_m(thing);
    if (last.stands_m && *last.stands_m <= room) continue;
    last.stands_m = room;
    last.thing = around_.scene().name_of(thing);
  }
}

StopSeen Referee::stop_of(const base::Obstacle& o) {
  const world::Pose pose = around_.pose_at(around_.now_s());
  const double c = std::cos(pose.yaw_rad);
  const double s = std::sin(pose.yaw_rad);
  world::Pose there = pose;
  there.x_m += c * o.ahead_m - s * o.left_m;
  there.y_m += s * o.ahead_m + c * o.left_m;
  there.z_m = around_.scene().terrain().height_m({there.x_m, there.y_m});
  there.roll_rad = there.pitch_rad = 0.0;
  StopSeen out;
  out.at_s = around_.now_s() - began_s_;
  out.what = std::string(o.what);
  out.at = {there.x_m, there.y_m};
  out.sensor = o.sensor;
  out.age_s = o.age_s;
  const world::Frame body(pose);
  out.rise_m = body.r[0][2] * (there.x_m - pose.x_m) + body.r[1][2] * (there.y_m - pose.y_m) +
               body.r[2][2] * (there.z_m - pose.z_m);
  if (out.what == "obstacle" || out.what == "drop") out.cause = cause_of(o, there, out.needless);
  return out;
}

std::string Referee::cause_of(const base::Obstacle& o, const world::Pose& there, bool& needless) {
  const world::Body about = world::Body::rectangle(kBeside_m, kBeside_m, 2.0 * kBeside_m,
                                                   pass_below_m_ + kOverIt_m, kUnderIt_m);
  world::Moment moment;
  around_.scene().move_to(moment, around_.now_s());
  needless = false;
  blamed_.clear();
  if (o.moves) {
    const auto met = world::contact(around_.scene(), moment, there, grown(about, kBeside_m), 0.01);
    const auto& things = around_.scene().world().things;
    needless = std::ranges::none_of(met.touches, [&](const world::Touch& t) {
      return t.thing >= 0 && world::moves(things[static_cast<std::size_t>(t.thing)].kind);
    });
    return needless ? "still" : "comes";
  }
  const auto stands = world::contact(around_.scene(), moment, there, about, 0.01).touches;
  for (const world::Touch& t : stands) {
    if (t.thing >= 0 && !t.moving) blamed_.push_back(t.thing);
  }
  if (!stands.empty()) return "thing";
  needless = true;
  const double met_s = around_.now_s() - o.age_s;
  for (const double before_s : {0.0, 0.1, 0.2, 0.4, 0.8}) {
    around_.scene().move_to(moment, std::max(0.0, met_s - before_s));
    if (touches_any(around_.scene(), moment, there, about)) return "left";
  }
  // What the rays met there, last.
  Met last;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const std::size_t cell = map_cell(there.x_m + dx * kMapCell_m, there.y_m + dy * kMapCell_m);
      if (cell != kNowhere && met_[cell].at_s > last.at_s) last = met_[cell];
    }
  }
  return std::string(word_of(last.cause));
}

/// In plan, between the outline and a thing. Of what the guard counts, so also of leaves and of
/// what the body would pass beneath.
double Referee::room_m(int thing) const {
  world::Body counts = around_.witness().body();
  counts.height_m = pass_below_m_ + kOverIt_m;
  counts.clearance_m = kUnderIt_m;
  world::Moment moment;
  around_.scene().move_to(moment, around_.now_s());
  return world::room_m(around_.scene(), moment, around_.pose_at(around_.now_s()), counts, thing,
                       kRoomMost_m);
}

std::optional<double> Referee::nearest_rad() const {
  constexpr double kLooks_m = 9.0;
  const world::Pose pose = around_.pose_at(around_.now_s());
  world::Moment moment;
  around_.scene().move_to(moment, around_.now_s());
  double best_m = kLooks_m;
  std::optional<double> out;
  around_.scene().near({pose.x_m, pose.y_m}, kLooks_m, moment, [&](const world::Shape& shape) {
    const double away_m = std::hypot(shape.x - pose.x_m, shape.y - pose.y_m);
    if (away_m >= best_m) return;
    best_m = away_m;
    out = base::angle_diff_rad(pose.yaw_rad, std::atan2(shape.y - pose.y_m, shape.x - pose.x_m));
  });
  return out;
}

void Referee::report(WorldRun& run) {
  run.driven_m = driven_m_;
  run.driven_s = around_.now_s() - began_s_;
  run.touches = std::move(touches_);
  run.stops = std::move(stops_);
  run.slows = slows_;
  run.brushes = soft_ - soft_before_;
  constexpr std::size_t kTrackEvery = 20;
  for (std::size_t i = index_at(began_s_); i < trail_.size(); i += kTrackEvery) {
    run.track.push_back({trail_[i].pose.x_m, trail_[i].pose.y_m});
  }
}

}  // namespace roverd::study
