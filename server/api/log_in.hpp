#pragma once
// What all ways to come in share: password, PIN, the first admin's code, an invitation. Whoever
// guesses waits, hashes are computed beside the web thread and few at a time. Web thread only.

#include <memory>
#include <optional>
#include <string>

#include "api/context.hpp"

namespace roverd::api {

/// Of hashing: beside what is small and must not wait for it.
inline constexpr Effort kHash{Effort::kSmall + 1};

/// What GET /session tells whoever sent `request`.
Json session_json(const Context& context, const Request& request,
                  const std::optional<people::Who>& who);

/// @return true: answered already, there is nothing to log in to
bool refuse_without_access(const ContextPtr& context, const CallPtr& call);

/// Refuses whom there is no time for. What it returns is held until the hash is computed; null:
/// answered already.
std::shared_ptr<void> may_hash(const ContextPtr& context, const CallPtr& call, base::Duration wait);

/// Answers with the session and its cookie, when it is kept. @param device the secret of a device
/// that was paired or used; empty: none
void let_in(const ContextPtr& context, const CallPtr& call,
            const people::Opened<people::Session>& opened, const std::string& device = {});

}  // namespace roverd::api
