#pragma once
// Captures of a network in the classic file format of libpcap, as far as datagrams of IPv4 over UDP
// go: read in pieces of any size, and written. Pure; bounded: at most one record is kept.
//
// File: magic A1B2C3D4 (microseconds) or A1B23C4D (nanoseconds) in either byte order, version 2.4,
// zone, accuracy, snapshot length, link type; then records of seconds, fraction, kept and true
// length, frame. Link types: 1 Ethernet (with VLAN tags), 12 and 101 raw IP, 113 and 276 Linux
// "cooked", 228 IPv4. The newer pcapng is refused by name.

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/bytes.hpp"
#include "base/result.hpp"
#include "base/time.hpp"

namespace roverd::pcap {

using base::Bytes;

inline constexpr std::size_t kHeaderSize = 24;
/// Of a record; what claims more is no capture.
inline constexpr std::uint32_t kLargestRecord = 262'144;

struct Address {
  std::array<std::uint8_t, 4> ip{};  ///< 192.168.1.201: {192, 168, 1, 201}
  std::uint16_t port = 0;
  friend bool operator==(const Address&, const Address&) = default;
};
std::string to_string(const Address& a);  // 192.168.1.201:2368

struct Datagram {
  base::WallTime stamp;
  Address from;
  Address to;
  Bytes payload;  ///< valid during the call
};

/// Are these the first bytes of a capture, classic or pcapng? @param four at least 4 bytes.
bool begins_capture(Bytes four) noexcept;

class Reader {
 public:
  using OnDatagram = std::function<void(const Datagram&)>;
  explicit Reader(OnDatagram on_datagram) : on_datagram_(std::move(on_datagram)) {}

  /// @return what is wrong with the file, naming the byte; nothing after it is read.
  base::Result<void> feed(Bytes part);
  /// No more will come. @return Malformed when a record is cut.
  base::Result<void> finish() const;

  /// Records that hold no whole datagram, by cause: "not IPv4", "not UDP", "fragment".
  const std::map<std::string, std::uint64_t>& passed_over() const noexcept { return passed_; }

 private:
  base::Result<std::size_t> next(Bytes bytes);
  base::Result<void> read_header(Bytes header);
  void read_record(std::uint32_t seconds, std::uint32_t fraction, Bytes frame);
  /// @return what follows the headers of the link; empty: cause() says why there is none.
  std::optional<Bytes> network_layer(Bytes frame, const char*& cause) const;
  std::uint32_t u32(const std::uint8_t* at) const noexcept;

  const OnDatagram on_datagram_;
  std::vector<std::uint8_t> rest_;
  std::uint64_t at_ = 0;  ///< of rest_ in the file
  bool started_ = false;
  bool swapped_ = false;
  bool nanoseconds_ = false;
  std::uint32_t link_type_ = 0;
  std::optional<base::Error> broken_;
  std::map<std::string, std::uint64_t> passed_;
};

/// The beginning of a file of raw IP frames with nanoseconds, little endian.
std::array<std::uint8_t, kHeaderSize> file_header() noexcept;
/// One record to append. @param d payload: at most 65507 bytes, what is longer is cut; the stamp
/// not before 1970.
std::vector<std::uint8_t> record(const Datagram& d);

}  // namespace roverd::pcap
