#include "api/audit.hpp"

#include <utility>

#include "api/access.hpp"
#include "api/control.hpp"
#include "mission/json/json.hpp"

namespace roverd::api {

namespace {

using people::Deed;
using people::Now;
using people::Who;

/// A refusal is small; anything larger is not one of ours.
constexpr std::size_t kLongestProblem = 8192;
/// Anyone may, known or not, as often as they like.
constexpr std::string_view kStop = "POST /vehicle/estop";

std::string credential_of(const std::optional<Who>& who) {
  if (!who) return {};
  return (who->by == Who::By::Session ? "session " : "token ") + who->id;
}

std::string method_of(http::verb method) {
  const auto word = http::to_string(method);
  return {word.data(), word.size()};
}

std::string_view asked_for(const Request& request) {
  const std::string_view whole = target(request);
  return whole.substr(0, whole.find('?'));
}

bool only_reads(http::verb method) {
  return method == http::verb::get || method == http::verb::head || method == http::verb::options;
}

/// What the answer gives as the reason.
std::string detail_of(const Response& response) {
  if (response.body().size() > kLongestProblem) return {};
  const auto body = mission::parse_json(response.body());
  if (!body || !body->is_object()) return {};
  const auto at = body->find("detail");
  return at != body->end() && at->is_string() ? at->get<std::string>() : std::string();
}

bool is_refusal(int status) {
  return status == 401 || status == 403 || status == 421 || status == 429;
}

std::string credential_of(const people::Driver& driver) {
  return (driver.by == Who::By::Session ? "session " : "token ") + driver.id;
}

}  // namespace

void Audit::answered(const Call& call, const Response& response, Now now) {
  const http::verb method = call.request.method();
  const int status = static_cast<int>(response.result_int());
  if (only_reads(method) && !is_refusal(status)) return;
  Deed deed;
  deed.time = now.wall;
  deed.user = call.who ? call.who->user : call.named;
  deed.credential = call.who ? credential_of(call.who) : call.named_by;
  deed.address = peer_of(call.request);
  // What is no call of ours has no name that a stranger could not choose.
  deed.call = method_of(method) + " " + (call.operation.empty() ? "(unknown)" : call.operation);
  deed.target = asked_for(call.request);
  deed.status = status;
  if (status >= 400) deed.detail = detail_of(response);
  count(std::move(deed), now.mono);
}

void Audit::upgraded(const Request& request, const std::optional<Who>& who, int status, Now now) {
  Deed deed;
  deed.time = now.wall;
  if (who) deed.user = who->user;
  deed.credential = credential_of(who);
  deed.address = peer_of(request);
  deed.call = "GET /stream";
  deed.target = asked_for(request);
  deed.status = status;
  count(std::move(deed), now.mono);
}

void Audit::stopped(const std::optional<Who>& who, const std::string& address, std::string_view how,
                    Now now) {
  Deed deed;
  deed.time = now.wall;
  if (who) deed.user = who->user;
  deed.credential = credential_of(who);
  deed.address = address;
  deed.call = "STREAM " + std::string(how);
  deed.status = 202;  // heard; the robot's events tell what came of it
  // A page says its stop again until it has been heard.
  count(std::move(deed), now.mono);
}

void Audit::control(const people::Lease::Notice& notice, Now now) {
  Deed deed;
  deed.time = now.wall;
  const auto& actor = notice.to ? notice.to : notice.from;
  if (actor) {
    deed.user = actor->user;
    deed.credential = credential_of(*actor);
    deed.address = actor->address;
  }
  deed.call = "CONTROL " + std::string(word_of(notice.kind));
  deed.status = 200;
  deed.detail = sentence(notice);
  keep_(std::move(deed));
}

/// The first of a kind at once, what follows together.
void Audit::count(Deed deed, base::Time now) {
  std::string kind = deed.user + '\n' + deed.credential + '\n' + deed.address + '\n' + deed.call +
                     '\n' + std::to_string(deed.status);
  // What was done is told for each thing that it was done to, as far as there is room.
  if (deed.status < 400) kind += '\n' + deed.target;
  if (!counted_.contains(kind) && counted_.size() >= kKinds) {
    // What was done keeps its name; only what was refused may come in any number of kinds.
    if (deed.status < 400) return keep_(std::move(deed));
    kind = "others";
    Deed others;
    others.time = deed.time;
    others.call = "OTHERS";
    others.status = deed.status;
    others.detail = "calls of many kinds or addresses at once";
    deed = std::move(others);
  }
  const auto [at, is_new] = counted_.try_emplace(std::move(kind), Counted{deed, now});
  if (is_new) {
    at->second.deed.times = 0;
    return keep_(std::move(deed));
  }
  ++at->second.deed.times;
  at->second.deed.time = deed.time;
}

void Audit::write(Counted& counted) {
  if (counted.deed.times > 0) keep_(std::move(counted.deed));
}

void Audit::sweep(base::Time now) {
  for (auto at = counted_.begin(); at != counted_.end();) {
    if (now - at->second.since < kTogether) {
      ++at;
      continue;
    }
    write(at->second);
    at = counted_.erase(at);
  }
}

void Audit::flush() {
  for (auto& [kind, counted] : counted_) write(counted);
  counted_.clear();
}

}  // namespace roverd::api
