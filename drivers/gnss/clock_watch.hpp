#pragma once
// A receiver that repeats one epoch for ever: its sentences are intact and its position is old.
// Seen by its time of day, which must go on. Some receivers print whole seconds at 5 Hz, so an
// equal time proves nothing for a while. Pure state, no clock.

#include <optional>
#include <variant>

#include "base/time.hpp"
#include "gnss/sentence.hpp"

namespace roverd::gnss {

class ClockWatch {
 public:
  static constexpr double kFrozenAfter_s = 1.5;

  /// @param stamp arrival. @return whether the time stands: nothing the receiver says is of now.
  bool add(const Sentence& sentence, base::Time stamp) noexcept {
    return add(time_of_fix(sentence), stamp);
  }
  /// @param time_s of a position, by the receiver; empty: it told none.
  bool add(std::optional<double> time_s, base::Time stamp) noexcept {
    if (!time_s) return frozen_;
    if (time_s != time_s_) {
      time_s_ = time_s;
      since_ = stamp;
      frozen_ = false;
    } else {
      frozen_ = base::seconds(stamp - since_) > kFrozenAfter_s;
    }
    return frozen_;
  }
  bool frozen() const noexcept { return frozen_; }

 private:
  /// Without a position a time may stand: nobody uses it.
  static std::optional<double> time_of_fix(const Sentence& sentence) noexcept {
    if (const auto* gga = std::get_if<Gga>(&sentence); gga && gga->lat) return gga->time_s;
    if (const auto* rmc = std::get_if<Rmc>(&sentence); rmc && rmc->lat) return rmc->time_s;
    if (const auto* gns = std::get_if<Gns>(&sentence); gns && gns->lat) return gns->time_s;
    return {};
  }

  std::optional<double> time_s_;
  base::Time since_{};
  bool frozen_ = false;
};

}  // namespace roverd::gnss
