// Any bytes as a gpsd's answer, through libgps: what is told is finite and on earth.

#include <cmath>
#include <cstdlib>

#include "gpsd/report.hpp"

namespace {

using namespace roverd;

void require(bool truth) {
  if (!truth) std::abort();
}

void look_at(const base::Measurement& m) {
  if (const auto* fix = std::get_if<base::GnssFix>(&m)) {
    require(!fix->position || base::is_valid(*fix->position));
  } else if (const auto* velocity = std::get_if<base::GnssVelocity>(&m)) {
    require(std::isfinite(velocity->east_mps) && std::isfinite(velocity->north_mps));
  } else if (const auto* heading = std::get_if<base::Heading>(&m)) {
    require(std::isfinite(heading->yaw_rad));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  gpsd::Reader reader({.driver = "gnss"},
                      {look_at, [](std::string_view) {}, [](std::string_view) {},
                       [](std::string_view, const std::string&) {}});
  gpsd::Lines lines;
  base::Time now{std::chrono::seconds(10)};
  lines.feed({data, size}, [&](std::string_view line) { reader.take(line, now); });
  static_cast<void>(gpsd::parse_source(std::string(data, data + size)));
  return 0;
}
