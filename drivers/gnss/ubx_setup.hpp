#pragma once
// Tells a u-blox receiver what to send, one request after the other, each acknowledged:
//
//   ask who it is (MON-VER) ─▶ CFG-VALSET position ─▶ … heading ─▶ … corrections in ─▶ … model
//
// A receiver refuses a whole request for one key that it does not know, so what only some models
// have (a heading, a covariance) stands in a request of its own. A request without an answer is
// repeated twice; refused and unanswered ones are named, and the receiver goes on as it is.
// Without `configure` it is only asked who it is, once it has spoken UBX itself.
//
// Pure state: no clock, no lock.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "base/time.hpp"
#include "ubx/messages.hpp"

namespace roverd::gnss {

enum class UbxPort { Uart1, Uart2, Usb };
/// "uart1", "uart2", "usb".
std::optional<UbxPort> ubx_port_from(const std::string& word);

struct UbxSetupOptions {
  bool configure = false;
  bool keep = false;  ///< in battery-backed memory and flash too, not only in RAM
  UbxPort port = UbxPort::Usb;
  double rate_hz = 5.0;
};

class UbxSetup {
 public:
  explicit UbxSetup(const UbxSetupOptions& options);

  /// The link was opened: from the beginning.
  void begin();
  /// @param heard an intact UBX frame came since begin().
  /// @return what is to be written now; empty: nothing.
  std::vector<std::uint8_t> due(bool heard, base::Time now);
  void add(const ubx::Message& message);

  /// "receiver", "firmware", "configuration" …, as far as known.
  const std::map<std::string, std::string>& facts() const noexcept { return facts_; }

 private:
  static constexpr base::Duration kPatience = std::chrono::seconds(1);
  static constexpr int kTries = 3;

  struct Step {
    std::string what;  ///< for people
    std::vector<std::uint8_t> bytes;
    bool is_poll = false;  ///< answered by MON-VER, else by an acknowledgement
  };

  void next(const std::string& outcome);
  void on_version(const ubx::MonVer& version);

  UbxSetupOptions options_;
  std::vector<Step> steps_;
  std::size_t at_ = 0;
  int tries_ = 0;
  base::Time asked_{};
  std::string refused_;  ///< "heading refused, model without answer"
  std::map<std::string, std::string> facts_;
};

}  // namespace roverd::gnss
