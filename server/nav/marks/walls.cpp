#include "nav/marks/walls.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "base/angle.hpp"
#include "nav/marks/ends.hpp"
#include "nav/sense/mount.hpp"

namespace roverd::nav::marks {
namespace {

constexpr double kFade = 0.8;
constexpr int kBelieved = 3;
constexpr int kMisses = 5;
constexpr double kSameAngle_rad = 0.14;  // 8°
constexpr double kSameOffset_m = 0.15;
constexpr double kSameEnd_m = 0.3;
constexpr double kThrough_m = 0.3;
constexpr double kForgotten_m = 15.0;
constexpr int kPlanePlaces = 11;  // of two points each
/// How far a plane reaches is not told: so far to either side of its centre it is believed.
constexpr double kPlaneHalf_m = 1.0;
constexpr double kPlaneSigma_m = 0.03;
/// A wall's normal is level: cos 30°.
constexpr double kUpright = 0.87;

Vec2 turned(const Pose2& ob, Vec2 direction) noexcept {
  return placed({0.0, 0.0, ob.yaw_rad}, direction);
}

Moments in_o(const Moments& b, const Pose2& ob) noexcept {
  const double c = std::cos(ob.yaw_rad);
  const double s = std::sin(ob.yaw_rad);
  Moments m;
  m.origin = placed(ob, b.origin);
  m.n = b.n;
  m.x = c * b.x - s * b.y;
  m.y = s * b.x + c * b.y;
  m.xx = c * c * b.xx - 2.0 * c * s * b.xy + s * s * b.yy;
  m.yy = s * s * b.xx + 2.0 * c * s * b.xy + c * c * b.yy;
  m.xy = c * s * (b.xx - b.yy) + (c * c - s * s) * b.xy;
  return m;
}

Line in_o(const Line& b, const Pose2& ob) noexcept {
  Line o = b;
  o.from = placed(ob, b.from);
  o.to = placed(ob, b.to);
  o.normal = turned(ob, b.normal);
  o.moments = in_o(b.moments, ob);
  return o;
}

/// Of two that are one: an end is open where the one that reaches farther is, unless the other one
/// was seen to end about there.
Stretch joined(const Stretch& a, const Stretch& b) noexcept {
  Stretch out{std::min(a.from_m, b.from_m), std::max(a.to_m, b.to_m)};
  const bool begin_together = std::abs(a.from_m - b.from_m) < kSameEnd_m;
  const bool end_together = std::abs(a.to_m - b.to_m) < kSameEnd_m;
  out.from_open = begin_together ? a.from_open && b.from_open
                                 : (a.from_m < b.from_m ? a.from_open : b.from_open);
  out.to_open = end_together ? a.to_open && b.to_open : (a.to_m > b.to_m ? a.to_open : b.to_open);
  return out;
}

/// Adds a stretch; those nearer than `gap_m` are one.
void cover(std::vector<Stretch>& all, Stretch more, double gap_m, std::size_t most) {
  std::vector<Stretch> out;
  for (const Stretch& s : all) {
    if (s.to_m + gap_m < more.from_m || more.to_m + gap_m < s.from_m) {
      out.push_back(s);
    } else {
      more = joined(more, s);
    }
  }
  out.push_back(more);
  std::ranges::sort(out, {}, &Stretch::from_m);
  if (out.size() > most) out.erase(out.begin());
  all = std::move(out);
}

double gap_to(const std::vector<Stretch>& all, Stretch s) noexcept {
  double least = 1e9;
  for (const Stretch& a : all) {
    least = std::min(least, std::max({0.0, s.from_m - a.to_m, a.from_m - s.to_m}));
  }
  return least;
}

Stretch along(const Wall& w, Vec2 a, Vec2 b, bool a_open = false, bool b_open = false) noexcept {
  const double at_a = sense::dot(w.along, a - w.anchor);
  const double at_b = sense::dot(w.along, b - w.anchor);
  if (at_a <= at_b) return {at_a, at_b, a_open, b_open};
  return {at_b, at_a, b_open, a_open};
}

double angle_between(Vec2 a, Vec2 b) noexcept {
  return std::abs(std::atan2(sense::cross(a, b), sense::dot(a, b)));
}

/// The line of all its points, told along the same direction and from the same place as before.
void refit(Wall& wall, const Moments& m) noexcept {
  const Fit fit = fit_of(m);
  Vec2 along_now = fit.along;
  if (sense::dot(along_now, wall.along) < 0.0) along_now = -1.0 * along_now;
  wall.along = along_now;
  wall.anchor = fit.centre + sense::dot(along_now, wall.anchor - fit.centre) * along_now;
  const Vec2 left{-along_now.y, along_now.x};
  wall.normal = sense::dot(left, wall.normal) < 0.0 ? -1.0 * left : left;
  wall.sigma_m = std::max(fit.rms_m, 0.005) / std::sqrt(std::max(1.0, m.n));
  wall.sigma_rad = std::min(1.0, wall.sigma_m / std::max(fit.spread_m, 1e-3));
}

}  // namespace

std::optional<PlaneWall> wall_of(const base::Vision& vision, const base::Mount& mount,
                                 const WallParams& params) noexcept {
  const base::VisionPlane* best = nullptr;
  for (const base::VisionPlane& p : vision.planes) {
    const bool upright = std::hypot(p.normal.x_m, p.normal.y_m) >= kUpright;
    if (p.centre.x_m <= 0.0 || p.size < params.min_plane_size || !upright) continue;
    if (best == nullptr || p.size > best->size) best = &p;
  }
  if (best == nullptr) return std::nullopt;
  const Eigen::Matrix3d turn = sense::rotation(mount);
  const auto turned_by = [&](const base::VisionPoint& p) {
    const Eigen::Vector3d b = turn * Eigen::Vector3d(p.x_m, p.y_m, p.z_m);
    return Vec2{b.x(), b.y()};
  };
  PlaneWall out;
  out.centre = turned_by(best->centre) + Vec2{mount.x_m, mount.y_m};
  out.normal = turned_by(best->normal);
  const double level = length(out.normal);
  if (level < 1e-6) return std::nullopt;
  out.normal = (1.0 / level) * out.normal;
  out.distance_m = -sense::dot(out.centre, out.normal);
  if (out.distance_m < 0.0) {
    out.normal = -1.0 * out.normal;
    out.distance_m = -out.distance_m;
  }
  out.size = best->size;
  return out;
}

void Walls::take(const PlanarScan& scan, const WallParams& params) {
  for (Kept& k : walls_) {
    k.matched = false;
    k.now.clear();
    k.rms_m = 0.0;
  }
  for (const Line& line : lines_of(scan, params)) {
    put(in_o(line, scan.pose), Source::Scan, scan.stamp, params);
  }
  look_through(scan);
  look_past_ends(scan);
  merge(params);
  expire(scan.stamp, {scan.pose.x_m, scan.pose.y_m}, params);
}

void Walls::take(const PlaneWall& plane, const Pose2& pose, base::Time stamp,
                 const WallParams& params) {
  Line line;
  const Vec2 ahead{-plane.normal.y, plane.normal.x};
  line.from = plane.centre - kPlaneHalf_m * ahead;
  line.to = plane.centre + kPlaneHalf_m * ahead;
  line.normal = plane.normal;
  line.from_open = line.to_open = true;
  line.moments.origin = plane.centre;
  for (int i = 0; i < kPlanePlaces; ++i) {
    const double part = 2.0 * i / (kPlanePlaces - 1) - 1.0;
    const Vec2 at = plane.centre + part * kPlaneHalf_m * ahead;
    for (const double beside_m : {-kPlaneSigma_m, kPlaneSigma_m}) {
      line.moments.add(at + beside_m * plane.normal);
    }
  }
  put(in_o(line, pose), Source::Vision, stamp, params);
  merge(params);
  expire(stamp, {pose.x_m, pose.y_m}, params);
}

void Walls::put(const Line& line, Source source, base::Time stamp, const WallParams& params) {
  const Vec2 middle = 0.5 * (line.from + line.to);
  Kept* best = nullptr;
  double least_m = kSameOffset_m;
  for (Kept& k : walls_) {
    const double off_m = std::abs(k.wall.distance_m(middle));
    if (angle_between(k.wall.normal, line.normal) > kSameAngle_rad || off_m > least_m) continue;
    if (gap_to(k.wall.seen, along(k.wall, line.from, line.to)) > params.door_m) continue;
    best = &k;
    least_m = off_m;
  }
  if (best == nullptr) {
    if (walls_.size() == kMostWalls) {
      walls_.erase(
          std::ranges::min_element(walls_, {}, [](const Kept& k) { return k.wall.seen_at; }));
    }
    Kept fresh;
    fresh.wall.id = next_++;
    fresh.wall.anchor = middle;
    fresh.wall.along = (1.0 / std::max(1e-9, line.length_m())) * (line.to - line.from);
    fresh.wall.normal = line.normal;
    walls_.push_back(std::move(fresh));
    best = &walls_.back();
  }
  // Two pieces of one wall in one scan fade it once.
  if (!best->matched) best->moments.fade(kFade);
  best->moments.add(line.moments);
  refit(best->wall, best->moments);
  const Stretch now = along(best->wall, line.from, line.to, line.from_open, line.to_open);
  cover(best->wall.seen, now, params.jump_m, kMostStretches);
  best->now.push_back(now);
  best->rms_m = std::max(best->rms_m, line.rms_m);
  best->wall.source = source;
  best->wall.seen_at = stamp;
  (source == Source::Scan ? best->wall.scanned_at : best->wall.imaged_at) = stamp;
  if (!best->matched) ++best->wall.hits;
  best->wall.believed = best->wall.believed || best->wall.hits >= kBelieved;
  best->matched = source == Source::Scan;
  best->misses = 0;
}

/// A wall that is not seen where the scan sees what is behind it is not there any more.
void Walls::look_through(const PlanarScan& scan) {
  const Vec2 eye = placed(scan.pose, scan.eye);
  std::erase_if(walls_, [&](Kept& k) {
    if (k.matched || k.wall.source != Source::Scan) return false;
    int through = 0;
    int held = 0;
    const double eye_m = k.wall.distance_m(eye);
    for (const Beam& beam : scan.beams) {
      if (!beam.hit) continue;
      const Vec2 hit = placed(scan.pose, beam.at);
      const double hit_m = k.wall.distance_m(hit);
      if (eye_m - hit_m < 1e-6) continue;  // it looks away from it
      const Vec2 met = eye + (eye_m / (eye_m - hit_m)) * (hit - eye);
      const double at = sense::dot(k.wall.along, met - k.wall.anchor);
      const bool on = std::ranges::any_of(
          k.wall.seen, [&](const Stretch& s) { return at > s.from_m + 0.1 && at < s.to_m - 0.1; });
      if (!on || eye_m < 0.0) continue;
      hit_m < -kThrough_m ? ++through : ++held;
    }
    k.misses = through >= 5 && through > held ? k.misses + 1 : 0;
    return k.misses >= kMisses;
  });
}

void Walls::look_past_ends(const PlanarScan& scan) {
  for (Kept& k : walls_) {
    if (k.wall.source == Source::Scan) look_past(k.wall, k.now, k.rms_m, scan);
  }
}

/// Two that turn out to be one line: the older one stays.
void Walls::merge(const WallParams& params) {
  for (std::size_t i = 0; i < walls_.size(); ++i) {
    for (std::size_t j = walls_.size(); j-- > i + 1;) {
      Kept& a = walls_[i];
      Kept& b = walls_[j];
      if (angle_between(a.wall.normal, b.wall.normal) > kSameAngle_rad / 2.0) continue;
      const Stretch& last = b.wall.seen.back();
      const Stretch whole =
          along(a.wall, b.wall.at(b.wall.seen.front().from_m), b.wall.at(last.to_m));
      const Vec2 middle = a.wall.at(0.5 * (whole.from_m + whole.to_m));
      if (std::abs(b.wall.distance_m(middle)) > kSameOffset_m / 2.0) continue;
      if (gap_to(a.wall.seen, whole) > params.door_m) continue;
      a.moments.add(b.moments);
      for (const Stretch& s : b.wall.seen) {
        cover(a.wall.seen,
              along(a.wall, b.wall.at(s.from_m), b.wall.at(s.to_m), s.from_open, s.to_open),
              params.jump_m, kMostStretches);
      }
      for (const SeenEnd& e : b.wall.ends) {
        const bool same_way = sense::dot(a.wall.along, b.wall.along) > 0.0;
        const double at_m = sense::dot(a.wall.along, b.wall.at(e.at_m) - a.wall.anchor);
        tell_end(a.wall, {at_m, same_way == e.ahead, e.hits});
      }
      refit(a.wall, a.moments);
      a.wall.hits = std::max(a.wall.hits, b.wall.hits);
      a.wall.believed = a.wall.believed || b.wall.believed;
      a.wall.seen_at = std::max(a.wall.seen_at, b.wall.seen_at);
      a.wall.scanned_at = std::max(a.wall.scanned_at, b.wall.scanned_at);
      a.wall.imaged_at = std::max(a.wall.imaged_at, b.wall.imaged_at);
      a.matched = a.matched || b.matched;
      walls_.erase(walls_.begin() + static_cast<std::ptrdiff_t>(j));
    }
  }
}

void Walls::expire(base::Time now, Vec2 here, const WallParams& params) {
  std::erase_if(walls_, [&](Kept& k) {
    if (base::seconds(now - k.wall.seen_at) > params.keep_s) return true;
    // One glance that never came again is none.
    if (!k.wall.believed && base::seconds(now - k.wall.seen_at) > 1.0) return true;
    std::erase_if(k.wall.seen, [&](const Stretch& s) {
      const double at = sense::dot(k.wall.along, here - k.wall.anchor);
      const double near = std::clamp(at, s.from_m, s.to_m);
      return length(k.wall.at(near) - here) > kForgotten_m;
    });
    return k.wall.seen.empty();
  });
}

std::vector<Wall> Walls::all() const {
  std::vector<Wall> out;
  for (const Kept& k : walls_) out.push_back(k.wall);
  return out;
}

}  // namespace roverd::nav::marks
