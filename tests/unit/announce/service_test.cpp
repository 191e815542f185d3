#include "announce/service.hpp"

#include <gtest/gtest.h>

namespace roverd::announce {
namespace {

TEST(Service, TheSecondOfANameGetsANumber) {
  EXPECT_EQ(numbered("kask", 1), "kask");
  EXPECT_EQ(numbered("kask", 2), "kask-2");
  EXPECT_EQ(numbered("kask", 12), "kask-12");
}

TEST(Service, ALongNameIsCutBetweenCharactersAndKeepsItsNumber) {
  const std::string letters = "õõõõõõõõõõõõõõõõõõõõõõõõõõõõõõõõ";  // 64 bytes
  ASSERT_EQ(letters.size(), 64U);
  EXPECT_EQ(numbered(letters, 1), letters.substr(0, 62));
  EXPECT_EQ(numbered(letters, 2), letters.substr(0, 60) + "-2");
}

TEST(Service, FactsAreKeysAndValuesOf255BytesAtMost) {
  Service service;
  service.facts = {{"path", "/"}, {"long", std::string(300, 'x')}};
  const auto txt = txt_of(service);
  ASSERT_EQ(txt.size(), 2U);
  EXPECT_EQ(txt[0], "path=/");
  EXPECT_EQ(txt[1], "long=" + std::string(250, 'x'));
}

TEST(Service, AnAliasIsWrittenAsDnsWritesNames) {
  EXPECT_EQ(wire_name("a.local"), std::string("\1a\5local\0", 9));
  EXPECT_EQ(wire_name("kask-2.local."), std::string("\6kask-2\5local\0", 14));
  EXPECT_EQ(wire_name(""), std::string(1, '\0'));
  EXPECT_EQ(wire_name(std::string(70, 'a')), "\x3f" + std::string(63, 'a') + std::string(1, '\0'));
}

}  // namespace
}  // namespace roverd::announce
