#include "gpsd/report.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstring>
#include <ctime>
#include <utility>

#include <gps.h>

#include "base/angle.hpp"

namespace roverd::gpsd {
namespace {

constexpr int kPort = 2947;
/// GST belongs to the position of its epoch, told before or after it.
constexpr double kGstReach_s = 2.0;

std::optional<double> told(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}
std::optional<double> positive(double value) {
  return std::isfinite(value) && value > 0.0 ? std::optional(value) : std::nullopt;
}

base::FixType fix_of(const gps_fix_t& fix) noexcept {
  if (fix.mode < MODE_2D) return base::FixType::None;
  switch (fix.status) {
    case STATUS_NO_FIX:  // not said: a plain one
    case STATUS_FIX:
    case STATUS_PPS_FIX:
      return base::FixType::Single;
    case STATUS_DGPS_FIX:
      return base::FixType::Differential;
    case STATUS_RTK_FIX:
      return base::FixType::RtkFixed;
    case STATUS_RTK_FLT:
      return base::FixType::RtkFloat;
    case STATUS_DR:
    case STATUS_GNSSDR:
      return base::FixType::Estimated;
    default:
      return base::FixType::Unknown;  // surveyed in, simulated
  }
}

std::string_view system_of(int gnssid) noexcept {
  constexpr std::array<std::string_view, 8> kWords{"gps",     "sbas", "galileo", "beidou",
                                                   "unknown", "qzss", "glonass", "navic"};
  const auto i = static_cast<std::size_t>(gnssid);
  return i < kWords.size() ? kWords[i] : "unknown";
}

/// "TPV" of {"class":"TPV", …}.
std::string_view class_of(std::string_view line) {
  constexpr std::string_view kBegin = "{\"class\":\"";
  if (!line.starts_with(kBegin)) return {};
  line.remove_prefix(kBegin.size());
  const auto end = line.find('"');
  return end == std::string_view::npos ? std::string_view() : line.substr(0, end);
}

/// libgps 3.22 reads for ever in a line in which another report, or its beginning, follows the
/// first.
constexpr std::string_view kClassKey = "\"class\":";

/// End of the year 2099; nanoseconds of far later ones do not fit into 64 bits.
constexpr std::time_t kLastSecond = 4'102'444'799;

/// Reports of devices nest others, and tell nothing that is used here.
bool needs_libgps(std::string_view kind) {
  return kind == "TPV" || kind == "SKY" || kind == "GST" || kind == "ATT" || kind == "VERSION" ||
         kind == "ERROR";
}

}  // namespace

base::Result<Source> parse_source(const std::string& text) {
  const auto refuse = [&text] {
    return base::fail(base::Code::Invalid, "\"" + text + "\" must be gpsd://HOST[:PORT][/DEVICE]");
  };
  if (!is_source(text)) return refuse();
  const std::string rest = text.substr(std::strlen("gpsd://"));
  const auto slash = rest.find('/');
  const std::string host_port = rest.substr(0, slash);
  Source out;
  if (slash != std::string::npos) out.device = rest.substr(slash);
  const bool plain = std::ranges::all_of(
      out.device, [](char c) { return c > ' ' && c <= '~' && c != '"' && c != '\\'; });
  const auto colon = host_port.rfind(':');
  const std::string host = host_port.substr(0, colon);
  int port = kPort;
  if (colon != std::string::npos) {
    const char* end = host_port.data() + host_port.size();
    const auto [at, ec] = std::from_chars(host_port.data() + colon + 1, end, port);
    if (ec != std::errc{} || at != end || port < 1 || port > 65535) return refuse();
  }
  if (host.empty() || !plain) return refuse();
  out.address = "tcp:" + host + ":" + std::to_string(port);
  return out;
}

std::string watch_request(const std::string& device) {
  std::string out = R"(?WATCH={"enable":true,"json":true)";
  if (!device.empty()) out += R"(,"device":")" + device + "\"";
  return out + "};\n";
}

Reader::Reader(ReaderOptions options, Ears ears)
    : options_(std::move(options)),
      ears_(std::move(ears)),
      data_(std::make_unique<gps_data_t>()),
      device_(options_.device) {}

Reader::~Reader() = default;

void Reader::reset() {
  device_ = options_.device;
  hdop_.reset();
  used_.reset();
  gst_.reset();
  clock_s_.reset();
}

bool Reader::take(std::string_view line, Time stamp) {
  const bool printable = std::ranges::all_of(line, [](char c) { return c >= ' ' && c <= '~'; });
  const std::string_view kind = class_of(line);
  if (!printable || kind.empty() || line.back() != '}') {
    ears_.refused("line that is no report of gpsd");
    return false;
  }
  if (!needs_libgps(kind)) return true;
  if (line.find(kClassKey) != line.rfind(kClassKey)) {
    ears_.refused("line of several reports");
    return false;
  }
  *data_ = gps_data_t{};
  gps_clear_fix(&data_->fix);
  std::string copy(line);  // libgps wants to write into it
  if (::gps_unpack(copy.data(), data_.get()) < 0) {
    ears_.refused("report that libgps refuses");
    return false;
  }
  if (kind == "ERROR") ears_.refused("error of gpsd");
  if (kind == "VERSION") ears_.fact("gpsd", std::string(data_->version.release));
  const bool measures = kind == "TPV" || kind == "SKY" || kind == "GST" || kind == "ATT";
  if (!measures) return kind != "ERROR";
  if (!ours()) {
    ears_.noted("report of another device");
    return true;
  }
  if (kind == "TPV") on_tpv(stamp);
  if (kind == "SKY") on_sky(stamp);
  if (kind == "GST") on_gst(stamp);
  if (kind == "ATT") on_att(stamp);
  return true;
}

/// gpsd may serve several receivers, and one robot stands at one place.
bool Reader::ours() {
  const std::string from(data_->dev.path);
  if (device_.empty() && !from.empty()) {
    device_ = from;
    ears_.fact("device", from);
  }
  return from.empty() || from == device_;
}

void Reader::on_tpv(Time stamp) {
  const gps_fix_t& f = data_->fix;
  base::GnssFix fix;
  fix.stamp = stamp;
  fix.fix = fix_of(f);
  fix.satellites = used_;
  fix.hdop = hdop_;
  if (f.time.tv_sec > kLastSecond) return ears_.refused("impossible date");
  if (f.time.tv_sec > 0) {
    fix.utc = base::WallTime{std::chrono::seconds(f.time.tv_sec) +
                             std::chrono::nanoseconds(f.time.tv_nsec)};
  }
  const bool placed = fix.fix != base::FixType::None && fix.fix != base::FixType::Unknown;
  const base::LatLon at{f.latitude, f.longitude};
  if (placed && std::isnan(at.lat) && std::isnan(at.lon)) {
    // The first sentence of an epoch may name the mode alone; the position follows.
    ears_.noted("fix without a position");
    return;
  }
  if (placed && !(std::isfinite(at.lat) && std::isfinite(at.lon) && std::abs(at.lat) <= 90.0 &&
                  std::abs(at.lon) <= 180.0)) {
    ears_.refused("position that is not on earth");
    return;
  }
  if (!placed) return ears_.tell(fix);
  clock_s_ = f.time.tv_sec > 0 ? std::optional(static_cast<double>(f.time.tv_sec) +
                                               static_cast<double>(f.time.tv_nsec) / 1e9)
                               : std::nullopt;
  fix.position = at;
  fix.alt_msl_m = told(f.altMSL);
  fix.geoid_sep_m = told(f.geoid_sep);
  fix.correction_age_s = positive(f.dgps_age);
  fix.sigma_east_m = positive(f.epx);
  fix.sigma_north_m = positive(f.epy);
  if (gst_ && std::abs(base::seconds(stamp - gst_->stamp)) < kGstReach_s) {
    fix.sigma_east_m = gst_->east_m;
    fix.sigma_north_m = gst_->north_m;
  }
  ears_.tell(fix);
  if (!std::isfinite(f.speed) || f.speed < 0.0 || f.speed > 1000.0) return;
  // Standing, there is no course.
  const bool stands = !std::isfinite(f.track);
  if (stands && f.speed > 0.1) return;
  const double yaw = stands ? 0.0 : base::yaw_from_heading(f.track);
  const double speed = stands ? 0.0 : f.speed;
  ears_.tell(
      base::GnssVelocity{stamp, speed * std::cos(yaw), speed * std::sin(yaw), positive(f.eps)});
}

void Reader::on_sky(Time stamp) {
  hdop_ = positive(data_->dop.hdop);
  const int count = std::clamp(data_->satellites_visible, 0, MAXCHANNELS);
  if (count == 0) return;  // DOPs alone
  auto all = std::make_shared<std::vector<base::Satellite>>();
  int used = 0;
  for (int i = 0; i < count; ++i) {
    const satellite_t& s = data_->skyview[i];
    base::Satellite out{
        std::string(system_of(s.gnssid)), s.svid > 0 ? s.svid : s.PRN, {}, {}, {}, s.used};
    if (std::isfinite(s.elevation) && std::abs(s.elevation) <= 90.0) {
      out.elevation_deg = s.elevation;
    }
    if (std::isfinite(s.azimuth) && s.azimuth >= 0.0 && s.azimuth <= 360.0) {
      out.azimuth_deg = std::fmod(s.azimuth, 360.0);
    }
    out.cn0_dbhz = positive(s.ss);
    used += s.used ? 1 : 0;
    all->push_back(std::move(out));
  }
  used_ = used;
  ears_.tell(base::SatellitesInView{stamp, options_.driver, std::move(all)});
}

void Reader::on_gst(Time stamp) {
  const auto east = positive(data_->gst.lon_err_deviation);
  const auto north = positive(data_->gst.lat_err_deviation);
  if (east && north) gst_ = Sigmas{stamp, *east, *north};
}

void Reader::on_att(Time stamp) {
  const double heading = data_->attitude.heading;
  if (!std::isfinite(heading) || heading < 0.0 || heading > 360.0) return;
  ears_.tell(base::Heading{stamp,
                           base::yaw_from_heading(heading + options_.heading_offset_deg),
                           options_.heading_source,
                           {}});
}

}  // namespace roverd::gpsd
