#include "mti/driver.hpp"

#include <stdexcept>
#include <utility>

namespace roverd::mti {
namespace {

/// What looks like a message and is not complete after this long is none.
constexpr base::Duration kStalledMessage = std::chrono::milliseconds(500);
/// How long one baud rate is listened to.
constexpr base::Duration kListen = std::chrono::milliseconds(1500);

const char* filter_words(const Status& status) noexcept {
  switch (status.filter_mode()) {
    case 0:
      return "without GNSS";
    case 1:
      return "coasting";
    case 3:
      return "with GNSS";
    default:
      return "unknown";
  }
}

}  // namespace

Driver::Driver(std::string name, const Params& params, MakeLink make_link,
               OnMeasurement on_measurement)
    : params_(params),
      setup_(params),
      interpreter_(
          name, params,
          {on_measurement,
           [this](std::string_view cause, std::uint64_t n) { port_.count(std::string(cause), n); },
           [this](std::string_view what, std::uint64_t n) { port_.note(std::string(what), n); }}),
      port_(
          {name, "waiting for a sample", params.retry_first_s, params.retry_max_s},
          std::move(make_link), [this](Bytes b, Time t) { on_bytes(b, t); }, [this] { forget(); },
          std::move(on_measurement)) {
  if (const auto valid = validate(params); !valid) {
    throw std::invalid_argument(valid.error().detail);
  }
}

void Driver::start(Time now) {
  forget();
  interpreter_.reset();
  port_.start(now);
}

void Driver::restart(Time now) {
  stop(now);
  start(now);
}

void Driver::forget() {
  framer_.forget();
  interpreter_.forget();
  begun_.reset();
}

void Driver::tick(Time now) {
  if (begun_ && now - *begun_ > kStalledMessage) {
    begun_.reset();
    framer_.give_up([&](const Message& m) { on_message(m, now); });
    count_framing();
  }
  check_silence(now);
  talk(now);
  port_.tick(now);
}

void Driver::check_silence(Time now) {
  if (!port_.is_open()) return;
  const double silent_s = base::seconds(now - port_.last_heard());
  if (silent_s <= params_.silent_after_s) return;
  const std::string reason = interpreter_.frozen()
                                 ? "the unit repeats itself: its sample time stands still"
                             : interpreter_.status() && !interpreter_.status()->self_test_ok()
                                 ? "the unit's self-test failed"
                                 : port_.silence("no sample");
  if (params_.silent_reopen_s > 0.0 && silent_s > params_.silent_reopen_s) {
    port_.fail(reason, now);
  } else if (!params_.configure || setup_.done() || setup_.deaf()) {
    port_.lose(reason, now);
  }
}

/// Asks what is to be asked, and tries the next baud rate where nothing makes sense.
void Driver::talk(Time now) {
  if (!port_.is_open()) {
    was_open_ = false;
    return;
  }
  if (!was_open_) {
    was_open_ = true;
    heard_here_ = false;
    tuned_ = now;
    setup_.begin();
  }
  const auto bytes = setup_.due(now);
  if (!bytes.empty()) static_cast<void>(port_.write(bytes));
  for (const auto& [key, value] : setup_.facts()) port_.fact(key, value);
  const bool asked = !params_.configure || setup_.deaf();
  if (heard_here_ || !asked || now - tuned_ < kListen) return;
  tuned_ = now;
  if (!port_.retune()) return;
  framer_.forget();
  setup_.begin();
}

void Driver::on_bytes(Bytes bytes, Time stamp) {
  const std::uint64_t before = framer_.counts().messages;
  framer_.feed(bytes, [&](const Message& m) { on_message(m, stamp); });
  count_framing();
  if (!framer_.waiting()) {
    begun_.reset();
  } else if (!begun_ || framer_.counts().messages != before) {
    begun_ = stamp;
  }
}

void Driver::on_message(const Message& message, Time stamp) {
  heard_here_ = true;
  setup_.add(message);
  switch (message.mid) {
    case mid::kMtData2:
      if (interpreter_.take(message.payload, stamp)) {
        port_.received(stamp);
        port_.heard(stamp);
      }
      return say_status();
    case mid::kMtData:
      return port_.note("MTData, the old format", 1);
    case mid::kError:
      return port_.note("error from the unit: " +
                            std::string(error_words(message.payload.empty() ? std::uint8_t{0}
                                                                            : message.payload[0])),
                        1);
    case mid::kWakeUp:
      port_.note("the unit began anew", 1);
      return interpreter_.reset();
    default:
      if (name_of(message.mid).empty()) port_.note("unknown message", 1);
  }
}

void Driver::count_framing() {
  const Framer::Counts& now = framer_.counts();
  const auto more = [this](const char* cause, std::uint64_t n, std::uint64_t& told) {
    if (n == told) return;
    port_.count(cause, n - told);
    told = n;
  };
  more("message with a wrong checksum", now.bad_checksum, counted_.bad_checksum);
  more("message too long", now.too_long, counted_.too_long);
  if (now.skipped_bytes != counted_.skipped_bytes) {
    port_.note("bytes outside any message", now.skipped_bytes - counted_.skipped_bytes);
    counted_.skipped_bytes = now.skipped_bytes;
  }
}

/// Only when it changes: this is called a hundred times a second.
void Driver::say_status() {
  constexpr std::uint32_t kTold = 0x1F80'0007;  // self-test, orientation, fix, filter, RTK
  if (!interpreter_.status()) return;
  const Status status = *interpreter_.status();
  if (status_told_ == (status.word & kTold)) return;
  status_told_ = status.word & kTold;
  port_.fact("self_test", status.self_test_ok() ? "ok" : "failed");
  port_.fact("orientation", status.orientation_valid() ? "valid" : "not valid");
  port_.fact("gnss", status.gnss_fix() ? "fix" : "no fix");
  port_.fact("filter", filter_words(status));
}

}  // namespace roverd::mti
