#include "api/idempotency.hpp"

#include <functional>
#include <utility>

#include "api/problem.hpp"

namespace roverd::api {

namespace {

constexpr std::size_t kLongestKey = 200;

}  // namespace

std::size_t Idempotency::hash_of(const std::string& body) noexcept {
  return std::hash<std::string>{}(body);
}

bool Idempotency::admit(const CallPtr& call, std::size_t body_hash) {
  const std::string_view given = header(call->request, "Idempotency-Key");
  if (given.empty()) return true;
  if (given.size() > kLongestKey) {
    call->respond(problem({base::Code::Invalid, "Idempotency-Key is longer than 200 characters"}));
    return false;
  }
  const auto method = call->request.method_string();
  const std::string key = std::string(method.data(), method.size()) + ' ' +
                          std::string(target(call->request)) + ' ' + std::string(given) + ' ' +
                          (call->who ? call->who->id : std::string());
  const auto [at, is_new] = entries_.try_emplace(key);
  Entry& entry = at->second;
  if (is_new) {
    entry.body_hash = body_hash;
    call->respond = [this, key, respond = std::move(call->respond)](Response response) {
      const auto answer = std::make_shared<const Response>(std::move(response));
      finish(key, answer);
      give(respond, answer);
    };
    return true;
  }
  if (entry.body_hash != body_hash) {
    call->respond(
        problem({base::Code::Invalid, "this Idempotency-Key was used before with another body"}));
  } else if (entry.answer) {
    give(call->respond, entry.answer);
  } else {
    // It holds its call, as whoever answers does: what answers looks at the request again.
    entry.waiting.push_back([call, respond = std::move(call->respond)](Response response) {
      respond(std::move(response));
    });
  }
  return false;
}

void Idempotency::give(const Respond& respond, const Answer& answer) const {
  if (!aside || answer->body().size() <= kLarge) return respond(*answer);
  auto copy = std::make_shared<Response>();
  aside([copy, answer] { *copy = *answer; }, [copy, respond] { respond(std::move(*copy)); });
}

void Idempotency::finish(const std::string& key, const Answer& answer) {
  const auto at = entries_.find(key);
  if (at == entries_.end()) return;
  const std::vector<Respond> waiting = std::move(at->second.waiting);
  if (answer->result_int() == 429 || answer->result_int() == 503) {
    entries_.erase(at);
  } else {
    at->second.answer = answer;
    at->second.waiting.clear();
    bytes_ += answer->body().size();
    finished_.push_back(key);
    trim();
  }
  for (const Respond& respond : waiting) give(respond, answer);
}

void Idempotency::trim() {
  while (finished_.size() > kKeys || (bytes_ > kBytes && finished_.size() > 1)) {
    const auto at = entries_.find(finished_.front());
    bytes_ -= at->second.answer->body().size();
    entries_.erase(at);
    finished_.pop_front();
  }
}

}  // namespace roverd::api
