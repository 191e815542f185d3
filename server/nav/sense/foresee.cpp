#include "nav/sense/foresee.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "base/angle.hpp"
#include "nav/sense/sweep.hpp"

namespace roverd::nav::sense {

namespace {

constexpr std::array kParts{1.0, 0.8, 0.6, 0.4, 0.2, 0.0};
constexpr double kLookEvery_s = 0.075;
constexpr double kFarthest_s = 10.0;   // nobody goes straight on for longer; bounds the tick
constexpr double kMostUnsure_m = 0.4;  // what is known of him, is known better than this
constexpr double kComesNearer_m = 0.01;
constexpr std::size_t kMostOf = 16;
constexpr double kTold_s = 0.35;     // from a turn of his until it is told
constexpr double kFollows_m = 0.3;   // beside the body's width: who walks up so, comes from behind
constexpr double kTurnsAbout = 0.2;  // corners so fast, as part of the way, and it turns
constexpr double kTurns_rad = base::rad_from_deg(100.0);  // by more nobody turns while he walks

/// Of the moment, in B as it is now.
struct Foreseeable {
  Vec2 at;
  Vec2 v;
  double radius_m;
  double sigma_mps;
  double now_m;  ///< between him and the body, with what it pulls
  bool behind;   ///< of who drives away from him
};

/// How much of the twist is driven, by time.
struct Pace {
  double from = 0.0;
  double to = 0.0;
  double for_s = 0.0;    ///< before it goes over
  double brake_s = 0.0;  ///< from the whole twist to none

  /// Time of the whole twist that is driven by then.
  double driven_s(double t_s) const noexcept {
    const double over_s = std::abs(to - from) * brake_s;
    const double t = std::clamp(t_s - for_s, 0.0, over_s);
    const double bends = over_s > 0.0 ? 0.5 * (to - from) * t * t / over_s : 0.0;
    return from * (std::min(t_s, for_s) + t) + bends + to * std::max(0.0, t_s - for_s - over_s);
  }
};

/// The first moment at which he is nearer than he may be.
std::optional<double> meets(const Foreseeable& who, const Footprint& body,
                            const base::BodyTwist& twist, const Pace& pace, double gap_m,
                            double horizon_s) noexcept {
  const double now_m = body.distance_m(who.at) - who.radius_m;
  const double allowed_m = std::min(gap_m, now_m - kComesNearer_m);
  for (double t = kLookEvery_s; t <= horizon_s; t += kLookEvery_s) {
    const Vec2 seen = seen_after(who.at + t * who.v, twist, pace.driven_s(t));
    const double unsure_m = std::min(kMostUnsure_m, who.sigma_mps * t);
    if (body.distance_m(seen) - who.radius_m - unsure_m < allowed_m) return t;
  }
  return std::nullopt;
}

/// Behind who drives away from him.
bool behind(Vec2 at, double radius_m, const Footprint& body,
            const base::BodyTwist& twist) noexcept {
  const double v = twist.linear_mps;
  if (std::abs(v) < std::abs(twist.angular_radps) * body.reach_m()) return false;  // it turns
  double end = 0.0;
  for (const Vec2 c : body.corners()) end = std::min(end, v > 0.0 ? c.x : -c.x);
  return (v > 0.0 ? at.x : -at.x) + radius_m < end;
}

/// Behind who drives away from him, and no wider than its way: he runs into it himself.
bool follows(const Foreseeable& who, const Footprint& body) noexcept {
  double aside_m = 0.0;
  for (const Vec2 c : body.corners()) aside_m = std::max(aside_m, std::abs(c.y));
  return who.behind && std::abs(who.at.y) - who.radius_m < aside_m + kFollows_m;
}

/// How fast he comes nearer who turns towards the body now, as far as anybody does.
double nears_if_he_turns_mps(const Foreseeable& who, const Footprint& body) noexcept {
  constexpr double kStep_s = 0.01;
  const double his_mps = std::hypot(who.v.x, who.v.y);
  if (his_mps <= 0.0) return 0.0;
  const double gains_m = body.distance_m(who.at + kStep_s * who.v) - body.distance_m(who.at);
  const double off_rad = std::acos(std::clamp(-gains_m / (kStep_s * his_mps), -1.0, 1.0));
  return his_mps * std::cos(std::max(0.0, off_rad - kTurns_rad));
}

/// How fast the whole twist brings the body nearer to where he is; negative: it leaves him.
double nears_mps(const Foreseeable& who, const Footprint& body,
                 const base::BodyTwist& twist) noexcept {
  constexpr double kStep_s = 0.01;
  return (body.distance_m(who.at) - body.distance_m(seen_after(who.at, twist, kStep_s))) / kStep_s;
}

/// Of the twist, so that it stands before he is there: f(λ) = a λ² + b λ + c <= 0.
/// @param his_mps towards it @param its_mps towards him, at λ = 1
double part_if_he_turns(const Foreseeable& who, double his_mps, double its_mps, double brake_s,
                        const ProtectParams& params) noexcept {
  const double waits_s = kTold_s + params.delay_s;
  const double a = 0.5 * its_mps * brake_s;
  const double b = its_mps * waits_s + his_mps * brake_s;
  const double c = his_mps * waits_s + params.side_m - who.now_m;
  if (c >= 0.0) return 0.0;
  if (a + b + c <= 0.0) return 1.0;
  // Begins below zero and ends above it: of its roots the first is within.
  return -2.0 * c / (b + std::sqrt(std::max(0.0, b * b - 4.0 * a * c)));
}

}  // namespace

Foreseen foresee(std::span<const Mover> movers, const Odometry& now, const Footprint& body,
                 const base::BodyTwist& twist, const ProtectParams& params,
                 const Footprint* whole) noexcept {
  Foreseen out;
  const double v = std::abs(twist.linear_mps);
  const double w = std::abs(twist.angular_radps);
  if (movers.empty() || params.foresee_s <= 0.0 || (v < 1e-3 && w < 1e-3)) return out;
  const Footprint& all = whole != nullptr ? *whole : body;
  const Footprint& leads = twist.linear_mps < 0.0 ? all : body;  // in reverse, what is pulled
  // Slower than it is it cannot be at once. By what it does more of: the other may be none.
  const double measured = v >= w * body.reach_m() ? now.v_mps / twist.linear_mps
                                                  : now.yaw_rate_radps / twist.angular_radps;
  const double goes_on = std::max(0.0, measured);
  const double brake_s = std::max(v / params.decel_mps2, w / params.turn_decel_radps2);
  const auto horizon_s = [&](double part) {
    const double brakes_s = params.delay_s + std::max(part, goes_on) * brake_s + kLookEvery_s;
    return std::max(params.foresee_s, std::min(brakes_s, kFarthest_s));
  };
  const double fastest_mps = std::max(1.0, goes_on) * (v + w * all.reach_m());
  const double c = std::cos(now.pose.yaw_rad);
  const double s = std::sin(now.pose.yaw_rad);
  const auto in_body = [&](Vec2 p) { return Vec2{c * p.x + s * p.y, -s * p.x + c * p.y}; };
  std::array<Foreseeable, kMostOf> who;
  std::array<const Mover*, kMostOf> of{};
  std::size_t n = 0;
  for (const Mover& m : movers) {
    const double age_s = std::max(0.0, base::seconds(now.stamp - m.seen));
    const Vec2 to = m.at + age_s * m.v_mps - Vec2{now.pose.x_m, now.pose.y_m};
    Foreseeable one{in_body(to), in_body(m.v_mps), m.radius_m, m.sigma_mps, 0.0, false};
    one.behind = behind(one.at, one.radius_m, all, twist);
    if (one.behind && (params.turn_part <= 0.0 || follows(one, all))) continue;
    one.now_m = all.distance_m(one.at) - one.radius_m;
    const double most_m = (fastest_mps + std::hypot(one.v.x, one.v.y)) * horizon_s(1.0);
    if (one.now_m > most_m + params.foresee_gap_m + kMostUnsure_m) continue;
    std::size_t place = n;
    if (n == who.size()) {
      const auto farthest = std::max_element(
          who.begin(), who.end(), [](const auto& a, const auto& b) { return a.now_m < b.now_m; });
      if (farthest->now_m <= one.now_m) continue;
      place = static_cast<std::size_t>(farthest - who.begin());
    } else {
      ++n;
    }
    of[place] = &m;
    who[place] = one;
  }
  const double gap_m = std::max(params.foresee_gap_m, params.side_m);
  std::size_t found = kMostOf;
  const auto tell = [&](std::size_t i, double meets_s) {
    found = i;
    out.found = true;
    out.room_m = who[i].now_m;
    out.meets_s = meets_s;
    out.at = who[i].at;
    out.radius_m = who[i].radius_m;
    out.sensor = of[i]->sensor;
    out.age_s = base::seconds(now.stamp - of[i]->seen);
  };
  const auto may = [&](double part) {
    const Pace brake{std::max(part, goes_on), 0.0, params.delay_s, brake_s};
    // What is slower than λ is taken to be at it at once.
    const Pace keep{std::max(part, goes_on), part, params.delay_s, brake_s};
    const auto met = [&](const Foreseeable& one) -> std::optional<double> {
      if (one.behind) return std::nullopt;
      auto t = meets(one, body, twist, keep, gap_m, params.foresee_s);
      if (!t && whole != nullptr) t = meets(one, *whole, twist, keep, gap_m, params.foresee_s);
      return t;
    };
    bool keeps = part > 0.0;
    bool brakes = true;
    for (std::size_t i = 0; i < n && (keeps || brakes); ++i) {
      if (const auto t = keeps ? met(who[i]) : std::nullopt) {
        keeps = false;
        if (!out.found) tell(i, *t);
      }
      brakes = brakes && (who[i].behind ||
                          !meets(who[i], leads, twist, brake, params.side_m, horizon_s(part)));
    }
    return keeps || brakes;
  };
  for (const double part : kParts) {
    out.part = part;
    if (may(part)) break;
  }
  out.unless_left = out.part;
  const bool turns = w * all.reach_m() > kTurnsAbout * v;
  for (std::size_t i = 0; i < n && params.turn_part > 0.0; ++i) {
    const double his_mps = params.turn_part * nears_if_he_turns_mps(who[i], all);
    const double its_mps = nears_mps(who[i], all, twist);
    // In a turn the side that leaves him now is followed by one that does not.
    const double counts_mps = turns ? std::max(0.0, its_mps) : its_mps;
    const double part = part_if_he_turns(who[i], his_mps, counts_mps, brake_s, params);
    if (his_mps <= 0.0) continue;
    if (its_mps >= 0.0) out.unless_left = std::min(out.unless_left, part);
    if (part >= out.part) continue;
    out.part = part;
    if (i == found && !out.may_turn) continue;  // he comes anyhow
    out.may_turn = true;
    tell(i, std::max(0.0, who[i].now_m) / his_mps);
  }
  return out;
}

}  // namespace roverd::nav::sense
