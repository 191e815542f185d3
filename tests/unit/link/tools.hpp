#pragma once
// What the link tests share: running an io_context until something is true, and a folder that goes
// away with the test.

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>

#include <boost/asio/io_context.hpp>

#include "base/bytes.hpp"

namespace roverd::link {

/// Handles events until `done`. The deadline only ends a test that fails.
template <class Done>
bool run_until(boost::asio::io_context& io, Done done,
               std::chrono::seconds deadline = std::chrono::seconds(20)) {
  const auto end = std::chrono::steady_clock::now() + deadline;
  while (!done()) {
    if (std::chrono::steady_clock::now() > end) return false;
    io.restart();
    if (io.run_one_for(std::chrono::milliseconds(5)) == 0) std::this_thread::yield();
  }
  return true;
}

/// Handles everything that is ready now, and what that makes ready.
inline void run_ready(boost::asio::io_context& io) {
  for (int i = 0; i < 100; ++i) {
    io.restart();
    if (io.poll() == 0) return;
  }
}

class TempFolder {
 public:
  TempFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "roverd-link-XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  ~TempFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  std::string file(const std::string& name) const { return (path_ / name).string(); }
  std::string write(const std::string& name, std::string_view content) const {
    std::ofstream(file(name), std::ios::binary) << content;
    return file(name);
  }

 private:
  std::filesystem::path path_;
};

inline std::string read_file(const std::string& path) {
  std::ostringstream out;
  out << std::ifstream(path, std::ios::binary).rdbuf();
  return out.str();
}

inline base::Bytes bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}
inline std::string text_of(base::Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

inline base::CanFrame make_frame(std::uint32_t id, std::initializer_list<std::uint8_t> data) {
  base::CanFrame frame;
  frame.id = id;
  for (const auto byte : data) frame.data[frame.len++] = byte;
  return frame;
}

}  // namespace roverd::link
