#pragma once
// A small judge of JSON against the schemas of the OpenAPI document: the words that the document
// uses, no others.

#include <string>

#include <nlohmann/json.hpp>

namespace roverd::test {

/// @return what is wrong, with its JSON pointer; empty if `value` fits.
std::string schema_fault(const nlohmann::json& document, const nlohmann::json& schema,
                         const nlohmann::json& value, const std::string& pointer = "");

/// The schema of an answer: by documented path ("/missions/{id}"), method in lower case and status.
/// Null if the document names no JSON for it; throws if it does not know the status at all.
const nlohmann::json* answer_schema(const nlohmann::json& document, const std::string& path,
                                    const std::string& method, unsigned status);

/// The documented path that an address belongs to; empty if none does.
std::string documented_path(const nlohmann::json& document, const std::string& address);

}  // namespace roverd::test
