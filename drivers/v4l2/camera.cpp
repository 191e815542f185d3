#include "v4l2/camera.hpp"

#include <algorithm>
#include <cerrno>
#include <utility>

#include <linux/videodev2.h>
#include <unistd.h>

#include "cloud/codec.hpp"

namespace roverd::v4l2 {
namespace {

using base::Result;
using link::Time;

constexpr std::uint32_t kBuffers = 4;
constexpr std::uint32_t kCapture = V4L2_BUF_TYPE_VIDEO_CAPTURE;
/// More formats than any camera has.
constexpr std::uint32_t kMostFormats = 64;

std::string letters(std::uint32_t fourcc) {
  std::string out;
  for (unsigned i = 0; i < 4; ++i) {
    const auto c = static_cast<char>(fourcc >> 8U * i & 0x7FU);
    out += c >= ' ' && c < 0x7F ? c : '?';
  }
  return out.substr(0, out.find_last_not_of(' ') + 1);
}

std::string size_text(std::uint32_t width, std::uint32_t height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

v4l2_buffer buffer_at(std::uint32_t index) noexcept {
  v4l2_buffer out{};
  out.type = kCapture;
  out.memory = V4L2_MEMORY_MMAP;
  out.index = index;
  return out;
}

/// What the driver told, if its clock is ours and the time can be.
Time time_of(const v4l2_buffer& buffer, Time now) noexcept {
  if ((buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) != V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC) {
    return now;
  }
  const Time told{std::chrono::seconds(buffer.timestamp.tv_sec) +
                  std::chrono::microseconds(buffer.timestamp.tv_usec)};
  return told <= now && now - told < std::chrono::seconds(1) ? told : now;
}

/// Without what fills up its rows.
Packed depth_frame(const Params& params, const Image& image) {
  const std::size_t row = image.width * 2;
  std::vector<std::uint8_t> pixels;
  pixels.reserve(row * image.height);
  for (std::size_t v = 0; v < image.height; ++v) {
    const std::uint8_t* from = image.bytes.data() + v * image.stride;
    pixels.insert(pixels.end(), from, from + row);
  }
  cloud::Header header;
  header.kind = cloud::Kind::Depth;
  header.stamp_ns = std::chrono::nanoseconds(image.stamp.time_since_epoch()).count();
  header.sequence = image.sequence;
  const auto middle = [](double told, std::size_t size) {
    return static_cast<float>(told < 0.0 ? static_cast<double>(size - 1) / 2.0 : told);
  };
  const auto fx = static_cast<float>(params.fx);
  const cloud::Depth depth{.width = static_cast<std::uint16_t>(image.width),
                           .height = static_cast<std::uint16_t>(image.height),
                           .fx = fx,
                           .fy = params.fy > 0.0 ? static_cast<float>(params.fy) : fx,
                           .cx = middle(params.cx, image.width),
                           .cy = middle(params.cy, image.height),
                           .unit_m = static_cast<float>(params.depth_unit_m),
                           .data = pixels};
  return {cloud::encode(header, depth), false};
}

}  // namespace

std::string path_of(const std::string& address) {
  constexpr std::string_view kBefore = "v4l2:";
  return address.starts_with(kBefore) ? address.substr(kBefore.size()) : std::string();
}

Camera::Camera(boost::asio::io_context& io, std::string path, const Params& params, Device& device)
    : Camera(
          io, std::move(path),
          Wanted{params.width,
                 params.height,
                 params.images_hz,
                 true,
                 {{V4L2_PIX_FMT_Z16, 2}},
                 "depth (Z16)"},
          [params](const Image& image) { return depth_frame(params, image); }, device) {}

Camera::Camera(boost::asio::io_context& io, std::string path, Wanted wanted, Pack pack,
               Device& device)
    : path_(std::move(path)),
      wanted_(std::move(wanted)),
      pack_(std::move(pack)),
      device_(device),
      descriptor_(io) {}

Camera::~Camera() {
  close();
}

Result<void> Camera::open() {
  close();
  const int fd = device_.open(path_);
  if (fd < 0) return tl::unexpected(broken("cannot be opened", -fd));
  if (auto done = set_up(fd); !done) {
    release(fd);
    ::close(fd);
    return done;
  }
  return descriptor_.open(fd, [this] { read(); });
}

void Camera::close() noexcept {
  if (!descriptor_.is_open()) return;
  release(descriptor_.fd());
  descriptor_.close();
}

/// Stops it and gives the memory back; the descriptor stays open.
void Camera::release(int fd) noexcept {
  int type = kCapture;
  device_.ask(fd, VIDIOC_STREAMOFF, &type);
  for (const Buffer& buffer : buffers_) device_.unmap(buffer.at, buffer.size);
  buffers_.clear();
}

base::Error Camera::broken(const std::string& what, int error) const {
  return {base::Code::Unavailable,
          "camera " + path_ + " " + what + (error != 0 ? ": " + link::errno_text(error) : ""),
          {}};
}

Result<void> Camera::set_up(int fd) {
  if (auto good = check_kind(fd); !good) return good;
  if (auto good = check_formats(fd); !good) return good;
  if (auto good = set_format(fd); !good) return good;
  set_rate(fd);
  if (auto good = map_buffers(fd); !good) return good;
  int type = kCapture;
  if (const int error = device_.ask(fd, VIDIOC_STREAMON, &type); error != 0) {
    return tl::unexpected(broken("does not begin", error));
  }
  return {};
}

Result<void> Camera::check_kind(int fd) {
  v4l2_capability told{};
  if (const int error = device_.ask(fd, VIDIOC_QUERYCAP, &told); error != 0) {
    return tl::unexpected(broken("is no camera", error));
  }
  // A device with several nodes tells of all in the one, of this node in the other.
  const std::uint32_t can =
      (told.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? told.device_caps : told.capabilities;
  if ((can & V4L2_CAP_VIDEO_CAPTURE) == 0) {
    return tl::unexpected(broken("gives no images: another node of the device may", 0));
  }
  if ((can & V4L2_CAP_STREAMING) == 0) {
    return tl::unexpected(broken("cannot give its images by shared memory", 0));
  }
  return {};
}

Result<void> Camera::check_formats(int fd) {
  std::string others;
  std::size_t best = wanted_.formats.size();
  for (std::uint32_t i = 0; i < kMostFormats; ++i) {
    v4l2_fmtdesc format{};
    format.index = i;
    format.type = kCapture;
    if (device_.ask(fd, VIDIOC_ENUM_FMT, &format) != 0) break;
    const auto found =
        std::ranges::find(wanted_.formats, format.pixelformat, &Wanted::Format::fourcc);
    best = std::min(best, static_cast<std::size_t>(found - wanted_.formats.begin()));
    others += (others.empty() ? "" : ", ") + letters(format.pixelformat);
  }
  if (best < wanted_.formats.size()) {
    format_ = wanted_.formats[best];
    return {};
  }
  return tl::unexpected(broken("gives no " + wanted_.what +
                                   (others.empty() ? "" : ", only " + others) +
                                   ": another node of the device may",
                               0));
}

Result<void> Camera::set_format(int fd) {
  const auto width = static_cast<std::uint32_t>(wanted_.width);
  const auto height = static_cast<std::uint32_t>(wanted_.height);
  v4l2_format wanted{};
  wanted.type = kCapture;
  wanted.fmt.pix.width = width;
  wanted.fmt.pix.height = height;
  wanted.fmt.pix.pixelformat = format_.fourcc;
  wanted.fmt.pix.field = V4L2_FIELD_NONE;
  if (const int error = device_.ask(fd, VIDIOC_S_FMT, &wanted); error != 0) {
    return tl::unexpected(broken("cannot be set to " + wanted_.what, error));
  }
  // The driver takes what is nearest to it: with another size a focal length in pixels would be
  // wrong.
  const v4l2_pix_format& given = wanted.fmt.pix;
  const bool other_size = given.width != width || given.height != height;
  constexpr std::uint32_t kLargest_px = 4096;
  const bool can_be = given.width >= 1 && given.height >= 1 && given.width <= kLargest_px &&
                      given.height <= kLargest_px;
  if (given.pixelformat != format_.fourcc || (wanted_.exact && other_size) || !can_be) {
    return tl::unexpected(broken("gives " + letters(given.pixelformat) + " " +
                                     size_text(given.width, given.height) + " instead of " +
                                     letters(format_.fourcc) + " " + size_text(width, height),
                                 0));
  }
  width_ = given.width;
  height_ = given.height;
  stride_ =
      format_.pixel == 0 ? 0 : std::max<std::size_t>(given.bytesperline, width_ * format_.pixel);
  return {};
}

/// A camera that cannot be told gives what it gives.
void Camera::set_rate(int fd) {
  v4l2_streamparm rate{};
  rate.type = kCapture;
  rate.parm.capture.timeperframe.numerator = 1;
  rate.parm.capture.timeperframe.denominator = static_cast<std::uint32_t>(wanted_.images_hz);
  device_.ask(fd, VIDIOC_S_PARM, &rate);
}

Result<void> Camera::map_buffers(int fd) {
  v4l2_requestbuffers wanted{};
  wanted.count = kBuffers;
  wanted.type = kCapture;
  wanted.memory = V4L2_MEMORY_MMAP;
  if (const int error = device_.ask(fd, VIDIOC_REQBUFS, &wanted); error != 0) {
    return tl::unexpected(
        broken(error == EBUSY ? "is used by another program" : "has no buffers", error));
  }
  if (wanted.count < 2) return tl::unexpected(broken("has less than two buffers", 0));
  for (std::uint32_t i = 0; i < std::min(wanted.count, kBuffers); ++i) {
    v4l2_buffer one = buffer_at(i);
    if (const int error = device_.ask(fd, VIDIOC_QUERYBUF, &one); error != 0) {
      return tl::unexpected(broken("does not tell its buffers", error));
    }
    void* at = device_.map(fd, one.length, one.m.offset);
    if (at == nullptr) return tl::unexpected(broken("does not share its buffers", 0));
    buffers_.push_back({static_cast<std::uint8_t*>(at), one.length});
    v4l2_buffer empty = buffer_at(i);
    if (const int error = device_.ask(fd, VIDIOC_QBUF, &empty); error != 0) {
      return tl::unexpected(broken("does not take its buffers", error));
    }
  }
  return {};
}

void Camera::read() {
  // As many as there are buffers: who fills them faster than they are read is served again soon.
  for (std::uint32_t i = 0; i < kBuffers && descriptor_.is_open(); ++i) {
    const int fd = descriptor_.fd();
    v4l2_buffer full = buffer_at(0);
    const int error = device_.ask(fd, VIDIOC_DQBUF, &full);
    if (error == EAGAIN) return;
    if (error != 0) return lost(link::errno_text(error));
    if (full.index >= buffers_.size()) return lost("it names a buffer that there is not");
    const Time now = base::steady_now();
    if ((full.flags & V4L2_BUF_FLAG_ERROR) != 0) {
      ++troubles_["image that the camera's driver marks as damaged"];
    } else {
      hand_over(buffers_[full.index], full.bytesused, full.sequence, time_of(full, now), now);
    }
    if (!descriptor_.is_open()) return;  // closed by the receiver
    v4l2_buffer empty = buffer_at(full.index);
    if (const int again = device_.ask(fd, VIDIOC_QBUF, &empty); again != 0) {
      return lost(link::errno_text(again));
    }
  }
}

void Camera::hand_over(const Buffer& buffer, std::size_t used, std::uint32_t sequence, Time stamp,
                       Time now) {
  const std::size_t size = std::min(used, buffer.size);
  const std::size_t least =
      format_.pixel == 0 ? 1 : stride_ * (height_ - 1) + width_ * format_.pixel;
  if (size < least) {
    ++troubles_["image that is too short"];
    return;
  }
  const Packed packed = pack_({.format = format_.fourcc,
                               .width = width_,
                               .height = height_,
                               .stride = stride_,
                               .bytes = {buffer.at, size},
                               .sequence = sequence,
                               .stamp = stamp});
  if (packed.bytes.empty()) {
    ++troubles_[packed.trouble];
  } else if (on_bytes) {
    on_bytes(packed.bytes, packed.at_image ? stamp : now);
  }
}

void Camera::lost(const std::string& reason) {
  close();
  if (on_closed) on_closed("lost " + describe() + ": " + reason);
}

}  // namespace roverd::v4l2
