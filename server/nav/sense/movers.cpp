#include "nav/sense/movers.hpp"

#include <algorithm>
#include <cmath>

#include "nav/sense/side_line.hpp"

namespace roverd::nav::sense {

namespace {

constexpr std::uint32_t kFewVoxels = 3;    // voxels of a thing
constexpr std::uint32_t kBody = 10;        // of somebody whose rows do not come and go
constexpr double kAtTheEye = 0.5;          // the cosine: else it is seen what he leaves
constexpr std::uint32_t kManyVoxels = 40;  // of what is plainly somebody
constexpr double kSteady_mps = 0.2;        // that line's sigma
constexpr double kSomebody_m = 0.9;        // wide
constexpr double kGone_m = 0.25;           // as far
constexpr std::size_t kTracks = 64;
constexpr std::size_t kSpread = 4;
constexpr double kWindow_s = 0.7;
constexpr double kEvery_s = 0.035;
constexpr double kBefore_s = 2.5;
constexpr double kBeforeEvery_s = 0.2;
constexpr double kSpan_s = 0.25;
constexpr std::size_t kSamples = 4;  // at least
constexpr double kGate_m = 0.35;
constexpr double kGate_mps = 1.5;
constexpr double kNoMore_mps = 0.1;
constexpr double kAgree_mps = 0.3;  // else one side is hidden, or comes into sight
constexpr double kTakenOver_mps = 0.15;
constexpr double kGlance_s = 0.1;
constexpr double kHisWay = 0.3;  // of his velocity: half of it where one side is cut off
constexpr double kBeside_m = 0.15;
constexpr double kAgain_m = 0.05;  // of the body that no beam met

}  // namespace

Movers::Movers(double range_m, bool planar) : planar_(planar), things_(range_m, !planar) {}

void Movers::forget() noexcept {
  things_.forget();
  tracks_.clear();
  begun_ = false;
}

void Movers::meet(const Reduced& in, const Grid& before) {
  met_ = false;
  const bool first = !begun_;
  if (first) begin_ = in.stamp;
  begun_ = true;
  const double now_s = base::seconds(in.stamp - begin_);
  if (!first && now_s <= now_s_) return;  // out of order
  now_s_ = now_s;
  // A float of seconds is a millisecond's after three hours: count from here on before.
  constexpr double kFromHere_s = 8192.0;
  if (now_s > kFromHere_s) count_from(in.stamp);
  met_ = true;
  stamp_ = in.stamp;
  body_ = {in.pose.x_m, in.pose.y_m};
  const Pose2 eye = in.pose * Pose2{static_cast<double>(in.origin_m[0]),
                                    static_cast<double>(in.origin_m[1]), 0.0};
  eye_ = {eye.x_m, eye.y_m};
  told_.clear();
  for (const Track& t : tracks_) {
    if (t.moves) told_.push_back(t.box.mid() + (now_s_ - t.seen_s) * t.v);
  }
  things_.meet(in, before, now_s_, told_);
}

void Movers::see(const Grid& grid, std::span<const Mover> others) {
  if (met_) follow(grid, others);
}

/// Nobody is forgotten by it. @param begin the piece that is taken now
void Movers::count_from(base::Time begin) {
  const double by_s = now_s_;
  things_.count_from(by_s);
  for (Track& t : tracks_) {
    t.seen_s -= by_s;
    t.agreed_s -= by_s;
    for (Sample& s : t.samples) s.at_s -= by_s;
    for (Sample& s : t.before) s.at_s -= by_s;
  }
  begin_ = begin;
  now_s_ = 0.0;
}

/// Each thing goes to the nearest track that expects one there.
void Movers::follow(const Grid& grid, std::span<const Mover> others) {
  std::erase_if(tracks_, [this](const Track& t) { return now_s_ - t.seen_s > kLost_s; });
  const std::size_t known = tracks_.size();
  for (std::size_t i = 0; i < things_.size(); ++i) {
    const Box& box = things_.box(i);
    if (box.points < kFewVoxels || box.wide()) continue;
    const Vec2 mid = box.mid();
    Track* best = nullptr;
    double least = 1e9;
    for (std::size_t k = 0; k < known; ++k) {
      Track& t = tracks_[k];
      if (t.seen_s == now_s_) continue;
      const double dt_s = now_s_ - t.seen_s;
      const Vec2 off = mid - (t.box.mid() + dt_s * t.v);
      const double away = std::hypot(off.x, off.y);
      if (away > kGate_m + kGate_mps * std::min(dt_s, 0.2) || away >= least) continue;
      best = &t;
      least = away;
    }
    if (best == nullptr) {
      if (tracks_.size() >= kTracks) continue;
      best = &tracks_.emplace_back();
    }
    best->seen_s = now_s_;
    best->box = box;
    if (!best->samples.empty() && now_s_ - best->samples.back().at_s < kEvery_s) continue;
    keep(*best);
    Sample sample;
    sample.at_s = now_s_;
    sample.box = box;
    const auto some = things_.points(i);
    for (std::size_t k = 0; k < std::min(kSpread, some.size()); ++k) {
      const Vec2 p = some[k * some.size() / std::min(kSpread, some.size())];
      sample.points[sample.size] = p;
      sample.was_free[sample.size++] = things_.was_free(p);
    }
    best->samples.push_back(sample);
    estimate(*best, grid);
    if (best->moves) continue;
    if (const Mover* other = seen_elsewhere(*best, others)) {
      best->v = other->v_mps;
      best->sigma = std::max(other->sigma_mps, kTakenOver_mps);
      best->agreed_s = now_s_;
      best->moves = true;
      best->moving = 3;
    }
  }
}

/// What is too old for a line; but of who creeps, it is seen by that alone what he left.
void Movers::keep(Track& track) const {
  const auto& samples = track.samples;
  auto& before = track.before;
  std::erase_if(before, [this](const Sample& s) { return now_s_ - s.at_s > kBefore_s; });
  const bool next = before.empty() || samples.front().at_s - before.back().at_s > kBeforeEvery_s;
  if (!samples.empty() && now_s_ - samples.front().at_s > kWindow_s && next) {
    before.push_back(samples.front());
  }
  std::erase_if(track.samples, [this](const Sample& s) { return now_s_ - s.at_s > kWindow_s; });
}

/// Where it was and is not any more, rays went through. Or nobody looked there since: it lies
/// behind him as the sensor sees him, or beside, for a body hides more than the part of it that is
/// met; and he came onto free places, or is plainly somebody.
bool Movers::left_free(const Track& track, const Grid& grid) const {
  const Box& b = track.box;
  const Vec2 to = b.mid() - eye_;
  const double away = std::max(0.01, std::hypot(to.x, to.y));
  const double half = 0.5 * std::hypot(b.x1 - b.x0, b.y1 - b.y0) + Box::kLeft_m;
  const double fast = std::hypot(track.v.x, track.v.y);
  const bool body = !planar_ && b.points >= kBody;
  const bool hides = planar_ || (body && dot(track.v, to) < -kAtTheEye * fast * away);
  int left = 0;
  int free = 0;
  int hidden = 0;
  const auto count = [&](const Sample& s) {
    for (std::size_t k = 0; k < s.size; ++k) {
      const Vec2 p = s.points[k];
      if (!b.leaves_out(p)) continue;
      const Vec2 off = p - eye_;
      const double beyond = dot(off, to) / away;
      if (hides && beyond > away && std::abs(cross(to, off)) / away < half * beyond / away) {
        ++hidden;
        continue;
      }
      const Known now = grid.at(p.x, p.y, stamp_);
      // A cloud that looks over what is low says only that what stood there is there no more.
      const bool is_free = now == Known::Free || (body && now == Known::Unknown);
      if (hides && !is_free && !(planar_ ? things_.met_lately(p) : things_.met_now(p))) {
        ++hidden;
        continue;
      }
      ++left;
      if (is_free) ++free;
    }
  };
  std::ranges::for_each(track.before, count);
  std::ranges::for_each(track.samples, count);
  if (left >= 2) return 2 * free > left;
  if (hidden >= 2 && came_onto_free(track)) return true;
  return hides && left == free && is_somebody(track);
}

/// Of a cloud: a body of somebody's size, of many voxels, that has gone steadily for half of its
/// own size. The ground about a lidar is not seen, and so it is not known what he came onto.
bool Movers::is_somebody(const Track& track) const noexcept {
  const Box& b = track.box;
  const Vec2 gone = track.samples.back().box.mid() - track.samples.front().box.mid();
  return !planar_ && b.points >= kManyVoxels && track.sigma < kSteady_mps &&
         std::max(b.x1 - b.x0, b.y1 - b.y0) < kSomebody_m && std::hypot(gone.x, gone.y) > kGone_m;
}

/// Most of where he is and was not before. What comes into sight was hidden, not free.
bool Movers::came_onto_free(const Track& track) noexcept {
  int came = 0;
  int free = 0;
  const Sample& now = track.samples.back();
  for (std::size_t k = 0; k < now.size; ++k) {
    if (!track.samples.front().box.leaves_out(now.points[k])) continue;
    ++came;
    if (now.was_free[k]) ++free;
  }
  return came >= 2 && 2 * free > came;
}

/// Somebody another sensor tells is there, and what is seen of him here goes his way. What stands
/// beside him does not.
const Mover* Movers::seen_elsewhere(const Track& track,
                                    std::span<const Mover> others) const noexcept {
  const auto& samples = track.samples;
  const double span_s = samples.back().at_s - samples.front().at_s;
  if (span_s < kGlance_s) return nullptr;
  const Vec2 off = samples.back().box.mid() - samples.front().box.mid();
  const Box& b = track.box;
  for (const Mover& m : others) {
    const double fast = std::hypot(m.v_mps.x, m.v_mps.y);
    if (fast < kLeast_mps || dot(off, m.v_mps) < kHisWay * fast * fast * span_s) continue;
    const double age_s = base::seconds(stamp_ - m.seen);
    const Vec2 at = m.at + age_s * m.v_mps;
    const double near = m.radius_m + kBeside_m;
    const bool x = at.x > b.x0 - near && at.x < b.x1 + near;
    if (x && at.y > b.y0 - near && at.y < b.y1 + near) return &m;
  }
  return nullptr;
}

void Movers::estimate(Track& track, const Grid& grid) const {
  const auto& samples = track.samples;
  const std::size_t n = samples.size();
  if (n < kSamples || samples.back().at_s - samples.front().at_s < kSpan_s) return;
  const auto side = [&](double Box::*of) {
    return line_through(n, [&](std::size_t i) {
      return std::array{samples[i].at_s, samples[i].box.*of};
    });
  };
  const Going x = going(side(&Box::x0), side(&Box::x1));
  const Going y = going(side(&Box::y0), side(&Box::y1));
  const double sigma = std::hypot(x.sigma, y.sigma);
  const bool agree = sigma < kAgree_mps;
  if (agree || !track.moves || now_s_ - track.agreed_s > kWindow_s) {
    track.v = {x.mean, y.mean};
    track.sigma = sigma;
  }
  if (agree) track.agreed_s = now_s_;
  const double sure = std::hypot(x.sure, y.sure);
  const double fast = std::hypot(track.v.x, track.v.y);
  if (track.moves) {
    track.moving = fast > kNoMore_mps ? 3 : track.moving - 1;
    if (track.moving <= 0) track.moves = false;
    return;
  }
  const double beyond_mps = kLeast_mps + 2.0 * std::min(track.sigma, 0.5);
  const bool fast_enough =
      sure > beyond_mps || (sure > kLeast_mps && fast > beyond_mps && is_somebody(track));
  const bool goes = fast_enough && left_free(track, grid);
  track.moving = goes ? track.moving + 1 : 0;
  if (track.moving < 2) return;
  track.moves = true;
  track.moving = 3;
}

void Movers::tell(base::Time now, std::uint8_t sensor, std::vector<Mover>& out) const {
  const double at_s = begun_ ? base::seconds(now - begin_) : 0.0;
  const std::size_t before = out.size();
  for (const Track& t : tracks_) {
    if (!t.moves || at_s - t.seen_s > kLost_s) continue;
    const double half_m = 0.5 * std::max(t.box.x1 - t.box.x0, t.box.y1 - t.box.y0);
    out.push_back({t.box.mid(), t.v, half_m + kAgain_m, t.sigma, sensor,
                   begin_ + base::from_seconds(t.seen_s)});
  }
  const auto away = [this](const Mover& m) {
    return std::hypot(m.at.x - body_.x, m.at.y - body_.y);
  };
  const auto first = out.begin() + static_cast<std::ptrdiff_t>(before);
  std::sort(first, out.end(), [&](const Mover& a, const Mover& b) { return away(a) < away(b); });
  if (out.size() - before > kMost) out.resize(before + kMost);
}

}  // namespace roverd::nav::sense
