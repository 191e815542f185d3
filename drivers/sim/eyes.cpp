#include "sim/eyes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "sim/vision_voice.hpp"
#include "sim/world/draw.hpp"

namespace roverd::sim {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
/// What a scanner says of a beam that was dazzled or met its own window: a reserved word.
constexpr std::uint16_t kReserved = 1;
constexpr std::size_t kMostWaiting = 4096;

/// Of the fact sheet: what sFA says.
constexpr int kDenied = 1;
constexpr int kUnknownVariable = 3;
constexpr int kInvalidData = 5;
/// What mLMPsetscancfg answers.
constexpr std::uint8_t kDone = 0;
constexpr std::uint8_t kFrequencyError = 1;
constexpr std::uint8_t kResolutionError = 2;

std::int32_t e4deg(double deg) {
  return static_cast<std::int32_t>(std::lround(deg * 1e4));
}
/// 25 Hz with 0.25 or 0.5 degrees, 50 Hz with 0.5.
std::uint8_t lms1xx_can(const sick::ScanConfig& c) {
  if (c.frequency_chz != 2500 && c.frequency_chz != 5000) return kFrequencyError;
  const bool fine = c.step_e4deg == 2500 && c.frequency_chz == 2500;
  return fine || c.step_e4deg == 5000 ? kDone : kResolutionError;
}

/// Of its name and dialect only.
void write_answer(sick::Writer& out, std::string_view kind, std::string_view name) {
  if (name == "STlms") {
    out.u16(sick::kMeasuring);
    out.u16(0);
  } else if (name == "DeviceIdent") {
    out.text("LMS1xx_SIM");
    out.text("V1.0");
  } else if (name == "SerialNumber" || name == "FirmwareVersion") {
    out.text("1");
  } else if (name == "LMDscandata") {
    out.u8(1);
  } else if (kind == "sMN") {
    out.u8(name == "LMCstartmeas" || name == "LMCstopmeas" ? 0 : 1);
  }
}

std::uint16_t azimuth_cdeg_of(const world::Shot& s) {
  const double turn = std::fmod(720.0 - static_cast<double>(s.bearing_rad) / kDegree, 360.0);
  return static_cast<std::uint16_t>(std::lround(turn * 100.0) % velodyne::kTurn_cdeg);
}

velodyne::Return vlp_return(float range_m, float light) {
  velodyne::Return out;
  out.distance = static_cast<std::uint16_t>(
      std::clamp(std::lround(static_cast<double>(range_m) / velodyne::kUnit_m), 0L, 65535L));
  out.reflectivity = static_cast<std::uint8_t>(std::clamp(light * 100.0F, 0.0F, 100.0F));
  return out;
}

/// Of one firing of one laser; where there is one echo all three are it.
struct VlpReturns {
  velodyne::Return strongest;
  velodyne::Return last;   ///< the farther
  velodyne::Return other;  ///< that which the last is not
};

VlpReturns vlp_returns(const world::Shot& s) {
  const velodyne::Return first = vlp_return(s.range_m, s.intensity);
  if (s.second_m <= 0.0F) return {first, first, first};
  const velodyne::Return second = vlp_return(s.second_m, s.second_intensity);
  const bool behind = second.distance >= first.distance;
  return {.strongest = s.second_intensity > s.intensity ? second : first,
          .last = behind ? second : first,
          .other = behind ? first : second};
}

velodyne::ReturnMode mode_of(const world::SensorParams& p) {
  if (p.returns == "dual") return velodyne::ReturnMode::Dual;
  return p.returns == "last" ? velodyne::ReturnMode::Last : velodyne::ReturnMode::Strongest;
}

std::uint32_t wrapped_us(double s) {
  return static_cast<std::uint32_t>(static_cast<std::uint64_t>(std::max(0.0, s) * 1e6));
}

}  // namespace

std::vector<std::uint8_t> LmsVoice::receive(base::Bytes bytes) {
  std::vector<std::uint8_t> out;
  framer_.feed(bytes, [&](const sick::Telegram& telegram) {
    const auto words = sick::words_of(telegram);
    if (!words) return;
    const auto said = answer(telegram, *words);
    out.insert(out.end(), said.begin(), said.end());
  });
  return out;
}

std::vector<std::uint8_t> LmsVoice::answer(const sick::Telegram& telegram,
                                           const sick::Words& words) {
  dialect_ = telegram.dialect;
  const std::string_view kind = words.kind == "sRN"   ? "sRA"
                                : words.kind == "sWN" ? "sWA"
                                : words.kind == "sMN" ? "sAN"
                                : words.kind == "sEN" ? "sEA"
                                                      : "";
  if (kind.empty()) return refused(kUnknownVariable);
  if (words.kind == "sMN" && words.name == "SetAccessMode") {
    sick::Fields fields(telegram.dialect, telegram.body, words.fields_at);
    const bool client = fields.u8("level") >= 3 && fields.u32("hash") == sick::kClientPassword;
    logged_in_ = client && fields.ok();
    return sick::Writer(dialect_, "sAN", words.name).u8(logged_in_ ? 1 : 0).framed();
  }
  if (words.kind == "sWN" || words.name == "mLMPsetscancfg") return set(telegram, words);
  sick::Writer out(dialect_, kind, words.name);
  if (words.kind == "sEN" && words.name == sick::kScanData) {
    sick::Fields fields(telegram.dialect, telegram.body, words.fields_at);
    subscribed_ = fields.u8("on") != 0;
    return out.u8(subscribed_ ? 1 : 0).framed();
  }
  if (words.kind != "sWN") write_answer(out, words.kind, words.name);
  return out.framed();
}

std::vector<std::uint8_t> LmsVoice::refused(int code) const {
  sick::Writer out(dialect_, "sFA", "");
  out.u8(static_cast<std::uint8_t>(code));
  return out.framed();
}

std::vector<std::uint8_t> LmsVoice::set(const sick::Telegram& telegram, const sick::Words& words) {
  if (!logged_in_) return refused(kDenied);
  sick::Fields fields(telegram.dialect, telegram.body, words.fields_at);
  if (words.name == "mLMPsetscancfg") return set_scan(fields);
  if (words.name == "LMPoutputRange") {
    const sick::OutputRange range = sick::read_output_range(fields);
    if (!fields.ok() || range.start_e4deg >= range.stop_e4deg) return refused(kInvalidData);
    range_ = range;
  } else if (words.name == "LMDscandatacfg") {
    const sick::DataConfig data = sick::read_data_config(fields);
    if (!fields.ok() || data.every == 0) return refused(kInvalidData);
    data_ = data;
  } else {
    return refused(kUnknownVariable);
  }
  return sick::Writer(dialect_, "sWA", words.name).framed();
}

/// Its field is what it is: only frequency and resolution change.
std::vector<std::uint8_t> LmsVoice::set_scan(sick::Fields& fields) {
  const sick::ScanConfig wanted = sick::read_scan_config(fields);
  if (!fields.ok()) return refused(kInvalidData);
  const std::uint8_t status = lms1xx_can(wanted);
  if (status == kDone) {
    params_.rate_hz = wanted.frequency_chz / 100.0;
    params_.step_deg = wanted.step_e4deg / 1e4;
  }
  sick::Writer out(dialect_, "sAN", "mLMPsetscancfg");
  out.u8(status);
  sick::write(out, {.frequency_chz = static_cast<std::uint32_t>(e4deg(params_.rate_hz) / 100),
                    .sectors = 1,
                    .step_e4deg = static_cast<std::uint32_t>(e4deg(params_.step_deg)),
                    .start_e4deg = e4deg(params_.fov_from_deg + 90.0),
                    .stop_e4deg = e4deg(params_.fov_to_deg + 90.0)});
  return out.framed();
}

bool LmsVoice::sends(std::int32_t angle_e4deg) const noexcept {
  return !range_ || (angle_e4deg >= range_->start_e4deg && angle_e4deg <= range_->stop_e4deg);
}

std::vector<std::uint8_t> LmsVoice::say(const world::Sweep& sweep,
                                        const world::SensorFaults& faults) {
  ++scans_;
  if (!subscribed_ || scans_ % data_.every != 0) return {};
  sick::Scan scan;
  scan.serial = 4711;
  scan.status[1] =
      static_cast<std::uint8_t>((faults.sensor_heating ? 1 : 0) | (sweep.blocked        ? 4
                                                                   : sweep.dirty > 0.0F ? 2
                                                                                        : 0));
  scan.telegram_count = ++telegrams_;
  scan.scan_count = scans_;
  scan.start_us = wrapped_us(sweep.at_s - begin_s_);
  scan.sent_us = wrapped_us(sweep.until_s - begin_s_);
  scan.scan_frequency_chz = static_cast<std::uint32_t>(std::lround(params_.rate_hz * 100.0));
  scan.measuring_hhz =
      static_cast<std::uint32_t>(std::lround(params_.rate_hz * 360.0 / params_.step_deg / 100.0));
  sick::Channel distance;
  distance.name = "DIST1";
  // The scanner's angles: 90 degrees ahead.
  distance.start_e4deg =
      static_cast<std::int32_t>(std::lround((params_.fov_from_deg + 90.0) * 1e4));
  distance.step_e4deg = static_cast<std::uint16_t>(std::lround(params_.step_deg * 1e4));
  distance.scale = params_.far_m > 60.0 ? 2.0F : 1.0F;
  sick::Channel remission = distance;
  remission.name = "RSSI1";
  remission.scale = 1.0F;
  std::int32_t angle_e4deg = distance.start_e4deg - distance.step_e4deg;
  for (const world::Shot& s : sweep.shots) {
    angle_e4deg += distance.step_e4deg;
    if (!sends(angle_e4deg)) continue;
    if (distance.values.empty()) distance.start_e4deg = remission.start_e4deg = angle_e4deg;
    const double raw =
        static_cast<double>(s.range_m) * 1000.0 / static_cast<double>(distance.scale);
    const bool dazzled =
        s.cause == world::Cause::Sun || (s.cause == world::Cause::Window && s.range_m <= 0.0F);
    distance.values.push_back(
        dazzled ? kReserved : static_cast<std::uint16_t>(std::clamp(std::lround(raw), 0L, 65535L)));
    remission.values.push_back(
        static_cast<std::uint16_t>(std::lround(std::clamp(s.intensity, 0.0F, 1.0F) * 1000.0F)));
  }
  scan.channels.push_back(std::move(distance));
  if (data_.remission) scan.channels.push_back(std::move(remission));
  return sick::encode(scan, dialect_);
}

void LmsVoice::restart(double now_s) {
  begin_s_ = now_s;
  params_ = usual_;
  subscribed_ = logged_in_ = false;
  range_.reset();
  data_ = {};
  telegrams_ = scans_ = 0;
  framer_.forget();
}

std::vector<std::uint8_t> vlp16_packet(const world::Sweep& sweep, velodyne::ReturnMode mode,
                                       std::size_t first) {
  velodyne::Packet packet;
  packet.mode = mode;
  const std::size_t together = packet.together();
  const std::size_t begin = first * velodyne::kLasers;
  const std::size_t shots = velodyne::kBlocks / together * velodyne::kChannels;
  for (std::size_t i = 0; i < shots && begin + i < sweep.shots.size(); ++i) {
    const world::Shot& s = sweep.shots[begin + i];
    const std::size_t channel = i % velodyne::kChannels;
    velodyne::Block& even = packet.blocks[i / velodyne::kChannels * together];
    if (channel == 0) even.azimuth_cdeg = azimuth_cdeg_of(s);
    const VlpReturns r = vlp_returns(s);
    even.channels[channel] = mode == velodyne::ReturnMode::Strongest ? r.strongest : r.last;
    if (together == 1) continue;
    velodyne::Block& odd = packet.blocks[i / velodyne::kChannels * together + 1];
    odd.azimuth_cdeg = even.azimuth_cdeg;
    odd.channels[channel] = r.strongest == r.last ? r.other : r.strongest;
  }
  const double at_s = sweep.at_s + static_cast<double>(first) * world::kVlpFiring_s;
  const auto us = static_cast<std::uint64_t>(std::llround(std::max(0.0, at_s) * 1e6));
  packet.stamp_us = static_cast<std::uint32_t>(us % velodyne::kHour_us);
  const auto bytes = velodyne::encode(packet);
  return {bytes.begin(), bytes.end()};
}

std::vector<std::uint8_t> depth_frame(const world::SensorParams& p, const world::Sweep& sweep,
                                      double at_s, bool good) {
  cloud::Header header;
  header.kind = cloud::Kind::Depth;
  header.good = good;
  header.stamp_ns = std::llround(std::max(0.0, at_s) * 1e9);
  header.sequence = static_cast<std::uint32_t>(sweep.count);
  cloud::Depth image;
  image.width = static_cast<std::uint16_t>(p.columns);
  image.height = static_cast<std::uint16_t>(p.rows);
  image.fx = static_cast<float>(p.columns / 2.0 / std::tan(p.fov_h_deg * kDegree / 2.0));
  image.fy = static_cast<float>(p.rows / 2.0 / std::tan(p.fov_v_deg * kDegree / 2.0));
  // The middle of the first pixel is 0.
  image.cx = static_cast<float>((p.columns - 1) / 2.0);
  image.cy = static_cast<float>((p.rows - 1) / 2.0);
  std::vector<std::uint16_t> pixels;
  pixels.reserve(sweep.shots.size());
  for (const world::Shot& s : sweep.shots) {
    const double ahead_m = static_cast<double>(s.range_m) *
                           std::cos(static_cast<double>(s.bearing_rad)) *
                           std::cos(static_cast<double>(s.elevation_rad));
    pixels.push_back(
        static_cast<std::uint16_t>(std::clamp(std::lround(ahead_m * 1e3), 0L, 65535L)));
  }
  const auto data = cloud::bytes_of(pixels);
  image.data = data;
  return cloud::encode(header, image);
}

std::vector<std::uint8_t> range_line(const world::Sweep& sweep) {
  const float range_m = sweep.shots.empty() ? 0.0F : sweep.shots.front().range_m;
  char text[32];
  const int size = range_m > 0.0F
                       ? std::snprintf(text, sizeof text, "%.3f\n", static_cast<double>(range_m))
                       : std::snprintf(text, sizeof text, "oor\n");
  return {text, text + size};
}

Eye::Eye(const world::SensorParams& p, std::uint64_t seed, double begin_s)
    : seed_(seed), sensor_(p, seed, begin_s) {
  if (p.kind == "lms") lms_.emplace(p, begin_s);
  if (p.kind == "picture") picture_.emplace(p);
}

std::vector<std::uint8_t> Eye::receive(base::Bytes bytes) {
  if (picture_ && !cut_) return picture_->receive(bytes);
  if (!lms_ || cut_) return {};
  auto out = lms_->receive(bytes);
  take_wanted();
  return out;
}

/// From the piece on that comes next, it is cast as was set.
void Eye::take_wanted() {
  const world::SensorParams& now = sensor_.params();
  const world::SensorParams& wanted = lms_->wanted();
  if (wanted.rate_hz == now.rate_hz && wanted.step_deg == now.step_deg) return;
  sensor_ = world::Sensor(wanted, seed_, sensor_.next_s() - 1.0 / now.rate_hz);
  sweep_.shots.clear();
}

void Eye::wait(double due_s, std::vector<std::uint8_t> bytes) {
  if (bytes.empty() || waiting_.size() >= kMostWaiting) return;
  waiting_.push_back({due_s, std::move(bytes)});
}

/// A packet leaves when its last firing is done.
void Eye::speak_vlp16(double late_s) {
  const velodyne::ReturnMode mode = mode_of(params());
  const std::size_t firings = world::kVlpFirings / (mode == velodyne::ReturnMode::Dual ? 2 : 1);
  for (std::size_t first = 0; first < world::kVlpFirings; first += firings) {
    const std::size_t end = std::min((first + firings) * velodyne::kLasers, sweep_.shots.size());
    if (end <= first * velodyne::kLasers) return;
    const double until_s = sweep_.at_s + static_cast<double>(sweep_.shots[end - 1].after_s);
    wait(until_s + late_s, vlp16_packet(sweep_, mode, first));
  }
}

void Eye::speak(const Surroundings& around, const world::SensorFaults& faults) {
  const double late_s = params().latency_s + faults.sensor_latency_s;
  if (params().kind == "vlp16") return speak_vlp16(late_s);
  const double due_s = sweep_.until_s + late_s;
  if (lms_) return wait(due_s, lms_->say(sweep_, faults));
  if (picture_) return wait(due_s, picture_->say(around, sweep_, faults));
  if (params().kind == "range") return wait(due_s, range_line(sweep_));
  if (params().kind == "vision") {
    const std::uint64_t own = world::spread(seed_) ^ world::key_of(params().name);
    return wait(due_s,
                vision_datagram(sweep_, around.scene().world(), faults.sensor_malformed, own));
  }
  wait(due_s, depth_frame(params(), sweep_, sweep_.at_s, !faults.sensor_heating));
}

void Eye::advance(const Surroundings& around, const world::SensorFaults& all,
                  const std::function<void(base::Bytes)>& say) {
  const world::SensorFaults faults = world::faults_of(all, params().name);
  const double now_s = around.now_s();
  if (cut_ && !faults.sensor_restart && lms_) {
    lms_->restart(now_s);
    take_wanted();
  }
  cut_ = faults.sensor_restart;
  if (cut_ || faults.sensor_silent) {
    sensor_.skip_to(now_s);
    waiting_.clear();
    return;
  }
  while (sensor_.next_s() <= now_s) {
    if (faults.sensor_freeze && !sweep_.shots.empty()) {
      world::Sweep anew;
      anew.at_s = sensor_.next_s() - (sweep_.until_s - sweep_.at_s);
      sensor_.skip_to(sensor_.next_s());
      sweep_.until_s += anew.at_s - sweep_.at_s;
      sweep_.at_s = anew.at_s;
    } else {
      sensor_.sweep(
          around.scene(), [&](double at_s) { return around.pose_at(at_s); }, faults, sweep_);
    }
    speak(around, faults);
  }
  while (!waiting_.empty() && waiting_.front().due_s <= now_s) {
    say(waiting_.front().bytes);
    waiting_.pop_front();
  }
}

}  // namespace roverd::sim
