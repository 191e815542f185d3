#pragma once
// A receiver that a gpsd serves has no section of its own: it is configured as any receiver.

#include <string>

#include "gnss/params.hpp"
#include "gpsd/driver.hpp"

namespace roverd {

inline gpsd::Params gpsd_params(const gnss::Params& p, const std::string& device) {
  return {.device = device,
          .heading_source = p.heading_source == "dual_antenna" ? base::HeadingSource::DualAntenna
                                                               : base::HeadingSource::Compass,
          .heading_offset_deg = p.heading_offset_deg,
          .silent_after_s = p.silent_after_s,
          .silent_reopen_s = p.silent_reopen_s,
          .retry_first_s = p.retry_first_s,
          .retry_max_s = p.retry_max_s};
}

}  // namespace roverd
