#include "net/frame.hpp"

#include <gtest/gtest.h>

namespace roverd::net {
namespace {

// RFC 6455, section 5.7: 0x81 0x05 0x48 0x65 0x6c 0x6c 0x6f is an unmasked "Hello".
TEST(Frame, HelloIsTheOneOfTheStandard) {
  EXPECT_EQ(*text_frame("Hello"), "\x81\x05Hello");
}

TEST(Frame, LengthsTakeTheShortestForm) {
  // Given texts at the borders of the three forms of a length,
  // then the header grows by two and by eight bytes, most significant first.
  EXPECT_EQ(text_frame(std::string(125, 'x'))->substr(0, 2), "\x81\x7d");
  EXPECT_EQ(text_frame(std::string(126, 'x'))->substr(0, 4), std::string("\x81\x7e\x00\x7e", 4));
  EXPECT_EQ(text_frame(std::string(65535, 'x'))->substr(0, 4), "\x81\x7e\xff\xff");
  EXPECT_EQ(text_frame(std::string(65536, 'x'))->substr(0, 10),
            std::string("\x81\x7f\x00\x00\x00\x00\x00\x01\x00\x00", 10));
  EXPECT_EQ(text_frame(std::string(65536, 'x'))->size(), 65546u);
}

TEST(Frame, AnEmptyTextIsTwoBytes) {
  EXPECT_EQ(*text_frame(""), std::string("\x81\x00", 2));
  EXPECT_EQ(*ping_frame(), std::string("\x89\x00", 2));
}

}  // namespace
}  // namespace roverd::net
