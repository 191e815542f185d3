#pragma once
// When somebody last said that the robot shall stand. What was clicked before that is not carried
// out after it, however young it is: on a slow way a stop overtakes it.
//
//   start clicked ──────────(a slow way)─────────▶ refused
//        hold clicked ──(another connection)──▶ taken
//
// That there was nothing to stop makes no difference: the start may have been under way. Control
// thread.

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "base/result.hpp"
#include "base/time.hpp"

namespace roverd::robot {

class LastStop {
 public:
  /// @param what happened, for people; of static life.
  void take(base::Time now, std::string_view what = "the robot was stopped") noexcept {
    last_ = Taken{now, what};
  }

  /// Late if a stop came after what the sender of a command had seen. @param seen in the robot's
  /// time, which the outside is told in whole milliseconds that have begun: what was seen in the
  /// same one was seen after the stop.
  base::Result<void> permits(base::Time seen) const {
    if (!last_ || seen >= std::chrono::floor<std::chrono::milliseconds>(last_->at)) return {};
    return base::fail(base::Code::Late,
                      std::string(last_->what) +
                          " after this was clicked, so it was not carried out: look, then click "
                          "again");
  }

 private:
  struct Taken {
    base::Time at;
    std::string_view what;
  };
  std::optional<Taken> last_;
};

}  // namespace roverd::robot
