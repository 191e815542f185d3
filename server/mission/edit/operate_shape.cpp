// Operations on the figure that the positions make: offset, scale, rotate, mirror.

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angle.hpp"
#include "base/tangent_plane.hpp"
#include "mission/edit/operation_steps.hpp"

namespace roverd::mission {

using base::EnuPoint;
using base::Error;
using base::Result;
using base::TangentPlane;

namespace {

/// Where a position stands in the plan: an item with a place or a local one, by index.
struct Spot {
  std::size_t item = 0;
  LatLon at;
};

Error on_map(int number) {
  return wrong("/op", "cannot be: item " + std::to_string(number) +
                          " counts from a map, which lies where the robot finds it");
}

/// Of a row or a wall that ends beside a place.
Until* until_of(Item& item) noexcept {
  if (auto* row = std::get_if<Row>(&item)) return &row->until;
  if (auto* wall = std::get_if<Wall>(&item)) return &wall->until;
  return nullptr;
}
const Until* until_of(const Item& item) noexcept {
  if (const auto* row = std::get_if<Row>(&item)) return &row->until;
  if (const auto* wall = std::get_if<Wall>(&item)) return &wall->until;
  return nullptr;
}

/// The short way round the date line.
double lon_difference(double from, double to) noexcept {
  const double way = to - from;
  return std::abs(way) < 180.0 ? way : std::remainder(way, 360.0);  // which is slow
}

/// Its own place, or that beside which it ends.
std::optional<LatLon> moved_with(const Item& item) noexcept {
  if (const auto at = place_of(item)) return at;
  const Until* until = until_of(item);
  if (until == nullptr || !until->lat || !until->lon) return std::nullopt;
  return LatLon{*until->lat, *until->lon};
}

double compass(double deg) noexcept {
  const double wrapped = std::fmod(deg, 360.0);
  const double heading = wrapped < 0.0 ? wrapped + 360.0 : wrapped;
  return heading >= 360.0 ? 0.0 : heading;
}

/// @param which may be the empty run of an empty plan
Result<std::vector<Spot>> places_in(const Plan& plan, const Numbers& which) {
  std::vector<Spot> out;
  out.reserve(static_cast<std::size_t>(which.last - which.first + 1));
  std::optional<TangentPlane> home;
  if (plan.home) home.emplace(plan.home->at);
  for (int number = which.first; number <= which.last; ++number) {
    const auto i = static_cast<std::size_t>(number) - 1;
    if (const auto at = moved_with(plan.items[i])) {
      out.push_back({i, *at});
    } else if (std::holds_alternative<MapPoint>(plan.items[i])) {
      return tl::unexpected<Error>(on_map(number));
    } else if (const auto* local = std::get_if<Local>(&plan.items[i])) {
      if (!home) {
        return tl::unexpected<Error>(
            wrong("/op", "cannot be: item " + std::to_string(number) +
                             " is local, measured from home, and the mission has no home"));
      }
      out.push_back({i, home->to_global({local->east_m, local->north_m})});
    }
  }
  return out;
}

void put(Plan& plan, const std::vector<Spot>& places) {
  std::optional<TangentPlane> home;
  if (plan.home) home.emplace(plan.home->at);
  for (const Spot& place : places) {
    if (auto* waypoint = std::get_if<Waypoint>(&plan.items[place.item])) {
      waypoint->at = place.at;
    } else if (auto* loiter = std::get_if<Loiter>(&plan.items[place.item])) {
      loiter->lat = place.at.lat;
      loiter->lon = place.at.lon;
    } else if (auto* circle = std::get_if<Circle>(&plan.items[place.item])) {
      circle->at = place.at;
    } else if (Until* until = until_of(plan.items[place.item]); until != nullptr) {
      until->lat = place.at.lat;
      until->lon = place.at.lon;
    } else if (auto* local = std::get_if<Local>(&plan.items[place.item]); local && home) {
      const EnuPoint p = home->to_local(place.at);
      local->east_m = p.east_m;
      local->north_m = p.north_m;
    }
  }
}

/// Of the extremes of latitude and longitude. @param places not empty
LatLon middle_of(const std::vector<Spot>& places) {
  const LatLon base = places.front().at;
  double lat_min = base.lat;
  double lat_max = base.lat;
  double west = 0.0;
  double east = 0.0;
  for (const Spot& place : places) {
    lat_min = std::min(lat_min, place.at.lat);
    lat_max = std::max(lat_max, place.at.lat);
    const double lon = lon_difference(base.lon, place.at.lon);
    west = std::min(west, lon);
    east = std::max(east, lon);
  }
  return {(lat_min + lat_max) / 2.0, lon_difference(0.0, base.lon + (west + east) / 2.0)};
}

/// Within 10 km of the plane's origin? Not if it is no number.
bool in_reach(EnuPoint p) noexcept {
  constexpr double kReach_m = base::LocalFrame::kReach_m;
  return p.east_m * p.east_m + p.north_m * p.north_m <= kReach_m * kReach_m;
}

/// Invalid if one of them is out of the plane's reach. @param pointer of the member to blame
Result<std::vector<EnuPoint>> laid_out(const TangentPlane& plane, const LatLon& origin,
                                       const std::vector<Spot>& places, const char* pointer) {
  std::vector<EnuPoint> out;
  out.reserve(places.size());
  for (const Spot& place : places) {
    out.push_back(plane.to_local(place.at));
    // On the far side of the earth the plane's distances shrink again.
    const bool opposite =
        std::abs(place.at.lat - origin.lat) > 1.0 ||
        (std::abs(origin.lat) < 85.0 && std::abs(lon_difference(origin.lon, place.at.lon)) > 90.0);
    if (opposite || !in_reach(out.back())) {
      return tl::unexpected<Error>(wrong(pointer, "cannot be: item " +
                                                      std::to_string(place.item + 1) +
                                                      " lies more than 10 km from the centre"));
    }
  }
  return out;
}

LatLon centroid_of(const std::vector<Spot>& places) {
  const TangentPlane plane(middle_of(places));
  EnuPoint sum;
  for (const Spot& place : places) sum = sum + plane.to_local(place.at);
  const auto count = static_cast<double>(places.size());
  return plane.to_global({sum.east_m / count, sum.north_m / count});
}

/// The middle of a figure that moves with it: at the poles the middle of the extremes does not, as
/// meridians are not parallel there. Two rounds, so that it does not depend on where one begins.
LatLon moving_centre_of(const std::vector<Spot>& places) {
  LatLon centre = middle_of(places);
  for (int i = 0; i < 2; ++i) {
    const TangentPlane plane(centre);
    EnuPoint sum;
    for (const Spot& place : places) sum = sum + plane.to_local(place.at);
    const auto count = static_cast<double>(places.size());
    centre = plane.to_global({sum.east_m / count, sum.north_m / count});
  }
  return centre;
}

/// The middle of the way from the figure's centre to where it goes, where north is measured, so
/// that the way back is measured in the same plane. It is found step by step, because north there
/// decides where it lies. Invalid: there is none, so near is the pole.
Result<LatLon> middle_of_way(const std::vector<Spot>& places, const EnuPoint& by) {
  constexpr int kMostSteps = 500;
  constexpr double kGood_m = 1e-7;
  const LatLon centre = moving_centre_of(places);
  const EnuPoint half{by.east_m / 2.0, by.north_m / 2.0};
  LatLon origin = TangentPlane(centre).to_global(half);
  for (int i = 0; i < kMostSteps; ++i) {
    const TangentPlane plane(origin);
    const EnuPoint step = plane.to_local(centre) + half;
    origin = plane.to_global(step);
    if (std::hypot(step.east_m, step.north_m) >= kGood_m) continue;
    // A way across the pole begins to the north and ends to the south.
    const LatLon end = TangentPlane(origin).to_global(half);
    if (std::abs(lon_difference(centre.lon, end.lon)) < 90.0) return origin;
    break;
  }
  return tl::unexpected<Error>(
      wrong("/op", "cannot be: so near to the pole there is no such direction"));
}

Result<LatLon> centre_of(const Plan& plan, const std::vector<Spot>& places, const About& about) {
  if (const auto* point = std::get_if<LatLon>(&about)) return *point;
  if (std::holds_alternative<AtHome>(about)) {
    if (plan.home) return plan.home->at;
    return tl::unexpected<Error>(wrong("/about", "cannot be home: the mission has none"));
  }
  if (places.empty()) {
    return tl::unexpected<Error>(wrong("/about", "cannot be: the mission has no position"));
  }
  return std::holds_alternative<Middle>(about) ? middle_of(places) : centroid_of(places);
}

/// Puts every position where `map` says, in the plane at the centre. @return the centre
template <class Map>
Result<LatLon> map_all(Plan& plan, const About& about, Map map) {
  const Numbers all{1, static_cast<int>(plan.items.size())};
  auto places = places_in(plan, all);
  if (!places) return tl::unexpected<Error>(places.error());
  const auto centre = centre_of(plan, *places, about);
  if (!centre) return centre;
  const TangentPlane plane(*centre);
  const auto points = laid_out(plane, *centre, *places, "/about");
  if (!points) return tl::unexpected<Error>(points.error());
  for (std::size_t i = 0; i < places->size(); ++i) {
    const EnuPoint to = map((*points)[i]);
    if (!in_reach(to)) {
      return tl::unexpected<Error>(
          wrong("/factor", "is too large: item " + std::to_string((*places)[i].item + 1) +
                               " would lie more than 10 km from the centre"));
    }
    (*places)[i].at = plane.to_global(to);
  }
  put(plan, *places);
  return centre;
}

/// Every heading of the items as `map` says.
template <class Map>
void map_headings(Plan& plan, Map map) {
  for (Item& item : plan.items) {
    if (auto* local = std::get_if<Local>(&item); local && local->heading_deg) {
      local->heading_deg = compass(map(*local->heading_deg));
    } else if (auto* turn = std::get_if<TurnBy>(&item); turn && turn->heading_deg) {
      turn->heading_deg = compass(map(*turn->heading_deg));
    }
  }
}

std::string about_words(const About& about) {
  switch (about.index()) {
    case 0:
      return "the middle";
    case 1:
      return "the centroid";
    case 2:
      return "home";
    default:
      return "a given point";
  }
}

std::string direction_words(const EnuPoint& by) {
  std::string out;
  if (by.north_m != 0.0 || by.east_m == 0.0) {
    out += rounded_text(std::abs(by.north_m)) + (by.north_m < 0.0 ? " m south" : " m north");
  }
  if (by.east_m != 0.0) {
    if (!out.empty()) out += ", ";
    out += rounded_text(std::abs(by.east_m)) + (by.east_m < 0.0 ? " m west" : " m east");
  }
  return out;
}

}  // namespace

Result<Done> apply(Plan plan, const Offset& offset) {
  if (!(std::hypot(offset.by.east_m, offset.by.north_m) <= base::LocalFrame::kReach_m)) {
    return tl::unexpected<Error>(wrong("/distance_m", "must be at most 10 km"));
  }
  const auto which = numbers_in(plan, offset.which);
  if (!which) return tl::unexpected<Error>(which.error());
  std::vector<Spot> places;
  places.reserve(static_cast<std::size_t>(which->last - which->first + 1));
  for (int number = which->first; number <= which->last; ++number) {
    const auto i = static_cast<std::size_t>(number) - 1;
    if (const auto at = moved_with(plan.items[i])) {
      places.push_back({i, *at});
    } else if (std::holds_alternative<MapPoint>(plan.items[i])) {
      return tl::unexpected<Error>(on_map(number));
    } else if (auto* local = std::get_if<Local>(&plan.items[i])) {
      local->east_m += offset.by.east_m;
      local->north_m += offset.by.north_m;
    }
  }
  if (!places.empty()) {
    const auto origin = middle_of_way(places, offset.by);
    if (!origin) return tl::unexpected<Error>(origin.error());
    const TangentPlane plane(*origin);
    const auto points = laid_out(plane, *origin, places, "/op");
    if (!points) return tl::unexpected<Error>(points.error());
    for (std::size_t i = 0; i < places.size(); ++i) {
      places[i].at = plane.to_global((*points)[i] + offset.by);
    }
    put(plan, places);
  }
  std::string what = "moved " + words_of(plan, *which) + " " + direction_words(offset.by);
  return Done{std::move(plan), std::move(what), std::nullopt, {}};
}

Result<Done> apply(Plan plan, const ScaleRotate& change) {
  if (!(change.factor >= kMinFactor && change.factor <= kMaxFactor)) {
    return tl::unexpected<Error>(wrong("/factor", "must be from 0.001 to 1000"));
  }
  const double turn_rad = base::rad_from_deg(std::remainder(change.turn_deg, 360.0));
  const double c = change.factor * std::cos(turn_rad);
  const double s = change.factor * std::sin(turn_rad);
  const auto centre = map_all(plan, change.about, [c, s](EnuPoint p) {
    return EnuPoint{c * p.east_m + s * p.north_m, c * p.north_m - s * p.east_m};
  });
  if (!centre) return tl::unexpected<Error>(centre.error());
  map_headings(plan, [&](double deg) { return deg + change.turn_deg; });
  for (Item& item : plan.items) {
    if (auto* move = std::get_if<Move>(&item)) move->forward_m *= change.factor;
    if (auto* circle = std::get_if<Circle>(&item)) circle->radius_m *= change.factor;
    if (auto* turn = std::get_if<TurnBy>(&item); turn && turn->radius_m) {
      *turn->radius_m *= change.factor;
    }
  }
  std::string what;
  if (change.factor != 1.0) what = "scaled by " + rounded_text(change.factor);
  if (change.turn_deg != 0.0 || what.empty()) {
    what += (what.empty() ? "turned by " : ", turned by ") + rounded_text(change.turn_deg) + " deg";
  }
  what += " about " + about_words(change.about);
  return Done{std::move(plan), std::move(what), std::nullopt, *centre};
}

Result<Done> apply(Plan plan, const Mirror& mirror) {
  const double axis_rad = base::rad_from_deg(std::remainder(mirror.axis_deg, 360.0));
  const EnuPoint axis{std::sin(axis_rad), std::cos(axis_rad)};
  const auto centre = map_all(plan, mirror.about, [axis](EnuPoint p) {
    const double along = 2.0 * (p.east_m * axis.east_m + p.north_m * axis.north_m);
    return EnuPoint{along * axis.east_m - p.east_m, along * axis.north_m - p.north_m};
  });
  if (!centre) return tl::unexpected<Error>(centre.error());
  map_headings(plan, [&](double deg) { return 2.0 * mirror.axis_deg - deg; });
  const auto other = [](Side side) { return side == Side::Left ? Side::Right : Side::Left; };
  for (Item& item : plan.items) {
    if (auto* turn = std::get_if<TurnBy>(&item); turn && turn->turn_deg) {
      turn->turn_deg = -*turn->turn_deg;
    } else if (auto* row = std::get_if<Row>(&item)) {
      row->side = row->side == RowSide::Left    ? RowSide::Right
                  : row->side == RowSide::Right ? RowSide::Left
                                                : RowSide::Both;
    } else if (auto* wall = std::get_if<Wall>(&item)) {
      wall->side = other(wall->side);
    } else if (auto* marks = std::get_if<Landmarks>(&item)) {
      if (marks->offset_m) marks->offset_m = -*marks->offset_m;
      if (marks->side) marks->side = other(*marks->side);
    } else if (auto* circle = std::get_if<Circle>(&item)) {
      circle->clockwise = !circle->clockwise;
    }
  }
  std::string what = "mirrored about the axis " + rounded_text(compass(mirror.axis_deg)) +
                     " deg through " + about_words(mirror.about);
  return Done{std::move(plan), std::move(what), std::nullopt, *centre};
}

namespace {

/// Where an item with a position lies. @param pointer of the member that names it
Result<LatLon> position_of(const Plan& plan, int item, const char* pointer) {
  const auto count = static_cast<int>(plan.items.size());
  if (item < 1 || item > count) {
    return tl::unexpected<Error>(wrong(
        pointer, "must be from 1 to " + std::to_string(count) + ", is " + std::to_string(item)));
  }
  const auto places = places_in(plan, Numbers{item, item});
  if (!places) return tl::unexpected<Error>(places.error());
  if (places->empty()) {
    return tl::unexpected<Error>(wrong(pointer, "has no position of its own"));
  }
  return places->front().at;
}

double direction_rad(EnuPoint way) noexcept {
  return std::atan2(way.north_m, way.east_m);
}

}  // namespace

Result<Done> apply(Plan plan, const Align& align) {
  constexpr double kLeast_m = 0.1;
  const auto first = position_of(plan, align.first.item, "/item");
  if (!first) return tl::unexpected<Error>(first.error());
  const TangentPlane plane(align.first.at);
  const EnuPoint begin = plane.to_local(*first);
  double turn_rad = 0.0;  // counter-clockwise
  std::string what = "aligned item " + std::to_string(align.first.item) + ", moved by " +
                     direction_words({-begin.east_m, -begin.north_m});
  if (align.second) {
    const auto second = position_of(plan, align.second->item, "/second/item");
    if (!second) return tl::unexpected<Error>(second.error());
    const EnuPoint way = plane.to_local(*second) - begin;
    const EnuPoint wanted = plane.to_local(align.second->at);
    const double way_m = std::hypot(way.east_m, way.north_m);
    const double wanted_m = std::hypot(wanted.east_m, wanted.north_m);
    if (!(std::min(way_m, wanted_m) >= kLeast_m)) {
      return tl::unexpected<Error>(wrong("/second", "is too near to tell a direction"));
    }
    turn_rad = base::angle_diff_rad(direction_rad(way), direction_rad(wanted));
    what += ", turned by " + rounded_text(-base::deg_from_rad(turn_rad)) + " deg; item " +
            std::to_string(align.second->item) + " is " + rounded_text(std::abs(way_m - wanted_m)) +
            " m from its place";
  }
  const double c = std::cos(turn_rad);
  const double s = std::sin(turn_rad);
  const auto centre = map_all(plan, align.first.at, [&](EnuPoint p) {
    const EnuPoint way = p - begin;
    return EnuPoint{c * way.east_m - s * way.north_m, s * way.east_m + c * way.north_m};
  });
  if (!centre) {
    const auto& fields = centre.error().fields;
    return tl::unexpected<Error>(
        wrong("/item", fields.empty() ? centre.error().detail : fields.front().detail));
  }
  if (turn_rad != 0.0) {
    map_headings(plan, [&](double deg) { return deg - base::deg_from_rad(turn_rad); });
  }
  return Done{std::move(plan), std::move(what), std::nullopt, *centre};
}

}  // namespace roverd::mission
