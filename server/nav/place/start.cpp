#include "nav/place/start.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"

namespace roverd::nav::place {

namespace {

constexpr std::size_t kFineHits = 180;
constexpr double kNearMore_m = 0.5;  // what the odometry errs by until it is decided
constexpr double kNearMore_rad = 0.2;
constexpr std::uint32_t kNearFor = 10;
constexpr double kNowhereAfter_m = 5.0;

double apart_m(const Pose2& a, const Pose2& b) noexcept {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m);
}

/// @param fresh share of what is seen that no scan before saw from this place
void weigh(const Field& field, const chart::Scan& scan, const StartParams& p, double fresh,
           Place& place) {
  constexpr std::size_t kLooked = 90;
  const Agreement a = agreement(field, scan, place.pose, kLooked);
  place.evidence += p.counts * a.log_fit;
  place.close = a.close_fit;
  place.stands += fresh * p.counts * (a.close_fit - p.nowhere);
  const double n = place.scans;
  place.explained = (place.explained * n + a.explained) / (n + 1.0);
  place.crossed = (place.crossed * n + a.crossed) / (n + 1.0);
  ++place.scans;
}

}  // namespace

void GlobalStart::clear() {
  places_.clear();
  near_.reset();
  scans_ = 0;
  since_search_ = 0;
  way_m_ = 0.0;
}

void GlobalStart::stay_near(const Pose2& pose, double half_m, double half_rad) {
  clear();
  near_ = Near{pose, half_m, half_rad};
}

bool GlobalStart::counts(const Pose2& pose) const noexcept {
  return !near_ || (std::hypot(pose.x_m - near_->middle.x_m, pose.y_m - near_->middle.y_m) <=
                        near_->half_m + kNearMore_m &&
                    std::abs(base::angle_diff_rad(near_->middle.yaw_rad, pose.yaw_rad)) <=
                        near_->half_rad + kNearMore_rad);
}

std::optional<Pose2> GlobalStart::feed(const Field& field, const chart::Scan& scan,
                                       const Pose2& step) {
  if (near_) near_->middle = near_->middle * step;
  const std::vector<Point> few = spread_hits(scan, 0.10, p_.points);
  const std::vector<Point> hits = hits_of(scan, kFineHits);
  if (few.size() < 10) {
    // Nothing to see: the places go along with the odometry.
    for (Place& place : places_) place.pose = place.pose * step;
    return std::nullopt;
  }
  if (scans_ > 0) way_m_ += std::hypot(step.x_m, step.y_m);
  follow(field, scan, few, hits, step);
  if (places_.empty() || ++since_search_ >= p_.again_after) {
    since_search_ = 0;
    begin(field, scan, few, hits);
  }
  ++scans_;
  merge();
  if (near_ && places_.empty() && scans_ >= kNearFor) near_.reset();  // it is not there at all
  return decide();
}

void GlobalStart::follow(const Field& field, const chart::Scan& scan, std::span<const Point> few,
                         std::span<const Point> hits, const Pose2& step) {
  constexpr double kWorstStep = 8.0;
  const double way = std::hypot(step.x_m, step.y_m);
  const double fresh = std::min(1.0, way / p_.fresh_m + std::abs(step.yaw_rad) / p_.fresh_rad);
  for (Place& place : places_) {
    const Pose2 expected = place.pose * step;
    const Found found = search_window(field, few, expected, p_.window);
    place.pose = refine(field, hits, found.pose, {}, p_.match).pose;
    place.way_m += way;
    weigh(field, scan, p_, fresh, place);
    const double off = apart_m(place.pose, expected) / (p_.step_m + p_.step_share * way);
    place.stands -= std::min(0.5 * off * off, kWorstStep);
  }
}

void GlobalStart::begin(const Field& field, const chart::Scan& scan, std::span<const Point> few,
                        std::span<const Point> hits) {
  const Whole whole = search_whole(field, few, p_.whole);
  cut_ = !whole.complete;
  // A place found late is taken to have fitted until now as the best one did: it is in the race.
  double best = 0.0;
  double now = 0.0;
  if (!places_.empty()) {
    const auto top = std::max_element(places_.begin(), places_.end(),
                                      [](auto& a, auto& b) { return a.evidence < b.evidence; });
    best = top->evidence;
    now = best / top->scans;
  }
  for (const Found& f : whole.found) {
    if (!counts(f.pose)) continue;
    Place place;
    place.pose = refine(field, hits, f.pose, {}, p_.match).pose;
    weigh(field, scan, p_, 1.0, place);
    if (scans_ > 0) place.evidence += best - now;
    places_.push_back(place);
  }
}

void GlobalStart::merge() {
  std::sort(places_.begin(), places_.end(),
            [](const Place& a, const Place& b) { return a.evidence > b.evidence; });
  std::vector<Place> kept;
  for (const Place& place : places_) {
    if (!kept.empty() && place.evidence < kept.front().evidence - p_.hopeless) break;
    if (kept.size() >= p_.whole.most) break;
    auto same = std::find_if(kept.begin(), kept.end(), [&](const Place& k) {
      return apart_m(k.pose, place.pose) < 0.4 &&
             std::abs(base::angle_diff_rad(k.pose.yaw_rad, place.pose.yaw_rad)) < 0.2;
    });
    if (same == kept.end()) {
      kept.push_back(place);
    } else if (place.scans > same->scans) {
      same->scans = place.scans;  // the same place, known for longer
      same->explained = place.explained;
      same->crossed = place.crossed;
      same->stands = place.stands;
      same->way_m = place.way_m;
    }
  }
  places_ = std::move(kept);
}

bool GlobalStart::fits_nowhere() const noexcept {
  return way_m_ >= kNowhereAfter_m &&
         std::none_of(places_.begin(), places_.end(), [](auto& p) { return p.stands > 0.0; });
}

std::optional<Pose2> GlobalStart::decide() const {
  if (places_.empty() || cut_) return std::nullopt;
  const Place& best = places_.front();
  if (best.scans < p_.least_scans || best.way_m < p_.least_way_m ||
      best.explained < p_.least_explained || best.crossed > p_.most_crossed ||
      best.stands < doubt_ * p_.stands || best.close < p_.least_close) {
    return std::nullopt;
  }
  if (places_.size() > 1 && best.evidence - places_[1].evidence < p_.lead) return std::nullopt;
  return best.pose;
}

}  // namespace roverd::nav::place
