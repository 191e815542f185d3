#include "net/peers.hpp"

#include <algorithm>

namespace roverd::net {

namespace {

/// A /64 of IPv6 may have so many times what one address may: others live in it, too.
constexpr int kOfOneNetwork = 4;

}  // namespace

Response Peers::refusal(unsigned status, std::string_view detail) const {
  if (handlers.on_refused) return handlers.on_refused(status, detail);
  Response response{boost::beast::http::int_to_status(status), 11};
  response.set(boost::beast::http::field::content_type, "text/plain; charset=utf-8");
  response.body() = std::string(detail) + "\n";
  return response;
}

/// As many of one address or network as may be, and all of them busy.
bool Peers::has_its_share(const From& from) {
  const int most = limits.per_address;
  const auto used_up = [this](const std::string& of, int share) {
    return !of.empty() && count_of(of, false) >= share && !drop_longest_waiting(false, of);
  };
  if (most == 0) return false;
  return used_up(from.address, most) || used_up(from.network, kOfOneNetwork * most);
}

bool Peers::makes_room(const From& from) {
  if (has_its_share(from)) return false;
  int most = limits.connections;
  const bool known = from.address.empty() || (handlers.knows && handlers.knows(from.address));
  if (!known) most -= std::min(limits.kept, most / 8);
  return count() - on_reserve() < most || drop_longest_waiting(false);
}

bool Peers::makes_room_on_reserve(const From& from) {
  const int most = std::max(1, limits.reserve / 4);
  const auto used_up = [this](const std::string& of, int share) {
    return limits.per_address > 0 && !of.empty() && count_of(of, true) >= share;
  };
  if (used_up(from.address, most)) return drop_longest_waiting(true, from.address);
  if (used_up(from.network, 2 * most)) return drop_longest_waiting(true, from.network);
  return on_reserve() < limits.reserve || drop_longest_waiting(true);
}

}  // namespace roverd::net
