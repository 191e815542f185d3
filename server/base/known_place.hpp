#pragma once
// A thing whose place on the earth was entered once: an AprilTag on a wall, a pole or a cone. Seen
// again, it tells where the robot is.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "base/geo.hpp"
#include "base/time.hpp"

namespace roverd::base {

struct KnownPlace {
  std::string name;               ///< a to z, 0 to 9 and _, 24 signs at most; each once
  LatLon at;                      ///< of the tag's or the pole's middle
  double sigma_m = 0.05;          ///< how well that is known, 1 sigma each way, 0.01 to 2
  std::optional<int> tag;         ///< its number in tag36h11, each once; empty: a pole or a cone
  std::optional<double> yaw_rad;  ///< in which the tag looks: out of the wall; empty: not known
  double yaw_sigma_rad = 0.0349065850;  ///< how well that is known, 1 sigma: 2 deg
  bool configured = false;              ///< by the configuration: not to be changed while it runs
  friend bool operator==(const KnownPlace&, const KnownPlace&) = default;
};

inline constexpr std::size_t kMostKnownPlaces = 200;

/// What became of it when it was seen last.
enum class PlaceVerdict {
  Unseen,
  Used,         ///< the estimate was corrected by it
  Agrees,       ///< with satellites or map, which need no help
  Contradicts,  ///< what is believed of the robot's place; it is not used
  Disputed,     ///< another known place, and nobody can tell which one is wrong: neither is used
  Ambiguous     ///< a pole that may be another one
};
/// unseen used agrees contradicts disputed ambiguous
std::string_view to_string(PlaceVerdict verdict) noexcept;

struct KnownPlaceState {
  std::string name;
  PlaceVerdict verdict = PlaceVerdict::Unseen;
  std::optional<Time> seen_at{};
  EnuPoint off{};        ///< where it is seen, less where it was entered
  double sigma_m = 0.0;  ///< of that, 1 sigma, the worse direction
  std::string detail{};  ///< one sentence; empty: nothing is wrong
};

}  // namespace roverd::base
