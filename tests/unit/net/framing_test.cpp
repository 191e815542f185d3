// Where a request ends, as RFC 9112 (section 6) has it.

#include "net/framing.hpp"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace roverd::net {
namespace {

namespace http = boost::beast::http;

unsigned status(const std::vector<std::pair<std::string, std::string>>& fields, unsigned version) {
  Request header;
  header.version(version);
  for (const auto& [name, value] : fields) header.insert(name, value);
  const auto fault = framing_fault(header);
  return fault ? fault->status : 0;
}

TEST(Framing, OneLengthOrChunkedOrNeitherIsPlain) {
  EXPECT_EQ(status({}, 11), 0u);
  EXPECT_EQ(status({}, 10), 0u);
  EXPECT_EQ(status({{"Content-Length", "0"}}, 11), 0u);
  EXPECT_EQ(status({{"content-length", "123456"}}, 10), 0u);
  EXPECT_EQ(status({{"Transfer-Encoding", "chunked"}}, 11), 0u);
  EXPECT_EQ(status({{"transfer-encoding", "Chunked"}}, 11), 0u);
}

TEST(Framing, ACodingThatIsNotUnderstoodIs501) {
  for (const char* coding : {"xchunked", "chunkedx", "gzip", "gzip, chunked", "chunked, chunked",
                             "chunked;q=1", "identity", "", "\"chunked\"", "chunk ed"}) {
    EXPECT_EQ(status({{"Transfer-Encoding", coding}}, 11), 501u) << coding;
  }
  EXPECT_EQ(status({{"Transfer-Encoding", "chunked"}, {"Transfer-Encoding", "chunked"}}, 11), 501u);
}

TEST(Framing, WhatTwoReadersMayCutDifferentlyIs400) {
  EXPECT_EQ(status({{"Content-Length", "5"}, {"Transfer-Encoding", "chunked"}}, 11), 400u);
  EXPECT_EQ(status({{"Transfer-Encoding", "xchunked"}, {"Content-Length", "5"}}, 11), 400u);
  EXPECT_EQ(status({{"Content-Length", "5"}, {"Content-Length", "5"}}, 11), 400u);
  for (const char* length : {"5, 5", "+5", "-5", "0x5", "5 5", "", "5.0"}) {
    EXPECT_EQ(status({{"Content-Length", length}}, 11), 400u) << length;
  }
  EXPECT_EQ(status({{"Transfer-Encoding", "chunked"}}, 10), 400u);
}

}  // namespace
}  // namespace roverd::net
