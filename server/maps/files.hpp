#pragma once
// A map on the disk as map servers keep it: a .yaml and the picture that it names; or a .pcd in
// three dimensions, of which this is the plane (solid.hpp).

#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/bytes.hpp"
#include "base/result.hpp"
#include "nav/chart/map.hpp"

namespace roverd::maps {

/// 40 million cells of two bytes, as text.
inline constexpr std::uintmax_t kLargestPicture = 200'000'000;

/// The whole file. NotFound, TooLarge above `most`, with its name.
base::Result<std::vector<std::uint8_t>> file_bytes(const std::filesystem::path& file,
                                                   std::uintmax_t most);

/// NotFound, Malformed and the rest, with the file's name.
base::Result<nav::chart::OccupancyMap> read_map_files(const std::filesystem::path& yaml);

/// The file holds all of it, or what it held before, also after a power cut. Unavailable with the
/// system's reason.
base::Result<void> replace_file(const std::filesystem::path& file, base::Bytes bytes);
/// So that the names in a folder hold over a power cut.
void sync_folder(const std::filesystem::path& folder) noexcept;

}  // namespace roverd::maps
