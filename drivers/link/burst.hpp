#pragma once

namespace roverd::link {

/// How many datagrams or frames a link takes in one turn of its event loop before the other links
/// have theirs.
inline constexpr int kReadBurst = 64;

}  // namespace roverd::link
