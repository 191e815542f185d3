#include "study/plant_program.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <thread>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace roverd::study {
namespace {

using base::Result;
using SteadyClock = std::chrono::steady_clock;

tl::unexpected<base::Error> plant_failed(std::string why) {
  return base::fail(base::Code::Unavailable, "the plant program " + std::move(why));
}

struct Pipe {
  int read = -1;
  int write = -1;

  bool open() {
    std::array<int, 2> ends{};
    // Not for the programs of other runs: an end that they hold never closes.
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) return false;
    read = ends[0];
    write = ends[1];
    return true;
  }
};

void close_end(int& end) {
  if (end >= 0) ::close(end);
  end = -1;
}

/// A child of its own group, with pipes as standard input and output. @return 0 or errno.
int spawn_shell(const std::string& command, int in, int out, pid_t& child) {
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, in, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, out, STDOUT_FILENO);
  posix_spawnattr_init(&attributes);
  sigset_t usual;
  sigemptyset(&usual);
  sigaddset(&usual, SIGPIPE);
  posix_spawnattr_setsigdefault(&attributes, &usual);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
  posix_spawnattr_setpgroup(&attributes, 0);
  std::string text = command;
  std::array<char, 3> shell{"sh"};
  std::array<char, 3> option{"-c"};
  std::array<char*, 4> words{shell.data(), option.data(), text.data(), nullptr};
  const int failed = ::posix_spawn(&child, "/bin/sh", &files, &attributes, words.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  return failed;
}

std::string cut_short(const std::string& text) {
  constexpr std::size_t kShown = 120;
  return text.size() <= kShown ? text : text.substr(0, kShown) + "…";
}

}  // namespace

Result<std::unique_ptr<PlantProgram>> PlantProgram::start(const std::string& command,
                                                          const PlantHello& hello,
                                                          base::Duration patience) {
  std::unique_ptr<PlantProgram> program(new PlantProgram(hello, patience));
  if (auto good = program->spawn(command); !good) return tl::unexpected(good.error());
  const auto line = program->ask(hello_line(hello));
  if (!line) return tl::unexpected(line.error());
  auto said = read_plant_line(*line, hello, true);
  if (!said) {
    return plant_failed("answered the hello with " + cut_short(*line) + ": " + said.error().detail);
  }
  program->said_ = *said;
  return program;
}

Result<void> PlantProgram::spawn(const std::string& command) {
  Pipe in;
  Pipe out;
  int failed = in.open() && out.open() ? 0 : errno;
  if (failed == 0) failed = spawn_shell(command, in.read, out.write, child_);
  close_end(in.read);
  close_end(out.write);
  to_ = in.write;
  from_ = out.read;
  if (failed == 0) return {};
  child_ = -1;
  return plant_failed(std::string("cannot be started: ") + std::strerror(failed));
}

PlantProgram::~PlantProgram() {
  close_end(to_);
  close_end(from_);
  if (child_ <= 0) return;
  (void)::kill(-child_, SIGKILL);
  (void)::waitpid(child_, nullptr, 0);
}

const sim::ForeignState& PlantProgram::step(const sim::ForeignOrder& order) {
  if (!problem_.empty()) return said_.state;
  const auto line = ask(order_line(order, hello_.steered));
  auto said = line ? read_plant_line(*line, hello_, false) : tl::unexpected(line.error());
  if (said) {
    said_.state = said->state;
    return said_.state;
  }
  problem_ = line ? "the plant program answered " + cut_short(*line) + ": " + said.error().detail
                  : line.error().detail;
  said_.state.fix.reset();
  return said_.state;
}

Result<std::string> PlantProgram::ask(std::string line) {
  line += '\n';
  std::size_t sent = 0;
  while (sent < line.size()) {
    const ssize_t n = ::write(to_, line.data() + sent, line.size() - sent);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return plant_failed(how_it_ended());
    sent += static_cast<std::size_t>(n);
  }
  return hear();
}

Result<std::string> PlantProgram::hear() {
  const auto until = SteadyClock::now() + patience_;
  for (;;) {
    if (const auto end = heard_.find('\n'); end != std::string::npos) {
      std::string line = heard_.substr(0, end);
      heard_.erase(0, end + 1);
      return line;
    }
    if (heard_.size() > kMaxPlantLine) return plant_failed("tells a line without an end");
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(until - SteadyClock::now()).count();
    pollfd wait{from_, POLLIN, 0};
    const int ready = left > 0 ? ::poll(&wait, 1, static_cast<int>(left)) : 0;
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) {
      return plant_failed("was silent for " +
                          std::to_string(std::lround(base::seconds(patience_))) + " s");
    }
    std::array<char, 4096> bytes{};
    const ssize_t n = ::read(from_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return plant_failed(how_it_ended());
    heard_.append(bytes.data(), static_cast<std::size_t>(n));
  }
}

std::string PlantProgram::how_it_ended() {
  // Its end of the pipe closes a moment before it is gone.
  for (int i = 0; i < 50 && child_ > 0; ++i) {
    int status = 0;
    if (::waitpid(child_, &status, WNOHANG) == child_) {
      const pid_t group = child_;
      child_ = -1;
      (void)::kill(-group, SIGKILL);  // what it left behind
      if (WIFSIGNALED(status)) return "was killed by signal " + std::to_string(WTERMSIG(status));
      return "ended with exit code " + std::to_string(WEXITSTATUS(status));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return "closed its pipe";
}

}  // namespace roverd::study
