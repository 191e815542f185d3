#include "sim/world/sensor.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

namespace roverd::sim::world {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRad = kPi / 180.0;
constexpr double kMoment_s = 1e-3;  ///< what moves is placed anew so often
constexpr double kRainReach_m = 10.0;
constexpr double kGlass_m = 0.08;  ///< dirt on the window echoes from about there
constexpr std::uint64_t kDustKey = 77;

Pose mount_of(const SensorParams& p) {
  return {p.x_m, p.y_m, p.z_m, p.roll_deg * kRad, p.pitch_deg * kRad, p.yaw_deg * kRad};
}

/// 0 .. 1: clouds some 20 degrees wide that change within a second, mostly thin.
double dust_cloud(double bearing_rad, double at_s) {
  const auto knot = [](double i, double k) {
    return share_of(spread(kDustKey +
                           static_cast<std::uint64_t>(static_cast<std::int64_t>(i)) * 7919 +
                           static_cast<std::uint64_t>(static_cast<std::int64_t>(k))));
  };
  const double x = bearing_rad / (20.0 * kRad);
  const double y = at_s / 0.8;
  const double i = std::floor(x);
  const double k = std::floor(y);
  const double u = x - i;
  const double v = y - k;
  const double below = std::lerp(knot(i, k), knot(i + 1, k), u);
  const double above = std::lerp(knot(i, k + 1), knot(i + 1, k + 1), u);
  const double thick = std::lerp(below, above, v);
  return thick * thick;
}

bool within(double bearing_rad, double from_deg, double to_deg) {
  const double width = std::fmod(to_deg - from_deg + 720.0, 360.0);
  const double off = std::fmod(bearing_rad / kRad - from_deg + 720.0, 360.0);
  return off <= width;
}

bool is_dirty(const SensorFaults& f) {
  return f.dirt_share > 0.0 && f.dirt_from_deg != f.dirt_to_deg;
}

}  // namespace

base::Result<void> check(const SensorParams& p) {
  const auto refuse = [](std::string detail) {
    return base::fail(base::Code::Invalid, std::move(detail));
  };
  if (p.kind != "lms" && p.kind != "vlp16" && p.kind != "depth" && p.kind != "range" &&
      p.kind != "vision" && p.kind != "picture") {
    return refuse("kind must be lms, vlp16, depth, range, vision or picture");
  }
  if (p.returns != "strongest" && p.returns != "last" && p.returns != "dual") {
    return refuse("returns must be strongest, last or dual");
  }
  if (p.returns != "strongest" && p.kind != "vlp16") return refuse("returns is a vlp16's");
  if (p.kind == "lms" && p.fov_to_deg < p.fov_from_deg + p.step_deg) {
    return refuse("fov_to_deg must lie at least one step_deg beyond fov_from_deg");
  }
  if (p.kind == "vlp16" && (p.rate_hz < 5.0 || p.rate_hz > 20.0)) {
    return refuse("rate_hz must lie in 5 .. 20 for a vlp16");
  }
  if (p.far_m <= p.near_m) return refuse("far_m must be larger than near_m");
  return {};
}

SensorParams usual(std::string_view kind) {
  SensorParams p;
  p.kind = std::string(kind);
  if (kind == "vlp16") {
    p.rate_hz = 10.0;
    p.near_m = 0.4;
    p.far_m = 100.0;
    p.dark_m = 60.0;
    p.sigma_m = 0.01;
    p.beam_mrad = 3.0;
    p.merge_m = 0.5;
    p.z_m = 0.8;
    p.latency_s = 0.0005;
  } else if (kind == "depth") {
    p.rate_hz = 15.0;
    p.near_m = 0.3;
    p.far_m = 8.0;
    p.dark_m = 6.0;
    p.sigma_m = 0.001;
    p.sigma_share = 0.002;
    p.dropout = 0.01;
    p.beam_mrad = 2.0;
    p.merge_m = 5.0;
    p.latency_s = 0.03;
  } else if (kind == "vision") {
    p.rate_hz = 10.0;
    p.near_m = 0.3;
    p.far_m = 8.0;
    p.dark_m = 8.0;
    p.sigma_m = 0.01;
    p.sigma_share = 0.002;
    p.beam_mrad = 0.0;
    p.columns = 120;
    p.rows = 12;
    p.latency_s = 0.1;
  } else if (kind == "picture") {
    p.rate_hz = 10.0;
    p.columns = 640;
    p.rows = 480;
    p.fov_h_deg = 70.0;
    p.latency_s = 0.03;
    p.exposure_s = 0.01;
  } else if (kind == "range") {
    p.rate_hz = 20.0;
    p.fov_h_deg = 20.0;
    p.near_m = 0.02;
    p.far_m = 4.0;
    p.dark_m = 4.0;
    p.sigma_m = 0.005;
    p.dropout = 0.01;
    p.beam_mrad = 0.0;
    p.latency_s = 0.01;
  }
  return p;
}

Sensor::Sensor(SensorParams p, std::uint64_t seed, double begin_s, int thin)
    : params_(std::move(p)),
      thin_(std::max(1, thin)),
      mount_(mount_of(params_)),
      begin_s_(begin_s) {
  if (params_.name.empty()) params_.name = params_.kind;
  key_ = spread(seed) ^ key_of(params_.name);
  period_s_ = 1.0 / params_.rate_hz;
  if (params_.kind == "vlp16") {
    prepare_vlp16();
  } else if (params_.kind == "depth" || params_.kind == "vision") {
    prepare_depth();
  } else if (params_.kind == "range") {
    prepare_range();
  } else if (params_.kind != "picture") {
    prepare_lms();
  }
}

void Sensor::add(double bearing_rad, double elevation_rad, double after_s, std::uint8_t ring) {
  const double cb = std::cos(bearing_rad);
  const double sb = std::sin(bearing_rad);
  const double ce = std::cos(elevation_rad);
  const double se = std::sin(elevation_rad);
  looks_.push_back({bearing_rad,
                    elevation_rad,
                    after_s,
                    ring,
                    {ce * cb, ce * sb, se},
                    {-sb, cb, 0.0},
                    {-se * cb, -se * sb, ce}});
}

void Sensor::prepare_lms() {
  const double from = params_.fov_from_deg;
  const auto beams = 1 + static_cast<int>((params_.fov_to_deg - from) / params_.step_deg + 1e-6);
  for (int i = 0; i < beams; ++i) {
    const double deg = i * params_.step_deg;
    add((from + deg) * kRad, 0.0, deg / 360.0 * period_s_, 0);
  }
}

void Sensor::prepare_vlp16() {
  period_s_ = kVlpFirings * kVlpFiring_s;
  turn_vlp16();
}

/// Lasers fire in the order of the device: −15, 1, −13, 3 … The head turns clockwise.
void Sensor::turn_vlp16() {
  looks_.clear();
  const double rate_radps = 2.0 * kPi * params_.rate_hz;
  for (int firing = 0; firing < kVlpFirings; firing += thin_) {
    for (int laser = 0; laser < 16; ++laser) {
      const auto ring = static_cast<std::uint8_t>(laser % 2 == 0 ? laser / 2 : 8 + laser / 2);
      const double after_s = firing * kVlpFiring_s + laser * kVlpShot_s;
      add(-(azimuth_rad_ + rate_radps * after_s), kRings_deg[ring] * kRad, after_s, ring);
    }
  }
}

void Sensor::prepare_depth() {
  const double half_h = std::tan(params_.fov_h_deg * kRad / 2.0);
  const double half_v = std::tan(params_.fov_v_deg * kRad / 2.0);
  for (int row = 0; row < params_.rows; ++row) {
    const double up = half_v * (1.0 - (2.0 * row + 1.0) / params_.rows);
    for (int column = 0; column < params_.columns; ++column) {
      const double left = half_h * (1.0 - (2.0 * column + 1.0) / params_.columns);
      add(std::atan(left), std::atan2(up, std::hypot(1.0, left)), 0.0,
          static_cast<std::uint8_t>(std::min(row, 255)));
    }
  }
}

/// The cone as a bundle of rays; fold_cone keeps the nearest.
void Sensor::prepare_range() {
  constexpr int kRound = 12;
  add(0.0, 0.0, 0.0, 0);
  for (int circle = 1; circle <= 3; ++circle) {
    const double off = params_.fov_h_deg * kRad / 2.0 * circle / 3.0;
    for (int i = 0; i < kRound; ++i) {
      const double around = 2.0 * kPi * i / kRound;
      add(off * std::cos(around), off * std::sin(around), 0.0, 0);
    }
  }
}

void Sensor::skip_to(double at_s) noexcept {
  while (next_s() <= at_s) {
    begin_s_ += period_s_;
    ++count_;
  }
}

void Sensor::sweep(const Scene& scene, const PoseAt& pose_at, const SensorFaults& faults,
                   Sweep& out) {
  out.at_s = begin_s_;
  out.until_s = begin_s_ + (looks_.empty() ? 0.0 : looks_.back().after_s);
  out.count = count_++;
  out.dirty = 0.0F;
  out.blocked = false;
  if (is_dirty(faults)) {
    const double width = std::fmod(faults.dirt_to_deg - faults.dirt_from_deg + 720.0, 360.0);
    out.dirty = static_cast<float>(width / 360.0 * faults.dirt_share);
    out.blocked = faults.dirt_share >= 1.0;
  }
  out.shots.clear();
  double placed_s = -1.0;
  double framed_s = -1.0;
  Frame sensor;
  for (const Look& look : looks_) {
    const double at_s = begin_s_ + look.after_s;
    // 16 lasers within 35 us share a pose, and so do all beams of an image.
    if (framed_s < 0.0 || look.after_s - framed_s > 50e-6) {
      framed_s = look.after_s;
      sensor = Frame(pose_at(at_s)) * mount_;
    }
    if (placed_s < 0.0 || look.after_s - placed_s > kMoment_s) {
      placed_s = look.after_s;
      scene.move_to(moment_, at_s);
    }
    out.shots.push_back(shoot(scene, moment_, sensor, look, at_s, faults));
    ++shots_;
  }
  if (params_.kind == "range") fold_cone(out);
  begin_s_ += period_s_;
  if (params_.kind == "vlp16") {
    azimuth_rad_ = std::fmod(azimuth_rad_ + 2.0 * kPi * params_.rate_hz * period_s_, 2.0 * kPi);
    turn_vlp16();
  }
}

/// Dirt takes light, and what is left of it echoes from the glass itself.
bool Sensor::through_window(const Look& look, const SensorFaults& faults, Draw& draw, Shot& shot,
                            double& share) const {
  if (!is_dirty(faults) || !within(look.bearing_rad, faults.dirt_from_deg, faults.dirt_to_deg)) {
    return true;
  }
  share = (1.0 - faults.dirt_share) * (1.0 - faults.dirt_share);
  if (faults.dirt_share < 1.0 && draw.uniform() >= 0.3 * faults.dirt_share) return true;
  shot.cause = Cause::Window;
  if (draw.uniform() < 0.5 && kGlass_m >= params_.near_m) {
    shot.range_m = static_cast<float>(kGlass_m + 0.02 * std::abs(draw.normal()));
    shot.intensity = static_cast<float>(0.3 * faults.dirt_share);
  }
  return false;
}

/// What the beam meets in the middle of its width and somewhere else in it.
void Sensor::echoes(const Scene& scene, const Moment& moment, const Frame& sensor, const Look& look,
                    double far_m, double share, Draw& draw, Shot& shot) const {
  const auto light = [&](const Hit& hit) { return share * hit.reflect * (0.2 + 0.8 * hit.cosine); };
  const auto seen = [&](const Hit& hit) {
    if (!hit.any() || hit.range_m < params_.near_m) return false;
    // Light falls with the square of the distance.
    return hit.range_m <= params_.dark_m * std::sqrt(light(hit) / 0.1);
  };
  Hit one = scene.cast({sensor.p, sensor.turn(look.dir)}, far_m, moment, draw);
  Hit two;
  double weight = 1.0;
  if (params_.beam_mrad > 0.0) {
    const double off = params_.beam_mrad * 1e-3 / 2.0;
    const double across = off * draw.uniform(-1.0, 1.0);
    const double over = off * draw.uniform(-1.0, 1.0);
    const Vec3 dir = look.dir + across * look.side + over * look.over;
    const double n = 1.0 / std::sqrt(dot(dir, dir));
    two = scene.cast({sensor.p, sensor.turn(n * dir)}, far_m, moment, draw);
    weight = draw.uniform(0.3, 0.7);
  }
  const bool has_one = seen(one);
  const bool has_two = seen(two);
  if (!has_one && !has_two) return;
  // On one face both parts of the beam belong together, however slanting it is.
  const bool apart = has_one && has_two && (one.thing != two.thing || one.leaf || two.leaf);
  const Hit& best = has_one ? one : two;
  shot.range_m = static_cast<float>(best.range_m);
  shot.intensity = static_cast<float>(light(best) * (has_one != has_two ? weight : 1.0));
  shot.thing = best.thing;
  shot.cause = best.thing == kGround ? Cause::Ground : Cause::Thing;
  if (!apart) return;
  const double gap_m = std::abs(one.range_m - two.range_m);
  if (gap_m < params_.merge_m) {
    shot.range_m = static_cast<float>(weight * one.range_m + (1.0 - weight) * two.range_m);
    if (gap_m > 0.03) shot.cause = Cause::Mixed;
    return;
  }
  if (two.range_m < one.range_m) std::swap(one, two);
  shot.range_m = static_cast<float>(one.range_m);
  shot.intensity = static_cast<float>(weight * light(one));
  shot.thing = one.thing;
  shot.cause = one.thing == kGround ? Cause::Ground : Cause::Thing;
  shot.second_m = static_cast<float>(two.range_m);
  shot.second_intensity = static_cast<float>((1.0 - weight) * light(two));
}

/// A drop or a cloud before what the beam would have met becomes its first echo.
void Sensor::weather(const SensorFaults& faults, double bearing_rad, double at_s, Draw& draw,
                     Shot& shot) const {
  const auto before = [&](double per_m, Cause cause) {
    if (per_m <= 0.0) return;
    const double range_m = params_.near_m + draw.exponential() / per_m;
    const double reach_m = std::min(kRainReach_m, params_.far_m);
    if (range_m > reach_m ||
        (shot.range_m > 0.0F && range_m >= static_cast<double>(shot.range_m))) {
      return;
    }
    if (shot.range_m > 0.0F) {
      shot.second_m = shot.range_m;
      shot.second_intensity = 0.7F * shot.intensity;
    }
    shot.range_m = static_cast<float>(range_m);
    shot.intensity = static_cast<float>(draw.uniform(0.005, 0.06));
    shot.cause = cause;
    shot.thing = kNothing;
  };
  before(faults.rain_per_m, Cause::Rain);
  if (faults.dust_per_m > 0.0) {
    before(3.0 * faults.dust_per_m * dust_cloud(bearing_rad, at_s), Cause::Dust);
  }
}

Shot Sensor::shoot(const Scene& scene, const Moment& moment, const Frame& sensor, const Look& look,
                   double at_s, const SensorFaults& faults) const {
  Shot shot;
  shot.bearing_rad = static_cast<float>(std::remainder(look.bearing_rad, 2.0 * kPi));
  shot.elevation_rad = static_cast<float>(look.elevation_rad);
  shot.after_s = static_cast<float>(look.after_s);
  shot.ring = look.ring;
  Draw draw(key_, shots_);
  if (faults.sun_width_deg > 0.0) {
    const double yaw = (90.0 - faults.sun_heading_deg) * kRad;
    const double up = faults.sun_elevation_deg * kRad;
    const Vec3 sun{std::cos(up) * std::cos(yaw), std::cos(up) * std::sin(yaw), std::sin(up)};
    if (dot(sun, sensor.turn(look.dir)) > std::cos(faults.sun_width_deg * kRad / 2.0)) {
      shot.cause = Cause::Sun;
      return shot;
    }
  }
  double share = 1.0;
  if (!through_window(look, faults, draw, shot, share)) return shot;
  if (draw.uniform() < params_.dropout + faults.sensor_dropout) {
    shot.cause = Cause::Dropout;
    return shot;
  }
  echoes(scene, moment, sensor, look, params_.far_m, share, draw, shot);
  if (faults.rain_per_m > 0.0 || faults.dust_per_m > 0.0) {
    const Vec3 dir = sensor.turn(look.dir);
    weather(faults, std::atan2(dir.y, dir.x), at_s, draw, shot);
  }
  const auto noisy = [&](float& range_m) {
    if (range_m <= 0.0F) return;
    const double r = static_cast<double>(range_m);
    const double sigma =
        std::hypot(params_.sigma_m, params_.sigma_share * r * r, faults.sensor_noise_m);
    range_m = static_cast<float>(std::clamp(r + sigma * draw.normal(), 0.001, params_.far_m));
  };
  noisy(shot.range_m);
  noisy(shot.second_m);
  return shot;
}

void Sensor::fold_cone(Sweep& out) const {
  Shot best = out.shots.front();
  for (const Shot& s : out.shots) {
    if (s.range_m > 0.0F && (best.range_m <= 0.0F || s.range_m < best.range_m)) best = s;
  }
  best.bearing_rad = 0.0F;
  best.elevation_rad = 0.0F;
  out.shots.assign(1, best);
}

}  // namespace roverd::sim::world
