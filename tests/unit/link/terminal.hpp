#pragma once
// A serial port for tests.

#include <array>
#include <string>
#include <string_view>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <unistd.h>

namespace roverd::link {

/// A pseudo-terminal: `master` plays the device, `path` is the serial port.
struct Terminal {
  Terminal() {
    int slave = -1;
    std::array<char, 256> name{};
    EXPECT_EQ(::openpty(&master, &slave, name.data(), nullptr, nullptr), 0);
    path = name.data();
    ::fcntl(master, F_SETFL, O_NONBLOCK);
    ::close(slave);
  }
  ~Terminal() { hang_up(); }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;
  void hang_up() {
    if (master >= 0) ::close(master);
    master = -1;
  }
  void say(std::string_view text) const {
    ASSERT_EQ(::write(master, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  /// What the program wrote since the last call.
  std::string hear() const {
    std::array<char, 4096> buffer{};
    const ssize_t n = ::read(master, buffer.data(), buffer.size());
    return n > 0 ? std::string(buffer.data(), static_cast<std::size_t>(n)) : std::string();
  }
  int master = -1;
  std::string path;
};

}  // namespace roverd::link
