#include "people/words.hpp"

namespace roverd::people {

std::string_view to_string(Role role) noexcept {
  switch (role) {
    case Role::Viewer:
      return "viewer";
    case Role::Operator:
      return "operator";
    case Role::Admin:
      return "admin";
  }
  return "";
}

std::optional<Role> role_of(std::string_view word) noexcept {
  for (const Role role : kRoles) {
    if (to_string(role) == word) return role;
  }
  return std::nullopt;
}

}  // namespace roverd::people
