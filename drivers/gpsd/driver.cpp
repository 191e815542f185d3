#include "gpsd/driver.hpp"

#include <utility>

namespace roverd::gpsd {

Driver::Driver(std::string name, const Params& params, MakeLink make_link,
               OnMeasurement on_measurement)
    : params_(params),
      on_measurement_(on_measurement),
      blend_([this](const base::Measurement& m) { on_measurement_(m); }),
      reader_({name, params.device, params.heading_source, params.heading_offset_deg},
              {[this](const base::Measurement& m) {
                 measured_ = true;
                 if (clock_.add(reader_.clock_s(), base::stamp_of(m))) {
                   return port_.refused("report of a standing clock");
                 }
                 if (std::holds_alternative<base::SatellitesInView>(m)) return on_measurement_(m);
                 blend_.nmea(m);
               },
               [this](std::string_view cause) { port_.refused(std::string(cause)); },
               [this](std::string_view what) { port_.note(std::string(what), 1); },
               [this](std::string_view key, std::string value) {
                 port_.fact(std::string(key), std::move(value));
               }}),
      port_(
          {std::move(name), "waiting for a report of gpsd", params.retry_first_s,
           params.retry_max_s},
          std::move(make_link), [this](base::Bytes b, Time t) { on_bytes(b, t); },
          [this] { forget(); }, std::move(on_measurement)) {}

void Driver::start(Time now) {
  forget();
  clock_ = {};
  port_.start(now);
}

void Driver::restart(Time now) {
  stop(now);
  start(now);
}

void Driver::forget() {
  lines_.forget();
  reader_.reset();
  blend_.reset();
}

void Driver::tick(Time now) {
  if (!port_.is_open()) {
    watching_ = false;
  } else if (!watching_) {
    const std::string request = watch_request(params_.device);
    watching_ = port_.write({reinterpret_cast<const std::uint8_t*>(request.data()),
                             request.size()}) == link::SendResult::Sent;
  }
  const double silent_s = base::seconds(now - port_.last_heard());
  if (port_.is_open() && silent_s > params_.silent_after_s) {
    const std::string reason = clock_.frozen()
                                   ? "the receiver repeats itself: its time stands still"
                                   : "gpsd tells nothing of a receiver";
    if (params_.silent_reopen_s > 0.0 && silent_s > params_.silent_reopen_s) {
      port_.fail(reason, now);
    } else {
      port_.lose(reason, now);
    }
  }
  port_.tick(now);
}

void Driver::on_bytes(base::Bytes bytes, Time stamp) {
  lines_.feed(bytes, [&](std::string_view line) { on_line(line, stamp); });
  if (lines_.too_long() != too_long_) {
    port_.count("line that is too long", lines_.too_long() - too_long_);
    too_long_ = lines_.too_long();
  }
}

void Driver::on_line(std::string_view line, Time stamp) {
  measured_ = false;
  if (!reader_.take(line, stamp) || !measured_) return;
  const gnss::Blend::Counts& now = blend_.counts();
  if (now.zero_positions != blended_.zero_positions) port_.refused("position 0, 0");
  if (now.impossible_dates != blended_.impossible_dates) port_.refused("impossible date");
  if (now.backwards != blended_.backwards) port_.refused("time going back");
  blended_ = now;
  if (clock_.frozen()) return;
  port_.received(stamp);
  port_.heard(stamp);
}

}  // namespace roverd::gpsd
