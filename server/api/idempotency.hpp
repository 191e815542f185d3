#pragma once
// Idempotency-Key: the same key gives the first answer again, also while the first is still on its
// way, and nobody else. Bounded: the oldest finished answers go first. A refusal that says "try
// again" (429, 503) is not kept: nothing was done.

#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <memory>
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
  bool admit(const CallPtr& call) { return admit(call, hash_of(call->request.body())); }
  /// The same for a body that was judged elsewhere.
  bool admit(const CallPtr& call, std::size_t body_hash);
  static std::size_t hash_of(const std::string& body) noexcept;

  /// Where large answers are copied: `work` there, then `then` here. Empty: at once.
  std::function<void(std::function<void()> work, std::function<void()> then)> aside{};

 private:
  static constexpr std::size_t kLarge = 256 * 1024;
  using Answer = std::shared_ptr<const Response>;
  struct Entry {
    std::size_t body_hash = 0;
    Answer answer;  ///< null: it is on its way
    std::vector<Respond> waiting;
  };
  void finish(const std::string& key, const Answer& answer);
  void give(const Respond& respond, const Answer& answer) const;
  void trim();

  std::map<std::string, Entry> entries_;
  std::deque<std::string> finished_;  ///< oldest first
  std::size_t bytes_ = 0;
};

}  // namespace roverd::api
