#pragma once
// What every change of a stored mission has in common: whose revision it is based on, and how it is
// answered. Web thread.

#include <functional>

#include "api/context.hpp"

namespace roverd::api {

/// There are no users yet: everybody is the operator at this machine.
inline constexpr const char* kAuthor = "local";

/// With ETag, and Location if it was created.
Response mission_response(http::status status, const store::StoredMission& mission);

/// Answers so; a large one is written beside the web thread.
void answer_mission(const ContextPtr& context, const CallPtr& call, http::status status,
                    store::StoredMission mission, bool must);

/// What a change of a stored mission answers.
store::Reply<store::StoredMission> changed(const ContextPtr& context, const CallPtr& call,
                                           http::status status);

/// The same for a change that If-Match guards: 412 with the present state.
store::Reply<store::StoredMission> changed_or_present(const ContextPtr& context,
                                                      const CallPtr& call);

/// 412 with the present state, so that a client can show what it collided with.
void refuse_with_present(const ContextPtr& context, const CallPtr& call, base::Error error);

/// Calls `change` with the revision that If-Match asks for, or refuses: 428 without the header.
/// Tags that name no revision of ours lead to 412 by way of an impossible revision.
void with_expected(const ContextPtr& context, const CallPtr& call,
                   std::function<void(std::int64_t expected)> change);

}  // namespace roverd::api
