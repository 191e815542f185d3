#include "maps/files.hpp"

#include <cerrno>
#include <cstddef>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "atlas/map_files.hpp"
#include "maps/solid.hpp"

namespace roverd::maps {

namespace {

namespace fs = std::filesystem;

base::Error of_file(const fs::path& file, base::Error error) {
  error.detail = file.string() + ": " + error.detail;
  return error;
}

auto system_refuses(const fs::path& file) {
  return base::fail(base::Code::Unavailable,
                    file.string() + ": " + std::generic_category().message(errno));
}

struct Handle {
  int fd;
  ~Handle() {
    if (fd >= 0) ::close(fd);
  }
};

base::Result<void> write_whole(const fs::path& file, base::Bytes bytes) {
  const Handle out{::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644)};
  if (out.fd < 0) return system_refuses(file);
  while (!bytes.empty()) {
    const ssize_t n = ::write(out.fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return system_refuses(file);
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
  if (::fsync(out.fd) != 0) return system_refuses(file);
  return {};
}

}  // namespace

base::Result<std::vector<std::uint8_t>> file_bytes(const fs::path& file, std::uintmax_t most) {
  std::error_code error;
  const auto size = fs::file_size(file, error);
  if (error) return base::fail(base::Code::NotFound, file.string() + ": " + error.message());
  if (size > most) return base::fail(base::Code::TooLarge, file.string() + ": too large");
  std::vector<std::uint8_t> out(size);
  std::ifstream in(file, std::ios::binary);
  in.read(reinterpret_cast<char*>(out.data()), static_cast<std::streamsize>(size));
  if (!in) return base::fail(base::Code::NotFound, file.string() + ": cannot be read");
  return out;
}

base::Result<nav::chart::OccupancyMap> read_map_files(const fs::path& yaml) {
  if (is_solid(yaml)) {
    const auto solid = read_solid(yaml);
    if (!solid) return tl::unexpected<base::Error>(solid.error());
    auto plane = plane_of(*solid);
    if (!plane) return tl::unexpected<base::Error>(of_file(yaml, plane.error()));
    return plane;
  }
  const auto text = file_bytes(yaml, atlas::kLargestWords);
  if (!text) return tl::unexpected<base::Error>(text.error());
  const auto words = atlas::read_words(std::string(text->begin(), text->end()));
  if (!words) return tl::unexpected<base::Error>(of_file(yaml, words.error()));
  const auto image = yaml.parent_path() / words->image;
  const auto bytes = file_bytes(image, kLargestPicture);
  if (!bytes) return tl::unexpected<base::Error>(bytes.error());
  const auto picture = atlas::read_pgm(*bytes);
  if (!picture) return tl::unexpected<base::Error>(of_file(image, picture.error()));
  auto map = atlas::map_of(*words, *picture);
  if (!map) return tl::unexpected<base::Error>(of_file(yaml, map.error()));
  return map;
}

base::Result<void> replace_file(const fs::path& file, base::Bytes bytes) {
  fs::path next = file;
  next += ".new";
  if (auto done = write_whole(next, bytes); !done) {
    ::unlink(next.c_str());
    return done;
  }
  if (::rename(next.c_str(), file.c_str()) != 0) {
    auto refused = system_refuses(file);
    ::unlink(next.c_str());
    return refused;
  }
  sync_folder(file.parent_path());
  return {};
}

void sync_folder(const fs::path& folder) noexcept {
  const Handle handle{::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
  if (handle.fd >= 0) ::fsync(handle.fd);
}

}  // namespace roverd::maps
