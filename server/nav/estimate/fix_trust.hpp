#pragma once
// How far a fixed solution is to be trusted: one that comes and goes may be a wrong one, whatever
// the receiver claims. Under trees and beside walls it is, by decimetres, for seconds.
//
//   another class ──fixed──▶ fresh ──lasts kSettle──▶ settled
//   lost within kSteady of its begin: the next one is shaken, and must last twice as long
//
// Not thread-safe; no allocation; nothing here reads a clock.

#include <algorithm>
#include <chrono>

#include "base/measurements.hpp"

namespace roverd::nav {

class FixTrust {
 public:
  static constexpr base::Duration kSettle = std::chrono::seconds(3);
  static constexpr base::Duration kLongest = std::chrono::seconds(24);
  static constexpr base::Duration kSteady = std::chrono::seconds(60);

  /// Once a fix. @param stamp never goes back
  void take(base::FixType fix, base::Time stamp) noexcept {
    if (fix != fix_) {
      if (fix_ == base::FixType::RtkFixed) lost(stamp);
      fix_ = fix;
      since_ = stamp;
    }
    settled_ = stamp - since_ >= must_last_;
  }

  base::FixType fix() const noexcept { return fix_; }
  bool settled() const noexcept { return settled_; }
  /// It is fixed, and worth no more than a float solution.
  bool shaken() const noexcept {
    return fix_ == base::FixType::RtkFixed && !settled_ && must_last_ > kSettle;
  }

 private:
  void lost(base::Time stamp) noexcept {
    must_last_ = stamp - since_ >= kSteady ? kSettle : std::min(2 * must_last_, kLongest);
  }

  base::FixType fix_ = base::FixType::None;
  base::Time since_{};
  base::Duration must_last_ = kSettle;
  bool settled_ = false;
};

}  // namespace roverd::nav
