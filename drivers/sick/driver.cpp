#include "sick/driver.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <utility>

namespace roverd::sick {
namespace {

/// What looks like a telegram and is not complete after this long is none.
constexpr base::Duration kStalledTelegram = std::chrono::milliseconds(500);
/// A connection over which nothing can be sent for so long is none.
constexpr base::Duration kUnsent = std::chrono::seconds(10);
/// The scan is never sent later than this after its beginning.
constexpr std::uint32_t kLongestScan_us = 1'000'000;

std::string beams_text(const Beams& b) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "%zu beams of %g deg from %g deg, %g Hz", b.count,
                b.step_e4deg / 1e4, b.start_e4deg / 1e4, b.frequency_chz / 100.0);
  return text.data();
}

}  // namespace

Driver::Driver(std::string name, const Params& params, MakeLink make_link,
               OnMeasurement on_measurement, base::OnSight on_sight)
    : params_(params),
      on_sight_(std::move(on_sight)),
      setup_(params),
      dialect_(params.dialect == "b" ? Dialect::B : Dialect::A),
      port_(
          {std::move(name), "waiting for a scan", params.retry_first_s, params.retry_max_s},
          std::move(make_link), [this](Bytes b, Time t) { on_bytes(b, t); }, [this] { forget(); },
          std::move(on_measurement)) {
  if (const auto valid = validate(params); !valid) {
    throw std::invalid_argument(valid.error().detail);
  }
  port_.on_opening([this](link::ByteLink&, Time now) { begin(now); });
  port_.on_reporting([this](Time now) { measure_rate(now); });
  port_.on_completing([this](base::DriverStatus& s) {
    auto detail = std::make_shared<base::DriverDetail>(*s.detail);
    detail->rates_hz["scan"] = rate_hz_;
    s.detail = std::move(detail);
  });
}

void Driver::start(Time now) {
  forget();
  port_.start(now);
}

void Driver::restart(Time now) {
  stop(now);
  start(now);
}

void Driver::forget() {
  framer_.forget();
  begun_.reset();
  last_.reset();
  clock_.reset();
}

void Driver::tick(Time now) {
  if (begun_ && now - *begun_ > kStalledTelegram) {
    begun_.reset();
    framer_.give_up([&](const Telegram& t) { on_telegram(t, now); });
    count_framing();
  }
  talk(now);
  check_silence(now);
  port_.tick(now);
}

/// A scanner that hangs up without a word may have been asked in the wrong dialect.
void Driver::begin(Time now) {
  if (asked_here_ && !heard_here_ && !tried_other_) dialect_ = other(dialect_);
  asked_here_ = false;
  heard_here_ = false;
  tried_other_ = false;
  sent_ = now;
  ready_.reset();
  setup_.begin(dialect_);
}

/// Asks what is to be asked, once connected.
void Driver::talk(Time now) {
  if (!port_.is_open()) return;
  if (const Request request = setup_.due(now); !request.empty()) {
    if (port_.write(request) == link::SendResult::Sent) {
      sent_ = now;
      asked_here_ = true;
    } else {
      setup_.unsent();
    }
  }
  if (setup_.done() && !ready_) ready_ = now;
  for (const auto& [key, value] : setup_.facts()) port_.fact(key, value);
  if (setup_.deaf()) try_other_dialect(now);
}

void Driver::try_other_dialect(Time now) {
  dialect_ = other(setup_.dialect());
  if (tried_other_) return port_.fail("no answer, neither in CoLa A nor in CoLa B", now);
  tried_other_ = true;
  setup_.begin(dialect_);
}

void Driver::check_silence(Time now) {
  if (!port_.is_open()) return;
  const Time heard = port_.last_heard();
  const Time since = port_.is_up() ? heard : std::max(heard, ready_.value_or(heard));
  const bool silent = base::seconds(now - since) > params_.silent_after_s;
  if (setup_.done()) {
    if (silent) port_.fail(port_.silence("no scan"), now);
  } else if (now - sent_ > kUnsent) {
    port_.fail("nothing can be sent", now);
  } else if (silent && port_.is_up()) {
    port_.lose("the scanner is being configured", now);
  }
}

void Driver::on_bytes(Bytes bytes, Time stamp) {
  const std::uint64_t before = framer_.counts().telegrams;
  framer_.feed(bytes, [&](const Telegram& t) { on_telegram(t, stamp); });
  count_framing();
  if (!framer_.waiting()) {
    begun_.reset();
  } else if (!begun_ || framer_.counts().telegrams != before) {
    begun_ = stamp;
  }
}

void Driver::on_telegram(const Telegram& telegram, Time stamp) {
  const auto words = words_of(telegram);
  if (!words) return port_.refused("telegram without words");
  heard_here_ = true;
  dialect_ = telegram.dialect;
  port_.fact("dialect", std::string(to_string(telegram.dialect)));
  setup_.add(telegram, *words);
  if (is_scan(*words)) {
    const auto scan = decode_scan(telegram);
    if (!scan) return port_.refused("scan, " + scan.error().detail);
    return take(*scan, stamp);
  }
  if (words->kind == "sFA") {
    const std::string why(error_words(error_code(telegram)));
    port_.fact("last_error", why);
    port_.note("error from the scanner: " + why, 1);
  }
}

/// Counts what was lost or came twice.
bool Driver::is_new(const Scan& scan) {
  const Last here{scan.scan_count, scan.start_us, scan.sent_us};
  const std::optional<Last> before = std::exchange(last_, here);
  if (!before) return true;
  const auto on = static_cast<std::uint16_t>(here.scan_count - before->scan_count);
  if (on == 0 && here.start_us == before->start_us) {
    port_.twice("scan that came twice");
    return false;
  }
  if (on == 0 || on > 0x7FFFU) {
    port_.note("scan counter began anew", 1);
    return true;
  }
  const auto every = static_cast<unsigned>(params_.every);
  const unsigned steps = std::max(1U, (on + every / 2) / every);
  if (steps > 1) port_.lost("lost scan", steps - 1);
  count_ += steps - 1;
  return true;
}

Time Driver::began(const Scan& scan, const Beams& beams, Time stamp) {
  using Clock = base::SampleClock<1>;
  const base::Duration takes = base::from_seconds(duration_s(beams));
  const Clock::Read sent = clock_.read(scan.sent_us, stamp);
  if (sent.step == Clock::Step::Same) return stamp - takes;    // it has no clock
  const std::uint32_t told_us = scan.sent_us - scan.start_us;  // wraps with both
  if (told_us > kLongestScan_us) return sent.stamp - takes;
  return sent.stamp - std::max<base::Duration>(takes, std::chrono::microseconds(told_us));
}

void Driver::take(const Scan& scan, Time stamp) {
  auto sight = to_sight(scan, {params_.ahead_deg, params_.clear_to_m});
  if (!sight) return port_.refused(sight.error().detail);
  if (!is_new(scan)) return;
  const Beams beams = *beams_of(scan);
  sight->sensor = port_.name();
  sight->stamp = began(scan, beams, stamp);
  sight->count = count_++;
  if (!sight->good) port_.note("scan that the scanner does not vouch for", 1);
  missing_ = missing_share(*sight);
  ++taken_;
  say_facts(scan, beams);
  port_.received(stamp);
  port_.heard(stamp);
  if (on_sight_) on_sight_(std::make_shared<const base::Sight>(std::move(*sight)));
}

/// Only what changes: this is called fifty times a second.
void Driver::say_facts(const Scan& scan, const Beams& beams) {
  if (beams_ != beams) {
    if (beams_) port_.note("scan of another shape than before", 1);
    beams_ = beams;
    port_.fact("scan", beams_text(beams));
  }
  if (status_told_ != scan.status) {
    status_told_ = scan.status;
    const Status status = status_of(scan);
    port_.fact("status", std::string(status.words));
    port_.fact("window", status.blocked ? "blocked" : status.dirty ? "dirty" : "clean");
  }
  if (serial_told_ != scan.serial) {
    serial_told_ = scan.serial;
    port_.fact("serial", std::to_string(scan.serial));
  }
}

void Driver::measure_rate(Time now) {
  constexpr double kWindow_s = 0.4;
  const double span_s = rate_from_ ? base::seconds(now - *rate_from_) : 0.0;
  if (rate_from_ && span_s < kWindow_s) return;
  rate_hz_ = rate_from_ ? static_cast<double>(taken_) / span_s : 0.0;
  taken_ = 0;
  rate_from_ = now;
  if (!port_.is_up()) return;
  port_.fact("missing_returns", std::to_string(std::lround(missing_ * 100.0)) + " %");
}

void Driver::count_framing() {
  const Framer::Counts& now = framer_.counts();
  const auto more = [this](const char* cause, std::uint64_t n, std::uint64_t& told) {
    if (n == told) return;
    port_.count(cause, n - told);
    told = n;
  };
  more("telegram with a wrong checksum", now.bad_checksum, counted_.bad_checksum);
  more("telegram of an impossible length", now.bad_length, counted_.bad_length);
  more("telegram that was cut", now.cut, counted_.cut);
  if (now.skipped_bytes != counted_.skipped_bytes) {
    port_.note("bytes outside any telegram", now.skipped_bytes - counted_.skipped_bytes);
    counted_.skipped_bytes = now.skipped_bytes;
  }
}

}  // namespace roverd::sick
