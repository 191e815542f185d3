// What a study says of its runs.

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "study/study.hpp"

namespace roverd::study {
namespace {

Run run_of(const std::string& course, std::uint64_t seed, double rms_m, std::string problem = {}) {
  Run r;
  r.course = course;
  r.disturbance = "d";
  r.seed = seed;
  r.problem = std::move(problem);
  r.truth.cross.rms_m = rms_m;
  r.truth.time_s = 10.0;
  r.way = {{0, 0}, {10, 0}};
  r.driven = {{0.0, {0, 0}, 0.0, 1.0, 0.0}, {10.0, {10, 0.1}, 0.0, 1.0, 0.0}};
  r.matched.resize(2);
  r.matched[1].s_m = 10.0;
  r.matched[1].cross_m = 0.1;
  return r;
}

TEST(StudyReport, TheTableHasMeanAndWorstOfEachCourse) {
  const std::string text = to_table(
      {run_of("L", 1, 0.02), run_of("L", 2, 0.04, "blocked: stuck"), run_of("S", 1, 0.01)});
  EXPECT_NE(text.find("L / d"), std::string::npos);
  EXPECT_NE(text.find("0.030/0.040"), std::string::npos);
  EXPECT_NE(text.find("1 of 2"), std::string::npos);
  EXPECT_NE(text.find("L / d, seed 2: blocked: stuck"), std::string::npos);
  EXPECT_NE(text.find("0 of 1"), std::string::npos);
}

TEST(StudyReport, TheJsonHasEveryRun) {
  study::Setup setup;
  setup.vehicle = "bunker";
  const auto whole =
      nlohmann::json::parse(to_json({run_of("L", 1, 0.02), run_of("L", 2, 0.04, "lost")}, setup));
  EXPECT_EQ(whole["vehicle"], "bunker");
  ASSERT_EQ(whole["runs"].size(), 2u);
  EXPECT_EQ(whole["runs"][0]["problem"], nullptr);
  EXPECT_EQ(whole["runs"][1]["problem"], "lost");
  EXPECT_EQ(whole["runs"][1]["truth"]["cross_track"]["rms_m"], 0.04);
  EXPECT_EQ(whole["runs"][1]["track"].dump(), "[[0.0,0.0,0.0,90.0,1.0],[10.0,10.0,0.1,90.0,1.0]]");
  EXPECT_EQ(whole["ways"]["L"].dump(), "[[0.0,0.0],[10.0,0.0]]");
}

TEST(StudyReport, ThePlotHasTheWayAndEachTrack) {
  const auto a = run_of("L & <S>", 1, 0.02);
  const auto b = run_of("L & <S>", 2, 0.02);
  const std::string picture = to_svg({&a, &b});
  EXPECT_EQ(picture.rfind("<svg ", 0), 0u);
  EXPECT_NE(picture.find("L &amp; &lt;S>"), std::string::npos);
  std::size_t lines = 0;
  for (auto at = picture.find("<polyline"); at != std::string::npos;
       at = picture.find("<polyline", at + 1)) {
    ++lines;
  }
  EXPECT_EQ(lines, 1u + 2u + 3u + 2u);
  EXPECT_EQ(to_svg({}), "");
}

}  // namespace
}  // namespace roverd::study
