#include "trust/private_files.hpp"

#include <cerrno>
#include <cstdio>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace roverd::trust {

namespace {

using base::Code;
using base::Result;
namespace fs = std::filesystem;

constexpr mode_t kOthers = S_IRWXG | S_IRWXO;
constexpr int kDamagedKept = 1000;

struct Fd {
  int fd;
  ~Fd() {
    if (fd >= 0) ::close(fd);
  }
};

auto system_refuses(const fs::path& path) {
  return base::fail(Code::Unavailable,
                    path.string() + ": " + std::generic_category().message(errno));
}

std::string octal(mode_t mode) {
  char text[8];
  std::snprintf(text, sizeof text, "%04o", static_cast<unsigned>(mode & 07777U));
  return text;
}

/// Who was able to read a key may have it.
Result<void> check_private(const fs::path& path, const struct stat& found) {
  if (found.st_uid != ::geteuid()) {
    return base::fail(Code::Invalid, path.string() + " belongs to another user (" +
                                         std::to_string(found.st_uid) + ")");
  }
  if ((found.st_mode & kOthers) != 0) {
    return base::fail(
        Code::Invalid,
        path.string() + " can be read or changed by others (mode " + octal(found.st_mode) +
            "), so the key may be known: take it away to have a new one made, or take "
            "the others' rights away (chmod go= ...) if you are sure");
  }
  return {};
}

Result<std::string> read_all(const fs::path& file, int fd) {
  std::string text(kLargestFile + 1, '\0');
  std::size_t size = 0;
  while (size < text.size()) {
    const ssize_t n = ::read(fd, text.data() + size, text.size() - size);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return system_refuses(file);
    if (n == 0) break;
    size += static_cast<std::size_t>(n);
  }
  if (size > kLargestFile) return base::fail(Code::Invalid, file.string() + " is too large");
  text.resize(size);
  return text;
}

Result<void> write_all(const fs::path& file, int fd, std::string_view text) {
  while (!text.empty()) {
    const ssize_t n = ::write(fd, text.data(), text.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return system_refuses(file);
    text.remove_prefix(static_cast<std::size_t>(n));
  }
  if (::fsync(fd) != 0) return system_refuses(file);
  return {};
}

/// So that a file's new name holds over a power cut.
void sync_folder_of(const fs::path& file) {
  const Fd folder{::open(file.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
  if (folder.fd >= 0) ::fsync(folder.fd);
}

}  // namespace

Result<void> private_folder(const fs::path& folder) {
  if (::mkdir(folder.c_str(), S_IRWXU) != 0 && errno != EEXIST) return system_refuses(folder);
  struct stat found {};
  if (::lstat(folder.c_str(), &found) != 0) return system_refuses(folder);
  if (!S_ISDIR(found.st_mode)) {
    return base::fail(Code::Invalid, folder.string() + " is no folder");
  }
  return check_private(folder, found);
}

Result<std::optional<std::string>> read_private(const fs::path& file) {
  const Fd in{::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC)};
  if (in.fd < 0 && errno == ENOENT) return std::optional<std::string>();
  if (in.fd < 0 && errno == ELOOP) {
    return base::fail(Code::Invalid, file.string() + " is a link");
  }
  if (in.fd < 0) return system_refuses(file);
  struct stat found {};
  if (::fstat(in.fd, &found) != 0) return system_refuses(file);
  if (!S_ISREG(found.st_mode)) {
    return base::fail(Code::Invalid, file.string() + " is no plain file");
  }
  if (auto good = check_private(file, found); !good) return tl::unexpected(good.error());
  auto text = read_all(file, in.fd);
  if (!text) return tl::unexpected(text.error());
  return std::optional<std::string>(std::move(*text));
}

Result<std::string> read_public(const fs::path& file) {
  const Fd in{::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)};
  if (in.fd < 0 && errno == ENOENT) {
    return base::fail(Code::NotFound, "there is no file " + file.string());
  }
  if (in.fd < 0) return system_refuses(file);
  return read_all(file, in.fd);
}

Result<void> write_private(const fs::path& file, std::string_view text) {
  fs::path next = file;
  next += ".new";
  ::unlink(next.c_str());  // of a start that was cut off
  const auto give_up = [&next](Result<void> why) {
    ::unlink(next.c_str());
    return why;
  };
  {
    const Fd out{::open(next.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC,
                        S_IRUSR | S_IWUSR)};
    if (out.fd < 0) return system_refuses(next);
    if (auto done = write_all(next, out.fd, text); !done) return give_up(std::move(done));
  }
  if (::rename(next.c_str(), file.c_str()) != 0) return give_up(system_refuses(file));
  sync_folder_of(file);
  return {};
}

Result<fs::path> set_aside(const fs::path& file) {
  for (int i = 1; i <= kDamagedKept; ++i) {
    fs::path other = file;
    other += ".damaged-" + std::to_string(i);
    struct stat found {};
    if (::lstat(other.c_str(), &found) == 0) continue;
    if (::rename(file.c_str(), other.c_str()) != 0) return system_refuses(file);
    sync_folder_of(file);
    return other;
  }
  return base::fail(Code::Conflict, file.string() + ": too many damaged ones are kept");
}

}  // namespace roverd::trust
