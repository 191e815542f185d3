#pragma once
// So much may be under way of one user: somebody's script that went wild, or a cookie in the wrong
// hands, leaves room for the others. Web thread only.

#include <map>
#include <string>

namespace roverd::api {

class Shares {
 public:
  explicit Shares(int each) : each_(each) {}

  bool used_up(const std::string& user) const {
    const auto found = taken_.find(user);
    return found != taken_.end() && found->second >= each_;
  }
  void take(const std::string& user) { ++taken_[user]; }
  void give_back(const std::string& user) {
    const auto found = taken_.find(user);
    if (found != taken_.end() && --found->second <= 0) taken_.erase(found);
  }

 private:
  int each_;
  std::map<std::string, int> taken_;
};

}  // namespace roverd::api
