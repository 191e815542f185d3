#include "api/docs.hpp"

#include <vector>

#include "api/problem.hpp"
#include "mission/formats/xml.hpp"

namespace roverd::api {

namespace {

using mission::xml_escaped;

std::string text_of(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? xml_escaped(found->get<std::string>()) : "";
}

/// The last part of "#/components/schemas/Vehicle".
std::string ref_name(const Json& object) {
  const auto ref = object.at("$ref").get<std::string>();
  return ref.substr(ref.rfind('/') + 1);
}

std::string type_words(const Json& schema);

std::string joined_types(const Json& options) {
  std::string out;
  for (const Json& option : options) out += (out.empty() ? "" : " | ") + type_words(option);
  return out;
}

/// "number | null", "list of Event" with a link, "\"hold\" | \"return\"".
std::string type_words(const Json& schema) {
  if (schema.contains("$ref")) {
    const std::string name = ref_name(schema);
    return "<a href=\"#schema-" + name + "\">" + name + "</a>";
  }
  for (const char* key : {"oneOf", "allOf"}) {
    if (schema.contains(key)) return joined_types(schema.at(key));
  }
  if (schema.contains("enum")) {
    std::string out;
    for (const Json& word : schema.at("enum")) {
      out += (out.empty() ? "" : " | ") + ("<code>" + xml_escaped(word.dump()) + "</code>");
    }
    return out;
  }
  if (!schema.contains("type")) return "anything";
  if (schema.at("type").is_array()) {
    std::string out;
    for (const Json& one : schema.at("type")) {
      out += (out.empty() ? "" : " | ") + one.get<std::string>();
    }
    return out;
  }
  auto type = schema.at("type").get<std::string>();
  if (type == "array" && schema.contains("items")) {
    return "list of " + type_words(schema.at("items"));
  }
  return type;
}

std::string limits_words(const Json& schema) {
  std::string out;
  const auto add = [&](const char* key, const char* sign) {
    if (schema.contains(key)) out += std::string(" ") + sign + " " + schema.at(key).dump();
  };
  add("minimum", "≥");
  add("exclusiveMinimum", "&gt;");
  add("maximum", "≤");
  add("default", "default");
  return out;
}

std::string property_rows(const Json& schema, const std::string& prefix = "") {
  std::string out;
  if (!schema.contains("properties")) return out;
  const Json required = schema.value("required", Json::array());
  for (const auto& [name, property] : schema.at("properties").items()) {
    bool needed = false;
    for (const Json& one : required) needed = needed || one == name;
    out += "<tr><td><code>" + prefix + xml_escaped(name) + "</code>" +
           (needed ? "" : " (optional)") + "</td><td>" + type_words(property) +
           limits_words(property) + "</td><td>" + text_of(property, "description") + "</td></tr>";
    out += property_rows(property, prefix + xml_escaped(name) + ".");
  }
  return out;
}

std::string table(const std::string& rows) {
  return rows.empty() ? "" : "<table>" + rows + "</table>";
}

class Page {
 public:
  explicit Page(const Json& document) : doc_(document) {}

  std::string make() {
    const Json& info = doc_.at("info");
    out_ =
        "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta "
        "name=\"viewport\" content=\"width=device-width, initial-scale=1\"><title>" +
        text_of(info, "title") +
        " API</title><link rel=\"stylesheet\" href=\"/docs/style.css\"></head><body><h1>" +
        text_of(info, "title") + " " + text_of(info, "version") + "</h1><p>" +
        text_of(info, "summary") + "</p><p>" + text_of(info, "description") +
        " Machine-readable: <a href=\"/openapi.json\">openapi.json</a>.</p>";
    contents();
    for (const auto& [path, methods] : doc_.at("paths").items()) {
      for (const auto& [method, operation] : methods.items()) call(path, method, operation);
    }
    schemas();
    problems();
    return out_ + "</body></html>\n";
  }

 private:
  const Json& resolved(const Json& object) const {
    if (!object.contains("$ref")) return object;
    const auto ref = object.at("$ref").get<std::string>();
    return doc_.at(Json::json_pointer(ref.substr(1)));
  }

  void contents() {
    out_ += "<ul class=\"contents\">";
    for (const auto& [path, methods] : doc_.at("paths").items()) {
      for (const auto& [method, operation] : methods.items()) {
        out_ += "<li><a href=\"#" + text_of(operation, "operationId") + "\"><b class=\"" + method +
                "\">" + method + "</b> <code>" + xml_escaped(path) + "</code></a> " +
                text_of(operation, "summary") + "</li>";
      }
    }
    out_ +=
        "<li><a href=\"#schemas\">Values</a></li><li><a href=\"#problems\">Refusals</a></li>"
        "</ul>";
  }

  void call(const std::string& path, const std::string& method, const Json& operation) {
    out_ += "<section id=\"" + text_of(operation, "operationId") + "\"><h2><b class=\"" + method +
            "\">" + method + "</b> <code>/api/v1" + xml_escaped(path) + "</code></h2><p>" +
            text_of(operation, "summary") + ". " + text_of(operation, "description") + "</p>";
    std::string rows;
    for (const Json& given : operation.value("parameters", Json::array())) {
      const Json& parameter = resolved(given);
      rows += "<tr><td><code>" + text_of(parameter, "name") + "</code> (" +
              text_of(parameter, "in") + (parameter.value("required", false) ? "" : ", optional") +
              ")</td><td>" + type_words(parameter.at("schema")) +
              limits_words(parameter.at("schema")) + "</td><td>" +
              text_of(parameter, "description") + "</td></tr>";
    }
    out_ += table(rows);
    if (operation.contains("requestBody")) {
      const Json& body = operation.at("requestBody");
      out_ += std::string("<p>Body") + (body.value("required", false) ? "" : " (optional)") + ": " +
              content_words(body) + "</p>";
    }
    answers(operation.at("responses"));
    out_ += "</section>";
  }

  static std::string content_words(const Json& holder) {
    std::string out;
    const Json content = holder.value("content", Json::object());
    for (const auto& [type, media] : content.items()) {
      out += (out.empty() ? "" : ", ") + xml_escaped(type) +
             (media.contains("schema") ? " " + type_words(media.at("schema")) : "");
    }
    return out;
  }

  void answers(const Json& responses) {
    std::string rows;
    for (const auto& [status, given] : responses.items()) {
      const Json& response = resolved(given);
      rows += "<tr><td><b>" + xml_escaped(status) + "</b></td><td>" + content_words(response) +
              "</td><td>" + text_of(response, "description") + "</td></tr>";
    }
    out_ += table(rows);
  }

  void schemas() {
    out_ += "<h1 id=\"schemas\">Values</h1>";
    for (const auto& [name, schema] : doc_.at("components").at("schemas").items()) {
      out_ += "<section id=\"schema-" + name + "\"><h2>" + name + "</h2><p>" +
              text_of(schema, "description") + "</p>";
      const std::string rows = property_rows(schema);
      out_ += rows.empty() ? "<p>" + type_words(schema) + "</p>" : table(rows);
      for (const Json& part : schema.value("allOf", Json::array())) {
        out_ += table(property_rows(part));
      }
      out_ += "</section>";
    }
  }

  void problems() {
    out_ += "<h1 id=\"problems\">Refusals</h1>";
    for (const ProblemKind& kind : problem_kinds()) {
      out_ += "<section id=\"problem-" + std::string(kind.slug) + "\"><h2>" +
              std::to_string(kind.status) + " " + xml_escaped(kind.title) + "</h2><p>" +
              xml_escaped(kind.meaning) + "</p></section>";
    }
  }

  const Json& doc_;
  std::string out_;
};

}  // namespace

std::string docs_page(const Json& openapi) {
  return Page(openapi).make();
}

std::string_view docs_style() noexcept {
  return R"css(:root { color-scheme: light dark; }
body { font: 15px/1.5 system-ui, sans-serif; max-width: 60rem; margin: 0 auto; padding: 1rem; }
code { font: 14px/1.4 ui-monospace, monospace; }
h2 { font-size: 1.05rem; margin: 2rem 0 .3rem; }
table { border-collapse: collapse; width: 100%; margin: .5rem 0; display: block; overflow-x: auto; }
td { border-top: 1px solid #8885; padding: .2rem .8rem .2rem 0; vertical-align: top; }
section:target { outline: 2px solid #3b82f6; outline-offset: .5rem; }
.contents { list-style: none; padding: 0; columns: 22rem; }
b.get, b.post, b.put, b.delete { text-transform: uppercase; font-size: .75rem; padding: .1rem .4rem;
  border-radius: .25rem; color: #fff; background: #2563eb; }
b.post { background: #15803d; } b.put { background: #b45309; } b.delete { background: #b91c1c; }
)css";
}

}  // namespace roverd::api
