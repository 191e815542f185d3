#include "nav/marks/choose.hpp"

namespace roverd::nav::marks {
namespace {

constexpr std::array<std::string_view, kGuides> kWords{"none", "wall_by_vision", "wall_by_scan",
                                                       "landmarks"};
constexpr double kGap_s = 0.3;  ///< between two pieces of what is seen all the time

}  // namespace

std::string_view to_string(Guide g) noexcept {
  return kWords[static_cast<std::size_t>(g)];
}

std::optional<Guide> guide_from(std::string_view word) noexcept {
  for (std::size_t i = 0; i < kGuides; ++i) {
    if (kWords[i] == word) return static_cast<Guide>(i);
  }
  return std::nullopt;
}

Guide Chooser::step(const InSight& seen, std::optional<Guide> only, base::Time now) noexcept {
  const std::array<bool, kGuides> in_sight{false, seen.wall_by_vision, seen.wall_by_scan,
                                           seen.landmarks};
  for (std::size_t i = 1; i < kGuides; ++i) {
    Watch& w = watches_[i];
    if (!in_sight[i]) continue;
    if (!w.last || base::seconds(now - *w.last) > kGap_s) w.since = now;
    w.last = now;
  }
  const auto lasts = [&](std::size_t i, double within_s) {
    return watches_[i].last && base::seconds(now - *watches_[i].last) <= within_s;
  };
  if (only) {
    const auto i = static_cast<std::size_t>(*only);
    return now_ = lasts(i, kPatience_s) ? *only : Guide::None;
  }
  const auto steering = static_cast<std::size_t>(now_);
  const bool held = now_ != Guide::None && lasts(steering, kPatience_s);
  for (std::size_t i = kGuides - 1; i > (held ? steering : 0); --i) {
    const bool sure = lasts(i, kGap_s) && base::seconds(now - *watches_[i].since) >= kSure_s;
    if (sure || (!held && lasts(i, kGap_s))) return now_ = static_cast<Guide>(i);
  }
  if (!held) now_ = Guide::None;
  return now_;
}

}  // namespace roverd::nav::marks
