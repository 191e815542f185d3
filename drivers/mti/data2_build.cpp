#include "mti/data2_build.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace roverd::mti {
namespace {

constexpr std::size_t number_bytes(Format format) noexcept {
  constexpr std::array<std::size_t, 4> kBytes{4, 4, 6, 8};
  return kBytes[static_cast<std::size_t>(format)];
}

/// Whole steps of 1/scale within ±limit.
std::int64_t fixed(double value, double scale, double limit) noexcept {
  return std::llround(std::clamp(value, -limit, limit - 1.0 / scale) * scale);
}

}  // namespace

Data2Builder& Data2Builder::numbers(std::uint16_t xdi, std::initializer_list<double> values) {
  const auto format = static_cast<Format>(xdi & 3U);
  head(xdi, values.size() * number_bytes(format));
  for (const double value : values) {
    switch (format) {
      case Format::Float32:
        put(std::bit_cast<std::uint32_t>(static_cast<float>(value)), 4);
        break;
      case Format::Fp1220:
        put(static_cast<std::uint64_t>(fixed(value, 0x1p20, 2048.0)), 4);
        break;
      case Format::Fp1632: {
        const auto all = static_cast<std::uint64_t>(fixed(value, 0x1p32, 32768.0));
        put(all & 0xFFFFFFFFU, 4);
        put(all >> 32U, 2);
        break;
      }
      case Format::Float64:
        put(std::bit_cast<std::uint64_t>(value), 8);
        break;
    }
  }
  return *this;
}

Data2Builder& Data2Builder::integer(std::uint16_t xdi, std::uint32_t value, std::size_t size) {
  head(xdi, size);
  put(value, size);
  return *this;
}

Data2Builder& Data2Builder::bytes(std::uint16_t xdi, Bytes bytes) {
  head(xdi, bytes.size());
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  return *this;
}

void Data2Builder::head(std::uint16_t xdi, std::size_t size) {
  put(xdi, 2);
  put(size, 1);
}

void Data2Builder::put(std::uint64_t value, std::size_t size) {
  for (std::size_t i = size; i-- > 0;) {
    bytes_.push_back(static_cast<std::uint8_t>(value >> (8 * i) & 0xFFU));
  }
}

}  // namespace roverd::mti
