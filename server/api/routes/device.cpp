// Paired devices: a PIN instead of the password for whoever wears gloves, and the invitation of
// another phone.

#include <algorithm>
#include <optional>
#include <utility>

#include "api/access_change.hpp"
#include "api/context.hpp"
#include "api/log_in.hpp"
#include "mission/text.hpp"
#include "people/secret.hpp"

namespace roverd::api {

namespace {

using base::Result;
using people::Book;
using people::Device;
using people::Role;

Json device_json(const Device& d, const Device* here) {
  return {{"id", d.id},
          {"name", d.name},
          {"user", d.user},
          {"role", to_string(d.role)},
          {"locked", Book::is_locked(d)},
          {"created", time_or_null(d.created)},
          {"used", d.used ? time_or_null(*d.used) : Json(nullptr)},
          {"current", here != nullptr && here->id == d.id}};
}

/// What a person says of a device.
struct Draft {
  std::string code;
  std::string name;
  std::string pin;
  std::optional<Role> role;
};

std::optional<Role> role_of_device(Members& members) {
  const auto word = members.text("role");
  if (!word) return std::nullopt;
  const auto role = people::role_of(*word);
  if (!role) members.complain("role", "must be viewer, operator or admin");
  return role;
}

/// @param invited by a code, with which the role comes. @return empty: answered already
std::optional<Draft> draft_in(const CallPtr& call, bool invited) {
  const auto body = json_body(call->request);
  if (!body) {
    call->respond(problem(body.error()));
    return std::nullopt;
  }
  Members members(*body);
  for (const char* name : {"name", "pin"}) members.require(name);
  if (invited) members.require("code");
  Draft out;
  if (invited) out.code = members.text("code").value_or("");
  out.name = members.text("name").value_or("");
  out.pin = members.text("pin").value_or("");
  if (!invited) out.role = role_of_device(members);
  const auto judge = [&members](std::string_view member, std::string wrong) {
    if (!wrong.empty()) members.complain(member, std::move(wrong));
  };
  judge("name", mission::name_problem(out.name));
  judge("pin", people::pin_problem(out.pin));
  if (const auto read = members.finish(); !read) {
    call->respond(problem(read.error()));
    return std::nullopt;
  }
  return out;
}

bool is_person(const CallPtr& call) {
  return call->who && call->who->by == people::Who::By::Session;
}

void hash_pin(const ContextPtr& c, const CallPtr& call, std::string pin, std::shared_ptr<void> slot,
              std::function<void(std::string)> then) {
  c->aside(
      call, kHash, [pin = std::move(pin)] { return people::hash_password(pin); },
      [call, slot = std::move(slot), then = std::move(then)](Result<std::string> hash) {
        if (!hash) return call->respond(problem(hash.error()));
        then(std::move(*hash));
      });
}

/// This browser, by whoever is logged in on it.
void pair_this(const ContextPtr& c, const CallPtr& call) {
  if (refuse_without_access(c, call)) return;
  if (!is_person(call)) {
    return call->respond(
        problem({base::Code::Conflict, "a device is paired by somebody who has logged in on it"}));
  }
  const auto draft = draft_in(call, false);
  if (!draft) return;
  auto slot = may_hash(c, call, base::Duration::zero());
  if (!slot) return;
  hash_pin(c, call, draft->pin, std::move(slot), [c, call, draft = *draft](std::string pin) {
    Book& book = c->access.book();
    const auto who = book.still(*call->who, Access::now());
    if (!who) return call->respond(problem(401, "the session is over"));
    Device wanted;
    wanted.user = who->user;
    wanted.name = draft.name;
    wanted.role = std::min(who->role, draft.role.value_or(who->role));
    wanted.pin = std::move(pin);
    auto made = book.pair(std::move(wanted), c->access.device_secret(call->request), who->id,
                          Access::now());
    if (!made) return call->respond(problem(made.error()));
    keep_people(c, [c, call, made = *made](const Result<void>& kept) {
      if (!kept) {
        (void)c->access.book().end_device(made.row.user, made.row.id);
        return call->respond(problem(kept.error()));
      }
      Response out = json_response(http::status::created, device_json(made.row, &made.row));
      out.set(http::field::set_cookie, c->access.device_cookie(made.secret));
      call->respond(std::move(out));
    });
  });
}

void list_devices(const ContextPtr& c, const CallPtr& call) {
  Json items = Json::array();
  if (call->who) {
    const Book& book = c->access.book();
    const Device* const here =
        book.by_device(c->access.device_secret(call->request), Access::now());
    for (const Device& d : book.devices_of(call->who->user)) items.push_back(device_json(d, here));
  }
  call->respond(json_response(http::status::ok, {{"items", items}, {"next_cursor", nullptr}}));
}

void end_device(const ContextPtr& c, const CallPtr& call) {
  const auto ended = call->who ? c->access.book().end_device(call->who->user, call->params["id"])
                               : base::fail(base::Code::NotFound, "there is no such device");
  if (!ended) return call->respond(problem(ended.error()));
  keep_people(c, [call](const Result<void>& kept) {
    if (kept) return call->respond(Response{http::status::no_content, 11});
    call->respond(
        problem({base::Code::Unavailable,
                 "it is over now, but may be back after a restart: " + kept.error().detail}));
  });
}

// ---- another phone

/// For oneself, or by an admin for somebody; never with more than the inviter may.
void invite(const ContextPtr& c, const CallPtr& call) {
  if (refuse_without_access(c, call)) return;
  if (!is_person(call)) {
    return call->respond(
        problem({base::Code::Conflict, "others are invited by somebody who has logged in"}));
  }
  const auto body = json_body(call->request, true);
  if (!body) return call->respond(problem(body.error()));
  Members members(*body);
  const people::Who& who = *call->who;
  const std::string user = members.text("user").value_or(who.user);
  const Role role = std::min(who.role, role_of_device(members).value_or(who.role));
  if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
  Book& book = c->access.book();
  if (user != who.user && who.role != Role::Admin) {
    return call->respond(problem(403, "only an admin invites somebody else's phone"));
  }
  if (auto may = book.may_pair(user); !may) return call->respond(problem(may.error()));
  const std::string code = book.invite({who.user, user, role}, Access::now());
  // Behind the #, so that no server and no log gets it.
  const Poster poster = c->deps.poster ? c->deps.poster("/#invite=" + code) : Poster{};
  const auto nothing = [](const std::string& text) { return text.empty() ? Json() : Json(text); };
  call->respond(
      json_response(http::status::created, {{"code", code},
                                            {"user", user},
                                            {"role", to_string(role)},
                                            {"expires_in_s", base::seconds(Book::kInvited)},
                                            {"address", nothing(poster.address)},
                                            {"svg", nothing(poster.svg)}}));
}

/// The code is used up by whoever types it rightly, also if the disk then fails.
void accept_invitation(const ContextPtr& c, const CallPtr& call) {
  if (refuse_without_access(c, call)) return;
  const auto draft = draft_in(call, true);
  if (!draft) return;
  Book& book = c->access.book();
  const std::string peer = peer_of(call->request);
  auto slot = may_hash(c, call, book.login_wait({}, peer, Access::now()));
  if (!slot) return;
  const auto invited = book.take_invitation(draft->code, peer, Access::now());
  if (!invited) {
    return call->respond(problem(401, "the code is wrong, was used already, or is over"));
  }
  call->named = invited->user;
  hash_pin(c, call, draft->pin, std::move(slot),
           [c, call, invited = *invited, name = draft->name, peer](std::string pin) {
             Book& house = c->access.book();
             // Hashing takes its time, and the inviter may be nobody any more.
             if (!house.end_invitation(invited, Access::now())) {
               return call->respond(problem(401, "the invitation has ended meanwhile"));
             }
             Device wanted;
             wanted.user = invited.user;
             wanted.name = name;
             wanted.role = invited.role;
             wanted.pin = std::move(pin);
             const auto now = Access::now();
             const auto made =
                 house.pair(std::move(wanted), c->access.device_secret(call->request), {}, now);
             if (!made) return call->respond(problem(made.error()));
             call->named_by = "device " + made->row.id;
             const auto opened = house.end_pin(house.begin_pin(made->row, peer, now), true, now);
             if (opened) let_in(c, call, *opened, made->secret);
           });
}

}  // namespace

void add_device_routes(const ContextPtr& c) {
  const auto post = http::verb::post;
  c->router.add(
      {http::verb::get, "/devices", {200}, [c](const CallPtr& call) { list_devices(c, call); }});
  c->router.add({post,
                 "/devices",
                 {201, 400, 401, 403, 404, 409, 413, 415, 422, 429, 503},
                 [c](const CallPtr& call) { pair_this(c, call); }});
  c->router.add(
      {http::verb::delete_, "/devices/{id}", {204, 403, 404, 429, 503}, [c](const CallPtr& call) {
         end_device(c, call);
       }});
  c->router.add({post,
                 "/invitations",
                 {201, 400, 403, 404, 409, 413, 415, 422, 429, 503},
                 [c](const CallPtr& call) { invite(c, call); }});
  c->router.add({post,
                 "/invitations/accept",
                 {200, 400, 401, 403, 404, 409, 413, 415, 422, 429, 503},
                 [c](const CallPtr& call) { accept_invitation(c, call); }});
}

}  // namespace roverd::api
