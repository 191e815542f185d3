// Frames as RFC 6455 (section 5) has them, and what is none.

#include "net/lookout.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace roverd::net {
namespace {

/// A client's frame, masked by hand.
std::string frame(unsigned char first, std::string_view payload, int length_bytes = 0) {
  std::string out(1, static_cast<char>(first));
  const auto n = payload.size();
  out += static_cast<char>(0x80U | (length_bytes == 2 ? 126U : length_bytes == 8 ? 127U : n));
  for (int i = length_bytes - 1; i >= 0; --i) out += static_cast<char>((n >> (8 * i)) & 0xffU);
  const unsigned char mask[4] = {0x12, 0x00, 0xff, 0x81};
  out.append(reinterpret_cast<const char*>(mask), 4);
  for (std::size_t i = 0; i < n; ++i) {
    out += static_cast<char>(static_cast<unsigned char>(payload[i]) ^ mask[i % 4]);
  }
  return out;
}

std::vector<std::string> seen(std::string_view bytes, std::size_t piece) {
  std::vector<std::string> out;
  Lookout lookout;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    lookout.feed(bytes.substr(at, piece), [&](std::string_view text) { out.emplace_back(text); });
  }
  return out;
}

TEST(Lookout, ShowsShortWholeTextsInWhateverPiecesTheyCome) {
  const std::string bytes = frame(0x81, "one") + frame(0x89, "a ping") + frame(0x81, "") +
                            frame(0x82, "binary") + frame(0x81, std::string(300, 'x'), 2) +
                            frame(0x81, std::string(70'000, 'y'), 8) +
                            frame(0x81, std::string(125, 'z')) + frame(0x01, "a part") +
                            frame(0x80, "the rest") + frame(0x81, "last");
  const std::vector<std::string> wanted = {"one", "", std::string(125, 'z'), "last"};
  for (const std::size_t piece :
       {std::size_t{1}, std::size_t{3}, std::size_t{1536}, bytes.size()}) {
    EXPECT_EQ(seen(bytes, piece), wanted) << piece;
  }
}

TEST(Lookout, SeesNothingBehindWhatCannotBeAClientsFrame) {
  const std::string good = frame(0x81, "text");
  std::string unmasked = "\x81\x04text";
  for (const std::string& bad : {unmasked, frame(0xC1, "compressed"), frame(0xA1, "reserved")}) {
    EXPECT_EQ(seen(good + bad + good, 1), std::vector<std::string>{"text"});
  }
}

TEST(Lookout, AHugeLengthIsOnlySkipped) {
  std::string huge = "\x81\xff";
  huge.append(8, '\xff');
  EXPECT_TRUE(seen(huge + "mask" + std::string(10'000, 'x') + frame(0x81, "text"), 7).empty());
}

}  // namespace
}  // namespace roverd::net
