#include "tools/decode.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

#include <fcntl.h>
#include <unistd.h>

namespace roverd {
namespace {

constexpr int kUnreadable = 1;
constexpr int kUsageWrong = 2;

struct Kind {
  std::string_view name;
  Reader (*make)(OnObject);
};
constexpr std::array kKinds{
    Kind{"bunker", bunker_reader}, Kind{"nmea", nmea_reader},     Kind{"ubx", ubx_reader},
    Kind{"mti", mti_reader},       Kind{"sick", sick_reader},     Kind{"vlp16", vlp16_reader},
    Kind{"cloud", cloud_reader},   Kind{"ranges", ranges_reader}, Kind{"vision", vision_reader}};

int say(int code, const std::string& cause) {
  std::fprintf(stderr, "roverd: %s\n", cause.c_str());
  return code;
}

class File {
 public:
  explicit File(const std::string& path)
      : fd_(path == "-" ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
  ~File() {
    if (fd_ > STDIN_FILENO) ::close(fd_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  /// As read(2), but not disturbed by signals; −1 also if the file could not be opened.
  ssize_t read(std::span<std::uint8_t> block) const noexcept {
    for (;;) {
      const ssize_t n = ::read(fd_, block.data(), block.size());
      if (n >= 0 || errno != EINTR) return n;
    }
  }
  bool is_open() const noexcept { return fd_ >= 0; }

 private:
  const int fd_;
};

/// Captures are often kept packed. Empty: these first bytes are of no packer that is known.
std::string packed_by(std::span<const std::uint8_t> begin) {
  const auto begins = [begin](std::string_view magic) {
    return begin.size() >= magic.size() &&
           std::memcmp(begin.data(), magic.data(), magic.size()) == 0;
  };
  if (begins("\x1f\x8b\x08")) return "gzip";
  if (begins("\xfd"
             "7zXZ"))
    return "xz";
  if (begins("\x28\xb5\x2f\xfd")) return "zstd";
  if (begins("BZh")) return "bzip2";
  return {};
}

/// Everything that comes in so far goes out before the next block is waited for, so that a live
/// `candump can0 | roverd decode bunker -` shows each frame at once.
int run(const Kind& kind, const std::string& path) {
  const File file(path);
  if (!file.is_open()) return say(kUnreadable, path + ": " + std::strerror(errno));
  std::string out;
  const Reader reader =
      kind.make([&out](const nlohmann::ordered_json& object) { out += to_line(object); });
  const std::string name = path == "-" ? "standard input" : path;
  bool begun = false;
  bool anything = false;
  std::array<std::uint8_t, 65536> block{};
  for (bool more = true; more;) {
    const ssize_t n = file.read(block);
    if (n < 0) return say(kUnreadable, path + ": " + std::strerror(errno));
    more = n > 0;
    if (!begun && more) {
      const std::string packer = packed_by({block.data(), static_cast<std::size_t>(n)});
      if (!packer.empty()) {
        return say(kUnreadable, name + ": is packed: " + packer + " -dc FILE | roverd decode " +
                                    std::string(kind.name) + " -");
      }
      begun = true;
    }
    if (more) {
      reader.feed({block.data(), static_cast<std::size_t>(n)});
    } else {
      reader.finish();
    }
    anything = anything || !out.empty();
    const bool written =
        std::fwrite(out.data(), 1, out.size(), stdout) == out.size() && std::fflush(stdout) == 0;
    if (!written && errno == EPIPE) return 0;
    if (!written) return say(kUnreadable, std::string("standard output: ") + std::strerror(errno));
    out.clear();
  }
  return anything ? 0 : say(kUnreadable, name + ": there are no packets in it");
}

}  // namespace

std::string to_line(const nlohmann::ordered_json& object) {
  return object.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
}

int decode(const std::string& kind, const std::string& file) {
  std::signal(SIGPIPE, SIG_IGN);
  for (const Kind& known : kKinds) {
    if (known.name == kind) return run(known, file);
  }
  return say(kUsageWrong, "decode does not know \"" + kind + "\" (roverd decode --help)");
}

}  // namespace roverd
