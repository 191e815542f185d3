#pragma once
// When bytes reached this machine, by the kernel's own word (TCP_INFO): what lay in a socket while
// nobody looked is older than the moment at which it is read. To about 4 ms (the kernel's tick).

#include "base/time.hpp"

namespace roverd::net {

/// When the newest bytes came in. `now` if the kernel does not tell.
base::Time newest_arrival(int socket, base::Time now) noexcept;

/// Since when the connection is open: it may have waited for accept(). Only before anything was
/// sent through it. `now` if the kernel does not tell.
base::Time opened_at(int socket, base::Time now) noexcept;

}  // namespace roverd::net
