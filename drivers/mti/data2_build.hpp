#pragma once
// MTData2 payloads, packet by packet: what the simulated unit and the tests send.

#include <cstdint>
#include <initializer_list>
#include <vector>

#include "mti/data2.hpp"

namespace roverd::mti {

constexpr std::uint16_t xdi_of(Kind kind, Axes axes = Axes::Enu,
                               Format format = Format::Float32) noexcept {
  return static_cast<std::uint16_t>(static_cast<unsigned>(kind) |
                                    static_cast<unsigned>(axes) << 2U |
                                    static_cast<unsigned>(format));
}

class Data2Builder {
 public:
  /// Numbers in the format that the XDI names; fixed-point ones are cut to their range.
  Data2Builder& numbers(std::uint16_t xdi, std::initializer_list<double> values);
  /// @param size 1, 2 or 4 bytes.
  Data2Builder& integer(std::uint16_t xdi, std::uint32_t value, std::size_t size);
  /// A packet as it stands. @param bytes at most 255.
  Data2Builder& bytes(std::uint16_t xdi, Bytes bytes);
  const std::vector<std::uint8_t>& payload() const noexcept { return bytes_; }

 private:
  void head(std::uint16_t xdi, std::size_t size);
  void put(std::uint64_t value, std::size_t size);

  std::vector<std::uint8_t> bytes_;
};

}  // namespace roverd::mti
