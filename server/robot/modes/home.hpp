#pragma once
// Where home is, and who said so. It moves only on purpose: what stops the robot and arms it again
// leaves it where it was.
//
//   Unset ──first position──▶ Assumed ──first arming: here──▶ Armed
//                                │                              │ set home, a mission's home
//                                └──────────────────────────────┴──────▶ Chosen
//   A later arming sets it here once more only where HomeAtArm says so.
//
// Control thread.

#include <optional>
#include <string_view>

#include "base/geo.hpp"

namespace roverd::robot {

/// What arming does to a home that is set already.
enum class HomeAtArm {
  Keep,          ///< nothing: the first arming sets it, no later one
  UnlessChosen,  ///< here, each time, unless an operator or a mission said where it is
  Here           ///< here, each time
};
/// "keep" "unless_chosen" "here"; empty: no such word.
inline std::optional<HomeAtArm> home_at_arm_from(std::string_view word) noexcept {
  if (word == "keep") return HomeAtArm::Keep;
  if (word == "unless_chosen") return HomeAtArm::UnlessChosen;
  if (word == "here") return HomeAtArm::Here;
  return std::nullopt;
}

class HomePlace {
 public:
  /// The first position of all: better than none. Later ones do nothing.
  void assume(base::LatLon here) noexcept {
    if (!at_) at_ = here;
  }

  /// @return home was set or moved: the driven way begins anew.
  bool arm(base::LatLon here, HomeAtArm rule) noexcept {
    const bool stays = (said_ == By::Arming && rule == HomeAtArm::Keep) ||
                       (said_ == By::Choice && rule != HomeAtArm::Here);
    if (stays) return false;
    at_ = here;
    said_ = By::Arming;
    return true;
  }

  /// An operator or a mission says so.
  void choose(base::LatLon where) noexcept {
    at_ = where;
    said_ = By::Choice;
  }

  const std::optional<base::LatLon>& at() const noexcept { return at_; }

 private:
  enum class By { Nobody, Arming, Choice };

  std::optional<base::LatLon> at_;
  By said_ = By::Nobody;
};

}  // namespace roverd::robot
