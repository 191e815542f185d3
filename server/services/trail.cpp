#include "services/trail.hpp"

#include <algorithm>
#include <cmath>

namespace roverd::services {

namespace {

double apart_m(base::LatLon a, base::LatLon b) noexcept {
  return base::distance_bearing(a, b).distance_m;
}

/// What the line loses without its point b. A metre left without a point weighs like a millimetre
/// of length, so that straight rows thin out before bends do, but are not emptied: the receiver's
/// track is drawn as dots.
double worth_m(base::EnuPoint a, base::EnuPoint b, base::EnuPoint c) noexcept {
  constexpr double kHole = 0.001;
  const double chord_m = base::distance_m(a, c);
  return base::distance_m(a, b) + base::distance_m(b, c) - chord_m + kHole * chord_m;
}

}  // namespace

void Track::add(base::LatLon at, base::Time stamp, double reach_m) {
  const double moved_m = points_.empty() ? 0.0 : apart_m(points_.back().at, at);
  const bool begins = points_.empty() || moved_m > reach_m;
  if (!begins && moved_m < kStep_m) {
    if (moved_m < kFineStep_m) return;
    if (stamp - std::max(points_.back().stamp, looked_) < kPause) return;
    looked_ = stamp;
    if (!unseen(at)) return;
  }
  if (points_.size() >= kMost) thin();
  points_.push_back({at, stamp, begins});
}

bool Track::unseen(base::LatLon at) const {
  const auto count = static_cast<std::ptrdiff_t>(std::min(kSeen, points_.size()));
  return std::none_of(points_.end() - count, points_.end(),
                      [at](const Point& p) { return apart_m(p.at, at) < kFineStep_m; });
}

/// Makes a quarter of the room free: of every second point the half goes that the line misses
/// least. Should there be only pieces too short to lose one, the oldest points go.
void Track::thin() {
  struct Candidate {
    double worth_m;
    std::size_t index;
  };
  const base::LocalFrame plane(1, points_.front().at);  // good enough to compare with, at any reach
  std::vector<Candidate> candidates;
  for (std::size_t i = 1; i + 1 < points_.size(); i += 2) {
    if (points_[i].begins || points_[i + 1].begins) continue;
    candidates.push_back({worth_m(plane.to_local(points_[i - 1].at), plane.to_local(points_[i].at),
                                  plane.to_local(points_[i + 1].at)),
                          i});
  }
  const std::size_t wanted = points_.size() / 4;
  if (candidates.size() > wanted) {
    const auto end = candidates.begin() + static_cast<std::ptrdiff_t>(wanted);
    std::nth_element(candidates.begin(), end, candidates.end(),
                     [](const auto& a, const auto& b) { return a.worth_m < b.worth_m; });
    candidates.erase(end, candidates.end());
  }
  std::vector<bool> goes(points_.size(), false);
  for (const Candidate& c : candidates) goes[c.index] = true;
  for (std::size_t i = 0; i + candidates.size() < wanted; ++i) goes[i] = true;
  std::vector<Point> kept;
  kept.reserve(kMost);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (!goes[i]) kept.push_back(points_[i]);
  }
  kept.front().begins = true;
  points_ = std::move(kept);
}

void Trail::take(const base::Snapshot& s) {
  const auto& pose = s.pose;
  if (pose && base::seconds(s.now - pose->stamp) <= kStale_s) {
    const double reach_m = kSlack_m + std::abs(pose->speed_mps.value_or(0.0)) * kAhead_s;
    estimated_.add(pose->global, pose->stamp, reach_m);
  }
  const auto& fix = s.gnss;
  if (!fix || !fix->position || fix->fix == base::FixType::None || fix_ == fix->stamp) return;
  fix_ = fix->stamp;
  received_.add(*fix->position, fix->stamp, kReceiverReach_m);
}

}  // namespace roverd::services
