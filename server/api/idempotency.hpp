#pragma once
// Idempotency-Key: the same key gives the first answer again, also while the first is still on its
// way. Bounded: the oldest finished answers go first. A refusal that says "try again" (429, 503) is
// not kept: nothing was done.

#include <cstddef>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "api/message.hpp"

namespace roverd::api {

class Idempotency {
 public:
  static constexpr std::size_t kKeys = 512;
  static constexpr std::size_t kBytes = 16 * 1024 * 1024;  ///< of kept answers

  /// @return true: this is the first; carry it out and answer through the replaced
  /// `call.respond`. false: it was or will be answered from the first one (or refused: the same
  /// key with another body is a mistake, 422). Without the header: true, nothing changed.
  bool admit(Call& call);

 private:
  struct Entry {
    std::size_t body_hash = 0;
    bool done = false;
    Response answer;
    std::vector<Respond> waiting;
  };
  void finish(const std::string& key, const Response& response);
  void trim();

  std::map<std::string, Entry> entries_;
  std::deque<std::string> finished_;  ///< oldest first
  std::size_t bytes_ = 0;
};

}  // namespace roverd::api
