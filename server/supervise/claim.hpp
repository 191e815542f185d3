#pragma once
// One program moves a robot. Whoever opens the link that moves it claims its name first; the kernel
// gives it back when the process ends, however it ends, and whatever became of its files.

#include <string>
#include <utility>

#include "base/result.hpp"

namespace roverd {

class Claim {
 public:
  /// @param link address of the drive link: "can:can0". Known on this computer only (CAN and serial
  /// ports are, too). Unavailable: another process has it; which one is said.
  static base::Result<Claim> take(const std::string& link);
  Claim(Claim&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Claim& operator=(Claim&&) = delete;
  Claim(const Claim&) = delete;
  ~Claim();

 private:
  explicit Claim(int fd) : fd_(fd) {}
  int fd_;
};

}  // namespace roverd
