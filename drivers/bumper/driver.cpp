#include "bumper/driver.hpp"

#include <utility>

namespace roverd::bumper {

Driver::Driver(std::string name, const Params& params, MakeLink make_link,
               OnMeasurement on_measurement)
    : params_(params),
      on_measurement_(on_measurement),
      port_(
          {std::move(name), "waiting for a line", params.retry_first_s, params.retry_max_s},
          std::move(make_link), [this](base::Bytes b, Time t) { on_bytes(b, t); },
          [this] { forget(); }, std::move(on_measurement)) {}

void Driver::start(Time now) {
  forget();
  port_.start(now);
}

void Driver::forget() {
  decoder_.forget();
  port_.hazards({"the bumper is not heard"});
}

void Driver::restart(Time now) {
  stop(now);
  start(now);
}

void Driver::tick(Time now) {
  const double silent_s = base::seconds(now - port_.last_heard());
  if (port_.is_open() && params_.silent_reopen_s > 0.0 && silent_s > params_.silent_reopen_s) {
    port_.fail(port_.silence("no intact line"), now);
  } else if (port_.is_up() && silent_s > params_.silent_after_s) {
    port_.lose(port_.silence("no intact line"), now);
  }
  port_.tick(now);
}

void Driver::on_bytes(base::Bytes bytes, Time stamp) {
  decoder_.feed(bytes, [&](std::uint8_t mask) {
    port_.hazards({});
    port_.received(stamp);
    port_.heard(stamp);
    on_measurement_(base::Bumper{stamp, mask != 0, where(mask)});
  });
  if (decoder_.refused() == damaged_) return;
  port_.count("damaged line", decoder_.refused() - damaged_);
  damaged_ = decoder_.refused();
}

}  // namespace roverd::bumper
