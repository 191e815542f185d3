#include "config/cameras.hpp"

#include <gtest/gtest.h>

#include "config/settings.hpp"
#include "source_folder.hpp"

namespace roverd {
namespace {

base::Result<Settings> with(const std::vector<std::string>& said) {
  return load_settings({tests::in_source("config/robot.toml"), "bunker", said});
}

TEST(CameraSettings, ACameraIsReadWithItsLensAndMount) {
  const auto s =
      with({"cameras.front.link=http://10.0.0.9/video", "cameras.front.fov_deg=90",
            "cameras.front.x_m=0.4", "cameras.front.pitch_deg=10", "cameras.spare.enabled=false"});
  ASSERT_TRUE(s) << s.error().detail;
  ASSERT_EQ(s->cameras.size(), 2U);
  const CameraSetup& front = s->cameras.at("front");
  EXPECT_EQ(front.said.link, "http://10.0.0.9/video");
  EXPECT_EQ(front.said.mount().x_m, 0.4);
  EXPECT_NEAR(front.said.mount().pitch_rad, 0.17453, 1e-5);
  EXPECT_NEAR(camera::lens_of(front.params, 640, 480).value().fx, 320.0, 1e-9);
  EXPECT_FALSE(read_tags(s->cameras)) << "pictures are for people, where nothing else is said";
}

TEST(CameraSettings, ACameraThatReadsTagsNeedsItsLens) {
  const auto s = with({"cameras.front.link=http://10.0.0.9/video", "cameras.front.fov_deg=90",
                       "cameras.front.tags=true", "cameras.front.latency_s=0.12"});
  ASSERT_TRUE(s) << s.error().detail;
  EXPECT_TRUE(read_tags(s->cameras));
  EXPECT_EQ(s->cameras.at("front").said.latency_s, 0.12);
  const auto blind = with({"cameras.front.link=http://10.0.0.9/video", "cameras.front.tags=true"});
  ASSERT_FALSE(blind);
  EXPECT_EQ(blind.error().detail,
            "--set cameras.front.tags=true needs the lens: fx and fy, or fov_deg");
  const auto off = with({"cameras.front.link=http://10.0.0.9/video", "cameras.front.fov_deg=90",
                         "cameras.front.tags=true", "cameras.front.enabled=false"});
  ASSERT_TRUE(off) << off.error().detail;
  EXPECT_FALSE(read_tags(off->cameras)) << "it is not there";
}

TEST(CameraSettings, WhatIsWrongIsNamedByItsKeyAndNoLoginIsShown) {
  const auto why = [](const std::vector<std::string>& said) {
    const auto s = with(said);
    return s ? "taken" : s.error().detail;
  };
  EXPECT_EQ(why({"cameras.front.fov_deg=70"}), "cameras.front.link must say where the camera is");
  const std::string login = why({"cameras.front.link=http://rover:secret@h:0/"});
  EXPECT_NE(login.find("cameras.front.link"), std::string::npos) << login;
  EXPECT_NE(login.find("wants HOST or HOST:PORT"), std::string::npos) << login;
  EXPECT_EQ(login.find("secret"), std::string::npos) << login;
  EXPECT_NE(why({"cameras.gnss.link=http://h/"}).find("of a name that a driver has"),
            std::string::npos);
  EXPECT_NE(why({"cameras.a.link=v4l2:/dev/video7", "cameras.b.link=v4l2:/dev/video7"})
                .find("takes /dev/video7, which cameras.a has, too"),
            std::string::npos);
  EXPECT_NE(
      why({"cameras.a.link=http://h/", "cameras.a.colour=1"}).find("unknown key cameras.a.colour"),
      std::string::npos);
  EXPECT_NE(why({"cameras.Front.link=http://h/"}).find("a camera's name has a to z"),
            std::string::npos);
}

}  // namespace
}  // namespace roverd
