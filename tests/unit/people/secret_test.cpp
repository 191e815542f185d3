// Secrets, codes and passwords.

#include "people/secret.hpp"

#include <set>

#include <gtest/gtest.h>

#include "people/words.hpp"

namespace roverd::people {
namespace {

TEST(Secret, EveryOneIsOfItsOwn) {
  std::set<std::string> seen;
  for (int i = 0; i < 1000; ++i) {
    const std::string secret = random_secret();
    EXPECT_EQ(secret.size(), 43u);  // 256 bits in base64
    EXPECT_EQ(secret.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
                                       "0123456789-_"),
              std::string::npos)
        << secret;
    seen.insert(secret);
  }
  EXPECT_EQ(seen.size(), 1000u);
}

TEST(Secret, ADigestIsAlwaysTheSameAndOfOneLength) {
  EXPECT_EQ(digest("a"), digest("a"));
  EXPECT_NE(digest("a"), digest("b"));
  EXPECT_EQ(digest("").size(), 64u);
  EXPECT_EQ(digest(std::string(100'000, 'x')).size(), 64u);
  EXPECT_TRUE(same("abc", "abc"));
  EXPECT_FALSE(same("abc", "abd"));
  EXPECT_FALSE(same("abc", "ab"));
  EXPECT_TRUE(same("", ""));
}

TEST(Secret, ACodeCanBeReadAloudAndTypedAnyhow) {
  for (int i = 0; i < 200; ++i) {
    const std::string code = spoken_code();
    ASSERT_EQ(code.size(), 9u);
    EXPECT_EQ(code[4], '-');
    EXPECT_EQ(code.find_first_of("01OILBDPTNQ"), std::string::npos) << code;
    EXPECT_EQ(plain_code(code), code);
  }
  EXPECT_EQ(plain_code("ktrf3m7x"), "KTRF-3M7X");
  EXPECT_EQ(plain_code(" ktrf 3m7x "), "KTRF-3M7X");
  EXPECT_EQ(plain_code("kt-rf-3m-7x"), "KTRF-3M7X");
  EXPECT_EQ(plain_code(""), "");
  EXPECT_LE(plain_code(std::string(100'000, 'a')).size(), 65u);
}

TEST(Password, OnlyTheRightOneFitsItsHash) {
  const auto hash = hash_password("correct horse");
  ASSERT_TRUE(hash);
  EXPECT_TRUE(hash->starts_with("$argon2id$v=19$m=16384,t=40,p=1$")) << *hash;
  EXPECT_EQ(hash->find("horse"), std::string::npos);
  EXPECT_TRUE(is_password(*hash, "correct horse"));
  EXPECT_FALSE(is_password(*hash, "correct horse "));
  EXPECT_FALSE(is_password(*hash, ""));
  // The same password twice is not the same hash.
  EXPECT_NE(*hash, *hash_password("correct horse"));
}

TEST(Password, NobodysHashAndBrokenOnesFitNothing) {
  for (const char* typed : {"", "password", "correct horse"}) {
    EXPECT_FALSE(is_password(nobodys_hash(), typed));
  }
  for (const std::string& broken :
       {std::string(), std::string("$argon2id$"), std::string("x"), std::string(500, '$')}) {
    EXPECT_FALSE(is_password(broken, "correct horse"));
  }
}

TEST(Password, WeakOnesAndStrangeNamesAreNamed) {
  EXPECT_EQ(password_problem("correct horse", "anna"), "");
  EXPECT_EQ(password_problem("short", "anna"), "must have at least 12 characters");
  EXPECT_EQ(password_problem("annaannaanna", "annaannaanna"), "must not be the user's name");
  EXPECT_EQ(password_problem("aaaaaaaaaaaa", "anna"), "must not be one character again and again");
  EXPECT_EQ(password_problem(std::string(201, 'a'), "anna"), "must have at most 200 bytes");
  for (const char* good : {"anna", "a", "A.b-c_9"}) EXPECT_EQ(user_name_problem(good), "");
  for (const std::string& bad :
       {std::string(), std::string("a b"), std::string("\xC3\xA4"), std::string("a\n"),
        std::string("a/b"), std::string(41, 'a'), std::string("a\0b", 3)}) {
    EXPECT_NE(user_name_problem(bad), "") << bad;
  }
}

TEST(Role, WordsGoThereAndBack) {
  for (const Role role : kRoles) EXPECT_EQ(role_of(to_string(role)), role);
  EXPECT_FALSE(role_of("Admin"));
  EXPECT_FALSE(role_of(""));
}

}  // namespace
}  // namespace roverd::people
