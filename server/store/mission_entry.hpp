#pragma once
// What the parts of Missions hand to each other inside a transaction.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mission/json/json.hpp"
#include "mission/text.hpp"
#include "store/missions.hpp"

namespace roverd::store {

inline std::int64_t ns_from(base::WallTime time) noexcept {
  return time.time_since_epoch().count();
}
inline base::WallTime time_from(std::int64_t ns) noexcept {
  return base::WallTime(base::Duration(ns));
}

/// The present row of a mission.
struct Missions::Head {
  std::string id;
  std::int64_t revision = 0;
  std::int64_t created_ns = 0;
  bool deleted = false;
  bool archived = false;
  std::string name;
};

/// The text of a revision's plan, and how it is kept.
struct Missions::Text {
  std::string text;
  bool whole = true;      ///< needs no other revision
  bool deletion = false;  ///< there is none
  std::size_t kept_bytes = 0;
  std::int64_t time_ns = 0;
};

/// A revision to be written.
struct Missions::Entry {
  std::int64_t time_ns = 0;
  std::string author;
  std::string what;
  std::string name;
  int items = 0;
  double length_m = 0.0;
  std::optional<std::string> plan;                 ///< empty: a deletion
  std::optional<std::vector<std::string>> tags{};  ///< empty: as they are

  Entry(const Change& change, std::string_view usual, base::WallTime now)
      : time_ns(ns_from(now)),
        author(mission::clean_name(change.author, "")),
        what(mission::clean_name(change.what, usual)) {}

  void hold(const mission::Plan& p) {
    name = p.name;
    items = static_cast<int>(p.items.size());
    length_m = mission::length_m(p);
    plan = mission::plan_to_text(p);
  }
};

}  // namespace roverd::store
