#include "config/reach.hpp"

#include <algorithm>
#include <sstream>

namespace roverd {

namespace {

using base::Code;
using base::Result;

constexpr const char* kEveryAddress = "::";

bool looks_like_address(const std::string& text) {
  const auto fits = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F') || c == '.' ||
           c == ':';
  };
  return text.find_first_of(".:") != std::string::npos &&
         std::all_of(text.begin(), text.end(), fits);
}

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

/// `bind` alone opens no network by mistake: both must have been said.
Result<void> check_bind(const Settings& s) {
  const ServerSettings& server = s.server;
  if (is_loopback(server.bind) || (server.tls && server.access)) return {};
  return base::fail(Code::Invalid, s.where("server.bind") +
                                       " must be a loopback address (127.0.0.1, ::1), is \"" +
                                       server.bind +
                                       "\": for a network server.listen = \"lan\" is there, or "
                                       "server.tls and server.access must be true");
}

/// @param on what `key` says
Result<void> force(const Settings& s, const std::string& key, bool& on, const char* why) {
  if (!on && s.places.contains(key)) {
    return base::fail(Code::Invalid, s.where(key) + " must not be false: server.listen = \"" +
                                         s.server.listen + "\" reaches into a network, and " + why);
  }
  on = true;
  return {};
}

}  // namespace

bool is_loopback(const std::string& address) noexcept {
  const auto plain = [](char c) { return c == '.' || (c >= '0' && c <= '9'); };
  return address == "::1" || (address.starts_with("127.") && address.size() <= 15 &&
                              std::all_of(address.begin(), address.end(), plain));
}

std::vector<std::string> addresses_of(const ServerSettings& server) {
  if (server.listen == "loopback") return {server.bind};
  if (server.listen == "lan") return {kEveryAddress};
  return words_of(server.listen);
}

bool reaches_out(const ServerSettings& server) {
  const auto addresses = addresses_of(server);
  return !std::all_of(addresses.begin(), addresses.end(), is_loopback);
}

std::string authority_of(const std::string& address, int port) {
  const bool v6 = address.find(':') != std::string::npos;
  return (v6 ? "[" + address + "]" : address) + ":" + std::to_string(port);
}

Result<void> settle_server(Settings& s) {
  const auto addresses = addresses_of(s.server);
  if (s.server.listen == "loopback") return check_bind(s);
  if (addresses.empty() || !std::all_of(addresses.begin(), addresses.end(), looks_like_address)) {
    return base::fail(Code::Invalid, s.where("server.listen") +
                                         " must be loopback, lan or addresses with blanks between "
                                         "them, is \"" +
                                         s.server.listen + "\"");
  }
  if (!reaches_out(s.server)) return {};
  if (auto done = force(s, "server.tls", s.server.tls, "only https is spoken there"); !done) {
    return done;
  }
  return force(s, "server.access", s.server.access, "people log in there");
}

}  // namespace roverd
