#include "app/recordings.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <system_error>
#include <tuple>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace roverd {
namespace {

namespace fs = std::filesystem;
using base::Code;
using base::Result;

class FolderHandle {
 public:
  /// Of the folder itself: where a symbolic link stands in its place it is somebody else's.
  explicit FolderHandle(const fs::path& folder)
      : fd_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC)) {}
  ~FolderHandle() {
    if (fd_ >= 0) ::close(fd_);
  }
  FolderHandle(const FolderHandle&) = delete;
  FolderHandle& operator=(const FolderHandle&) = delete;
  int get() const noexcept { return fd_; }

 private:
  const int fd_;
};

std::string reason_of(int number) {
  return std::generic_category().message(number);
}

base::WallTime changed_of(const struct stat& about) {
  return base::WallTime(std::chrono::seconds(about.st_mtim.tv_sec) +
                        std::chrono::nanoseconds(about.st_mtim.tv_nsec));
}

/// What cannot be looked at is left out: it went meanwhile.
std::vector<RecordingEntry> recordings_in(const fs::path& folder, int fd, std::error_code& ec) {
  std::vector<RecordingEntry> out;
  for (fs::directory_iterator at(folder, ec), end; !ec && at != end; at.increment(ec)) {
    std::string name = at->path().filename().string();
    if (!is_recording_name(name)) continue;
    struct stat about {};
    if (::fstatat(fd, name.c_str(), &about, AT_SYMLINK_NOFOLLOW) != 0) continue;
    if (!S_ISREG(about.st_mode)) continue;
    out.push_back({std::move(name), changed_of(about), static_cast<std::uint64_t>(about.st_size)});
  }
  return out;
}

/// @param error of Failed
Removal remove_recording(int folder, const std::string& name, int& error) {
  const int fd = ::openat(folder, name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0 && errno == ENOENT) return Removal::WasGone;
  if (fd < 0) {  // whether it is being written is not known
    error = errno;
    return Removal::Failed;
  }
  Removal done = Removal::Gone;
  if (::flock(fd, LOCK_EX | LOCK_NB) != 0) {
    done = Removal::InUse;
  } else if (::unlinkat(folder, name.c_str(), 0) != 0) {
    error = errno;
    done = error == ENOENT ? Removal::WasGone : Removal::Failed;
  }
  ::close(fd);
  return done;
}

std::string megabytes(std::uint64_t bytes) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f MB", static_cast<double>(bytes) * 1e-6);
  return text.data();
}

/// "older than 30 days, or beyond 20000 MB"
std::string bounds_text(const RecordingBounds& bounds) {
  std::string out;
  if (bounds.keep_for > base::Duration::zero()) {
    out = "older than " + std::to_string(bounds.keep_for / std::chrono::hours(24)) + " days";
  }
  if (bounds.total_bytes > 0) {
    out += std::string(out.empty() ? "" : ", or ") + "beyond " +
           std::to_string(bounds.total_bytes / 1'000'000) + " MB";
  }
  return out;
}

struct Sweep {
  int files = 0;
  std::uint64_t bytes = 0;
  std::string first;
  std::string last;
  std::string trouble;
};

Sweep sweep(const fs::path& folder, const RecordingBounds& bounds, base::WallTime now) {
  Sweep done;
  const FolderHandle handle(folder);
  if (handle.get() < 0) {
    const int number = errno;
    if (number != ENOENT) {
      const bool link = number == ELOOP || number == ENOTDIR;
      done.trouble = folder.string() + ": " + (link ? "not a folder itself" : reason_of(number));
    }
    return done;
  }
  std::error_code ec;
  auto entries = recordings_in(folder, handle.get(), ec);
  if (ec) done.trouble = folder.string() + ": " + ec.message();
  spare_recordings(std::move(entries), bounds, now, [&](const RecordingEntry& e) {
    int error = 0;
    const Removal removal = remove_recording(handle.get(), e.name, error);
    if (removal == Removal::Gone) {
      ++done.files;
      done.bytes += e.bytes;
      if (done.first.empty()) done.first = e.name;
      done.last = e.name;
    } else if (removal == Removal::Failed && done.trouble.empty()) {
      done.trouble = (folder / e.name).string() + ": " + reason_of(error);
    }
    return removal;
  });
  return done;
}

/// How many characters of `text` from `at` on are digits.
std::size_t digits_at(std::string_view text, std::size_t at) noexcept {
  std::size_t n = 0;
  while (at + n < text.size() && std::isdigit(static_cast<unsigned char>(text[at + n])) != 0) ++n;
  return n;
}

}  // namespace

bool is_recording_name(std::string_view name) noexcept {
  constexpr std::string_view kForm = "00000000T000000Z-";
  if (name.size() <= kForm.size()) return false;
  for (std::size_t i = 0; i < kForm.size(); ++i) {
    const bool digit = std::isdigit(static_cast<unsigned char>(name[i])) != 0;
    if (kForm[i] == '0' ? !digit : name[i] != kForm[i]) return false;
  }
  const auto ending = name.rfind('.');
  const std::string_view last = name.substr(std::min(ending, name.size()));
  if (last != ".log" && last != ".raw" && last != ".pcap") return false;
  std::string_view device = name.substr(kForm.size(), ending - kForm.size());
  if (const auto dot = device.find('.'); dot != std::string_view::npos) {
    const std::size_t digits = digits_at(device, dot + 1);
    if (digits < 3 || dot + 1 + digits != device.size()) return false;
    device = device.substr(0, dot);
  }
  return !device.empty() && std::all_of(device.begin(), device.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_';
  });
}

void spare_recordings(std::vector<RecordingEntry> entries, const RecordingBounds& bounds,
                      base::WallTime now,
                      const std::function<Removal(const RecordingEntry&)>& remove) {
  std::sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
    return std::tie(a.changed, a.name) < std::tie(b.changed, b.name);
  });
  std::uint64_t left = 0;
  for (const RecordingEntry& e : entries) left += e.bytes;
  const bool by_age = bounds.keep_for > base::Duration::zero() && now >= base::kYoungest;
  for (const RecordingEntry& e : entries) {
    // Of one that was written before the clock was set nobody knows the age: only the room counts.
    const bool old = by_age && e.changed >= base::kYoungest && e.changed < now - bounds.keep_for;
    const bool many = bounds.total_bytes > 0 && left > bounds.total_bytes && e.bytes > 0;
    if (!old && !many) continue;
    const Removal removal = remove(e);
    if (removal == Removal::Gone || removal == Removal::WasGone) left -= e.bytes;
  }
}

std::vector<base::Event> RecordingTidier::tidy(base::WallTime now) {
  std::vector<base::Event> events;
  if (bounds_.total_bytes == 0 && bounds_.keep_for <= base::Duration::zero()) return events;
  const Sweep done = sweep(folder_, bounds_, now);
  if (done.files > 0) {
    const std::string which = done.files == 1 ? "recording " + done.first + " was"
                                              : std::to_string(done.files) + " recordings, " +
                                                    done.first + " to " + done.last + ", were";
    events.push_back({now, base::Severity::Info, "recordings_removed",
                      which + " removed (" + megabytes(done.bytes) + "): " + bounds_text(bounds_)});
  }
  if (!done.trouble.empty() && !troubled_) {
    events.push_back(
        {now, base::Severity::Warning, "recordings_stay",
         "recordings that are " + bounds_text(bounds_) + " cannot be removed: " + done.trouble});
  }
  troubled_ = !done.trouble.empty();
  return events;
}

}  // namespace roverd
