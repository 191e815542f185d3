// Log-in, log-out, the first admin, and where somebody is logged in.

#include <atomic>
#include <cmath>
#include <memory>
#include <utility>

#include "api/access_change.hpp"
#include "api/context.hpp"
#include "people/secret.hpp"

namespace roverd::api {

namespace {

using people::Book;
using people::Session;

/// Hashing costs much: so many wait or are at work, the others try again.
constexpr int kHashing = 3;
/// Beside what is small and must not wait for it.
constexpr Effort kHash{Effort::kSmall + 1};

Json session_json(const Context& context, const std::optional<people::Who>& who) {
  const Access& access = context.access;
  Json out = {{"access", access.on()},
              {"setup", access.on() && access.book().needs_setup()},
              {"user", nullptr},
              {"role", nullptr},
              {"id", nullptr}};
  if (who) {
    out["user"] = who->user;
    out["role"] = to_string(who->role);
    out["id"] = who->id;
  }
  return out;
}

Json one_session(const Session& s, const std::string& mine) {
  return {{"id", s.id},
          {"device", s.device},
          {"address", s.address},
          {"created", time_or_null(s.created)},
          {"seen", time_or_null(s.seen)},
          {"current", s.id == mine}};
}

Response too_soon(base::Duration wait) {
  const auto seconds = std::to_string(static_cast<long>(std::ceil(base::seconds(wait))));
  Response out = problem(429, "too many wrong log-ins: try again in " + seconds + " s");
  out.set(http::field::retry_after, seconds);
  return out;
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

/// Lets one hash at a time be counted, wherever its work is dropped.
class Hashing {
 public:
  /// Null: too many.
  std::shared_ptr<void> begin() {
    auto slot = std::shared_ptr<void>(count_.get(), [count = count_](void*) { --*count; });
    return ++*count_ > kHashing ? nullptr : slot;
  }

 private:
  std::shared_ptr<std::atomic<int>> count_ = std::make_shared<std::atomic<int>>(0);
};

void let_in(const ContextPtr& c, const CallPtr& call, const people::Opened<Session>& opened) {
  const auto* user = c->access.book().user(opened.row.user);
  call->named = opened.row.user;
  people::Who who{opened.row.user, user->role, people::Who::By::Session, opened.row.id, {}};
  // A disk that fails keeps nobody from the robot: the session then ends with the program.
  keep_people(c, [c, call, who, secret = opened.secret](const base::Result<void>&) {
    Response out = json_response(http::status::ok, session_json(*c, who));
    out.set(http::field::set_cookie, c->access.cookie(secret));
    call->respond(std::move(out));
  });
}

bool refuse_without_access(const ContextPtr& c, const CallPtr& call) {
  if (c->access.on() && c->access.book().loaded()) return false;
  call->respond(problem(
      c->access.on() ? base::Error{base::Code::Unavailable, "the users have not been read yet"}
                     : base::Error{base::Code::Conflict,
                                   "access control is off: there is nothing to log in to"}));
  return true;
}

/// Refuses whom there is no time for. @return null: answered already
std::shared_ptr<void> may_try(const ContextPtr& c, const CallPtr& call, Hashing& hashing,
                              const std::string& user) {
  const auto wait = c->access.book().login_wait(user, peer_of(call->request), Access::now());
  if (wait > base::Duration::zero()) {
    call->respond(too_soon(wait));
    return nullptr;
  }
  auto slot = hashing.begin();
  if (!slot) call->respond(problem(429, "others are logging in just now; try again"));
  return slot;
}

Handler log_in(const ContextPtr& c, Hashing& hashing) {
  return [c, &hashing](const CallPtr& call) {
    if (refuse_without_access(c, call)) return;
    auto typed = typed_in(call, false);
    if (!typed) return;
    // Not what is no user's name: people type passwords there.
    if (c->access.book().user(typed->user) != nullptr) call->named = typed->user;
    const auto slot = may_try(c, call, hashing, typed->user);
    if (!slot) return;
    const auto attempt =
        c->access.book().begin_login(typed->user, peer_of(call->request), Access::now());
    c->aside(
        call, kHash,
        [attempt, typed = *typed] { return people::is_password(attempt.hash, typed.password); },
        [c, call, attempt, slot, device = typed->device](bool right) {
          const auto opened = c->access.book().end_login(attempt, right, device, Access::now());
          if (!opened) return call->respond(problem(401, "user or password is wrong"));
          let_in(c, call, *opened);
        });
  };
}

Handler set_up(const ContextPtr& c, Hashing& hashing) {
  return [c, &hashing](const CallPtr& call) {
    if (refuse_without_access(c, call)) return;
    Book& book = c->access.book();
    if (!book.needs_setup()) {
      return call->respond(problem({base::Code::Conflict, "the first admin is there already"}));
    }
    auto typed = typed_in(call, true);
    if (!typed) return;
    const auto slot = may_try(c, call, hashing, {});
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

}  // namespace

void add_session_routes(const ContextPtr& c) {
  const auto hashing = std::make_shared<Hashing>();
  const auto held = [hashing](Handler handler) {
    return [hashing, handler = std::move(handler)](CallPtr call) { handler(std::move(call)); };
  };
  const auto get = http::verb::get;
  const auto post = http::verb::post;
  const auto del = http::verb::delete_;
  c->router.add({get, "/session", {200}, [c](const CallPtr& call) {
                   call->respond(json_response(http::status::ok, session_json(*c, call->who)));
                 }});
  c->router.add({post,
                 "/session",
                 {200, 400, 401, 403, 409, 413, 415, 422, 429, 503},
                 held(log_in(c, *hashing))});
  c->router.add({post,
                 "/setup",
                 {200, 400, 401, 403, 409, 413, 415, 422, 429, 503},
                 held(set_up(c, *hashing))});
  c->router.add({del, "/session", {204, 403, 404, 409, 429, 503}, [c](const CallPtr& call) {
                   log_out(c, call);
                 }});
  c->router.add({get, "/sessions", {200}, [c](const CallPtr& call) { list_sessions(c, call); }});
  c->router.add({del, "/sessions/{id}", {204, 403, 404, 429, 503}, [c](const CallPtr& call) {
                   end_one(c, call);
                 }});
}

}  // namespace roverd::api
