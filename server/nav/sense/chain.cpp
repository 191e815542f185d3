#include "nav/sense/chain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "nav/sense/mount.hpp"

namespace roverd::nav::sense {

namespace {

/// From one ring to the next, by the first points that tell of several. 0: there is one only.
float step_up_rad(const base::Sight& sight) noexcept {
  constexpr std::size_t kLooks = 64;
  const base::SightPoint* low = nullptr;
  const base::SightPoint* high = nullptr;
  for (std::size_t i = 0; i < std::min(kLooks, sight.points.size()); ++i) {
    const base::SightPoint& p = sight.points[i];
    if (low == nullptr || p.ring < low->ring) low = &p;
    if (high == nullptr || p.ring > high->ring) high = &p;
  }
  if (low == nullptr || low->ring == high->ring) return 0.0F;
  const auto up = [](const base::SightPoint& p) {
    return std::atan2(p.z_m, std::hypot(p.x_m, p.y_m));
  };
  const float step = (up(*high) - up(*low)) / static_cast<float>(high->ring - low->ring);
  return std::isfinite(step) ? std::abs(step) : 0.0F;
}

/// Between neighbouring points. Where the points lie much farther apart than was told, what was
/// told is of no use: 0. Of several rings neighbours do not follow one another; they are told by
/// devices that are known.
float step_across_rad(const base::Sight& sight, float step_up) {
  constexpr std::size_t kLooks = 64;
  constexpr float kFar = 8.0F;  // times: a row's end, a point left out
  const float told = 2.0F * sight.half_step_rad;
  const std::size_t n = sight.points.size();
  if (step_up > 0.0F || n < 2) return told;
  std::array<float, kLooks> apart;
  std::size_t looks = 0;
  for (std::size_t i = 0; i < kLooks; ++i) {
    const std::size_t k = i * (n - 1) / kLooks;
    const base::SightPoint& p = sight.points[k];
    const base::SightPoint& q = sight.points[k + 1];
    const Eigen::Vector3f a(p.x_m, p.y_m, p.z_m);
    const Eigen::Vector3f b(q.x_m, q.y_m, q.z_m);
    const float angle = std::atan2(a.cross(b).norm(), a.dot(b));
    if (std::isfinite(angle)) apart[looks++] = angle;
  }
  if (looks == 0) return told;
  const auto middle = apart.begin() + static_cast<std::ptrdiff_t>(looks / 2);
  std::nth_element(apart.begin(), middle, apart.begin() + static_cast<std::ptrdiff_t>(looks));
  return *middle > kFar * told ? 0.0F : told;
}

/// So high over the lowest ground that was seen a plane meets grass: over the ground as it is laid,
/// which is half of the grass higher, nothing lower is an obstacle, and blades reach as high again.
/// On level ground a plane meets what is as high as it is mounted: less than 0.6 of that, so that a
/// height that is wrong by the rest (two thirds of what is allowed here) does not take it away.
double over_ground_m(const GroundParams& ground, const std::vector<SensorSetup>& sensors) {
  double over_m = ground.min_height_m + 2.0 * ground.rough_m;
  for (const SensorSetup& s : sensors) {
    if (s.planar && s.thin) over_m = std::min(over_m, 0.6 * s.mount.z_m);
  }
  return std::max(over_m, std::min(ground.min_height_m, Hills::kMostLow_m));
}

}  // namespace

Chain::Chain(const ChainParams& params, const Footprint& body)
    : p_(params),
      reducer_(params.reduce, body, params.pulled),
      ground_(params.ground, params.reduce.max_range_m, body),
      hills_(params.reduce.max_range_m, params.ground.min_height_m),
      grid_(params.grid) {}

base::Result<Chain> Chain::of(ChainParams params, std::vector<SensorSetup> sensors,
                              const Footprint& body, base::Time now) {
  using base::Code;
  if (sensors.size() > kMaxSensors) return base::fail(Code::TooLarge, "more than 32 sensors");
  Chain chain(params, body);
  chain.hills_ = Hills(params.reduce.max_range_m, over_ground_m(params.ground, sensors));
  for (SensorSetup& s : sensors) {
    for (const EyeOf& other : chain.eyes_) {
      if (other.setup.name == s.name) {
        return base::fail(Code::Invalid, "two sensors are called " + s.name,
                          {{"/" + s.name, "the name is there twice"}});
      }
    }
    if (auto checked = check_mount(s.mount); !checked) {
      base::Error error = checked.error();
      error.detail = s.name + ": " + error.detail;
      for (base::FieldError& f : error.fields) f.pointer = "/" + s.name + f.pointer;
      return tl::unexpected<base::Error>(std::move(error));
    }
    SightedParams sighted;
    sighted.planar = s.planar;
    sighted.thin = s.planar && s.thin;
    sighted.blind_m = s.blind_m;
    sighted.vouch_m = params.vouch_m;
    sighted.low_m = params.ground.min_height_m;
    sighted.range_m = params.reduce.max_range_m;
    chain.eyes_.push_back({s, sighted, Persist(s.persist, params.reduce.max_range_m),
                           HealthWatch(s.health, now), Movers(params.reduce.max_range_m, s.planar),
                           Grass()});
  }
  return chain;
}

base::Result<std::size_t> Chain::take(const base::Sight& sight, const PoseHistory& history,
                                      base::Time now) {
  std::size_t i = 0;
  while (i < eyes_.size() && eyes_[i].setup.name != sight.sensor) ++i;
  if (i == eyes_.size()) {
    return base::fail(base::Code::NotFound, "there is no sensor called " + sight.sensor);
  }
  EyeOf& eye = eyes_[i];
  if (!sight.good) {
    eye.health.took(sight, std::nullopt, now);
    return base::fail(base::Code::Unavailable, sight.sensor + " says that its data are not good");
  }
  if (auto done = reducer_.reduce(sight, eye.setup.mount, history, reduced_); !done) {
    eye.health.took(sight, std::nullopt, now);
    return tl::unexpected<base::Error>(done.error());
  }
  eye.health.took(sight, reduced_.counts, now);
  if (!reduced_.lie.told) hills_.forget();
  hills_.drive(reduced_);
  if (!eye.setup.planar) {
    ground_.judge(reduced_.voxels);
    hills_.deny(reduced_);
    // Who is not believed to see the way free does not tell of the ground either.
    const bool sees = sight.window != base::Window::Blocked && eye.health.at(now).eye != Eye::Blind;
    if (sees) hills_.learn(reduced_);
  } else if (eye.sighted.thin) {
    hills_.judge(reduced_);
  }
  const float up = step_up_rad(sight);
  eye.persist.judge(reduced_.voxels, reduced_.pose,
                    {reduced_.origin_m[0], reduced_.origin_m[1], step_across_rad(sight, up), up});
  // Behind a blocked window what was not met is not clear.
  if (sight.window == base::Window::Blocked) {
    std::erase_if(reduced_.voxels, [](const Voxel& v) { return v.kind != Kind::Obstacle; });
  }
  sight_sectors(reduced_, sight.half_step_rad, eye.sighted, *sectors_);
  if (eye.sighted.thin) eye.grass.see(reduced_, *sectors_, hills_);
  eye.movers.meet(reduced_, grid_);
  grid_.take(reduced_, *sectors_, static_cast<std::uint8_t>(i), &hills_);
  others_.clear();
  for (std::size_t k = 0; k < eyes_.size(); ++k) {
    if (k != i) eyes_[k].movers.tell(reduced_.stamp, static_cast<std::uint8_t>(k), others_);
  }
  eye.movers.see(grid_, others_);
  return i;
}

void Chain::movers(base::Time now, std::vector<Mover>& out) const {
  out.clear();
  for (std::size_t i = 0; i < eyes_.size(); ++i) {
    eyes_[i].movers.tell(now, static_cast<std::uint8_t>(i), out);
  }
}

void Chain::forget() noexcept {
  grid_.forget();
  hills_.forget();
  for (EyeOf& eye : eyes_) {
    eye.movers.forget();
    eye.grass.forget();
  }
}

std::optional<std::string> Chain::blind(base::Time now) const {
  for (const EyeOf& eye : eyes_) {
    if (!eye.setup.needed) continue;
    const Fitness f = eye.health.at(now);
    if (f.eye == Eye::Blind) return eye.setup.name + ": " + f.reason;
  }
  return std::nullopt;
}

}  // namespace roverd::nav::sense
