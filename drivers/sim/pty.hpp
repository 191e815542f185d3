#pragma once
// A pseudo-terminal that looks like a device's serial port, with a symbolic link to it at a path of
// the caller's choice.

#include <string>

#include "link/descriptor.hpp"
#include "link/link.hpp"

namespace roverd::sim {

/// Raw in both directions. Nobody need listen: like a serial port without a reader, old bytes are
/// dropped; what a late reader still finds is about a second old.
class Pty final : public link::ByteLink {
 public:
  static constexpr int kMaxUnread = 2048;  ///< bytes; more are dropped before the next write

  /// @param path where the symbolic link is made. One that is there already is replaced; anything
  /// else at that path is left alone and is an error of open(). Empty: no link is made.
  Pty(boost::asio::io_context& io, std::string path);
  ~Pty() override;

  base::Result<void> open() override;
  void close() noexcept override;
  link::SendResult write(base::Bytes bytes) noexcept override;
  std::string describe() const override {
    return "serial:" + (path_.empty() ? device_ : path_) + ":115200";
  }

 private:
  base::Result<void> make_symlink(const std::string& device);
  void read();
  void drop_unread() noexcept;

  const std::string path_;
  link::Descriptor master_;
  int slave_ = -1;      ///< held open, so that the line does not hang up between readers
  std::string device_;  ///< "/dev/pts/3", while it is open
};

}  // namespace roverd::sim
