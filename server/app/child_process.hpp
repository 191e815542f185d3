#pragma once
// Another program of ours as a child of this one: text in, lines out, one at a time. Nothing here
// waits: its pipes are read and written as they are ready.
//
//   start ─▶ child ◀─ input, then closed
//              ├─ stdout ─▶ line, line, line …
//              ├─ stderr ─▶ the last words, for when it fails
//              └─ ends, is killed, takes too long ─▶ end(problem), once
//
// It inherits no descriptor and no blocked signal, and is gone when this object is. It is not
// forked: pages of a robot's program must not begin to fault because of it.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <boost/asio/io_context.hpp>

#include "base/result.hpp"
#include "base/time.hpp"

namespace roverd {

class ChildProcess {
 public:
  /// A line that is longer ends it, and so does more of them.
  static constexpr std::size_t kLongestLine = 1u << 20u;
  static constexpr std::size_t kMostOutput = 32u << 20u;

  /// Called on the io_context's thread.
  struct Ears {
    std::function<void(const std::string&)> line;  ///< without its end
    /// Empty: exit code 0. Else what happened, beginning with the program's name.
    std::function<void(const std::string& problem)> end;
  };

  explicit ChildProcess(boost::asio::io_context& io) : io_(io) {}
  ~ChildProcess() { stop(); }
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// @param command program and arguments. Conflict: one runs already. Unavailable, naming the
  /// program: it cannot be started. @param limit then it is killed
  base::Result<void> start(const std::vector<std::string>& command, std::string input,
                           base::Duration limit, Ears ears);
  bool running() const noexcept;
  /// Kills it; no ear hears more of it. Does nothing if none runs.
  void stop() noexcept;

 private:
  struct Job;
  boost::asio::io_context& io_;
  std::shared_ptr<Job> job_;
};

}  // namespace roverd
