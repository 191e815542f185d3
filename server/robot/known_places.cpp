#include "robot/known_places.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angle.hpp"
#include "nav/marks/scan.hpp"
#include "robot/safety/words.hpp"

namespace roverd::robot {
namespace {

using base::PlaceVerdict;

constexpr double kLookEvery_s = 0.1;
constexpr double kAnew_s = 5.0;      // unseen for so long, it is another meeting
constexpr int kLooks = 5;            // in a row, that decide
constexpr double kLooksFor_s = 0.5;  // and for so long
constexpr double kTellGate2 = 13.8;  // 99.9 %
constexpr double kRemembered_s = 60.0;
constexpr double kSurer = 3.0;  // times, than what is to be decided
constexpr double kOdds = 6.0;   // twice the logarithm of 20 to 1
constexpr double kOthersWithin = 5.0;
constexpr double kOthersWithin_m = 1.0;
constexpr double kSince_m = 3.0;       // that a robot drives from a look to here, at most
constexpr double kPostsOf_s = 1.0;     // seen within it, a post stands there
constexpr double kPostKnown_m = 0.03;  // no scan shows a post's middle better
constexpr double kMounted_rad = 0.01;  // nor is a mount known better, or a bearing
constexpr std::size_t kMostNews = 16;

/// "1.02 m (to 135 deg)".
std::string off_words(base::EnuPoint off) {
  const double m = std::hypot(off.east_m, off.north_m);
  const double deg = base::heading_from_yaw(std::atan2(off.north_m, off.east_m));
  return number(m, "%.2f m") + number(deg, " (to %.0f deg)");
}

double length_of_m(base::EnuPoint p) noexcept {
  return std::hypot(p.east_m, p.north_m);
}

/// Along the line of sight and across it.
Eigen::Matrix2d along_the_sight(const Eigen::Vector2d& at, double range_m,
                                double across_m) noexcept {
  const double far_m = at.norm();
  const Eigen::Vector2d u = far_m > 1e-6 ? Eigen::Vector2d(at / far_m) : Eigen::Vector2d(1, 0);
  const Eigen::Vector2d v{-u.y(), u.x()};
  return range_m * range_m * u * u.transpose() + across_m * across_m * v * v.transpose();
}

}  // namespace

void KnownPlaces::set(List list) {
  std::vector<Known> next;
  for (const base::KnownPlace& place : *list) {
    const auto same = std::ranges::find(known_, place, &Known::place);
    if (same != known_.end()) {
      next.push_back(*same);
    } else {
      next.push_back(Known{.place = place});
    }
  }
  known_ = std::move(next);
  changed_ = true;
}

void KnownPlaces::moved(const nav::sense::Odometry& now) {
  const bool first = history_.empty();
  const nav::sense::Pose2 before = first ? now.pose : history_.newest().pose;
  if (!history_.push(now)) return;
  way_m_ += std::hypot(now.pose.x_m - before.x_m, now.pose.y_m - before.y_m);
}

void KnownPlaces::trust() noexcept {
  for (Known& known : known_) {
    if (known.distrusted_m <= 0.0) continue;
    known.distrusted_m = 0.0;
    known.verdict = PlaceVerdict::Unseen;
    known.detail.clear();
    changed_ = true;
  }
}

bool KnownPlaces::place_in(Known& known, const nav::Estimator& estimator) const {
  const auto& frame = estimator.frame();
  if (!frame) return false;
  if (known.frame == frame->id()) return true;
  if (base::distance_bearing(frame->origin(), known.place.at).distance_m >
      base::LocalFrame::kReach_m) {
    return false;
  }
  known.at = frame->to_local(known.place.at);
  known.frame = frame->id();
  return true;
}

nav::LandmarkSight KnownPlaces::sight_of(const Known& known, const Seen& seen) const {
  nav::LandmarkSight out;
  out.stamp = seen.stamp;
  out.at = known.at;
  // A mount that is off errs alike in all looks.
  out.place_sigma_m = std::hypot(known.place.sigma_m, kMounted_rad * seen.at.norm());
  out.seen = seen.at;
  out.seen_covariance = seen.covariance;
  out.since_s = known.seen_at ? base::seconds(seen.stamp - *known.seen_at) : 1.0;
  if (known.place.yaw_rad && seen.face_rad) {
    out.yaw_rad = base::angle_diff_rad(*seen.face_rad, *known.place.yaw_rad);
    out.yaw_sigma_rad = seen.face_sigma_rad;
    out.face_sigma_rad = std::hypot(known.place.yaw_sigma_rad, kMounted_rad);
  }
  return out;
}

void KnownPlaces::see(const nav::tags::TagsSeen& image, nav::Estimator& estimator, base::Time now) {
  for (const nav::tags::TagPlace& tag : image.tags) {
    const auto alike = std::ranges::count(image.tags, tag.id, &nav::tags::TagPlace::id);
    const auto known = std::ranges::find(known_, std::optional(tag.id),
                                         [](const Known& k) { return k.place.tag; });
    if (alike > 1 || known == known_.end()) continue;
    Seen seen;
    seen.stamp = image.stamp;
    seen.at = {tag.pose.x_m, tag.pose.y_m};
    seen.covariance = along_the_sight(seen.at, tag.sigma_range_m, tag.sigma_across_m) +
                      1e-6 * Eigen::Matrix2d::Identity();
    if (tag.yaw_known) {  // whoever faces it looks against it
      seen.face_rad = base::wrap_rad(tag.pose.yaw_rad + base::kPi);
      seen.face_sigma_rad = tag.sigma_yaw_rad;
    }
    if (!estimator.located()) begin(*known, seen, estimator, now);
    judge(*known, seen, estimator, now);
  }
}

/// Only one that tells where the robot stands by itself: a tag that was entered with its face.
void KnownPlaces::begin(Known& known, const Seen& seen, nav::Estimator& estimator, base::Time now) {
  const auto body = history_.at(seen.stamp);
  if (!body || !known.place.yaw_rad || !seen.face_rad) return;
  // Without a frame it is counted from the tag itself; a glance at one makes none.
  if (estimator.frame() && !place_in(known, estimator)) return;
  const auto which = static_cast<std::size_t>(known.place.tag.value_or(0));
  const auto found = first_sight_.look(which, sight_of(known, seen), *body);
  if (!found) return;
  estimator.need_frame(known.place.at);
  if (!estimator.begin(*found, now) || news_.size() >= kMostNews) return;
  news_.push_back({false, "where the robot stands is known by " + known.place.name + ", to " +
                              number(found->sigma_m, "%.2f m")});
}

/// So far from where it was seen that nothing is to be compared: quickly.
bool KnownPlaces::is_far(const Known& known, const Seen& seen, const nav::Belief& b) noexcept {
  const double c = std::cos(b.x(nav::kYaw));
  const double s = std::sin(b.x(nav::kYaw));
  const double east_m = known.at.east_m - b.x(nav::kEast) - c * seen.at.x() + s * seen.at.y();
  const double north_m = known.at.north_m - b.x(nav::kNorth) - s * seen.at.x() - c * seen.at.y();
  const double sigma_m = std::sqrt(b.P(nav::kEast, nav::kEast) + b.P(nav::kNorth, nav::kNorth)) +
                         std::sqrt(b.P(nav::kYaw, nav::kYaw)) * seen.at.norm() +
                         known.place.sigma_m + 0.05 * seen.at.norm();
  return std::hypot(east_m, north_m) > kSince_m + kOthersWithin_m + 1.5 * kOthersWithin * sigma_m;
}

/// Those that were seen lately, each with the known poles that it may be.
std::vector<KnownPlaces::Post> KnownPlaces::posts_in(const nav::marks::View& view,
                                                     const nav::Estimator& estimator,
                                                     base::Time now) {
  std::vector<Post> out;
  for (const nav::marks::Landmark& mark : view.landmarks) {
    if (base::seconds(now - mark.seen_at) > kPostsOf_s) continue;
    const auto then = history_.at(mark.seen_at);
    if (!then) continue;
    const nav::sense::Vec2 b = nav::marks::placed(nav::sense::inverse(*then), mark.at);
    Post post;
    post.seen.stamp = mark.seen_at;
    post.seen.at = {b.x, b.y};
    const double least_m = std::hypot(mark.sigma_m, kPostKnown_m);
    post.seen.covariance = along_the_sight(post.seen.at, least_m,
                                           std::hypot(least_m, kMounted_rad * post.seen.at.norm()));
    for (std::size_t i = 0; i < known_.size(); ++i) {
      Known& known = known_[i];
      if (known.place.tag || !place_in(known, estimator)) continue;
      if (is_far(known, post.seen, estimator.belief())) continue;
      const auto look = estimator.compare(sight_of(known, post.seen), now);
      if (!look) continue;
      const double within_m = std::max(kOthersWithin_m, kOthersWithin * look->sigma_m);
      if (length_of_m(look->off) <= within_m) post.near.push_back(i);
    }
    auto& taken = posts_taken_[mark.id];
    const bool due = mark.believed && base::seconds(mark.seen_at - taken) >= kLookEvery_s;
    if (post.near.empty()) continue;
    if (due) {
      taken = mark.seen_at;
      out.insert(out.begin(), std::move(post));
    } else {
      post.seen.stamp = base::Time{};  // it only stands there
      out.push_back(std::move(post));
    }
  }
  return out;
}

void KnownPlaces::see(const nav::marks::View& view, nav::Estimator& estimator, base::Time now) {
  const bool any = std::ranges::any_of(known_, [](const Known& k) { return !k.place.tag; });
  if (!any) return;
  if (posts_taken_.size() > 4 * nav::marks::Landmarks::kMostLandmarks) posts_taken_.clear();
  const std::vector<Post> posts = posts_in(view, estimator, now);
  for (const Post& post : posts) {
    if (post.seen.stamp == base::Time{}) continue;
    Known& known = known_[post.near.front()];
    const auto claims = [&](const Post& other) {
      return std::ranges::count(other.near, post.near.front()) > 0;
    };
    if (post.near.size() == 1 && std::ranges::count_if(posts, claims) == 1) {
      judge(known, post.seen, estimator, now);
      continue;
    }
    for (const std::size_t i : post.near) {
      known_[i].seen_at = now;
      if (known_[i].distrusted_m <= 0.0) put(known_[i], PlaceVerdict::Ambiguous);
    }
  }
}

void KnownPlaces::put(Known& known, PlaceVerdict verdict) {
  if (verdict == PlaceVerdict::Ambiguous) {
    known.detail = "more than one pole may be it: it is not used";
  } else if (verdict != known.verdict) {
    known.detail.clear();
  }
  known.verdict = verdict;
  changed_ = true;
}

void KnownPlaces::judge(Known& known, const Seen& seen, nav::Estimator& estimator, base::Time now) {
  if (known.seen_at && base::seconds(seen.stamp - *known.seen_at) < 0.5 * kLookEvery_s) return;
  if (!place_in(known, estimator)) return;
  const nav::LandmarkSight sight = sight_of(known, seen);
  const auto look = estimator.compare(sight, now);
  if (!look) return;
  const bool met_anew = !known.seen_at || base::seconds(seen.stamp - *known.seen_at) > kAnew_s;
  known.seen_at = seen.stamp;
  known.look = *look;
  changed_ = true;
  if (met_anew) known.beside = 0;
  if (known.distrusted_m > 0.0) return watch(known, now);
  if (look->nis > nav::kLandmarkGate2) {
    if (known.beside++ == 0) known.beside_since = now;
    const bool long_enough = base::seconds(now - known.beside_since) >= kLooksFor_s;
    if (look->nis > kTellGate2 && known.beside >= kLooks && long_enough) {
      contradicts(known, estimator, now);
    }
    return;
  }
  known.beside = 0;
  if (estimator.needs_no_landmark()) return put(known, PlaceVerdict::Agrees);
  const bool used_anew = !known.used_at || base::seconds(now - *known.used_at) > kAnew_s;
  const nav::StateVector before = estimator.belief().x;
  if (!estimator.correct(sight, now)) return;
  if (used_anew) {
    known.before_m = look->belief_m;
    known.moved = {};
  }
  const nav::StateVector& after = estimator.belief().x;
  known.moved.east_m += after(nav::kEast) - before(nav::kEast);
  known.moved.north_m += after(nav::kNorth) - before(nav::kNorth);
  known.used_at = now;
  known.used_way_m = way_m_;
  put(known, PlaceVerdict::Used);
}

/// One that is distrusted may be right after all.
void KnownPlaces::watch(Known& known, base::Time now) {
  const bool decides = kSurer * known.look.belief_m < known.distrusted_m;
  const bool fits = known.look.nis <= nav::kLandmarkGate2;
  if (!fits) known.fits = 0;
  if (fits && decides) ++known.fits;
  if (known.fits < kLooks || base::seconds(now - known.since) < kLooksFor_s) return;
  known.distrusted_m = 0.0;
  known.fits = known.beside = 0;
  put(known, PlaceVerdict::Agrees);
  if (news_.size() < kMostNews) {
    news_.push_back({false, "the known place " + known.place.name + " fits again: it is used"});
  }
}

KnownPlaces::Known* KnownPlaces::last_used(const Known& but, base::Time now) noexcept {
  Known* last = nullptr;
  for (Known& k : known_) {
    const bool lately = k.used_at && base::seconds(now - *k.used_at) < kRemembered_s;
    if (&k == &but || !lately || k.distrusted_m > 0.0) continue;
    if (last == nullptr || *last->used_at < *k.used_at) last = &k;
  }
  return last;
}

/// Another one that was distrusted alone, lately, and says the same.
KnownPlaces::Known* KnownPlaces::ally(const Known& known, base::Time now) noexcept {
  for (Known& k : known_) {
    const bool lately = base::seconds(now - k.since) < kRemembered_s;
    if (&k == &known || k.distrusted_m <= 0.0 || !k.alone || !lately) continue;
    const double apart_m = base::distance_m(k.off, known.look.off);
    if (apart_m <= 3.0 * std::hypot(k.look.sigma_m, known.look.sigma_m) &&
        apart_m < 0.5 * k.distrusted_m) {
      return &k;
    }
  }
  return nullptr;
}

/// Was the estimate, before it was corrected by `last`, so sure that this one is the wrong one? By
/// the likelihoods of what it would have been off by then. A single look from afar may be half a
/// metre off; where `last` took it in many of them is not.
bool KnownPlaces::outvoted(const Known& known, const Known& last) noexcept {
  const auto square = [](base::EnuPoint p) { return p.east_m * p.east_m + p.north_m * p.north_m; };
  const double by_last = std::max(last.before_m * last.before_m, 1e-4);
  const double look = known.look.sigma_m * known.look.sigma_m;
  const double by_this = by_last + std::max(look - known.look.belief_m * known.look.belief_m, 0.0);
  return square(last.moved + known.look.off) / by_this - square(last.moved) / by_last > kOdds;
}

/// Who speaks against it.
std::string KnownPlaces::source(const nav::Estimator& estimator, const Known* last) const {
  if (estimator.health().by_map) return "the map";
  if (estimator.needs_no_landmark()) return "the satellites";
  if (last == nullptr) return "the odometry";
  return last->place.name + ", used " + number(way_m_ - last->used_way_m, "%.2f m") +
         " of way before, and the odometry";
}

void KnownPlaces::distrust(Known& known, base::Time now, PlaceVerdict verdict, std::string why) {
  known.distrusted_m = length_of_m(known.look.off);
  known.off = known.look.off;
  known.alone = verdict == PlaceVerdict::Contradicts;
  known.since = now;
  known.fits = 0;
  put(known, verdict);
  known.detail = std::move(why);
}

void KnownPlaces::contradicts(Known& known, nav::Estimator& estimator, base::Time now) {
  const base::EnuPoint seen_off{-known.look.off.east_m, -known.look.off.north_m};
  const double off_m = length_of_m(seen_off);
  Known* last = last_used(known, now);
  const bool better = estimator.needs_no_landmark();
  std::string words;
  if (Known* other = better ? nullptr : ally(known, now); other != nullptr) {
    estimator.doubt_position(off_m);
    other->distrusted_m = 0.0;
    put(*other, PlaceVerdict::Unseen);
    known.beside = 0;
    words = "the known places " + other->place.name + " and " + known.place.name +
            " agree that the robot stands elsewhere, by " + number(off_m, "%.2f m") +
            ": both are believed, and the position is uncertain until they have moved it";
  } else if (better || last == nullptr || outvoted(known, *last)) {
    words = "the known place " + known.place.name + " is seen " + off_words(seen_off) +
            " from where it was entered, by " + source(estimator, last) + ": it is not used";
    distrust(known, now, PlaceVerdict::Contradicts, words);
  } else {
    words = "the known places " + last->place.name + " and " + known.place.name +
            " contradict each other: seen from one, the other is " + off_words(seen_off) +
            " from where it was entered. Neither is used until another one decides";
    last->look.off = {seen_off.east_m, seen_off.north_m};
    distrust(*last, now, PlaceVerdict::Disputed, words);
    distrust(known, now, PlaceVerdict::Disputed, words);
    estimator.doubt_position(off_m);
  }
  if (news_.size() < kMostNews) news_.push_back({true, std::move(words)});
}

std::vector<KnownPlaces::News> KnownPlaces::news() {
  return std::exchange(news_, {});
}

std::shared_ptr<const std::vector<base::KnownPlaceState>> KnownPlaces::states() {
  if (!std::exchange(changed_, false)) return told_;
  if (known_.empty()) {
    told_ = nullptr;
    return told_;
  }
  auto out = std::make_shared<std::vector<base::KnownPlaceState>>();
  for (const Known& k : known_) {
    const base::EnuPoint off{-k.look.off.east_m, -k.look.off.north_m};
    out->push_back({k.place.name, k.verdict, k.seen_at, off, k.look.sigma_m, k.detail});
  }
  told_ = std::move(out);
  return told_;
}

}  // namespace roverd::robot
