#include "nav/sense/movers.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>

#include "nav/sense/side_line.hpp"

namespace roverd::nav::sense {

namespace {

constexpr double kPlace_m = 0.1;
constexpr std::int32_t kHangs = 2;  // cells so far apart are of one thing
constexpr double kEdge_m = 0.3;     // so near to the end of the range a thing is cut off
constexpr double kWidest_m = 1.6;
constexpr std::size_t kWeather = 24;     // held back in one piece, by more than edges: dust, rain
constexpr std::uint32_t kFewVoxels = 3;  // voxels of a thing
constexpr std::size_t kThings = 64;
constexpr std::size_t kSpread = 4;
constexpr double kGap_s = 0.5;  // of a place: not taken for so long, it begins anew
constexpr double kWindow_s = 0.7;
constexpr double kEvery_s = 0.035;
constexpr double kSpan_s = 0.25;
constexpr std::size_t kSamples = 4;  // at least
constexpr double kGate_m = 0.35;
constexpr double kGate_mps = 1.5;
constexpr double kLeft_m = 0.12;      // so far outside of its box a place was left
constexpr std::uint32_t kLately = 2;  // pieces: what was met in the last ones is taken
constexpr double kNoMore_mps = 0.15;
constexpr double kAgree_mps = 0.3;  // else one side is hidden, or comes into sight
constexpr double kTakenOver_mps = 0.15;
constexpr double kGlance_s = 0.1;
constexpr double kHisWay = 0.3;  // of his velocity: half of it where one side is cut off
constexpr double kBeside_m = 0.15;
constexpr double kAgain_m = 0.05;  // of the body that no beam met

}  // namespace

Movers::Movers(double range_m, bool planar) : range_m_(range_m), planar_(planar) {
  const auto wide = static_cast<std::uint32_t>(std::ceil(2.0 * range_m / kPlace_m)) + 8;
  const std::uint32_t side = std::bit_ceil(std::clamp(wide, 16U, 1024U));
  mask_ = side - 1;
  places_.resize(static_cast<std::size_t>(side) * side);
}

Movers::Cell Movers::cell_at(Vec2 p) noexcept {
  return {static_cast<std::int32_t>(std::floor(p.x / kPlace_m)),
          static_cast<std::int32_t>(std::floor(p.y / kPlace_m))};
}

void Movers::forget() noexcept {
  std::fill(places_.begin(), places_.end(), Place{});
  tracks_.clear();
  piece_ = 0;
  begun_ = false;
}

std::size_t Movers::index(std::int32_t x, std::int32_t y) const noexcept {
  const auto column = static_cast<std::uint32_t>(x) & mask_;
  const auto row = static_cast<std::uint32_t>(y) & mask_;
  return static_cast<std::size_t>(row) * (mask_ + 1) + column;
}

bool Movers::met_lately(Vec2 p) const noexcept {
  const Cell cell = cell_at(p);
  return piece_ - places_[index(cell.x, cell.y)].piece < kLately;
}

/// There or beside it something has stood for long, and was met lately.
bool Movers::still_about(std::int32_t x, std::int32_t y) noexcept {
  for (std::int32_t v = y - 1; v <= y + 1; ++v) {
    for (std::int32_t u = x - 1; u <= x + 1; ++u) {
      const Place& p = place(u, v);
      const auto last_s = static_cast<double>(p.last_s);
      if (now_s_ - last_s < kGap_s && last_s - static_cast<double>(p.first_s) >= kStill_s) {
        return true;
      }
    }
  }
  return false;
}

void Movers::gather(const Reduced& in, const Grid& before) {
  cells_.clear();
  points_.clear();
  of_.clear();
  const double c = std::cos(in.pose.yaw_rad);
  const double s = std::sin(in.pose.yaw_rad);
  const double far_m = range_m_ - kEdge_m;
  for (const Kind kind : {Kind::Obstacle, Kind::Passing}) {
    believed_ = kind == Kind::Obstacle ? 0 : points_.size();
    for (const Voxel& v : in.voxels) {
      if (v.kind != kind) continue;
      const auto x = static_cast<double>(v.x_m);
      const auto y = static_cast<double>(v.y_m);
      if (x * x + y * y > far_m * far_m) continue;
      const Vec2 at{in.pose.x_m + c * x - s * y, in.pose.y_m + s * x + c * y};
      const Cell cell = cell_at(at);
      points_.push_back(at);
      of_.push_back(cell);
      Place& p = place(cell.x, cell.y);
      if (p.piece == piece_) continue;
      const bool anew = now_s_ - static_cast<double>(p.last_s) > kGap_s;
      if (anew) p.was_free = before.at(at.x, at.y, in.stamp) == Known::Free;
      p.piece = piece_;
      if (kind == Kind::Passing) {  // never a thing by itself, nor still
        p.thing = still_about(cell.x, cell.y) ? -1 : 0;
        continue;
      }
      if (anew) p.first_s = static_cast<float>(now_s_);
      p.last_s = static_cast<float>(now_s_);
      p.thing = -1;
      cells_.push_back(cell);
    }
  }
  std::erase_if(cells_, [this](const Cell& cell) { return still_about(cell.x, cell.y); });
  for (const Cell& cell : cells_) place(cell.x, cell.y).thing = 0;
}

/// Things are numbered from 1.
void Movers::part() {
  things_.clear();
  for (const Cell& first : cells_) {
    if (place(first.x, first.y).thing != 0 || things_.size() >= kThings) continue;
    things_.emplace_back();
    const auto number = static_cast<std::int32_t>(things_.size());
    place(first.x, first.y).thing = number;
    open_.assign(1, first);
    while (!open_.empty()) {
      const Cell at = open_.back();
      open_.pop_back();
      for (std::int32_t y = at.y - kHangs; y <= at.y + kHangs; ++y) {
        for (std::int32_t x = at.x - kHangs; x <= at.x + kHangs; ++x) {
          Place& p = place(x, y);
          if (p.piece != piece_ || p.thing != 0) continue;
          p.thing = number;
          // What is held back belongs to whom it lies beside, and joins nobody to anything.
          if (p.last_s == static_cast<float>(now_s_)) open_.push_back({x, y});
        }
      }
    }
  }
  spread_.resize(std::max(spread_.size(), things_.size()));
  for (auto& some : spread_) some.clear();
  // What is held back at edges would bend his way; of who walks in dust it is the most of him.
  const bool weather = points_.size() - believed_ >= kWeather;
  parts_.assign(things_.size(), {});
  const auto thing_of = [this](std::size_t i) { return place(of_[i].x, of_[i].y).thing; };
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const std::int32_t number = thing_of(i);
    if (number <= 0) continue;
    Parts& of = parts_[static_cast<std::size_t>(number - 1)];
    ++(i < believed_ ? of.believed : of.held_back);
  }
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const std::int32_t number = thing_of(i);
    if (number <= 0) continue;
    const auto thing = static_cast<std::size_t>(number - 1);
    if (i >= believed_ && (!weather || !parts_[thing].half_hidden())) continue;
    Box& b = things_[thing];
    const Vec2 p = points_[i];
    b = {std::min(b.x0, p.x), std::max(b.x1, p.x), std::min(b.y0, p.y), std::max(b.y1, p.y),
         b.points + 1};
    spread_[thing].push_back(p);
  }
}

void Movers::meet(const Reduced& in, const Grid& before) {
  met_ = false;
  if (!begun_) {
    begun_ = true;
    begin_ = in.stamp;
  }
  const double now_s = base::seconds(in.stamp - begin_);
  if (piece_ > 0 && now_s <= now_s_) return;  // out of order
  now_s_ = now_s;
  // A float of seconds is a millisecond's after three hours: count from here on before.
  constexpr double kFromHere_s = 8192.0;
  if (now_s > kFromHere_s) count_from(in.stamp);
  ++piece_;
  met_ = true;
  stamp_ = in.stamp;
  body_ = {in.pose.x_m, in.pose.y_m};
  const Pose2 eye = in.pose * Pose2{static_cast<double>(in.origin_m[0]),
                                    static_cast<double>(in.origin_m[1]), 0.0};
  eye_ = {eye.x_m, eye.y_m};
  gather(in, before);
  part();
}

void Movers::see(const Grid& grid, std::span<const Mover> others) {
  if (met_) follow(grid, others);
}

/// Nobody is forgotten by it. @param begin the piece that is taken now
void Movers::count_from(base::Time begin) {
  const double by_s = now_s_;
  for (Place& p : places_) {
    p.first_s = static_cast<float>(static_cast<double>(p.first_s) - by_s);
    p.last_s = static_cast<float>(static_cast<double>(p.last_s) - by_s);
  }
  for (Track& t : tracks_) {
    t.seen_s -= by_s;
    t.agreed_s -= by_s;
    for (Sample& s : t.samples) s.at_s -= by_s;
  }
  begin_ = begin;
  now_s_ = 0.0;
}

/// Each thing goes to the nearest track that expects one there.
void Movers::follow(const Grid& grid, std::span<const Mover> others) {
  std::erase_if(tracks_, [this](const Track& t) { return now_s_ - t.seen_s > kLost_s; });
  const std::size_t known = tracks_.size();
  for (std::size_t i = 0; i < things_.size(); ++i) {
    const Box& box = things_[i];
    if (box.points < kFewVoxels || box.x1 - box.x0 > kWidest_m || box.y1 - box.y0 > kWidest_m) {
      continue;
    }
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
      if (tracks_.size() >= kThings) continue;
      best = &tracks_.emplace_back();
    }
    best->seen_s = now_s_;
    best->box = box;
    if (!best->samples.empty() && now_s_ - best->samples.back().at_s < kEvery_s) continue;
    std::erase_if(best->samples, [this](const Sample& s) { return now_s_ - s.at_s > kWindow_s; });
    Sample sample;
    sample.at_s = now_s_;
    sample.box = box;
    const auto& some = spread_[i];
    for (std::size_t k = 0; k < std::min(kSpread, some.size()); ++k) {
      const Vec2 p = some[k * some.size() / std::min(kSpread, some.size())];
      sample.points[sample.size] = p;
      const Cell cell = cell_at(p);
      sample.was_free[sample.size++] = place(cell.x, cell.y).was_free;
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

/// Not in the box, nor near its sides.
bool Movers::Box::leaves_out(Vec2 p) const noexcept {
  return p.x <= x0 - kLeft_m || p.x >= x1 + kLeft_m || p.y <= y0 - kLeft_m || p.y >= y1 + kLeft_m;
}

/// Where it was and is not any more, rays went through. Or nobody looked there since: it lies
/// behind him as the sensor sees him, or beside, for a body hides more than the part of it that is
/// met; and he came onto free places.
bool Movers::left_free(const Track& track, const Grid& grid) const {
  const Box& b = track.box;
  const Vec2 to = b.mid() - eye_;
  const double away = std::max(0.01, std::hypot(to.x, to.y));
  const double half = 0.5 * std::hypot(b.x1 - b.x0, b.y1 - b.y0) + kLeft_m;
  int left = 0;
  int free = 0;
  int hidden = 0;
  for (const Sample& s : track.samples) {
    for (std::size_t k = 0; k < s.size; ++k) {
      const Vec2 p = s.points[k];
      if (!b.leaves_out(p)) continue;
      const Vec2 off = p - eye_;
      const double beyond = dot(off, to) / away;
      if (planar_ && beyond > away && std::abs(cross(to, off)) / away < half * beyond / away) {
        ++hidden;
        continue;
      }
      const bool is_free = grid.at(p.x, p.y, stamp_) == Known::Free;
      if (planar_ && !is_free && !met_lately(p)) {
        ++hidden;
        continue;
      }
      ++left;
      if (is_free) ++free;
    }
  }
  return left >= 2 ? 2 * free > left : hidden >= 2 && came_onto_free(track);
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
  const bool goes = sure > kLeast_mps + 2.0 * std::min(track.sigma, 0.5) && left_free(track, grid);
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
