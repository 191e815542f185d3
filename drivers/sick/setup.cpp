#include "sick/setup.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sick/scan.hpp"

namespace roverd::sick {
namespace {

using namespace std::chrono_literals;

/// To know that nobody answers in this dialect.
constexpr base::Duration kKnock = 500ms;
constexpr base::Duration kPollState = 200ms;
constexpr int kStatePolls = 100;
/// After sMA, or of what stops and starts the motor.
constexpr base::Duration kSlow = 5s;

struct Field {
  std::int32_t start_e4deg;
  std::int32_t stop_e4deg;
};
/// What the model sees, in its own angles.
Field field_of(const Params& p) noexcept {
  if (p.model == "lms5xx") return {-50'000, 1'850'000};
  return {-450'000, 2'250'000};
}
std::int32_t e4deg(double deg) {
  return static_cast<std::int32_t>(std::lround(deg * 1e4));
}
std::uint32_t step_of(const Params& p) {
  return static_cast<std::uint32_t>(e4deg(p.resolution_deg));
}

}  // namespace

ScanConfig wanted_scan(const Params& p) {
  const Field field = field_of(p);
  return {.frequency_chz = static_cast<std::uint32_t>(std::lround(p.frequency_hz * 100.0)),
          .sectors = 1,
          .step_e4deg = step_of(p),
          .start_e4deg = field.start_e4deg,
          .stop_e4deg = field.stop_e4deg};
}

OutputRange wanted_range(const Params& p) {
  const Field field = field_of(p);
  const auto within = [&](double deg) {
    return std::clamp(e4deg(deg + p.ahead_deg), field.start_e4deg, field.stop_e4deg);
  };
  return {.sectors = 1,
          .step_e4deg = step_of(p),
          .start_e4deg = within(p.right_deg),
          .stop_e4deg = within(p.left_deg)};
}

DataConfig wanted_data(const Params& p) {
  DataConfig out;
  out.echoes = static_cast<std::uint16_t>(((1U << p.echoes) - 1U) << 8U);
  out.remission = p.remission;
  out.every = static_cast<std::uint16_t>(p.every);
  return out;
}

void Setup::step(const char* what, const char* kind, const char* name, Request request) {
  steps_.push_back({.what = what, .kind = kind, .name = name, .request = std::move(request)});
}

void Setup::list_configuration() {
  const Dialect d = dialect_;
  const auto names = [&](const char* what, const char* name, const char* fact) {
    step(what, "sRA", name, read(d, name));
    steps_.back().fact = fact;
  };
  step("scans off", "sEA", kScanData.data(), subscribe(d, false));
  steps_.back().patience = kKnock;
  names("device", "DeviceIdent", "device");
  names("serial number", "SerialNumber", "serial_number");
  names("firmware", "FirmwareVersion", "firmware");
  step("login", "sAN", "SetAccessMode", login(d));
  if (params_.model != "tim") {
    step("scan configuration", "sAN", "mLMPsetscancfg", set(d, wanted_scan(params_)));
    steps_.back().patience = kSlow;
  }
  step("output range", "sWA", "LMPoutputRange", set(d, wanted_range(params_)));
  step("scan content", "sWA", "LMDscandatacfg", set(d, wanted_data(params_)));
  step("start", "sAN", "LMCstartmeas", call(d, "LMCstartmeas"));
  steps_.back().patience = kSlow;
  step("measuring state", "sRA", "STlms", read(d, "STlms"));
  steps_.back().patience = kPollState;
  steps_.back().tries = kStatePolls;
  steps_.back().until_measuring = true;
  step("run", "sAN", "Run", call(d, "Run"));
}

void Setup::begin(Dialect dialect) {
  dialect_ = dialect;
  steps_.clear();
  if (params_.configure) list_configuration();
  step("scans on", "sEA", kScanData.data(), subscribe(dialect, true));
  steps_.back().patience = kKnock;
  at_ = 0;
  tries_ = 0;
  asked_.reset();
  working_ = false;
  heard_ = false;
  deaf_ = false;
  problems_.clear();
  facts_.clear();
  facts_["configuration"] = "asking for " + steps_[0].what;
}

void Setup::next(const std::string& problem) {
  if (!problem.empty()) problems_ += (problems_.empty() ? "" : ", ") + problem;
  ++at_;
  tries_ = 0;
  asked_.reset();
  working_ = false;
  facts_["configuration"] = !done()              ? "asking for " + steps_[at_].what
                            : !problems_.empty() ? problems_
                            : params_.configure  ? "as wanted"
                                                 : "as stored in the scanner";
}

Request Setup::due(base::Time now) {
  while (!done() && !deaf_) {
    const Step& s = steps_[at_];
    if (asked_ && now - *asked_ < (working_ ? kSlow : s.patience)) return {};
    if (tries_ < s.tries) {
      ++tries_;
      asked_ = now;
      return s.request;
    }
    if (!heard_) {
      deaf_ = true;
      return {};
    }
    const auto state = facts_.find("state");
    const bool told = s.until_measuring && state != facts_.end();
    next(s.what + ": " + (told ? state->second : std::string("no answer")));
  }
  return {};
}

void Setup::unsent() noexcept {
  if (tries_ > 0) --tries_;
  asked_.reset();
}

void Setup::add(const Telegram& telegram, const Words& words) {
  if (telegram.dialect != dialect_) begin(telegram.dialect);
  heard_ = true;
  deaf_ = false;
  if (done() || !asked_) return;
  const Step& s = steps_[at_];
  if (words.kind == "sFA" || (words.kind == s.kind && words.name == s.name)) {
    on_answer(telegram, words);
  } else if (words.kind == "sMA" && words.name == s.name) {
    working_ = true;
  }
}

void Setup::on_answer(const Telegram& telegram, const Words& words) {
  const Step& s = steps_[at_];
  const std::string_view refusal = refusal_in(telegram, words);
  if (!refusal.empty()) return next(s.what + ": " + std::string(refusal));
  if (!s.fact.empty()) facts_[s.fact] = letters_in(telegram, words);
  if (!s.until_measuring) return next("");
  const auto state = state_in(telegram, words);
  if (!state) return next(s.what + ": not understood");
  facts_["state"] = state_words(*state);
  if (*state == kMeasuring) next("");
}

}  // namespace roverd::sick
