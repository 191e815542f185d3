// Log-in by password and by PIN, log-out, the first admin, where somebody is logged in, and a new
// password of one's own.

#include <optional>
#include <string>
#include <utility>

#include "api/access_change.hpp"
#include "api/context.hpp"
#include "api/log_in.hpp"
#include "people/secret.hpp"

namespace roverd::api {

namespace {

using people::Book;
using people::Session;

Json one_session(const Session& s, const std::string& mine) {
  return {{"id", s.id},
          {"device", s.device},
          {"address", s.address},
          {"created", time_or_null(s.created)},
          {"seen", time_or_null(s.seen)},
          {"current", s.id == mine}};
}

struct Typed {
  std::string user;
  std::string password;
  std::string device;
  std::string code;
};

/// @return empty: answered already
std::optional<Typed> typed_in(const CallPtr& call, bool first) {
  const auto body = json_body(call->request);
  if (!body) {
    call->respond(problem(body.error()));
    return std::nullopt;
  }
  Members members(*body);
  for (const char* name : {"user", "password"}) members.require(name);
  if (first) members.require("code");
  Typed out;
  out.user = members.text("user").value_or("");
  out.password = members.text("password").value_or("");
  out.device =
      members.text("device").value_or(std::string(header(call->request, http::field::user_agent)));
  if (first) {
    out.code = members.text("code").value_or("");
    complain_of_new_user(members, "user", out.user, "password", out.password);
  }
  if (const auto read = members.finish(); !read) {
    call->respond(problem(read.error()));
    return std::nullopt;
  }
  return out;
}

base::Duration wait_of(const ContextPtr& c, const CallPtr& call, const std::string& user) {
  return c->access.book().login_wait(user, peer_of(call->request), Access::now());
}

void log_in(const ContextPtr& c, const CallPtr& call) {
  auto typed = typed_in(call, false);
  if (!typed) return;
  // Not what is no user's name: people type passwords there.
  if (c->access.book().user(typed->user) != nullptr) call->named = typed->user;
  const auto slot = may_hash(c, call, wait_of(c, call, typed->user));
  if (!slot) return;
  const auto attempt =
      c->access.book().begin_login(typed->user, peer_of(call->request), Access::now());
  c->aside(
      call, kHash,
      [attempt, typed = *typed] { return people::is_password(attempt.hash, typed.password); },
      [c, call, attempt, slot, device = typed->device](bool right) {
        Book& book = c->access.book();
        const auto opened = book.end_login(attempt, right, device, Access::now());
        if (!opened) return call->respond(problem(401, "user or password is wrong"));
        book.unlock(c->access.device_secret(call->request), attempt.user, Access::now());
        let_in(c, call, *opened);
      });
}

std::string what_is_left(const people::Device* device) {
  const int left = device == nullptr ? 0 : Book::kWrongPins - device->wrong;
  if (left > 0) return "the PIN is wrong; it may be tried " + std::to_string(left) + " more times";
  return "the PIN is wrong; this device is locked now, and wants the password";
}

/// By a paired device. Its tries are kept before the PIN is compared.
void log_in_by_pin(const ContextPtr& c, const CallPtr& call, const std::string& pin) {
  Book& book = c->access.book();
  const std::string secret = c->access.device_secret(call->request);
  const people::Device* const device = book.by_device(secret, Access::now());
  if (device == nullptr) {
    return call->respond(problem(401, "this device is not paired: use the password"));
  }
  call->named = device->user;
  call->named_by = "device " + device->id;
  if (call->request.count(http::field::origin) != 1) {
    return call->respond(problem(403, "a PIN needs the Origin that every browser sends"));
  }
  if (Book::is_locked(*device)) {
    return call->respond(problem(401,
                                 "this device is locked after too many wrong PINs: use the "
                                 "password"));
  }
  const std::string peer = peer_of(call->request);
  const auto slot = may_hash(c, call, book.pin_wait(*device, peer, Access::now()));
  if (!slot) return;
  const auto attempt = book.begin_pin(*device, peer, Access::now());
  keep_people(c, [c, call, attempt, slot, secret, pin](const base::Result<void>&) {
    c->aside(
        call, kHash, [attempt, pin] { return people::is_password(attempt.hash, pin); },
        [c, call, attempt, slot, secret](bool right) {
          Book& house = c->access.book();
          const auto opened = house.end_pin(attempt, right, Access::now());
          // The cookie lives a year from here.
          if (opened) return let_in(c, call, *opened, secret);
          call->respond(problem(401, what_is_left(house.by_device(secret, Access::now()))));
        });
  });
}

void enter(const ContextPtr& c, const CallPtr& call) {
  if (refuse_without_access(c, call)) return;
  const auto body = json_body(call->request);
  if (!body || !body->is_object() || !body->contains("pin")) return log_in(c, call);
  Members members(*body);
  const std::string pin = members.text("pin").value_or("");
  // A slip of the glove costs no try.
  if (pin.size() < people::kShortestPin || pin.size() > people::kLongestPin) {
    members.complain("pin", "must be 4 to 8 digits");
  }
  if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
  log_in_by_pin(c, call, pin);
}

Handler set_up(const ContextPtr& c) {
  return [c](const CallPtr& call) {
    if (refuse_without_access(c, call)) return;
    Book& book = c->access.book();
    if (!book.needs_setup()) {
      return call->respond(problem({base::Code::Conflict, "the first admin is there already"}));
    }
    auto typed = typed_in(call, true);
    if (!typed) return;
    const auto slot = may_hash(c, call, wait_of(c, call, {}));
    if (!slot) return;
    const std::string peer = peer_of(call->request);
    if (!book.is_code(typed->code, peer, Access::now())) {
      return call->respond(problem(401, "the code is wrong; it is printed where roverd started"));
    }
    c->aside(
        call, kHash, [password = typed->password] { return people::hash_password(password); },
        [c, call, slot, peer, typed = *typed](base::Result<std::string> hash) {
          if (!hash) return call->respond(problem(hash.error()));
          Book& house = c->access.book();
          if (!house.needs_setup()) {
            return call->respond(
                problem({base::Code::Conflict, "the first admin is there already"}));
          }
          const auto now = Access::now();
          auto added = house.add_user(typed.user, people::Role::Admin, *hash, now);
          if (!added) return call->respond(problem(added.error()));
          keep_people(c, [c, call, peer, typed](const base::Result<void>& kept) {
            if (!kept) {
              (void)c->access.book().remove_user(typed.user);
              c->tell_code();
              return call->respond(problem(kept.error()));
            }
            Book& kept_house = c->access.book();
            const auto at = Access::now();
            const auto opened = kept_house.end_login(kept_house.begin_login(typed.user, peer, at),
                                                     true, typed.device, at);
            if (opened) let_in(c, call, *opened);
          });
        });
  };
}

void log_out(const ContextPtr& c, const CallPtr& call) {
  if (!call->who || call->who->by != people::Who::By::Session) {
    return call->respond(problem({base::Code::Conflict, "there is no session to end"}));
  }
  end_sessions(c, call, {call->who->id}, [c, call] {
    Response out{http::status::no_content, 11};
    out.set(http::field::set_cookie, c->access.cookie({}));
    call->respond(std::move(out));
  });
}

void list_sessions(const ContextPtr& c, const CallPtr& call) {
  Json items = Json::array();
  if (call->who) {
    for (const Session& s : c->access.book().sessions_of(call->who->user)) {
      items.push_back(one_session(s, call->who->id));
    }
  }
  call->respond(json_response(http::status::ok, {{"items", items}, {"next_cursor", nullptr}}));
}

void end_one(const ContextPtr& c, const CallPtr& call) {
  if (!call->who) {
    return call->respond(problem({base::Code::NotFound, "there is no such session"}));
  }
  end_sessions(c, call, {call->params["id"]}, [call] {
    call->respond(Response{http::status::no_content, 11});
  });
}

/// Also those that a PIN made; the pairings stay.
void end_others(const ContextPtr& c, const CallPtr& call) {
  if (refuse_without_access(c, call)) return;
  if (call->who->by != people::Who::By::Session) {
    return call->respond(
        problem({base::Code::Conflict, "which ones are the others: ask by a session"}));
  }
  c->access.book().end_other_sessions(call->who->user, call->who->id);
  keep_people(c, [call](const base::Result<void>& kept) {
    if (kept) return call->respond(Response{http::status::no_content, 11});
    call->respond(
        problem({base::Code::Unavailable,
                 "they are over now, but may be back after a restart: " + kept.error().detail}));
  });
}

/// The old and the new one.
struct Passwords {
  std::string old;
  std::string next;
};

/// @return empty: answered already
std::optional<Passwords> passwords_in(const CallPtr& call) {
  const auto body = json_body(call->request);
  if (!body) {
    call->respond(problem(body.error()));
    return std::nullopt;
  }
  Members members(*body);
  for (const char* name : {"password", "new_password"}) members.require(name);
  Passwords out{members.text("password").value_or(""), members.text("new_password").value_or("")};
  if (auto wrong = people::password_problem(out.next, call->who->user); !wrong.empty()) {
    members.complain("new_password", std::move(wrong));
  }
  if (const auto read = members.finish(); !read) {
    call->respond(problem(read.error()));
    return std::nullopt;
  }
  return out;
}

void take_new_password(const ContextPtr& c, const CallPtr& call, const people::Attempt& attempt,
                       std::string hash) {
  Book& book = c->access.book();
  const people::User* const user = book.user(attempt.user);
  if (user == nullptr || user->password != attempt.hash || !book.still(*call->who, Access::now())) {
    return call->respond(problem({base::Code::Conflict, "the password was changed meanwhile"}));
  }
  const auto* device = book.by_device(c->access.device_secret(call->request), Access::now());
  const std::string here = device != nullptr ? device->id : std::string();
  book.clear_login(attempt);
  if (auto done = book.change_user(attempt.user, {}, std::move(hash), call->who->id, here); !done) {
    return call->respond(problem(done.error()));
  }
  keep_people(c, [call](const base::Result<void>& kept) {
    if (kept) return call->respond(Response{http::status::no_content, 11});
    call->respond(problem({base::Code::Unavailable,
                           "it holds now, but not after a restart: " + kept.error().detail}));
  });
}

void change_password(const ContextPtr& c, const CallPtr& call) {
  if (refuse_without_access(c, call)) return;
  if (call->who->by != people::Who::By::Session) {
    return call->respond(
        problem({base::Code::Conflict, "a password is changed by somebody who has logged in"}));
  }
  const auto typed = passwords_in(call);
  if (!typed) return;
  const auto slot = may_hash(c, call, wait_of(c, call, call->who->user));
  if (!slot) return;
  const auto attempt =
      c->access.book().begin_login(call->who->user, peer_of(call->request), Access::now());
  // Empty: the old one is wrong.
  using Made = std::optional<base::Result<std::string>>;
  c->aside(
      call, kHash,
      [attempt, typed = *typed]() -> Made {
        if (!people::is_password(attempt.hash, typed.old)) return std::nullopt;
        return people::hash_password(typed.next);
      },
      [c, call, attempt, slot](Made made) {
        if (!made) return call->respond(problem(403, "the old password is wrong"));
        if (!*made) return call->respond(problem(made->error()));
        take_new_password(c, call, attempt, std::move(**made));
      });
}

}  // namespace

void add_session_routes(const ContextPtr& c) {
  const auto get = http::verb::get;
  const auto post = http::verb::post;
  const auto del = http::verb::delete_;
  c->router.add({get, "/session", {200}, [c](const CallPtr& call) {
                   call->respond(
                       json_response(http::status::ok, session_json(*c, call->request, call->who)));
                 }});
  c->router.add({post,
                 "/session",
                 {200, 400, 401, 403, 409, 413, 415, 422, 429, 503},
                 [c](const CallPtr& call) { enter(c, call); }});
  c->router.add({post, "/setup", {200, 400, 401, 403, 409, 413, 415, 422, 429, 503}, set_up(c)});
  c->router.add({del, "/session", {204, 403, 404, 409, 429, 503}, [c](const CallPtr& call) {
                   log_out(c, call);
                 }});
  c->router.add({post,
                 "/session/password",
                 {204, 400, 403, 409, 413, 415, 422, 429, 503},
                 [c](const CallPtr& call) { change_password(c, call); }});
  c->router.add({get, "/sessions", {200}, [c](const CallPtr& call) { list_sessions(c, call); }});
  c->router.add({del, "/sessions", {204, 403, 409, 429, 503}, [c](const CallPtr& call) {
                   end_others(c, call);
                 }});
  c->router.add({del, "/sessions/{id}", {204, 403, 404, 429, 503}, [c](const CallPtr& call) {
                   end_one(c, call);
                 }});
}

}  // namespace roverd::api
