#pragma once
// What we tell an MTi when its port opens, and whether it agreed.
//
//   GoToConfig (every 100 ms, for 3 s) ─▶ DeviceID ─▶ ProductCode ─▶ FirmwareRev
//       ─▶ SetOutputConfiguration ─▶ GoToMeasurement
//
// An acknowledge is the request's number plus one; data that were under way come before it and are
// used. Who does not answer GoToConfig is left as it is, to be asked again at another baud rate;
// what is refused or left unanswered later is named, and the unit measures with what it has. A
// unit that was switched off and on begins anew (WakeUp). Pure state, no clock.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/time.hpp"
#include "mti/params.hpp"
#include "mti/xbus.hpp"

namespace roverd::mti {

/// What is asked for: rates of the counters with every message, the rest at rate_hz (field and
/// orientation at most 100 Hz, the receiver's items at 4 Hz).
std::vector<Output> wanted_outputs(const Params& params);

class Setup {
 public:
  /// Of params.configure: false asks nothing.
  explicit Setup(const Params& params);

  /// The port has just been opened, or the unit began anew.
  void begin();
  /// What is to be sent now; empty: nothing. The port cannot send: nothing more is asked.
  std::vector<std::uint8_t> due(base::Time now);
  void add(const Message& message);
  /// No answer to GoToConfig: perhaps another baud rate. begin() asks again.
  bool deaf() const noexcept { return deaf_; }
  bool done() const noexcept { return at_ == steps_.size(); }

  /// "configuration", "device", "product", "firmware".
  const std::map<std::string, std::string>& facts() const noexcept { return facts_; }

 private:
  struct Step {
    std::string what;
    std::uint8_t request;
    std::vector<std::uint8_t> bytes;
    base::Duration patience;
    int tries;
  };
  void next(const std::string& outcome);
  void on_answer(const Message& message);
  std::string judge(Bytes answered) const;

  const bool configure_;
  std::vector<Output> wanted_;
  std::vector<Step> steps_;
  std::size_t at_ = 0;
  int tries_ = 0;
  base::Time asked_{};
  bool deaf_ = false;
  std::string refused_;
  std::map<std::string, std::string> facts_;
};

}  // namespace roverd::mti
