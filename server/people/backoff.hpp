#pragma once
// How long whoever guessed wrong must wait: not at all for the first few, then twice as long each
// time. Bounded; forgets what is old. Counts monotonic time: a clock that jumps helps nobody.

#include <cstddef>
#include <string>
#include <unordered_map>

#include "base/time.hpp"

namespace roverd::people {

class Backoff {
 public:
  static constexpr int kFree = 4;
  static constexpr base::Duration kFirst = std::chrono::seconds(1);
  static constexpr base::Duration kForget = std::chrono::hours(1);

  /// @param most keys that are remembered @param free tries that nobody waits after
  Backoff(base::Duration longest, std::size_t most, int free = kFree)
      : longest_(longest), most_(most), free_(free) {}

  /// Zero: may try now.
  base::Duration wait(const std::string& key, base::Time now) const;
  /// An attempt counts as wrong when it begins, so that many at once gain nothing.
  void tried(const std::string& key, base::Time now);
  void clear(const std::string& key) { known_.erase(key); }
  std::size_t size() const noexcept { return known_.size(); }

 private:
  struct Failures {
    int count = 0;
    base::Time last;
    base::Time free_at;
  };
  void make_room(base::Time now);

  base::Duration longest_;
  std::size_t most_;
  int free_;
  std::unordered_map<std::string, Failures> known_;
};

}  // namespace roverd::people
