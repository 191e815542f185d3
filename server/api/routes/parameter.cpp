// Parameters while the program runs: what there is, and one changed at a time.

#include <array>
#include <utility>

#include "api/context.hpp"

namespace roverd::api {

namespace {

const std::vector<unsigned> kPut = {200, 400, 403, 404, 409, 413, 415, 422, 429, 503};

struct Unit {
  std::string_view suffix;
  std::string_view unit;
};
/// Longer suffixes first: a name carries its unit.
constexpr std::array<Unit, 17> kUnits = {{{"_radps2", "rad/s2"},
                                          {"_mps2", "m/s2"},
                                          {"_mps3", "m/s3"},
                                          {"_radps", "rad/s"},
                                          {"_1pm", "1/m"},
                                          {"_1ps", "1/s"},
                                          {"_dps", "deg/s"},
                                          {"_mps", "m/s"},
                                          {"_deg", "deg"},
                                          {"_rad", "rad"},
                                          {"_pct", "%"},
                                          {"_hz", "Hz"},
                                          {"_mb", "MB"},
                                          {"_kg", "kg"},
                                          {"_m", "m"},
                                          {"_s", "s"},
                                          {"_v", "V"}}};

Json unit_json(std::string_view name) {
  for (const Unit& u : kUnits) {
    if (name.ends_with(u.suffix)) return u.unit;
  }
  return nullptr;
}

Json param_value(const base::ParamValue& value) {
  return std::visit([](const auto& v) { return Json(v); }, value);
}

const char* acts_text(const robot::Parameter& p) {
  if (!p.at_once) return "at_next_start";
  return p.by_way ? "at_next_load" : "at_once";
}

Json stricter_json(base::Stricter side) {
  switch (side) {
    case base::Stricter::Any:
      return nullptr;
    case base::Stricter::Lower:
      return "lower";
    case base::Stricter::Higher:
      return "higher";
    case base::Stricter::None:
      break;
  }
  return "none";
}

std::string full_name(const robot::Parameter& p) {
  return p.section + "." + p.info.name;
}

Json parameter_json(const Context& context, const robot::Parameter& p) {
  const auto kept = context.kept.find(full_name(p));
  const base::ParamValue& later = kept == context.kept.end() ? p.info.value : kept->second;
  const bool number = std::holds_alternative<double>(p.info.value);
  const bool flag = std::holds_alternative<bool>(p.info.value);
  return {{"name", full_name(p)},
          {"type", flag             ? "boolean"
                   : !number        ? "text"
                   : p.info.integer ? "integer"
                                    : "number"},
          {"unit", unit_json(p.info.name)},
          {"value", param_value(p.info.value)},
          {"next_start_value", param_value(later)},
          {"default", param_value(p.initial)},
          {"min", p.info.min ? Json(*p.info.min) : Json(nullptr)},
          {"max", p.info.max ? Json(*p.info.max) : Json(nullptr)},
          {"description", p.info.description},
          {"acts", acts_text(p)},
          {"stricter", stricter_json(p.info.stricter)}};
}

const robot::Parameter* find(const std::vector<robot::Parameter>& all, std::string_view name) {
  for (const robot::Parameter& p : all) {
    if (name.size() == p.section.size() + 1 + p.info.name.size() &&
        name.starts_with(p.section + ".") && name.ends_with(p.info.name)) {
      return &p;
    }
  }
  return nullptr;
}

std::string name_of(const Call& call) {
  return call.params.find("name")->second;
}

Response no_parameter(const std::string& name) {
  return problem({base::Code::NotFound, "there is no parameter " + name});
}

Handler list_parameters(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    Json items = Json::array();
    for (const robot::Parameter& p : context->deps.robot.parameters()) {
      items.push_back(parameter_json(*context, p));
    }
    call->respond(
        json_response(http::status::ok, {{"items", std::move(items)}, {"next_cursor", nullptr}}));
  };
}

Handler get_parameter(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto all = context->deps.robot.parameters();
    const robot::Parameter* p = find(all, name_of(*call));
    if (p == nullptr) return call->respond(no_parameter(name_of(*call)));
    call->respond(json_response(http::status::ok, parameter_json(*context, *p)));
  };
}

std::optional<base::ParamValue> read_value(const Json* value) {
  if (value == nullptr) return std::nullopt;
  if (value->is_boolean()) return base::ParamValue(value->get<bool>());
  if (value->is_number()) return base::ParamValue(value->get<double>());
  if (value->is_string()) return base::ParamValue(value->get<std::string>());
  return std::nullopt;
}

/// What became of a change.
struct Changed {
  std::string name;
  base::ParamValue value;
  bool taken = false;  ///< by the robot; else it is for the next start
  bool acted = false;
  std::string waits{};  ///< what it waits for, where the robot took it and it does not act yet
};

/// Keeps it for the next start, then answers with what holds now.
void keep(const ContextPtr& context, const CallPtr& call, Changed changed) {
  store::StoredParameter stored{changed.name, changed.value};
  context->deps.store.keep_parameter(
      std::move(stored),
      [context, call, changed = std::move(changed)](const base::Result<void>& kept) {
        if (!kept && !changed.taken) return call->respond(problem(kept.error()));
        if (kept) context->kept[changed.name] = changed.value;
        const auto all = context->deps.robot.parameters();
        const robot::Parameter* p = find(all, changed.name);
        if (p == nullptr) return call->respond(no_parameter(changed.name));
        Json out = parameter_json(*context, *p);
        const Json wanted = param_value(changed.value);
        if (changed.taken) out["value"] = wanted;  // the tick after it publishes it
        out["acted"] = changed.acted;
        out["waits_for"] = changed.waits.empty() ? Json(nullptr) : Json(changed.waits);
        out["kept"] = kept.has_value();
        out["next_start"] = kept ? wanted : Json(nullptr);
        call->respond(json_response(http::status::ok, out));
      });
}

/// The robot took it. What acts in the way of a mission acts when the loaded one is laid anew:
/// at once, unless it is in hand.
void settle(const ContextPtr& context, const CallPtr& call, Changed changed, bool by_way) {
  changed.taken = true;
  changed.acted = true;
  if (!context->deps.robot.loaded()) return keep(context, call, std::move(changed));
  auto done = context->commands.expect(
      base::steady_now() + Commands::kPatience,
      [context, call, changed = std::move(changed), by_way](const base::Result<void>& laid) {
        Changed now = changed;
        if (!laid) {
          now.acted = !by_way;
          now.waits =
              "the loaded mission drives the way that was laid out before: " + laid.error().detail;
        }
        keep(context, call, std::move(now));
      });
  context->deps.services.lay_way_anew(std::move(done));
}

Handler put_parameter(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto body = json_body(call->request);
    if (!body) return call->respond(problem(body.error()));
    const std::string name = name_of(*call);
    const auto all = context->deps.robot.parameters();
    const robot::Parameter* p = find(all, name);
    if (p == nullptr) return call->respond(no_parameter(name));
    Members members(*body);
    members.require("value");
    const auto value = read_value(members.any("value"));
    if (body->is_object() && body->contains("value") && !value) {
      members.complain("value", "must be a number, true or false, or text");
    }
    const robot::Validity validity = validity_of(members, *call, Moves::No);
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
    if (const auto good = context->deps.robot.check_parameter(name, *value); !good) {
      return call->respond(problem(good.error()));
    }
    const bool later = !p->at_once;
    const bool lays_way = robot::lays_way(p->section, p->info.name);
    context->commands.run(robot::SetParameter{name, *value, words_for(call->who), later}, validity,
                          base::steady_now(),
                          [context, call, name, value = *value, later, lays_way,
                           by_way = p->by_way](const base::Result<void>& result) {
                            if (!result) return call->respond(problem(result.error()));
                            Changed changed{name, value, !later, !later};
                            if (lays_way && !later)
                              return settle(context, call, std::move(changed), by_way);
                            keep(context, call, std::move(changed));
                          });
  };
}

}  // namespace

void add_parameter_routes(const ContextPtr& c) {
  c->router.add({http::verb::get, "/parameters", {200}, list_parameters(c)});
  c->router.add({http::verb::get, "/parameters/{name}", {200, 404}, get_parameter(c)});
  c->router.add({http::verb::put, "/parameters/{name}", kPut, put_parameter(c)});
}

}  // namespace roverd::api
