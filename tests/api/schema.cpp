#include "schema.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace roverd::test {

using nlohmann::json;

namespace {

const json& resolved(const json& document, const json& object) {
  if (!object.contains("$ref")) return object;
  return document.at(json::json_pointer(object.at("$ref").get<std::string>().substr(1)));
}

bool has_type(const json& value, const std::string& type) {
  if (type == "null") return value.is_null();
  if (type == "boolean") return value.is_boolean();
  if (type == "number") return value.is_number();
  if (type == "integer") return value.is_number_integer();
  if (type == "string") return value.is_string();
  if (type == "array") return value.is_array();
  if (type == "object") return value.is_object();
  throw std::runtime_error("unknown type " + type);
}

bool type_fits(const json& types, const json& value) {
  if (types.is_string()) return has_type(value, types);
  return std::any_of(types.begin(), types.end(),
                     [&](const json& type) { return has_type(value, type); });
}

std::string number_fault(const json& schema, const json& value) {
  const double number = value.get<double>();
  if (schema.contains("minimum") && number < schema["minimum"].get<double>()) return "too small";
  if (schema.contains("maximum") && number > schema["maximum"].get<double>()) return "too large";
  return {};
}

std::string object_fault(const json& document, const json& schema, const json& value,
                         const std::string& pointer) {
  for (const json& name : schema.value("required", json::array())) {
    if (!value.contains(name.get<std::string>())) {
      return pointer + "/" + name.get<std::string>() + " is missing";
    }
  }
  const json properties = schema.value("properties", json::object());
  for (const auto& [name, member] : value.items()) {
    if (properties.contains(name)) {
      const std::string fault =
          schema_fault(document, properties[name], member, pointer + "/" + name);
      if (!fault.empty()) return fault;
    } else if (schema.contains("additionalProperties") &&
               schema["additionalProperties"].is_object()) {
      const std::string fault =
          schema_fault(document, schema["additionalProperties"], member, pointer + "/" + name);
      if (!fault.empty()) return fault;
    } else if (schema.contains("properties") &&
               schema.value("additionalProperties", json()) == false) {
      return pointer + "/" + name + " is not documented";
    }
  }
  return {};
}

std::vector<std::string> split(const std::string& path) {
  std::vector<std::string> out;
  std::istringstream in(path.substr(0, path.find('?')));
  for (std::string part; std::getline(in, part, '/');) out.push_back(part);
  return out;
}

}  // namespace

std::string schema_fault(const json& document, const json& given, const json& value,
                         const std::string& pointer) {
  const json& schema = resolved(document, given);
  if (schema.contains("oneOf")) {
    std::string faults;
    for (const json& option : schema["oneOf"]) {
      const std::string fault = schema_fault(document, option, value, pointer);
      if (fault.empty()) return {};
      faults += fault + "; ";
    }
    return pointer + " fits none: " + faults;
  }
  for (const json& part : schema.value("allOf", json::array())) {
    const std::string fault = schema_fault(document, part, value, pointer);
    if (!fault.empty()) return fault;
  }
  if (schema.contains("type") && !type_fits(schema["type"], value)) {
    return pointer + " has the wrong type: " + value.dump().substr(0, 60);
  }
  if (schema.contains("enum")) {
    const json& words = schema["enum"];
    if (std::find(words.begin(), words.end(), value) == words.end()) {
      return pointer + " is not one of the words: " + value.dump();
    }
  }
  if (value.is_number()) {
    const std::string fault = number_fault(schema, value);
    if (!fault.empty()) return pointer + " is " + fault;
  }
  if (value.is_object()) return object_fault(document, schema, value, pointer);
  if (value.is_array() && schema.contains("items")) {
    for (std::size_t i = 0; i < value.size(); ++i) {
      const std::string fault =
          schema_fault(document, schema["items"], value[i], pointer + "/" + std::to_string(i));
      if (!fault.empty()) return fault;
    }
  }
  return {};
}

std::string documented_path(const json& document, const std::string& address) {
  const auto parts = split(address);
  std::string best;
  for (const auto& [path, methods] : document.at("paths").items()) {
    const auto pattern = split(path);
    if (pattern.size() != parts.size()) continue;
    bool fits = true;
    for (std::size_t i = 0; i < parts.size() && fits; ++i) {
      fits = pattern[i] == parts[i] || (pattern[i].starts_with('{') && !parts[i].empty());
    }
    // A literal wins over a parameter, as in the server.
    if (fits && (best.empty() || best.find('{') != std::string::npos)) best = path;
  }
  return best;
}

const json* answer_schema(const json& document, const std::string& path, const std::string& method,
                          unsigned status) {
  const json& responses = document.at("paths").at(path).at(method).at("responses");
  const std::string key = std::to_string(status);
  if (!responses.contains(key)) {
    throw std::runtime_error(method + " " + path + " answered the undocumented status " + key);
  }
  const json& response = resolved(document, responses.at(key));
  if (!response.contains("content")) return nullptr;
  for (const char* type : {"application/json", "application/problem+json"}) {
    if (response["content"].contains(type)) return &response["content"][type]["schema"];
  }
  return nullptr;
}

}  // namespace roverd::test
