// Any bytes through framer and MTData2; cut elsewhere they give the same messages, and no number
// comes out that is none. Then as an MTi at the driver's port: what it tells is finite and on
// earth.

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "link/memory.hpp"
#include "mti/data2.hpp"
#include "mti/driver.hpp"

namespace {

using namespace roverd;

void check(bool truth) {
  if (!truth) std::abort();
}

void check_data(base::Bytes payload) {
  const mti::Data2 data = mti::decode_data2(payload);
  check(data.whole || data.packets.empty());
  for (const mti::Packet& p : data.packets) {
    const bool told = !std::holds_alternative<std::monostate>(p.value);
    check(told == (p.fault == mti::Fault::None));
    if (const auto* n = std::get_if<mti::Numbers>(&p.value)) {
      for (std::size_t i = 0; i < n->size; ++i) check(std::isfinite((*n)[i]));
    }
    if (const auto* pvt = std::get_if<mti::GnssPvt>(&p.value)) check(base::is_valid(pvt->at));
  }
}

std::uint64_t run(base::Bytes bytes, std::size_t piece) {
  mti::Framer framer;
  const auto take = [](const mti::Message& m) {
    check(m.payload.size() <= mti::kMaxPayload);
    if (m.mid == mti::mid::kMtData2) check_data(m.payload);
    mti::outputs_of(m.payload);
  };
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    framer.feed(bytes.subspan(at, std::min(piece, bytes.size() - at)), take);
  }
  framer.give_up(take);
  return framer.counts().messages;
}

void check_told(const base::Measurement& m) {
  const auto finite = [](double v) { check(std::isfinite(v)); };
  if (const auto* fix = std::get_if<base::GnssFix>(&m)) {
    check(!fix->position || base::is_valid(*fix->position));
  } else if (const auto* inertial = std::get_if<base::Inertial>(&m)) {
    if (inertial->rate_radps) finite(inertial->rate_radps->up + inertial->rate_radps->forward);
    if (inertial->accel_mps2) finite(inertial->accel_mps2->up + inertial->accel_mps2->left);
  } else if (const auto* lean = std::get_if<base::Attitude>(&m)) {
    finite(lean->roll_rad + lean->pitch_rad);
  } else if (const auto* heading = std::get_if<base::Heading>(&m)) {
    finite(heading->yaw_rad);
  } else if (const auto* velocity = std::get_if<base::GnssVelocity>(&m)) {
    finite(velocity->east_mps + velocity->north_mps);
  }
}

void drive(base::Bytes bytes, unsigned choice) {
  mti::Params params;
  params.configure = (choice & 1U) != 0;
  params.heading = (choice & 2U) != 0 ? "orientation" : "field";
  params.position = (choice & 4U) != 0 ? "filter" : "gnss";
  params.arm_forward_m = 0.5;
  auto wire = link::memory_byte_pair();
  mti::Driver driver(
      "mti", params,
      [&wire] { return base::Result<std::unique_ptr<link::ByteLink>>(std::move(wire.a)); },
      check_told);
  base::Time now{std::chrono::seconds(10)};
  wire.b->set_immediate([&now] { return now; });
  check(wire.b->open().has_value());
  driver.start(now);
  const std::size_t piece = choice / 8U + 1U;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    now += std::chrono::milliseconds(10);
    wire.b->write(bytes.subspan(at, std::min(piece, bytes.size() - at)));
    driver.tick(now);
  }
  now += std::chrono::seconds(2);
  driver.tick(now);
  // As the payload of a message, for the checksum hides it from the fuzzer.
  if (bytes.size() <= mti::kMaxPayload) wire.b->write(mti::encode(mti::mid::kMtData2, bytes));
  driver.stop(now);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const base::Bytes bytes(data + 1, size - 1);
  check(run(bytes, std::max<std::size_t>(bytes.size(), 1)) == run(bytes, data[0] % 64U + 1U));
  check_data(bytes);  // the checksum hides this from the fuzzer
  drive(bytes, data[0]);
  return 0;
}
