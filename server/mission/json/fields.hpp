#pragma once
// The members of every item, listed once. The same list reads JSON, checks values made in memory
// and writes JSON; a visitor's members are:
//
//   v.number(name, double&, range)            required
//   v.number(name, optional<double>&, range)  may be absent
//   v.whole(name, int&, min, max)             required
//   v.count(name, int&, max)                  required: 0..max, 0 also as "forever"
//   v.count(name, optional<int>&, max)        the same, may be absent
//   v.flag(name, bool&)                       absent means false
//   v.word(name, enumeration&)                required
//   v.word(name, optional<enumeration>&)      may be absent
//   v.word_or(name, enumeration&, usual)      absent means `usual`
//   v.name(name, string&)                     required
//   v.name(name, optional<string>&)           may be absent
//   v.rest(json&)                             all members that no other line names
//   v.exactly_one(a, has_a, b, has_b)
//   v.together(a, has_a, b, has_b)            both or none

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "mission/json/json.hpp"
#include "mission/plan.hpp"

namespace roverd::mission {

struct Range {
  double min;
  double max;
  bool without_min = false;  ///< open below
  bool without_max = false;  ///< open above

  /// false for NaN
  constexpr bool holds(double value) const noexcept {
    return (without_min ? value > min : value >= min) && (without_max ? value < max : value <= max);
  }
};

/// "must be from 0 to 10, is 11", for a value that it does not hold.
std::string range_problem(const Range& range, double value);

inline constexpr Range kLat{-90.0, 90.0};
inline constexpr Range kLon{-180.0, 180.0};
inline constexpr Range kAlt_m{-1000.0, 10'000.0};
inline constexpr Range kSpeed_mps{0.0, 10.0, true};
inline constexpr Range kCorridor_m{0.05, 100.0};
inline constexpr Range kRadius_m{0.0, 100.0, true};
inline constexpr Range kHold_s{0.0, 86'400.0};
inline constexpr Range kHeading_deg{0.0, 360.0, false, true};
inline constexpr Range kTurn_deg{-360.0, 360.0};
inline constexpr Range kLocal_m{-10'000.0, 10'000.0};
inline constexpr Range kBeside_m{0.0, 20.0, true};
inline constexpr Range kRow_m{0.0, 10'000.0, true};
inline constexpr Range kStandOff_m{0.1, 5.0};
inline constexpr Range kOffset_m{-20.0, 20.0};
inline constexpr Range kDrift_m{0.1, 100.0};
inline constexpr Range kCircle_m{0.5, 1000.0};
inline constexpr Range kArc_m{0.1, 100.0};  ///< of a turn
inline constexpr Range kCircleTurns{0.05, 1000.0};
inline constexpr int kMaxLandmarks = 10'000;
inline constexpr int kMaxStations = 36;  ///< a turn
inline constexpr int kMaxTimes = 10'000;

template <class E>
inline constexpr std::array<E, 0> kWordsOf{};
template <>
inline constexpr std::array kWordsOf<Turn>{Turn::Auto, Turn::Pivot, Turn::Arc, Turn::Through};
template <>
inline constexpr std::array kWordsOf<Side>{Side::Left, Side::Right};
template <>
inline constexpr std::array kWordsOf<RowSide>{RowSide::Both, RowSide::Left, RowSide::Right};
template <>
inline constexpr std::array kWordsOf<RowSeeing>{RowSeeing::Line, RowSeeing::Rays};
template <>
inline constexpr std::array kWordsOf<SightSource>{SightSource::Auto, SightSource::Scan,
                                                  SightSource::Vision};
template <>
inline constexpr std::array kWordsOf<AtEnd>{AtEnd::Hold, AtEnd::Return, AtEnd::Repeat,
                                            AtEnd::BackAndForth};

/// T or const T.
template <class P, class T>
concept Of = std::is_same_v<std::remove_const_t<P>, T>;

template <class V>
void fields(V& v, Of<Waypoint> auto& p) {
  v.number("lat", p.at.lat, kLat);
  v.number("lon", p.at.lon, kLon);
  v.number("alt_m", p.alt_m, kAlt_m);
  v.number("speed_mps", p.speed_mps, kSpeed_mps);
  v.number("radius_m", p.radius_m, kRadius_m);
  v.number("hold_s", p.hold_s, kHold_s);
  v.flag("reverse", p.reverse);
  v.word_or("turn", p.turn, Turn::Auto);
}
template <class V>
void fields(V& v, Of<Local> auto& p) {
  v.number("east_m", p.east_m, kLocal_m);
  v.number("north_m", p.north_m, kLocal_m);
  v.number("heading_deg", p.heading_deg, kHeading_deg);
}
template <class V>
void fields(V& v, Of<MapPoint> auto& p) {
  v.number("x_m", p.x_m, kLocal_m);
  v.number("y_m", p.y_m, kLocal_m);
  v.number("yaw_deg", p.yaw_deg, kTurn_deg);
  v.number("speed_mps", p.speed_mps, kSpeed_mps);
  v.number("radius_m", p.radius_m, kRadius_m);
  v.number("hold_s", p.hold_s, kHold_s);
  v.flag("reverse", p.reverse);
}
template <class V>
void fields(V& v, Of<MissionMap> auto& p) {
  v.name("map", p.map);
}
template <class V>
void fields(V& v, Of<Move> auto& p) {
  v.number("forward_m", p.forward_m, kLocal_m);
}
template <class V>
void fields(V& v, Of<TurnBy> auto& p) {
  v.number("turn_deg", p.turn_deg, kTurn_deg);
  v.number("heading_deg", p.heading_deg, kHeading_deg);
  v.number("radius_m", p.radius_m, kArc_m);
  v.exactly_one("turn_deg", p.turn_deg.has_value(), "heading_deg", p.heading_deg.has_value());
}
template <class V>
void fields(V& v, Of<Wait> auto& p) {
  v.number("seconds", p.seconds, kHold_s);
}
template <class V>
void fields(V& v, Of<Speed> auto& p) {
  v.number("speed_mps", p.speed_mps, kSpeed_mps);
}
template <class V>
void until_fields(V& v, auto& p) {
  v.number("until_lat", p.lat, kLat);
  v.number("until_lon", p.lon, kLon);
  v.together("until_lat", p.lat.has_value(), "until_lon", p.lon.has_value());
  v.name("until_place", p.place);
}
template <class V>
void fields(V& v, Of<Row> auto& p) {
  v.word_or("side", p.side, RowSide::Both);
  v.number("gap_m", p.gap_m, kBeside_m);
  v.number("speed_mps", p.speed_mps, kSpeed_mps);
  v.number("distance_m", p.distance_m, kRow_m);
  v.word_or("seeing", p.seeing, RowSeeing::Line);
  until_fields(v, p.until);
}
template <class V>
void fields(V& v, Of<Wall> auto& p) {
  v.word("side", p.side);
  v.number("distance_m", p.distance_m, kBeside_m);
  v.number("speed_mps", p.speed_mps, kSpeed_mps);
  v.number("length_m", p.length_m, kRow_m);
  v.word("source", p.source);
  v.flag("landmarks_first", p.landmarks_first);
  until_fields(v, p.until);
}
template <class V>
void fields(V& v, Of<Landmarks> auto& p) {
  v.name("name", p.name);
  v.number("offset_m", p.offset_m, kOffset_m);
  v.word("side", p.side);
  v.exactly_one("offset_m", p.offset_m.has_value(), "side", p.side.has_value());
  v.number("speed_mps", p.speed_mps, kSpeed_mps);
  v.count("count", p.count, kMaxLandmarks);
  v.word("source", p.source);
}
template <class V>
void fields(V& v, Of<Dock> auto& p) {
  v.whole("tag", p.tag, 0, kMostTag);
  v.number("stand_off_m", p.stand_off_m, kStandOff_m);
}
template <class V>
void fields(V& v, Of<Jump> auto& p) {
  v.whole("item", p.item, 1, static_cast<int>(kMaxItems));
  v.count("times", p.times, kMaxTimes);
}
template <class V>
void fields(V&, Of<ReturnHome> auto&) {}
template <class V>
void fields(V& v, Of<Action> auto& p) {
  v.name("name", p.name);
  v.rest(p.arguments);
}
template <class V>
void fields(V& v, Of<Loiter> auto& p) {
  v.number("lat", p.lat, kLat);
  v.number("lon", p.lon, kLon);
  v.number("seconds", p.seconds, kHold_s);
  v.number("radius_m", p.radius_m, kDrift_m);
  v.together("lat", p.lat.has_value(), "lon", p.lon.has_value());
}
template <class V>
void fields(V& v, Of<Circle> auto& p) {
  v.number("lat", p.at.lat, kLat);
  v.number("lon", p.at.lon, kLon);
  v.number("radius_m", p.radius_m, kCircle_m);
  v.number("turns", p.turns, kCircleTurns);
  v.flag("clockwise", p.clockwise);
  v.number("speed_mps", p.speed_mps, kSpeed_mps);
  v.count("stations", p.stations, kMaxStations);
  v.number("hold_s", p.hold_s, kHold_s);
}
template <class V>
void fields(V& v, Of<Home> auto& p) {
  v.number("lat", p.at.lat, kLat);
  v.number("lon", p.at.lon, kLon);
  v.number("alt_m", p.alt_m, kAlt_m);
}
template <class V>
void fields(V& v, Of<Settings> auto& p) {
  v.word_or("at_end", p.at_end, AtEnd::Hold);
  v.number("speed_mps", p.speed_mps, kSpeed_mps);
  v.count("times", p.times, kMaxTimes);
  v.number("corridor_m", p.corridor_m, kCorridor_m);
}

}  // namespace roverd::mission
