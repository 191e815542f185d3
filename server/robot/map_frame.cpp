#include "robot/map_frame.hpp"

#include <cmath>
#include <string>

#include "base/angle.hpp"

namespace roverd::robot {
namespace {

using base::Code;
using base::PlacePhase;

// By more it is another way than the one that was shown.
constexpr double kLiesElsewhere_m = 0.2;
constexpr double kLiesAskew_rad = 0.02;

base::Error against(const std::string& map, const std::string& why) {
  return {Code::Conflict, "the mission counts from the map \"" + map + "\": " + why, {}};
}

/// Why the robot's place in the map in use is not known, and what to do. @param place not Off
std::string not_found(const base::PlaceState& place) {
  const std::string why = place.reason.empty() ? "" : " (" + place.reason + ")";
  const bool lost = place.phase == PlacePhase::Lost;
  return (lost ? "the robot is lost in it" : "the robot is not found in it yet") + why +
         (place.says_cure
              ? ""
              : ": drive some metres by hand, or say where it stands (a tap on the map)");
}

/// Empty: it is.
std::string not_in_use(const std::string& map, const std::optional<base::PlaceState>& place) {
  if (!place || place->phase == PlacePhase::Off) return "no map is in use";
  return place->map == map ? "" : "the map in use is \"" + place->map + "\"";
}

/// Why who is led into it cannot be; empty: it is known to be in it. @param place not Off
std::string not_seen(const base::PlaceState& place, base::Time now) {
  if (place.phase != PlacePhase::Known) return not_found(place);
  const double age_s = base::seconds(now - place.stamp);
  if (age_s <= kSeen_s) return {};
  return "nothing was seen in it for " + std::to_string(std::lround(age_s)) + " s";
}

}  // namespace

base::Result<base::MapLies> lies_of(const mission::MissionMap& said, const MapNow& now) {
  const auto no = [&said](const std::string& why) {
    return tl::unexpected(against(said.map, why));
  };
  if (const auto why = not_in_use(said.map, now.place); !why.empty()) return no(why);
  if (now.place->phase != PlacePhase::Known && (!now.place->lies || !now.frame)) {
    return no(not_found(*now.place));
  }
  if (!now.place->lies) {
    const std::string& reason = now.place->reason;
    return no(reason.empty() ? "nobody knows where on the earth it lies" : reason);
  }
  if (!now.frame) return no("the robot's position is not known yet");
  base::MapLies lies = *now.place->lies;
  const double far_m = base::distance_bearing(now.frame->origin(), lies.at).distance_m;
  if (far_m > base::LocalFrame::kReach_m) return no("it lies more than 10 km away");
  lies.at = now.frame->to_global(now.frame->to_local(lies.at) + now.offset);
  return lies;
}

bool leads_into_map(const mission::Plan& plan, const nav::RouteStep* step) noexcept {
  if (step == nullptr) return true;
  if (step->kind != nav::StepKind::Go && step->kind != nav::StepKind::Face) return false;
  const auto i = static_cast<std::size_t>(step->item - 1);
  return i < plan.items.size() && std::holds_alternative<mission::MapPoint>(plan.items[i]);
}

base::Result<void> counts_from(const mission::MissionMap& laid, const MapNow& now, bool into_it) {
  const auto lies = lies_of(laid, now);
  if (!lies) return tl::unexpected(lies.error());
  const std::string unseen = into_it ? not_seen(*now.place, now.now) : "";
  if (!unseen.empty()) return tl::unexpected(against(laid.map, unseen));
  const bool same =
      laid.lies && base::distance_bearing(laid.lies->at, lies->at).distance_m <= kLiesElsewhere_m &&
      std::abs(base::angle_diff_rad(laid.lies->yaw_rad, lies->yaw_rad)) <= kLiesAskew_rad;
  if (same) return {};
  return tl::unexpected(against(
      laid.map, "it lies elsewhere by now than when the mission was loaded: load it again"));
}

base::Result<base::MapPlace> found_in(const mission::MissionMap& said,
                                      const std::optional<base::PlaceState>& place,
                                      base::Time now) {
  std::string why = not_in_use(said.map, place);
  if (why.empty()) why = not_seen(*place, now);
  if (why.empty() && !place->in_map) why = not_found(*place);
  if (!why.empty()) return tl::unexpected(against(said.map, why));
  return *place->in_map;
}

}  // namespace roverd::robot
