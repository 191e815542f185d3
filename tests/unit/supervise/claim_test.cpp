// Two programs never move the same robot.

#include "supervise/claim.hpp"

#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace roverd {
namespace {

/// Of this test alone: others may run beside it.
std::string link_named(const std::string& name) {
  return "can:" + name + std::to_string(::getpid());
}

TEST(Claim, TheSecondOneIsRefusedAndToldWhoTheFirstIs) {
  const std::string link = link_named("a");
  const auto first = Claim::take(link);
  ASSERT_TRUE(first) << first.error().detail;
  for (int i = 0; i < 3; ++i) {
    const auto second = Claim::take(link);
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().detail, "another roverd (process " + std::to_string(::getpid()) +
                                         ") drives this robot over " + link);
  }
}

TEST(Claim, EveryLinkIsItsOwn) {
  const auto first = Claim::take(link_named("a"));
  EXPECT_TRUE(Claim::take(link_named("b")));
  // Links longer than such a name may be differ at their ends.
  const std::string front(200, 'x');
  const auto longer = Claim::take(link_named(front) + "1");
  EXPECT_TRUE(Claim::take(link_named(front) + "2"));
  EXPECT_FALSE(Claim::take(link_named(front) + "1"));
}

TEST(Claim, ItIsGivenBackWhateverEndsTheProcess) {
  // Given a process that claims a link and is killed,
  const std::string link = link_named("c");
  int ready[2];
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const auto claim = Claim::take(link);
    const char done = claim ? 'y' : 'n';
    if (::write(ready[1], &done, 1) != 1) ::_exit(1);
    ::pause();
  }
  char done = 'n';
  ASSERT_EQ(::read(ready[0], &done, 1), 1);
  EXPECT_EQ(done, 'y');
  EXPECT_FALSE(Claim::take(link));
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  // then the link is free.
  EXPECT_TRUE(Claim::take(link));
}

}  // namespace
}  // namespace roverd
