#include "link/record_file.hpp"

#include <array>
#include <cerrno>
#include <cstdio>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include "link/descriptor.hpp"

namespace roverd::link {

std::string numbered_file(const std::string& first, int number) {
  const auto slash = first.rfind('/');
  auto dot = first.rfind('.');
  if (dot == std::string::npos || (slash != std::string::npos && dot < slash)) dot = first.size();
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), ".%03d", number);
  return first.substr(0, dot) + text.data() + first.substr(dot);
}

base::Result<std::unique_ptr<RecordFile>> RecordFile::create(const std::string& path,
                                                             const RecordOptions& options,
                                                             std::string header) {
  auto file = std::unique_ptr<RecordFile>(new RecordFile(path, options, std::move(header)));
  if (auto begun = file->begin(path); !begun) return tl::unexpected(begun.error());
  return file;
}

RecordFile::~RecordFile() {
  if (fd_ >= 0) ::close(fd_);
}

base::Result<void> RecordFile::begin(const std::string& path) {
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (fd < 0) {
    return base::fail(base::Code::Unavailable,
                      "cannot make the recording " + path + ": " + errno_text(errno));
  }
  // Held for as long as it is written: who tidies up leaves it. Without locks (some network disks)
  // it is written all the same.
  ::flock(fd, LOCK_SH | LOCK_NB);
  if (fd_ >= 0) {
    ::fdatasync(fd_);
    ::close(fd_);
  }
  fd_ = fd;
  size_ = 0;
  paths_.push_back(path);
  return put(header_);
}

base::Result<void> RecordFile::follow() {
  if (keep_files_ < 2) {
    return stop("the file has reached " + std::to_string(max_bytes_ / 1'000'000) + " MB");
  }
  if (auto begun = begin(numbered_file(first_, ++number_)); !begun) return begun;
  while (paths_.size() > static_cast<std::size_t>(keep_files_)) {
    ::unlink(paths_.front().c_str());
    paths_.pop_front();
  }
  return {};
}

base::Result<void> RecordFile::stop(const std::string& why) const {
  return base::fail(base::Code::Unavailable, "recording to " + paths_.back() + " stopped: " + why);
}

base::Result<void> RecordFile::write(const std::string& text) {
  if (size_ + text.size() > max_bytes_ && (size_ > header_.size() || keep_files_ < 2)) {
    if (auto next = follow(); !next) return next;
  }
  return put(text);
}

base::Result<void> RecordFile::put(const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t n = ::write(fd_, text.data() + done, text.size() - done);
    if (n > 0) {
      done += static_cast<std::size_t>(n);
    } else if (n == 0 || errno != EINTR) {
      const int error = n == 0 ? ENOSPC : errno;
      if (::ftruncate(fd_, static_cast<off_t>(size_)) != 0) return stop(errno_text(errno));
      return stop(errno_text(error));
    }
  }
  size_ += text.size();
  written_ += text.size();
  return {};
}

base::Result<void> RecordFile::sync() {
  struct statvfs disk {};
  if (::fstatvfs(fd_, &disk) == 0 && disk.f_bavail * disk.f_frsize < keep_free_bytes_) {
    return stop("less than " + std::to_string(keep_free_bytes_ / 1'000'000) +
                " MB are left on the disk");
  }
  if (::fdatasync(fd_) != 0) return stop(errno_text(errno));
  return {};
}

}  // namespace roverd::link
