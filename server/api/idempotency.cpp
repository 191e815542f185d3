#include "api/idempotency.hpp"

#include <functional>
#include <utility>

#include "api/problem.hpp"

namespace roverd::api {

namespace {

constexpr std::size_t kLongestKey = 200;

}  // namespace

bool Idempotency::admit(Call& call) {
  const std::string_view given = header(call.request, "Idempotency-Key");
  if (given.empty()) return true;
  if (given.size() > kLongestKey) {
    call.respond(problem({base::Code::Invalid, "Idempotency-Key is longer than 200 characters"}));
    return false;
  }
  const auto method = call.request.method_string();
  const std::string key = std::string(method.data(), method.size()) + ' ' +
                          std::string(target(call.request)) + ' ' + std::string(given);
  const std::size_t hash = std::hash<std::string>{}(call.request.body());
  const auto [at, is_new] = entries_.try_emplace(key);
  Entry& entry = at->second;
  if (is_new) {
    entry.body_hash = hash;
    call.respond = [this, key, respond = std::move(call.respond)](Response response) {
      finish(key, response);
      respond(std::move(response));
    };
    return true;
  }
  if (entry.body_hash != hash) {
    call.respond(
        problem({base::Code::Invalid, "this Idempotency-Key was used before with another body"}));
  } else if (entry.done) {
    call.respond(entry.answer);
  } else {
    entry.waiting.push_back(std::move(call.respond));
  }
  return false;
}

void Idempotency::finish(const std::string& key, const Response& response) {
  const auto at = entries_.find(key);
  if (at == entries_.end()) return;
  const std::vector<Respond> waiting = std::move(at->second.waiting);
  if (response.result_int() == 429 || response.result_int() == 503) {
    entries_.erase(at);
  } else {
    at->second.done = true;
    at->second.answer = response;
    at->second.waiting.clear();
    bytes_ += response.body().size();
    finished_.push_back(key);
    trim();
  }
  for (const Respond& respond : waiting) respond(response);
}

void Idempotency::trim() {
  while (finished_.size() > kKeys || (bytes_ > kBytes && finished_.size() > 1)) {
    const auto at = entries_.find(finished_.front());
    bytes_ -= at->second.answer.body().size();
    entries_.erase(at);
    finished_.pop_front();
  }
}

}  // namespace roverd::api
