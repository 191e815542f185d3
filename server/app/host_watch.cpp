#include "app/host_watch.hpp"

#include <cmath>
#include <cstdio>
#include <utility>

namespace roverd {
namespace {

constexpr std::uint64_t kLow_bytes = 200'000'000;
constexpr double kSilent_s = 10.0;
constexpr double kLate_s = 0.020;
constexpr double kMinute_s = 60.0;

std::string with(const char* format, double value) {
  char text[96];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

}  // namespace

std::vector<base::HostProblem> host_problems(const HostFacts& f) {
  std::vector<base::HostProblem> out;
  const double silent_s = base::seconds(f.now - f.storage.looked);
  if (!f.storage.trouble.empty()) {
    out.push_back({"storage_failed", "changes cannot be saved: " + f.storage.trouble});
  } else if (silent_s > kSilent_s) {
    out.push_back({"storage_silent", with("the disk has not answered for %.0f s", silent_s)});
  } else if (f.storage.free_bytes && *f.storage.free_bytes < kLow_bytes) {
    out.push_back({"storage_low", with("the disk is nearly full: %.0f MB are left",
                                       static_cast<double>(*f.storage.free_bytes) / 1e6)});
  }
  if (f.wall < base::kYoungest) {
    out.push_back(
        {"clock_unset",
         "the clock of this computer is not set: dates and times of what is kept are wrong"});
  }
  const std::string late =
      f.lateness_s ? with("the control loop wakes up to %.1f ms late", *f.lateness_s * 1e3)
                   : std::string("how late the control loop wakes is not known yet");
  if (f.lateness_s && *f.lateness_s > kLate_s) out.push_back({"loop_late", late});
  if (!f.real_time) {
    out.push_back(
        {"realtime_refused",
         "this system grants no real-time priority (rtprio in limits.conf, LimitRTPRIO= of a "
         "service): " +
             late,
         false});
  }
  if (!f.memory_locked) {
    out.push_back(
        {"memory_unlocked",
         "this system does not let the program lock its memory (CAP_IPC_LOCK, LimitMEMLOCK= "
         "of a service): " +
             late,
         false});
  }
  if (!f.unannounced.empty()) {
    out.push_back(
        {"not_announced", "nobody finds this robot by its name: " + f.unannounced, false});
  }
  return out;
}

void LatenessWatch::take(const base::LoopHealth& loop, base::Time now) {
  if (!since_) {
    since_ = now;
    begun_ = loop.lateness_log2_us;
  }
  std::uint64_t sum = 0;
  Counts counts{};
  for (std::size_t i = 0; i < counts.size(); ++i)
    sum += counts[i] = loop.lateness_log2_us[i] - begun_[i];
  if (sum >= 500) {
    const auto wanted = static_cast<std::uint64_t>(std::ceil(static_cast<double>(sum) * 0.999));
    std::uint64_t below = 0;
    std::size_t i = 0;
    while (i + 1 < counts.size() && (below += counts[i]) < wanted) ++i;
    p999_s_ = std::ldexp(1e-6, static_cast<int>(i));
  }
  if (base::seconds(now - *since_) < kMinute_s) return;
  since_ = now;
  begun_ = loop.lateness_log2_us;
}

}  // namespace roverd
