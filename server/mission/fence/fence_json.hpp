#pragma once
// A fence in the words of the public interface:
//
//   {"name": "North field",
//    "areas": [{"kind": "inclusion", "polygon": [{"lat": 58.1, "lon": 26.7}, …]},
//              {"kind": "exclusion", "circle": {"lat": 58.1, "lon": 26.7, "radius_m": 12}}],
//    "rally": [{"lat": 58.1, "lon": 26.7, "alt_m": 60}]}
//
// `areas` and `rally` may be left out. Strict like the reading of plans (see json.hpp). Pure.

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "base/result.hpp"
#include "mission/fence/fence.hpp"

namespace roverd::mission {

/// Satisfies check_fence, or Invalid with a pointer to each offending member.
base::Result<Fence> fence_from_json(const nlohmann::json& value);
base::Result<Fence> fence_from_text(std::string_view text);

nlohmann::json fence_to_json(const Fence& fence);

std::string_view to_string(AreaKind kind) noexcept;  // inclusion exclusion

}  // namespace roverd::mission
