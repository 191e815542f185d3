#include "gnss/sky.hpp"

#include <algorithm>
#include <array>
#include <memory>

namespace roverd::gnss {
namespace {

struct System {
  std::string_view talker;
  int number;  ///< of GSA
  std::string_view word;
};
constexpr std::array kSystems{System{"GP", 1, "gps"},     System{"GL", 2, "glonass"},
                              System{"GA", 3, "galileo"}, System{"GB", 4, "beidou"},
                              System{"BD", 4, "beidou"},  System{"GQ", 5, "qzss"},
                              System{"QZ", 5, "qzss"},    System{"GI", 6, "navic"}};

std::string_view system_word(const Talker& talker, std::optional<int> nmea_system) noexcept {
  for (const System& s : kSystems) {
    if (nmea_system ? s.number == *nmea_system : s.talker == talker.view()) return s.word;
  }
  return "unknown";
}

struct Range {
  int first;
  int last;
  std::string_view word;
  int minus;
};
/// Numbers that say their system by themselves.
constexpr std::array kRanges{Range{33, 64, "sbas", -87},     Range{65, 96, "glonass", 64},
                             Range{120, 158, "sbas", 0},     Range{193, 202, "qzss", 192},
                             Range{201, 263, "beidou", 200}, Range{301, 336, "galileo", 300},
                             Range{401, 463, "beidou", 400}};

std::string_view ubx_system(int gnss_id) noexcept {
  constexpr std::array<std::string_view, 8> kWords{"gps",     "sbas", "galileo", "beidou",
                                                   "unknown", "qzss", "glonass", "navic"};
  const auto i = static_cast<std::size_t>(gnss_id);
  return i < kWords.size() ? kWords[i] : "unknown";
}

/// @param placed the satellites are those of NAV-SAT, which says itself what is used.
void add_signal(std::vector<base::Satellite>& all, const ubx::NavSig::One& s, bool placed) {
  const std::string_view system = ubx_system(s.gnss_id);
  auto of = std::ranges::find_if(all, [&](const base::Satellite& known) {
    return known.system == system && known.number == s.number;
  });
  if (of == all.end()) {
    if (placed) return;  // of another epoch
    all.push_back({std::string(system), s.number, {}, {}, {}, false});
    of = all.end() - 1;
  }
  const std::string_view name = ubx::signal_name(s.gnss_id, s.signal_id);
  base::SatelliteSignal signal{
      name.empty() ? "signal " + std::to_string(s.signal_id) : std::string(name), {}, s.used()};
  if (s.cn0_dbhz > 0) signal.cn0_dbhz = s.cn0_dbhz;
  of->signals.push_back(std::move(signal));
  if (placed) return;
  of->used = of->used.value_or(false) || s.used();
  if (s.cn0_dbhz > 0) of->cn0_dbhz = std::max<double>(of->cn0_dbhz.value_or(0.0), s.cn0_dbhz);
}

}  // namespace

SatelliteName satellite_name(const Talker& talker, std::optional<int> nmea_system,
                             int id) noexcept {
  const std::string_view word = system_word(talker, nmea_system);
  for (const Range& r : kRanges) {
    if (id < r.first || id > r.last) continue;
    // 33-64 of another system than GPS are its own (BeiDou has 63, Galileo 36).
    const bool own = word != "unknown" && word != r.word;
    const bool shared = word == "gps" && (r.word == "sbas" || r.word == "qzss");
    if (own && !shared) continue;
    return {r.word, id - r.minus};
  }
  return {word == "unknown" && id <= 32 ? "gps" : word, id};
}

void Sky::add(const Sentence& sentence, Time stamp) {
  const auto* gsa = std::get_if<Gsa>(&sentence);
  if (gsa != nullptr) {
    if (!in_gsa_) used_.clear();
    knows_used_ = true;
    for (std::size_t i = 0; i < gsa->used; ++i) {
      used_.insert(satellite_name(gsa->talker, gsa->system, gsa->ids[i]));
    }
  }
  in_gsa_ = gsa != nullptr;
  if (const auto* gsv = std::get_if<Gsv>(&sentence)) {
    if (const auto group = groups_.add(*gsv)) add_group(*group, stamp);
  }
}

void Sky::add_group(const SatelliteGroup& group, Time stamp) {
  const std::pair name{group.talker, group.signal};
  if (std::ranges::find(swept_, name) != swept_.end()) tell(stamp);
  swept_.push_back(name);
  last_group_ = stamp;
  for (std::size_t i = 0; i < group.used; ++i) {
    const Satellite& s = group.sats[i];
    const SatelliteName who = satellite_name(group.talker, {}, s.id);
    auto known = std::ranges::find_if(sweep_, [&](const base::Satellite& k) {
      return k.system == who.system && k.number == who.number;
    });
    if (known == sweep_.end()) {
      sweep_.push_back({std::string(who.system), who.number, {}, {}, {}, {}});
      known = sweep_.end() - 1;
    }
    if (s.elevation_deg) known->elevation_deg = *s.elevation_deg;
    if (s.azimuth_deg) known->azimuth_deg = *s.azimuth_deg % 360;
    if (s.cn0_dbhz) known->cn0_dbhz = std::max<double>(known->cn0_dbhz.value_or(0.0), *s.cn0_dbhz);
  }
}

void Sky::tell(Time stamp) {
  auto all = std::make_shared<std::vector<base::Satellite>>(std::move(sweep_));
  sweep_.clear();
  swept_.clear();
  if (ubx_ && base::seconds(stamp - *ubx_) < kPatience_s) return;
  for (base::Satellite& s : *all) {
    if (knows_used_) s.used = used_.contains({s.system, s.number});
  }
  on_measurement_(base::SatellitesInView{last_group_, driver_, std::move(all)});
}

void Sky::add(const ubx::NavSat& sats, Time stamp) {
  sats_.clear();
  sats_.reserve(sats.all.size());
  for (const ubx::NavSat::One& s : sats.all) {
    base::Satellite out{std::string(ubx_system(s.gnss_id)), s.number, {}, {}, {}, s.used()};
    if (s.elevation_deg >= -90 && s.elevation_deg <= 90 && s.azimuth_deg >= 0 &&
        s.azimuth_deg <= 360) {
      out.elevation_deg = s.elevation_deg;
      out.azimuth_deg = s.azimuth_deg % 360;
    }
    if (s.cn0_dbhz > 0) out.cn0_dbhz = s.cn0_dbhz;
    sats_.push_back(std::move(out));
  }
  sats_at_ = stamp;
  tell_ubx(stamp);
}

void Sky::add(const ubx::NavSig& signals, Time stamp) {
  signals_ = signals;
  signals_at_ = stamp;
  tell_ubx(stamp);
}

/// What NAV-SAT says of the satellites, and NAV-SIG of their signals, as far as both are fresh.
void Sky::tell_ubx(Time stamp) {
  ubx_ = stamp;
  const auto fresh = [&](const std::optional<Time>& at) {
    return at && base::seconds(stamp - *at) < kPatience_s;
  };
  const bool placed = fresh(sats_at_);
  auto all = std::make_shared<std::vector<base::Satellite>>();
  if (placed) *all = sats_;
  if (fresh(signals_at_)) {
    for (const ubx::NavSig::One& s : signals_.all) add_signal(*all, s, placed);
  }
  on_measurement_(base::SatellitesInView{stamp, driver_, std::move(all)});
}

void Sky::tick(Time now) {
  if (!swept_.empty() && base::seconds(now - last_group_) > kPause_s) tell(now);
}

void Sky::reset() {
  groups_ = {};
  sweep_.clear();
  swept_.clear();
  used_.clear();
  knows_used_ = in_gsa_ = false;
  ubx_.reset();
  sats_at_.reset();
  signals_at_.reset();
}

}  // namespace roverd::gnss
