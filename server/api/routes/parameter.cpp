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

Json parameter_json(const robot::Parameter& p) {
  const bool number = std::holds_alternative<double>(p.info.value);
  const bool flag = std::holds_alternative<bool>(p.info.value);
  return {{"name", p.section + "." + p.info.name},
          {"type", flag             ? "boolean"
                   : !number        ? "text"
                   : p.info.integer ? "integer"
                                    : "number"},
          {"unit", unit_json(p.info.name)},
          {"value", param_value(p.info.value)},
          {"default", param_value(p.initial)},
          {"min", p.info.min ? Json(*p.info.min) : Json(nullptr)},
          {"max", p.info.max ? Json(*p.info.max) : Json(nullptr)},
          {"description", p.info.description},
          {"acts", p.at_once ? "at_once" : "at_next_start"}};
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
      items.push_back(parameter_json(p));
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
    call->respond(json_response(http::status::ok, parameter_json(*p)));
  };
}

std::optional<base::ParamValue> read_value(const Json* value) {
  if (value == nullptr) return std::nullopt;
  if (value->is_boolean()) return base::ParamValue(value->get<bool>());
  if (value->is_number()) return base::ParamValue(value->get<double>());
  if (value->is_string()) return base::ParamValue(value->get<std::string>());
  return std::nullopt;
}

/// Keeps it for the next start, then answers with what holds now.
void keep(const ContextPtr& context, const CallPtr& call, store::StoredParameter changed,
          bool acted) {
  const std::string name = changed.name;
  const Json wanted = param_value(changed.value);
  context->deps.store.keep_parameter(std::move(changed),
                                     [context, call, name, wanted, acted](base::Result<void> kept) {
                                       if (!kept && !acted)
                                         return call->respond(problem(kept.error()));
                                       const auto all = context->deps.robot.parameters();
                                       const robot::Parameter* p = find(all, name);
                                       if (p == nullptr) return call->respond(no_parameter(name));
                                       Json out = parameter_json(*p);
                                       if (acted)
                                         out["value"] = wanted;  // the tick after it publishes it
                                       out["acted"] = acted;
                                       out["kept"] = kept.has_value();
                                       out["next_start"] = kept ? wanted : Json(nullptr);
                                       call->respond(json_response(http::status::ok, out));
                                     });
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
    if (!p->at_once) return keep(context, call, {name, *value}, false);
    context->commands.run(robot::SetParameter{name, *value}, validity, base::steady_now(),
                          [context, call, name, value = *value](base::Result<void> result) {
                            if (!result) return call->respond(problem(result.error()));
                            keep(context, call, {name, value}, true);
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
