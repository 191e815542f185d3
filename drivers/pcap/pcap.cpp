#include "pcap/pcap.hpp"

#include <algorithm>
#include <cstdio>

namespace roverd::pcap {
namespace {

constexpr std::uint32_t kMicroseconds = 0xA1B2C3D4;
constexpr std::uint32_t kNanoseconds = 0xA1B23C4D;
constexpr std::uint32_t kNextGeneration = 0x0A0D0D0A;
constexpr std::size_t kRecordHeader = 16;
constexpr std::size_t kIpHeader = 20;
constexpr std::size_t kUdpHeader = 8;
constexpr std::size_t kLargestPayload = 65'535 - kIpHeader - kUdpHeader;
constexpr std::uint8_t kUdp = 17;
constexpr std::uint32_t kRawIp = 101;

std::uint32_t little32(const std::uint8_t* at) noexcept {
  return static_cast<std::uint32_t>(at[0]) | static_cast<std::uint32_t>(at[1]) << 8U |
         static_cast<std::uint32_t>(at[2]) << 16U | static_cast<std::uint32_t>(at[3]) << 24U;
}
std::uint32_t big32(const std::uint8_t* at) noexcept {
  return static_cast<std::uint32_t>(at[3]) | static_cast<std::uint32_t>(at[2]) << 8U |
         static_cast<std::uint32_t>(at[1]) << 16U | static_cast<std::uint32_t>(at[0]) << 24U;
}
/// As in all headers of the internet.
std::uint16_t net16(const std::uint8_t* at) noexcept {
  return static_cast<std::uint16_t>(at[0] << 8U | at[1]);
}
void put_net16(std::uint8_t* at, std::size_t value) noexcept {
  at[0] = static_cast<std::uint8_t>(value >> 8U & 0xFFU);
  at[1] = static_cast<std::uint8_t>(value & 0xFFU);
}
void put_little32(std::uint8_t* at, std::uint64_t value) noexcept {
  for (unsigned i = 0; i < 4; ++i) at[i] = static_cast<std::uint8_t>(value >> (8U * i) & 0xFFU);
}

base::Error wrong(std::uint64_t byte, std::string what) {
  const std::string where = "byte " + std::to_string(byte);
  return {base::Code::Malformed, where + ": " + what, {{where, std::move(what)}}};
}

/// RFC 1071.
std::uint16_t ip_checksum(const std::uint8_t* header) noexcept {
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < kIpHeader; i += 2) sum += net16(header + i);
  while (sum > 0xFFFFU) sum = (sum & 0xFFFFU) + (sum >> 16U);
  return static_cast<std::uint16_t>(~sum & 0xFFFFU);
}

/// After the addresses of an Ethernet frame: its type, behind any VLAN tags.
std::optional<Bytes> behind_type(Bytes frame, std::size_t type_at, const char*& cause) {
  while (frame.size() >= type_at + 2) {
    const std::uint16_t type = net16(frame.data() + type_at);
    if (type == 0x0800) return frame.subspan(type_at + 2);
    if (type != 0x8100 && type != 0x88A8 && type != 0x9100) {
      cause = "not IPv4";
      return {};
    }
    type_at += 4;
  }
  cause = "cut short";
  return {};
}

/// @return false: cause says why it is no whole datagram.
bool read_ip(Bytes ip, Datagram& out, const char*& cause) {
  cause = "cut short";
  if (ip.size() < kIpHeader) return false;
  if (ip[0] >> 4U != 4) {
    cause = "not IPv4";
    return false;
  }
  const std::size_t header = (ip[0] & 0x0FU) * 4U;
  const std::size_t total = net16(ip.data() + 2);
  if (header < kIpHeader || total < header) {
    cause = "a wrong IP header";
    return false;
  }
  if (ip[9] != kUdp) {
    cause = "not UDP";
    return false;
  }
  // More fragments, or not the first.
  if ((net16(ip.data() + 6) & 0x3FFFU) != 0) {
    cause = "fragment";
    return false;
  }
  if (ip.size() < total) return false;
  const Bytes udp = ip.subspan(header, total - header);
  if (udp.size() < kUdpHeader) return false;
  const std::size_t size = net16(udp.data() + 4);
  if (size < kUdpHeader || size > udp.size()) {
    cause = "a wrong UDP length";
    return false;
  }
  std::copy_n(ip.begin() + 12, 4, out.from.ip.begin());
  std::copy_n(ip.begin() + 16, 4, out.to.ip.begin());
  out.from.port = net16(udp.data());
  out.to.port = net16(udp.data() + 2);
  out.payload = udp.subspan(kUdpHeader, size - kUdpHeader);
  return true;
}

}  // namespace

std::string to_string(const Address& a) {
  char text[32];
  std::snprintf(text, sizeof text, "%u.%u.%u.%u:%u", a.ip[0], a.ip[1], a.ip[2], a.ip[3], a.port);
  return text;
}

bool begins_capture(Bytes four) noexcept {
  if (four.size() < 4) return false;
  for (const std::uint32_t magic : {little32(four.data()), big32(four.data())}) {
    if (magic == kMicroseconds || magic == kNanoseconds || magic == kNextGeneration) return true;
  }
  return false;
}

std::uint32_t Reader::u32(const std::uint8_t* at) const noexcept {
  return swapped_ ? big32(at) : little32(at);
}

base::Result<void> Reader::feed(Bytes part) {
  if (broken_) return tl::unexpected(*broken_);
  rest_.insert(rest_.end(), part.begin(), part.end());
  std::size_t done = 0;
  for (;;) {
    const auto used = next(Bytes(rest_).subspan(done));
    if (!used) {
      broken_ = used.error();
      rest_ = {};
      return tl::unexpected(*broken_);
    }
    if (*used == 0) break;
    done += *used;
    at_ += *used;
  }
  rest_.erase(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(done));
  return {};
}

base::Result<void> Reader::finish() const {
  if (broken_) return tl::unexpected(*broken_);
  if (rest_.empty() && started_) return {};
  return tl::unexpected(wrong(at_, started_ ? "the last record is cut" : "no header of a capture"));
}

/// @return how many bytes were read; 0: more are needed.
base::Result<std::size_t> Reader::next(Bytes bytes) {
  if (!started_) {
    if (bytes.size() < kHeaderSize) return 0U;
    if (auto read = read_header(bytes); !read) return tl::unexpected(read.error());
    started_ = true;
    return kHeaderSize;
  }
  if (bytes.size() < kRecordHeader) return 0U;
  const std::uint32_t kept = u32(bytes.data() + 8);
  if (kept > kLargestRecord) {
    return tl::unexpected(wrong(at_ + 8, "a record of " + std::to_string(kept) + " bytes"));
  }
  if (bytes.size() < kRecordHeader + kept) return 0U;
  read_record(u32(bytes.data()), u32(bytes.data() + 4), bytes.subspan(kRecordHeader, kept));
  return kRecordHeader + kept;
}

base::Result<void> Reader::read_header(Bytes header) {
  const std::uint32_t magic = little32(header.data());
  if (magic == kNextGeneration) {
    return tl::unexpected(wrong(0,
                                "pcapng is not read, only classic captures (tcpdump -w, or "
                                "editcap -F pcap)"));
  }
  const std::uint32_t other = big32(header.data());
  swapped_ = other == kMicroseconds || other == kNanoseconds;
  nanoseconds_ = (swapped_ ? other : magic) == kNanoseconds;
  if (!swapped_ && magic != kMicroseconds && magic != kNanoseconds) {
    return tl::unexpected(wrong(0, "not the magic of a capture"));
  }
  link_type_ = u32(header.data() + 20) & 0xFFFFU;
  switch (link_type_) {
    case 1:
    case 12:
    case kRawIp:
    case 113:
    case 228:
    case 276:
      return {};
    default:
      return tl::unexpected(wrong(20, "link type " + std::to_string(link_type_) +
                                          " is not understood (1, 12, 101, 113, 228, 276 are)"));
  }
}

std::optional<Bytes> Reader::network_layer(Bytes frame, const char*& cause) const {
  switch (link_type_) {
    case 1:
      return behind_type(frame, 12, cause);
    case 113:
      return behind_type(frame, 14, cause);
    case 276: {
      // Protocol first, 20 bytes in all.
      if (frame.size() >= 20 && net16(frame.data()) == 0x0800) return frame.subspan(20);
      cause = frame.size() < 20 ? "cut short" : "not IPv4";
      return {};
    }
    default:
      return frame;
  }
}

void Reader::read_record(std::uint32_t seconds, std::uint32_t fraction, Bytes frame) {
  Datagram d;
  // A fraction of more than a second is damage; the datagram need not be.
  const auto ns = std::min<std::int64_t>(
      static_cast<std::int64_t>(fraction) * (nanoseconds_ ? 1 : 1000), 999'999'999);
  d.stamp = base::WallTime{std::chrono::seconds(seconds) + std::chrono::nanoseconds(ns)};
  const char* cause = nullptr;
  const auto ip = network_layer(frame, cause);
  if (ip && read_ip(*ip, d, cause)) return on_datagram_(d);
  ++passed_[cause];
}

std::array<std::uint8_t, kHeaderSize> file_header() noexcept {
  std::array<std::uint8_t, kHeaderSize> out{};
  put_little32(out.data(), kNanoseconds);
  out[4] = 2;
  out[6] = 4;
  put_little32(out.data() + 16, kLargestRecord);
  put_little32(out.data() + 20, kRawIp);
  return out;
}

std::vector<std::uint8_t> record(const Datagram& d) {
  const Bytes payload = d.payload.first(std::min(d.payload.size(), kLargestPayload));
  const std::size_t udp = kUdpHeader + payload.size();
  const std::size_t total = kIpHeader + udp;
  std::vector<std::uint8_t> out(kRecordHeader + total);
  const auto whole = std::chrono::floor<std::chrono::seconds>(d.stamp);
  put_little32(out.data(), static_cast<std::uint64_t>(whole.time_since_epoch().count()));
  put_little32(out.data() + 4, static_cast<std::uint64_t>((d.stamp - whole).count()));
  put_little32(out.data() + 8, total);
  put_little32(out.data() + 12, total);
  std::uint8_t* ip = out.data() + kRecordHeader;
  ip[0] = 0x45;
  put_net16(ip + 2, total);
  ip[6] = 0x40;  // not to be fragmented
  ip[8] = 64;    // hops
  ip[9] = kUdp;
  std::copy(d.from.ip.begin(), d.from.ip.end(), ip + 12);
  std::copy(d.to.ip.begin(), d.to.ip.end(), ip + 16);
  put_net16(ip + 10, ip_checksum(ip));
  std::uint8_t* header = ip + kIpHeader;
  put_net16(header, d.from.port);
  put_net16(header + 2, d.to.port);
  put_net16(header + 4, udp);  // its checksum stays 0: none
  std::copy(payload.begin(), payload.end(), header + kUdpHeader);
  return out;
}

}  // namespace roverd::pcap
