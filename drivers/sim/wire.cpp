#include "sim/wire.hpp"

#include <string>

#include "ackermann/codec.hpp"
#include "ratio/codec.hpp"
#include "twist/binary.hpp"
#include "twist/text.hpp"

namespace roverd::sim {
namespace {

using ByteVector = std::vector<std::uint8_t>;

class AckermannWire final : public Wire {
 public:
  int receive(base::Bytes datagram) override {
    const ackermann::Decoded d = ackermann::decode(datagram);
    if (d.fault != ackermann::Fault::None) return 0;
    order_ = {};
    order_.drive = d.message.mode == ackermann::DriveMode::Autonomous;
    order_.speed_mps = d.message.speed_mps;
    order_.wheel_rad = d.message.wheel_rad;
    return 1;
  }
  const Order& order() const noexcept override { return order_; }
  ByteVector report(const Condition& c) override {
    using ackermann::DriveMode;
    const DriveMode mode = c.by_hand   ? DriveMode::Remote
                           : c.obeying ? DriveMode::Autonomous
                                       : DriveMode::Park;
    const auto out = ackermann::encode(
        {static_cast<float>(c.twist.linear_mps), static_cast<float>(c.wheel_rad), mode});
    return {out.begin(), out.end()};
  }
  void forget() override { order_ = {}; }

 private:
  Order order_;
};

/// Knows neither enable nor modes: every line is obeyed.
class RatioWire final : public Wire {
 public:
  explicit RatioWire(double track_width_m) : track_width_m_(track_width_m) {}

  int receive(base::Bytes bytes) override {
    int count = 0;
    decoder_.feed(bytes, [&](const ratio::Message& m) {
      ++count;
      order_.drive = true;
      order_.twist = ratio::to_twist(m, track_width_m_);
    });
    return count;
  }
  const Order& order() const noexcept override { return order_; }
  ByteVector report(const Condition& c) override {
    const std::string line = ratio::encode(ratio::from_twist(c.twist, track_width_m_));
    return {line.begin(), line.end()};
  }
  void forget() override {
    order_ = {};
    decoder_.forget();
  }

 private:
  const double track_width_m_;
  ratio::Decoder decoder_;
  Order order_;
};

class TwistWire final : public Wire {
 public:
  explicit TwistWire(bool binary) : binary_(binary) {}

  int receive(base::Bytes bytes) override {
    int count = 0;
    const auto take = [&](const twist::Said& said) {
      const auto* c = std::get_if<twist::Command>(&said);
      if (c == nullptr) return;
      ++count;
      ack_ = c->seq;
      order_.drive = c->enable;
      order_.twist = {c->speed_mps, c->turn_radps};
    };
    if (binary_) {
      frames_.feed(bytes, take);
    } else {
      lines_.feed(bytes, take);
    }
    return count;
  }
  const Order& order() const noexcept override { return order_; }
  ByteVector report(const Condition& c) override {
    twist::Feedback f;
    f.seq = seq_++;
    f.ack = ack_;
    f.speed_mps = c.twist.linear_mps;
    f.turn_radps = c.twist.angular_radps;
    f.left_m = c.left_m;
    f.right_m = c.right_m;
    f.battery_v = c.battery_v;
    f.status = status(c);
    f.estop = c.estop;
    if (binary_) return twist::encode_binary(f);
    const std::string line = twist::encode_text(f);
    return {line.begin(), line.end()};
  }
  void forget() override {
    order_ = {};
    seq_ = ack_ = 0;
    lines_.forget();
    frames_.forget();
  }

 private:
  static std::uint8_t status(const Condition& c) noexcept {
    unsigned bits = 0;
    if (c.obeying) bits |= twist::kObeying;
    if (c.watchdog) bits |= twist::kWatchdog;
    if (c.motor_fault) bits |= twist::kMotorFault;
    if (c.low_battery) bits |= twist::kLowBattery;
    if (c.by_hand) bits |= twist::kByHand;
    return static_cast<std::uint8_t>(bits);
  }

  const bool binary_;
  twist::TextDecoder lines_;
  twist::BinaryDecoder frames_;
  std::uint8_t seq_ = 0;
  std::uint8_t ack_ = 0;
  Order order_;
};

}  // namespace

std::unique_ptr<Wire> make_wire(std::string_view word, double track_width_m) {
  if (word == "ackermann") return std::make_unique<AckermannWire>();
  if (word == "ratio") return std::make_unique<RatioWire>(track_width_m);
  return std::make_unique<TwistWire>(word == "twist_binary");
}

}  // namespace roverd::sim
