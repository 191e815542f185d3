#pragma once
// What a service manager (systemd, Type=notify) is told: that the robot is served, and, as long as
// the control loop runs, that it is alive. A loop that hangs is silent here, too: the manager then
// ends the process and starts another one, which is disarmed. Datagrams as in sd_notify(3); without
// NOTIFY_SOCKET in the environment everything here does nothing.

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "base/time.hpp"

namespace roverd {

class ServiceManager {
 public:
  /// @param socket path, or @name in the kernel; empty: there is none. @param watchdog_us as in
  /// WATCHDOG_USEC; empty or wrong: no watchdog.
  ServiceManager(std::string socket, std::string_view watchdog_us);
  /// From the environment.
  static ServiceManager of_this_process();
  ServiceManager(ServiceManager&& other) noexcept;
  ServiceManager& operator=(ServiceManager&&) = delete;
  ServiceManager(const ServiceManager&) = delete;
  ~ServiceManager();

  void ready(const std::string& address);
  void stopping();
  /// @param ticks of the control loop since the start: only when there are new ones is it alive.
  void alive(std::uint64_t ticks);
  /// How often alive() is to be called: a third of what the manager waits. Empty: not at all.
  std::optional<base::Duration> period() const noexcept { return period_; }

 private:
  void tell(const std::string& words);

  int fd_ = -1;
  std::string socket_;
  std::optional<base::Duration> period_;
  std::optional<std::uint64_t> told_;
};

/// Keeps what the program touches from being swapped out: a page read back from a disk costs more
/// than a tick. @return whether it was permitted (CAP_IPC_LOCK, or LimitMEMLOCK=infinity).
bool lock_memory() noexcept;

}  // namespace roverd
