#include <utility>
#include <variant>
#include <vector>

#include "api/context.hpp"

namespace roverd::api {

void Commands::run(robot::Command command, const robot::Validity& validity, base::Time now,
                   Done done) {
  const base::Time not_after = validity.not_after;
  if (now > not_after) {
    return done(tl::unexpected<base::Error>(late_error(not_after, now)));
  }
  const bool estop = std::holds_alternative<robot::Estop>(command);  // always has room
  const std::size_t most = kWaiting + (robot::is_stop(command) ? robot::kStopsWaiting : 0);
  if (waiting_.size() >= most && !estop) {
    return done(base::fail(base::Code::Unavailable, "too many commands wait for the robot"));
  }
  const std::uint64_t id = next_++;
  const std::weak_ptr<Commands*> self = self_;
  const bool queued = robot_.request(std::move(command), validity, [self, id](auto result) {
    if (const auto alive = self.lock()) (*alive)->answer(id, std::move(result));
  });
  if (!queued) {
    return done(base::fail(base::Code::Unavailable, "too many commands wait for the robot"));
  }
  const bool endless = not_after == base::Time::max();
  const base::Time give_up = (endless ? now : not_after) + kPatience;
  waiting_.emplace(id, Waiting{give_up, std::move(done)});
}

Commands::Done Commands::expect(base::Time give_up, Done done) {
  const std::uint64_t id = next_++;
  waiting_.emplace(id, Waiting{give_up, std::move(done)});
  return [self = std::weak_ptr<Commands*>(self_), id](base::Result<void> result) {
    if (const auto alive = self.lock()) (*alive)->answer(id, std::move(result));
  };
}

void Commands::answer(std::uint64_t id, base::Result<void> result) {
  const auto at = waiting_.find(id);
  if (at == waiting_.end()) return;
  const Done done = std::move(at->second.done);
  waiting_.erase(at);
  done(std::move(result));
}

void Commands::sweep(base::Time now) {
  std::vector<std::uint64_t> overdue;
  for (const auto& [id, waiting] : waiting_) {
    if (now > waiting.give_up) overdue.push_back(id);
  }
  for (const std::uint64_t id : overdue) {
    answer(id, base::fail(base::Code::Unavailable,
                          "nobody answers: the control loop or the driver hangs"));
  }
}

void run_command(const ContextPtr& context, const CallPtr& call, robot::Command command,
                 const robot::Validity& validity,
                 std::function<Json(const base::Snapshot&)> state) {
  // It may have waited for the store, and control was lost or taken meanwhile.
  if (auto refusal = context->without_control(*call)) return call->respond(std::move(*refusal));
  context->commands.run(std::move(command), validity, base::steady_now(),
                        [context, call, state = std::move(state)](base::Result<void> result) {
                          if (!result) return call->respond(problem(result.error()));
                          if (const auto snapshot = context->snapshot_or_refuse(call)) {
                            call->respond(json_response(http::status::ok, state(*snapshot)));
                          }
                        });
}

}  // namespace roverd::api
