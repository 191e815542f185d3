#pragma once
// Where RTL and SMART_RTL would lead from here: asked before they begin, and by whoever wants to
// see it first. Pure; any thread.
//
//   RTL        ● ───────────────▶ home, or the nearest rally point whose straight way is inside
//   SMART_RTL  ● ──╮  the driven way, back to where it began
//                  ╰──●──●──▶
//
// Frame: everything here is local to one frame, the robot's.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/geo.hpp"
#include "nav/behave/breadcrumbs.hpp"
#include "robot/safety/fence_guard.hpp"

namespace roverd::robot {

struct WayHomeFacts {
  base::EnuPoint here;
  std::optional<base::EnuPoint> home;  ///< empty: none, or out of the map's reach
  const LaidFence* fence = nullptr;    ///< of the same frame; null: none
  double margin_m = 0.0;               ///< that a way keeps from the fence
};

/// The driven way as it was kept. Immutable once published.
struct DrivenWay {
  std::uint32_t frame_id = 0;
  std::vector<base::EnuPoint> back;  ///< from the newest point to the first; empty: none is known
  double longest_gap_m = 0.0;        ///< of pieces that were not driven as they are drawn
  /// Not empty: `back` is still to be made of them, by whoever asks (nav::way_back).
  std::vector<nav::Crumb> crumbs{};
  double accuracy_m = 0.0;
};

enum class HomeEnd { Home, Rally, Begin };         ///< Begin: where the driven way began
std::string_view to_string(HomeEnd end) noexcept;  // home rally_point begin_of_way

struct WayHome {
  std::vector<base::EnuPoint> way;  ///< to be driven in order, without `here`; may be empty
  HomeEnd end = HomeEnd::Home;
  std::string refusal;  ///< why it cannot be driven; empty: it can

  /// From `here` along the way; 0 if there is none.
  double length_m(base::EnuPoint here) const noexcept;
};

WayHome straight_home(const WayHomeFacts& facts);
WayHome driven_home(const WayHomeFacts& facts, const DrivenWay& driven);

}  // namespace roverd::robot
