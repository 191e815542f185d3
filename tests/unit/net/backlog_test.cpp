#include "net/backlog.hpp"

#include <gtest/gtest.h>

namespace roverd::net {
namespace {

std::string text(const Frame& frame) {
  return frame ? frame->substr(2) : "nothing";
}

TEST(Backlog, ASlotKeepsOnlyTheNewest) {
  // Given a client that takes nothing,
  Backlog backlog;
  EXPECT_TRUE(backlog.offer(1, text_frame("old")));
  EXPECT_TRUE(backlog.offer(2, text_frame("other topic")));
  // when a newer state comes,
  EXPECT_FALSE(backlog.offer(1, text_frame("new")));
  // then it stands in the older one's place, and the loss is counted.
  EXPECT_EQ(backlog.dropped(), 1u);
  EXPECT_EQ(text(backlog.next()), "new");
  EXPECT_EQ(text(backlog.next()), "other topic");
  EXPECT_EQ(backlog.next(), nullptr);
}

TEST(Backlog, TheQueueKeepsOrderAndGoesFirst) {
  Backlog backlog;
  backlog.offer(1, text_frame("state"));
  backlog.push(text_frame("first"));
  backlog.push(text_frame("second"));
  EXPECT_EQ(text(backlog.next()), "first");
  EXPECT_EQ(text(backlog.next()), "second");
  EXPECT_EQ(text(backlog.next()), "state");
  EXPECT_TRUE(backlog.empty());
}

TEST(Backlog, AFullQueueDropsTheOldest) {
  Backlog backlog;
  for (std::size_t i = 0; i < Backlog::kQueue + 3; ++i) {
    EXPECT_EQ(backlog.push(text_frame(std::to_string(i))), i < Backlog::kQueue);
  }
  EXPECT_EQ(backlog.dropped(), 3u);
  EXPECT_EQ(text(backlog.next()), "3");
}

}  // namespace
}  // namespace roverd::net
