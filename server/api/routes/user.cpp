// Users: who there is, and what they may.

#include <utility>

#include "api/access_change.hpp"
#include "api/context.hpp"
#include "base/log.hpp"
#include "people/secret.hpp"

namespace roverd::api {

namespace {

using base::Result;
using people::Role;
using people::User;

Json user_json(const User& u) {
  return {{"name", u.name}, {"role", to_string(u.role)}, {"created", time_or_null(u.created)}};
}

std::optional<Role> role_in(Members& members) {
  const auto word = members.text("role");
  if (!word) return std::nullopt;
  const auto role = people::role_of(*word);
  if (!role) members.complain("role", "must be viewer, operator or admin");
  return role;
}

bool refuse_while_off(const ContextPtr& c, const CallPtr& call) {
  if (c->access.on()) return false;
  call->respond(problem({base::Code::Conflict, "access control is off: there are no users"}));
  return true;
}

void answer_user(const ContextPtr& c, const CallPtr& call, const std::string& name,
                 http::status status) {
  const User* user = c->access.book().user(name);
  if (user == nullptr) {
    return call->respond(problem({base::Code::NotFound, "there is no such user"}));
  }
  call->respond(json_response(status, user_json(*user)));
}

/// Hashes it beside the web thread.
template <class Then>
void with_hash(const ContextPtr& c, const CallPtr& call, std::string password, Then then) {
  c->aside(
      call, Effort{Effort::kSmall + 1},
      [password = std::move(password)] { return people::hash_password(password); },
      [c, call, then = std::move(then)](Result<std::string> hash) {
        if (!hash) return call->respond(problem(hash.error()));
        // Hashing takes its time, and who asked may be no admin any more.
        const auto still = call->who ? c->access.book().still(*call->who, Access::now())
                                     : std::optional<people::Who>();
        if (!still || still->role != Role::Admin) {
          return call->respond(problem(403, "the right to do this has ended meanwhile"));
        }
        then(std::move(*hash));
      });
}

void make_user(const ContextPtr& c, const CallPtr& call) {
  if (refuse_while_off(c, call)) return;
  const auto body = json_body(call->request);
  if (!body) return call->respond(problem(body.error()));
  Members members(*body);
  for (const char* name : {"name", "role", "password"}) members.require(name);
  const std::string name = members.text("name").value_or("");
  const std::string password = members.text("password").value_or("");
  complain_of_new_user(members, "name", name, "password", password);
  const Role role = role_in(members).value_or(Role::Viewer);
  if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
  with_hash(c, call, password, [c, call, name, role](std::string hash) {
    const auto added = c->access.book().add_user(name, role, std::move(hash), Access::now());
    if (!added) return call->respond(problem(added.error()));
    keep_people(c, [c, call, name](const Result<void>& kept) {
      if (kept) return answer_user(c, call, name, http::status::created);
      (void)c->access.book().remove_user(name);
      call->respond(problem(kept.error()));
    });
  });
}

/// What cannot be kept holds until the program ends: less is taken back than was given.
void keep_change(const ContextPtr& c, const CallPtr& call, const std::string& name) {
  keep_people(c, [c, call, name](const Result<void>& kept) {
    if (kept) return answer_user(c, call, name, http::status::ok);
    call->respond(problem({base::Code::Unavailable,
                           "it holds now, but not after a restart: " + kept.error().detail}));
  });
}

void change_user(const ContextPtr& c, const CallPtr& call) {
  if (refuse_while_off(c, call)) return;
  const auto body = json_body(call->request);
  if (!body) return call->respond(problem(body.error()));
  const std::string name = call->params["name"];
  Members members(*body);
  const auto role = role_in(members);
  const auto password = members.text("password");
  if (password) {
    if (auto wrong = people::password_problem(*password, name); !wrong.empty()) {
      members.complain("password", std::move(wrong));
    }
  }
  if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
  if (c->access.book().user(name) == nullptr) {
    return call->respond(problem({base::Code::NotFound, "there is no such user"}));
  }
  const std::string keep = call->who ? call->who->id : std::string();
  const auto change = [c, call, name, role, keep](std::optional<std::string> hash) {
    const auto done = c->access.book().change_user(name, role, std::move(hash), keep);
    if (!done) return call->respond(problem(done.error()));
    keep_change(c, call, name);
  };
  if (!password) return change(std::nullopt);
  with_hash(c, call, *password, [change](std::string hash) { change(std::move(hash)); });
}

void remove_user(const ContextPtr& c, const CallPtr& call) {
  if (refuse_while_off(c, call)) return;
  const auto done = c->access.book().remove_user(call->params["name"]);
  if (!done) return call->respond(problem(done.error()));
  // Whoever was the last one leaves a robot that wants its first admin again.
  if (c->access.book().needs_setup()) c->tell_code();
  keep_people(c, [call](const Result<void>& kept) {
    if (kept) return call->respond(Response{http::status::no_content, 11});
    call->respond(
        problem({base::Code::Unavailable,
                 "the user is out now, but may be back after a restart: " + kept.error().detail}));
  });
}

void list_users(const ContextPtr& c, const CallPtr& call) {
  Json items = Json::array();
  if (c->access.on()) {
    for (const User& u : c->access.book().users()) items.push_back(user_json(u));
  }
  call->respond(json_response(http::status::ok, {{"items", items}, {"next_cursor", nullptr}}));
}

}  // namespace

void add_user_routes(const ContextPtr& c) {
  c->router.add(
      {http::verb::get, "/users", {200}, [c](const CallPtr& call) { list_users(c, call); }});
  c->router.add({http::verb::post,
                 "/users",
                 {201, 400, 403, 404, 409, 413, 415, 422, 429, 503},
                 [c](const CallPtr& call) { make_user(c, call); }});
  c->router.add({http::verb::patch,
                 "/users/{name}",
                 {200, 400, 403, 404, 409, 413, 415, 422, 429, 503},
                 [c](const CallPtr& call) { change_user(c, call); }});
  c->router.add({http::verb::delete_,
                 "/users/{name}",
                 {204, 403, 404, 409, 429, 503},
                 [c](const CallPtr& call) { remove_user(c, call); }});
}

void load_people(const ContextPtr& context) {
  if (!context->access.on()) return;
  context->deps.store.read_people([context](base::Result<people::Everybody> kept) {
    if (!kept) {
      base::log(base::Level::Error, "api", "the users cannot be read",
                {{"reason", kept.error().detail}});
      return;
    }
    context->access.book().load(std::move(*kept), Access::now());
    if (context->access.book().needs_setup()) context->tell_code();
  });
}

}  // namespace roverd::api
