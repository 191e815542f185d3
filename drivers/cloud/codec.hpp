#pragma once
// Clouds, depth images and planar ranges over a stream of bytes: docs/cloud-format.md. For cameras
// whose own program sends what it sees. Little endian; pure; bounded.
//
// Header, 56 bytes:
//    0  4  "RVSC"
//    4  1  version, 1
//    5  1  kind: 1 cloud, 2 depth image, 3 planar ranges
//    6  2  flags: bit 0 pose is told, bit 1 axes of a cloud are optical (x right, y down, z ahead),
//          bit 2 not good (heating up, covered)
//    8  8  stamp, i64 nanoseconds of the sender's clock, 0 .. 4e18: when it was measured
//   16  4  sequence, u32, one more each time
//   20  4  bytes of the body, u32
//   24 24  pose: x y z (m) roll pitch yaw (rad), f32: how the camera stands in the frame of its
//   mount 48  4  CRC-32 of the body 52  4  CRC-32 of the 52 bytes before
//
// Bodies:
//   cloud  u32 points, f32 half angle between neighbours (rad), then x y z f32 (m); NaN: none
//   depth  u16 width, u16 height, f32 fx fy cx cy (pixels), f32 metres a unit, then u16 row by row
//          from the upper left, along the optical axis; 0: none
//   ranges u32 points, f32 first, f32 step (rad, left positive, 0 ahead), then f32 (m); infinity:
//          nothing came back; 0, negative, NaN: nothing is known

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/bytes.hpp"
#include "base/result.hpp"
#include "base/sight.hpp"

namespace roverd::cloud {

using base::Bytes;

inline constexpr std::size_t kHeaderSize = 56;
inline constexpr std::uint8_t kVersion = 1;
inline constexpr std::uint32_t kMaxPoints = 1'000'000;
inline constexpr std::size_t kSmallestBody = 8;  ///< a cloud of no point begins with 8 bytes

enum class Kind : std::uint8_t { Cloud = 1, Depth = 2, Ranges = 3 };

struct Header {
  Kind kind = Kind::Cloud;
  bool optical = false;
  bool good = true;
  std::int64_t stamp_ns = 0;
  std::uint32_t sequence = 0;
  std::uint32_t body_size = 0;
  std::uint32_t body_crc = 0;
  std::optional<base::Mount> pose{};  ///< x y z roll pitch yaw, each finite
};

// The bodies; data as they came, `count` or width x height of them.
struct Cloud {
  std::uint32_t count = 0;
  float half_step_rad = 0.0F;  ///< 0: not known; else 0.0001 to 0.2
  Bytes data;                  ///< 12 bytes a point
};
struct Depth {
  std::uint16_t width = 0;
  std::uint16_t height = 0;
  float fx = 0.0F;
  float fy = 0.0F;
  float cx = 0.0F;
  float cy = 0.0F;
  float unit_m = 0.001F;
  Bytes data;  ///< 2 bytes a pixel
};
struct Ranges {
  std::uint32_t count = 0;
  float first_rad = 0.0F;
  float step_rad = 0.0F;
  Bytes data;  ///< 4 bytes a range
};
struct Frame {
  Header header;
  std::variant<Cloud, Depth, Ranges> body;
};

float f32_at(const std::uint8_t* at) noexcept;
std::uint16_t u16_at(const std::uint8_t* at) noexcept;

/// @return why a header is none, in words.
base::Result<Header> decode_header(Bytes header);
/// @param body of header.body_size bytes, its CRC checked. Refused, naming what is wrong: more than
/// max_points, sizes that do not fit, intrinsics, units or steps that are none.
base::Result<Frame> decode_body(const Header& header, Bytes body, std::uint32_t max_points);

/// Sizes and CRCs of the header are filled in. @param bodies: `data` as told above.
std::vector<std::uint8_t> encode(const Header& header, const Cloud& body);
std::vector<std::uint8_t> encode(const Header& header, const Depth& body);
std::vector<std::uint8_t> encode(const Header& header, const Ranges& body);
/// Data of a body: floats, or pixels, to bytes.
std::vector<std::uint8_t> bytes_of(const std::vector<float>& values);
std::vector<std::uint8_t> bytes_of(const std::vector<std::uint16_t>& values);

/// Frames out of a stream, however it is cut. What is no frame is skipped up to the next header; a
/// frame that is too large is let by without being kept. Keeps at most one frame.
class Decoder {
 public:
  explicit Decoder(std::uint32_t max_points) : max_points_(max_points) {}

  /// @param on_frame const Frame&; its bytes are valid during the call.
  template <class OnFrame>
  void feed(Bytes bytes, OnFrame&& on_frame) {
    while (!bytes.empty()) {
      bytes = bytes.subspan(take(bytes));
      if (const auto frame = complete()) on_frame(*frame);
    }
  }
  /// The stream was cut: what comes next belongs to nothing before.
  void forget() noexcept;

  /// Among the refusals: it counts bytes.
  static constexpr const char* kStray = "bytes outside any frame";
  /// Refusals by cause; kStray counts bytes.
  const std::map<std::string, std::uint64_t>& refused() const noexcept { return refused_; }

 private:
  std::size_t take(Bytes bytes);
  std::size_t take_header(Bytes bytes);
  std::optional<Frame> complete();
  std::uint32_t largest_body(Kind kind) const noexcept;

  const std::uint32_t max_points_;
  std::array<std::uint8_t, kHeaderSize> head_{};
  std::size_t head_size_ = 0;
  std::optional<Header> header_;  ///< whose body is awaited
  std::vector<std::uint8_t> body_;
  std::uint64_t let_by_ = 0;  ///< bytes of a refused body that are still to come
  std::map<std::string, std::uint64_t> refused_;
};

}  // namespace roverd::cloud
