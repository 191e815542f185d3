#include "link/replay.hpp"

#include <charconv>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "link/recording.hpp"
#include "tools.hpp"

namespace roverd::link {
namespace {

using namespace std::chrono_literals;
using namespace std::string_literals;

constexpr const char* kLog =
    "# a short drive\n"
    "(1700000000.000000) can0 211#01\n"
    "(1700000000.010000) can0 111#0096 T\n"
    "\n"
    "(1700000000.020000) can0 221#02 R\n"
    "(1700000003.020000) can0 241#03\n";

/// Plays to the end and keeps what was heard.
template <class Link>
struct Listener {
  explicit Listener(Link& link) {
    link.on_closed = [this](const std::string& reason) { closed = reason; };
  }
  std::string closed;
};

TEST(FrameFile, GivesFramesAtTheirRecordedTimes) {
  const TempFolder folder;
  std::vector<std::uint32_t> ids;
  FrameFile file(folder.write("a.log", kLog),
                 [&](const CanFrame& f, Time) { ids.push_back(f.id); });
  ASSERT_TRUE(file.open());
  std::vector<base::Duration> due;
  for (auto next = file.advance(); next && *next; next = file.advance()) {
    due.push_back(**next);
    file.emit(Time{});
  }
  // Sent frames are left out, for the listener was their sender; their time still passes.
  EXPECT_EQ(ids, (std::vector<std::uint32_t>{0x211, 0x221, 0x241}));
  EXPECT_EQ(due, (std::vector<base::Duration>{0ms, 20ms, 3020ms}));
}

TEST(FrameFile, StampsThatGoBackCostNoTime) {
  const TempFolder folder;
  FrameFile file(folder.write("a.log", "(5.0) can0 001#\n(4.0) can0 002#\n(4.5) can0 003#\n"),
                 [](const CanFrame&, Time) {});
  ASSERT_TRUE(file.open());
  EXPECT_EQ(**file.advance(), 0s);
  EXPECT_EQ(**file.advance(), 0s);
  EXPECT_EQ(**file.advance(), 500ms);
}

TEST(FrameReplay, PlaysAConsoleLogAsFastAsPossibleAndSaysThatItEnded) {
  const TempFolder folder;
  asio::io_context io;
  FrameReplay link(
      io,
      folder.write("c.txt", "  vcan0  241   [8]  A6 00 00 B0 00 00 00 7E\n  vcan0  211   [0] \n"),
      {.speed = 0});
  Listener listener(link);
  std::vector<CanFrame> heard;
  link.on_frame = [&](const CanFrame& f, Time) { heard.push_back(f); };
  EXPECT_EQ(link.send(make_frame(1, {})), SendResult::Closed);
  ASSERT_TRUE(link.open());
  EXPECT_TRUE(heard.empty());  // never from within open
  EXPECT_EQ(link.send(make_frame(1, {})), SendResult::Sent);
  ASSERT_TRUE(run_until(io, [&] { return !listener.closed.empty(); }));
  EXPECT_EQ(listener.closed, "end of file");
  ASSERT_EQ(heard.size(), 2u);
  EXPECT_EQ(heard[0], make_frame(0x241, {0xA6, 0, 0, 0xB0, 0, 0, 0, 0x7E}));
  EXPECT_EQ(link.send(make_frame(1, {})), SendResult::Closed);
  EXPECT_EQ(link.open().error().code, base::Code::Conflict);
}

TEST(FrameReplay, KeepsTheRecordedPaceTimesTheSpeed) {
  const TempFolder folder;
  asio::io_context io;
  FrameReplay link(io, folder.write("a.log", kLog), {.speed = 20});
  Listener listener(link);
  std::vector<Time> at;
  link.on_frame = [&](const CanFrame&, Time t) { at.push_back(t); };
  ASSERT_TRUE(link.open());
  ASSERT_TRUE(run_until(io, [&] { return !listener.closed.empty(); }));
  ASSERT_EQ(at.size(), 3u);
  // 3.02 s at 20 times the speed are 151 ms. Never early; late only by what the machine is busy.
  EXPECT_GE(base::seconds(at[2] - at[0]), 0.150);
  EXPECT_LT(base::seconds(at[2] - at[0]), 3.0);
}

/// Bytes of the same run as kLog, from two seconds later.
std::string bytes_of_the_run() {
  std::string text = recording_header("serial:/dev/gnss:115200");
  append_record(text, 1'700'000'002s, false, bytes_of("$A"));
  append_record(text, 1'700'000'004s, false, bytes_of("$B"));
  return text;
}

std::shared_ptr<ReplayTogether> run_of_the_log() {
  auto together = std::make_shared<ReplayTogether>();
  together->begin = 1'700'000'000s;
  return together;
}

TEST(Replays, OfOneRunKeepTheirDistance) {
  // Given a bus and a receiver of one run, of which the receiver began two seconds later,
  const TempFolder folder;
  asio::io_context io;
  const auto together = run_of_the_log();
  FrameReplay bus(io, folder.write("a.log", kLog), {.speed = 20, .together = together});
  ByteReplay receiver(io, folder.write("a.raw", bytes_of_the_run()),
                      {.speed = 20, .together = together});
  std::vector<Time> frames;
  std::vector<Time> chunks;
  bus.on_frame = [&](const CanFrame&, Time t) { frames.push_back(t); };
  receiver.on_bytes = [&](Bytes, Time t) { chunks.push_back(t); };
  // when they are opened in any order, twenty times as fast,
  ASSERT_TRUE(receiver.open());
  const Time begin = base::steady_now();
  ASSERT_TRUE(bus.open());
  ASSERT_TRUE(run_until(io, [&] { return frames.size() == 3 && chunks.size() == 2; }));
  // then what came two seconds later does so in a twentieth of that.
  EXPECT_GE(chunks[0] - begin, 90ms);
  EXPECT_GE(chunks[1] - begin, 190ms);
  EXPECT_GE(frames[2] - begin, 140ms);
  EXPECT_LE(frames[1], chunks[0]);
}

TEST(Replays, OneThatIsOpenedAgainGoesOnWhereTheRunIs) {
  // Given a run that has been played for 1.5 s, twice as fast as recorded,
  const TempFolder folder;
  asio::io_context io;
  const auto together = run_of_the_log();
  together->started = (base::steady_now() - 1'500ms).time_since_epoch().count();
  FrameReplay bus(io, folder.write("a.log", kLog), {.speed = 2, .together = together});
  std::vector<std::uint32_t> ids;
  bus.on_frame = [&](const CanFrame& f, Time) { ids.push_back(f.id); };
  // when the bus is opened,
  ASSERT_TRUE(bus.open());
  ASSERT_TRUE(run_until(io, [&] { return !ids.empty(); }));
  // then what is over is not told any more.
  EXPECT_EQ(ids, std::vector<std::uint32_t>{0x241});
}

TEST(FrameReplay, ADamagedLineIsNamed) {
  const TempFolder folder;
  asio::io_context io;
  const auto path = folder.write("a.log", "(1.0) can0 211#01\n\n(1.0) can0 211#0\n(2.0) can0 1#\n");
  FrameReplay link(io, path, {.speed = 0});
  Listener listener(link);
  ASSERT_TRUE(link.open());
  ASSERT_TRUE(run_until(io, [&] { return !listener.closed.empty(); }));
  EXPECT_EQ(listener.closed,
            "replay file " + path + " line 3: the data is not pairs of hex digits");
}

TEST(FrameReplay, ALineThatWasCutOffAtTheEndIsTheEnd) {
  const TempFolder folder;
  asio::io_context io;
  FrameReplay link(io, folder.write("a.log", "(1.0) can0 211#01\n(1.0) can0 21"), {.speed = 0});
  Listener listener(link);
  ASSERT_TRUE(link.open());
  ASSERT_TRUE(run_until(io, [&] { return !listener.closed.empty(); }));
  EXPECT_EQ(listener.closed, "end of file");
}

TEST(FrameReplay, AWrongFileIsNoticedWhenOpening) {
  const TempFolder folder;
  asio::io_context io;
  const auto problem = [&](const std::string& path) {
    return FrameReplay(io, path).open().error().detail;
  };
  EXPECT_EQ(problem("/no/such/file"), "replay file /no/such/file does not exist");
  EXPECT_EQ(problem("/tmp"), "replay file /tmp is a folder");
  const auto nmea = folder.write("n.log", "$GPGGA,1,2\n");
  EXPECT_EQ(problem(nmea), "replay file " + nmea + " line 1: the frame is missing");
  const auto empty = folder.write("e.log", "# nothing\n");
  EXPECT_EQ(problem(empty), "replay file " + empty + " holds no CAN frames");
  const auto binary = folder.write("b.log", std::string(10'000, 'x'));
  EXPECT_EQ(problem(binary), "replay file " + binary + " line 1: too long for a CAN frame");
}

TEST(FrameReplay, ALoopBeginsAgain) {
  const TempFolder folder;
  asio::io_context io;
  FrameReplay link(io, folder.write("a.log", kLog), {.speed = 0, .loop = true});
  Listener listener(link);
  int frames = 0;
  link.on_frame = [&](const CanFrame&, Time) {
    if (++frames == 10) link.close();
  };
  ASSERT_TRUE(link.open());
  ASSERT_TRUE(run_until(io, [&] { return frames >= 10; }));
  run_ready(io);
  EXPECT_EQ(frames, 10);  // and nothing after close
  EXPECT_EQ(listener.closed, "");
}

std::string recording() {
  std::string file = recording_header("tcp:host:1");
  append_record(file, 1'700'000'000s, false, bytes_of("$GNG"));
  append_record(file, 1'700'000'000s + 30ms, true, bytes_of("sent"));
  append_record(file, 1'700'000'000s + 50ms, false, bytes_of("GA\r\n"));
  return file;
}

std::vector<std::pair<std::string, base::Duration>> play(const std::string& path,
                                                         const ReplayOptions& options = {}) {
  std::vector<std::pair<std::string, base::Duration>> out;
  std::string chunk;
  ByteFile file(path, options, [&](Bytes b, Time) { chunk = text_of(b); });
  const auto opened = file.open();
  EXPECT_TRUE(opened) << opened.error().detail;
  for (auto next = file.advance(); next && *next; next = file.advance()) {
    file.emit(Time{});
    out.emplace_back(chunk, **next);
  }
  return out;
}

using Played = std::vector<std::pair<std::string, base::Duration>>;

TEST(ByteFile, ARecordingGivesItsReceivedChunksAtTheirTimes) {
  const TempFolder folder;
  const Played expected{{"$GNG", 0ms}, {"GA\r\n", 50ms}};
  EXPECT_EQ(play(folder.write("a.rec", recording())), expected);
  // and a file that was cut off gives all whole records
  const auto cut = recording().substr(0, recording().size() - 3);
  EXPECT_EQ(play(folder.write("b.rec", cut)), (Played{{"$GNG", 0ms}}));
}

TEST(ByteFile, ARecordingThatGoesOnInFurtherFilesIsFollowedByItsStamps) {
  const TempFolder folder;
  const auto part = [](int second, const std::string& text) {
    std::string out = recording_header("serial:x");
    append_record(out, std::chrono::seconds(1'700'000'000 + second), false, bytes_of(text));
    return out;
  };
  const auto path = folder.write("a.raw", part(0, "one"));
  folder.write("a.002.raw", part(7, "two"));
  folder.write("a.003.raw", part(8, "three").substr(0, 20));  // power was cut
  folder.write("a.005.raw", part(99, "of another"));
  EXPECT_EQ(play(path), (Played{{"one", 0s}, {"two", 7s}}));
  folder.write("a.002.raw", "something else");
  ByteFile file(path, {}, [](Bytes, Time) {});
  ASSERT_TRUE(file.open());
  ASSERT_TRUE(file.advance());
  EXPECT_EQ(file.advance().error().detail,
            "replay file " + folder.file("a.002.raw") + " is no recording");
}

TEST(FrameFile, ALogThatGoesOnInFurtherFilesIsFollowedAndBegunAnewByRewind) {
  const TempFolder folder;
  std::vector<std::uint32_t> ids;
  const auto path = folder.write("a.log", "(1700000000.0) can0 001#\n(1700000001.0) can0 002#\n");
  folder.write("a.002.log", "(1700000003.0) can0 003#\n");
  FrameFile file(path, [&](const CanFrame& f, Time) { ids.push_back(f.id); });
  ASSERT_TRUE(file.open());
  base::Duration last{};
  for (int round = 0; round < 2; ++round) {
    for (auto next = file.advance(); next && *next; next = file.advance()) {
      last = **next;
      file.emit(Time{});
    }
    EXPECT_EQ(last, 3s);
    ASSERT_TRUE(file.rewind());
  }
  EXPECT_EQ(ids, (std::vector<std::uint32_t>{1, 2, 3, 1, 2, 3}));
  folder.write("a.002.log", "(1700000003.0) can0 003#\nrubbish\n");
  auto next = file.advance();
  while (next && *next) next = file.advance();
  ASSERT_FALSE(next);
  EXPECT_TRUE(
      next.error().detail.starts_with("replay file " + folder.file("a.002.log") + " line 2"))
      << next.error().detail;
}

/// Messages are lines; "t=12.5" tells the time of day, "w=12.5" that of a week, and "b" and a
/// number announce so many bytes of anything, line feeds among them.
base::StreamClock lines_clock() {
  struct LinesState {
    std::string waiting;
    std::uint64_t at = 0;
  };
  return [s = std::make_shared<LinesState>()](Bytes bytes, const base::OnStreamMark& on) {
    s->waiting += text_of(bytes);
    for (;;) {
      auto end = s->waiting.find('\n');
      if (end == std::string::npos) break;
      base::StreamMark mark;
      if (s->waiting[0] == 'b') end += std::stoul(s->waiting.substr(1));
      if (end >= s->waiting.size()) break;
      using Clock = base::StreamTime::Clock;
      if (s->waiting.starts_with("t=")) {
        mark.time = {Clock::TimeOfDay, std::stod(s->waiting.substr(2)), 86'400.0};
      }
      if (s->waiting.starts_with("w=")) {
        mark.time = {Clock::TimeOfWeek, std::stod(s->waiting.substr(2)), 604'800.0};
      }
      mark.end = s->at += end;
      on(mark);
      s->waiting.erase(0, end + 1);
      ++s->at;
    }
    on({s->at, {}});
  };
}

TEST(ByteFile, APlainFileIsTimedByWhatItsMessagesSay) {
  const TempFolder folder;
  const auto path = folder.write("a.nmea",
                                 "# comment\nt=86399.5\r\nmore\nt=0.5\n"  // midnight
                                 "t=0.4\nt=500\nlast");
  const Played expected{{"# comment\n", 0s}, {"t=86399.5\r\n", 0s}, {"more\n", 0s}, {"t=0.5\n", 1s},
                        {"t=0.4\n", 1s},     {"t=500\n", 11s},      {"last", 11s}};
  EXPECT_EQ(play(path, {.longest_gap_s = 10, .make_clock = lines_clock}), expected);
}

TEST(ByteFile, AMessageIsNeverCutWhateverItsBytes) {
  const TempFolder folder;
  const std::string binary = "b12\n\n\nt=77\r\n\n\x00\n\n"s;
  const auto path = folder.write("a", "t=5\n" + binary + "\nt=6\n" + binary + "\n");
  const Played expected{{"t=5\n", 0s}, {binary + "\n", 0s}, {"t=6\n", 1s}, {binary + "\n", 1s}};
  EXPECT_EQ(play(path, {.make_clock = lines_clock}), expected);
}

TEST(ByteFile, ClocksOfOtherOriginsGoOnSideBySide) {
  const TempFolder folder;
  // The week's clock is seen second, ends, and the day's goes on; one of them is 10 ms early.
  const auto path = folder.write("a", "t=5\nw=400000\nt=6\nw=400001\nw=400001.99\nt=7\nt=8\n");
  const Played expected{{"t=5\n", 0s},      {"w=400000\n", 0s},        {"t=6\n", 1s},
                        {"w=400001\n", 1s}, {"w=400001.99\n", 1990ms}, {"t=7\n", 2s},
                        {"t=8\n", 3s}};
  const auto played = play(path, {.make_clock = lines_clock});
  ASSERT_EQ(played.size(), expected.size());
  for (std::size_t i = 0; i < played.size(); ++i) {
    EXPECT_EQ(played[i].first, expected[i].first);
    EXPECT_NEAR(base::seconds(played[i].second), base::seconds(expected[i].second), 1e-6) << i;
  }
}

TEST(ByteFile, AClockThatIsSetAnewCostsNoTime) {
  const TempFolder folder;
  // Two seconds after its start the receiver finds out what time it is; later it restarts.
  const auto path = folder.write("a", "w=1\nw=2\nw=300000\nw=300001\nw=3\nw=4\n");
  const Played expected{{"w=1\n", 0s},      {"w=2\n", 1s}, {"w=300000\n", 1s},
                        {"w=300001\n", 2s}, {"w=3\n", 2s}, {"w=4\n", 3s}};
  EXPECT_EQ(play(path, {.make_clock = lines_clock}), expected);
}

TEST(ByteFile, APlainFileWithoutTimesIsPlayedAtTheFallbackRate) {
  const TempFolder folder;
  const auto path = folder.write("a.bin", "0123456789\n" + std::string(300, 'x'));
  const auto cut = play(path, {.make_clock = lines_clock, .fallback_bytes_per_s = 100});
  ASSERT_EQ(cut.size(), 2u);
  EXPECT_EQ(cut[0].second, 110ms);
  EXPECT_NEAR(base::seconds(cut[1].second), 3.11, 1e-6);
  const auto uncut = play(path, {.fallback_bytes_per_s = 100});
  ASSERT_EQ(uncut.size(), 2u);
  EXPECT_EQ(uncut[0].first.size(), 256u);
  EXPECT_NEAR(base::seconds(uncut[1].second), 3.11, 1e-6);
}

TEST(ByteFile, EveryByteOfAPlainFileArrives) {
  // given more than one read of messages, long and short, with binary between
  const TempFolder folder;
  std::string content;
  for (int i = 0; content.size() < 400'000; ++i) {
    const auto size = static_cast<std::size_t>(i % 7000);
    content += "t=" + std::to_string(i) + "\n" + std::string(size, '\x01') + "\n";
    content +=
        "b" + std::to_string(size) + "\n" + std::string(size, i % 2 == 0 ? '\n' : '\r') + "\n";
  }
  content += "t=1";
  const auto path = folder.write("a", content);
  for (const bool clocked : {true, false}) {
    ReplayOptions how;
    if (clocked) how.make_clock = lines_clock;
    std::string heard;
    for (const auto& [chunk, at] : play(path, how)) heard += chunk;
    EXPECT_EQ(heard, content) << clocked;
  }
}

TEST(ByteReplay, PlaysAndEnds) {
  const TempFolder folder;
  asio::io_context io;
  ByteReplay link(io, folder.write("a.rec", recording()), {.speed = 0});
  Listener listener(link);
  std::string heard;
  link.on_bytes = [&](Bytes b, Time) { heard += text_of(b); };
  ASSERT_TRUE(link.open());
  EXPECT_EQ(link.write(bytes_of("x")), SendResult::Sent);
  ASSERT_TRUE(run_until(io, [&] { return !listener.closed.empty(); }));
  EXPECT_EQ(heard, "$GNGGA\r\n");
  EXPECT_EQ(listener.closed, "end of file");
}

TEST(ByteReplay, DamageIsNamedByItsByte) {
  const TempFolder folder;
  asio::io_context io;
  const auto path = folder.write("a.rec", recording() + "rubbish\n");
  ByteReplay link(io, path, {.speed = 0});
  Listener listener(link);
  ASSERT_TRUE(link.open());
  ASSERT_TRUE(run_until(io, [&] { return !listener.closed.empty(); }));
  EXPECT_EQ(listener.closed, "replay file " + path + " byte " + std::to_string(recording().size()) +
                                 ": not a record line");
  const auto newer = folder.write("b.rec", "roverd-bytes 9 x\n");
  EXPECT_EQ(ByteReplay(io, newer).open().error().detail,
            "replay file " + newer + " line 1: version 9 is not known here");
  const auto empty = folder.write("c.rec", "");
  EXPECT_EQ(ByteReplay(io, empty).open().error().detail, "replay file " + empty + " is empty");
}

TEST(ByteReplay, AReceiverMayCloseItsLinkInTheCallback) {
  const TempFolder folder;
  asio::io_context io;
  ByteReplay link(io, folder.write("a.rec", recording()), {.speed = 0});
  int calls = 0;
  link.on_bytes = [&](Bytes, Time) {
    ++calls;
    link.close();
  };
  ASSERT_TRUE(link.open());
  ASSERT_TRUE(run_until(io, [&] { return calls > 0; }));
  run_ready(io);
  EXPECT_EQ(calls, 1);
  ASSERT_TRUE(link.open());  // closed, not ended: it plays from the start
  ASSERT_TRUE(run_until(io, [&] { return calls > 1; }));
}

}  // namespace
}  // namespace roverd::link
