#include "nav/around/search.hpp"

#include <bit>

namespace roverd::nav::around {

namespace {

constexpr double kStep_m = 0.3;
constexpr double kStepOfRadius = 0.12;
constexpr double kMostStep_m = 0.6;
constexpr double kTurn_rad = base::kPi / 12.0;
constexpr double kHeadings = 24.0;
constexpr float kGreed = 1.5F;          // of what is still to go
constexpr float kGoodEnough_m = 0.15F;  // a better way by less is not looked for
constexpr float kGoodEnough = 0.05F;
constexpr float kSame_m = 1e-4F;
constexpr std::size_t kBranches = 9;
constexpr std::size_t kAims = 3;  // targets that are tried from one place

}  // namespace

void Search::reserve(std::size_t expand) {
  room_ = expand * kBranches;
  nodes_.reserve(room_ + 1);
  open_.reserve(room_ + 1);
  slots_.assign(std::bit_ceil(2 * room_), {});
}

void Search::set_primitives(const Wanted& w) {
  primitives_.clear();
  const double bend = 1.0 / w.radius_m;
  const double step_m = std::clamp(kStepOfRadius * w.radius_m, kStep_m, kMostStep_m);
  cell_m_ = 0.5 * step_m;
  // The narrowest arc must lead to another heading, or it is never driven twice in a row.
  headings_ = std::clamp(std::ceil(2.0 * base::kPi / (0.75 * step_m * bend)), kHeadings, 720.0);
  for (const double c : {0.0, bend, -bend, 0.4 * bend, -0.4 * bend}) {
    primitives_.push_back({c, step_m, 0.0});
  }
  if (w.kinematics.pivots) {
    primitives_.push_back({0.0, 0.0, kTurn_rad});
    primitives_.push_back({0.0, 0.0, -kTurn_rad});
  }
  if (w.kinematics.may_reverse) {
    primitives_.push_back({0.0, -step_m, 0.0});
    if (!w.kinematics.pivots) {
      primitives_.push_back({bend, -step_m, 0.0});
      primitives_.push_back({-bend, -step_m, 0.0});
    }
  }
}

std::uint32_t* Search::slot(std::uint64_t key) noexcept {
  const std::size_t mask = slots_.size() - 1;
  auto i = static_cast<std::size_t>((key * 0x9E3779B97F4A7C15ULL) >> 20U) & mask;
  while (slots_[i].run == run_ && slots_[i].key != key) i = (i + 1) & mask;
  if (slots_[i].run != run_) slots_[i] = {key, 0, run_};
  return &slots_[i].node;
}

std::uint32_t* Search::slot(const Pose2& at) noexcept {
  const auto ix = static_cast<std::int64_t>(std::floor(at.x_m / cell_m_)) & 0xFFFFFF;
  const auto iy = static_cast<std::int64_t>(std::floor(at.y_m / cell_m_)) & 0xFFFFFF;
  const auto turns = (at.yaw_rad + base::kPi) / (2.0 * base::kPi) * headings_;
  const auto ih = static_cast<std::int64_t>(turns + 0.5) % static_cast<std::int64_t>(headings_);
  return slot((static_cast<std::uint64_t>(ix) << 34U) | (static_cast<std::uint64_t>(iy) << 10U) |
              static_cast<std::uint64_t>(ih));
}

void Search::offer(const Pose2& at, float g, std::uint32_t parent, std::uint8_t by, float to_go,
                   std::uint32_t& known) {
  const float f = g + kGreed * to_go;
  if (nodes_.size() >= room_) {
    full_ = true;
    return;
  }
  if (known != 0) nodes_[known - 1].closed = true;
  nodes_.push_back({at.x_m, at.y_m, at.yaw_rad, g, parent, by, false});
  known = static_cast<std::uint32_t>(nodes_.size());
  open_.push_back({f, known - 1});
  std::push_heap(open_.begin(), open_.end());
}

void Search::expand(std::uint32_t from, const Price& price) {
  const Node n = nodes_[from];
  const Piece last = n.by == kStart ? Piece{} : primitives_[n.by];
  for (std::uint8_t k = 0; k < primitives_.size(); ++k) {
    const Piece& p = primitives_[k];
    // Back to where it came from.
    if (p.pivot() && last.pivot() && (p.turn_rad > 0.0) != (last.turn_rad > 0.0)) continue;
    const Pose2 to = p.after(pose(n), 1.0);
    const float to_go = price.field->to_go(to.x_m, to.y_m);
    if (to_go >= Field::kNever) continue;
    float g = n.g;
    if (p.pivot() && last.pivot()) g -= Price::kPivot_m;
    if (p.length_m * last.length_m < 0.0) g += Price::kSwitch_m;
    // First what is cheap to ask: may it be any use?
    const float least = g + Price::least(p);
    if (least + to_go >= best_) continue;
    std::uint32_t* known = slot(to);
    if (*known != 0 && nodes_[*known - 1].g <= least + kSame_m) continue;
    const float cost = price.of(pose(n), p);
    if (cost >= Field::kNever) continue;
    if (*known != 0 && nodes_[*known - 1].g <= g + cost + kSame_m) continue;
    offer(to, g + cost, from, k, to_go, *known);
  }
}

void Search::try_link(std::uint32_t from, const Link& link, std::size_t target, const Wanted& w,
                      const Price& price) {
  const Node& n = nodes_[from];
  const float left = best_ - n.g - w.targets[target].cost;
  if (Price::least(link) >= left) return;
  const float cost = price.of(pose(n), link, left);
  if (cost >= left) return;
  best_ = n.g + cost + w.targets[target].cost;
  best_from_ = from;
  best_link_ = link;
  target_ = target;
}

/// The targets that are nearest by a curve are tried.
void Search::aim(std::uint32_t from, const Wanted& w, const Price& price) {
  std::array<std::pair<float, std::size_t>, kAims> nearest;
  nearest.fill({Field::kNever, kNone});
  const Pose2 at = pose(nodes_[from]);
  for (std::size_t i = 0; i < w.targets.size(); ++i) {
    const Link link = dubins(at, w.targets[i].pose, w.radius_m);
    std::pair<float, std::size_t> c{Price::least(link) + w.targets[i].cost, i};
    for (auto& other : nearest) {
      if (c.first < other.first) std::swap(c, other);
    }
  }
  for (const auto& [cost, i] : nearest) {
    if (i == kNone) continue;
    const Pose2& to = w.targets[i].pose;
    try_link(from, dubins(at, to, w.radius_m), i, w, price);
    if (w.kinematics.pivots) {
      try_link(from, dubins(at, to, 2.5 * w.radius_m), i, w, price);
      try_link(from, straight_between_turns(at, to), i, w, price);
    }
  }
}

/// The window's end is an end, if nothing better is found.
void Search::arrive(std::uint32_t at, const Wanted& w) noexcept {
  const Node& n = nodes_[at];
  const Beside by = w.lane->beside({n.x, n.y});
  if (by.along_m < *w.onwards_m) return;
  const double route_rad = w.lane->pose(by.along_m).yaw_rad;
  if (std::abs(base::angle_diff_rad(route_rad, n.yaw)) >= base::kPi / 3.0) return;
  const float cost = n.g + w.onwards_cost * (1.0F + static_cast<float>(by.distance_m));
  if (cost >= best_) return;
  best_ = cost;
  best_from_ = at;
  best_link_ = {};
  target_ = kNone;
}

void Search::collect(std::uint32_t from) {
  pieces_.clear();
  for (std::uint32_t i = from; nodes_[i].by != kStart; i = nodes_[i].parent) {
    pieces_.push_back(primitives_[nodes_[i].by]);
  }
  std::reverse(pieces_.begin(), pieces_.end());
  for (std::size_t i = 0; i < best_link_.size; ++i) pieces_.push_back(best_link_.pieces[i]);
}

Ended Search::run(const Wanted& w, const Price& price) {
  set_primitives(w);
  nodes_.clear();
  open_.clear();
  pieces_.clear();
  if (++run_ == 0) {
    slots_.assign(slots_.size(), {});
    run_ = 1;
  }
  full_ = false;
  expanded_ = 0;
  best_ = Field::kNever;
  best_link_ = {};
  target_ = kNone;
  offer(w.start, 0.0F, 0, kStart, price.field->to_go(w.start.x_m, w.start.y_m), *slot(w.start));
  while (!open_.empty()) {
    const Open top = open_.front();
    if (best_ < Field::kNever && top.f >= best_ - std::max(kGoodEnough_m, kGoodEnough * best_)) {
      break;
    }
    if (expanded_ >= w.expand || full_) break;
    std::pop_heap(open_.begin(), open_.end());
    open_.pop_back();
    Node& n = nodes_[top.node];
    if (n.closed) continue;
    n.closed = true;
    ++expanded_;
    if (w.onwards_m && price.field->along_m(n.x, n.y) >= *w.onwards_m - cell_m_) {
      arrive(top.node, w);
      if (w.targets.empty() && best_ < Field::kNever) break;
    }
    const float to_go = price.field->to_go(n.x, n.y);
    const auto now_and_then = static_cast<std::size_t>(std::clamp(2.0F * to_go, 1.0F, 24.0F));
    if (!w.targets.empty() && (expanded_ == 1 || expanded_ % now_and_then == 0)) {
      aim(top.node, w, price);
    }
    expand(top.node, price);
  }
  if (best_ >= Field::kNever) return open_.empty() && !full_ ? Ended::Exhausted : Ended::GivenUp;
  collect(best_from_);
  return Ended::Found;
}

}  // namespace roverd::nav::around
