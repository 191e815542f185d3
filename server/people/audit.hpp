#pragma once
// What is written down of who did what: each row's hash holds the one before it. A row that was
// changed, put in between or taken out breaks the chain there. What a chain cannot show: rows
// missing at its end, and all of it made anew by somebody who may write the file. Whoever keeps a
// hash elsewhere (an export has the last one) can show that, too.
// Pure; any thread.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/time.hpp"

namespace roverd::people {

/// One call that changed something or was refused.
struct Deed {
  base::WallTime time{};     ///< before base::kYoungest: the clock was not set
  std::string user{};        ///< empty: nobody known
  std::string credential{};  ///< "session 1f…", "token 2a…"; empty: none was shown
  std::string address{};
  std::string call{};    ///< "PUT /missions/{id}"
  std::string target{};  ///< the path as it was asked for, without its query
  int status = 0;        ///< as answered over HTTP
  std::string detail{};  ///< why it was refused, or what was given
  int times = 1;         ///< so many alike, one after the other

  static constexpr std::size_t kLongest = 300;  ///< bytes of each text; the rest is cut off
};

struct KeptDeed {
  std::int64_t id = 0;  ///< 1, 2, 3 …
  Deed deed;
  std::string hash;
};

/// The hash before the first row.
inline constexpr std::string_view kFirstHash{};
/// @param before the hash of the row before it
std::string chained(std::string_view before, std::int64_t id, const Deed& deed);
/// Of rows in order. @return the first one that is not as it was written; empty: all are
std::optional<std::int64_t> first_break(std::int64_t before_id, std::string_view before,
                                        const std::vector<KeptDeed>& rows);

/// Texts as they are kept: no longer than Deed::kLongest, and UTF-8 without control characters.
Deed tidied(Deed deed);

}  // namespace roverd::people
