#pragma once
// A plan in the words of the public interface: {name, items, home?, settings?, drawing?}, items
// {type, …}.
//
// Reading is strict: an unknown member, a wrong type or a value out of range is refused, and every
// offending field is named by JSON pointer (at most kMaxFieldErrors of them). `null` stands for an
// absent optional member. Numbers keep every bit of a double in a round trip. Nothing here throws;
// all of it is pure and may run on any thread.
//
// Ranges: lat −90..90, lon −180..180, alt_m −1000..10000, speed_mps 0 < v ≤ 10, radius_m and
// waypoint distances 0 < r ≤ 100, hold_s and seconds 0..86400, heading_deg 0 ≤ h < 360, turn_deg
// −360..360, east_m, north_m and forward_m −10000..10000, gap_m and distance_m 0 < d ≤ 20, offset_m
// −20..20, distance_m of a row 0 < d ≤ 10000, jump item 1..number of items and never itself, times
// 0..10000. Names: 1..200 characters, not only blanks, no control characters.

#include <cstddef>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "base/result.hpp"
#include "mission/plan.hpp"

namespace roverd::mission {

inline constexpr std::size_t kMaxItems = 200'000;
inline constexpr std::size_t kMaxNameLength = 200;  ///< Unicode characters
inline constexpr std::size_t kMaxFieldErrors = 100;
inline constexpr std::size_t kMaxDrawing = 64u << 10u;  ///< bytes as compact text
inline constexpr std::size_t kMaxDrawingKind = 40;
inline constexpr std::size_t kMaxJsonDepth = 32;
/// Of a document's values in memory; a .plan of 200,000 items takes 300 MB.
inline constexpr std::size_t kMaxJsonMemory = 400u << 20u;

/// Any JSON text, for every body the program reads. Malformed, with "byte N" counted from 0, if it
/// is not JSON (in UTF-8, a byte order mark is allowed) or is nested deeper than kMaxJsonDepth.
/// Invalid, with the member's JSON pointer, if a number does not fit a double (1e999) or a member
/// is there twice. TooLarge: it would take more than kMaxJsonMemory. Unavailable: there is not so
/// much now.
base::Result<nlohmann::json> parse_json(std::string_view text);

/// `value` is a plan or it is Invalid; `fields` then names each offending member.
base::Result<Plan> plan_from_json(const nlohmann::json& value);
/// parse_json, then plan_from_json.
base::Result<Plan> plan_from_text(std::string_view text);

/// One item. `pointer` is put before the names in errors ("/item"). A jump's target is not checked
/// against a plan here.
base::Result<Item> item_from_json(const nlohmann::json& value, const std::string& pointer);

/// The rules above for a plan made in memory, with the same pointers.
base::Result<void> check_plan(const Plan& plan);

/// Absent optional members are left out; `settings` is always there.
nlohmann::json plan_to_json(const Plan& plan);
nlohmann::json item_to_json(const Item& item);
/// The same as one compact line: what the store keeps. plan_from_text gives an equal plan back.
std::string plan_to_text(const Plan& plan);

/// The words of the public interface for the enumerations of a plan.
std::string_view to_string(Turn turn) noexcept;         // auto pivot arc through
std::string_view to_string(Side side) noexcept;         // left right
std::string_view to_string(RowSide side) noexcept;      // both left right
std::string_view to_string(RowSeeing seeing) noexcept;  // line rays
std::string_view to_string(SightSource by) noexcept;    // auto scan vision
std::string_view to_string(AtEnd at_end) noexcept;      // hold return repeat back_and_forth

}  // namespace roverd::mission
