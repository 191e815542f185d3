#include "nav/sense/things.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace roverd::nav::sense {

namespace {

constexpr double kPlace_m = 0.1;
constexpr std::int32_t kHangs = 2;    // cells so far apart are of one thing
constexpr double kEdge_m = 0.3;       // so near to the end of the range a thing is cut off
constexpr std::size_t kWeather = 24;  // held back in one piece, by more than edges: dust, rain
constexpr double kGap_s = 0.5;        // of a place: not taken for so long, it begins anew
constexpr double kMissed_s = 0.12;    // of a place: for so long it may be
constexpr int kVacated = 2;           // places
constexpr std::size_t kAtOnce = 2;    // things

}  // namespace

/// Not in the box, nor near its sides.
bool Box::leaves_out(Vec2 p) const noexcept {
  return p.x <= x0 - kLeft_m || p.x >= x1 + kLeft_m || p.y <= y0 - kLeft_m || p.y >= y1 + kLeft_m;
}

Things::Things(double range_m, bool wakes) : range_m_(range_m), wakes_(wakes) {
  const auto wide = static_cast<std::uint32_t>(std::ceil(2.0 * range_m / kPlace_m)) + 8;
  const std::uint32_t side = std::bit_ceil(std::clamp(wide, 16U, 1024U));
  mask_ = side - 1;
  places_.resize(static_cast<std::size_t>(side) * side);
}

void Things::forget() noexcept {
  std::fill(places_.begin(), places_.end(), Place{});
  piece_ = 0;
}

void Things::count_from(double by_s) noexcept {
  for (Place& p : places_) {
    p.first_s = static_cast<float>(static_cast<double>(p.first_s) - by_s);
    p.last_s = static_cast<float>(static_cast<double>(p.last_s) - by_s);
  }
}

void Things::meet(const Reduced& in, const Grid& before, double now_s, std::span<const Vec2> told) {
  now_s_ = now_s;
  ++piece_;
  gather(in, before);
  if (wakes_) wake(told);
  part();
}

bool Things::was_free(Vec2 p) const noexcept {
  const Cell cell = cell_at(p);
  return places_[index(cell.x, cell.y)].was_free;
}

Things::Cell Things::cell_at(Vec2 p) noexcept {
  return {static_cast<std::int32_t>(std::floor(p.x / kPlace_m)),
          static_cast<std::int32_t>(std::floor(p.y / kPlace_m))};
}

std::size_t Things::index(std::int32_t x, std::int32_t y) const noexcept {
  const auto column = static_cast<std::uint32_t>(x) & mask_;
  const auto row = static_cast<std::uint32_t>(y) & mask_;
  return static_cast<std::size_t>(row) * (mask_ + 1) + column;
}

bool Things::met_within(Vec2 p, std::uint32_t pieces) const noexcept {
  const Cell cell = cell_at(p);
  return piece_ - places_[index(cell.x, cell.y)].piece < pieces;
}

/// There or beside it something has stood for long, and was met lately.
bool Things::still_about(std::int32_t x, std::int32_t y) noexcept {
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

void Things::gather(const Reduced& in, const Grid& before) {
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

/// What stood for long has new parts on one side, and left places on another: it is still no more,
/// but for where somebody who is told goes past it. If many do so at once, the odometry slipped.
void Things::wake(std::span<const Vec2> told) {
  woken_.clear();
  std::size_t things = 0;
  for (const Cell& fresh : cells_) {
    if (place(fresh.x, fresh.y).looked == piece_) continue;
    gather_whole(fresh);
    const Box box = about_whole();
    if (box.wide() || !vacated_about(box)) continue;
    if (std::ranges::any_of(told, [&](Vec2 at) { return !box.leaves_out(at); })) continue;
    ++things;
    for (const Cell& c : whole_) {
      if (place(c.x, c.y).thing != 0) woken_.push_back(c);
    }
  }
  if (things > kAtOnce) return;
  for (const Cell& c : woken_) {
    Place& p = place(c.x, c.y);
    p.thing = 0;
    p.first_s = static_cast<float>(now_s_);
    cells_.push_back(c);
  }
}

Box Things::about_whole() const noexcept {
  Box box;
  for (const Cell& c : whole_) {
    const Vec2 p{(c.x + 0.5) * kPlace_m, (c.y + 0.5) * kPlace_m};
    box = {std::min(box.x0, p.x), std::max(box.x1, p.x), std::min(box.y0, p.y),
           std::max(box.y1, p.y), box.points + 1};
  }
  return box;
}

/// Places in it or beside it, that were taken for long, have been left. One may be missed.
bool Things::vacated_about(const Box& box) noexcept {
  const Cell low = cell_at({box.x0, box.y0});
  const Cell high = cell_at({box.x1, box.y1});
  int left = 0;
  for (std::int32_t y = low.y - kHangs; y <= high.y + kHangs; ++y) {
    for (std::int32_t x = low.x - kHangs; x <= high.x + kHangs; ++x) {
      const Place& p = place(x, y);
      const auto last_s = static_cast<double>(p.last_s);
      const bool stood = last_s - static_cast<double>(p.first_s) >= kStill_s;
      if (stood && now_s_ - last_s > kMissed_s && now_s_ - last_s < kGap_s) ++left;
    }
  }
  return left >= kVacated;
}

/// All that is believed now and hangs together with it, still or not.
void Things::gather_whole(const Cell& first) {
  whole_.assign(1, first);
  place(first.x, first.y).looked = piece_;
  for (std::size_t i = 0; i < whole_.size(); ++i) {
    const Cell at = whole_[i];
    for (std::int32_t y = at.y - kHangs; y <= at.y + kHangs; ++y) {
      for (std::int32_t x = at.x - kHangs; x <= at.x + kHangs; ++x) {
        Place& p = place(x, y);
        if (p.looked == piece_ || p.last_s != static_cast<float>(now_s_)) continue;
        p.looked = piece_;
        whole_.push_back({x, y});
      }
    }
  }
}

/// Things are numbered from 1.
void Things::part() {
  boxes_.clear();
  for (const Cell& first : cells_) {
    if (place(first.x, first.y).thing != 0 || boxes_.size() >= kMost) continue;
    boxes_.emplace_back();
    const auto number = static_cast<std::int32_t>(boxes_.size());
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
  spread_.resize(std::max(spread_.size(), boxes_.size()));
  for (auto& some : spread_) some.clear();
  // What is held back at edges would bend his way; of who walks in dust it is the most of him.
  const bool weather = points_.size() - believed_ >= kWeather;
  parts_.assign(boxes_.size(), {});
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
    Box& b = boxes_[thing];
    const Vec2 p = points_[i];
    b = {std::min(b.x0, p.x), std::max(b.x1, p.x), std::min(b.y0, p.y), std::max(b.y1, p.y),
         b.points + 1};
    spread_[thing].push_back(p);
  }
}

}  // namespace roverd::nav::sense
