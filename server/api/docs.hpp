#pragma once
// /docs: the OpenAPI document for people. Plain HTML made once, no script, works offline.

#include <string>

#include "api/message.hpp"

namespace roverd::api {

/// @param openapi a document as ours: $ref within itself.
std::string docs_page(const Json& openapi);
std::string_view docs_style() noexcept;

}  // namespace roverd::api
