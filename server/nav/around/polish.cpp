#include "nav/around/polish.hpp"

#include <numeric>

namespace roverd::nav::around {

namespace {

constexpr double kCut_m = 0.3;
constexpr float kWorth_m = 0.01F;

}  // namespace

float Polish::change(const Piece& before, const Piece& after) noexcept {
  if (before.length_m * after.length_m < 0.0) return Price::kSwitch_m;
  return 0.0F;
}

void Polish::cut(const Pose2& start, const Price& price, const std::vector<Piece>& pieces) {
  pieces_.clear();
  at_.assign(1, start);
  cost_.clear();
  for (const Piece& p : pieces) {
    const int n =
        p.pivot() ? 1 : std::max(1, static_cast<int>(std::ceil(std::abs(p.length_m) / kCut_m)));
    for (int i = 0; i < n; ++i) {
      const Piece part{p.curvature_1pm, p.length_m / n, p.turn_rad};
      // Turns that follow each other are one.
      if (part.pivot() && !pieces_.empty() && pieces_.back().pivot()) {
        pieces_.back().turn_rad += part.turn_rad;
        at_.back() = pieces_.back().after(at_[at_.size() - 2], 1.0);
        cost_.back() += price.of(at_[at_.size() - 2], part) - Price::kPivot_m;
        continue;
      }
      cost_.push_back(price.of(at_.back(), part));
      pieces_.push_back(part);
      at_.push_back(part.after(at_.back(), 1.0));
    }
  }
}

void Polish::replace(std::size_t from, std::size_t to, const Link& link, const Price& price) {
  std::vector<Piece> whole(pieces_.begin(), pieces_.begin() + static_cast<std::ptrdiff_t>(from));
  for (std::size_t i = 0; i < link.size; ++i) whole.push_back(link.pieces[i]);
  whole.insert(whole.end(), pieces_.begin() + static_cast<std::ptrdiff_t>(to), pieces_.end());
  const Pose2 start = at_.front();
  cut(start, price, whole);
}

bool Polish::shorten(std::size_t from, std::size_t to, const Kinematics& kinematics,
                     double radius_m, const Price& price) {
  float now = std::accumulate(cost_.begin() + static_cast<std::ptrdiff_t>(from),
                              cost_.begin() + static_cast<std::ptrdiff_t>(to), 0.0F);
  for (std::size_t i = std::max<std::size_t>(from, 1); i <= to && i < pieces_.size(); ++i) {
    now += change(pieces_[i - 1], pieces_[i]);
  }
  const Pose2& a = at_[from];
  const Pose2& b = at_[to];
  const auto better = [&](const Link& link) {
    if (link.size == 0) return false;
    float ends = 0.0F;
    if (from > 0) ends += change(pieces_[from - 1], link.pieces[0]);
    if (to < pieces_.size()) ends += change(link.pieces[link.size - 1], pieces_[to]);
    const float most = now - ends - kWorth_m;
    if (Price::least(link) >= most) return false;
    ++tries_;
    if (price.of(a, link, std::min(most, Field::kNever)) >= std::min(most, Field::kNever))
      return false;
    replace(from, to, link, price);
    return true;
  };
  const bool by_curve = better(dubins(a, b, 3.0 * radius_m)) || better(dubins(a, b, radius_m));
  return by_curve || (kinematics.pivots && better(straight_between_turns(a, b)));
}

void Polish::run(const Pose2& start, const Kinematics& kinematics, double radius_m,
                 const Price& price, std::vector<Piece>& pieces) {
  cut(start, price, pieces);
  tries_ = 0;
  bool again = true;
  for (int pass = 0; again && pass < 4; ++pass) {
    again = false;
    for (std::size_t width = pieces_.size(); width >= 2 && tries_ < kTries;
         width -= (width + 3) / 4) {
      const std::size_t stride = std::max<std::size_t>(1, width / 4);
      for (std::size_t from = 0; from + width <= pieces_.size() && tries_ < kTries;
           from += stride) {
        if (shorten(from, from + width, kinematics, radius_m, price)) again = true;
      }
    }
  }
  pieces = pieces_;
}

}  // namespace roverd::nav::around
