#include "people/backoff.hpp"

#include <algorithm>

namespace roverd::people {

base::Duration Backoff::wait(const std::string& key, base::Time now) const {
  const auto found = known_.find(key);
  if (found == known_.end()) return base::Duration::zero();
  return std::max(base::Duration::zero(), found->second.free_at - now);
}

void Backoff::tried(const std::string& key, base::Time now) {
  if (!known_.contains(key) && known_.size() >= most_) make_room(now);
  Failures& f = known_[key];
  if (f.count > 0 && now - f.last > kForget) f = {};
  ++f.count;
  f.last = f.free_at = now;
  if (f.count < free_) return;
  const int doublings = std::min(f.count - free_, 20);
  f.free_at = now + std::min(longest_, kFirst * (1 << doublings));
}

/// What is old goes; if nothing is, whoever has the least to wait for.
void Backoff::make_room(base::Time now) {
  std::erase_if(known_, [now](const auto& entry) { return now - entry.second.last > kForget; });
  if (known_.size() < most_) return;
  known_.erase(std::min_element(known_.begin(), known_.end(), [](const auto& a, const auto& b) {
    return a.second.free_at < b.second.free_at;
  }));
}

}  // namespace roverd::people
