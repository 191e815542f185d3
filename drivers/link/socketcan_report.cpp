// The half of the SocketCAN link that watches the interface itself.

#include <array>
#include <cstdio>

#include "link/can_control.hpp"
#include "link/socketcan.hpp"

namespace roverd::link {
namespace {

constexpr base::Duration kRefresh = std::chrono::seconds(1);
/// A bus that is off this long was not restarted by the kernel.
constexpr base::Duration kBusOffPatience = std::chrono::seconds(1);
/// A frame takes a quarter of a millisecond; the queue before it a few.
constexpr base::Duration kLateConfirmation = std::chrono::milliseconds(200);
/// Between a frame's arrival and our reading it: half a tick of the control loop.
constexpr base::Duration kLateReading = std::chrono::milliseconds(10);

void add_state(const CanState& state, std::map<std::string, std::string>& facts) {
  facts["can_interface"] = !state.exists ? "missing" : state.up ? "up" : "down";
  if (!state.exists) return;
  facts["can_kind"] = state.kind;
  if (state.controller) facts["can_state"] = to_string(*state.controller);
  if (state.tx_errors) facts["can_tx_errors"] = std::to_string(*state.tx_errors);
  if (state.rx_errors) facts["can_rx_errors"] = std::to_string(*state.rx_errors);
  if (state.bitrate) facts["can_bitrate"] = std::to_string(*state.bitrate);
  if (state.restart_ms) facts["can_restart_ms"] = std::to_string(*state.restart_ms);
}

std::string words_of(CanFaults faults) {
  std::string out;
  for (std::size_t i = 0; i < kCanFaultWords.size(); ++i) {
    if ((faults >> i & 1U) == 0) continue;
    out += (out.empty() ? "" : ", ") + std::string(kCanFaultWords[i]);
  }
  return out;
}

}  // namespace

void SocketCanLink::count_errors(const CanFrame& frame) noexcept {
  const CanFaults faults = faults_of(frame);
  if (faults == 0) return;
  last_faults_ = faults;
  for (std::size_t i = 0; i < faults_.size(); ++i) faults_[i] += faults >> i & 1U;
}

void SocketCanLink::refresh(Time now) {
  if (refreshed_ && now - *refreshed_ < kRefresh) return;
  refreshed_ = now;
  if (auto state = read_can_state(interface_)) {
    state_ = std::move(*state);
  } else {
    state_ = {};
    problem_ = state.error().detail;
  }
  care_for_bus_off(now);
}

void SocketCanLink::care_for_bus_off(Time now) {
  if (!state_.up || state_.controller != CanController::BusOff) {
    off_since_.reset();
    return;
  }
  if (!off_since_) off_since_ = now;
  if (!options_.configures() || now - *off_since_ < kBusOffPatience) return;
  off_since_ = now;  // the next try as long after this one
  auto restarted = restart_bus(interface_);
  if (restarted) ++restarts_;
  problem_ = restarted ? "" : restarted.error().detail;
}

BusReport SocketCanLink::report(Time now) {
  refresh(now);
  BusReport out;
  add_state(state_, out.facts);
  if (!problem_.empty()) out.facts["can_problem"] = problem_;
  if (slowest_ > kLateReading) {
    out.facts["can_read_late"] =
        std::to_string(std::chrono::round<std::chrono::milliseconds>(slowest_).count()) + " ms";
  }
  slowest_ = {};
  if (last_faults_ != 0) out.facts["can_last_error"] = words_of(last_faults_);
  const auto count = [&out](std::string what, std::uint64_t n) {
    if (n > 0) out.counts.emplace(std::move(what), n);
  };
  for (std::size_t i = 0; i < faults_.size(); ++i) {
    count("CAN error: " + std::string(kCanFaultWords[i]), faults_[i]);
  }
  count("CAN FD frame", fd_frames_);
  count("no CAN frame", refused());
  count("lost: read too late", overrun());
  count("foreign frame not read: the bus is full",
        others_dropped_ + (others_ ? others_->dropped : 0));
  count("bus restarted by roverd", restarts_);
  if (!options_.only.empty()) return out;
  count("sent, never confirmed", confirmations_.lost_count());
  out.facts["can_confirmed"] = std::to_string(confirmations_.confirmed_count()) + " of " +
                               std::to_string(confirmations_.sent_count());
  const auto age = confirmations_.oldest_waiting(base::steady_now());
  if (age && *age > kLateConfirmation) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%.1f s: does anybody acknowledge?",
                  base::seconds(*age));
    out.facts["can_unconfirmed_since"] = text.data();
  }
  return out;
}

}  // namespace roverd::link
