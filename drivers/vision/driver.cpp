#include "vision/driver.hpp"

#include <memory>
#include <utility>

namespace roverd::vision {

Driver::Driver(std::string name, const Params& params, MakeLink make_link,
               OnMeasurement on_measurement, base::OnVision on_vision)
    : params_(params),
      on_vision_(std::move(on_vision)),
      port_(
          {std::move(name), "waiting for a datagram", params.retry_first_s, params.retry_max_s},
          std::move(make_link), [this](Bytes b, Time t) { on_datagram(b, t); }, [] {},
          std::move(on_measurement)) {}

void Driver::restart(Time now) {
  stop(now);
  start(now);
}

void Driver::tick(Time now) {
  const double silent_s = base::seconds(now - port_.last_heard());
  if (port_.is_open() && params_.silent_reopen_s > 0.0 && silent_s > params_.silent_reopen_s) {
    port_.fail(silence(), now);
  } else if (port_.is_up() && silent_s > params_.silent_after_s) {
    port_.lose(silence(), now);
  }
  port_.tick(now);
}

std::string Driver::silence() const {
  return refused_last_ ? "what the vision program sends is malformed"
                       : "nothing of the vision program";
}

void Driver::on_datagram(Bytes bytes, Time stamp) {
  const Decoded decoded = decode(bytes);
  if (decoded.fault != Fault::None) {
    refused_last_ = true;
    port_.fact("refused_last", describe(decoded));
    return port_.refused(to_string(decoded.fault));
  }
  refused_last_ = false;
  auto vision = std::make_shared<base::Vision>(seen(decoded.datagram));
  vision->sensor = port_.name();
  vision->stamp = stamp - base::from_seconds(params_.latency_s);
  vision->count = count_++;
  port_.received(stamp);
  port_.fact("landmarks", std::to_string(vision->landmarks.size()));
  port_.fact("obstacles", std::to_string(vision->obstacles.size()));
  port_.fact("planes", std::to_string(vision->planes.size()));
  port_.heard(stamp);
  on_vision_(std::move(vision));
}

}  // namespace roverd::vision
