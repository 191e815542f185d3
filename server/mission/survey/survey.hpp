#pragma once
// Coverage: a way that passes over a whole field.
//
//   ╭───────────────────────╮   border   the path stays so far inside the field's edge
//   │ ╭───────────────────╮ │   headland passes along the edge, one spacing apart
//   │ │ ──▶───────────▶─╮ │ │   tracks   parallel, one spacing apart, over what is left
//   │ │ ╭─◀───────────◀─╯ │ │
//   │ │ ╰─▶──[hole]───▶   │ │   cells    what lies beside a hole or behind a notch is a cell of
//   │ ╰───────────────────╯ │            its own: boustrophedon cells, joined where one follows
//   ╰───────────────────────╯            on another; ways between them stay inside
//
// Covered is what comes within half a spacing of the path. With at least one headland pass that is
// everything that can be reached without leaving the field, because each track is as long as the
// piece of its strip is, not as its middle line is. Without headland passes tracks end where the
// border begins: at slanted edges corners stay open, and the covered share says so.
//
// Local metres are those of the tangent plane at the field's middle. Pure; any thread. Time grows
// with points, tracks and crossings; all three are bounded.
// Source: Choset and Pignon 1997, "Coverage Path Planning: The Boustrophedon Decomposition".

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/result.hpp"
#include "mission/plan.hpp"

namespace roverd::mission {

inline constexpr std::size_t kMaxFieldPoints = 20'000;  ///< of all rings together
inline constexpr std::size_t kMaxSurveyItems = 100'000;

enum class SurveyPattern {
  Tracks,     ///< headland passes, then parallel tracks
  Perimeter,  ///< headland passes alone
  Spiral      ///< rings from the edge to the middle, a little closer than the spacing
};
enum class SurveyTurn {
  Pivot,  ///< on the spot
  Arc     ///< no tighter than radius_m where there is room
};
enum class FieldCorner { SouthWest, SouthEast, NorthWest, NorthEast };

struct SurveyRequest {
  /// The first is the field, the others are holes. Open or closed, either sense of rotation.
  std::vector<std::vector<LatLon>> rings;
  double spacing_m = 1.0;               ///< working width, 0.05 … 1000
  std::optional<double> direction_deg;  ///< compass, of the tracks; empty: the best one
  SurveyPattern pattern = SurveyPattern::Tracks;
  SurveyTurn turn = SurveyTurn::Pivot;
  double radius_m = 0.0;  ///< of arcs, 0.1 … 100
  std::variant<FieldCorner, LatLon> start = FieldCorner::SouthWest;
  int headland_passes = 1;         ///< 0 … 100; perimeter: at least 1; a spiral needs none
  std::optional<double> border_m;  ///< 0 … 1000; empty: half the spacing
  double overshoot_m = 0.0;        ///< 0 … 100: tracks are longer at both ends, within the border
  int skip = 0;                    ///< 0 … 50 tracks are left out at each turn, and driven later
  double speed_mps = 0.8;          ///< for the time
  double turn_rate_radps = 0.75;   ///< of turns on the spot, for the time
};

struct Survey {
  std::vector<Item> items;  ///< waypoints
  double direction_deg = 0.0;
  double length_m = 0.0;
  double time_s = 0.0;  ///< an estimate
  double field_m2 = 0.0;
  double reachable_share = 0.0;  ///< of the field: what the path may come near enough to
  double covered_share = 0.0;    ///< of the field, within 0.1 % of it
  int tracks = 0;
  int cells = 0;
  int tight_turns = 0;  ///< sharper than the radius, for want of room
  std::vector<std::string> notes;
};

/// Invalid names the member of the request: "/polygon/0/5", "/spacing_m". Points are named by ring
/// and index. Errors: fewer than 3 points, too many, not on earth, farther than 10 km from the
/// middle, an edge that crosses or touches another one, no area, a hole outside or within another,
/// nothing that can be reached, more than kMaxSurveyItems items.
base::Result<Survey> plan_survey(const SurveyRequest& request);

}  // namespace roverd::mission
