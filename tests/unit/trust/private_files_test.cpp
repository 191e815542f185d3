#include "trust/private_files.hpp"

#include <csignal>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include "folder.hpp"

namespace roverd::trust {
namespace {

using base::Code;
using test::content;
using test::Folder;
using test::mode_of;
using test::put;

TEST(PrivateFiles, WhatIsWrittenIsReadAndNobodyElseMay) {
  const Folder folder;
  ::umask(0);  // whatever the caller's

  ASSERT_TRUE(write_private(folder.path / "key", "secret"));

  EXPECT_EQ(mode_of(folder.path / "key"), 0600U);
  EXPECT_EQ(read_private(folder.path / "key").value(), "secret");
  EXPECT_FALSE(std::filesystem::exists(folder.path / "key.new"));
  ::umask(022);
}

TEST(PrivateFiles, AnOlderFileIsReplacedAndAHalfWrittenOneForgotten) {
  const Folder folder;
  put(folder.path / "key", "old", 0644);
  put(folder.path / "key.new", "half", 0666);

  ASSERT_TRUE(write_private(folder.path / "key", "new"));

  EXPECT_EQ(content(folder.path / "key"), "new");
  EXPECT_EQ(mode_of(folder.path / "key"), 0600U);
}

TEST(PrivateFiles, NoFileIsNoError) {
  const Folder folder;
  const auto read = read_private(folder.path / "none");
  ASSERT_TRUE(read);
  EXPECT_EQ(*read, std::nullopt);
  EXPECT_EQ(read_public(folder.path / "none").error().code, Code::NotFound);
}

TEST(PrivateFiles, AFileThatOthersCanReadOrChangeIsRefused) {
  const Folder folder;
  for (const mode_t mode : {0640U, 0604U, 0620U, 0601U}) {
    put(folder.path / "key", "secret", mode);
    const auto read = read_private(folder.path / "key");
    ASSERT_FALSE(read) << mode;
    EXPECT_EQ(read.error().code, Code::Invalid);
    EXPECT_NE(read.error().detail.find("can be read or changed by others"), std::string::npos);
  }
}

TEST(PrivateFiles, LinksFoldersPipesAndHugeFilesAreRefused) {
  const Folder folder;
  put(folder.path / "target", "secret");
  std::filesystem::create_symlink(folder.path / "target", folder.path / "link");
  std::filesystem::create_directory(folder.path / "folder");
  ASSERT_EQ(::mkfifo((folder.path / "pipe").c_str(), 0600), 0);
  put(folder.path / "huge", std::string(kLargestFile + 1, 'x'));
  for (const char* name : {"link", "folder", "pipe", "huge"}) {
    EXPECT_EQ(read_private(folder.path / name).error().code, Code::Invalid) << name;
  }
}

TEST(PrivateFiles, AFolderIsMadeForUsAloneAndAnOpenOneRefused) {
  const Folder folder;
  ASSERT_TRUE(private_folder(folder.path / "tls"));
  EXPECT_EQ(mode_of(folder.path / "tls"), 0700U);
  EXPECT_TRUE(private_folder(folder.path / "tls"));

  ::chmod((folder.path / "tls").c_str(), 0755);
  EXPECT_EQ(private_folder(folder.path / "tls").error().code, Code::Invalid);
  put(folder.path / "file", "");
  EXPECT_EQ(private_folder(folder.path / "file").error().code, Code::Invalid);
  EXPECT_EQ(private_folder(folder.path / "no" / "where").error().code, Code::Unavailable);
}

// A limit on the size of files stands in for a full disk.
TEST(PrivateFiles, OnAFullDiskTheOldFileStays) {
  const Folder folder;
  put(folder.path / "key", "old");
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  rlimit small = before;
  small.rlim_cur = 2;
  ::setrlimit(RLIMIT_FSIZE, &small);
  const auto written = write_private(folder.path / "key", "new and longer");
  ::setrlimit(RLIMIT_FSIZE, &before);

  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, Code::Unavailable);
  EXPECT_EQ(content(folder.path / "key"), "old");
  EXPECT_FALSE(std::filesystem::exists(folder.path / "key.new"));
}

TEST(PrivateFiles, InAFolderWithoutRightToWriteTheSystemsReasonIsTold) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const Folder folder;
  ::chmod(folder.path.c_str(), 0500);
  const auto written = write_private(folder.path / "key", "x");
  ::chmod(folder.path.c_str(), 0700);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, Code::Unavailable);
}

TEST(PrivateFiles, WhereNoFileCanLieTheSystemsReasonIsTold) {
  const auto written = write_private("/proc/key", "x");  // a folder in which root writes nothing
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, Code::Unavailable);
}

TEST(PrivateFiles, DamagedOnesAreSetAsideSideBySide) {
  const Folder folder;
  put(folder.path / "key", "one");
  EXPECT_EQ(set_aside(folder.path / "key").value(), folder.path / "key.damaged-1");
  put(folder.path / "key", "two");
  EXPECT_EQ(set_aside(folder.path / "key").value(), folder.path / "key.damaged-2");
  EXPECT_EQ(content(folder.path / "key.damaged-1"), "one");
  EXPECT_FALSE(set_aside(folder.path / "key"));
}

}  // namespace
}  // namespace roverd::trust
