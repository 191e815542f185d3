// Tokens for scripts: shown once, then only their names.

#include <algorithm>
#include <utility>

#include "api/access_change.hpp"
#include "api/context.hpp"
#include "api/json/rfc3339.hpp"
#include "mission/text.hpp"

namespace roverd::api {

namespace {

using people::Token;

Json token_json(const Token& t) {
  Json out = {{"id", t.id},           {"name", t.name},
              {"user", t.user},       {"role", to_string(t.role)},
              {"methods", t.methods}, {"created", time_or_null(t.created)},
              {"expires", nullptr},   {"used", nullptr}};
  if (t.expires) out["expires"] = base::to_rfc3339(*t.expires);
  if (t.used) out["used"] = time_or_null(*t.used);
  return out;
}

std::vector<std::string> methods_in(Members& members) {
  const Json* given = members.any("methods");
  std::vector<std::string> out;
  if (given == nullptr) return out;
  const auto& known = people::kMethods;
  const auto is_method = [&](const Json& word) {
    return word.is_string() &&
           std::find(known.begin(), known.end(), word.get<std::string>()) != known.end();
  };
  if (!given->is_array() || given->size() > known.size() ||
      !std::all_of(given->begin(), given->end(), is_method)) {
    members.complain("methods", "must be a list of GET, POST, PUT, PATCH, DELETE; empty: all");
    return out;
  }
  for (const Json& word : *given) out.push_back(word.get<std::string>());
  return out;
}

Token token_in(Members& members, const people::Who& who) {
  Token out;
  out.user = who.user;
  for (const char* name : {"name", "role"}) members.require(name);
  if (const auto name = members.text("name")) {
    if (auto wrong = mission::name_problem(*name); !wrong.empty()) {
      members.complain("name", std::move(wrong));
    }
    out.name = *name;
  }
  if (const auto word = members.text("role")) {
    const auto role = people::role_of(*word);
    if (!role) members.complain("role", "must be viewer, operator or admin");
    out.role = role.value_or(people::Role::Viewer);
  }
  out.methods = methods_in(members);
  if (const auto text = members.text("expires")) {
    out.expires = from_rfc3339(*text);
    if (!out.expires) members.complain("expires", "must be a time: 2026-03-01T12:00:00Z");
    if (out.expires && *out.expires <= base::wall_now()) {
      members.complain("expires", "is over already, by the robot's clock");
    }
  }
  return out;
}

void make_token(const ContextPtr& c, const CallPtr& call) {
  // One that ends could make one that does not.
  if (!call->who || call->who->by != people::Who::By::Session) {
    return call->respond(
        problem({base::Code::Conflict, "tokens are made by somebody who has logged in"}));
  }
  const auto body = json_body(call->request);
  if (!body) return call->respond(problem(body.error()));
  Members members(*body);
  Token wanted = token_in(members, *call->who);
  if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
  if (wanted.expires && base::wall_now() < base::kYoungest) {
    return call->respond(problem(
        {base::Code::Conflict, "the robot's clock is not set: nothing can be good until a time"}));
  }
  auto made = c->access.book().add_token(std::move(wanted), Access::now());
  if (!made) return call->respond(problem(made.error()));
  keep_people(c, [c, call, made = *made](const base::Result<void>& kept) {
    if (!kept) {
      (void)c->access.book().end_token({}, made.row.id);
      return call->respond(problem(kept.error()));
    }
    Json out = token_json(made.row);
    out["token"] = made.secret;
    call->respond(json_response(http::status::created, out));
  });
}

void list_tokens(const ContextPtr& c, const CallPtr& call) {
  Json items = Json::array();
  if (c->access.on()) {
    for (const Token& t : c->access.book().tokens_of({})) items.push_back(token_json(t));
  }
  call->respond(json_response(http::status::ok, {{"items", items}, {"next_cursor", nullptr}}));
}

void end_token(const ContextPtr& c, const CallPtr& call) {
  const auto ended = c->access.on() ? c->access.book().end_token({}, call->params["id"])
                                    : base::fail(base::Code::NotFound, "there is no such token");
  if (!ended) return call->respond(problem(ended.error()));
  keep_people(c, [call](const base::Result<void>& kept) {
    if (kept) return call->respond(Response{http::status::no_content, 11});
    call->respond(
        problem({base::Code::Unavailable,
                 "it is over now, but may be back after a restart: " + kept.error().detail}));
  });
}

}  // namespace

void add_token_routes(const ContextPtr& c) {
  c->router.add(
      {http::verb::get, "/tokens", {200}, [c](const CallPtr& call) { list_tokens(c, call); }});
  c->router.add({http::verb::post,
                 "/tokens",
                 {201, 400, 403, 404, 409, 413, 415, 422, 429, 503},
                 [c](const CallPtr& call) { make_token(c, call); }});
  c->router.add(
      {http::verb::delete_, "/tokens/{id}", {204, 403, 404, 429, 503}, [c](const CallPtr& call) {
         end_token(c, call);
       }});
}

}  // namespace roverd::api
