#pragma once
// What was learned of this robot, in a small file of the data folder: written whole or
// not at all, read once at the start. A file that is missing, damaged, of another vehicle, or of
// values that no robot has, is as none.
//
//   {"vehicle": "bunker can", "time": "2026-03-01T12:00:00Z",
//    "odometry_scale": 0.921, "odometry_scale_sigma": 0.004, "odometry_scale_day": 20513.5,
//    "gyro_bias_dps": 0.31, "gyro_bias_sigma_dps": 0.02, "gyro_bias_dps_day": 20513.5}
//
// Values grow uncertain with their age: the scale within months (tracks wear, the ground is another
// one), the bias within days. Any thread; not two at once.

#include <filesystem>
#include <string>
#include <string_view>

#include "base/result.hpp"
#include "base/time.hpp"
#include "nav/estimate/learned.hpp"

namespace roverd {

std::string learned_text(const nav::Learned& learned, const std::string& vehicle,
                         base::WallTime now);
/// Pure. @param vehicle whose values are wanted.
nav::Learned learned_from(std::string_view text, const std::string& vehicle, base::WallTime now);

nav::Learned read_learned(const std::filesystem::path& file, const std::string& vehicle,
                          base::WallTime now);
/// Values that are empty keep what the file says of this vehicle. Durable when it returns.
base::Result<void> write_learned(const std::filesystem::path& file, const nav::Learned& learned,
                                 const std::string& vehicle, base::WallTime now);

/// The file holds this text or what it held before, also after a power cut. Durable when it
/// returns. Unavailable, with the system's reason.
base::Result<void> replace_file(const std::filesystem::path& file, const std::string& text);

}  // namespace roverd
