#pragma once
// What is known of walls and landmarks at one moment, in the odometry's frame O. Immutable once it
// is handed on.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "nav/marks/landmarks.hpp"
#include "nav/marks/walls.hpp"

namespace roverd::nav::marks {

struct View {
  base::Time stamp;  ///< of the last scan or image that told it
  /// By the sensors' numbers (Eyes): each one's last scan or image, whatever it showed.
  std::vector<base::Time> looked_at{};
  std::vector<Wall> walls{};  ///< by all that is seen
  std::vector<Landmark> landmarks{};
  std::array<Eyes, 2> eyes{};  ///< by Source: who ever told anything
  struct Alone {
    std::vector<Wall> walls{};
    std::vector<Landmark> landmarks{};
  };
  std::array<Alone, 2> alone{};  ///< by Source; empty unless both kinds told something

  std::span<const Wall> walls_by(By by) const noexcept {
    if (by == By::Auto || !two()) return told(by) ? std::span(walls) : std::span<const Wall>();
    return alone[index(by)].walls;
  }
  std::span<const Landmark> landmarks_by(By by) const noexcept {
    if (by == By::Auto || !two()) {
      return told(by) ? std::span(landmarks) : std::span<const Landmark>();
    }
    return alone[index(by)].landmarks;
  }
  /// Whose word counts; 0: anyone's.
  Eyes eyes_by(By by) const noexcept { return by == By::Auto ? 0 : eyes[index(by)]; }

  /// One of these has looked since then. @param who 0: anyone.
  bool looked_since(base::Time then, Eyes who) const noexcept {
    if (who == 0) return stamp >= then;
    for (std::size_t i = 0; i < looked_at.size(); ++i) {
      if ((who & eye_of(i)) != 0 && looked_at[i] >= then) return true;
    }
    return false;
  }
  /// Somebody of that kind ever told anything. One that never did looks at nothing.
  bool told(By by) const noexcept { return by == By::Auto || eyes[index(by)] != 0; }

 private:
  static constexpr std::size_t index(By by) noexcept { return by == By::Scan ? 0 : 1; }
  bool two() const noexcept { return eyes[0] != 0 && eyes[1] != 0; }
};

}  // namespace roverd::nav::marks
