#include "gnss/driver.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace roverd::gnss {

namespace {

/// Receivers tell a position once in a second at least; without a fix its message comes as well.
constexpr base::Duration kPositionPatience = std::chrono::seconds(5);

/// What looks like a binary frame and is not complete after this long is none.
constexpr base::Duration kStalled = std::chrono::seconds(1);

EpochOptions epoch_options(const Params& p) {
  EpochOptions o;
  o.timeout_s = p.epoch_timeout_s;
  o.heading_source = p.heading_source == "dual_antenna" ? base::HeadingSource::DualAntenna
                                                        : base::HeadingSource::Compass;
  o.heading_offset_deg = p.heading_offset_deg;
  return o;
}

UbxEpochOptions ubx_epoch_options(const Params& p) {
  return {.timeout_s = p.epoch_timeout_s,
          .baseline_m = p.baseline_m,
          .baseline_tolerance = p.baseline_tolerance_pct / 100.0,
          .heading_offset_deg = p.heading_offset_deg};
}

UbxSetupOptions setup_options(const Params& p) {
  return {.configure = p.ubx_configure,
          .keep = p.ubx_keep,
          .port = ubx_port_from(p.ubx_port).value_or(UbxPort::Usb),
          .rate_hz = p.ubx_rate_hz};
}

}  // namespace

base::Result<void> validate(const Params& params) {
  if (params.heading_source != "compass" && params.heading_source != "dual_antenna") {
    return base::fail(base::Code::Invalid, "heading_source must be compass or dual_antenna",
                      {{"heading_source", "must be compass or dual_antenna"}});
  }
  if (!ubx_port_from(params.ubx_port)) {
    return base::fail(base::Code::Invalid, "ubx_port must be usb, uart1 or uart2",
                      {{"ubx_port", "must be usb, uart1 or uart2"}});
  }
  return {};
}

Driver::Driver(std::string name, const Params& params, MakeLink make_link,
               OnMeasurement on_measurement)
    : params_(params),
      on_measurement_(on_measurement),
      blend_([this](const base::Measurement& m) { tell(m); }),
      epochs_(epoch_options(params), [this](const base::Measurement& m) { blend_.nmea(m); }),
      ubx_epochs_(ubx_epoch_options(params), [this](const base::Measurement& m) { blend_.ubx(m); }),
      sky_(name, [this](const base::Measurement& m) { on_measurement_(m); }),
      setup_(setup_options(params)),
      port_(
          {name, "waiting for a sentence", params.retry_first_s, params.retry_max_s},
          std::move(make_link), [this](Bytes b, Time t) { on_bytes(b, t); },
          [this] { forget_epochs(); }, std::move(on_measurement)) {
  if (const auto valid = validate(params); !valid)
    throw std::invalid_argument(valid.error().detail);
  port_.on_opening([this](link::ByteLink&, Time now) { begin(now); });
  port_.on_completing([this](base::DriverStatus& s) { complete(s); });
}

void Driver::start(Time now) {
  port_.start(now);
}

void Driver::begin(Time now) {
  last_byte_ = last_intact_ = retuned_ = last_fix_ = now;
  no_position_ = false;
  clock_ = {};
  ubx_clock_ = {};
  ubx_before_ = counts().ubx;
  setup_.begin();
}

void Driver::forget_epochs() {
  epochs_.reset();
  ubx_epochs_.reset();
  sky_.reset();
  blend_.reset();
}

void Driver::tick(Time now) {
  if (port_.is_open()) {
    const std::uint64_t before = intact();
    decoder_.give_up(now - kStalled, [&](const auto& said, Time t) { take(said, t); });
    after_bytes(before, now);
    epochs_.tick(now);
    ubx_epochs_.tick(now);
    sky_.tick(now);
    check_silence(now);
    retune(now);
    talk(now);
  }
  correct();
  port_.tick(now);
}

void Driver::check_silence(Time now) {
  const double silent_s = base::seconds(now - last_intact_);
  if (silent_s <= params_.silent_after_s) return;
  const bool bytes = base::seconds(now - last_byte_) <= params_.silent_after_s;
  const std::string reason = bytes ? "bytes but no sentence: wrong baud rate, or another device"
                                   : "no bytes: the receiver is silent";
  if (params_.silent_reopen_s > 0.0 && silent_s > params_.silent_reopen_s) {
    port_.fail(reason, now);
  } else {
    port_.lose(reason, now);
  }
}

/// What a receiver says at a wrong baud rate is never a sentence: the next rate.
void Driver::retune(Time now) {
  const Time heard = std::max(last_intact_, retuned_);
  if (!port_.is_open() || base::seconds(now - heard) <= params_.silent_after_s) return;
  retuned_ = now;
  if (port_.retune()) decoder_.forget();
}

void Driver::talk(Time now) {
  if (!port_.is_open()) return;
  const auto bytes = setup_.due(counts().ubx > ubx_before_, now);
  if (!bytes.empty() && port_.write(bytes) == link::SendResult::Sent) ++sent_;
}

void Driver::correct() {
  if (!take_corrections) return;
  Frames frames;
  take_corrections(frames);
  for (const auto& frame : frames) {
    const bool sent = port_.write(frame) == link::SendResult::Sent;
    ++(sent ? corrections_ : corrections_lost_);
  }
}

void Driver::on_bytes(Bytes bytes, Time stamp) {
  last_byte_ = stamp;
  const std::uint64_t before = intact();
  decoder_.feed(bytes, stamp, [&](const auto& said, Time t) { take(said, t); });
  after_bytes(before, stamp);
}

void Driver::take(const Sentence& sentence, Time stamp) {
  if (clock_.add(sentence, stamp)) return clock_stands(stamp);
  sky_.add(sentence, stamp);
  epochs_.add(sentence, stamp);
}

void Driver::take(const ubx::Message& message, Time stamp) {
  setup_.add(message);
  const auto* pvt = std::get_if<ubx::NavPvt>(&message);
  std::optional<double> time_s;
  if (pvt != nullptr && pvt->usable()) time_s = pvt->itow_ms / 1e3;
  if (ubx_clock_.add(time_s, stamp)) return clock_stands(stamp);
  if (const auto* sats = std::get_if<ubx::NavSat>(&message)) return sky_.add(*sats, stamp);
  if (const auto* signals = std::get_if<ubx::NavSig>(&message)) return sky_.add(*signals, stamp);
  ubx_epochs_.add(message, stamp);
}

void Driver::clock_stands(Time stamp) {
  ++frozen_;
  if (!port_.is_up()) return;
  port_.lose("the receiver repeats itself: its time stands still", stamp);
  port_.say(stamp);
}

void Driver::after_bytes(std::uint64_t intact_before, Time stamp) {
  if (intact() == intact_before) return;
  last_intact_ = stamp;
  port_.received(stamp);
  // Set up for something else it speaks, and nobody would know why there is no position.
  no_position_ = stamp - last_fix_ > kPositionPatience;
  if (!clock_.frozen() && !ubx_clock_.frozen()) port_.heard(stamp);
}

void Driver::tell(const base::Measurement& m) {
  if (const auto* fix = std::get_if<base::GnssFix>(&m)) last_fix_ = std::max(last_fix_, fix->stamp);
  on_measurement_(m);
}

void Driver::stop(Time now) {
  port_.stop(now);
}

void Driver::restart(Time now) {
  stop(now);
  start(now);
}

void Driver::complete(base::DriverStatus& s) const {
  s.received = counts().used + counts().ubx_used;
  s.refused = counts().damaged + counts().ubx_refused + frozen_;
  s.sent = sent_;
  auto detail = std::make_shared<base::DriverDetail>(*s.detail);
  detail->counts.merge(causes());
  for (const auto& [key, value] : setup_.facts()) detail->facts[key] = value;
  if (no_position_) {
    detail->facts["no_position"] =
        "the receiver sends no position message: switch on GGA, GNS or RMC of NMEA, or NAV-PVT of "
        "UBX";
  }
  s.detail = std::move(detail);
}

std::map<std::string, std::uint64_t> Driver::causes() const {
  std::map<std::string, std::uint64_t> out;
  const auto count = [&out](std::string what, std::uint64_t n) {
    if (n > 0) out.emplace(std::move(what), n);
  };
  const SentenceCounts& c = decoder_.counts();
  for (std::size_t i = 0; i < c.by_flaw.size(); ++i) {
    count("sentence: " + std::string(to_string(static_cast<Flaw>(i))), c.by_flaw[i]);
  }
  count("sentence of no use", c.unused);
  count("unknown sentence", c.unknown);
  count("UBX frame, not used", c.ubx - c.ubx_used - c.ubx_refused);
  count("UBX frame, impossible", c.ubx_refused);
  count("RTCM3 frame, not used", c.rtcm3);
  count("binary frame with a wrong checksum", decoder_.framing().broken_binary);
  count("bytes outside any sentence", decoder_.framing().skipped_bytes);
  count("sentence of a standing clock", frozen_);
  count("heading of two antennas, not fixed or of a wrong length", ubx_epochs_.headings_refused());
  count("correction frame for the receiver", corrections_);
  count("correction frame, no room at the port", corrections_lost_);
  count("position 0, 0", blend_.counts().zero_positions);
  count("impossible date", blend_.counts().impossible_dates);
  count("time going back", blend_.counts().backwards);
  return out;
}

}  // namespace roverd::gnss
