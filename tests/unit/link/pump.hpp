#pragma once
// A driver on a real transport: events, ticks and commands go on until something is true.

#include <optional>

#include "base/drive_command.hpp"
#include "unit/link/tools.hpp"

namespace roverd::link {

template <class Driver>
class Pump {
 public:
  Pump(boost::asio::io_context& io, Driver& driver) : io_(io), driver_(driver) {}

  /// @return false if `done` did not come true before the deadline.
  template <class Done>
  bool until(Done done) {
    return run_until(io_, [&] {
      const base::Time now = base::steady_now();
      if constexpr (requires(base::DriveCommand c) { driver_.send(c, now); }) {
        if (command) driver_.send(*command, now);
      }
      driver_.tick(now);
      return done();
    });
  }
  bool until_phase(base::DriverPhase phase) {
    return until([&] { return status().phase == phase; });
  }
  base::DriverStatus status() const { return driver_.status(base::steady_now()); }
  std::uint64_t counted(const std::string& cause) const {
    const auto counts = status().detail->counts;
    const auto found = counts.find(cause);
    return found == counts.end() ? 0 : found->second;
  }

  std::optional<base::DriveCommand> command;

 private:
  boost::asio::io_context& io_;
  Driver& driver_;
};

}  // namespace roverd::link
