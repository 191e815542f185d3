#include "robot/guard/blocked.hpp"

#include <array>
#include <cmath>

namespace roverd::robot {
namespace {

// Clear for less, and no farther than this: the same stop.
constexpr double kSame_s = 3.0;
constexpr double kSame_m = 0.3;

constexpr std::array<std::string_view, 4> kThens{"wait", "around", "return", "abort"};

}  // namespace

std::string_view to_string(Then then) noexcept {
  return kThens.at(static_cast<std::size_t>(then));
}

std::optional<Then> then_from(std::string_view word) noexcept {
  for (std::size_t i = 0; i < kThens.size(); ++i) {
    if (kThens.at(i) == word) return static_cast<Then>(i);
  }
  return std::nullopt;
}

base::Result<void> check(const BlockedParams& p) {
  if (then_from(p.then)) return {};
  const std::string detail = "must be wait, around, return or abort, is \"" + p.then + "\"";
  return base::fail(base::Code::Invalid, "then " + detail, {{"then", detail}});
}

void Blocked::set(const BlockedParams& params) {
  params_ = params;
  const Then then = then_from(params.then).value_or(Then::Wait);
  if (then != then_) decided_ = false;  // what stands blocked is told the other one, too
  then_ = then;
}

std::optional<Then> Blocked::step(bool stops, bool solid, const nav::sense::Pose2& at,
                                  base::Time now) noexcept {
  stops_ = stops;
  solid_ = solid;
  if (since_) {
    const bool elsewhere = std::hypot(at.x_m - stood_.x_m, at.y_m - stood_.y_m) > kSame_m;
    if (elsewhere || (!stops && base::seconds(now - stopped_last_) > kSame_s)) forget();
  }
  if (!stops) return std::nullopt;
  stops_ = true;
  solid_ = solid;
  stopped_last_ = now;
  if (!since_) {
    since_ = now;
    stood_ = at;
  }
  if (decided_ || base::seconds(now - *since_) < params_.after_s) return std::nullopt;
  decided_ = true;
  return then_;
}

void Blocked::forget() noexcept {
  stops_ = solid_ = decided_ = false;
  since_.reset();
}

std::optional<base::Time> Blocked::decides_at() const noexcept {
  if (!stops_ || decided_ || !since_) return std::nullopt;
  return *since_ + base::from_seconds(params_.after_s);
}

bool Blocked::wants_around() const noexcept {
  return stops_ && solid_ && then_ == Then::Around && (decided_ || params_.around_at_once);
}

}  // namespace roverd::robot
