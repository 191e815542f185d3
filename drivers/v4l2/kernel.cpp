#include <cerrno>

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/mman.h>

#include "v4l2/device.hpp"

namespace roverd::v4l2 {
namespace {

class Kernel final : public Device {
 public:
  int open(const std::string& path) override {
    const int fd = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    return fd >= 0 ? fd : -errno;
  }
  int ask(int fd, unsigned long request, void* argument) override {
    while (::ioctl(fd, request, argument) != 0) {
      if (errno != EINTR) return errno;
    }
    return 0;
  }
  void* map(int fd, std::size_t size, std::int64_t offset) override {
    void* at =
        ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, fd, static_cast<off_t>(offset));
    return at == MAP_FAILED ? nullptr : at;
  }
  void unmap(void* at, std::size_t size) noexcept override { ::munmap(at, size); }
};

}  // namespace

Device& kernel() noexcept {
  static Kernel only;
  return only;
}

}  // namespace roverd::v4l2
