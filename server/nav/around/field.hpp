#pragma once
// What a pose is judged by, laid out once per question over the window of the patch:
//
//   fine cells (the patch's)  metres to the nearest thing that stands there
//   coarse cells (10 cm)      room to the corridor's and the fence's borders; what a metre costs;
//                             and, outwards from the goals, what the way to them costs (to_go)
//
// Memory is kept from one question to the next. Frame O, metres.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "nav/around/around.hpp"
#include "nav/around/lane.hpp"

namespace roverd::nav::around {

/// Which of the borders hold; without one of them it is told why there was no way with it.
struct Borders {
  bool corridor = true;
  bool fence = true;
};

class Field {
 public:
  static constexpr float kFar_m = 3.0F;  ///< distances and rooms are not told beyond this
  static constexpr float kNever = 1e9F;

  /// @param lane the question's route. @param margin_m inside of the fence
  void lay(const sense::Patch& patch, const Question& q, const Lane& lane);

  /// To the nearest thing's middle; outside of the window −1: nobody goes there.
  float clear_m(double x, double y) const noexcept {
    const double fx = (x - x0_m_) * per_cell_;
    const double fy = (y - y0_m_) * per_cell_;
    if (fx < 0.0 || fy < 0.0 || fx >= side_ || fy >= side_) return -1.0F;
    return between(clear_, side_, fx, fy);
  }
  /// Room to corridor and fence, negative outside.
  float room_m(double x, double y) const noexcept {
    return between(room_, n_, (x - x0_m_) * per_coarse_, (y - y0_m_) * per_coarse_);
  }
  /// What a metre costs here, at least 1.
  float price(double x, double y) const noexcept {
    const std::size_t i = coarse(x, y);
    return i == kNowhere ? 1.0F : std::max(1.0F, price_[i]);
  }
  bool unseen(double x, double y) const noexcept;
  /// Whether somewhere between these corners; true where they do not lie in the window.
  bool any_unseen(Vec2 low, Vec2 high) const noexcept;

  /// A metre's price in each coarse cell, 0 where the body does not fit whatever its heading.
  /// @param inner_m radius of the largest circle about the origin within the body. @param least_m
  /// from that to the middle of what stands there
  void price_all(const Question& q, double inner_m, double least_m, Borders borders);

  struct Goal {
    Vec2 at;
    float cost = 0.0F;
  };
  /// Costs from everywhere to the goals; no farther than `beyond` more than from `from`.
  void flood(std::span<const Goal> goals, Vec2 from, float beyond);
  float to_go(double x, double y) const noexcept {
    const std::size_t i = coarse(x, y);
    return i == kNowhere ? kNever : to_go_[i];
  }

  /// Every coarse cell that the body may pass and that lies between two places of the route.
  void across(double from_m, double to_m, float cost, std::vector<Goal>& out) const;
  /// Along the route, of its place nearest to the coarse cell there; outside less than any.
  double along_m(double x, double y) const noexcept {
    const std::size_t i = coarse(x, y);
    return i == kNowhere ? -1e9 : static_cast<double>(along_[i]);
  }

  /// flood() came to the window's edge, beside a place of the route after this one.
  bool edge_reached(double after_m) const noexcept;

  double cell_m() const noexcept { return cell_m_; }
  bool inside(double x, double y, double margin_m) const noexcept;

 private:
  static constexpr std::size_t kNowhere = ~std::size_t{0};
  std::size_t coarse(double x, double y) const noexcept {
    const auto ix = static_cast<std::int32_t>((x - x0_m_) * per_coarse_);
    const auto iy = static_cast<std::int32_t>((y - y0_m_) * per_coarse_);
    if (x < x0_m_ || y < y0_m_ || ix >= n_ || iy >= n_) return kNowhere;
    return static_cast<std::size_t>(iy) * static_cast<std::size_t>(n_) +
           static_cast<std::size_t>(ix);
  }
  /// Between the middles of four cells.
  static float between(const std::vector<float>& v, std::int32_t n, double fx, double fy) noexcept {
    fx = std::clamp(fx - 0.5, 0.0, n - 1.001);
    fy = std::clamp(fy - 0.5, 0.0, n - 1.001);
    const auto ix = static_cast<std::int32_t>(fx);
    const auto iy = static_cast<std::int32_t>(fy);
    const auto tx = static_cast<float>(fx - ix);
    const auto ty = static_cast<float>(fy - iy);
    const float* a = v.data() + static_cast<std::size_t>(iy) * static_cast<std::size_t>(n) + ix;
    const float* b = a + n;
    const float low = a[0] + tx * (a[1] - a[0]);
    const float high = b[0] + tx * (b[1] - b[0]);
    return low + ty * (high - low);
  }
  Vec2 middle(std::int32_t ix, std::int32_t iy) const noexcept {
    return {x0_m_ + (ix + 0.5) * coarse_m_, y0_m_ + (iy + 0.5) * coarse_m_};
  }
  void lay_corridor(const Question& q, const Lane& lane);
  void lay_fence(const Question& q);
  void lay_ring(const Ring& ring, bool keep_in);
  void mark_unseen(const sense::Patch& patch, const Question& q);
  void mark_before(const Question& q);
  void relax(std::size_t cell, float cost);

  double cell_m_ = 0.05;
  double coarse_m_ = 0.1;
  double per_cell_ = 20.0;
  double per_coarse_ = 10.0;
  double x0_m_ = 0.0;
  double y0_m_ = 0.0;
  std::int32_t side_ = 0;
  std::int32_t n_ = 0;  ///< coarse cells a side
  std::int32_t k_ = 2;  ///< fine cells a coarse one
  std::vector<float> clear_;
  std::vector<float> corridor_;
  std::vector<float> fence_;
  std::vector<float> ring_;
  std::vector<float> room_;
  std::vector<float> along_;
  std::vector<float> price_;
  std::vector<float> to_go_;
  std::vector<std::uint8_t> unseen_;
  std::vector<std::uint8_t> before_;
  std::vector<std::uint32_t> near_;
  std::vector<std::pair<Vec2, Vec2>> edges_;
  bool fenced_ = false;
  std::vector<std::vector<std::uint32_t>> buckets_;
};

}  // namespace roverd::nav::around
