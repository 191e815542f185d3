#pragma once
// The recordings of all starts together: how much room they may take, and how long they stay. What
// goes are whole files of ours, the oldest first. Never one that is being written (link/record_file
// holds it by flock), never one whose name is not of a recording, never through a symbolic link.
//
//   20260301T120000Z-bunker.log   20260301T120000Z-bunker.002.log   20260301T120000Z-gnss-2.raw
//
// Ages come from the files' own times: a name tells what the clock said when its recording began.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/result.hpp"
#include "base/snapshot.hpp"
#include "base/time.hpp"

namespace roverd {

struct RecordingBounds {
  std::uint64_t total_bytes = 0;  ///< of all files together; 0: whatever there is
  base::Duration keep_for{};      ///< since the last byte; zero: for ever
};

struct RecordingEntry {
  std::string name;
  base::WallTime changed;
  std::uint64_t bytes = 0;
};

/// What became of a file that was to be removed.
enum class Removal { Gone, WasGone, InUse, Failed };

/// As recording_file() and link::numbered_file() make them.
bool is_recording_name(std::string_view name) noexcept;

/// Asks to remove, oldest first (of equal times in the order of their names), until what is left is
/// within the bounds. By age only where the clock was ever set; a file of the future is as young as
/// can be. An empty file takes no room: only its age removes it. Pure but for `remove`.
void spare_recordings(std::vector<RecordingEntry> entries, const RecordingBounds& bounds,
                      base::WallTime now,
                      const std::function<Removal(const RecordingEntry&)>& remove);

/// Keeps one folder within its bounds, and says what it did.
class RecordingTidier {
 public:
  RecordingTidier(std::filesystem::path folder, RecordingBounds bounds)
      : folder_(std::move(folder)), bounds_(bounds) {}

  /// Takes as long as the disk does: beside the driving. One thread at a time. A trouble is told
  /// once, and again only after it was over.
  /// @return events: what was removed, what cannot be
  std::vector<base::Event> tidy(base::WallTime now);

 private:
  const std::filesystem::path folder_;
  const RecordingBounds bounds_;
  bool troubled_ = false;  ///< told, and not over
};

}  // namespace roverd
