// The file of known places: whatever the bytes, it is refused with a sentence, or every place of it
// is one that can be, and is read again as it was written.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "config/known_places.hpp"

using namespace roverd;

namespace {

void check(bool good) {
  if (!good) std::abort();
}

bool same(double a, double b) {
  return std::abs(a - b) < 1e-9;
}

void can_be(const base::KnownPlace& p) {
  check(!p.name.empty() && p.name.size() <= 24);
  check(std::abs(p.at.lat) <= 90.0 && std::abs(p.at.lon) <= 180.0);
  check(p.sigma_m >= 0.01 && p.sigma_m <= 2.0);
  check(p.yaw_sigma_rad > 0.0 && p.yaw_sigma_rad < 0.8);
  check(!p.tag || (*p.tag >= 0 && *p.tag <= 586));
  check(!p.yaw_rad || std::isfinite(*p.yaw_rad));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto read = known_places_from({reinterpret_cast<const char*>(data), size});
  if (!read) {
    check(!read.error().detail.empty());
    return 0;
  }
  const auto again = known_places_from(known_places_text(*read));
  check(again.has_value() && again->size() == read->size());
  for (std::size_t i = 0; i < read->size(); ++i) {
    const base::KnownPlace& was = (*read)[i];
    const base::KnownPlace& is = (*again)[i];
    can_be(was);
    check(was.name == is.name && was.at == is.at && was.sigma_m == is.sigma_m);
    check(was.tag == is.tag && was.yaw_rad.has_value() == is.yaw_rad.has_value());
    check(same(was.yaw_sigma_rad, is.yaw_sigma_rad));
    check(!was.yaw_rad || std::cos(*was.yaw_rad - *is.yaw_rad) > 1.0 - 1e-12);
  }
  return 0;
}
