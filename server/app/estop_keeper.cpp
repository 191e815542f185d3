#include "app/estop_keeper.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <pthread.h>
#include <sys/stat.h>
#include <unistd.h>

namespace roverd {
namespace {

constexpr std::string_view kLatched = "roverd: the emergency stop is latched.\n";
constexpr std::string_view kReleased = "roverd: the emergency stop is released\n";
static_assert(kLatched.size() == kReleased.size());

constexpr const char* kBefore =
    "it was latched before the program started: reset it when you have looked";

/// All that matters of it, and one byte more.
std::optional<std::string> read_start(int fd) {
  std::array<char, kLatched.size() + 1> bytes{};
  const auto n = ::pread(fd, bytes.data(), bytes.size(), 0);
  if (n < 0) return std::nullopt;
  return std::string(bytes.data(), static_cast<std::size_t>(n));
}

bool overwrite(int fd, std::string_view text) {
  return ::pwrite(fd, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size()) &&
         ::ftruncate(fd, static_cast<off_t>(text.size())) == 0;
}

EstopKeeper::Found judge(const std::string& name, const std::optional<std::string>& text,
                         bool existed, bool first) {
  if (!existed && first) return {};
  if (!existed) {
    return {true, "the file that keeps it (" + name +
                      ") is missing, so nobody knows: it counts as latched; look, and reset it"};
  }
  const auto kept = text ? estop_from(*text) : std::nullopt;
  if (!kept) {
    return {true, "the file that keeps it (" + name +
                      ") is damaged, so nobody knows: it counts as latched; look, and reset it"};
  }
  return *kept ? EstopKeeper::Found{true, kBefore} : EstopKeeper::Found{};
}

}  // namespace

std::string_view estop_text(bool latched) noexcept {
  return latched ? kLatched : kReleased;
}

std::optional<bool> estop_from(std::string_view text) noexcept {
  if (text == kLatched) return true;
  if (text == kReleased) return false;
  return std::nullopt;
}

std::unique_ptr<EstopKeeper> EstopKeeper::open(const std::filesystem::path& file, bool first,
                                               Callbacks callbacks) {
  int fd = ::open(file.c_str(), O_RDWR | O_CLOEXEC);
  const bool existed = fd >= 0;
  if (!existed && errno == ENOENT) fd = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  Found found = fd < 0 ? Found{true, "the file that keeps it cannot be had (" + file.string() +
                                         ": " + std::strerror(errno) +
                                         "): it counts as latched, and will not be kept"}
                       : judge(file.string(), read_start(fd), existed, first);
  std::unique_ptr<EstopKeeper> keeper(
      new EstopKeeper(fd, file, std::move(found), std::move(callbacks)));
  if (!existed) {  // its name, too, must outlive a power cut
    const int folder = ::open(file.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder >= 0) {
      ::fsync(folder);
      ::close(folder);
    }
  }
  return keeper;
}

EstopKeeper::EstopKeeper(int fd, std::filesystem::path file, Found found, Callbacks callbacks)
    : fd_(fd),
      file_(std::move(file)),
      found_(std::move(found)),
      callbacks_(std::move(callbacks)),
      wanted_(found_.latched) {
  sem_init(&news_, 0, 0);
  keep(found_.latched);
  sem_post(&news_);  // to sync it
  thread_ = std::thread([this] { run(); });
}

EstopKeeper::~EstopKeeper() {
  stop_ = true;
  sem_post(&news_);
  thread_.join();
  sem_destroy(&news_);
  if (fd_ >= 0) ::close(fd_);
}

void EstopKeeper::want(bool latched) noexcept {
  wanted_ = latched;
  sem_post(&news_);
}

void EstopKeeper::when_kept(std::function<void()> then) {
  {
    std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(then));
  }
  sem_post(&news_);
}

void EstopKeeper::tell(const char* deed, int error) {
  if (std::exchange(troubled_, true) || !callbacks_.trouble) return;
  callbacks_.trouble(file_.string() + " cannot be " + deed + " (" + std::strerror(error) +
                     "): the emergency stop would not outlive this program");
}

void EstopKeeper::keep(bool latched) {
  if (fd_ < 0) return;  // told with what was found
  if (overwrite(fd_, estop_text(latched))) {
    troubled_ = false;
  } else {
    tell("written", errno);
  }
}

void EstopKeeper::run() noexcept {
  pthread_setname_np(pthread_self(), "estop");
  bool written = found_.latched;
  bool synced = false;
  while (true) {
    while (sem_wait(&news_) != 0) continue;  // a signal
    const bool last = stop_;
    try {
      if (const bool now = wanted_; now != written || troubled_) {
        keep(now);
        written = now;
        synced = false;
      }
      std::vector<std::function<void()>> done;
      {
        std::lock_guard lock(mutex_);
        done.swap(waiting_);
      }
      for (const auto& then : done) then();
      if (!synced && fd_ >= 0 && ::fdatasync(fd_) != 0) tell("synced", errno);
      synced = true;
    } catch (...) {
      // No memory, for a message or an answer: what matters is written first, without any.
      synced = false;
    }
    if (last) return;
  }
}

}  // namespace roverd
