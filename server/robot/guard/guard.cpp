#include "robot/guard/guard.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/angle.hpp"
#include "nav/sense/foresee.hpp"

namespace roverd::robot {
namespace {

using base::BodyTwist;
using nav::sense::Limit;

constexpr double kPicture_s = 0.5;    // older, and whoever makes them stands still
constexpr double kLean_s = 0.15;      // older, and the body may lie otherwise by now
constexpr double kAside_mps = 1.0;    // faster aside is no slide and no turn
constexpr double kMost_mps = 50.0;    // what is measured to be faster is none of ours: the pose
constexpr double kMost_radps = 50.0;  // must stay where cells can be counted
constexpr double kLeast_mps = 0.05;   // slower, and it stands
constexpr double kLeast_radps = 0.05;
constexpr double kProbe_mps = 0.15;  // what a stopped drive tries
constexpr double kProbe_radps = 0.15;
constexpr double kAsk_s = 3.0;     // so often a stopped drive is asked anew,
constexpr double kAskFor_s = 1.0;  // for so long: it first makes sure that it stands
constexpr double kHandTurns_radps = 0.3;
constexpr double kWishless_s = 0.5;
constexpr double kDockIs_m = 0.3;  // what stands within this beyond the vehicle's end, docked
constexpr double kDockLeast_mps = 0.06;
constexpr double kFollows_m = 0.02;
constexpr double kHis_m = 0.3;          // what stands this near to somebody who moves is he
constexpr double kTurnsRound_m = 0.06;  // so that a way around, too, may begin with a turn

bool stands(const BodyTwist& t) noexcept {
  return std::abs(t.linear_mps) < 1e-6 && std::abs(t.angular_radps) < 1e-6;
}

BodyTwist times(const BodyTwist& t, double part) noexcept {
  return {t.linear_mps * part, t.angular_radps * part};
}

/// The same curve, so slowly as it is tried.
BodyTwist probe_of(const BodyTwist& wanted) noexcept {
  const double v = std::abs(wanted.linear_mps);
  const double w = std::abs(wanted.angular_radps);
  const double part = std::max(v / kProbe_mps, w / kProbe_radps);
  return part > 1e-6 ? times(wanted, 1.0 / part) : wanted;
}

/// Of the twist, at a hand's creep speed.
double creeps_part(const BodyTwist& twist, const nav::sense::ProtectParams& params) noexcept {
  const double v = std::abs(twist.linear_mps);
  const double w = std::abs(twist.angular_radps);
  const double by_way = v > 1e-6 ? params.creep_mps / v : 1.0;
  const double by_turn = w > 1e-6 ? params.creep_turn_radps / w : 1.0;
  return std::min({1.0, by_way, by_turn});
}

/// Within 45 degrees, of how the body goes and how its corners turn about it.
bool same_way(const BodyTwist& a, const BodyTwist& b, double reach_m) noexcept {
  const double aw = a.angular_radps * reach_m;
  const double bw = b.angular_radps * reach_m;
  const double both = std::hypot(a.linear_mps, aw) * std::hypot(b.linear_mps, bw);
  return a.linear_mps * b.linear_mps + aw * bw > std::sqrt(0.5) * both;
}

bool too_slow(const BodyTwist& t) noexcept {
  return std::abs(t.linear_mps) < kLeast_mps && std::abs(t.angular_radps) < kLeast_radps;
}

/// What one would set otherwise where it stops for this; empty: there is no such thing.
std::string_view key_of(const base::Obstacle& o, bool foreseen, bool may_turn,
                        const BodyTwist& wanted, double reach_m) noexcept {
  if (o.action != base::GuardAction::Stop) return {};
  if (o.what == "drop") return "sense.ground.drop_m";
  if (o.moves && may_turn) return "sense.protect.turn_part";
  if (o.moves && foreseen) return "sense.protect.foresee_s";
  if (o.what != "unseen") return {};
  const double v = wanted.linear_mps;
  if (std::abs(v) < 0.2 * std::abs(wanted.angular_radps) * reach_m) {
    return "sense.protect.creep_turn_radps";
  }
  return v < 0.0 ? "sense.protect.creep_back_mps" : "sense.protect.creep_mps";
}

/// @param room_m between the body and it
std::string sentence(const base::Obstacle& o, bool may_turn, double room_m) {
  char text[160];
  const double deg = base::deg_from_rad(o.bearing_rad);
  if (o.what == "blind") {
    return "nothing is seen any more: the picture of the surroundings is too old";
  }
  const char* side = deg > 0.0 ? "to the left" : "to the right";
  const bool front = std::abs(deg) < 75.0;
  const bool back = std::abs(deg) > 105.0;
  std::string where = front ? "ahead" : back ? "behind" : "";
  if (std::abs(deg) > 15.0 && std::abs(deg) < 165.0) {
    where += (where.empty() ? "" : ", ") + std::string(side);
  }
  const char* what = o.what == "drop"     ? "the ground ends"
                     : o.what == "unseen" ? "no sensor has seen the way"
                     : may_turn           ? "somebody near may turn this way"
                     : o.moves            ? "somebody comes into the way"
                                          : "something stands in the way";
  std::snprintf(text, sizeof text, "%s, %.1f m %s%s%s", what, room_m, where.c_str(),
                o.sensor.empty() ? "" : ", seen by ", o.sensor.c_str());
  return text;
}

}  // namespace

void Guard::set(const nav::sense::ProtectParams& params, const nav::VehicleParams& vehicle,
                bool demands, const BlockedParams& blocked, const nav::ToolParams& tool,
                const OutlineParams& outline, const nav::sense::RaysParams& rays) {
  sees_ = true;
  demands_ = demands;
  body_ = footprint_of(vehicle, tool, outline);
  trailer_ = trailer_of(tool, outline);
  coupling_ = {};
  whole_.reset();
  if (trailer_) {
    std::vector<nav::sense::Vec2> corners(body_.corners().begin(), body_.corners().end());
    for (const nav::sense::Vec2 c : trailer_->body.corners()) {
      corners.push_back({c.x - trailer_->hitch_m, c.y});
    }
    if (const auto hull = nav::sense::Footprint::of(corners)) whole_ = *hull;
  }
  swings_m_.reset();
  if (!vehicle.steered()) {
    double front_m = 0.0;
    double swings_m = 0.0;  // of what is ahead of the origin: it turns towards what stands there
    for (const nav::sense::Vec2 c : body_.corners()) {
      front_m = std::max(front_m, c.x);
      if (c.x > 0.0) swings_m = std::max(swings_m, std::hypot(c.x, c.y));
    }
    swings_m_ = swings_m - front_m;
  }
  change(params, blocked, rays);
}

void Guard::change(const nav::sense::ProtectParams& params, const BlockedParams& blocked,
                   const nav::sense::RaysParams& rays) {
  params_ = params;
  rays_ = rays;
  blocked_.set(blocked);
  decel_set_mps2_ = params.decel_mps2;
  // Where it stopped it must still be able to turn away.
  if (swings_m_) {
    params_.gap_m = std::max(params_.gap_m, *swings_m_ + params_.side_m + kTurnsRound_m);
  }
}

std::shared_ptr<const Surroundings> Guard::take(std::shared_ptr<const Surroundings> news) noexcept {
  return std::exchange(around_, std::move(news));
}

void Guard::brake_by(double decel_mps2) noexcept {
  params_.decel_mps2 = std::clamp(decel_mps2, 0.05, decel_set_mps2_);
}

bool Guard::too_old(base::Time now) const noexcept {
  return !around_ || !around_->seen || base::seconds(now - *around_->seen) > around_->lasts_s ||
         base::seconds(now - around_->patch.stamp) > kPicture_s;
}

const nav::sense::Odometry& Guard::move(const BodyTwist& measured, base::Time now,
                                        const std::optional<base::Attitude>& lean,
                                        double left_mps) noexcept {
  const double dt_s = began_ ? base::seconds(now - odometry_.stamp) : 0.0;
  const bool usable = std::isfinite(measured.linear_mps) && std::isfinite(measured.angular_radps);
  const BodyTwist t = usable
                          ? BodyTwist{std::clamp(measured.linear_mps, -kMost_mps, kMost_mps),
                                      std::clamp(measured.angular_radps, -kMost_radps, kMost_radps)}
                          : BodyTwist{};
  const double aside_mps =
      std::isfinite(left_mps) ? std::clamp(left_mps, -kAside_mps, kAside_mps) : 0.0;
  if (dt_s > 0.0 && dt_s < 1.0) {
    odometry_.pose =
        odometry_.pose * nav::sense::along(t.linear_mps, aside_mps, t.angular_radps, dt_s);
    if (trailer_) coupling_.drive(*trailer_, t, dt_s);
  }
  if (lean && std::isfinite(lean->roll_rad + lean->pitch_rad)) {
    odometry_.lie.roll_rad = lean->roll_rad;
    odometry_.lie.pitch_rad = lean->pitch_rad;
    odometry_.lie.told = base::seconds(now - lean->stamp) <= kLean_s;
    if (dt_s > 0.0 && dt_s < 1.0) {
      odometry_.lie.z_m += std::sin(lean->pitch_rad) * t.linear_mps * dt_s;
    }
  } else {
    odometry_.lie.roll_rad = odometry_.lie.pitch_rad = 0.0;
    odometry_.lie.told = false;
  }
  began_ = true;
  odometry_.stamp = now;
  odometry_.v_mps = t.linear_mps;
  odometry_.left_mps = aside_mps;
  odometry_.yaw_rate_radps = t.angular_radps;
  lately_.move(odometry_, dt_s);
  return odometry_;
}

/// A person who drives sees what no sensor does, and may always creep away.
nav::sense::ProtectParams Guard::params_of(bool by_itself) const noexcept {
  nav::sense::ProtectParams p = params_;
  // A way that was found to be clear bends past what stands there: each of its bends, driven on and
  // on, would lead into that. It still stops before, only nearer.
  if (by_itself && follows_) p.gap_m = std::min(p.gap_m, p.side_m + kFollows_m);
  if (by_itself) return p;
  p.creep_back_mps = std::max(p.creep_back_mps, p.creep_mps);
  p.creep_turn_radps = std::max(p.creep_turn_radps, kHandTurns_radps);
  return p;
}

Guard::Looked Guard::look(const BodyTwist& twist, bool by_itself, base::Time now) const noexcept {
  Looked v;
  const nav::sense::ProtectParams params = params_of(by_itself);
  if (!too_old(now)) {
    const bool counts = rays_.enabled && !spared_;
    const bool ahead = counts && twist.linear_mps > 0.0;
    if (ahead && around_->rays && !around_->rays->lost) {
      v = told_by(*around_->rays, rays_.stop_m);
      v.part = 0.0;
      return v;
    }
    if (counts && rays_.instead) {
      if (ahead && around_->rays) v = look_where_lost(twist, params);
      if (ahead) look_along_rays(v, twist, params);
      return v;
    }
    v = {protect(around_->patch, odometry_.pose, body_, twist, params,
                 spared_ ? &*spared_ : nullptr, &around_->marks)};
    look_where_it_skids(v, twist, params);
    look_behind(v, twist, params);
    if (ahead) look_along_rays(v, twist, params);
    look_ahead_of_time(v, twist, by_itself, params);
    return v;
  }
  // Nothing is known: as if the very next step were unseen.
  const bool ahead = twist.linear_mps > 0.0;
  const double most_mps = ahead ? params.creep_mps : params.creep_back_mps;
  const double by_way =
      std::abs(twist.linear_mps) > 1e-6 ? most_mps / std::abs(twist.linear_mps) : 1.0;
  const bool spot = std::abs(twist.linear_mps) < kLeast_mps;
  const double by_turn = spot && std::abs(twist.angular_radps) > 1e-6
                             ? params.creep_turn_radps / std::abs(twist.angular_radps)
                             : 1.0;
  v.part = std::clamp(std::min(by_way, by_turn), 0.0, 1.0);
  v.limit = Limit::Unseen;
  v.found = true;
  return v;
}

/// Nothing else knows what a lost sensor stopped for, as long as no other one has seen that place
/// free; and then the rest of it may stand there yet.
Guard::Looked Guard::look_where_lost(const BodyTwist& twist,
                                     const nav::sense::ProtectParams& params) const noexcept {
  const nav::sense::Patch& patch = around_->patch;
  const nav::sense::Vec2 at = around_->rays->at;
  const auto cell = [&patch](double m) {
    return static_cast<std::int32_t>(std::floor(m / patch.cell_m));
  };
  if (patch.at(cell(at.x), cell(at.y)).known == nav::sense::Known::Free) {
    return {protect(patch, odometry_.pose, body_, twist, params, nullptr, &around_->marks)};
  }
  Looked v = told_by(*around_->rays, rays_.stop_m);
  v.part = 0.0;
  v.lost = true;
  return v;
}

/// Who moves: before he is in the way; and who is in it, is known to go.
void Guard::look_ahead_of_time(Looked& v, const BodyTwist& twist, bool by_itself,
                               const nav::sense::ProtectParams& params) const noexcept {
  if (around_->movers.empty() || params.foresee_s <= 0.0) return;
  nav::sense::Foreseen f = nav::sense::foresee(around_->movers, odometry_, body_, twist, params,
                                               whole_ ? &*whole_ : nullptr);
  // A person who drives may always creep away: also from who walks beside it, often himself.
  if (!by_itself) f.part = std::max(f.part, std::min(f.unless_left, creeps_part(twist, params)));
  if (f.part < v.part) {
    v = {};
    v.part = f.part;
    v.limit = Limit::Obstacle;
    v.found = true;
    v.touch_s = f.meets_s;
    v.distance_m = f.may_turn ? f.room_m : std::abs(twist.linear_mps) * f.meets_s;
    v.at = f.at;
    v.radius_m = f.radius_m;
    v.bearing_rad = std::atan2(f.at.y, f.at.x);
    v.sensor = f.sensor;
    v.age_s = f.age_s;
    v.moves = true;
    v.foreseen = true;
    v.may_turn = f.may_turn;
    return;
  }
  if (v.limit != Limit::Obstacle) return;
  const nav::sense::Pose2 at = odometry_.pose * nav::sense::Pose2{v.at.x, v.at.y, 0.0};
  for (const nav::sense::Mover& m : around_->movers) {
    const double age_s = base::seconds(odometry_.stamp - m.seen);
    const nav::sense::Vec2 his = m.at + age_s * m.v_mps;
    if (std::hypot(his.x - at.x_m, his.y - at.y_m) < m.radius_m + kHis_m) v.moves = true;
  }
}

/// A dock is come to so slowly that it does not skid.
void Guard::look_where_it_skids(Looked& v, const BodyTwist& twist,
                                const nav::sense::ProtectParams& params) const noexcept {
  if (spared_) return;
  const nav::sense::Verdict skids = protect_skidding(around_->patch, odometry_.pose, body_, twist,
                                                     lately_, !swings_m_, params, &around_->marks);
  const bool tells = v.limit == Limit::None && skids.limit != Limit::None;
  if (skids.part < v.part || tells) v = {skids};
}

/// What is pulled cuts corners, and swings out.
void Guard::look_behind(Looked& v, const BodyTwist& twist,
                        const nav::sense::ProtectParams& params) const noexcept {
  if (!trailer_) return;
  const nav::sense::Verdict behind = protect_trailer(around_->patch, odometry_.pose, *trailer_,
                                                     coupling_, twist, params, &around_->marks);
  if (behind.part >= v.part) return;
  v = {behind};
  v.trailer = true;
}

/// In proportion, before the rays say stop; and slowly, where one said so that sees no more.
void Guard::look_along_rays(Looked& v, const BodyTwist& twist,
                            const nav::sense::ProtectParams& params) const noexcept {
  if (around_->rays_ahead) {
    const RaysStop& near = *around_->rays_ahead;
    const nav::sense::Pose2& here = odometry_.pose;
    const double driven_m = std::hypot(here.x_m - near.from.x, here.y_m - near.from.y);
    const double way_m = std::max(0.0, near.way_m - driven_m);
    const double part = nav::sense::part_for(way_m / twist.linear_mps, twist, params);
    if (part < v.part) {
      v = told_by(near, rays_.slow_m);
      v.part = part;
      v.distance_m = way_m;
    }
  }
  if (!around_->rays || !around_->rays->lost) return;
  const double part = std::min(1.0, params.creep_mps / twist.linear_mps);
  if (part >= v.part) return;
  v = told_by(*around_->rays, rays_.stop_m);
  v.part = part;
  v.limit = Limit::Unseen;
  v.lost = true;
}

Guard::Looked Guard::told_by(const RaysStop& stop, double within_m) const noexcept {
  const nav::sense::Pose2 at =
      inverse(odometry_.pose) * nav::sense::Pose2{stop.at.x, stop.at.y, 0.0};
  Looked v;
  v.within_m = within_m;
  v.limit = Limit::Obstacle;
  v.found = true;
  v.at = {at.x_m, at.y_m};
  v.bearing_rad = std::atan2(at.y_m, at.x_m);
  v.sensor = stop.sensor;
  v.age_s = base::seconds(around_->patch.stamp - stop.seen);
  v.rays = stop.rays;
  return v;
}

BodyTwist Guard::judge(const BodyTwist& wanted, bool by_itself, base::Time now) {
  limit_mps_ = 1e9;
  if (!sees_) return wanted;
  if (stands(wanted)) {
    // A hand that let go, or a drive that is done, waits for nothing.
    if (!wishless_since_) wishless_since_ = now;
    const bool wants_nothing = base::seconds(now - *wishless_since_) > kWishless_s;
    if (stopped_since_ && (!by_itself || wants_nothing)) forget();
    if (!stopped_since_) obstacle_ = {};
    return wanted;
  }
  wishless_since_.reset();
  wanted_ = wanted;
  if (stopped_since_ && by_itself) return {};  // asked, and held until the way has been clear
  const Looked v = look(wanted, by_itself, now);
  BodyTwist out = times(wanted, v.part);
  if (v.limit != Limit::None && too_slow(out)) {
    out = {};
    held_ = wanted;
    clear_since_.reset();
    if (!stopped_since_) {
      stopped_since_ = now;
      asked_ = now - base::from_seconds(kAskFor_s);
      news_ = true;
    }
    tell(v, base::GuardAction::Stop, now);
    return out;
  }
  if (stopped_since_ && !by_itself) {
    // A hand that draws back is let go at once; one that still wants the same waits as a drive by
    // itself does (may_go_on): who stepped out of the way may step back.
    if (!clear_since_) clear_since_ = now;
    const bool waits = base::seconds(now - *clear_since_) < blocked_.params().clear_s;
    if (waits && same_way(wanted, held_, body_.reach_m())) return {};
    stopped_since_.reset();
    clear_since_.reset();
    news_ = false;
  }
  if (v.limit == Limit::None) {
    obstacle_ = {};
    return out;
  }
  const bool creeps = v.limit == Limit::Unseen;
  tell(v, creeps ? base::GuardAction::Creep : base::GuardAction::Slow, now);
  limit_mps_ = std::abs(out.linear_mps);
  return out;
}

BodyTwist Guard::overrule(const BodyTwist& wanted, base::Time now) {
  const BodyTwist kept = judge(wanted, false, now);
  if (!sees_ || stands(wanted) || obstacle_.action == base::GuardAction::None) return kept;
  const double fastest =
      std::abs(wanted.linear_mps) + std::abs(wanted.angular_radps) * body_.reach_m();
  const BodyTwist least = times(wanted, std::min(1.0, params_.override_mps / fastest));
  const bool enough = std::abs(kept.linear_mps) >= std::abs(least.linear_mps) &&
                      std::abs(kept.angular_radps) >= std::abs(least.angular_radps);
  if (enough) return kept;
  obstacle_.action = base::GuardAction::Overridden;
  obstacle_.stopped_since.reset();
  stopped_since_.reset();
  news_.reset();  // the hand knows
  limit_mps_ = params_.override_mps;
  return least;
}

bool Guard::may_go_on(base::Time now) {
  if (!stopped_since_ || clear_long_enough(now)) return true;
  const double since_s = base::seconds(now - asked_);
  if (since_s >= kAsk_s) {
    asked_ = now;
    wishless_since_.reset();
  }
  return since_s >= kAsk_s || since_s < kAskFor_s;
}

void Guard::spare_dock(const std::optional<nav::sense::Pose2>& docked, bool reverse) noexcept {
  spared_.reset();
  if (!docked || std::hypot(docked->x_m, docked->y_m) > params_.dock_m) return;
  double end_m = 0.0;
  double side_m = 0.0;
  for (const nav::sense::Vec2 corner : body_.corners()) {
    if (reverse ? corner.x < end_m : corner.x > end_m) end_m = corner.x;
    side_m = std::max(side_m, std::abs(corner.y));
  }
  const double c = std::cos(docked->yaw_rad);
  const double s = std::sin(docked->yaw_rad);
  const auto place = [&](double y) {
    return nav::sense::Vec2{docked->x_m + c * end_m - s * y, docked->y_m + s * end_m + c * y};
  };
  // Slower than it can be driven it would not be come to.
  const double most_mps = std::max(params_.override_mps, kDockLeast_mps);
  const nav::sense::Vec2 ahead = reverse ? nav::sense::Vec2{-c, -s} : nav::sense::Vec2{c, s};
  spared_ = nav::sense::Spared{place(-side_m), place(side_m), kDockIs_m, ahead, most_mps};
}

std::optional<Then> Guard::decide(bool by_itself, base::Time now) noexcept {
  // Who moves is waited for: no way is looked for around him.
  const bool solid = (obstacle_.what == "obstacle" && !obstacle_.moves) || obstacle_.what == "drop";
  const auto what_then = blocked_.step(by_itself && stops(), solid, odometry_.pose, now);
  const bool stop = obstacle_.action == base::GuardAction::Stop;
  if (!stop) why_.clear();
  if (obstacle_.action == base::GuardAction::None) {
    limits_since_.reset();
    return what_then;
  }
  if (!limits_since_ || stop != limits_by_stop_) limits_since_ = now;
  limits_by_stop_ = stop;
  if (stop && (why_.empty() || why_what_ != obstacle_.what)) {
    why_ = obstacle_.reason;
    why_what_ = obstacle_.what;
  }
  obstacle_.since = limits_since_;
  obstacle_.blocked = blocked_.blocked();
  obstacle_.then = by_itself ? to_string(blocked_.then()) : std::string_view{};
  obstacle_.decides_at = blocked_.decides_at();
  return what_then;
}

bool Guard::clear_long_enough(base::Time now) {
  const BodyTwist probe = probe_of(wanted_);
  const Looked v = look(probe, true, now);
  const BodyTwist out = times(probe, v.part);
  if (v.limit != Limit::None && too_slow(out)) {
    clear_since_.reset();
    tell(v, base::GuardAction::Stop, now);
    return false;
  }
  if (!clear_since_) clear_since_ = now;
  if (base::seconds(now - *clear_since_) < blocked_.params().clear_s) return false;
  stopped_since_.reset();
  clear_since_.reset();
  news_ = false;
  obstacle_ = {};
  return true;
}

void Guard::forget() noexcept {
  blocked_.forget();
  why_.clear();
  limits_since_.reset();
  spared_.reset();
  news_.reset();  // that the way is clear was not seen
  stopped_since_.reset();
  clear_since_.reset();
  wanted_ = {};
  limit_mps_ = 1e9;
  obstacle_ = {};
}

/// Between the body and what limits it; of what the trailer would touch, how far it is from the
/// origin: where the trailer is, is known less well.
double Guard::room_m(const Looked& v) const noexcept {
  if (v.trailer) return std::hypot(v.at.x, v.at.y);
  const nav::sense::Footprint& body = v.may_turn && whole_ ? *whole_ : body_;
  return std::max(0.0, body.distance_m(v.at) - v.radius_m);
}

void Guard::tell(const Looked& v, base::GuardAction action, base::Time now) {
  const bool old = too_old(now);
  obstacle_.action = action;
  obstacle_.what = old ? "blind" : nav::sense::to_string(v.limit);
  obstacle_.moves = v.moves && !old;
  obstacle_.distance_m = v.distance_m;
  obstacle_.bearing_rad = v.bearing_rad;
  obstacle_.ahead_m = v.at.x;
  obstacle_.left_m = v.at.y;
  obstacle_.sensor.clear();
  if (!old && v.limit != Limit::Unseen && v.sensor < around_->sensors->size()) {
    obstacle_.sensor = (*around_->sensors)[v.sensor].name;
  }
  obstacle_.age_s = v.age_s + (around_ ? base::seconds(now - around_->patch.stamp) : 0.0);
  obstacle_.stopped_since = stopped_since_;
  obstacle_.reason = sentence(obstacle_, v.may_turn, room_m(v));
  // Who may help: a person who sees it, or whoever sets how the robot goes there.
  const auto key = key_of(obstacle_, v.foreseen, v.may_turn, wanted_, body_.reach_m());
  if (!key.empty()) {
    const bool unseen = obstacle_.what == "unseen";
    obstacle_.reason += unseen ? ": drive it by hand, or let it creep there (" : " (";
    obstacle_.reason += std::string(key) + ")";
  }
  if (v.trailer) obstacle_.reason += ": the trailer would touch it";
  if (v.lost && v.sensor < around_->sensors->size()) {
    obstacle_.reason +=
        ": " + (*around_->sensors)[v.sensor].name + " saw something, and sees no more";
  } else if (v.rays > 0) {
    char text[64];
    const bool stops = action == base::GuardAction::Stop;
    std::snprintf(text, sizeof text, ": %d rays shorter than %.2f m (sense.rays.%s)", v.rays,
                  v.within_m, stops ? "stop_m" : "slow_m");
    obstacle_.reason += text;
  }
}

}  // namespace roverd::robot
