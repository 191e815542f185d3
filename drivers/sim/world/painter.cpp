#include "sim/world/painter.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

namespace roverd::sim::world {
namespace {

constexpr double kNear_m = 0.05;
constexpr double kFar_m = 80.0;
constexpr int kSides = 14;  ///< of a round thing
constexpr int kCells = 10;  ///< a tag across, with the white around its border
constexpr double kBorderCells = 8.0;
constexpr int kSub = 4;  ///< samples of a tag's pixel, each way
constexpr double kWhite = 225.0;
constexpr double kBlack = 28.0;
constexpr double kStray = 250.0;   ///< how light stray light is
constexpr double kBeside_m = 1.0;  ///< what is so far away counts for how much a picture blurs

/// How light things are by their kind, so that people can tell them apart.
double lightness(Kind kind) noexcept {
  switch (kind) {
    case Kind::Wall:
      return 165.0;
    case Kind::Pole:
      return 60.0;
    case Kind::Box:
      return 120.0;
    case Kind::Cone:
      return 215.0;
    case Kind::Bush:
    case Kind::Row:
      return 55.0;
    case Kind::Bar:
      return 95.0;
    case Kind::Person:
      return 190.0;
    case Kind::Animal:
      return 80.0;
    case Kind::Tag:
      return kWhite;
  }
  return 120.0;
}

/// The light comes from the south-west, from above. @param n unit
double lit(double shade, Vec3 n) noexcept {
  const double light = -0.45 * n.x - 0.55 * n.y + 0.7 * n.z;
  return shade * (0.8 + 0.25 * light);
}

Vec3 minus(Vec3 a, Vec3 b) noexcept {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Vec3 crossed(Vec3 a, Vec3 b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
std::uint8_t level(double shade) noexcept {
  return static_cast<std::uint8_t>(std::clamp(shade, 0.0, 255.0));
}

/// What of a face lies before the camera.
std::vector<Vec3> cut_near(const std::vector<Vec3>& face) {
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < face.size(); ++i) {
    const Vec3 a = face[i];
    const Vec3 b = face[(i + 1) % face.size()];
    if (a.x >= kNear_m) out.push_back(a);
    if ((a.x >= kNear_m) != (b.x >= kNear_m)) {
      out.push_back(a + ((kNear_m - a.x) / (b.x - a.x)) * minus(b, a));
    }
  }
  return out;
}

}  // namespace

Painter::Painter(int columns, int rows, double fov_rad)
    : columns_(columns),
      rows_(rows),
      f_(columns / 2.0 / std::tan(fov_rad / 2.0)),
      grey_(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)),
      light_(grey_.size()),
      near_(grey_.size()) {}

Vec3 Painter::seen_turned(Vec3 v) const noexcept {
  const auto& r = camera_.r;
  return {r[0][0] * v.x + r[1][0] * v.y + r[2][0] * v.z,
          r[0][1] * v.x + r[1][1] * v.y + r[2][1] * v.z,
          r[0][2] * v.x + r[1][2] * v.y + r[2][2] * v.z};
}

Vec3 Painter::seen(Vec3 at) const noexcept {
  return seen_turned(minus(at, camera_.p));
}

void Painter::expose(const Scene& scene, const Moment& moment, const Frame& camera) {
  camera_ = camera;
  paint_ground(scene);
  scene.near({camera.p.x, camera.p.y}, kFar_m, moment,
             [&](const Shape& shape) { paint_shape(scene, shape); });
  paint_tags(scene);
  if (pieces_ == 0) std::ranges::fill(light_, std::uint16_t{0});
  ++pieces_;
  for (std::size_t i = 0; i < grey_.size(); ++i) {
    light_[i] = static_cast<std::uint16_t>(light_[i] + grey_[i]);
  }
}

const std::vector<std::uint8_t>& Painter::develop(std::uint64_t number, double glare) {
  const double pieces = std::max(1, std::exchange(pieces_, 0));
  for (std::size_t i = 0; i < grey_.size(); ++i) {
    grey_[i] = level(std::lerp(light_[i] / pieces, kStray, glare) + 0.5);
  }
  add_noise(number);
  return grey_;
}

double Painter::blur_px(const Frame& from, const Frame& to) const noexcept {
  const Vec3 way = minus(to.p, from.p);
  double turned = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Vec3 a{from.r[0][axis], from.r[1][axis], from.r[2][axis]};
    const Vec3 off = minus({to.r[0][axis], to.r[1][axis], to.r[2][axis]}, a);
    turned = std::max(turned, std::sqrt(dot(off, off)));
  }
  return f_ * (turned + std::sqrt(dot(way, way)) / kBeside_m);
}

/// Level, as it is under the camera, with patches by which one sees that one moves.
void Painter::paint_ground(const Scene& scene) {
  const double over_m = camera_.p.z - scene.terrain().surface_m({camera_.p.x, camera_.p.y});
  const auto& r = camera_.r;
  const double light = 70.0 + 140.0 * scene.world().ground.reflect;
  for (int v = 0; v < rows_; ++v) {
    const double up = -(v + 0.5 - rows_ / 2.0) / f_;
    const auto row = static_cast<std::size_t>(v) * static_cast<std::size_t>(columns_);
    for (int u = 0; u < columns_; ++u) {
      const double left = -(u + 0.5 - columns_ / 2.0) / f_;
      const std::size_t at = row + static_cast<std::size_t>(u);
      const double down = -(r[2][0] + r[2][1] * left + r[2][2] * up);
      const double nearness = over_m > 0.0 ? down / over_m : 0.0;  // 1 / ahead
      if (nearness < 1.0 / 400.0) {
        near_[at] = 0.0F;
        grey_[at] = level(235.0 + 60.0 * std::min(0.0, down));
        continue;
      }
      near_[at] = static_cast<float>(nearness);
      double shade = light;
      if (nearness > 1.0 / 25.0) {
        const double ahead = 1.0 / nearness;
        const double x = camera_.p.x + ahead * (r[0][0] + r[0][1] * left + r[0][2] * up);
        const double y = camera_.p.y + ahead * (r[1][0] + r[1][1] * left + r[1][2] * up);
        const auto patch = static_cast<std::uint64_t>(std::floor(x * 2.0) + 1e6) * 2'000'003U +
                           static_cast<std::uint64_t>(std::floor(y * 2.0) + 1e6);
        shade += 24.0 * (share_of(spread(patch)) - 0.5) * (1.0 - 1.0 / (nearness * 25.0));
      }
      grey_[at] = level(shade);
    }
  }
}

void Painter::paint_shape(const Scene& scene, const Shape& shape) {
  const Vec3 middle = seen({shape.x, shape.y, (shape.low_m + shape.high_m) / 2.0});
  const double size = shape.reach_m() + (shape.high_m - shape.low_m) / 2.0;
  if (middle.x < -size || middle.x > kFar_m + size) return;
  const Thing& thing = scene.world().things[shape.thing];
  const double shade = lightness(thing.kind) * (0.5 + static_cast<double>(shape.reflect));
  switch (shape.form) {
    case Form::Box:
    case Form::Cylinder:
      return paint_prism(shape, shade);
    case Form::Cone:
      return paint_cone(shape, shade);
    case Form::Sphere:
      return paint_ball(shape, shade);
  }
}

void Painter::paint_prism(const Shape& shape, double shade) {
  std::vector<Vec2> plan;
  if (shape.form == Form::Box) {
    for (const auto& [i, k] : {std::pair{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}) {
      plan.push_back({shape.x + i * shape.a * shape.c - k * shape.b * shape.s,
                      shape.y + i * shape.a * shape.s + k * shape.b * shape.c});
    }
  } else {
    for (int i = 0; i < kSides; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kSides;
      plan.push_back({shape.x + shape.a * std::cos(angle), shape.y + shape.a * std::sin(angle)});
    }
  }
  Face top;
  Face bottom;
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const Vec2 a = plan[i];
    const Vec2 b = plan[(i + 1) % plan.size()];
    const Vec2 side = b - a;
    const double long_m = std::max(1e-9, length(side));
    const Vec3 outward{side.y / long_m, -side.x / long_m, 0.0};
    paint_face({{a.x, a.y, shape.low_m},
                {b.x, b.y, shape.low_m},
                {b.x, b.y, shape.high_m},
                {a.x, a.y, shape.high_m}},
               lit(shade, outward));
    top.push_back({a.x, a.y, shape.high_m});
    bottom.push_back({a.x, a.y, shape.low_m});
  }
  paint_face(top, lit(shade, {0, 0, 1}));
  paint_face(bottom, lit(shade, {0, 0, -1}));
}

void Painter::paint_cone(const Shape& shape, double shade) {
  const Vec3 tip{shape.x, shape.y, shape.high_m};
  for (int i = 0; i < kSides; ++i) {
    const auto corner = [&](int k) {
      const double angle = 2.0 * std::numbers::pi * k / kSides;
      return Vec3{shape.x + shape.a * std::cos(angle), shape.y + shape.a * std::sin(angle),
                  shape.low_m};
    };
    const double middle = 2.0 * std::numbers::pi * (i + 0.5) / kSides;
    paint_face({corner(i), corner(i + 1), tip},
               lit(shade, {std::cos(middle), std::sin(middle), 0.2}));
  }
}

/// A disc that looks at the camera.
void Painter::paint_ball(const Shape& shape, double shade) {
  const Vec3 middle{shape.x, shape.y, (shape.low_m + shape.high_m) / 2.0};
  const auto& r = camera_.r;
  const Vec3 left{r[0][1], r[1][1], r[2][1]};
  const Vec3 up{r[0][2], r[1][2], r[2][2]};
  Face disc;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kSides;
    disc.push_back(middle + (shape.a * std::cos(angle)) * left + (shape.a * std::sin(angle)) * up);
  }
  const double tint = share_of(spread(static_cast<std::uint64_t>(
      std::llround(middle.x * 997.0 + middle.y * 131.0 + middle.z * 17.0) + 1'000'000'000)));
  paint_face(disc, shade * (0.8 + 0.5 * tint));
}

/// Convex, its corners in E, either way round.
void Painter::paint_face(const Face& corners, double shade) {
  Face face;
  face.reserve(corners.size());
  for (const Vec3 at : corners) face.push_back(seen(at));
  face = cut_near(face);
  if (face.size() < 3) return;
  const Vec3 n = crossed(minus(face[1], face[0]), minus(face[2], face[0]));
  const double d = dot(n, face[0]);
  if (std::abs(d) < 1e-12) return;  // seen from its edge
  double low = 1e9;
  double high = -1e9;
  std::vector<Vec2> at;
  for (const Vec3 p : face) {
    at.push_back({columns_ / 2.0 - f_ * p.y / p.x, rows_ / 2.0 - f_ * p.z / p.x});
    low = std::min(low, at.back().y);
    high = std::max(high, at.back().y);
  }
  const int first = static_cast<int>(std::clamp(std::ceil(low - 0.5), 0.0, double(rows_)));
  const int last = static_cast<int>(std::clamp(std::floor(high - 0.5), -1.0, rows_ - 1.0));
  for (int v = first; v <= last; ++v) {
    const double y = v + 0.5;
    double from = 1e9;
    double to = -1e9;
    for (std::size_t i = 0; i < at.size(); ++i) {
      const Vec2 a = at[i];
      const Vec2 b = at[(i + 1) % at.size()];
      if ((a.y <= y) == (b.y <= y)) continue;
      const double x = a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y);
      from = std::min(from, x);
      to = std::max(to, x);
    }
    const int begin = static_cast<int>(std::clamp(std::ceil(from - 0.5), 0.0, double(columns_)));
    const int end = static_cast<int>(std::clamp(std::floor(to - 0.5), -1.0, columns_ - 1.0));
    const double row_part = n.x - n.z * (y - rows_ / 2.0) / f_;
    for (int u = begin; u <= end; ++u) {
      const double nearness = (row_part - n.y * (u + 0.5 - columns_ / 2.0) / f_) / d;
      const std::size_t pixel = static_cast<std::size_t>(v) * static_cast<std::size_t>(columns_) +
                                static_cast<std::size_t>(u);
      if (nearness <= static_cast<double>(near_[pixel])) continue;
      near_[pixel] = static_cast<float>(nearness);
      grey_[pixel] = level(shade);
    }
  }
}

const std::array<bool, 100>& Painter::cells_of(int id) {
  const auto known = cells_.find(id);
  if (known != cells_.end()) return known->second;
  auto& cells = cells_[id];
  apriltag_family_t* family = tag36h11_create();
  image_u8_t* image = apriltag_to_image(family, id);
  for (int row = 0; row < kCells; ++row) {
    for (int column = 0; column < kCells; ++column) {
      cells[static_cast<std::size_t>(row * kCells + column)] =
          image->buf[row * image->stride + column] > 127;
    }
  }
  std::free(image->buf);
  std::free(image);
  tag36h11_destroy(family);
  return cells;
}

/// The farthest first: a nearer one covers it.
void Painter::paint_tags(const Scene& scene) {
  std::vector<std::pair<double, const Thing*>> tags;
  for (const Thing& thing : scene.world().things) {
    if (thing.kind != Kind::Tag) continue;
    const Vec2 off = thing.points.front() - Vec2{camera_.p.x, camera_.p.y};
    tags.emplace_back(length(off), &thing);
  }
  std::ranges::stable_sort(tags, std::ranges::greater{}, [](const auto& tag) { return tag.first; });
  for (const auto& [away_m, tag] : tags) {
    paint_tag(*tag, scene.terrain().surface_m(tag->points.front()));
  }
}

/// Each of its pixels by the rays through it.
void Painter::paint_tag(const Thing& tag, double ground_m) {
  const double c = std::cos(tag.yaw_rad);
  const double s = std::sin(tag.yaw_rad);
  const Vec3 n = seen_turned({c, s, 0.0});
  const Vec3 middle = seen({tag.points.front().x, tag.points.front().y, ground_m + tag.height_m});
  const double facing = dot(n, middle);
  if (facing >= 0.0) return;  // from behind
  const Vec3 right = seen_turned({-s, c, 0.0});
  const Vec3 down = seen_turned({0.0, 0.0, -1.0});
  const double half_m = tag.length_m / 2.0 * kCells / kBorderCells;
  Vec2 low{1e9, 1e9};
  Vec2 high{-1e9, -1e9};
  for (const auto& [i, k] : {std::pair{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}) {
    const Vec3 p = middle + (i * half_m) * right + (k * half_m) * down;
    if (p.x < kNear_m) return;
    const Vec2 at{columns_ / 2.0 - f_ * p.y / p.x, rows_ / 2.0 - f_ * p.z / p.x};
    low = {std::min(low.x, at.x), std::min(low.y, at.y)};
    high = {std::max(high.x, at.x), std::max(high.y, at.y)};
  }
  const auto cut = [](double x, int most) {
    return static_cast<int>(std::clamp(x, 0.0, static_cast<double>(most)));
  };
  const auto& cells = cells_of(std::clamp(static_cast<int>(tag.id), 0, kTags - 1));
  for (int v = cut(std::floor(low.y), rows_); v < cut(std::ceil(high.y), rows_); ++v) {
    for (int u = cut(std::floor(low.x), columns_); u < cut(std::ceil(high.x), columns_); ++u) {
      const std::size_t pixel = static_cast<std::size_t>(v) * static_cast<std::size_t>(columns_) +
                                static_cast<std::size_t>(u);
      double sum = 0.0;
      for (int sub = 0; sub < kSub * kSub; ++sub) {
        const Vec3 ray{1.0, -(u + (sub % kSub + 0.5) / kSub - columns_ / 2.0) / f_,
                       -(v + (sub / kSub + 0.5) / kSub - rows_ / 2.0) / f_};
        const double along = dot(n, ray);
        const double ahead = along < 0.0 ? facing / along : 0.0;
        const Vec3 off = minus(ahead * ray, middle);
        const double x = (dot(off, right) / half_m + 1.0) / 2.0 * kCells;
        const double y = (dot(off, down) / half_m + 1.0) / 2.0 * kCells;
        const bool on = x >= 0.0 && x < kCells && y >= 0.0 && y < kCells;
        // What stands before it, not the plate that bears it.
        const bool hidden = static_cast<double>(near_[pixel]) * (ahead - 0.02) > 1.0;
        if (!on || hidden) {
          sum += grey_[pixel];
        } else {
          sum += cells[static_cast<std::size_t>(static_cast<int>(y) * kCells + static_cast<int>(x))]
                     ? kWhite
                     : kBlack;
        }
      }
      grey_[pixel] = level(sum / (kSub * kSub) + 0.5);
    }
  }
}

/// About 1.6 grey levels, 1 sigma.
void Painter::add_noise(std::uint64_t number) {
  std::uint64_t state = spread(number);
  for (std::size_t i = 0; i < grey_.size(); i += 8) {
    state = spread(state);
    for (std::size_t k = 0; k < 8 && i + k < grey_.size(); ++k) {
      const auto byte = static_cast<unsigned>(state >> (8 * k) & 0xFFU);
      const int noise = static_cast<int>((byte & 3U) + (byte >> 2U & 3U) + (byte >> 4U & 1U)) - 3;
      grey_[i + k] = static_cast<std::uint8_t>(std::clamp(int{grey_[i + k]} + noise, 0, 255));
    }
  }
}

}  // namespace roverd::sim::world
