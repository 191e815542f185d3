#pragma once
// Asks the kernel about a CAN interface and sets it up, over rtnetlink.
//
// Never waits for an answer: the kernel works on such a request inside the sending call, and its
// answer is there afterwards. Device thread only. Changes need CAP_NET_ADMIN.

#include <string>

#include "base/result.hpp"
#include "link/can_options.hpp"
#include "link/can_state.hpp"

namespace roverd::link {

/// An interface that does not exist is a state too (exists = false), not an error.
base::Result<CanState> read_can_state(const std::string& interface);

/// Gives the interface its bit rate and sets it up, as far as it is not so yet; another bit rate
/// means down for a moment. Errors say what was not allowed or not possible.
base::Result<void> bring_up(const std::string& interface, const CanOptions& options);

/// After bus off. An adapter that cannot restart by itself is set down; the next bring_up then
/// starts it anew.
base::Result<void> restart_bus(const std::string& interface);

}  // namespace roverd::link
