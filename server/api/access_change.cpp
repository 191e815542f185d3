#include "api/access_change.hpp"

#include <utility>

#include "people/secret.hpp"

namespace roverd::api {

void keep_people(const ContextPtr& context, std::function<void(const base::Result<void>&)> then) {
  context->deps.store.change_people(
      context->access.book().take_change(),
      [then = std::move(then)](const base::Result<void>& done) { then(done); });
  if (context->on_access_change) context->on_access_change();
}

void end_sessions(const ContextPtr& context, const CallPtr& call, std::vector<std::string> ids,
                  std::function<void()> then) {
  for (const std::string& id : ids) {
    const auto ended = context->access.book().end_session(call->who->user, id);
    if (!ended) return call->respond(problem(ended.error()));
  }
  keep_people(context, [call, then = std::move(then)](const base::Result<void>& kept) {
    if (kept) return then();
    call->respond(
        problem({base::Code::Unavailable,
                 "it is over now, but may be back after a restart: " + kept.error().detail}));
  });
}

Json time_or_null(base::WallTime time) {
  return time < base::kYoungest ? Json(nullptr) : Json(base::to_rfc3339(time));
}

void complain_of_new_user(Members& members, std::string_view name_member, const std::string& name,
                          std::string_view password_member, const std::string& password) {
  if (auto wrong = people::user_name_problem(name); !wrong.empty()) {
    members.complain(name_member, std::move(wrong));
  }
  if (auto wrong = people::password_problem(password, name); !wrong.empty()) {
    members.complain(password_member, std::move(wrong));
  }
}

}  // namespace roverd::api
