// Another program as a child: its lines, its end, and what a bad one does.

#include "app/child_process.hpp"

#include <chrono>
#include <filesystem>
#include <iterator>
#include <optional>

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

namespace roverd {
namespace {

using namespace std::chrono_literals;

class ChildProcessTest : public testing::Test {
 protected:
  /// Runs it to its end. @return its problem; empty: it went well, no value: it was never told
  std::optional<std::string> shell(const std::string& script, std::string input = "",
                                   base::Duration limit = 20s) {
    ended_.reset();
    lines.clear();
    const auto begun = child.start({"/bin/sh", "-c", script}, std::move(input), limit, ears());
    EXPECT_TRUE(begun) << begun.error().detail;
    io.restart();
    io.run_for(30s);
    return ended_;
  }
  ChildProcess::Ears ears() {
    return {[this](const std::string& line) { lines.push_back(line); },
            [this](const std::string& problem) { ended_ = problem; }};
  }

  boost::asio::io_context io{1};
  ChildProcess child{io};
  std::vector<std::string> lines;
  std::optional<std::string> ended_;
};

TEST_F(ChildProcessTest, ReadsWhatItIsToldAndTellsItsLines) {
  // Given more input than a pipe holds
  const std::string input(300'000, 'x');
  // When a program counts it
  EXPECT_EQ(shell("wc -c | tr -d ' '; echo; printf 'no end'", input + "\n"), "");
  // Then its whole lines were heard, and what was begun was not
  EXPECT_EQ(lines, (std::vector<std::string>{"300001", ""}));
  EXPECT_FALSE(child.running());
}

TEST_F(ChildProcessTest, EndsWithoutReadingItsInput) {
  EXPECT_EQ(shell("exit 0", std::string(300'000, 'x')), "");
}

TEST_F(ChildProcessTest, TellsItsExitCodeWithItsLastWords) {
  EXPECT_EQ(shell("echo first >&2; echo 'cannot go on' >&2; exit 3"),
            "sh ended with exit code 3: cannot go on");
  EXPECT_EQ(shell("exit 4"), "sh ended with exit code 4");
}

TEST_F(ChildProcessTest, TellsTheSignalThatEndedIt) {
  EXPECT_EQ(shell("kill -SEGV $$"), "sh was ended by signal 11 (Segmentation fault)");
}

TEST_F(ChildProcessTest, IsKilledWhenItTakesTooLong) {
  const auto begun = std::chrono::steady_clock::now();
  EXPECT_EQ(shell("exec sleep 20", "", 1s), "sh took longer than 1 s");
  EXPECT_LT(std::chrono::steady_clock::now() - begun, 10s);
}

TEST_F(ChildProcessTest, IsKilledWhenItSaysTooMuch) {
  EXPECT_EQ(shell("exec cat /dev/zero"), "sh said more than can be");
  EXPECT_EQ(shell("exec yes $(printf %01000d 1)"), "sh said more than can be");
}

TEST_F(ChildProcessTest, ThatIsNotThereIsNamed) {
  const auto begun = child.start({"/nowhere/study"}, "", 1s, ears());
  ASSERT_FALSE(begun);
  EXPECT_EQ(begun.error().code, base::Code::Unavailable);
  EXPECT_EQ(begun.error().detail, "/nowhere/study: No such file or directory");
  EXPECT_FALSE(child.running());
}

TEST_F(ChildProcessTest, RunsOneAtATimeAndNobodyHearsOfOneThatWasStopped) {
  // Given one that runs
  ASSERT_TRUE(child.start({"/bin/sleep", "20"}, "", 20s, ears()));
  const auto second = child.start({"/bin/sleep", "20"}, "", 20s, ears());
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, base::Code::Conflict);
  // When it is stopped, then the next one may run at once
  child.stop();
  EXPECT_FALSE(child.running());
  EXPECT_EQ(shell("echo next"), "");
  EXPECT_EQ(lines, (std::vector<std::string>{"next"}));
}

TEST_F(ChildProcessTest, InheritsNoDescriptorAndNoBlockedSignal) {
  // Given a descriptor that others would inherit, and a signal that is blocked
  const int mine = ::dup(STDERR_FILENO);
  ASSERT_GT(mine, STDERR_FILENO);
  sigset_t term;
  sigemptyset(&term);
  sigaddset(&term, SIGTERM);
  sigset_t before;
  pthread_sigmask(SIG_BLOCK, &term, &before);
  // When programs tell what they have
  EXPECT_EQ(shell("exec ls /proc/self/fd"), "");
  const auto descriptors = lines;
  EXPECT_EQ(shell("exec grep SigBlk /proc/self/status"), "");
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  ::close(mine);
  // Then that is input, output, errors and the folder that is listed, and no signal
  EXPECT_EQ(descriptors, (std::vector<std::string>{"0", "1", "2", "3"}));
  EXPECT_EQ(lines, (std::vector<std::string>{"SigBlk:\t0000000000000000"}));
}

TEST_F(ChildProcessTest, HoldsNoDescriptorWhenItHasEnded) {
  const auto held = [] {
    const std::filesystem::directory_iterator all("/proc/self/fd");
    return std::distance(std::filesystem::begin(all), std::filesystem::end(all));
  };
  EXPECT_EQ(shell("exit 0"), "");  // asio may have opened some of its own
  child.stop();
  const auto before = held();
  EXPECT_EQ(shell("echo said; exit 0"), "");
  EXPECT_EQ(held(), before);
  EXPECT_EQ(shell("exit 3"), "sh ended with exit code 3");
  EXPECT_EQ(held(), before);
}

}  // namespace
}  // namespace roverd
