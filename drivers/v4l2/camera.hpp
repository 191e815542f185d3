#pragma once
// A camera at this computer, through the kernel (Video4Linux 2). What its images become is the
// caller's: a Pack makes bytes of each.
//
// Of a depth camera (pixel format Z16: 16 bits of depth along the optical axis, little endian, row
// by row) they come out as frames of cloud/codec.hpp, as if a program had sent them: so the cloud
// driver hears it, and what is recorded is played like any other.
//
//   open ─▶ QUERYCAP ─▶ ENUM_FMT ─▶ S_FMT ─▶ S_PARM ─▶ REQBUFS ─▶ (QUERYBUF, mmap, QBUF) x 4
//        ─▶ STREAMON ─▶ readable: DQBUF ─▶ frame ─▶ QBUF … ─▶ STREAMOFF, unmap, close
//
// Source: the kernel's "Video for Linux API", parts "Streaming I/O (Memory Mapping)" and "Buffers".
// Buffers that the driver marks as damaged (V4L2_BUF_FLAG_ERROR) or that are too short are counted
// and given back; their numbers are missing then. Frames bear the driver's number and its time: of
// CLOCK_MONOTONIC where it says so, else that of the taking. A camera that is pulled out is
// on_closed; open() tries it again.
//
// Device thread only.

#include <functional>
#include <string>
#include <vector>

#include "link/descriptor.hpp"
#include "link/link.hpp"
#include "v4l2/device.hpp"
#include "v4l2/params.hpp"

namespace roverd::v4l2 {

/// One image in the driver's memory, for the time of a call.
struct Image {
  std::uint32_t format = 0;  ///< V4L2_PIX_FMT_…
  std::size_t width = 0;     ///< as the driver gives it
  std::size_t height = 0;
  std::size_t stride = 0;  ///< bytes from row to row; of a compressed one 0
  base::Bytes bytes;       ///< as many as came
  std::uint32_t sequence = 0;
  link::Time stamp;  ///< when it was taken
};

/// What is wanted of a camera.
struct Wanted {
  struct Format {
    std::uint32_t fourcc = 0;
    std::size_t pixel = 0;  ///< bytes of one; 0: compressed
  };
  int width = 640;
  int height = 480;
  int images_hz = 30;
  bool exact = false;           ///< another size is refused
  std::vector<Format> formats;  ///< the first one that the camera has
  std::string what;             ///< them, for messages: "depth (Z16)"
};

/// Bytes to hand over, stamped with the image's time or with that of its arrival. Empty: none, and
/// `trouble` says why.
struct Packed {
  std::vector<std::uint8_t> bytes;
  bool at_image = false;
  std::string trouble{};
};
using Pack = std::function<Packed(const Image&)>;

class Camera final : public link::ByteLink {
 public:
  /// @param path "/dev/video2", or a name under /dev/v4l/by-id, which stays. @param params valid.
  /// @param device outlives it.
  Camera(boost::asio::io_context& io, std::string path, const Params& params,
         Device& device = kernel());
  /// A camera of any images.
  Camera(boost::asio::io_context& io, std::string path, Wanted wanted, Pack pack,
         Device& device = kernel());
  ~Camera() override;

  /// Unavailable: it is not there, busy, or does not do as it must; the detail says which.
  base::Result<void> open() override;
  void close() noexcept override;
  /// A camera is not written to.
  link::SendResult write(link::Bytes) noexcept override { return link::SendResult::Closed; }
  std::string describe() const override { return "v4l2:" + path_; }
  std::map<std::string, std::uint64_t> troubles() const override { return troubles_; }

 private:
  struct Buffer {
    std::uint8_t* at = nullptr;
    std::size_t size = 0;
  };

  base::Result<void> set_up(int fd);
  base::Result<void> check_kind(int fd);
  base::Result<void> check_formats(int fd);
  base::Result<void> set_format(int fd);
  void set_rate(int fd);
  base::Result<void> map_buffers(int fd);
  void release(int fd) noexcept;
  void read();
  void hand_over(const Buffer& buffer, std::size_t used, std::uint32_t sequence, link::Time stamp,
                 link::Time now);
  base::Error broken(const std::string& what, int error) const;
  void lost(const std::string& reason);

  const std::string path_;
  const Wanted wanted_;
  const Pack pack_;
  Device& device_;
  link::Descriptor descriptor_;
  std::vector<Buffer> buffers_;
  Wanted::Format format_;  ///< what it gives
  std::size_t width_ = 0;
  std::size_t height_ = 0;
  std::size_t stride_ = 0;  ///< bytes of a row, with what fills it up
  std::map<std::string, std::uint64_t> troubles_;
};

/// "v4l2:/dev/video2" to the path; empty: it is no such address.
std::string path_of(const std::string& address);

}  // namespace roverd::v4l2
