#include "nav/around/body.hpp"

#include <algorithm>
#include <cmath>

namespace roverd::nav::around {

namespace {

constexpr float kBetween_m = 0.010F;  // what interpolation may tell too much
constexpr float kRoom_m = 0.02F;      // the same of coarse cells
constexpr double kAboutStart_m = 1.5;
constexpr float kNearer_m = 0.003F;

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
  reach_m_ = shape.reach_m();
  inner_m_ = std::max(0.0, -shape.distance_m({0.0, 0.0}));
  least_m_ = static_cast<float>(least_m + 0.7072 * field.cell_m()) + kBetween_m;
  sample_m_ = std::sqrt(least_m_ * least_m_ + static_cast<float>(2.0 * kApart_m * kApart_m));
  along_outline(shape, 2.0 * kApart_m, outline_);
  along_outline(shape, 0.4 * kApart_m, dense_);
  within_outline(shape, 4.0 * kApart_m, inner_);
  within_outline(shape, 2.0 * kApart_m, dense_inner_);
  double back = 1e9;
  double front = -1e9;
  double half = 0.0;
  for (const Vec2 c : shape.corners()) {
    back = std::min(back, c.x);
    front = std::max(front, c.x);
    half = std::max(half, std::abs(c.y));
  }
  const int n = std::clamp(static_cast<int>(std::ceil((front - back) / (0.8 * half))), 1, 12);
  cover_.clear();
  for (int i = 0; i < n; ++i) {
    const double a = back + (front - back) * i / n;
    const double b = back + (front - back) * (i + 1) / n;
    double low = 1e9;
    double high = -1e9;
    const auto take = [&](double x) {
      const auto [l, h] = slice(shape, x);
      low = std::min(low, l);
      high = std::max(high, h);
    };
    take(a);
    take(b);
    for (const Vec2 c : shape.corners()) {
      if (c.x > a && c.x < b) take(c.x);
    }
    const Vec2 middle{0.5 * (a + b), 0.5 * (low + high)};
    cover_.push_back({middle, static_cast<float>(std::hypot(0.5 * (b - a), 0.5 * (high - low)))});
  }
  about_.at = {0.5 * (back + front), 0.0};
  about_.radius_m = 0.0F;
  for (const Vec2 c : shape.corners()) {
    const Vec2 d = c - about_.at;
    about_.radius_m = std::max(about_.radius_m, static_cast<float>(std::hypot(d.x, d.y)));
  }
}

void Body::allow_start(const Pose2& start) {
  start_ = start;
  allowed_ = true;
  start_clear_m_ = Field::kFar_m;
  start_room_m_ = Field::kFar_m;
  const double c = std::cos(start.yaw_rad);
  const double s = std::sin(start.yaw_rad);
  for (const Vec2 p : dense_) {
    const double x = start.x_m + c * p.x - s * p.y;
    const double y = start.y_m + s * p.x + c * p.y;
    start_clear_m_ = std::min(start_clear_m_, field_->clear_m(x, y));
    start_room_m_ = std::min(start_room_m_, field_->room_m(x, y));
  }
  start_clear_m_ -= kNearer_m;
  start_room_m_ -= kNearer_m;
}

bool Body::circles_fit(const Pose2& pose, double c, double s, bool borders) const noexcept {
  const auto fits = [&](const Circle& k) {
    const double x = pose.x_m + c * k.at.x - s * k.at.y;
    const double y = pose.y_m + s * k.at.x + c * k.at.y;
    return field_->clear_m(x, y) >= k.radius_m + least_m_ &&
           (!borders || field_->room_m(x, y) >= k.radius_m + kRoom_m);
  };
  return fits(about_) || std::all_of(cover_.begin(), cover_.end(), fits);
}

bool Body::fits(const Pose2& pose) const noexcept {
  if (!field_->inside(pose.x_m, pose.y_m, 0.0)) return false;
  const double c = std::cos(pose.yaw_rad);
  const double s = std::sin(pose.yaw_rad);
  if (circles_fit(pose, c, s, true)) return true;
  const double dx = pose.x_m - start_.x_m;
  const double dy = pose.y_m - start_.y_m;
  float clear = sample_m_;
  float room = kRoom_m;
  if (allowed_ && dx * dx + dy * dy < kAboutStart_m * kAboutStart_m &&
      (start_clear_m_ < clear || start_room_m_ < room)) {
    clear = std::min(clear, start_clear_m_);
    room = std::min(room, start_room_m_);
    return all_clear(pose, dense_, clear, room) &&
           all_clear(pose, dense_inner_, static_cast<float>(1.42 * kApart_m), -Field::kFar_m);
  }
  return all_clear(pose, outline_, clear, room) &&
         all_clear(pose, inner_, static_cast<float>(2.83 * kApart_m), -Field::kFar_m);
}

bool Body::all_clear(const Pose2& pose, const std::vector<Vec2>& points, float clear,
                     float room) const noexcept {
  const double c = std::cos(pose.yaw_rad);
  const double s = std::sin(pose.yaw_rad);
  return std::all_of(points.begin(), points.end(), [&](Vec2 p) {
    const double x = pose.x_m + c * p.x - s * p.y;
    const double y = pose.y_m + s * p.x + c * p.y;
    return field_->clear_m(x, y) >= clear &&
           (room <= -Field::kFar_m || field_->room_m(x, y) >= room);
  });
}

bool Body::clears(const Pose2& pose) const noexcept {
  if (circles_fit(pose, std::cos(pose.yaw_rad), std::sin(pose.yaw_rad), false)) return true;
  return all_clear(pose, outline_, sample_m_, -Field::kFar_m) &&
         all_clear(pose, inner_, static_cast<float>(2.83 * kApart_m), -Field::kFar_m);
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
