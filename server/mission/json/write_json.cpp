// Plans to JSON values and to the compact text that the store keeps, by the lists in fields.hpp.

#include <utility>

#include "mission/json/fields.hpp"
#include "mission/json/json.hpp"
#include "mission/text.hpp"

namespace roverd::mission {
namespace {

using nlohmann::json;

class ValueWriter {
 public:
  explicit ValueWriter(json& out) : out_(out) {}

  void number(const char* name, const double& value, const Range&) { out_[name] = value; }
  void number(const char* name, const std::optional<double>& value, const Range&) {
    if (value) out_[name] = *value;
  }
  void whole(const char* name, const int& value, int, int) { out_[name] = value; }
  void count(const char* name, const int& value, int) { out_[name] = value; }
  void count(const char* name, const std::optional<int>& value, int) {
    if (value) out_[name] = *value;
  }
  void flag(const char* name, const bool& value) {
    if (value) out_[name] = true;
  }
  template <class E>
  void word(const char* name, const E& value) {
    out_[name] = to_string(value);
  }
  template <class E>
  void word(const char* name, const std::optional<E>& value) {
    if (value) word(name, *value);
  }
  template <class E>
  void word_or(const char* name, const E& value, E usual) {
    if (value != usual) word(name, value);
  }
  void name(const char* name, const std::string& value) { out_[name] = value; }
  void name(const char* at, const std::optional<std::string>& value) {
    if (value) name(at, *value);
  }
  void rest(const json& value) {
    for (const auto& [key, member] : value.items()) out_.emplace(key, member);
  }
  void exactly_one(const char*, bool, const char*, bool) {}
  void together(const char*, bool, const char*, bool) {}

 private:
  json& out_;
};

/// Broken UTF-8 (which check_plan refuses) is replaced, so that this never throws.
std::string json_quoted(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// Appends members to an object that is open. A value tree of 10,000 items costs ten times as much.
class TextWriter {
 public:
  explicit TextWriter(std::string& out) : out_(out) {}

  void number(const char* name, const double& value, const Range&) {
    key(name);
    append_number(out_, value);
  }
  void number(const char* name, const std::optional<double>& value, const Range& range) {
    if (value) number(name, *value, range);
  }
  void whole(const char* name, const int& value, int, int) {
    key(name);
    out_ += std::to_string(value);
  }
  void count(const char* name, const int& value, int max) { whole(name, value, 0, max); }
  void count(const char* name, const std::optional<int>& value, int max) {
    if (value) whole(name, *value, 0, max);
  }
  void flag(const char* name, const bool& value) {
    if (!value) return;
    key(name);
    out_ += "true";
  }
  template <class E>
  void word(const char* name, const E& value) {
    key(name);
    out_ += '"';
    out_ += to_string(value);
    out_ += '"';
  }
  template <class E>
  void word(const char* name, const std::optional<E>& value) {
    if (value) word(name, *value);
  }
  template <class E>
  void word_or(const char* name, const E& value, E usual) {
    if (value != usual) word(name, value);
  }
  void name(const char* name, const std::string& value) {
    key(name);
    out_ += json_quoted(value);
  }
  void name(const char* at, const std::optional<std::string>& value) {
    if (value) name(at, *value);
  }
  void rest(const json& value) {
    for (const auto& [name, member] : value.items()) {
      separate();
      out_ += json_quoted(name);
      out_ += ':';
      out_ += json_quoted(member);
    }
  }
  void exactly_one(const char*, bool, const char*, bool) {}
  void together(const char*, bool, const char*, bool) {}

  void key(const char* name) {
    separate();
    out_ += '"';
    out_ += name;
    out_ += "\":";
  }

 private:
  void separate() {
    if (out_.back() != '{') out_ += ',';
  }

  std::string& out_;
};

template <class T>
void append_object(std::string& out, const T& members) {
  out += '{';
  TextWriter writer(out);
  fields(writer, members);
  out += '}';
}

}  // namespace

json item_to_json(const Item& item) {
  json out = json::object();
  out["type"] = type_name(item);
  ValueWriter writer(out);
  std::visit([&](const auto& members) { fields(writer, members); }, item);
  return out;
}

json plan_to_json(const Plan& plan) {
  json out = json::object();
  out["name"] = plan.name;
  if (plan.home) {
    ValueWriter writer(out["home"] = json::object());
    fields(writer, *plan.home);
  }
  json& settings = out["settings"] = json::object();
  ValueWriter writer(settings);
  fields(writer, plan.settings);
  writer.word("at_end", plan.settings.at_end);
  json::array_t items;
  items.reserve(plan.items.size());
  for (const Item& item : plan.items) items.push_back(item_to_json(item));
  out["items"] = std::move(items);
  if (plan.frame) {
    ValueWriter of_frame(out["frame"] = json::object());
    fields(of_frame, *plan.frame);
  }
  if (!plan.drawing.is_null()) out["drawing"] = plan.drawing;
  return out;
}

std::string plan_to_text(const Plan& plan) {
  std::string out = "{\"name\":" + json_quoted(plan.name);
  if (plan.home) {
    out += ",\"home\":";
    append_object(out, *plan.home);
  }
  if (plan.frame) {
    out += ",\"frame\":";
    append_object(out, *plan.frame);
  }
  out += ",\"settings\":";
  append_object(out, plan.settings);
  out += ",\"items\":[";
  for (std::size_t i = 0; i < plan.items.size(); ++i) {
    if (i > 0) out += ',';
    out += "{\"type\":\"";
    out += type_name(plan.items[i]);
    out += '"';
    TextWriter writer(out);
    std::visit([&](const auto& members) { fields(writer, members); }, plan.items[i]);
    out += '}';
  }
  out += ']';
  if (!plan.drawing.is_null()) out += ",\"drawing\":" + plan.drawing.dump();
  out += '}';
  return out;
}

std::string_view to_string(Turn turn) noexcept {
  switch (turn) {
    case Turn::Auto:
      return "auto";
    case Turn::Pivot:
      return "pivot";
    case Turn::Arc:
      return "arc";
    case Turn::Through:
      return "through";
  }
  return "auto";
}

std::string_view to_string(Side side) noexcept {
  switch (side) {
    case Side::Left:
      return "left";
    case Side::Right:
      return "right";
  }
  return "left";
}

std::string_view to_string(RowSide side) noexcept {
  switch (side) {
    case RowSide::Both:
      return "both";
    case RowSide::Left:
      return "left";
    case RowSide::Right:
      return "right";
  }
  return "both";
}

std::string_view to_string(RowSeeing seeing) noexcept {
  switch (seeing) {
    case RowSeeing::Line:
      return "line";
    case RowSeeing::Rays:
      return "rays";
  }
  return "line";
}

std::string_view to_string(SightSource by) noexcept {
  switch (by) {
    case SightSource::Auto:
      return "auto";
    case SightSource::Scan:
      return "scan";
    case SightSource::Vision:
      return "vision";
  }
  return "auto";
}

std::string_view to_string(AtEnd at_end) noexcept {
  switch (at_end) {
    case AtEnd::Hold:
      return "hold";
    case AtEnd::Return:
      return "return";
    case AtEnd::Repeat:
      return "repeat";
    case AtEnd::BackAndForth:
      return "back_and_forth";
  }
  return "hold";
}

}  // namespace roverd::mission
