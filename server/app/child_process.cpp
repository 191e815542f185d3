#include "app/child_process.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/local/connect_pair.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace roverd {

namespace {

namespace asio = boost::asio;
using boost::system::error_code;

constexpr base::Duration kReapEvery = std::chrono::milliseconds(5);
constexpr std::size_t kLastWords = 2000;

/// Both ends close by themselves.
struct Pipe {
  std::array<int, 2> fd{-1, -1};
  Pipe() = default;
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() {
    for (const int one : fd) {
      if (one >= 0) ::close(one);
    }
  }
  bool open() { return ::pipe2(fd.data(), O_CLOEXEC) == 0; }
  int give(std::size_t end) { return std::exchange(fd[end], -1); }
};

struct Pipes {
  Pipe out, err;
  bool open() { return out.open() && err.open(); }
};

/// With these pipes and nothing else of ours. @return an errno
int spawn(pid_t& pid, const std::vector<std::string>& command, int in, const Pipes& pipes) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, in, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, pipes.out.fd[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, pipes.err.fd[1], STDERR_FILENO);
  posix_spawn_file_actions_addclosefrom_np(&files, STDERR_FILENO + 1);
  posix_spawnattr_t how;
  posix_spawnattr_init(&how);
  sigset_t none;
  sigset_t all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&how, &none);
  posix_spawnattr_setsigdefault(&how, &all);
  posix_spawnattr_setflags(&how, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const int failed =
      ::posix_spawn(&pid, command.front().c_str(), &files, &how, arguments.data(), environ);
  posix_spawnattr_destroy(&how);
  posix_spawn_file_actions_destroy(&files);
  return failed;
}

std::string last_line(std::string text) {
  text.erase(text.find_last_not_of(" \r\n") + 1);
  return text.substr(text.find_last_of('\n') + 1);  // npos + 1 is 0
}

}  // namespace

struct ChildProcess::Job : std::enable_shared_from_this<Job> {
  Job(asio::io_context& io, Ears with)
      : in(io), out(io), err(io), timer(io), ears(std::move(with)) {}
  ~Job() {
    if (pid <= 0) return;
    ::kill(pid, SIGKILL);
    (void)::waitpid(pid, nullptr, 0);
  }
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  void run(std::string text, base::Duration limit);
  void write(std::string text);
  void hear_lines();
  void hear_errors();
  bool take(std::size_t count);
  void kill(std::string why);
  void reap_soon();
  void reap();
  void tell_end(int status);

  /// No pipe: writing to one whose reader died would end this program, too.
  asio::local::stream_protocol::socket in;
  asio::posix::stream_descriptor out, err;
  asio::steady_timer timer;  ///< first the limit, then the wait for its end
  Ears ears;
  std::string name;
  pid_t pid = -1;
  int open = 2;      ///< of its two outputs
  std::string why;   ///< it was killed
  std::string line;  ///< begun
  std::string words;
  std::size_t heard = 0;
  std::array<char, 16 * 1024> buffer{};
  std::array<char, 1024> error_buffer{};
};

void ChildProcess::Job::run(std::string text, base::Duration limit) {
  timer.expires_after(limit);
  timer.async_wait([self = shared_from_this(), limit](const error_code& ec) {
    if (ec) return;
    const auto s = std::chrono::duration_cast<std::chrono::seconds>(limit).count();
    self->kill("took longer than " + std::to_string(s) + " s");
  });
  write(std::move(text));
  hear_lines();
  hear_errors();
}

void ChildProcess::Job::write(std::string text) {
  auto held = std::make_shared<std::string>(std::move(text));
  asio::async_write(in, asio::buffer(*held),
                    [self = shared_from_this(), held](const error_code&, std::size_t) {
                      error_code none;  // it may have ended without reading all: its end tells
                      self->in.close(none);
                    });
}

void ChildProcess::Job::hear_lines() {
  out.async_read_some(asio::buffer(buffer),
                      [self = shared_from_this()](const error_code& ec, std::size_t count) {
                        if (!ec && self->take(count)) return self->hear_lines();
                        if (--self->open == 0) self->reap_soon();
                      });
}

void ChildProcess::Job::hear_errors() {
  err.async_read_some(asio::buffer(error_buffer),
                      [self = shared_from_this()](const error_code& ec, std::size_t count) {
                        if (ec) {
                          if (--self->open == 0) self->reap_soon();
                          return;
                        }
                        self->words.append(self->error_buffer.data(), count);
                        if (self->words.size() > kLastWords) {
                          self->words.erase(0, self->words.size() - kLastWords);
                        }
                        self->hear_errors();
                      });
}

/// @return false: it says too much.
bool ChildProcess::Job::take(std::size_t count) {
  heard += count;
  line.append(buffer.data(), count);
  for (auto end = line.find('\n'); end != std::string::npos; end = line.find('\n')) {
    const std::string whole = line.substr(0, end);
    line.erase(0, end + 1);
    if (ears.line) ears.line(whole);
  }
  if (line.size() <= kLongestLine && heard <= kMostOutput) return true;
  kill("said more than can be");
  return false;
}

void ChildProcess::Job::kill(std::string reason) {
  if (pid <= 0) return;
  why = std::move(reason);
  ::kill(pid, SIGKILL);
}

void ChildProcess::Job::reap_soon() {
  timer.expires_after(kReapEvery);
  timer.async_wait([self = shared_from_this()](const error_code& ec) {
    if (!ec) self->reap();
  });
}

void ChildProcess::Job::reap() {
  int status = 0;
  const pid_t done = ::waitpid(pid, &status, WNOHANG);
  if (done == 0) return reap_soon();
  pid = -1;
  error_code none;  // nobody may start another one for a day
  out.close(none);
  err.close(none);
  tell_end(status);
}

void ChildProcess::Job::tell_end(int status) {
  std::string problem;
  if (!why.empty()) {
    problem = name + " " + why;
  } else if (WIFSIGNALED(status)) {
    problem = name + " was ended by signal " + std::to_string(WTERMSIG(status)) + " (" +
              ::strsignal(WTERMSIG(status)) + ")";
  } else if (WEXITSTATUS(status) != 0) {
    const std::string said = last_line(words);
    problem = name + " ended with exit code " + std::to_string(WEXITSTATUS(status)) +
              (said.empty() ? "" : ": " + said);
  }
  if (const auto end = std::exchange(ears.end, nullptr)) end(problem);
}

base::Result<void> ChildProcess::start(const std::vector<std::string>& command, std::string input,
                                       base::Duration limit, Ears ears) {
  if (running()) return base::fail(base::Code::Conflict, command.front() + " runs already");
  const auto cannot = [&command](int error) {
    return base::fail(base::Code::Unavailable, command.front() + ": " + std::strerror(error));
  };
  Pipes pipes;
  if (!pipes.open()) return cannot(errno);
  auto job = std::make_shared<Job>(io_, std::move(ears));
  asio::local::stream_protocol::socket theirs(io_);
  error_code ec;
  asio::local::connect_pair(job->in, theirs, ec);
  if (ec) return cannot(ec.value());
  if (const int failed = spawn(job->pid, command, theirs.native_handle(), pipes); failed != 0) {
    job->pid = -1;
    return cannot(failed);
  }
  job->name = std::filesystem::path(command.front()).filename().string();
  job->out.assign(pipes.out.give(0));
  job->err.assign(pipes.err.give(0));
  job_ = std::move(job);
  job_->run(std::move(input), limit);
  return {};
}

bool ChildProcess::running() const noexcept {
  return job_ && job_->pid > 0;
}

void ChildProcess::stop() noexcept {
  if (!job_) return;
  job_->ears = {};
  job_->kill("");
  job_.reset();  // its handlers hold it until it has been reaped
}

}  // namespace roverd
