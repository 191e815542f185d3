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

/// Lines "t=12.5" carry a time.
std::optional<double> clock_of(Bytes line) {
  const std::string text = text_of(line);
  if (text.rfind("t=", 0) != 0) return {};
  double value = 0;
  std::from_chars(text.data() + 2, text.data() + text.size(), value);
  return value;
}

TEST(ByteFile, APlainFileIsTimedByWhatItsLinesSay) {
  const TempFolder folder;
  const auto path = folder.write("a.nmea",
                                 "# comment\nt=86399.5\r\nmore\nt=0.5\n"  // midnight
                                 "t=0.4\nt=500\nlast");
  const Played expected{{"# comment\n", 0s}, {"t=86399.5\r\n", 0s}, {"more\n", 0s}, {"t=0.5\n", 1s},
                        {"t=0.4\n", 1s},     {"t=500\n", 11s},      {"last", 11s}};
  EXPECT_EQ(play(path, {.longest_gap_s = 10, .line_clock = clock_of}), expected);
}

TEST(ByteFile, APlainFileWithoutTimesIsPlayedAtTheFallbackRate) {
  const TempFolder folder;
  const auto path = folder.write("a.bin", "0123456789\n" + std::string(300, 'x'));
  const auto played = play(path, {.line_clock = clock_of, .fallback_bytes_per_s = 100});
  ASSERT_EQ(played.size(), 3u);
  EXPECT_EQ(played[0].second, 110ms);
  EXPECT_EQ(played[1].first.size(), 256u);
  EXPECT_NEAR(base::seconds(played[2].second), 3.11, 1e-6);
}

TEST(ByteFile, EveryByteOfAPlainFileArrives) {
  // given more than one read of lines, long and short, with binary between
  const TempFolder folder;
  std::string content;
  for (int i = 0; content.size() < 200'000; ++i) {
    content +=
        "t=" + std::to_string(i) + "\n" + std::string(static_cast<std::size_t>(i % 7000), '\x01');
  }
  std::string heard;
  for (const auto& [chunk, at] : play(folder.write("a", content), {.line_clock = clock_of})) {
    heard += chunk;
  }
  EXPECT_EQ(heard, content);
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
