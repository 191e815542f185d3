#include "sim/world/scene.hpp"

#include <algorithm>
#include <bit>
#include <optional>
#include <string_view>
#include <utility>

namespace roverd::sim::world {
namespace {

constexpr double kMostCells = 1'000'000.0;
constexpr double kLeastCell_m = 0.5;
constexpr double kSkin_m = 1e-9;

}  // namespace

Scene::Scene(World world) : world_(std::move(world)), terrain_(world_.ground, world_.seed) {
  build();
  index();
}

void Scene::build() {
  for (std::uint32_t i = 0; i < world_.things.size(); ++i) {
    if (moves(world_.things[i].kind)) {
      movers_.push_back(i);
    } else {
      build_thing(world_, terrain_, i, shapes_);
    }
  }
}

void Scene::index() {
  if (shapes_.empty()) return;
  Vec2 low{kReach_m * 2, kReach_m * 2};
  Vec2 high{-kReach_m * 2, -kReach_m * 2};
  top_m_ = shapes_.front().high_m;
  bottom_m_ = shapes_.front().low_m;
  for (const Shape& s : shapes_) {
    const double r = s.reach_m();
    low = {std::min(low.x, s.x - r), std::min(low.y, s.y - r)};
    high = {std::max(high.x, s.x + r), std::max(high.y, s.y + r)};
    top_m_ = std::max(top_m_, s.high_m);
    bottom_m_ = std::min(bottom_m_, s.low_m);
  }
  // About one shape for each cell where they stand evenly.
  const double area = std::max(1.0, (high.x - low.x) * (high.y - low.y));
  const double wanted = std::min(kMostCells, 2.0 * static_cast<double>(shapes_.size()) + 64.0);
  cell_m_ = std::max(kLeastCell_m, std::sqrt(area / wanted));
  corner_ = {low.x - kSkin_m, low.y - kSkin_m};
  columns_ = 1 + static_cast<int>((high.x - corner_.x) / cell_m_);
  rows_ = 1 + static_cast<int>((high.y - corner_.y) / cell_m_);
  const std::size_t cells = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  begins_.assign(cells + 1, 0);
  tops_.assign(cells, -1e9F);
  const auto each_cell = [&](const Shape& s, auto&& use) {
    const double r = s.reach_m();
    for (int row = row_of(s.y - r); row <= row_of(s.y + r); ++row) {
      for (int column = column_of(s.x - r); column <= column_of(s.x + r); ++column) {
        use(cell_of(column, row));
      }
    }
  };
  for (const Shape& s : shapes_) each_cell(s, [&](std::size_t cell) { ++begins_[cell + 1]; });
  for (std::size_t i = 0; i < cells; ++i) begins_[i + 1] += begins_[i];
  held_.resize(begins_.back());
  std::vector<std::uint32_t> next(begins_.begin(), begins_.end() - 1);
  for (std::uint32_t i = 0; i < shapes_.size(); ++i) {
    each_cell(shapes_[i], [&](std::size_t cell) {
      held_[next[cell]++] = i;
      tops_[cell] = std::max(tops_[cell], static_cast<float>(shapes_[i].high_m + 1e-3));
    });
  }
}

int Scene::column_of(double x) const noexcept {
  return static_cast<int>(std::clamp((x - corner_.x) / cell_m_, 0.0, columns_ - 1.0));
}

int Scene::row_of(double y) const noexcept {
  return static_cast<int>(std::clamp((y - corner_.y) / cell_m_, 0.0, rows_ - 1.0));
}

std::string Scene::name_of(int thing) const {
  if (thing == kGround) return "ground";
  if (thing < 0 || static_cast<std::size_t>(thing) >= world_.things.size()) return "nothing";
  const Thing& one = world_.things[static_cast<std::size_t>(thing)];
  if (!one.name.empty()) return one.name;
  return std::string(to_string(one.kind)) + " " + std::to_string(thing);
}

std::optional<std::size_t> Scene::mover(std::string_view name) const {
  for (std::size_t i = 0; i < world_.things.size(); ++i) {
    const Thing& one = world_.things[i];
    const bool moves = one.kind == Kind::Person || one.kind == Kind::Animal;
    if (moves && one.name == name) return i;
  }
  return std::nullopt;
}

void Scene::begin_walk(std::string_view name, double at_s) {
  if (const auto i = mover(name)) world_.things[*i].start_s = at_s;
}

Moment Scene::at(double at_s) const {
  Moment moment;
  move_to(moment, at_s);
  return moment;
}

void Scene::move_to(Moment& moment, double at_s) const {
  moment.at_s = at_s;
  moment.shapes.clear();
  for (const std::uint32_t i : movers_) {
    build_mover(world_, terrain_, i, at_s, moment.shapes);
  }
}

/// @param best holds what was met so far; its range bounds what can still be nearer.
void Scene::meet(const Shape& shape, const Ray& ray, std::uint64_t key, Hit& best,
                 const Shape*& met) const noexcept {
  const Span span = span_in(shape, ray.from, ray.dir);
  if (span.empty() || span.to < 0.0 || span.from >= best.range_m) return;
  double range_m = std::max(0.0, span.from);
  if (shape.density_pm > 0.0F) {
    // Drawn by the shape, not in the order of the search: a shape met in two cells is met alike.
    const auto place = std::bit_cast<std::uint64_t>(shape.x) +
                       3 * std::bit_cast<std::uint64_t>(shape.y) +
                       7 * std::bit_cast<std::uint64_t>(shape.low_m);
    range_m += Draw(key ^ spread(place)).exponential() / static_cast<double>(shape.density_pm);
    if (range_m > span.to || range_m >= best.range_m) return;
  }
  best.range_m = range_m;
  best.thing = static_cast<int>(shape.thing);
  met = &shape;
}

void Scene::walk(const Ray& ray, std::uint64_t key, Hit& best, const Shape*& met) const noexcept {
  const double wide = columns_ * cell_m_;
  const double tall = rows_ * cell_m_;
  double enter = 0.0;
  double leave = best.range_m;
  const auto cut = [&](double o, double d, double size) {
    if (d == 0.0) {
      if (o < 0.0 || o > size) leave = -1.0;
      return;
    }
    const double one = -o / d;
    const double two = (size - o) / d;
    enter = std::max(enter, std::min(one, two));
    leave = std::min(leave, std::max(one, two));
  };
  const double ox = ray.from.x - corner_.x;
  const double oy = ray.from.y - corner_.y;
  cut(ox, ray.dir.x, wide);
  cut(oy, ray.dir.y, tall);
  // Above all of it, and rising?
  if (ray.from.z > top_m_) {
    if (ray.dir.z >= 0.0) return;
    enter = std::max(enter, (top_m_ - ray.from.z) / ray.dir.z);
  } else if (ray.dir.z > 0.0) {
    leave = std::min(leave, (top_m_ - ray.from.z) / ray.dir.z);
  }
  if (ray.dir.z < 0.0) leave = std::min(leave, (bottom_m_ - ray.from.z) / ray.dir.z);
  if (enter > leave) return;
  // Source: Amanatides, Woo 1987.
  int column = column_of(ray.from.x + enter * ray.dir.x);
  int row = row_of(ray.from.y + enter * ray.dir.y);
  const int step_x = ray.dir.x > 0.0 ? 1 : -1;
  const int step_y = ray.dir.y > 0.0 ? 1 : -1;
  const double far = 1e30;
  const double delta_x = ray.dir.x != 0.0 ? cell_m_ / std::abs(ray.dir.x) : far;
  const double delta_y = ray.dir.y != 0.0 ? cell_m_ / std::abs(ray.dir.y) : far;
  double next_x =
      ray.dir.x != 0.0 ? ((column + (step_x > 0 ? 1 : 0)) * cell_m_ - ox) / ray.dir.x : far;
  double next_y =
      ray.dir.y != 0.0 ? ((row + (step_y > 0 ? 1 : 0)) * cell_m_ - oy) / ray.dir.y : far;
  double at = enter;
  while (true) {
    const double exit = std::min(next_x, next_y);
    const std::size_t cell = cell_of(column, row);
    const double lowest = ray.from.z + (ray.dir.z < 0.0 ? std::min(exit, leave) : at) * ray.dir.z;
    if (lowest <= static_cast<double>(tops_[cell])) {
      for (std::uint32_t i = begins_[cell]; i < begins_[cell + 1]; ++i) {
        meet(shapes_[held_[i]], ray, key, best, met);
      }
    }
    if (exit >= best.range_m || exit > leave) return;
    at = exit;
    if (next_x < next_y) {
      column += step_x;
      if (column < 0 || column >= columns_) return;
      next_x += delta_x;
    } else {
      row += step_y;
      if (row < 0 || row >= rows_) return;
      next_y += delta_y;
    }
  }
}

Hit Scene::finish(const Ray& ray, double max_m, double grass_m, Hit best,
                  const Shape* met) const noexcept {
  if (met != nullptr) {
    best.leaf = met->density_pm > 0.0F;
    best.reflect = static_cast<double>(met->reflect);
  }
  const auto ground = terrain_.meet(ray.from, ray.dir, std::min(max_m, best.range_m), grass_m);
  if (ground)
    return {ground->range_m, kGround, grass_m > 0.0, ground->cosine, world_.ground.reflect};
  if (met == nullptr) return {};
  best.cosine = best.leaf ? 0.7 : facing(*met, ray.from + best.range_m * ray.dir, ray.dir);
  return best;
}

Hit Scene::cast(const Ray& ray, double max_m, const Moment& moment, Draw& draw) const noexcept {
  const auto key = static_cast<std::uint64_t>(draw.uniform() * 0x1.0p53);
  // Most blades are short.
  const double blade = world_.ground.grass_m > 0.0 ? draw.uniform() : 0.0;
  const double grass_m = world_.ground.grass_m * blade * blade;
  Hit best;
  best.range_m = max_m;
  const Shape* met = nullptr;
  for (const Shape& shape : moment.shapes) meet(shape, ray, key, best, met);
  if (columns_ > 0) walk(ray, key, best, met);
  return finish(ray, max_m, grass_m, best, met);
}

Hit Scene::cast_slowly(const Ray& ray, double max_m, const Moment& moment,
                       Draw& draw) const noexcept {
  const auto key = static_cast<std::uint64_t>(draw.uniform() * 0x1.0p53);
  const double blade = world_.ground.grass_m > 0.0 ? draw.uniform() : 0.0;
  const double grass_m = world_.ground.grass_m * blade * blade;
  Hit best;
  best.range_m = max_m;
  const Shape* met = nullptr;
  for (const Shape& shape : moment.shapes) meet(shape, ray, key, best, met);
  for (const Shape& shape : shapes_) meet(shape, ray, key, best, met);
  return finish(ray, max_m, grass_m, best, met);
}

}  // namespace roverd::sim::world
