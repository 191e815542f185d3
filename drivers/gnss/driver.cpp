#include "gnss/driver.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace roverd::gnss {

using Phase = base::DriverPhase;

namespace {

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
    : name_(std::move(name)),
      params_(params),
      make_link_(std::move(make_link)),
      on_measurement_(std::move(on_measurement)),
      life_(params.retry_first_s, params.retry_max_s),
      blend_([this](const base::Measurement& m) { on_measurement_(m); }),
      epochs_(epoch_options(params), [this](const base::Measurement& m) { blend_.nmea(m); }),
      ubx_epochs_(ubx_epoch_options(params), [this](const base::Measurement& m) { blend_.ubx(m); }),
      sky_(name_, [this](const base::Measurement& m) { on_measurement_(m); }),
      setup_(setup_options(params)) {
  if (const auto valid = validate(params); !valid)
    throw std::invalid_argument(valid.error().detail);
}

Driver::~Driver() {
  if (link_) link_->close();
}

void Driver::start(Time now) {
  now_ = now;
  if (life_.phase() != Phase::Down) return;
  open(now);
  report(now);
}

void Driver::open(Time now) {
  if (!link_) {
    auto made = make_link_();
    if (!made) return life_.faulty(made.error().detail, now);
    link_ = std::move(*made);
    link_->on_bytes = [this](Bytes b, Time t) { on_bytes(b, t); };
    link_->on_closed = [this](const std::string& reason) { fail(reason, now_); };
  }
  life_.opening("waiting for a sentence");
  last_byte_ = last_intact_ = retuned_ = now;
  clock_ = {};
  ubx_clock_ = {};
  ubx_before_ = counts().ubx;
  setup_.begin();
  open_ = true;  // before open: a link may hand over the first bytes from inside it
  if (const auto opened = link_->open(); !opened) fail(opened.error().detail, now);
}

void Driver::fail(const std::string& reason, Time now) {
  open_ = false;
  link_->close();
  forget_epochs();
  life_.faulty(reason, now);
}

void Driver::forget_epochs() {
  epochs_.reset();
  ubx_epochs_.reset();
  sky_.reset();
  blend_.reset();
}

void Driver::tick(Time now) {
  now_ = now;
  if (open_) {
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
  if (!open_ && life_.retry_due(now)) open(now);
  report(now);
}

void Driver::check_silence(Time now) {
  const double silent_s = base::seconds(now - last_intact_);
  if (silent_s <= params_.silent_after_s) return;
  const bool bytes = base::seconds(now - last_byte_) <= params_.silent_after_s;
  const std::string reason = bytes ? "bytes but no sentence: wrong baud rate, or another device"
                                   : "no bytes: the receiver is silent";
  if (params_.silent_reopen_s > 0.0 && silent_s > params_.silent_reopen_s) {
    fail(reason, now);
  } else if (life_.phase() != Phase::Faulty || life_.reason() != reason) {
    forget_epochs();
    life_.faulty(reason, now);
  }
}

/// What a receiver says at a wrong baud rate is never a sentence: the next rate.
void Driver::retune(Time now) {
  const Time heard = std::max(last_intact_, retuned_);
  if (!open_ || base::seconds(now - heard) <= params_.silent_after_s) return;
  retuned_ = now;
  if (link_->retune()) decoder_.forget();
}

void Driver::talk(Time now) {
  if (!open_) return;
  const auto bytes = setup_.due(counts().ubx > ubx_before_, now);
  if (!bytes.empty() && link_->write(bytes) == link::SendResult::Sent) ++sent_;
}

void Driver::correct() {
  if (!take_corrections) return;
  Frames frames;
  take_corrections(frames);
  for (const auto& frame : frames) {
    const bool sent = open_ && link_->write(frame) == link::SendResult::Sent;
    ++(sent ? corrections_ : corrections_lost_);
  }
}

void Driver::on_bytes(Bytes bytes, Time stamp) {
  if (!open_) return;
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
  ubx_epochs_.add(message, stamp);
}

void Driver::clock_stands(Time stamp) {
  ++frozen_;
  if (life_.phase() != Phase::Up) return;
  forget_epochs();
  life_.faulty("the receiver repeats itself: its time stands still", stamp);
  report(stamp);
}

void Driver::after_bytes(std::uint64_t intact_before, Time stamp) {
  if (intact() == intact_before) return;
  last_intact_ = stamp;
  last_received_ = stamp;
  if (life_.phase() == Phase::Up || clock_.frozen() || ubx_clock_.frozen()) return;
  life_.up();
  report(stamp);
}

void Driver::report(Time now) {
  if (life_.report_due(now)) on_measurement_(status(now));
}

void Driver::stop(Time now) {
  now_ = now;
  if (life_.phase() == Phase::Down) return;
  open_ = false;
  if (link_) link_->close();
  forget_epochs();
  life_.down();
  report(now);
}

void Driver::restart(Time now) {
  stop(now);
  start(now);
}

base::DriverStatus Driver::status(Time now) const {
  base::DriverStatus s;
  s.stamp = now;
  s.name = name_;
  s.phase = life_.phase();
  s.reason = life_.reason();
  s.received = counts().used + counts().ubx_used;
  s.refused = counts().damaged + counts().ubx_refused + frozen_;
  s.sent = sent_;
  s.last_received = last_received_;
  auto detail = std::make_shared<base::DriverDetail>();
  detail->counts = causes();
  detail->facts = setup_.facts();
  if (link_) s.link = link_->describe();
  s.link_open = open_;
  s.detail = std::move(detail);
  return s;
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
  if (link_) count("from a foreign address", link_->strangers());
  return out;
}

}  // namespace roverd::gnss
