#pragma once
// Who may do what: users, their sessions, tokens and paired devices, as they are kept. None of it
// holds a secret that opens a door: of passwords, PINs, cookies and tokens there are only hashes.

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/time.hpp"

namespace roverd::people {

/// Each may what the ones before it may.
enum class Role { Viewer, Operator, Admin };
inline constexpr std::array kRoles = {Role::Viewer, Role::Operator, Role::Admin};
std::string_view to_string(Role role) noexcept;
std::optional<Role> role_of(std::string_view word) noexcept;

/// What names a token's methods: the changing ones and GET, which stands for HEAD, too.
inline constexpr std::array<std::string_view, 5> kMethods = {"GET", "POST", "PUT", "PATCH",
                                                             "DELETE"};

struct User {
  std::string name;
  Role role = Role::Viewer;
  std::string password;  ///< argon2id with its parameters, as libsodium writes it
  base::WallTime created{};
};

/// A browser that logged in. Times before base::kYoungest: the clock was not set.
struct Session {
  std::string id;    ///< names it, opens nothing
  std::string hash;  ///< of its cookie
  std::string user;
  std::string device;  ///< as it called itself
  std::string address;
  base::WallTime created{};
  base::WallTime seen{};
  std::string
      paired{};  ///< the device whose PIN made it, and with which it goes; empty: a password
};

/// A browser that its user paired: what it keeps and a PIN together make a session.
struct Device {
  std::string id;    ///< names it, opens nothing
  std::string hash;  ///< of its cookie, which alone opens nothing
  std::string user;
  std::string name;
  Role role = Role::Viewer;  ///< never more, whatever the user may
  std::string pin;           ///< argon2id
  int wrong = 0;             ///< PINs since the last right one
  base::WallTime created{};
  std::optional<base::WallTime> used{};
};

/// What a script shows instead of a cookie.
struct Token {
  std::string id;
  std::string hash;
  std::string name;
  std::string user;  ///< who made it: never more than that one may
  Role role = Role::Viewer;
  std::vector<std::string> methods{};  ///< of kMethods; empty: all
  base::WallTime created{};
  std::optional<base::WallTime> expires{};
  std::optional<base::WallTime> used{};
};

/// All that is kept.
struct Everybody {
  std::vector<User> users;
  std::vector<Session> sessions;
  std::vector<Token> tokens;
  std::vector<Device> devices{};
};

/// What is to be written: rows as they are now, and the ids of those that are gone. With a user go
/// the user's sessions, tokens and devices, with a device its sessions.
struct Change {
  Everybody now{};
  std::vector<std::string> gone_users{};
  std::vector<std::string> gone_sessions{};
  std::vector<std::string> gone_tokens{};
  std::vector<std::string> gone_devices{};
  bool empty() const noexcept {
    return now.users.empty() && now.sessions.empty() && now.tokens.empty() && now.devices.empty() &&
           gone_users.empty() && gone_sessions.empty() && gone_tokens.empty() &&
           gone_devices.empty();
  }
};

}  // namespace roverd::people
