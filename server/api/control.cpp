#include "api/control.hpp"

#include <algorithm>
#include <utility>

#include "api/access_change.hpp"
#include "api/problem.hpp"
#include "mission/json/json.hpp"

namespace roverd::api {

namespace {

using people::Driver;
using people::Lease;
using Kind = Lease::Notice::Kind;

std::string_view kind_of(const Driver& d) noexcept {
  return d.by == people::Who::By::Session ? "browser" : "script";
}

std::string in_words(const std::optional<Driver>& d) {
  if (!d) return "nobody";
  return d->user + (d->name.empty() ? "" : " (" + d->name + ")");
}

Json driver_json(const Driver& d) {
  return {{"id", d.id}, {"user", d.user}, {"name", d.name}, {"kind", kind_of(d)}};
}

Json driver_or_null(const std::optional<Driver>& d) {
  return d ? driver_json(*d) : Json(nullptr);
}

/// The wall clock may have been set meanwhile: what was is counted from now.
Json begun_at(base::Time mono, const people::Now& now) {
  return time_or_null(now.wall < base::kYoungest ? now.wall : now.wall - (now.mono - mono));
}

}  // namespace

std::string_view word_of(Kind kind) noexcept {
  switch (kind) {
    case Kind::Taken:
      return "taken";
    case Kind::Released:
      return "released";
    case Kind::Lost:
      return "lost";
    case Kind::Ended:
      return "ended";
    case Kind::HandedOver:
      return "handed_over";
    case Kind::Forced:
      return "forced";
    case Kind::Asked:
      return "asked";
    case Kind::Refused:
      return "refused";
    case Kind::Expired:
      return "expired";
    case Kind::Withdrawn:
      return "withdrawn";
  }
  return "";
}

std::string sentence(const Lease::Notice& n) {
  const std::string from = in_words(n.from);
  const std::string to = in_words(n.to);
  switch (n.kind) {
    case Kind::Taken:
      return to + " has control";
    case Kind::Released:
      return from + " gave up control";
    case Kind::Lost:
      return from + " was not heard any more and lost control";
    case Kind::Ended:
      return from + " lost control: the log-in, the token or the role ended";
    case Kind::HandedOver:
      return from + " handed control over to " + to;
    case Kind::Forced:
      return to + " took control from " + from + " by force: " + n.reason;
    case Kind::Asked:
      return to + " asks " + from + " for control";
    case Kind::Refused:
      return from + " keeps control; " + to + " had asked";
    case Kind::Expired:
      return from + " did not answer; " + to + " had asked for control";
    case Kind::Withdrawn:
      return to + " does not ask for control any more";
  }
  return "";
}

std::optional<base::Event> event_of(const Lease::Notice& notice) {
  const auto event = [&](std::string kind, base::Severity level) {
    return base::Event{base::wall_now(), level, std::move(kind), sentence(notice)};
  };
  switch (notice.kind) {
    case Kind::Taken:
      return event("control_taken", base::Severity::Info);
    case Kind::Released:
      return event("control_released", base::Severity::Info);
    case Kind::HandedOver:
      return event("control_handed_over", base::Severity::Info);
    case Kind::Forced:
      return event("control_forced", base::Severity::Warning);
    case Kind::Lost:
    case Kind::Ended:
      return event("control_lost", base::Severity::Warning);
    case Kind::Asked:
    case Kind::Refused:
    case Kind::Expired:
    case Kind::Withdrawn:
      return std::nullopt;
  }
  return std::nullopt;
}

bool acts(const Context& context, const Route& route, const Call& call) {
  switch (route.control) {
    case NeedsControl::No:
      return false;
    case NeedsControl::Yes:
      return true;
    case NeedsControl::UnlessHold: {
      const auto body = mission::parse_json(call.request.body());
      return body && body->is_object() && body->value("mode", Json()) != "HOLD";
    }
    case NeedsControl::IfActive: {
      const auto id = call.params.find("id");
      if (route.pattern.starts_with("/maps/")) {
        const maps::Shelf* shelf = context.deps.maps.shelf;
        const auto in_use = shelf != nullptr ? shelf->in_use() : std::nullopt;
        return in_use && id != call.params.end() && std::to_string(*in_use) == id->second;
      }
      return context.fence && id != call.params.end() && context.fence->id == id->second;
    }
  }
  return true;
}

std::optional<Driver> Control::driver(const std::optional<people::Who>& who,
                                      const std::string& address) const {
  if (!who) return std::nullopt;
  const bool script = who->by == people::Who::By::Token;
  return Driver{who->by, who->id, script ? address : std::string(), who->user};
}

void Control::heard(const std::optional<Driver>& who) {
  if (!on() || !who) return;
  lease_.heard(*who, base::steady_now());
  tell();
}

void Control::step() {
  if (!on()) return;
  const auto facts = [this](const Driver& d) {
    const auto still =
        access_.book().still({d.user, people::Role::Viewer, d.by, d.id, {}}, Access::now());
    const bool valid = still && suffices(still->role, Need::Operator);
    return Lease::Fact{valid, linked && linked(d)};
  };
  lease_.step(facts, base::steady_now());
  tell();
}

std::string Control::name_of(const Driver& who) const {
  const auto find = [&who](const auto& rows, auto member) {
    const auto found = std::find_if(rows.begin(), rows.end(),
                                    [&who](const auto& row) { return row.id == who.id; });
    return found == rows.end() ? std::string() : (*found).*member;
  };
  return who.by == people::Who::By::Session
             ? find(access_.book().sessions_of(who.user), &people::Session::device)
             : find(access_.book().tokens_of(who.user), &people::Token::name);
}

base::Result<Lease::Outcome> Control::take(Driver who, Lease::How how, const std::string& reason) {
  if (const std::string name = name_of(who); !name.empty()) who.name = name;
  step();
  auto done = lease_.take(who, how, reason, base::steady_now());
  step();
  return done;
}

base::Result<void> Control::release(const Driver& who) {
  auto done = lease_.release(who, base::steady_now());
  step();
  return done;
}

base::Result<void> Control::answer(std::uint64_t request, bool accept) {
  auto done = lease_.answer(request, accept, base::steady_now());
  step();
  return done;
}

void Control::tell() {
  for (const Notice& notice : lease_.take_notices()) {
    if (on_notice) on_notice(notice);
  }
}

Json Control::holder() const {
  return driver_or_null(lease_.holder());
}

Json Control::state() const {
  const auto now = Access::now();
  Json out = {{"on", on()},
              {"holder", holder()},
              {"requests", Json::array()},
              {"grace_s", base::seconds(lease_.params().grace)},
              {"ask_s", base::seconds(lease_.params().ask)}};
  if (lease_.holder()) {
    const auto left = lease_.grace_left(now.mono);
    out["holder"]["since"] = begun_at(lease_.since(), now);
    out["holder"]["grace_left_s"] = left ? Json(base::seconds(*left)) : Json(nullptr);
  }
  for (const auto& r : lease_.requests()) {
    Json one = driver_json(r.who);
    one["request"] = r.id;
    one["expires_in_s"] = std::max(0.0, base::seconds(r.until - now.mono));
    out["requests"].push_back(std::move(one));
  }
  return out;
}

Json Control::here() const {
  Json out = Json::array();
  if (!on() || !present) return out;
  for (Present& each : present()) {
    each.who.name = name_of(each.who);
    Json one = driver_json(each.who);
    one["role"] = to_string(each.role);
    one["streams"] = each.streams;
    out.push_back(std::move(one));
  }
  return out;
}

Json Control::state_with(const Notice& notice) const {
  Json out = state();
  out["change"] = {{"what", word_of(notice.kind)},
                   {"detail", sentence(notice)},
                   {"from", driver_or_null(notice.from)},
                   {"to", driver_or_null(notice.to)},
                   {"reason", notice.reason.empty() ? Json(nullptr) : Json(notice.reason)}};
  return out;
}

Json Control::problem() const {
  const std::string who = in_words(lease_.holder());
  Json out = problem_json(
      403, lease_.holder() ? "this needs control, which " + who + " has; anyone may stop"
                           : std::string("this needs control, which nobody has: take it first"));
  out["type"] = "/docs#problem-control";
  out["title"] = "Control is not held";
  out["holder"] = holder();
  return out;
}

}  // namespace roverd::api
