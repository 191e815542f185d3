#include "nav/around/body.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace roverd::nav::around {

namespace {

constexpr float kBetween_m = 0.010F;  // what interpolation may tell too much
constexpr float kRoom_m = 0.02F;      // the same of coarse cells
constexpr double kAboutStart_m = 1.5;
constexpr float kNearer_m = 0.003F;
constexpr double kTurnsHere_m = 0.05;  // nearer to the start it still turns on the spot
constexpr float kTurnsNearer_m = 0.03F;
constexpr float kSwings_m = 0.2F;    // so much a corner may swing out in the turn that begins a way
constexpr float kVouches_m = 0.03F;  // what interpolation may tell too much, twice
constexpr double kBeyond_m = 3.0 * Body::kApart_m;

void along_outline(const sense::Footprint& shape, double apart_m, std::vector<Vec2>& out) {
  out.clear();
  const auto corners = shape.corners();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 a = corners[i];
    const Vec2 e = corners[(i + 1) % corners.size()] - a;
    const auto n = static_cast<int>(std::ceil(std::hypot(e.x, e.y) / apart_m));
    for (int k = 0; k < n; ++k) out.push_back(a + (static_cast<double>(k) / n) * e);
  }
}

/// Points within the outline, so that none within it is farther than 0.71 times `apart_m` from one
/// of them or half of that from the outline.
void within_outline(const sense::Footprint& shape, double apart_m, std::vector<Vec2>& out) {
  out.clear();
  const auto n = static_cast<int>(std::ceil(shape.reach_m() / apart_m));
  for (int y = -n; y <= n; ++y) {
    for (int x = -n; x <= n; ++x) {
      const Vec2 p{x * apart_m, y * apart_m};
      if (shape.distance_m(p) <= -0.5 * apart_m) out.push_back(p);
    }
  }
}

/// The highest and lowest y of the outline at one x.
std::pair<double, double> slice(const sense::Footprint& shape, double x) noexcept {
  double low = 1e9;
  double high = -1e9;
  const auto corners = shape.corners();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 a = corners[i];
    const Vec2 b = corners[(i + 1) % corners.size()];
    if (x < std::min(a.x, b.x) || x > std::max(a.x, b.x)) continue;
    for (const double t : {0.0, 1.0}) {
      const double u = std::abs(b.x - a.x) < 1e-9 ? t : (x - a.x) / (b.x - a.x);
      const double y = a.y + u * (b.y - a.y);
      low = std::min(low, y);
      high = std::max(high, y);
    }
  }
  return {low, high};
}

}  // namespace

void Body::set(const sense::Footprint& shape, double least_m, const Field& field) {
  field_ = &field;
  allowed_ = false;
  inner_m_ = std::max(0.0, -shape.distance_m({0.0, 0.0}));
  least_m_ = static_cast<float>(least_m + 0.7072 * field.cell_m()) + kBetween_m;
  sample_m_ = std::sqrt(least_m_ * least_m_ + static_cast<float>(2.0 * kApart_m * kApart_m));
  lay(shape, 2.0 * kApart_m, 4.0 * kApart_m, coarse_);
  lay(shape, 0.4 * kApart_m, 2.0 * kApart_m, dense_);
  dense_m_ = std::sqrt(least_m_ * least_m_ + static_cast<float>(0.08 * kApart_m * kApart_m));
  cover(shape);
}

void Body::lay(const sense::Footprint& shape, double apart_m, double inner_apart_m, Points& out) {
  out.apart_m = apart_m;
  along_outline(shape, apart_m, out.outline);
  within_outline(shape, inner_apart_m, out.inner);
  out.inner_m = static_cast<float>(0.7075 * inner_apart_m);
}

/// Circles in a row, and one about everything.
void Body::cover(const sense::Footprint& shape) {
  double back = 1e9;
  double front = -1e9;
  double half = 0.0;
  for (const Vec2 c : shape.corners()) {
    back = std::min(back, c.x);
    front = std::max(front, c.x);
    half = std::max(half, std::abs(c.y));
  }
  about_.at = {0.5 * (back + front), 0.0};
  about_.radius_m = 0.0F;
  for (const Vec2 c : shape.corners()) {
    const Vec2 d = c - about_.at;
    about_.radius_m = std::max(about_.radius_m, static_cast<float>(std::hypot(d.x, d.y)));
  }
  const int n = std::clamp(static_cast<int>(std::ceil((front - back) / (0.8 * half))), 1, 12);
  cover_.clear();
  for (int i = 0; i < n; ++i) {
    cover_.push_back(
        circle_of(shape, back + (front - back) * i / n, back + (front - back) * (i + 1) / n));
  }
}

/// About what of the body lies between two x.
Body::Circle Body::circle_of(const sense::Footprint& shape, double from, double to) const {
  double low = 1e9;
  double high = -1e9;
  const auto take = [&](double x) {
    const auto [l, h] = slice(shape, x);
    low = std::min(low, l);
    high = std::max(high, h);
  };
  take(from);
  take(to);
  for (const Vec2 c : shape.corners()) {
    if (c.x > from && c.x < to) take(c.x);
  }
  Circle circle;
  circle.at = {0.5 * (from + to), 0.5 * (low + high)};
  circle.radius_m = static_cast<float>(std::hypot(0.5 * (to - from), 0.5 * (high - low)));
  // What lies just beyond, too: between two points it is the nearer one that vouches.
  const auto lies = [&](Vec2 p) { return p.x >= from - kBeyond_m && p.x <= to + kBeyond_m; };
  const auto pick = [&](const Points& points, Circle::Part& part) {
    for (std::size_t k = 0; k < points.outline.size(); ++k) {
      if (!lies(points.outline[k])) continue;
      const bool goes_on = !part.outline.empty() && part.outline.back().last == k;
      if (!goes_on) part.outline.push_back({k, k});
      part.outline.back().last = k + 1;
    }
    std::ranges::copy_if(points.inner, std::back_inserter(part.inner), lies);
  };
  pick(coarse_, circle.coarse);
  pick(dense_, circle.dense);
  return circle;
}

void Body::allow_start(const Pose2& start) {
  start_ = start;
  allowed_ = true;
  start_clear_m_ = Field::kFar_m;
  start_room_m_ = Field::kFar_m;
  const Stand at{start};
  for (const Vec2 p : dense_.outline) {
    const double x = at.x_m + at.cos * p.x - at.sin * p.y;
    const double y = at.y_m + at.sin * p.x + at.cos * p.y;
    start_clear_m_ = std::min(start_clear_m_, field_->clear_m(x, y));
    start_room_m_ = std::min(start_room_m_, field_->room_m(x, y));
  }
  start_clear_m_ -= kNearer_m;
  start_room_m_ -= kNearer_m;
}

bool Body::circle_fits(const Stand& at, const Circle& circle, bool borders) const noexcept {
  const double x = at.x_m + at.cos * circle.at.x - at.sin * circle.at.y;
  const double y = at.y_m + at.sin * circle.at.x + at.cos * circle.at.y;
  return field_->clear_m(x, y) >= circle.radius_m + least_m_ &&
         (!borders || field_->room_m(x, y) >= circle.radius_m + kRoom_m);
}

/// Where a circle has room, what of the body lies in it has.
bool Body::stands(const Stand& at, bool borders) const noexcept {
  const float room = borders ? kRoom_m : -Field::kFar_m;
  return std::all_of(cover_.begin(), cover_.end(), [&](const Circle& circle) {
    return circle_fits(at, circle, borders) ||
           part_fits(at, coarse_, circle.coarse, sample_m_, room);
  });
}

/// As near as it is there, and no nearer; or as a turn on the spot may.
bool Body::stands_as_at_start(const Stand& at, bool turns) const noexcept {
  const float clear = std::min(turns ? dense_m_ - kTurnsNearer_m : dense_m_, start_clear_m_);
  const float room = std::min(kRoom_m, start_room_m_);
  return std::all_of(cover_.begin(), cover_.end(), [&](const Circle& circle) {
    return circle_fits(at, circle, true) || part_fits(at, dense_, circle.dense, clear, room);
  });
}

bool Body::fits(const Stand& at, bool as_at_start) const noexcept {
  if (!field_->inside(at.x_m, at.y_m, 0.0)) return false;
  if (circle_fits(at, about_, true)) return true;
  const double dx = at.x_m - start_.x_m;
  const double dy = at.y_m - start_.y_m;
  const double far_m2 = dx * dx + dy * dy;
  const bool near = as_at_start && allowed_ && far_m2 < kAboutStart_m * kAboutStart_m &&
                    (start_clear_m_ < sample_m_ + kSwings_m || start_room_m_ < kRoom_m);
  return near ? stands_as_at_start(at, far_m2 < kTurnsHere_m * kTurnsHere_m) : stands(at, true);
}

/// Along the outline nothing comes nearer faster than one goes: what has more room than is asked
/// for vouches for its neighbours.
bool Body::part_fits(const Stand& at, const Points& points, const Circle::Part& part, float clear,
                     float room) const noexcept {
  const bool borders = room > -Field::kFar_m;
  const auto place = [&at](Vec2 p) {
    return Vec2{at.x_m + at.cos * p.x - at.sin * p.y, at.y_m + at.sin * p.x + at.cos * p.y};
  };
  const auto per_point = static_cast<float>(1.0 / points.apart_m);
  for (const Run& run : part.outline) {
    for (std::size_t i = run.first; i < run.last;) {
      const Vec2 p = place(points.outline[i]);
      float more = field_->clear_m(p.x, p.y) - clear;
      if (more < 0.0F) return false;
      if (borders) more = std::min(more, field_->room_m(p.x, p.y) - room);
      if (more < 0.0F) return false;
      i += 1 + static_cast<std::size_t>(std::max(0.0F, more - kVouches_m) * per_point);
    }
  }
  return std::ranges::all_of(part.inner, [&](Vec2 q) {
    const Vec2 p = place(q);
    return field_->clear_m(p.x, p.y) >= points.inner_m;
  });
}

bool Body::clears(const Pose2& pose) const noexcept {
  const Stand at{pose};
  return circle_fits(at, about_, false) || stands(at, false);
}

bool Body::touches(const sense::Patch& patch, const sense::Footprint& shape, const Pose2& pose) {
  const Pose2 bo = sense::inverse(pose);
  const double reach = shape.reach_m();
  const auto cell = [&](double v) {
    return static_cast<std::int32_t>(std::floor(v / patch.cell_m));
  };
  for (std::int32_t y = cell(pose.y_m - reach); y <= cell(pose.y_m + reach); ++y) {
    for (std::int32_t x = cell(pose.x_m - reach); x <= cell(pose.x_m + reach); ++x) {
      const sense::Known k = patch.at(x, y).known;
      if (k != sense::Known::Occupied && k != sense::Known::Drop) continue;
      const Pose2 in = bo * Pose2{(x + 0.5) * patch.cell_m, (y + 0.5) * patch.cell_m, 0.0};
      if (shape.distance_m({in.x_m, in.y_m}) <= 0.0) return true;
    }
  }
  return false;
}

}  // namespace roverd::nav::around
