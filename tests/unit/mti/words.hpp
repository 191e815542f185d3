#pragma once
// A unit's messages, put together for the driver's tests.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/angle.hpp"
#include "base/measurements.hpp"
#include "mti/data2_build.hpp"
#include "mti/rotation.hpp"
#include "mti/xbus.hpp"

namespace roverd::mti {

inline constexpr std::uint32_t kHealthy = 0x0000'0003;  // self-test, orientation
inline constexpr std::uint32_t kWithFix = 0x0180'0007;  // and a GNSS fix in the filter

/// One message at 100 Hz, standing level, facing the local frame's x axis.
struct Word {
  std::uint32_t count = 0;  ///< of 100 us
  std::uint16_t number = 0;
  std::uint32_t status = kHealthy;
  Vec3 rate{0.0, 0.0, 0.0};
  Vec3 accel{0.0, 0.0, 9.81};

  Data2Builder builder() const {
    Data2Builder b;
    b.integer(xdi_of(Kind::PacketCounter), number, 2)
        .integer(xdi_of(Kind::SampleTimeFine), count, 4)
        .integer(xdi_of(Kind::StatusWord), status, 4)
        .numbers(xdi_of(Kind::Acceleration), {accel[0], accel[1], accel[2]})
        .numbers(xdi_of(Kind::RateOfTurn), {rate[0], rate[1], rate[2]});
    return b;
  }
};

inline Data2Builder& with_orientation(Data2Builder& b, Axes axes, const Mat3& R_LS) {
  const auto q = to_quaternion(R_LS);
  return b.numbers(xdi_of(Kind::Quaternion, axes), {q[0], q[1], q[2], q[3]});
}

template <class M>
std::vector<M> all_of(const std::vector<base::Measurement>& heard) {
  std::vector<M> out;
  for (const auto& m : heard) {
    if (const auto* one = std::get_if<M>(&m)) out.push_back(*one);
  }
  return out;
}

}  // namespace roverd::mti
