// Any bytes as datagrams of a VLP-16: what is read is written as the same, every point of every
// turn is finite and within range, time goes on, and no turn grows without end.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "velodyne/revolutions.hpp"

namespace {

using namespace roverd;

void check(bool truth) {
  if (!truth) std::abort();
}

void check_turn(const velodyne::Turn& turn) {
  const auto& sight = *turn.sight;
  check(sight.points.size() <= 320'000);
  check(turn.missing <= 2U * turn.firings);
  for (const base::SightPoint& p : sight.points) {
    const float range_m = std::hypot(p.x_m, p.y_m, p.z_m);
    check(std::isfinite(range_m) && range_m < 131.1F);
    check(p.after_s >= 0.0F && std::isfinite(p.after_s));
    check(p.ring < 16);
  }
}

/// Makes most inputs to packets that pass: the rest of each is the fuzzer's.
void mend(std::array<std::uint8_t, velodyne::kPacketSize>& bytes, std::uint32_t stamp_us) {
  for (std::size_t b = 0; b < velodyne::kBlocks; ++b) {
    bytes[b * 100] = 0xFF;
    bytes[b * 100 + 1] = 0xEE;
    bytes[b * 100 + 3] = static_cast<std::uint8_t>(bytes[b * 100 + 3] % 0x8CU);
  }
  for (unsigned i = 0; i < 4; ++i) {
    bytes[1200 + i] = static_cast<std::uint8_t>(stamp_us >> 8U * i & 0xFFU);
  }
  bytes[1204] = static_cast<std::uint8_t>(0x37U + bytes[1204] % 3U);
  bytes[1205] = bytes[1205] % 8U == 0 ? 0x24 : 0x22;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const base::Bytes all(data, size);
  static_cast<void>(velodyne::describe(velodyne::decode(all)));
  const auto position = velodyne::decode_position(all);
  if (position.fault == velodyne::Fault::None) {
    check(velodyne::decode_position(velodyne::encode(position.position)).position ==
          position.position);
  }
  if (size < 2) return 0;
  velodyne::Params params;
  params.clear_to_m = data[0] % 2 == 0 ? 0.0 : 10.0;
  velodyne::Revolutions revolutions("fuzz", params, check_turn);
  base::Time now{std::chrono::hours(1)};
  std::uint32_t stamp_us = 0;
  for (std::size_t at = 2; at < size && at < 20'000; at += 200) {
    std::array<std::uint8_t, velodyne::kPacketSize> bytes{};
    const std::size_t n = std::min(bytes.size(), size - at);
    std::memcpy(bytes.data(), data + at, n);
    if (data[1] % 4 != 0) {
      stamp_us = (stamp_us + 1327U * data[at]) % velodyne::kHour_us;
      mend(bytes, stamp_us);
    }
    const velodyne::Decoded decoded = velodyne::decode(bytes);
    if (decoded.fault != velodyne::Fault::None) continue;
    check(velodyne::encode(decoded.packet) == bytes);
    now += std::chrono::microseconds(1327) * (data[at + n - 1] % 4U);
    revolutions.add(decoded.packet, now);
  }
  revolutions.finish();
  return 0;
}
