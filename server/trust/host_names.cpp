#include "trust/host_names.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <sstream>

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace roverd::trust {

namespace {

/// A computer full of containers has hundreds; a certificate must not grow without end.
constexpr std::size_t kMostAddresses = 64;
constexpr std::size_t kLongestHost = 253;
constexpr std::size_t kLongestLabel = 63;

std::string lower(std::string_view text) {
  std::string made(text);
  std::transform(made.begin(), made.end(), made.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return made;
}

/// As inet_ntop writes it; empty: no address.
std::string plain_address(const std::string& text) {
  std::array<unsigned char, sizeof(in6_addr)> bytes{};
  std::array<char, INET6_ADDRSTRLEN> plain{};
  for (const int family : {AF_INET, AF_INET6}) {
    if (::inet_pton(family, text.c_str(), bytes.data()) != 1) continue;
    ::inet_ntop(family, bytes.data(), plain.data(), plain.size());
    return plain.data();
  }
  return {};
}

void add_once(std::vector<std::string>& list, std::string one) {
  if (std::find(list.begin(), list.end(), one) == list.end()) list.push_back(std::move(one));
}

std::string address_of(const sockaddr& address) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (address.sa_family == AF_INET) {
    const auto& v4 = reinterpret_cast<const sockaddr_in&>(address);
    ::inet_ntop(AF_INET, &v4.sin_addr, text.data(), text.size());
  } else if (address.sa_family == AF_INET6) {
    const auto& v6 = reinterpret_cast<const sockaddr_in6&>(address);
    if (IN6_IS_ADDR_LINKLOCAL(&v6.sin6_addr)) return {};
    ::inet_ntop(AF_INET6, &v6.sin6_addr, text.data(), text.size());
  }
  return text.data();
}

}  // namespace

bool is_host_name(std::string_view text) noexcept {
  if (text.empty() || text.size() > kLongestHost) return false;
  std::size_t label = 0;
  char before = '.';
  for (const char c : text) {
    const bool letter = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (c == '.' ? before == '.' || before == '-' : !letter && (c != '-' || before == '.')) {
      return false;
    }
    label = c == '.' ? 0 : label + 1;
    if (label > kLongestLabel) return false;
    before = c;
  }
  return before != '.' && before != '-';
}

base::Result<Names> all_names(std::string_view host, std::vector<std::string> addresses,
                              std::string_view configured) {
  Names names;
  if (is_host_name(host)) {
    const std::string own = lower(host);
    add_once(names.hosts, own);
    add_once(names.hosts, own.substr(0, own.find('.')) + ".local");
  }
  add_once(names.hosts, "localhost");
  std::erase(names.hosts, "localhost.local");
  std::istringstream more{std::string(configured)};
  for (std::string one; more >> one;) {
    const std::string address = plain_address(one);
    if (!address.empty()) {
      add_once(names.addresses, address);
    } else if (is_host_name(one)) {
      add_once(names.hosts, lower(one));
    } else {
      return base::fail(base::Code::Invalid, "\"" + one + "\" is neither a name nor an address");
    }
  }
  add_once(names.addresses, "127.0.0.1");
  add_once(names.addresses, "::1");
  std::sort(addresses.begin(), addresses.end());
  for (auto& one : addresses) {
    if (names.addresses.size() < kMostAddresses) add_once(names.addresses, std::move(one));
  }
  return names;
}

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

std::vector<std::string> interface_addresses() {
  std::vector<std::string> found;
  ifaddrs* all = nullptr;
  if (::getifaddrs(&all) != 0) return found;
  for (const ifaddrs* one = all; one != nullptr; one = one->ifa_next) {
    if (one->ifa_addr == nullptr || (one->ifa_flags & IFF_UP) == 0) continue;
    if (auto text = address_of(*one->ifa_addr); !text.empty()) add_once(found, std::move(text));
  }
  ::freeifaddrs(all);
  return found;
}

std::string outward_address() {
  const int udp = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (udp < 0) return {};
  sockaddr_in far{};
  far.sin_family = AF_INET;
  far.sin_port = htons(9);
  ::inet_pton(AF_INET, "192.0.2.1", &far.sin_addr);  // in documents only, so behind the last router
  sockaddr_in own{};
  socklen_t size = sizeof own;
  const bool known = ::connect(udp, reinterpret_cast<const sockaddr*>(&far), sizeof far) == 0 &&
                     ::getsockname(udp, reinterpret_cast<sockaddr*>(&own), &size) == 0;
  ::close(udp);
  return known ? address_of(reinterpret_cast<const sockaddr&>(own)) : std::string();
}

}  // namespace roverd::trust
