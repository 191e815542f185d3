#pragma once
// A value that must reach its readers. The control loop only tries the readers' lock
// (base/latest.hpp) and tries again at every tick until it got it. set and deliver: control thread;
// get: any.

#include <memory>
#include <utility>

#include "base/latest.hpp"

namespace roverd::robot {

template <class T>
class Delivered {
 public:
  void set(std::shared_ptr<const T> value) noexcept {
    value_ = std::move(value);
    due_ = true;
  }
  /// @return whether readers have the newest one.
  bool deliver() noexcept {
    if (due_) due_ = !latest_.publish(value_);
    if (!due_) value_.reset();
    return !due_;
  }
  std::shared_ptr<const T> get() const { return latest_.get(); }

 private:
  base::Latest<T> latest_;
  std::shared_ptr<const T> value_;  ///< waits
  bool due_ = false;
};

}  // namespace roverd::robot
