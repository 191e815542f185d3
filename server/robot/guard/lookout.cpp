#include "robot/guard/lookout.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace roverd::robot {
namespace {

constexpr double kWaits_s = 0.2;
constexpr double kAhead_s = 0.025;  // a tick, and how late it may be
constexpr double kTellAnyway_s = 0.1;
constexpr double kMissed = 2.5;  // pieces that may be missing
constexpr std::size_t kMostWaiting = 64;
constexpr double kBeyond_m = 1.0;  // the picture reaches on, for the body's own size
constexpr double kBesideEvery_s = 0.08;
constexpr double kBesideBand_m = 0.1;  // of the scanner's height, where it leans
constexpr double kAsKept_s = 1e6;      // as long as the grid keeps it

base::SensorHealth health_of(nav::sense::Eye eye, bool silent) noexcept {
  if (silent) return base::SensorHealth::Silent;
  switch (eye) {
    case nav::sense::Eye::Ok:
      return base::SensorHealth::Good;
    case nav::sense::Eye::Degraded:
      return base::SensorHealth::Degraded;
    case nav::sense::Eye::Blind:
      return base::SensorHealth::Blind;
  }
  return base::SensorHealth::Blind;
}

/// When its last point was measured.
base::Time end_of(const base::Sight& sight) noexcept {
  const double after_s = sight.points.empty() ? 0.0 : double(sight.points.back().after_s);
  return sight.stamp + base::from_seconds(after_s);
}

}  // namespace

Lookout::Lookout(nav::sense::Chain chain, std::vector<std::string> kinds, double reach_m,
                 const nav::sense::RaysParams& rays)
    : chain_(std::move(chain)),
      kinds_(std::move(kinds)),
      last_(chain_.sensors()),
      free_for_s_(chain_.sensors(), kAsKept_s),
      scans_(chain_.sensors()),
      rays_(rays),
      counted_(chain_.sensors()),
      beside_at_(chain_.sensors()),
      nears_(chain_.sensors()),
      reach_m_(reach_m) {
  kinds_.resize(chain_.sensors());
}

void Lookout::follow(const nav::sense::ProtectParams& protect, const nav::sense::RaysParams& rays) {
  reach_m_ = protect.reach_m + kBeyond_m;
  rays_ = rays;
  if (rays_.enabled) return;
  for (auto& one : counted_) one.reset();
  for (auto& one : nears_) one.reset();
}

void Lookout::moved(const nav::sense::Odometry& o) noexcept {
  (void)history_.push(o);
}

void Lookout::look_for(const RowQuestion& row) {
  const bool same = finder_ && row.order && row.id == row_.id;
  row_ = row;
  if (same) return finder_->tune(row.params);
  finder_.reset();
  if (row.order) finder_.emplace(row.params, *row.order);
}

void Lookout::see(std::shared_ptr<const base::Sight> sight, base::Time now) {
  if (waiting_.size() >= kMostWaiting) waiting_.pop_front();
  waiting_.push_back(std::move(sight));
  take_waiting(now);
}

/// One that has to wait keeps no other sensor's waiting; one from the future is taken as it is, and
/// refused by the chain.
void Lookout::take_waiting(base::Time now) {
  for (auto one = waiting_.begin(); one != waiting_.end();) {
    const base::Sight& sight = **one;
    const double past_s = base::seconds(now - end_of(sight));
    const bool known =
        !history_.empty() && base::seconds(end_of(sight) - history_.newest().stamp) <= kAhead_s;
    if (!known && past_s < kWaits_s && past_s > -kWaits_s) {
      ++one;
      continue;
    }
    take(sight, now);
    one = waiting_.erase(one);
  }
}

void Lookout::take(const base::Sight& sight, base::Time now) {
  const auto number = chain_.take(sight, history_, now);
  if (!number) return;
  last_[*number] = {sight.points.size(), end_of(sight)};
  scans_[*number].keep(chain_.last(), end_of(sight));
  if (finder_) {
    nav::rows::scan_of(chain_.last(), row_.params, row_scan_);
    finder_->see(row_scan_);
  }
  look_beside(sight, *number);
  if (rays_.enabled) {
    count(*number, end_of(sight), now);
    near(*number, end_of(sight), now);
  }
  news_ = true;
}

/// A piece that is too short, blind or unplaced tells nothing of walls and landmarks.
void Lookout::look_beside(const base::Sight& sight, std::size_t number) {
  auto& last = beside_at_[number];
  if (!chain_.sensor(number).planar) return;
  if (last && base::seconds(sight.stamp - *last) < kBesideEvery_s) return;
  if (!nav::marks::planar_of(sight, chain_.sensor(number).mount, history_, wall_params_.max_range_m,
                             kBesideBand_m, beside_scan_)) {
    return;
  }
  last = sight.stamp;
  chain_.movers(beside_scan_.stamp, movers_);
  marks_.take(nav::marks::Source::Scan, number, [&](nav::marks::Marks& to) {
    to.walls.take(beside_scan_, wall_params_);
    to.landmarks.take(beside_scan_, landmark_params_, number, movers_);
  });
  tell_beside(beside_scan_.stamp, number);
}

void Lookout::recognise(std::shared_ptr<const base::Vision> vision) {
  const auto camera = std::ranges::find(cameras_, vision->sensor, &Camera::name);
  const auto pose = history_.at(vision->stamp);
  if (camera == cameras_.end() || !pose) return;
  const auto wall = nav::marks::wall_of(*vision, camera->mount, wall_params_);
  // Before the take: a glance must not call back a wall that is too old.
  marks_.each([&](nav::marks::Marks& known) {
    known.walls.expire(vision->stamp, {pose->x_m, pose->y_m}, wall_params_);
  });
  // Numbered on from the sensors that look around.
  const auto eye = chain_.sensors() + static_cast<std::size_t>(camera - cameras_.begin());
  marks_.take(nav::marks::Source::Vision, eye, [&](nav::marks::Marks& to) {
    if (wall) to.walls.take(*wall, *pose, vision->stamp, wall_params_);
    to.landmarks.take(*vision, camera->mount, *pose, camera->half_view_rad, landmark_params_, eye);
  });
  tell_beside(vision->stamp, eye);
  std::erase_if(images_, [&](const Image& old) { return old.seen->sensor == vision->sensor; });
  images_.push_back({std::move(vision), camera->mount});
  news_ = true;
}

/// A view is as new as the newest that told of it; how old each one's word is stands beside that.
void Lookout::tell_beside(base::Time seen, std::size_t eye) {
  auto view = std::make_shared<nav::marks::View>();
  view->stamp = beside_ ? std::max(beside_->stamp, seen) : seen;
  if (beside_) view->looked_at = beside_->looked_at;
  if (view->looked_at.size() <= eye) view->looked_at.resize(eye + 1);
  view->looked_at[eye] = std::max(view->looked_at[eye], seen);
  marks_.tell(*view);
  beside_ = std::move(view);
}

/// A piece of a sensor that does not see clears nothing. Nor does one in which any ray is still too
/// short: what comes nearer is met by fewer of them, for a cloud is thinned.
void Lookout::count(std::size_t number, base::Time seen, base::Time now) {
  const nav::sense::Reduced& in = chain_.last();
  nav::sense::rays_of(in, rays_, fan_);
  const nav::sense::Counted c = nav::sense::count_rays(fan_, rays_);
  if (!c.stop) {
    const bool sees = chain_.health(number, now).eye != nav::sense::Eye::Blind;
    if (sees && c.rays == 0) counted_[number].reset();
    return;
  }
  const double x_m = double(in.origin_m[0] + c.nearest_m * std::cos(c.nearest_rad));
  const double y_m = double(in.origin_m[1] + c.nearest_m * std::sin(c.nearest_rad));
  const nav::sense::Pose2 met = in.pose * nav::sense::Pose2{x_m, y_m, 0.0};
  RaysStop stop;
  stop.sensor = static_cast<std::uint8_t>(number);
  stop.rays = c.rays;
  stop.at = {met.x_m, met.y_m};
  stop.seen = seen;
  counted_[number] = {c.nearest_m, stop};
}

/// Before they say stop: of the same fan, so far. Here, too, who does not see clears nothing.
void Lookout::near(std::size_t number, base::Time seen, base::Time now) {
  const nav::sense::Reduced& in = chain_.last();
  const nav::sense::Nearing n = nav::sense::nearing(fan_, rays_, ranges_);
  if (!n.slows) {
    if (chain_.health(number, now).eye != nav::sense::Eye::Blind) nears_[number].reset();
    return;
  }
  const double x_m = double(in.origin_m[0] + n.nearest_m * std::cos(n.nearest_rad));
  const double y_m = double(in.origin_m[1] + n.nearest_m * std::sin(n.nearest_rad));
  const nav::sense::Pose2 met = in.pose * nav::sense::Pose2{x_m, y_m, 0.0};
  RaysStop ahead;
  ahead.sensor = static_cast<std::uint8_t>(number);
  ahead.rays = n.rays;
  ahead.at = {met.x_m, met.y_m};
  ahead.seen = seen;
  ahead.way_m = static_cast<double>(n.way_m);
  ahead.from = {in.pose.x_m, in.pose.y_m};
  nears_[number] = ahead;
}

/// One whose sensor sees goes before one that is lost, the nearest first.
void Lookout::tell_rays(Surroundings& out, base::Time now) {
  const auto sees = [&out](std::size_t i) {
    const base::SensorHealth h = (*out.sensors)[i].health;
    return h == base::SensorHealth::Good || h == base::SensorHealth::Degraded;
  };
  bool any_sees = false;
  for (std::size_t i = 0; i < counted_.size(); ++i) any_sees = any_sees || sees(i);
  const nav::sense::Pose2 body = inverse(history_.newest().pose);
  const auto lost = [&](std::size_t i, const RaysStop& stop) {
    return any_sees && !sees(i) && !chain_.sensor(i).needed &&
           base::seconds(now - stop.seen) > free_for_s_[i];
  };
  const auto in_body = [&](const RaysStop& stop) {
    return body * nav::sense::Pose2{stop.at.x, stop.at.y, 0.0};
  };
  float nearest_m = 0.0F;
  for (std::size_t i = 0; i < counted_.size(); ++i) {
    auto& one = counted_[i];
    if (!one) continue;
    one->stop.lost = lost(i, one->stop);
    if (one->stop.lost) {
      const nav::sense::Pose2 at = in_body(one->stop);
      const bool left = std::hypot(at.x_m, at.y_m) > rays_.far_as_m;
      if (left) one.reset();
      // Behind it holds nobody who drives ahead; but who turns comes to face it again.
      if (left || at.x_m < 0.0) continue;
    }
    const bool nearer = !out.rays || (out.rays->lost && !one->stop.lost) ||
                        (out.rays->lost == one->stop.lost && one->nearest_m < nearest_m);
    if (!nearer) continue;
    out.rays = one->stop;
    nearest_m = one->nearest_m;
  }
  for (std::size_t i = 0; i < nears_.size(); ++i) {
    auto& one = nears_[i];
    if (one && lost(i, *one)) one.reset();
    if (one && (!out.rays_ahead || one->way_m < out.rays_ahead->way_m)) out.rays_ahead = one;
  }
}

std::shared_ptr<const Surroundings> Lookout::picture(base::Time now) {
  take_waiting(now);
  const bool due = !told_ || base::seconds(now - *told_) >= kTellAnyway_s;
  if ((!news_ && !due) || history_.empty()) return nullptr;
  auto out = std::make_shared<Surroundings>();
  auto sensors = std::make_shared<std::vector<base::SensorState>>();
  for (std::size_t i = 0; i < chain_.sensors(); ++i) {
    const nav::sense::SensorSetup& setup = chain_.sensor(i);
    const nav::sense::Fitness fit = chain_.health(i, now);
    base::SensorState s;
    s.name = setup.name;
    s.kind = kinds_[i];
    s.required = setup.needed;
    s.health = health_of(fit.eye, !last_[i].seen || fit.age_s > setup.health.silent_s);
    s.reason = fit.reason;
    s.window = fit.window;
    s.seen = last_[i].seen;
    s.rate_hz = fit.rate_hz;
    s.unknown_part = fit.unknown_part;
    s.refused = fit.refused;
    s.points = last_[i].points;
    const double pieces_s = kMissed / std::max(0.1, setup.health.rate_hz);
    // What it saw free is not vouched for any more, however fresh the others are.
    const bool sees =
        s.health == base::SensorHealth::Good || s.health == base::SensorHealth::Degraded;
    free_for_s_[i] = sees ? kAsKept_s : std::max(setup.health.silent_s, pieces_s);
    s.mount = setup.mount;
    if (s.seen && (!out->seen || *s.seen > *out->seen)) out->seen = s.seen;
    out->lasts_s = std::max(out->lasts_s, pieces_s);
    sensors->push_back(std::move(s));
  }
  chain_.grid().patch(history_.newest().pose, reach_m_, now, out->patch, free_for_s_);
  out->marks.mark(out->patch);
  chain_.movers(now, out->movers);
  out->sensors = std::move(sensors);
  if (finder_ && finder_->view()) out->row = RowSeen{row_.id, *finder_->view()};
  out->beside = beside_;
  if (rays_.enabled) tell_rays(*out, now);
  news_ = false;
  told_ = now;
  return out;
}

std::shared_ptr<const Outlook> Lookout::outlook(const OutlookParams& params, base::Time now) const {
  if (history_.empty()) return nullptr;
  auto out = std::make_shared<Outlook>(outlook_of(chain_, scans_, history_.newest(), params, now));
  tell_marks(*out, beside_.get(), images_);
  return out;
}

}  // namespace roverd::robot
