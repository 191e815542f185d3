#include "mti/setup.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "mti/data2_build.hpp"

namespace roverd::mti {
namespace {

constexpr std::uint16_t kAlways = 0xFFFF;
constexpr std::uint8_t kReqFirmware = 0x12;
constexpr std::uint8_t kReqProduct = 0x1C;
constexpr base::Duration kKnock = std::chrono::milliseconds(100);
constexpr int kKnocks = 30;
constexpr base::Duration kPatience = std::chrono::milliseconds(500);
constexpr int kTries = 3;

std::string hex(std::uint32_t value, int digits) {
  std::array<char, 12> text{};
  std::snprintf(text.data(), text.size(), "%0*X", digits, value);
  return text.data();
}

/// Printable characters only; blanks at the end go.
std::string text_of(Bytes bytes) {
  std::string out;
  for (const std::uint8_t b : bytes) {
    if (b >= 0x20 && b < 0x7F) out += static_cast<char>(b);
  }
  out.erase(out.find_last_not_of(' ') + 1);
  return out;
}

std::string name_of_output(std::uint16_t xdi) {
  const std::string_view name = name_of(static_cast<Kind>(xdi & 0xFFF0U));
  return name.empty() ? hex(xdi, 4) : std::string(name);
}

}  // namespace

std::vector<Output> wanted_outputs(const Params& params) {
  const auto rate = static_cast<std::uint16_t>(std::lround(params.rate_hz));
  const auto slow = std::min<std::uint16_t>(rate, 100);
  std::vector<Output> out{
      {xdi_of(Kind::PacketCounter), kAlways}, {xdi_of(Kind::SampleTimeFine), kAlways},
      {xdi_of(Kind::StatusWord), kAlways},    {xdi_of(Kind::Quaternion, Axes::Ned), slow},
      {xdi_of(Kind::Acceleration), rate},     {xdi_of(Kind::RateOfTurn), rate},
      {xdi_of(Kind::MagneticField), slow}};
  if (params.position == "none") return out;
  if (params.position == "filter") {
    const auto hz = static_cast<std::uint16_t>(std::lround(std::max(1.0, params.position_hz)));
    out.push_back({xdi_of(Kind::UtcTime), hz});
    out.push_back({xdi_of(Kind::LatLon, Axes::Enu, Format::Fp1632), hz});
    out.push_back({xdi_of(Kind::AltitudeEllipsoid, Axes::Enu, Format::Fp1632), hz});
    out.push_back({xdi_of(Kind::Velocity, Axes::Ned), hz});
  }
  out.push_back({xdi_of(Kind::GnssPvt), 4});
  out.push_back({xdi_of(Kind::GnssSatellites), 4});
  return out;
}

Setup::Setup(const Params& params) : configure_(params.configure), wanted_(wanted_outputs(params)) {
  if (!configure_) return;
  const auto step = [&](const char* what, std::uint8_t mid) {
    steps_.push_back({what, mid, encode(mid, {}), kPatience, kTries});
  };
  steps_.push_back(
      {"configuration state", mid::kGoToConfig, encode(mid::kGoToConfig, {}), kKnock, kKnocks});
  step("device", mid::kReqDid);
  step("product", kReqProduct);
  step("firmware", kReqFirmware);
  steps_.push_back({"outputs", mid::kSetOutput, encode(wanted_), kPatience, kTries});
  step("measurement state", mid::kGoToMeasurement);
  begin();
}

void Setup::begin() {
  at_ = 0;
  tries_ = 0;
  deaf_ = false;
  refused_.clear();
  facts_.clear();
  if (configure_) facts_["configuration"] = "asking for " + steps_[0].what;
}

std::vector<std::uint8_t> Setup::due(base::Time now) {
  while (!done() && !deaf_) {
    const Step& step = steps_[at_];
    if (tries_ > 0 && now - asked_ < step.patience) return {};
    if (tries_ < step.tries) {
      ++tries_;
      asked_ = now;
      return step.bytes;
    }
    if (at_ > 0) {
      next(step.what + " without answer");
      continue;
    }
    deaf_ = true;
    facts_["configuration"] = "the unit does not answer";
  }
  return {};
}

void Setup::add(const Message& message) {
  if (!configure_) return;
  if (message.mid == mid::kWakeUp) return begin();
  if (done() || deaf_ || tries_ == 0) return;
  const Step& step = steps_[at_];
  if (message.mid == mid::kError) {
    const std::uint8_t code = message.payload.empty() ? std::uint8_t{0} : message.payload[0];
    return next(step.what + " refused: " + std::string(error_words(code)));
  }
  if (message.mid == step.request + 1) on_answer(message);
}

void Setup::on_answer(const Message& message) {
  const Bytes p = message.payload;
  const std::string what = steps_[at_].what;
  std::string outcome;
  if (what == "device" && (p.size() == 4 || p.size() == 8)) {
    std::uint32_t id = 0;
    for (const std::uint8_t b : p.last(4)) id = id << 8U | b;
    facts_[what] = hex(id, 8);
  } else if (what == "product") {
    facts_[what] = text_of(p);
  } else if (what == "firmware" && p.size() >= 3) {
    facts_[what] = std::to_string(p[0]) + "." + std::to_string(p[1]) + "." + std::to_string(p[2]);
  } else if (what == "outputs") {
    outcome = judge(p);
  }
  next(outcome);
}

/// What of the wish the unit will not send, or not as fast. Empty: all as wanted.
std::string Setup::judge(Bytes answered) const {
  const std::vector<Output> given = outputs_of(answered);
  std::string out;
  for (const Output& w : wanted_) {
    const auto found = std::ranges::find(given, w.xdi, &Output::xdi);
    if (found != given.end() && found->rate_hz == w.rate_hz) continue;
    if (!out.empty()) out += ", ";
    out += name_of_output(w.xdi);
    out += found == given.end() || found->rate_hz == 0
               ? std::string(" not offered")
               : " at " + std::to_string(found->rate_hz) + " Hz";
  }
  return out;
}

void Setup::next(const std::string& outcome) {
  if (!outcome.empty()) refused_ += (refused_.empty() ? "" : ", ") + outcome;
  ++at_;
  tries_ = 0;
  facts_["configuration"] = !done()            ? "asking for " + steps_[at_].what
                            : refused_.empty() ? "accepted"
                                               : refused_;
}

}  // namespace roverd::mti
