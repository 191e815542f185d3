#pragma once
// The files of the page, built into the program (server/net/embed_page.cmake). Without a built page
// there is one small file that says so.

#include <span>

#include "net/assets.hpp"

namespace roverd::net {

/// Bytes of the program: valid for ever. Any thread.
std::span<const FileEntry> page_entries() noexcept;

}  // namespace roverd::net
