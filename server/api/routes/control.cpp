// Control: who holds it, and how it changes hands.

#include <algorithm>
#include <utility>

#include "api/context.hpp"
#include "mission/text.hpp"

namespace roverd::api {

namespace {

using people::Lease;

constexpr std::size_t kLongestReason = 200;

std::optional<people::Driver> caller(const ContextPtr& c, const CallPtr& call) {
  return c->control.driver(call->who, peer_of(call->request));
}

Json state_for(const ContextPtr& c, const std::optional<people::Driver>& who) {
  Json out = c->control.state();
  out["mine"] = c->control.may(who);
  out["here"] = c->control.here();
  out["you"] = who ? Json(who->id) : Json(nullptr);
  return out;
}

void answer(const ContextPtr& c, const CallPtr& call, http::status status) {
  call->respond(json_response(status, state_for(c, caller(c, call))));
}

/// With the holder.
void refuse(const ContextPtr& c, const CallPtr& call, const base::Error& error) {
  Json body = problem_json(error);
  body["holder"] = c->control.holder();
  call->respond(problem_response(status_of(error.code), body));
}

std::string reason_in(Members& members, bool force) {
  const auto reason = members.text("reason");
  if (force && !reason) members.complain("reason", "is needed to take control by force");
  if (!force && reason) members.complain("reason", "belongs to force");
  if (!reason) return {};
  const auto length = mission::utf8_length(*reason);
  const bool fits = length && *length >= 1 && *length <= kLongestReason &&
                    reason->find_first_not_of(' ') != std::string::npos &&
                    std::none_of(reason->begin(), reason->end(), [](char sign) {
                      return static_cast<unsigned char>(sign) < 0x20 || sign == 0x7f;
                    });
  if (force && !fits) members.complain("reason", "must be 1 to 200 characters on one line");
  return *reason;
}

void take(const ContextPtr& c, const CallPtr& call) {
  const auto body = json_body(call->request, true);
  if (!body) return call->respond(problem(body.error()));
  Members members(*body);
  const bool ask = members.flag("ask").value_or(false);
  const bool force = members.flag("force").value_or(false);
  const std::string reason = reason_in(members, force);
  if (ask && force) members.complain("ask", "and force exclude each other");
  if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
  const auto who = caller(c, call);
  if (!c->control.on() || !who) return answer(c, call, http::status::ok);
  const auto how = force ? Lease::How::Force : ask ? Lease::How::Ask : Lease::How::IfFree;
  const auto done = c->control.take(*who, how, reason);
  if (!done) return refuse(c, call, done.error());
  answer(c, call, *done == Lease::Outcome::Holds ? http::status::ok : http::status::accepted);
}

void release(const ContextPtr& c, const CallPtr& call) {
  const auto body = json_body(call->request, true);
  if (!body) return call->respond(problem(body.error()));
  Members members(*body);
  if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
  const auto who = caller(c, call);
  if (!c->control.on() || !who) return answer(c, call, http::status::ok);
  if (const auto done = c->control.release(*who); !done) return refuse(c, call, done.error());
  answer(c, call, http::status::ok);
}

void hand_over(const ContextPtr& c, const CallPtr& call) {
  const auto body = json_body(call->request);
  if (!body) return call->respond(problem(body.error()));
  Members members(*body);
  for (const char* name : {"accept", "to"}) members.require(name);
  const bool accept = members.flag("accept").value_or(false);
  const auto to = members.whole("to", 1, std::int64_t{1} << 53);
  if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
  const auto who = caller(c, call);
  if (c->control.on() && !c->control.may(who)) {
    return call->respond(problem_response(403, c->control.problem()));
  }
  const auto done = c->control.answer(static_cast<std::uint64_t>(*to), accept);
  if (!done) return refuse(c, call, done.error());
  answer(c, call, http::status::ok);
}

}  // namespace

void add_control_routes(const ContextPtr& c) {
  const auto post = http::verb::post;
  c->router.add({http::verb::get, "/control", {200}, [c](const CallPtr& call) {
                   answer(c, call, http::status::ok);
                 }});
  c->router.add({post,
                 "/control/take",
                 {200, 202, 400, 403, 409, 413, 415, 422, 429, 503},
                 [c](const CallPtr& call) { take(c, call); }});
  c->router.add({post,
                 "/control/release",
                 {200, 400, 403, 409, 413, 415, 422, 429, 503},
                 [c](const CallPtr& call) { release(c, call); }});
  c->router.add({post,
                 "/control/handover",
                 {200, 400, 403, 404, 413, 415, 422, 429, 503},
                 [c](const CallPtr& call) { hand_over(c, call); }});
}

}  // namespace roverd::api
