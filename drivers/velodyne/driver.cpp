#include "velodyne/driver.hpp"

#include <cstdio>
#include <utility>

namespace roverd::velodyne {
namespace {

std::string fixed(const char* format, double value) {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

const char* pps_word(std::uint8_t state) noexcept {
  constexpr std::array kWords{"absent", "synchronizing", "locked", "in error"};
  return state < kWords.size() ? kWords[state] : "unknown";
}

}  // namespace

Driver::Driver(std::string name, const Params& params, MakeLink make_link,
               OnMeasurement on_measurement, base::OnSight on_sight, MakeLink make_position)
    : params_(params),
      on_sight_(std::move(on_sight)),
      make_position_(std::move(make_position)),
      revolutions_(name, params, [this](const Turn& t) { on_turn(t); }),
      port_(
          {std::move(name), "waiting for a whole turn", params.retry_first_s, params.retry_max_s},
          std::move(make_link), [this](Bytes b, Time t) { on_packet(b, t); },
          [this] {
            revolutions_.forget();
            heard_packet_ = false;
          },
          std::move(on_measurement)) {
  port_.on_completing([this](base::DriverStatus& s) { complete(s); });
}

Driver::~Driver() {
  close_position();
}

void Driver::start(Time now) {
  listen_position();
  port_.start(now);
}

void Driver::stop(Time now) {
  close_position();
  port_.stop(now);
}

void Driver::restart(Time now) {
  stop(now);
  start(now);
}

void Driver::tick(Time now) {
  const double silent_s = base::seconds(now - port_.last_heard());
  const auto why = [&] {
    const bool packets_come = heard_packet_ && base::seconds(now - stamp_) < params_.silent_after_s;
    return packets_come ? std::string(
                              "no whole turn, though packets come: the head stands, or a "
                              "sector is filtered, or packets are refused")
                        : std::string("no packet of the sensor");
  };
  if (port_.is_open() && params_.silent_reopen_s > 0.0 && silent_s > params_.silent_reopen_s) {
    port_.fail(why(), now);
  } else if (port_.is_up() && silent_s > params_.silent_after_s) {
    port_.lose(why(), now);
  }
  port_.tick(now);
}

void Driver::on_packet(Bytes datagram, Time stamp) {
  const Decoded decoded = decode(datagram);
  if (decoded.fault != Fault::None) return port_.refused(describe(decoded));
  port_.received(stamp);
  heard_packet_ = true;
  stamp_ = stamp;
  product_ = decoded.packet.product;
  mode_ = decoded.packet.mode;
  revolutions_.add(decoded.packet, stamp);
}

void Driver::on_turn(const Turn& turn) {
  port_.fact("product", std::string(to_string(product_)));
  port_.fact("return_mode", std::string(to_string(mode_)));
  if (turn.whole) {
    port_.heard(stamp_);
    port_.fact("rpm", fixed("%.0f", 60.0 / turn.duration_s));
    port_.fact("missing_pct", fixed("%.1f", 100.0 * turn.missing / turn.firings));
    port_.fact("points", std::to_string(turn.sight->points.size()));
  }
  on_sight_(turn.sight);
}

void Driver::complete(base::DriverStatus& status) const {
  auto detail = std::make_shared<base::DriverDetail>(*status.detail);
  const auto& c = revolutions_.counts();
  const auto tell = [&](const char* what, std::uint64_t n) {
    if (n > 0) detail->counts[what] = n;
  };
  detail->lost = c.lost;
  detail->twice = c.duplicates;
  tell("packets lost", c.lost);
  tell("packets twice", c.duplicates);
  tell("packets late", c.late);
  tell("jumps of the sensor's clock", c.jumps);
  tell("packets with a gap in the azimuth", c.gaps);
  status.detail = std::move(detail);
}

void Driver::listen_position() {
  if (!make_position_ || position_) return;
  auto made = make_position_();
  if (!made) return port_.fact("position", made.error().detail);
  position_ = std::move(*made);
  position_->on_bytes = [this](Bytes b, Time) { on_position(b); };
  position_->on_closed = [this](const std::string& reason) { port_.fact("position", reason); };
  const auto opened = position_->open();
  port_.fact("position", opened ? "not heard yet" : opened.error().detail);
}

void Driver::close_position() noexcept {
  if (position_) position_->close();
  position_.reset();
}

void Driver::on_position(Bytes datagram) {
  const DecodedPosition decoded = decode_position(datagram);
  if (decoded.fault != Fault::None) return port_.refused("a position packet that is none");
  port_.fact("position", "heard");
  port_.fact("pps", pps_word(decoded.position.pps));
  port_.fact("nmea", decoded.position.nmea.empty() ? "none" : decoded.position.nmea);
}

}  // namespace roverd::velodyne
