#include "nav/marks/landmarks.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "base/angle.hpp"
#include "nav/sense/mount.hpp"

namespace roverd::nav::marks {
namespace {

constexpr double kFadeWeight = 0.9;
constexpr double kFadeName = 0.9;
constexpr double kKeep_s = 60.0;     ///< out of view, under way
constexpr double kTogether_s = 1.0;  ///< who told it so lately tells it
constexpr double kStands_m = 0.1;
constexpr double kStands_rad = 0.1;
constexpr double kLongestMove_s = 2.0;  ///< by that much
constexpr double kFarAway_m = 15.0;
constexpr double kVisionSigma_m = 0.05;
constexpr double kVisionSigmaOfRange = 0.02;
constexpr double kOnePart = 0.5;      ///< of near_m: two so near to each other are one
constexpr double kNothingBack = 0.5;  ///< where no echo comes back it may be dark, or gone
constexpr int kAstray = 3;            ///< sights in a row, of one that is not believed
constexpr int kBelievedAstray = 5;    ///< somebody may hide it, whose leg is seen instead
constexpr double kLegs_m = 0.1;       ///< radius of what wanders
constexpr double kThere_m = 0.1;
constexpr double kLongestGap_s = 0.5;  ///< between two pieces, of the time unseen

double since(base::Time& last, base::Time now) noexcept {
  const double dt_s = base::seconds(now - last);
  last = now;
  return std::clamp(dt_s, 0.0, kLongestGap_s);
}

/// A glance that never came again is none.
template <class Kept>
bool gone(const Kept& kept, double moved_s, base::Time now, const LandmarkParams& params) noexcept {
  if (kept.unseen_s() > params.forget_s) return true;
  if (kept.mark.believed) return moved_s - kept.moved_s > kKeep_s;
  return base::seconds(now - kept.mark.seen_at) > 1.0;
}

/// The image's edge may go through it: what is seen of it lies nearer to the image's middle.
bool may_be_cut(const base::VisionPoint& at, double half_view_rad, double radius_m) noexcept {
  const double range_m = std::max(1e-6, std::hypot(at.x_m, at.y_m));
  const double half_rad = std::asin(std::min(1.0, radius_m / range_m));
  return std::abs(std::atan2(at.y_m, at.x_m)) + half_rad > half_view_rad;
}

/// How much it counts that the scan did not see what stood there: 1 where it saw something farther,
/// less where nothing came back; 0: it did not look, or something stands there or before it.
double missed(const PlanarScan& scan, Vec2 at_b, double by_m) noexcept {
  const Vec2 to = at_b - scan.eye;
  const double range_m = length(to);
  if (range_m < 1e-6) return 0.0;
  double out = 0.0;
  for (const Beam& beam : scan.beams) {
    const Vec2 ray = beam.at - scan.eye;
    const double ray_m = length(ray);
    if (ray_m < 1e-6 || sense::dot(ray, to) <= 0.0) continue;
    if (std::abs(sense::cross(ray, to)) / ray_m > by_m) continue;
    if (beam.hit && ray_m < range_m + kThere_m) return 0.0;
    out = std::max(out, beam.hit ? 1.0 : kNothingBack);
  }
  return out;
}

/// The older one stays, where the surer one of both stands.
template <class Kept>
Kept one_of(Kept older, const Kept& newer) {
  if (newer.weight > older.weight) {
    older.mark.at = newer.mark.at;
    older.mark.sigma_m = newer.mark.sigma_m;
    older.weight = newer.weight;
    older.mark.name = newer.mark.name;
    older.names = newer.names;
  }
  if (older.mark.radius_m <= 0.0) older.mark.radius_m = newer.mark.radius_m;
  older.mark.by_scan |= newer.mark.by_scan;
  older.mark.by_vision |= newer.mark.by_vision;
  older.mark.believed |= newer.mark.believed;
  older.mark.seen_at = std::max(older.mark.seen_at, newer.mark.seen_at);
  older.hits = std::max(older.hits, newer.hits);
  older.imaged_at = std::max(older.imaged_at, newer.imaged_at);
  older.add(newer);
  older.moved_s = std::max(older.moved_s, newer.moved_s);
  older.scanned_at = std::max(older.scanned_at, newer.scanned_at);
  return older;
}

}  // namespace

Landmarks::Told* Landmarks::Kept::by(Eyes eye) noexcept {
  const auto one = std::ranges::find(told, eye, &Told::eye);
  return one == told.end() ? nullptr : &*one;
}

double Landmarks::Kept::unseen_s() const noexcept {
  double out = 0.0;
  for (const Told& one : told) out = std::max(out, one.unseen_s);
  return out;
}

/// Those that told it about when it was seen last; who told it before may look elsewhere now.
Eyes Landmarks::Kept::eyes() const noexcept {
  Eyes out = 0;
  for (const Told& one : told) {
    if (base::seconds(mark.seen_at - one.at) < kTogether_s) out |= one.eye;
  }
  return out;
}

/// Those that told another one, which turned out to be this one.
void Landmarks::Kept::add(const Kept& other) {
  const double least_s = std::min(unseen_s(), other.unseen_s());
  for (const Told& one : other.told) {
    if (Told* same = by(one.eye)) {
      same->at = std::max(same->at, one.at);
    } else {
      told.push_back(one);
    }
  }
  for (Told& one : told) one.unseen_s = std::min(one.unseen_s, least_s);
  mark.eyes = eyes();
}

/// While the body stands its odometry does not drift: nothing that is known grows old.
void Landmarks::move(const Pose2& pose, base::Time now) noexcept {
  const bool stands = length(Vec2{pose.x_m - stood_.x_m, pose.y_m - stood_.y_m}) < kStands_m &&
                      std::abs(base::wrap_rad(pose.yaw_rad - stood_.yaw_rad)) < kStands_rad;
  if (stands) return;
  moved_s_ += std::clamp(base::seconds(now - stood_at_), 0.0, kLongestMove_s);
  stood_ = pose;
  stood_at_ = now;
}

void Landmarks::join(Kept& kept, const Seen& seen, const Look& look, const LandmarkParams& params) {
  const double weight = 1.0 / (seen.sigma_m * seen.sigma_m);
  kept.weight *= kFadeWeight;
  const double gain = weight / (kept.weight + weight);
  kept.mark.at = kept.mark.at + gain * (seen.at - kept.mark.at);
  kept.weight += weight;
  kept.mark.sigma_m = 1.0 / std::sqrt(kept.weight);
  if (seen.radius_m > 0.0) kept.mark.radius_m = seen.radius_m;
  (look.by_vision ? kept.mark.by_vision : kept.mark.by_scan) = true;
  kept.mark.seen_at = std::max(kept.mark.seen_at, look.stamp);
  kept.moved_s = look.moved_s;
  if (kept.by(look.eye) == nullptr) kept.told.push_back({look.eye, look.stamp, 0.0});
  kept.by(look.eye)->at = look.stamp;
  for (Told& one : kept.told) one.unseen_s = 0.0;
  kept.mark.eyes = kept.eyes();
  if (look.by_vision) {
    kept.imaged_at = look.stamp;
    kept.mark.believed = kept.mark.believed || ++kept.hits >= static_cast<int>(params.confirm);
  } else {
    kept.scanned_at = look.stamp;
    ++kept.scans;
    const int most = kept.mark.believed ? kBelievedAstray : kAstray;
    kept.wanders = kept.stands.see(seen.at, seen.slack_m, most, look.stamp);
    const bool imaged = base::seconds(look.stamp - kept.imaged_at) < kTogether_s;
    if (kept.wanders) kept.scans = 0;
    if (kept.wanders && !imaged) kept.mark.believed = false;
  }
  if (seen.name.empty()) return;
  for (auto& [name, votes] : kept.names) votes *= kFadeName;
  kept.names[seen.name] += 1.0;
  const auto by_votes = [](const auto& a, const auto& b) { return a.second < b.second; };
  if (kept.names.size() > kMostNames) {
    kept.names.erase(std::min_element(kept.names.begin(), kept.names.end(), by_votes));
  }
  kept.mark.name = std::max_element(kept.names.begin(), kept.names.end(), by_votes)->first;
}

/// Where somebody goes by what stands, what is seen beside its place is his leg, and not it.
bool Landmarks::is_other(const Kept& kept, const Seen& seen, const Look& look) const noexcept {
  return !look.by_vision && kept.mark.believed &&
         !kept.stands.holds(seen.at, seen.slack_m, look.stamp) &&
         stirs_.beside(kept.mark.at, look.stamp);
}

void Landmarks::put(const std::vector<Seen>& seen, const Look& look, const LandmarkParams& params,
                    std::vector<bool>& met) {
  struct Pair {
    double apart_m;
    std::size_t kept, seen;
  };
  std::vector<Pair> pairs;
  for (std::size_t k = 0; k < kept_.size(); ++k) {
    for (std::size_t s = 0; s < seen.size(); ++s) {
      const double apart_m = length(kept_[k].mark.at - seen[s].at);
      if (apart_m > params.near_m || is_other(kept_[k], seen[s], look)) continue;
      pairs.push_back({apart_m, k, s});
    }
  }
  std::ranges::sort(pairs, {}, &Pair::apart_m);
  std::vector<bool> used(seen.size(), false);
  met.assign(kept_.size(), false);
  for (const Pair& p : pairs) {
    if (met[p.kept] || used[p.seen]) continue;
    met[p.kept] = used[p.seen] = true;
    join(kept_[p.kept], seen[p.seen], look, params);
  }
  for (std::size_t s = 0; s < seen.size() && kept_.size() < kMostLandmarks; ++s) {
    if (used[s]) continue;
    Kept fresh;
    fresh.mark.id = next_++;
    fresh.mark.at = seen[s].at;
    join(fresh, seen[s], look, params);
    kept_.push_back(std::move(fresh));
    met.push_back(true);
  }
  // Something false beside one would draw its sights to itself, and be that one a second time.
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    for (std::size_t k = kept_.size(); k-- > i + 1;) {
      if (length(kept_[i].mark.at - kept_[k].mark.at) > kOnePart * params.near_m) continue;
      kept_[i] = one_of(kept_[i], kept_[k]);
      met[i] = met[i] || met[k];
      kept_.erase(kept_.begin() + static_cast<std::ptrdiff_t>(k));
      met.erase(met.begin() + static_cast<std::ptrdiff_t>(k));
    }
  }
}

/// Those that this scan told.
void Landmarks::believe(const PlanarScan& scan, const LandmarkParams& params) {
  const auto told = [&](const Kept& k) { return k.scanned_at == scan.stamp; };
  for (const Kept& k : kept_) {
    if (told(k) && k.wanders) stirs_.tell(k.mark.at, kLegs_m, scan.stamp);
  }
  for (Kept& k : kept_) {
    if (!told(k) || k.mark.believed) continue;
    if (stirs_.beside(k.mark.at, scan.stamp)) k.stands.begin_anew(scan.stamp);
    k.mark.believed =
        k.scans >= static_cast<int>(params.confirm) && k.stands.for_s(scan.stamp) >= kStands_s;
  }
}

void Landmarks::take(const PlanarScan& scan, const LandmarkParams& params, std::size_t eye,
                     std::span<const sense::Mover> movers) {
  slack_.move(scan.pose, scan.stamp);
  for (const sense::Mover& m : movers) stirs_.tell(m.at, m.radius_m, m.seen);
  std::vector<Seen> seen;
  for (const Post& post : posts_of(scan, params)) {
    seen.push_back({placed(scan.pose, post.at),
                    std::max(0.01, post.sigma_m),
                    post.radius_m,
                    slack_.at_m(length(post.at)),
                    {}});
  }
  move(scan.pose, scan.stamp);
  const double dt_s = since(looked_at_[eye % looked_at_.size()], scan.stamp);
  std::vector<bool> met;
  put(seen, {false, eye_of(eye), scan.stamp, moved_s_}, params, met);
  believe(scan, params);
  const Pose2 bo = sense::inverse(scan.pose);
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    const Vec2 at = placed(bo, kept_[i].mark.at);
    if (met[i] || length(at) >= 0.8 * params.max_range_m) continue;
    // Who never told it may see over it, or not know what it is.
    if (Told* told = kept_[i].by(eye_of(eye))) told->unseen_s += dt_s * missed(scan, at, 0.05);
  }
  std::erase_if(kept_, [&](const Kept& k) {
    return gone(k, moved_s_, scan.stamp, params) ||
           length(k.mark.at - Vec2{scan.pose.x_m, scan.pose.y_m}) > kFarAway_m;
  });
}

void Landmarks::take(const base::Vision& vision, const base::Mount& mount, const Pose2& pose,
                     double half_view_rad, const LandmarkParams& params, std::size_t eye) {
  const Eigen::Matrix3d turn = sense::rotation(mount);
  std::vector<Seen> seen;
  for (const base::VisionLandmark& l : vision.landmarks) {
    const Eigen::Vector3d b = turn * Eigen::Vector3d(l.at.x_m, l.at.y_m, l.at.z_m);
    const double range_m = std::hypot(l.at.x_m, l.at.y_m);
    if (l.at.x_m <= 0.0 || range_m > params.max_range_m) continue;  // behind the camera: false
    double sigma_m = kVisionSigma_m + kVisionSigmaOfRange * range_m;
    if (may_be_cut(l.at, half_view_rad, params.max_radius_m)) sigma_m += params.max_radius_m;
    seen.push_back(
        {placed(pose, {mount.x_m + b.x(), mount.y_m + b.y()}), sigma_m, 0.0, 0.0, l.name});
  }
  move(pose, vision.stamp);
  const double dt_s = since(looked_at_[eye % looked_at_.size()], vision.stamp);
  std::vector<bool> met;
  put(seen, {true, eye_of(eye), vision.stamp, moved_s_}, params, met);
  const Pose2 bo = sense::inverse(pose);
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    const Vec2 at = placed(bo, kept_[i].mark.at) - Vec2{mount.x_m, mount.y_m};
    const double off_rad = base::wrap_rad(std::atan2(at.y, at.x) - mount.yaw_rad);
    const bool looked = std::abs(off_rad) < 0.8 * half_view_rad &&
                        length(at) < 0.8 * params.max_range_m && length(at) > 0.5;
    // Where a scan tells it, too, its place is the scan's to deny.
    const bool scanned = kept_[i].mark.by_scan &&
                         base::seconds(vision.stamp - kept_[i].scanned_at) < params.forget_s;
    Told* told = kept_[i].by(eye_of(eye));
    if (met[i] || told == nullptr || scanned || !looked) continue;
    told->unseen_s += dt_s;
    // Programs see what is not there, and twice at one place by chance.
    if (!kept_[i].mark.believed) kept_[i].hits = std::max(0, kept_[i].hits - 1);
  }
  std::erase_if(kept_, [&](const Kept& k) { return gone(k, moved_s_, vision.stamp, params); });
}

std::vector<Landmark> Landmarks::all() const {
  std::vector<Landmark> out;
  for (const Kept& k : kept_) out.push_back(k.mark);
  return out;
}

}  // namespace roverd::nav::marks
