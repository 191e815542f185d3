#include "link/recording.hpp"

#include <gtest/gtest.h>

#include "tools.hpp"

namespace roverd::link {
namespace {

using namespace std::chrono_literals;
using State = RecordingStep::State;

const base::Duration kStamp = 1'700'000'000s + 123'456us;

TEST(Recording, IsReadableText) {
  std::string file = recording_header("serial:/dev/ttyACM0:115200");
  append_record(file, kStamp, false, bytes_of("$GNGGA,\r\n"));
  append_record(file, kStamp + 1s, true, bytes_of("log"));
  EXPECT_EQ(file,
            "roverd-bytes 1 serial:/dev/ttyACM0:115200\n"
            "(1700000000.123456) R 9\n$GNGGA,\r\n\n"
            "(1700000001.123456) T 3\nlog\n");
}

TEST(Recording, EveryByteComesBackWithItsStampAndDirection) {
  std::string binary;
  for (int i = 0; i < 256; ++i) binary += static_cast<char>(i);
  std::string file;
  append_record(file, kStamp, false, bytes_of(binary));
  append_record(file, kStamp + 200ms, true, bytes_of("(1.000000) R 3\nabc\n"));
  append_record(file, kStamp, false, {});  // nothing arrived: nothing is written

  const auto first = next_record(bytes_of(file));
  ASSERT_EQ(first.state, State::Ok) << first.problem;
  EXPECT_EQ(text_of(first.record.bytes), binary);
  EXPECT_EQ(first.record.stamp, kStamp);
  EXPECT_FALSE(first.record.sent);
  const auto second = next_record(bytes_of(file).subspan(first.used));
  ASSERT_EQ(second.state, State::Ok) << second.problem;
  EXPECT_EQ(text_of(second.record.bytes), "(1.000000) R 3\nabc\n");
  EXPECT_TRUE(second.record.sent);
  EXPECT_EQ(first.used + second.used, file.size());
}

TEST(Recording, AnyCutOffEndOnlyNeedsMore) {
  std::string file;
  append_record(file, kStamp, false, bytes_of("$GPHDT,12.5,T*00\r\n"));
  for (std::size_t n = 0; n < file.size(); ++n) {
    EXPECT_EQ(next_record(bytes_of(file).first(n)).state, State::NeedMore) << n;
  }
  const std::string header = recording_header("tcp:host:1");
  for (std::size_t n = 0; n < header.size(); ++n) {
    EXPECT_EQ(read_recording_header(bytes_of(header).first(n)).state, State::NeedMore) << n;
  }
  EXPECT_EQ(read_recording_header(bytes_of(header)).used, header.size());
}

TEST(Recording, ALargeChunkBecomesSeveralRecords) {
  const std::string chunk(kLargestRecord + 1, 'x');
  std::string file;
  append_record(file, kStamp, false, bytes_of(chunk));
  const auto first = next_record(bytes_of(file));
  ASSERT_EQ(first.state, State::Ok);
  EXPECT_EQ(first.record.bytes.size(), kLargestRecord);
  EXPECT_EQ(next_record(bytes_of(file).subspan(first.used)).record.bytes.size(), 1u);
}

TEST(Recording, DamageIsNoticed) {
  for (const char* text :
       {"(1.000000) R 3\nabcX", "(1.000000) X 3\nabc\n", "(1.00) R 3\nabc\n", "1.000000 R 3\nabc\n",
        "(1.000000) R 0\n\n", "(1.000000) R 65537\n", "(1.000000) R -1\n", "(1.000000) R 3 \nabc\n",
        "\n", "a line without an end that goes on and on and on"}) {
    EXPECT_EQ(next_record(bytes_of(text)).state, State::Bad) << text;
  }
}

TEST(Recording, AHeaderOfAnotherKindOrVersionIsRefused) {
  EXPECT_EQ(read_recording_header(bytes_of("$GPGGA,1\n")).problem, "no recording");
  EXPECT_EQ(read_recording_header(bytes_of("roverd-bytes 2 x\n")).problem,
            "version 2 is not known here");
  EXPECT_EQ(read_recording_header(bytes_of("roverd-bytes x\n")).problem,
            "the header has no version");
  EXPECT_EQ(read_recording_header(bytes_of("roverd-bytes 1 " + std::string(2000, 'x'))).problem,
            "the header line is too long");
  EXPECT_EQ(recording_header("a\nb\rc"), "roverd-bytes 1 a b c\n");
}

}  // namespace
}  // namespace roverd::link
