#pragma once
// Secrets: made, hashed, compared. Any thread; none of it logs, and no error names a secret.

#include <string>
#include <string_view>

#include "base/result.hpp"

namespace roverd::people {

/// 256 bits of chance, URL-safe.
std::string random_secret();
/// Names something; opens nothing.
std::string random_id();
/// What is kept of a secret of that kind (BLAKE2b-256, hexadecimal). Not for passwords: it is
/// quick.
std::string digest(std::string_view secret);
/// Takes as long for what is nearly right as for what is wrong.
bool same(std::string_view a, std::string_view b) noexcept;

/// Eight signs in two groups that are hard to mistake when they are read aloud: "KTRF-3M7X".
std::string spoken_code();
/// As a person may type it: lower case, blanks, no hyphen.
std::string plain_code(std::string_view typed);

/// argon2id; costs 100 to 300 ms of CPU and 16 MB: never on the web thread. Unavailable: no memory.
base::Result<std::string> hash_password(std::string_view password);
/// Costs the same, also where `hash` is none of ours.
bool is_password(const std::string& hash, std::string_view password) noexcept;
/// Hash of a password that nobody knows: to be compared with where there is no such user, so that
/// the time tells nothing.
const std::string& nobodys_hash();

inline constexpr std::size_t kShortestPassword = 12;
inline constexpr std::size_t kLongestPassword = 200;
/// What is wrong with it; empty: nothing. Never tells the password.
std::string password_problem(std::string_view password, std::string_view user);
inline constexpr std::size_t kShortestPin = 4;
inline constexpr std::size_t kLongestPin = 8;
/// What is wrong with it, as those before: digits only, and none of those that are tried first.
std::string pin_problem(std::string_view pin);
/// 1 to 40 letters, digits, dots, hyphens, underscores.
std::string user_name_problem(std::string_view name);

}  // namespace roverd::people
