#pragma once
// A camera's kernel driver for tests: it does as the API's description says, checks the order in
// which it is asked, and gives the images that a test hands it.

#include <algorithm>
#include <array>
#include <cerrno>
#include <deque>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <linux/videodev2.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include "base/time.hpp"
#include "v4l2/device.hpp"

namespace roverd::v4l2 {

class StandIn final : public Device {
 public:
  static constexpr std::size_t kBuffers = 4;

  // How it is.
  bool there = true;
  std::uint32_t node = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  std::vector<std::uint32_t> formats{V4L2_PIX_FMT_Z16};
  std::uint32_t width = 640;  ///< what it can do only
  std::uint32_t height = 480;
  std::uint32_t stride = 1280;
  bool busy = false;

  // What was done with it.
  int opened = 0;
  int mapped = 0;
  bool streams = false;
  v4l2_fract interval{};

  int open(const std::string& path) override {
    EXPECT_EQ(path, "/dev/video2");
    if (!there) return -ENOENT;
    ++opened;
    ready_ = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    return ready_;
  }
  int ask(int fd, unsigned long request, void* argument) override {
    EXPECT_EQ(fd, ready_);
    if (!there) return ENODEV;
    switch (request) {
      case VIDIOC_QUERYCAP: {
        auto& a = *static_cast<v4l2_capability*>(argument);
        // The device has a node of metadata beside it.
        a.capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING | V4L2_CAP_META_CAPTURE |
                         V4L2_CAP_DEVICE_CAPS;
        a.device_caps = node;
        return 0;
      }
      case VIDIOC_ENUM_FMT: {
        auto& a = *static_cast<v4l2_fmtdesc*>(argument);
        if (a.type != V4L2_BUF_TYPE_VIDEO_CAPTURE || a.index >= formats.size()) return EINVAL;
        a.pixelformat = formats[a.index];
        return 0;
      }
      case VIDIOC_S_FMT:
        return set_format(*static_cast<v4l2_format*>(argument));
      case VIDIOC_S_PARM:
        interval = static_cast<v4l2_streamparm*>(argument)->parm.capture.timeperframe;
        return 0;
      case VIDIOC_REQBUFS: {
        auto& a = *static_cast<v4l2_requestbuffers*>(argument);
        EXPECT_EQ(a.memory, V4L2_MEMORY_MMAP);
        a.count = std::min<std::uint32_t>(a.count, kBuffers);
        memory_.assign(a.count, std::vector<std::uint8_t>(std::size_t{stride} * height));
        return 0;
      }
      case VIDIOC_QUERYBUF: {
        auto& a = *static_cast<v4l2_buffer*>(argument);
        if (a.index >= memory_.size()) return EINVAL;
        a.length = static_cast<std::uint32_t>(memory_[a.index].size());
        a.m.offset = a.index * 0x100000U;
        return 0;
      }
      case VIDIOC_QBUF: {
        const auto& a = *static_cast<v4l2_buffer*>(argument);
        if (a.index >= memory_.size() || std::ranges::count(empty_, a.index) > 0) return EINVAL;
        empty_.push_back(a.index);
        return 0;
      }
      case VIDIOC_DQBUF: {
        auto& a = *static_cast<v4l2_buffer*>(argument);
        if (!streams) return EINVAL;
        if (full_.empty()) {
          std::uint64_t n = 0;
          if (::read(ready_, &n, sizeof n) < 0) return EAGAIN;
          return EAGAIN;
        }
        a = full_.front();
        full_.pop_front();
        return 0;
      }
      case VIDIOC_STREAMON:
        EXPECT_FALSE(empty_.empty()) << "nothing to be filled";
        streams = true;
        return 0;
      case VIDIOC_STREAMOFF:
        streams = false;
        empty_.clear();
        full_.clear();
        return 0;
      default:
        return ENOTTY;
    }
  }
  void* map(int fd, std::size_t size, std::int64_t offset) override {
    EXPECT_EQ(fd, ready_);
    auto& one = memory_.at(static_cast<std::size_t>(offset / 0x100000));
    EXPECT_EQ(size, one.size());
    ++mapped;
    return one.data();
  }
  void unmap(void*, std::size_t) noexcept override { --mapped; }

  /// An image of the camera. @param used bytes of it that came; 0: all. @return false: no buffer
  /// was free, the image is lost, as its number is.
  bool show(const std::vector<std::uint16_t>& pixels, std::uint32_t flags = 0, base::Time at = {},
            std::uint32_t used = 0) {
    const std::uint32_t number = number_++;
    if (!streams || empty_.empty()) return false;
    v4l2_buffer full{};
    full.index = empty_.front();
    empty_.pop_front();
    auto& memory = memory_[full.index];
    std::fill(memory.begin(), memory.end(), std::uint8_t{0xEE});
    for (std::size_t v = 0; v < height; ++v) {
      for (std::size_t u = 0; u < width; ++u) {
        const std::uint16_t depth = pixels[v * width + u];
        memory[v * stride + 2 * u] = static_cast<std::uint8_t>(depth & 0xFFU);
        memory[v * stride + 2 * u + 1] = static_cast<std::uint8_t>(depth >> 8U);
      }
    }
    full.flags = flags;
    full.sequence = number;
    full.bytesused = used != 0 ? used : static_cast<std::uint32_t>(memory.size());
    const auto since = at.time_since_epoch();
    full.timestamp.tv_sec = std::chrono::duration_cast<std::chrono::seconds>(since).count();
    full.timestamp.tv_usec =
        std::chrono::duration_cast<std::chrono::microseconds>(since).count() % 1'000'000;
    full_.push_back(full);
    wake();
    return true;
  }
  /// Somebody pulls the cable.
  void pull() {
    there = false;
    streams = false;
    empty_.clear();
    full_.clear();
    wake();
  }
  std::size_t waiting_to_be_filled() const { return empty_.size(); }

 private:
  int set_format(v4l2_format& a) {
    if (busy) return EBUSY;
    EXPECT_EQ(a.fmt.pix.pixelformat, V4L2_PIX_FMT_Z16);
    a.fmt.pix.width = width;  // what is nearest to the wish
    a.fmt.pix.height = height;
    a.fmt.pix.bytesperline = stride;
    a.fmt.pix.sizeimage = stride * height;
    return 0;
  }
  void wake() const {
    const std::uint64_t one = 1;
    EXPECT_EQ(::write(ready_, &one, sizeof one), static_cast<ssize_t>(sizeof one));
  }

  int ready_ = -1;
  std::uint32_t number_ = 0;
  std::vector<std::vector<std::uint8_t>> memory_;
  std::deque<std::uint32_t> empty_;
  std::deque<v4l2_buffer> full_;
};

}  // namespace roverd::v4l2
