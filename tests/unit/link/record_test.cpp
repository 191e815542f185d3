#include "link/record.hpp"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <thread>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "link/candump.hpp"
#include "link/memory.hpp"
#include "link/recording.hpp"
#include "tools.hpp"

namespace roverd::link {
namespace {

using namespace std::chrono_literals;

/// Tests run where they run: a nearly full disk is no reason to fail, except where it is the
/// matter.
RecordOptions options() {
  RecordOptions out;
  out.keep_free_bytes = 0;
  out.write_every = 1ms;
  return out;
}

std::vector<CanRecord> read_log(const std::string& path) {
  std::vector<CanRecord> out;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const auto record = parse_candump_line(line);
    EXPECT_TRUE(record && *record) << line;
    if (record && *record) out.push_back(**record);
  }
  return out;
}

class RecordedFrames : public testing::Test {
 protected:
  void start(const RecordOptions& with = options()) {
    auto made = RecordedFrameLink::create(std::move(wire.a), path, with);
    ASSERT_TRUE(made) << made.error().detail;
    link = std::move(*made);
    ASSERT_TRUE(link->open());
    ASSERT_TRUE(wire.b->open());
    wire.b->set_immediate([this] { return now; });
  }
  TempFolder folder;
  std::string path = folder.file("drive.log");
  MemoryFramePair wire = memory_frame_pair();
  std::unique_ptr<RecordedFrameLink> link;
  Time now = base::steady_now();
};

TEST_F(RecordedFrames, BothDirectionsPassAndAreWritten) {
  start();
  std::vector<CanFrame> heard;
  link->on_frame = [&](const CanFrame& f, Time) { heard.push_back(f); };
  const auto in = make_frame(0x221, {1, 2});
  const auto out = make_frame(0x111, {3});
  const auto before = base::wall_now();
  wire.b->send(in);
  EXPECT_EQ(link->send(out), SendResult::Sent);
  EXPECT_EQ(heard, std::vector<CanFrame>{in});
  EXPECT_EQ(wire.b->waiting(), 1u);
  link.reset();  // writes what is left
  const auto log = read_log(path);
  ASSERT_EQ(log.size(), 2u);
  EXPECT_EQ(log[0].frame, in);
  EXPECT_FALSE(log[0].sent);
  EXPECT_EQ(log[0].bus, "can0");
  EXPECT_EQ(log[1].frame, out);
  EXPECT_TRUE(log[1].sent);
  EXPECT_LT(std::chrono::abs(*log[0].stamp - before.time_since_epoch()), 10s);
}

TEST_F(RecordedFrames, TheTimesBetweenFramesAreKept) {
  start();
  wire.b->send(make_frame(1, {}));
  now += 20ms;
  wire.b->send(make_frame(2, {}));
  link.reset();
  const auto log = read_log(path);
  ASSERT_EQ(log.size(), 2u);
  const auto apart = *log[1].stamp - *log[0].stamp;
  EXPECT_NEAR(base::seconds(apart), 0.020, 2e-6);  // cut to microseconds
}

TEST_F(RecordedFrames, WhatTheLinkDidNotTakeIsNotRecorded) {
  start();
  link->close();
  EXPECT_EQ(link->send(make_frame(1, {})), SendResult::Closed);
  link.reset();
  EXPECT_EQ(read_file(path), "");
}

TEST_F(RecordedFrames, ALostLinkIsPassedOn) {
  start();
  std::string why;
  link->on_closed = [&](const std::string& reason) { why = reason; };
  EXPECT_EQ(link->describe(), "memory");
  wire.b->fail("gone");  // the far end says so to its own listener only
  EXPECT_EQ(link->send(make_frame(1, {})), SendResult::Closed);
}

TEST_F(RecordedFrames, TwoThreadsRecordWithoutALoss) {
  RecordOptions with = options();
  start(with);
  wire.b->close();
  ASSERT_TRUE(wire.b->open());
  // The memory wire belongs to one thread, so the two threads use one direction each and in turn:
  // only the recorder sees both.
  std::atomic<int> turn{0};
  std::thread control([&] {
    for (int i = 0; i < 500; ++i) {
      while (turn.load() != 1) std::this_thread::yield();
      link->send(make_frame(0x111, {1}));
      turn = 0;
    }
  });
  for (int i = 0; i < 500; ++i) {
    while (turn.load() != 0) std::this_thread::yield();
    wire.b->send(make_frame(0x221, {2}));
    turn = 1;
  }
  control.join();
  link.reset();
  EXPECT_EQ(read_log(path).size(), 1000u);
}

TEST_F(RecordedFrames, AnExistingFileIsNeverTouched) {
  folder.write("drive.log", "precious");
  const auto made = RecordedFrameLink::create(std::move(wire.a), path, options());
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().detail, "cannot make the recording " + path + ": File exists");
  EXPECT_EQ(read_file(path), "precious");
}

TEST_F(RecordedFrames, ABusNameThatWouldBreakTheLogIsRefused) {
  RecordOptions with = options();
  with.bus = "can 0";
  EXPECT_FALSE(RecordedFrameLink::create(std::move(wire.a), path, with));
}

/// Waits for the writer thread; the deadline only ends a failing test.
std::string wait_for_problem(const RecordedFrameLink& link) {
  const auto end = std::chrono::steady_clock::now() + 20s;
  while (link.status().problem.empty() && std::chrono::steady_clock::now() < end) {
    std::this_thread::yield();
  }
  return link.status().problem;
}

TEST_F(RecordedFrames, AFullDiskStopsTheRecordingAndNotTheLink) {
  // given a disk with room for 100 bytes (the kernel's limit on file size stands in for it)
  ::signal(SIGXFSZ, SIG_IGN);
  rlimit old{};
  ::getrlimit(RLIMIT_FSIZE, &old);
  const rlimit small{100, old.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &small);
  RecordOptions with = options();
  std::atomic<int> told{0};
  with.on_problem = [&](const std::string&) { ++told; };
  start(with);
  // when more comes
  for (int i = 0; i < 10; ++i) link->send(make_frame(0x111, {1, 2, 3}));
  const std::string problem = wait_for_problem(*link);
  ::setrlimit(RLIMIT_FSIZE, &old);
  // then recording says why it stopped, once, and the link goes on
  EXPECT_EQ(problem, "recording to " + path + " stopped: File too large");
  EXPECT_EQ(link->send(make_frame(0x111, {4})), SendResult::Sent);
  const auto end = std::chrono::steady_clock::now() + 20s;
  while (link->status().dropped == 0 && std::chrono::steady_clock::now() < end) {
    std::this_thread::yield();
  }
  EXPECT_GT(link->status().dropped, 0u);
  link.reset();
  EXPECT_EQ(told, 1);
}

TEST_F(RecordedFrames, ALimitOnTheFileStopsTheRecording) {
  RecordOptions with = options();
  with.max_bytes = 60;
  with.keep_files = 1;
  start(with);
  for (int i = 0; i < 10; ++i) link->send(make_frame(0x111, {1, 2, 3}));
  EXPECT_NE(wait_for_problem(*link).find("the file has reached"), std::string::npos);
}

TEST_F(RecordedFrames, AFullFileIsFollowedByTheNextAndTheOldestGoes) {
  RecordOptions with = options();
  with.max_bytes = 200;  // five lines of 40 letters
  with.keep_files = 3;
  start(with);
  for (std::uint8_t i = 0; i < 40; ++i) {  // one line at a time
    const auto before = link->status().sent;
    link->send(make_frame(0x111, {i}));
    const auto end = std::chrono::steady_clock::now() + 20s;
    while (link->status().sent == before && std::chrono::steady_clock::now() < end) {
      std::this_thread::yield();
    }
  }
  link.reset();
  // then the last files stand there, whole lines each, without a gap between them
  EXPECT_FALSE(std::filesystem::exists(path));
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder.file("."))) {
    files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  ASSERT_EQ(files.size(), 3u);
  std::vector<CanRecord> all;
  for (const auto& file : files) {
    const std::string text = read_file(file);
    EXPECT_LE(text.size(), 200u);
    EXPECT_EQ(text.front(), '(');
    EXPECT_EQ(text.back(), '\n');
    for (const auto& record : read_log(file)) all.push_back(record);
  }
  ASSERT_GE(all.size(), 10u);
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i].frame.data[0], 40 - all.size() + i);
  }
}

TEST(RecordFiles, AreNumberedBeforeTheirEnding) {
  EXPECT_EQ(numbered_file("a.b/drive.log", 2), "a.b/drive.002.log");
  EXPECT_EQ(numbered_file("a.b/drive", 12), "a.b/drive.012");
  EXPECT_EQ(numbered_file("drive.log", 1000), "drive.1000.log");
}

TEST(RecordFiles, EachBeginsWithTheHeader) {
  const TempFolder folder;
  RecordOptions with = options();
  with.max_bytes = 10;
  auto file = RecordFile::create(folder.file("a.raw"), with, "head\n");
  ASSERT_TRUE(file);
  for (const char* text : {"one\n", "two, which is longer than a file\n", "six\n"}) {
    ASSERT_TRUE((*file)->write(text));
  }
  EXPECT_EQ(read_file(folder.file("a.raw")), "head\none\n");
  EXPECT_EQ(read_file(folder.file("a.002.raw")), "head\ntwo, which is longer than a file\n");
  EXPECT_EQ(read_file(folder.file("a.003.raw")), "head\nsix\n");
}

TEST_F(RecordedFrames, ADiskThatIsNearlyFullIsLeftToOthers) {
  RecordOptions with = options();
  with.keep_free_bytes = UINT64_MAX;
  with.sync_every = 1ms;
  start(with);
  EXPECT_NE(wait_for_problem(*link).find("are left on the disk"), std::string::npos);
}

TEST_F(RecordedFrames, CountsWhatIsInTheFile) {
  start();
  link->send(make_frame(1, {}));
  wire.b->send(make_frame(2, {}));
  const auto end = std::chrono::steady_clock::now() + 20s;
  RecordStatus status;
  do {
    status = link->status();
    std::this_thread::yield();
  } while (status.sent + status.received < 2 && std::chrono::steady_clock::now() < end);
  EXPECT_EQ(status.sent, 1u);
  EXPECT_EQ(status.received, 1u);
  EXPECT_EQ(status.bytes, read_file(path).size());
  EXPECT_EQ(status.dropped, 0u);
}

TEST(RecordedBytes, BothDirectionsPassAndAreWritten) {
  const TempFolder folder;
  auto wire = memory_byte_pair();
  MemoryByteLink* const inner = wire.a.get();
  auto made = RecordedByteLink::create(std::move(wire.a), folder.file("gnss.rec"), options());
  ASSERT_TRUE(made) << made.error().detail;
  auto link = std::move(*made);
  ASSERT_TRUE(link->open());
  ASSERT_TRUE(wire.b->open());
  std::string heard;
  link->on_bytes = [&](Bytes b, Time) { heard += text_of(b); };
  wire.b->set_immediate([] { return base::steady_now(); });
  wire.b->write(bytes_of("$GNGGA\r\n"));
  EXPECT_EQ(link->write(bytes_of("rtcm")), SendResult::Sent);
  EXPECT_EQ(heard, "$GNGGA\r\n");
  link->on_peer = [&] { heard = "another"; };
  inner->on_peer();
  EXPECT_EQ(heard, "another");
  link.reset();

  const std::string file = read_file(folder.file("gnss.rec"));
  const auto header = read_recording_header(bytes_of(file));
  ASSERT_EQ(header.state, RecordingStep::State::Ok);
  EXPECT_EQ(file.substr(0, header.used), "roverd-bytes 1 memory\n");
  const auto first = next_record(bytes_of(file).subspan(header.used));
  EXPECT_EQ(text_of(first.record.bytes), "$GNGGA\r\n");
  EXPECT_FALSE(first.record.sent);
  const auto second = next_record(bytes_of(file).subspan(header.used + first.used));
  EXPECT_EQ(text_of(second.record.bytes), "rtcm");
  EXPECT_TRUE(second.record.sent);
}

TEST(Ring, KeepsOrderAndRefusesWhenFull) {
  Ring<int> ring(3);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(ring.put(i));
  EXPECT_FALSE(ring.put(3));
  std::vector<int> out;
  ring.take(out);
  EXPECT_EQ(out, (std::vector<int>{0, 1, 2}));
  EXPECT_TRUE(ring.put(4));
}

TEST(Ring, LosesNothingBetweenTwoThreads) {
  Ring<int> ring(512);
  std::thread producer([&] {
    for (int i = 0; i < 20'000;) {
      if (ring.put(i)) {
        ++i;
      } else {
        std::this_thread::yield();
      }
    }
  });
  std::vector<int> out;
  while (out.size() < 20'000) {
    ring.take(out);
    std::this_thread::yield();
  }
  producer.join();
  for (int i = 0; i < 20'000; ++i) ASSERT_EQ(out[static_cast<std::size_t>(i)], i);
}

}  // namespace
}  // namespace roverd::link
