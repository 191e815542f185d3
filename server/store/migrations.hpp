#pragma once
// The SQL files of migrations/, embedded at build time. Forward only; a shipped one is never
// edited.

#include <span>
#include <string_view>

namespace roverd::store {

struct Migration {
  int number;             ///< 1, 2, 3 … also the schema's version once it is applied
  std::string_view name;  ///< "0001_missions.sql"
  std::string_view sql;   ///< null-terminated
};

/// In order.
std::span<const Migration> migrations() noexcept;

}  // namespace roverd::store
