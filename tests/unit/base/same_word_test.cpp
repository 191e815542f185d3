#include "base/same_word.hpp"

#include <cstring>

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

namespace roverd::base {
namespace {

TEST(SameWord, CaseOfPlainLettersDoesNotCount) {
  EXPECT_TRUE(same_word("", ""));
  EXPECT_TRUE(same_word("Chunked", "cHUNKED"));
  EXPECT_TRUE(same_word("application/json", "Application/JSON"));
  EXPECT_FALSE(same_word("gzip", "gzi"));
  EXPECT_FALSE(same_word("gzip", "gzi_"));
  EXPECT_FALSE(same_word("@[`{", "`{@["));  // the neighbours of the letters
}

TEST(SameWord, NothingIsReadBeyondEitherWord) {
  // Given two words at the end of readable memory, which differ in case and then at all,
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  char* const at = static_cast<char*>(
      ::mmap(nullptr, 3 * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
  ASSERT_NE(at, MAP_FAILED);
  ASSERT_EQ(::mprotect(at + page, page, PROT_NONE), 0);
  std::memcpy(at + page - 4, "gZiP", 4);
  // when they are compared, then whoever reads on dies of it.
  EXPECT_TRUE(same_word({at + page - 4, 4}, "GzIp"));
  EXPECT_TRUE(same_word("GzIp", {at + page - 4, 4}));
  EXPECT_FALSE(same_word({at + page - 4, 4}, "GzIx"));
  ::munmap(at, 3 * page);
}

}  // namespace
}  // namespace roverd::base
