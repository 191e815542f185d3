#pragma once
// Kept maps in the words of the public interface. Pure.

#include <cstdint>
#include <optional>
#include <vector>

#include "api/message.hpp"
#include "maps/words.hpp"

namespace roverd::api {

/// Of what is in use just now.
struct MapsNow {
  std::optional<std::int64_t> in_use;
  std::optional<maps::Anchor> placed;    ///< of that one; empty: nobody knows where it lies
  std::optional<maps::Making> making{};  ///< empty: none is being made
};

/// Null: nobody knows.
Json anchor_json(const std::optional<maps::Anchor>& anchor);
/// @param whole with the corners of what is forbidden
Json map_json(const maps::About& about, const MapsNow& now, bool whole);
/// Null: none is being made.
Json making_json(const std::optional<maps::Making>& making);
Json map_list_json(const std::vector<maps::About>& list, const MapsNow& now);

}  // namespace roverd::api
