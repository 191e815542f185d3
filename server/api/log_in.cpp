#include "api/log_in.hpp"

#include <cmath>
#include <utility>

#include "api/access_change.hpp"

namespace roverd::api {

namespace {

/// Hashing costs much: so many wait or are at work, the others try again.
constexpr int kHashing = 3;

Json paired_json(const Context& context, const Request& request) {
  const auto* const device =
      context.access.on()
          ? context.access.book().by_device(context.access.device_secret(request), Access::now())
          : nullptr;
  if (device == nullptr) return nullptr;
  return {{"id", device->id},
          {"user", device->user},
          {"name", device->name},
          {"locked", people::Book::is_locked(*device)}};
}

Response too_soon(base::Duration wait) {
  const auto seconds = std::to_string(static_cast<long>(std::ceil(base::seconds(wait))));
  Response out = problem(429, "too many wrong log-ins: try again in " + seconds + " s");
  out.set(http::field::retry_after, seconds);
  return out;
}

}  // namespace

Json session_json(const Context& context, const Request& request,
                  const std::optional<people::Who>& who) {
  const Access& access = context.access;
  Json out = {{"access", access.on()}, {"setup", access.on() && access.book().needs_setup()},
              {"user", nullptr},       {"role", nullptr},
              {"id", nullptr},         {"paired", paired_json(context, request)}};
  if (who) {
    out["user"] = who->user;
    out["role"] = to_string(who->role);
    out["id"] = who->id;
  }
  return out;
}

bool refuse_without_access(const ContextPtr& c, const CallPtr& call) {
  if (c->access.on() && c->access.book().loaded()) return false;
  call->respond(problem(
      c->access.on() ? base::Error{base::Code::Unavailable, "the users have not been read yet"}
                     : base::Error{base::Code::Conflict,
                                   "access control is off: there is nothing to log in to"}));
  return true;
}

std::shared_ptr<void> may_hash(const ContextPtr& c, const CallPtr& call, base::Duration wait) {
  if (wait > base::Duration::zero()) {
    call->respond(too_soon(wait));
    return nullptr;
  }
  // Counted down wherever its work is dropped.
  auto slot = std::shared_ptr<void>(c->hashing.get(), [count = c->hashing](void*) { --*count; });
  if (++*c->hashing <= kHashing) return slot;
  call->respond(problem(429, "others are logging in just now; try again"));
  return nullptr;
}

void let_in(const ContextPtr& c, const CallPtr& call, const people::Opened<people::Session>& opened,
            const std::string& device) {
  call->named = opened.row.user;
  const auto who = c->access.book().by_session(opened.secret, Access::now());
  // A disk that fails keeps nobody from the robot: the session then ends with the program.
  keep_people(c, [c, call, who, device, secret = opened.secret](const base::Result<void>&) {
    Json state = session_json(*c, call->request, who);
    Response out = json_response(http::status::ok, state);
    out.insert(http::field::set_cookie, c->access.cookie(secret));
    if (!device.empty()) out.insert(http::field::set_cookie, c->access.device_cookie(device));
    call->respond(std::move(out));
  });
}

}  // namespace roverd::api
