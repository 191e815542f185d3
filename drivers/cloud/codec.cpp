#include "cloud/codec.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include <zlib.h>

namespace roverd::cloud {
namespace {

constexpr std::array<std::uint8_t, 4> kMagic{'R', 'V', 'S', 'C'};
constexpr unsigned kPoseTold = 1;
constexpr unsigned kOptical = 2;
constexpr unsigned kNotGood = 4;
/// In 2096, where the clock is UTC: differences of stamps do not overflow.
constexpr std::uint64_t kLastStamp_ns = 4'000'000'000'000'000'000;
constexpr float kLeastHalf_rad = 1e-4F;
constexpr float kMostHalf_rad = 0.2F;
constexpr std::size_t kCloudHead = 8;
constexpr std::size_t kDepthHead = 24;
constexpr std::size_t kRangesHead = 12;

std::uint32_t u32_at(const std::uint8_t* at) noexcept {
  return static_cast<std::uint32_t>(at[0]) | static_cast<std::uint32_t>(at[1]) << 8U |
         static_cast<std::uint32_t>(at[2]) << 16U | static_cast<std::uint32_t>(at[3]) << 24U;
}
std::uint64_t u64_at(const std::uint8_t* at) noexcept {
  return u32_at(at) | static_cast<std::uint64_t>(u32_at(at + 4)) << 32U;
}
std::uint32_t crc_of(Bytes bytes) noexcept {
  return static_cast<std::uint32_t>(::crc32_z(0, bytes.data(), bytes.size()));
}

tl::unexpected<base::Error> malformed(std::string what) {
  return base::fail(base::Code::Malformed, std::move(what));
}

/// Appends little endian.
struct Put {
  std::vector<std::uint8_t>& out;
  void u16(std::uint16_t v) const {
    out.push_back(static_cast<std::uint8_t>(v & 0xFFU));
    out.push_back(static_cast<std::uint8_t>(v >> 8U));
  }
  void u32(std::uint32_t v) const {
    for (unsigned i = 0; i < 4; ++i) out.push_back(static_cast<std::uint8_t>(v >> 8U * i & 0xFFU));
  }
  void f32(float v) const { u32(std::bit_cast<std::uint32_t>(v)); }
};

std::vector<std::uint8_t> framed(const Header& h, Kind kind, const std::vector<std::uint8_t>& head,
                                 Bytes data) {
  std::vector<std::uint8_t> body = head;
  body.insert(body.end(), data.begin(), data.end());
  std::vector<std::uint8_t> out(kMagic.begin(), kMagic.end());
  out.reserve(kHeaderSize + body.size());
  const Put put{out};
  out.push_back(kVersion);
  out.push_back(static_cast<std::uint8_t>(kind));
  put.u16(static_cast<std::uint16_t>((h.pose ? kPoseTold : 0U) | (h.optical ? kOptical : 0U) |
                                     (h.good ? 0U : kNotGood)));
  const auto stamp = static_cast<std::uint64_t>(h.stamp_ns);
  put.u32(static_cast<std::uint32_t>(stamp & 0xFFFFFFFFU));
  put.u32(static_cast<std::uint32_t>(stamp >> 32U));
  put.u32(h.sequence);
  put.u32(static_cast<std::uint32_t>(body.size()));
  const base::Mount pose = h.pose.value_or(base::Mount{});
  for (const double v :
       {pose.x_m, pose.y_m, pose.z_m, pose.roll_rad, pose.pitch_rad, pose.yaw_rad}) {
    put.f32(static_cast<float>(v));
  }
  put.u32(crc_of(body));
  put.u32(crc_of(out));
  out.insert(out.end(), body.begin(), body.end());
  return out;
}

/// A body's data: as many as its head says, no more, no fewer.
base::Result<Bytes> data_of(Bytes body, std::size_t head, std::uint64_t count, std::size_t each,
                            std::uint32_t max_points) {
  if (count > max_points) return malformed("more than " + std::to_string(max_points) + " points");
  if (body.size() != head + count * each) {
    return malformed("the body's size does not fit its number of points");
  }
  return body.subspan(head);
}

base::Result<Cloud> cloud_of(Bytes body, std::uint32_t max_points) {
  if (body.size() < kCloudHead) return malformed("a cloud without its 8 bytes of head");
  Cloud out;
  out.count = u32_at(body.data());
  out.half_step_rad = f32_at(body.data() + 4);
  // What lies between two rays counts as seen: none is as wide as a barn door, nor as a hair.
  const float half_rad = out.half_step_rad;
  if (half_rad != 0.0F && !(half_rad >= kLeastHalf_rad && half_rad <= kMostHalf_rad)) {
    return malformed("half_step_rad of a cloud must be 0 or lie in 0.0001 .. 0.2");
  }
  const auto data = data_of(body, kCloudHead, out.count, 12, max_points);
  if (!data) return tl::unexpected(data.error());
  out.data = *data;
  return out;
}

base::Result<Depth> depth_of(Bytes body, std::uint32_t max_points) {
  if (body.size() < kDepthHead) return malformed("a depth image without its 24 bytes of head");
  const std::uint8_t* at = body.data();
  Depth out{u16_at(at),      u16_at(at + 2),  f32_at(at + 4),  f32_at(at + 8),
            f32_at(at + 12), f32_at(at + 16), f32_at(at + 20), {}};
  const auto focal = [](float v) { return std::isfinite(v) && v >= 1.0F; };
  const auto middle = [](float v) { return std::abs(v) <= 65'536.0F; };
  if (!focal(out.fx) || !focal(out.fy)) {
    return malformed("fx and fy of a depth image must be 1 or more");
  }
  if (!middle(out.cx) || !middle(out.cy)) {
    return malformed("cx and cy of a depth image must lie in -65536 .. 65536");
  }
  if (!(out.unit_m >= 1e-5F && out.unit_m <= 0.1F)) {
    return malformed("unit_m of a depth image must lie in 0.00001 .. 0.1");
  }
  const std::uint64_t pixels = std::uint64_t{out.width} * out.height;
  const auto data = data_of(body, kDepthHead, pixels, 2, max_points);
  if (!data) return tl::unexpected(data.error());
  out.data = *data;
  return out;
}

base::Result<Ranges> ranges_of(Bytes body, std::uint32_t max_points) {
  if (body.size() < kRangesHead) return malformed("ranges without their 12 bytes of head");
  Ranges out;
  out.count = u32_at(body.data());
  out.first_rad = f32_at(body.data() + 4);
  out.step_rad = f32_at(body.data() + 8);
  if (!(std::abs(out.first_rad) <= 7.0F)) {
    return malformed("first_rad of ranges must lie in -7 .. 7");
  }
  if (!(std::abs(out.step_rad) <= 3.2F) || out.step_rad == 0.0F) {
    return malformed("step_rad of ranges must lie in -3.2 .. 3.2 and not be 0");
  }
  const auto data = data_of(body, kRangesHead, out.count, 4, max_points);
  if (!data) return tl::unexpected(data.error());
  out.data = *data;
  return out;
}

/// A header of this version, whole, though one of its values is none: where its body ends is known.
bool told_its_body(Bytes header) noexcept {
  return u32_at(header.data() + 52) == crc_of(header.first(52)) && header[4] == kVersion;
}

}  // namespace

float f32_at(const std::uint8_t* at) noexcept {
  return std::bit_cast<float>(u32_at(at));
}
std::uint16_t u16_at(const std::uint8_t* at) noexcept {
  return static_cast<std::uint16_t>(at[0] | at[1] << 8U);
}

base::Result<Header> decode_header(Bytes bytes) {
  if (bytes.size() < kHeaderSize || !std::equal(kMagic.begin(), kMagic.end(), bytes.begin())) {
    return malformed("no header");
  }
  const std::uint8_t* at = bytes.data();
  if (u32_at(at + 52) != crc_of(bytes.first(52))) return malformed("a header with a wrong CRC");
  if (at[4] != kVersion) return malformed("version " + std::to_string(at[4]) + ", not 1");
  if (at[5] < 1 || at[5] > 3) return malformed("unknown kind " + std::to_string(at[5]));
  Header out;
  out.kind = static_cast<Kind>(at[5]);
  const unsigned flags = u16_at(at + 6);
  out.optical = (flags & kOptical) != 0;
  out.good = (flags & kNotGood) == 0;
  const std::uint64_t stamp_ns = u64_at(at + 8);
  if (stamp_ns > kLastStamp_ns) return malformed("a stamp that is none");
  out.stamp_ns = static_cast<std::int64_t>(stamp_ns);
  out.sequence = u32_at(at + 16);
  out.body_size = u32_at(at + 20);
  out.body_crc = u32_at(at + 48);
  if ((flags & kPoseTold) != 0) {
    std::array<float, 6> p{};
    for (std::size_t i = 0; i < p.size(); ++i) p[i] = f32_at(at + 24 + 4 * i);
    const bool possible =
        std::all_of(p.begin(), p.end(), [](float v) { return std::abs(v) <= 100.0F; });
    if (!possible) return malformed("a pose that is none");
    out.pose = base::Mount{p[0], p[1], p[2], p[3], p[4], p[5]};
  }
  return out;
}

base::Result<Frame> decode_body(const Header& header, Bytes body, std::uint32_t max_points) {
  const auto framed_as = [&](auto parsed) -> base::Result<Frame> {
    if (!parsed) return tl::unexpected(parsed.error());
    return Frame{header, *parsed};
  };
  switch (header.kind) {
    case Kind::Cloud:
      return framed_as(cloud_of(body, max_points));
    case Kind::Depth:
      return framed_as(depth_of(body, max_points));
    case Kind::Ranges:
      return framed_as(ranges_of(body, max_points));
  }
  return malformed("unknown kind");
}

std::vector<std::uint8_t> encode(const Header& header, const Cloud& body) {
  std::vector<std::uint8_t> head;
  const Put put{head};
  put.u32(body.count);
  put.f32(body.half_step_rad);
  return framed(header, Kind::Cloud, head, body.data);
}

std::vector<std::uint8_t> encode(const Header& header, const Depth& body) {
  std::vector<std::uint8_t> head;
  const Put put{head};
  put.u16(body.width);
  put.u16(body.height);
  for (const float v : {body.fx, body.fy, body.cx, body.cy, body.unit_m}) put.f32(v);
  return framed(header, Kind::Depth, head, body.data);
}

std::vector<std::uint8_t> encode(const Header& header, const Ranges& body) {
  std::vector<std::uint8_t> head;
  const Put put{head};
  put.u32(body.count);
  put.f32(body.first_rad);
  put.f32(body.step_rad);
  return framed(header, Kind::Ranges, head, body.data);
}

std::vector<std::uint8_t> bytes_of(const std::vector<float>& values) {
  std::vector<std::uint8_t> out;
  out.reserve(values.size() * 4);
  for (const float v : values) Put{out}.f32(v);
  return out;
}
std::vector<std::uint8_t> bytes_of(const std::vector<std::uint16_t>& values) {
  std::vector<std::uint8_t> out;
  out.reserve(values.size() * 2);
  for (const std::uint16_t v : values) Put{out}.u16(v);
  return out;
}

void Decoder::forget() noexcept {
  head_size_ = 0;
  header_.reset();
  body_.clear();
  let_by_ = 0;
}

std::uint32_t Decoder::largest_body(Kind kind) const noexcept {
  switch (kind) {
    case Kind::Cloud:
      return static_cast<std::uint32_t>(kCloudHead) + 12 * max_points_;
    case Kind::Depth:
      return static_cast<std::uint32_t>(kDepthHead) + 2 * max_points_;
    case Kind::Ranges:
      return static_cast<std::uint32_t>(kRangesHead) + 4 * max_points_;
  }
  return 0;
}

/// @return how many of the bytes were used, at least one.
std::size_t Decoder::take(Bytes bytes) {
  if (let_by_ > 0) {
    const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(let_by_, bytes.size()));
    let_by_ -= n;
    return n;
  }
  if (!header_) return take_header(bytes);
  const std::size_t n = std::min(bytes.size(), header_->body_size - body_.size());
  body_.insert(body_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n));
  return n;
}

std::size_t Decoder::take_header(Bytes bytes) {
  const std::size_t n = std::min(bytes.size(), kHeaderSize - head_size_);
  std::copy_n(bytes.begin(), n, head_.begin() + static_cast<std::ptrdiff_t>(head_size_));
  head_size_ += n;
  // What cannot be the beginning of a header goes, one byte after the other.
  const auto drop = [this](std::size_t count) {
    std::copy(head_.begin() + static_cast<std::ptrdiff_t>(count),
              head_.begin() + static_cast<std::ptrdiff_t>(head_size_), head_.begin());
    head_size_ -= count;
    refused_[kStray] += count;
  };
  const auto begins_at = [this](std::size_t at) {
    const std::size_t known = std::min(head_size_ - at, kMagic.size());
    return std::equal(kMagic.begin(), kMagic.begin() + static_cast<std::ptrdiff_t>(known),
                      head_.begin() + static_cast<std::ptrdiff_t>(at));
  };
  const auto find_begin = [&](std::size_t from) {
    while (from < head_size_ && !begins_at(from)) ++from;
    return from;
  };
  if (const std::size_t begin = find_begin(0); begin > 0) drop(begin);
  if (head_size_ < kHeaderSize) return n;
  auto header = decode_header(head_);
  if (!header) {
    ++refused_[header.error().detail];
    if (told_its_body(head_)) {
      let_by_ = u32_at(head_.data() + 20);
      head_size_ = 0;
    } else {
      drop(find_begin(1));
    }
    return n;
  }
  head_size_ = 0;
  if (header->body_size > largest_body(header->kind)) {
    ++refused_["more than " + std::to_string(max_points_) + " points"];
    let_by_ = header->body_size;
  } else if (header->body_size < kSmallestBody) {
    ++refused_["a body without its head"];
    let_by_ = header->body_size;
  } else {
    header_ = *header;
    body_.clear();
  }
  return n;
}

std::optional<Frame> Decoder::complete() {
  if (!header_ || body_.size() < header_->body_size) return {};
  const Header header = *header_;
  header_.reset();
  if (crc_of(body_) != header.body_crc) {
    ++refused_["a body with a wrong CRC"];
    return {};
  }
  auto frame = decode_body(header, body_, max_points_);
  if (frame) return *frame;
  ++refused_[frame.error().detail];
  return {};
}

}  // namespace roverd::cloud
