#include "store/folder_watch.hpp"

#include <cerrno>
#include <system_error>
#include <utility>

#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

namespace roverd::store {

FolderWatch::FolderWatch(std::filesystem::path file)
    : file_(std::move(file)), folder_(file_.has_parent_path() ? file_.parent_path() : ".") {
  struct stat now {};
  known_ = ::stat(file_.c_str(), &now) == 0;
  device_ = now.st_dev;
  inode_ = now.st_ino;
}

std::string FolderWatch::gone() const {
  struct stat now {};
  if (::stat(file_.c_str(), &now) != 0) {
    const int number = errno;
    if (number != ENOENT) {
      return file_.string() + " cannot be seen: " + std::generic_category().message(number);
    }
    const bool folder_there = ::stat(folder_.c_str(), &now) == 0;
    return folder_there ? "the database " + file_.string() + " was removed"
                        : "the data folder " + folder_.string() + " was removed";
  }
  if (known_ && now.st_dev == device_ && now.st_ino == inode_) return {};
  return "the database " + file_.string() + " was replaced by another file";
}

std::string FolderWatch::unwritable() const {
  if (::access(folder_.c_str(), W_OK | X_OK) == 0) return {};
  const int number = errno;
  return "the data folder " + folder_.string() +
         " cannot be written: " + std::generic_category().message(number);
}

std::optional<std::uint64_t> FolderWatch::free_bytes() const {
  struct statvfs disk {};
  if (::statvfs(folder_.c_str(), &disk) != 0) return std::nullopt;
  return std::uint64_t{disk.f_bavail} * disk.f_frsize;
}

}  // namespace roverd::store
