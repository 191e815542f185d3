#pragma once
// The system calls by which a camera of Video4Linux is spoken to: the kernel's, or a test's.

#include <cstddef>
#include <cstdint>
#include <string>

namespace roverd::v4l2 {

/// Device thread.
class Device {
 public:
  virtual ~Device() = default;
  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  /// For reading and writing, not to be waited on. @return a descriptor that becomes readable with
  /// each image, the caller's to close; below 0: minus the errno.
  virtual int open(const std::string& path) = 0;
  /// As ioctl(2), begun anew where a signal cut it. @return 0, or the errno.
  virtual int ask(int fd, unsigned long request, void* argument) = 0;
  /// One buffer of the driver's. @return null: it cannot be.
  virtual void* map(int fd, std::size_t size, std::int64_t offset) = 0;
  virtual void unmap(void* at, std::size_t size) noexcept = 0;
};

/// The kernel's. Lives as long as the program; any thread.
Device& kernel() noexcept;

}  // namespace roverd::v4l2
