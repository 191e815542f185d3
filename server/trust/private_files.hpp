#pragma once
// Files that nobody else on this computer may read, kept over power cuts: a private key.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "base/result.hpp"

namespace roverd::trust {

/// Larger ones are none of ours.
inline constexpr std::size_t kLargestFile = std::size_t{256} * 1024;

/// Makes the folder with mode 0700 where it is missing. Errors: Invalid (others may read or write
/// it, it is somebody else's, or no folder), Unavailable (the system's reason).
base::Result<void> private_folder(const std::filesystem::path& folder);

/// The whole file; empty optional: there is none. Errors: Invalid (others may read or write it, it
/// is somebody else's, a link, no plain file, or too large), Unavailable (the system's reason).
base::Result<std::optional<std::string>> read_private(const std::filesystem::path& file);

/// Anybody may read this one. Errors as above; NotFound: there is none.
base::Result<std::string> read_public(const std::filesystem::path& file);

/// The file holds all of the text or what it held before, also after a power cut. It is never
/// readable for others, not for a moment: made anew with mode 0600 beside its place, then moved.
base::Result<void> write_private(const std::filesystem::path& file, std::string_view text);

/// Gives a damaged file another name, NAME.damaged-1 and so on. @return that name
base::Result<std::filesystem::path> set_aside(const std::filesystem::path& file);

}  // namespace roverd::trust
