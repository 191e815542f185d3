#include "gnss/ubx_setup.hpp"

#include <algorithm>
#include <cmath>

namespace roverd::gnss {
namespace {

using Items = std::vector<ubx::ValSet::Item>;

// Output keys of a message follow the ports: UART1, UART2, USB.
constexpr std::uint32_t kOutPvt = 0x20910007;
constexpr std::uint32_t kOutSatellites = 0x20910016;
constexpr std::uint32_t kOutPrecise = 0x20910034;
constexpr std::uint32_t kOutCov = 0x20910084;
constexpr std::uint32_t kOutRelative = 0x2091008E;
constexpr std::uint32_t kRateMeasure_ms = 0x30210001;
constexpr std::uint32_t kRateNavigate = 0x30210002;
constexpr std::uint32_t kModel = 0x20110021;
constexpr std::uint64_t kAutomotive = 4;

std::uint32_t rtcm3_in(UbxPort port) noexcept {
  switch (port) {
    case UbxPort::Uart1:
      return 0x10730004;
    case UbxPort::Uart2:
      return 0x10750004;
    case UbxPort::Usb:
      return 0x10770004;
  }
  return 0;
}

}  // namespace

std::optional<UbxPort> ubx_port_from(const std::string& word) {
  if (word == "uart1") return UbxPort::Uart1;
  if (word == "uart2") return UbxPort::Uart2;
  if (word == "usb") return UbxPort::Usb;
  return std::nullopt;
}

UbxSetup::UbxSetup(const UbxSetupOptions& options) : options_(options) {
  steps_.push_back({"version", ubx::encode(ubx::Poll{ubx::key::kMonVer}), true});
  if (!options.configure) return;
  const auto port = static_cast<std::uint32_t>(options.port);
  const std::uint8_t layers = options.keep ? 7 : 1;
  const auto request = [&](const char* what, Items items) {
    steps_.push_back({what, ubx::encode(ubx::ValSet{layers, std::move(items)})});
  };
  const auto period_ms = static_cast<std::uint64_t>(std::llround(1000.0 / options.rate_hz));
  request("position", {{kOutPvt + port, 1}, {kRateMeasure_ms, period_ms}, {kRateNavigate, 1}});
  request("precise position", {{kOutPrecise + port, 1}});
  request("covariance", {{kOutCov + port, 1}});
  request("heading", {{kOutRelative + port, 1}});
  // Once a second is enough for a picture of the sky.
  const auto epochs = static_cast<std::uint64_t>(std::lround(std::max(1.0, options.rate_hz)));
  request("satellites", {{kOutSatellites + port, epochs}});
  request("corrections", {{rtcm3_in(options.port), 1}});
  request("model", {{kModel, kAutomotive}});
}

void UbxSetup::begin() {
  at_ = 0;
  tries_ = 0;
  refused_.clear();
  facts_.clear();
}

std::vector<std::uint8_t> UbxSetup::due(bool heard, base::Time now) {
  if (at_ == steps_.size() || !(heard || options_.configure)) return {};
  if (tries_ > 0 && now - asked_ < kPatience) return {};
  if (tries_ == kTries) {
    next("without answer");
    return due(heard, now);
  }
  ++tries_;
  asked_ = now;
  return steps_[at_].bytes;
}

void UbxSetup::add(const ubx::Message& message) {
  if (const auto* version = std::get_if<ubx::MonVer>(&message)) on_version(*version);
  const auto* ack = std::get_if<ubx::Ack>(&message);
  if (ack == nullptr || !(ack->to == ubx::key::kCfgValSet) || at_ == steps_.size()) return;
  if (tries_ > 0 && !steps_[at_].is_poll) next(ack->accepted ? "" : "refused");
}

void UbxSetup::next(const std::string& outcome) {
  if (!outcome.empty()) {
    refused_ += (refused_.empty() ? "" : ", ") + steps_[at_].what + " " + outcome;
  }
  ++at_;
  tries_ = 0;
  if (!options_.configure) return;
  if (at_ < steps_.size()) {
    facts_["configuration"] = "asking for " + steps_[at_].what;
  } else {
    facts_["configuration"] = refused_.empty() ? "accepted" : refused_;
  }
}

void UbxSetup::on_version(const ubx::MonVer& version) {
  const auto fact = [&](const char* name, const std::string& value) {
    if (!value.empty()) facts_[name] = value;
  };
  fact("receiver", version.extension("MOD"));
  fact("firmware", version.extension("FWVER"));
  fact("protocol", version.extension("PROTVER"));
  fact("software", version.software);
  fact("hardware", version.hardware);
  if (at_ < steps_.size() && steps_[at_].is_poll) next("");
}

}  // namespace roverd::gnss
