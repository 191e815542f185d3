#include "camera/driver.hpp"

#include <deque>

#include <gtest/gtest.h>

#include "link/memory.hpp"
#include "pictures.hpp"

namespace roverd::camera {
namespace {

using namespace std::chrono_literals;
using base::DriverPhase;

struct CameraDriverTest : ::testing::Test {
  void begin(const std::string& address, const Params& params = {}) {
    Driver::Doors doors;
    doors.make_link = [this]() -> base::Result<std::unique_ptr<link::ByteLink>> {
      wires.push_back(link::memory_byte_pair());
      ours = wires.back().a.get();
      camera().on_bytes = [this](base::Bytes b, Time) { asked.append(b.begin(), b.end()); };
      EXPECT_TRUE(camera().open());
      return std::move(wires.back().a);
    };
    doors.on_measurement = [](const base::Measurement&) {};
    doors.on_picture = [this](base::PicturePtr p) { pictures.push_back(std::move(p)); };
    std::optional<Source> source;
    if (!address.empty()) source = parse_source(address).value();
    driver = std::make_unique<Driver>("front", params, source, doors);
    driver->start(now);
    after(20ms);
  }
  link::MemoryByteLink& camera() { return *wires.back().b; }
  void after(base::Duration wait) {
    now += wait;
    driver->tick(now);
    camera().deliver(now);
  }
  void says(const std::string& text) {
    camera().write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    ours->deliver(now);
  }
  base::DriverStatus status() const { return driver->status(now); }
  std::uint64_t count(const std::string& what) const {
    const auto counts = status().detail->counts;
    return counts.contains(what) ? counts.at(what) : 0;
  }

  Time now = Time{} + 1000s;
  std::deque<link::MemoryBytePair> wires;
  link::MemoryByteLink* ours = nullptr;
  std::string asked;
  std::vector<base::PicturePtr> pictures;
  std::unique_ptr<Driver> driver;
};

TEST_F(CameraDriverTest, PicturesOfAStreamAreHandedOverAsTheyCame) {
  begin("http://10.0.0.9/video");
  EXPECT_TRUE(asked.starts_with("GET /video HTTP/1.1\r\n")) << asked;
  EXPECT_EQ(status().phase, DriverPhase::Opening);
  says(kStream + sized_part(picture(10)));
  EXPECT_EQ(status().phase, DriverPhase::Up);
  after(100ms);
  says(sized_part(picture(20)));
  ASSERT_EQ(pictures.size(), 2U);
  EXPECT_EQ(pictures[1]->camera, "front");
  EXPECT_EQ(pictures[1]->count, 1U);
  EXPECT_EQ(pictures[1]->stamp, now);
  EXPECT_EQ(pictures[1]->width, kSide);
  EXPECT_EQ(std::string(pictures[1]->jpeg.begin(), pictures[1]->jpeg.end()), picture(20));
  EXPECT_EQ(status().received, 2U);
  EXPECT_EQ(status().link, "http://10.0.0.9:80/video");
  EXPECT_EQ(status().detail->facts.at("size"), "16x16");
  EXPECT_EQ(status().detail->rates_hz.at("picture"), 1.0) << "two within two seconds";
}

TEST_F(CameraDriverTest, ACameraThatHangsIsFaultyThoughItSends) {
  begin("http://10.0.0.9/video");
  says(kStream + sized_part(picture(10)));
  for (int i = 0; i < 10; ++i) {
    after(100ms);
    says(sized_part(picture(10)));
  }
  EXPECT_EQ(pictures.size(), 1U) << "no picture is new that shows what the last one did";
  after(100ms);
  EXPECT_EQ(status().phase, DriverPhase::Faulty);
  EXPECT_EQ(status().reason, "the same picture again and again");
  EXPECT_EQ(count("same picture again"), 10U);
  EXPECT_EQ(status().last_received, Time{} + 1000s + 20ms) << "when it gave a new one last";
  says(sized_part(picture(11)));
  EXPECT_EQ(status().phase, DriverPhase::Up);
}

TEST_F(CameraDriverTest, SilenceIsToldAndThenTheConnectionIsMadeAnew) {
  begin("http://10.0.0.9/video");
  says(kStream + sized_part(picture(10)));
  after(1001ms);
  EXPECT_EQ(status().phase, DriverPhase::Faulty);
  EXPECT_EQ(status().reason, "no new picture");
  EXPECT_TRUE(status().link_open);
  EXPECT_EQ(wires.size(), 1U);
  after(4001ms);
  EXPECT_FALSE(status().link_open);
  after(2s);
  after(20ms);
  EXPECT_EQ(wires.size(), 2U);
  says(kStream + sized_part(picture(12)));
  EXPECT_EQ(status().phase, DriverPhase::Up);
  EXPECT_EQ(pictures.back()->count, 1U);
}

TEST_F(CameraDriverTest, DamagedPicturesAreCountedByTheirFault) {
  begin("http://10.0.0.9/video");
  const std::string good = picture(10);
  says(kStream + sized_part("no picture at all") + sized_part(good.substr(0, 60)) +
       sized_part(good));
  EXPECT_EQ(pictures.size(), 1U);
  EXPECT_EQ(count("picture that is no JPEG"), 1U);
  EXPECT_EQ(count("picture that does not end"), 1U);
  EXPECT_EQ(status().refused, 2U);
  EXPECT_EQ(status().detail->refused_last, "picture that does not end");
}

TEST_F(CameraDriverTest, SinglePicturesAreFetchedOneAfterTheOther) {
  Params p;
  p.images_hz = 5.0;
  begin("http://10.0.0.9/shot.jpg", p);
  const auto shot = [&](std::uint8_t grey) {
    const std::string jpeg = picture(grey);
    says("HTTP/1.0 200 OK\r\nContent-Type: image/jpeg\r\nContent-Length: " +
         std::to_string(jpeg.size()) + "\r\n\r\n" + jpeg);
  };
  shot(10);
  EXPECT_EQ(pictures.size(), 1U);
  after(150ms);
  EXPECT_EQ(wires.size(), 1U) << "not yet due";
  after(50ms);
  ASSERT_EQ(wires.size(), 2U);
  EXPECT_EQ(status().phase, DriverPhase::Up) << "between two pictures it is not lost";
  after(20ms);
  shot(20);
  EXPECT_EQ(pictures.size(), 2U);
  EXPECT_EQ(status().detail->facts.at("gives"), "one picture at a time");
}

TEST_F(CameraDriverTest, ALoginIsToldAsADigestOnceItIsAskedFor) {
  begin("http://rover:secret@10.0.0.9/video");
  EXPECT_EQ(asked.find("Authorization"), std::string::npos);
  asked.clear();
  const std::string no =
      "HTTP/1.1 401 Unauthorized\r\nWWW-Authenticate: Digest realm=\"c\", nonce=\"1\", "
      "qop=\"auth\"\r\n\r\n";
  says(no);
  after(20ms);
  after(20ms);
  EXPECT_NE(asked.find("Authorization: Digest username=\"rover\""), std::string::npos) << asked;
  says(kStream + sized_part(picture(10)));
  EXPECT_EQ(status().phase, DriverPhase::Up);
}

TEST_F(CameraDriverTest, ARefusedLoginWaitsLongAndIsNeverTold) {
  begin("http://rover:secret@10.0.0.9/video");
  const std::string no = "HTTP/1.1 401 No\r\nWWW-Authenticate: Basic realm=\"c\"\r\n\r\n";
  says(no);
  after(20ms);
  after(20ms);
  EXPECT_NE(asked.find("Authorization: Basic"), std::string::npos);
  says(no);
  EXPECT_EQ(status().phase, DriverPhase::Faulty);
  EXPECT_EQ(status().reason, "it refuses the login");
  const std::size_t before = wires.size();
  after(4s);
  EXPECT_EQ(wires.size(), before);
  after(2s);
  EXPECT_EQ(wires.size(), before + 1);
  EXPECT_EQ(status().link.find("secret"), std::string::npos);
}

TEST_F(CameraDriverTest, AClosedConnectionIsTriedAgain) {
  begin("http://10.0.0.9/video");
  says(kStream + sized_part(picture(10)));
  ours->fail("the peer closed the connection");
  EXPECT_EQ(status().phase, DriverPhase::Faulty);
  EXPECT_EQ(status().reason, "the peer closed the connection");
  after(600ms);
  after(20ms);
  EXPECT_EQ(wires.size(), 2U);
}

TEST_F(CameraDriverTest, ACameraOfThisComputerHandsOverPictures) {
  begin("");
  EXPECT_TRUE(asked.empty());
  says(picture(10) + std::string(8, '\0'));
  ASSERT_EQ(pictures.size(), 1U);
  EXPECT_EQ(pictures[0]->jpeg.size(), picture(10).size()) << "without what filled the buffer";
  says("\xFF\xD8 torn");
  EXPECT_EQ(status().refused, 1U);
}

}  // namespace
}  // namespace roverd::camera
