#include "ranges/driver.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace roverd::ranges {

Driver::Driver(std::string name, const Params& params, MakeLink make_link,
               OnMeasurement on_measurement, base::OnSight on_sight)
    : params_(params),
      unit_m_(metres_of(params.unit).value_or(1.0)),
      on_sight_(std::move(on_sight)),
      fans_(params),
      port_(
          {std::move(name), "waiting for a line", params.retry_first_s, params.retry_max_s},
          std::move(make_link),
          [this](Bytes b, Time t) {
            lines_.feed(
                b, [&](std::string_view line) { on_line(line, t); },
                [this] { port_.refused("a line that is too long"); });
          },
          [this] { lines_.forget(); }, std::move(on_measurement)) {}

void Driver::start(Time now) {
  port_.start(now);
}

void Driver::restart(Time now) {
  stop(now);
  start(now);
}

void Driver::tick(Time now) {
  const double silent_s = base::seconds(now - port_.last_heard());
  if (port_.is_open() && params_.silent_reopen_s > 0.0 && silent_s > params_.silent_reopen_s) {
    port_.fail(port_.silence("no ranges"), now);
  } else if (port_.is_up() && silent_s > params_.silent_after_s) {
    port_.lose(port_.silence("no ranges"), now);
  }
  port_.tick(now);
}

void Driver::on_line(std::string_view text, Time stamp) {
  const Line line = parse(text, unit_m_);
  if (line.fault != nullptr) return port_.refused(line.fault);
  if (line.readings.size() != static_cast<std::size_t>(params_.count)) {
    return port_.refused("a line with more or fewer ranges than set");
  }
  const auto refused = std::count_if(line.readings.begin(), line.readings.end(),
                                     [](auto& r) { return r.outcome == Outcome::Refused; });
  if (refused > 0) port_.count("a range that is none", static_cast<std::uint64_t>(refused));
  if (refused == params_.count) return;
  auto sight = std::make_shared<base::Sight>();
  sight->sensor = port_.name();
  sight->stamp = stamp - base::from_seconds(params_.latency_s);
  sight->count = count_++;
  fans_.spread(line.readings, *sight);
  tell_facts(line.readings);
  port_.received(stamp);
  port_.heard(stamp);
  on_sight_(std::move(sight));
}

void Driver::tell_facts(const std::vector<Reading>& readings) {
  std::string all;
  std::size_t missing = 0;
  for (const Reading& r : readings) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f", r.range_m);
    const bool seen = r.outcome == Outcome::Range;
    if (!seen) ++missing;
    all += (all.empty() ? "" : " ");
    all += seen ? text : r.outcome == Outcome::Nothing ? "-" : "?";
  }
  port_.fact("ranges_m", all);
  char share[32];
  std::snprintf(share, sizeof share, "%.1f",
                100.0 * static_cast<double>(missing) / static_cast<double>(readings.size()));
  port_.fact("missing_pct", share);
}

}  // namespace roverd::ranges
