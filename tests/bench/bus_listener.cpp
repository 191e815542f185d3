// roverd-bus PATH ID SECONDS: listens on a local CAN socket and prints how evenly the frames of one
// id come, as one JSON object: frames, period_ms (mean), jitter_p50_ms, jitter_p99_ms, gap_max_ms.
// Jitter: how far the time between two frames is from their mean period.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <pthread.h>
#include <sched.h>

#include "link/cansock.hpp"

namespace {

using namespace roverd;

double at_share(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

int report(const std::vector<base::Time>& stamps) {
  if (stamps.size() < 10) {
    std::fprintf(stderr, "roverd-bus: only %zu frames\n", stamps.size());
    return 1;
  }
  const double mean_ms =
      1e3 * base::seconds(stamps.back() - stamps.front()) / static_cast<double>(stamps.size() - 1);
  std::vector<double> jitter_ms;
  double gap_ms = 0.0;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    const double between_ms = 1e3 * base::seconds(stamps[i] - stamps[i - 1]);
    jitter_ms.push_back(std::abs(between_ms - mean_ms));
    gap_ms = std::max(gap_ms, between_ms);
  }
  std::printf(
      "{\"frames\":%zu,\"period_ms\":%.3f,\"jitter_p50_ms\":%.3f,\"jitter_p99_ms\":%.3f,"
      "\"gap_max_ms\":%.3f}\n",
      stamps.size(), mean_ms, at_share(jitter_ms, 0.5), at_share(jitter_ms, 0.99), gap_ms);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fputs("usage: roverd-bus PATH ID SECONDS\n", stderr);
    return 2;
  }
  // The listener's own lateness is no jitter of the robot: before others, where that is allowed.
  sched_param priority{};
  priority.sched_priority = 10;
  (void)pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority);
  const auto id = static_cast<std::uint32_t>(std::strtoul(argv[2], nullptr, 0));
  boost::asio::io_context io(1);
  link::CanSocketLink bus(io, argv[1]);
  std::vector<base::Time> stamps;
  bus.on_frame = [&](const base::CanFrame& f, base::Time t) {
    if (f.id == id && !f.extended) stamps.push_back(t);
  };
  if (const auto opened = bus.open(); !opened) {
    std::fprintf(stderr, "roverd-bus: %s\n", opened.error().detail.c_str());
    return 1;
  }
  io.run_for(base::from_seconds(std::strtod(argv[3], nullptr)));
  return report(stamps);
}
