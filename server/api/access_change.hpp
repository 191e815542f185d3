#pragma once
// What the routes of sessions, users and tokens share: a change of the book is kept before it is
// answered, and whoever lost a right loses the stream.

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "api/context.hpp"

namespace roverd::api {

/// Writes what changed in the book. `then` comes once, on the web thread.
void keep_people(const ContextPtr& context, std::function<void(const base::Result<void>&)> then);
/// Ends sessions of the caller at once, kept or not; `then` answers when it is kept, else 503 tells
/// that the session may come back with a restart. NotFound if the first is not the caller's.
void end_sessions(const ContextPtr& context, const CallPtr& call, std::vector<std::string> ids,
                  std::function<void()> then);
/// Null where the clock was not set.
Json time_or_null(base::WallTime time);
void complain_of_new_user(Members& members, std::string_view name_member, const std::string& name,
                          std::string_view password_member, const std::string& password);

}  // namespace roverd::api
