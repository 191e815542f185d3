// A data folder that goes away under the running program: nothing is said to be saved that is not.

#include <fstream>
#include <thread>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "folder.hpp"

namespace roverd::store {
namespace {

namespace fs = std::filesystem;

/// What is told of the disk, once it was looked at after `since`.
StorageState looked_after(const Store& store, base::Time since) {
  for (int i = 0; i < 1000; ++i) {
    StorageState state = store.storage();
    if (state.looked > since) return state;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return {};
}

TEST(Gone, AChangeAfterTheFolderWasRemovedIsRefusedAndTold) {
  // Given a store with one mission in a folder,
  Folder folder;
  const auto inner = folder.path() / "data";
  fs::create_directory(inner);
  const auto store = open_store(inner / "roverd.db");
  const auto before = create(*store, plan_named("before"));
  ASSERT_TRUE(before);
  EXPECT_EQ(looked_after(*store, {}).trouble, "");
  // when the folder is removed,
  fs::remove_all(inner);
  // then nothing is kept any more, and the refusal names the folder.
  for (const auto& refused : {create(*store, plan_named("after")),
                              replace(*store, before->id, 1, plan_named("changed"))}) {
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, base::Code::Unavailable);
    EXPECT_NE(refused.error().detail.find("the data folder " + inner.string() + " was removed"),
              std::string::npos)
        << refused.error().detail;
  }
  const std::string trouble = store->storage().trouble;
  EXPECT_NE(trouble.find("was removed"), std::string::npos) << trouble;
  // It is seen without anybody asking, too.
  EXPECT_NE(looked_after(*store, base::steady_now()).trouble.find("was removed"),
            std::string::npos);
}

TEST(Gone, AnotherFileInItsPlaceIsNotTakenForIt) {
  Folder folder;
  const auto store = open_store(folder.file());
  fs::rename(folder.file(), folder.file("kept.db"));
  std::ofstream(folder.file()) << "something else";
  const auto refused = create(*store, plan_named("after"));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().detail.find("was replaced by another file"), std::string::npos);
}

TEST(Gone, WhatComesBackIsUsedAgain) {
  // Given a folder that was moved away, and a change that was refused,
  Folder folder;
  const auto inner = folder.path() / "data";
  fs::create_directory(inner);
  const auto store = open_store(inner / "roverd.db");
  fs::rename(inner, folder.path() / "elsewhere");
  ASSERT_FALSE(create(*store, plan_named("lost")));
  // when it is back,
  fs::rename(folder.path() / "elsewhere", inner);
  // then the next look finds all well, and what is saved is there.
  EXPECT_EQ(looked_after(*store, base::steady_now()).trouble, "");
  const auto saved = create(*store, plan_named("saved"));
  ASSERT_TRUE(saved);
  EXPECT_EQ(read(*store, saved->id)->plan.name, "saved");
}

TEST(Gone, AFullDiskIsTroubleUntilAChangeIsKeptAgain) {
  // Given a store that may grow to 1 MB,
  Folder folder;
  Options options;
  options.max_bytes = 1'000'000;
  const auto store = open_store(folder.file(), std::move(options));
  const auto small = create(*store, plan_named("small"));
  ASSERT_TRUE(small);
  // when a mission does not fit,
  ASSERT_FALSE(create(*store, noisy_plan("large", 100'000)));
  // then that is told,
  EXPECT_NE(store->storage().trouble.find("full"), std::string::npos) << store->storage().trouble;
  // until something fits.
  ASSERT_TRUE(replace(*store, small->id, 1, plan_named("still small")));
  EXPECT_EQ(store->storage().trouble, "");
}

TEST(Gone, TheFreeSpaceOfTheDiskIsTold) {
  Folder folder;
  const auto store = open_store(folder.file());
  const auto free_bytes = looked_after(*store, {}).free_bytes;
  ASSERT_TRUE(free_bytes);
  EXPECT_NEAR(static_cast<double>(*free_bytes),
              static_cast<double>(fs::space(folder.path()).available), 1e9);
}

}  // namespace
}  // namespace roverd::store
