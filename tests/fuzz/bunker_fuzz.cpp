// Any frame through the decoder, the encoders, the odometry and the gate.

#include <cstdlib>
#include <cstring>
#include <variant>

#include "bunker/codec.hpp"
#include "bunker/interpreter.hpp"
#include "bunker/odometry.hpp"
#include "bunker/plausible.hpp"
#include "bunker/v1.hpp"
#include "gate/gate.hpp"

namespace {

using namespace roverd;

void check(bool truth) {
  if (!truth) std::abort();
}

/// Flags, id and length from the first bytes, then data: 12 bytes a frame.
base::CanFrame frame_from(const std::uint8_t* p) {
  base::CanFrame f;
  f.id = (static_cast<std::uint32_t>(p[0] & 7U) << 8U) | p[1];
  f.extended = (p[0] & 0x10U) != 0;
  f.remote = (p[0] & 0x20U) != 0;
  f.error = (p[0] & 0x40U) != 0;
  f.len = p[2] % 9;
  std::memcpy(f.data.data(), p + 4, 8);
  return f;
}

/// Half of them with the checksum of V1, which chance would hardly find.
base::CanFrame sealed(base::CanFrame f) {
  if ((f.data[6] & 1U) != 0) f.data[7] = bunker::v1_checksum(f);
  return f;
}

struct Encode {
  base::CanFrame operator()(std::monostate) const { return {}; }
  template <class M>
  base::CanFrame operator()(const M& m) const {
    return encode(m);
  }
};

/// Decodes, and what was decoded must say the same again.
template <class Decode>
auto there_and_back(const base::CanFrame& f, Decode decode) {
  const auto d = decode(f);
  check((d.verdict == bunker::Verdict::Decoded) == (d.message.index() != 0));
  if (d.verdict != bunker::Verdict::Decoded) return d;
  const base::CanFrame again = std::visit(Encode{}, d.message);
  check(again.id == f.id && again.len == 8);
  const auto twice = decode(again);
  check(twice.message.index() == d.message.index());
  check(std::visit(Encode{}, twice.message) == again);
  return d;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  gate::Gate gate{gate::bunker({})};
  gate.permit(true);
  bunker::Odometry odometry(4.0);
  bunker::Interpreter interpreter(bunker::kErrorBits, [](const base::Measurement&) {});
  base::Time now{};
  for (; size >= 12; data += 12, size -= 12) {
    const base::CanFrame f = frame_from(data);
    now += std::chrono::milliseconds(data[3]);
    gate.saw(f, now);
    const bool may = gate.allows(f, now);
    check(!may || f.id == 0x111 || f.id == 0x421 || f.id == 0x441 || f.id == 0x121 ||
          f.id == 0x130 || f.id == 0x140 || f.id == 0x411 || f.id == 0x4A1);
    const auto old = there_and_back(sealed(f), [](const auto& x) { return bunker::v1::decode(x); });
    interpreter.take(old.message, base::ControlMode::Can, now);
    bunker::impossible(old.message, 4.0);
    const auto d = there_and_back(f, [](const auto& x) { return bunker::decode(x); });
    interpreter.take(d.message, now);
    bunker::impossible(d.message, 4.0);
    if (const auto* s = std::get_if<bunker::SystemState>(&d.message)) {
      check(bunker::error_bits(s->error_code).size <= 16);
    }
    if (const auto* o = std::get_if<bunker::Odometer>(&d.message)) odometry.add(*o, now);
  }
  return 0;
}
