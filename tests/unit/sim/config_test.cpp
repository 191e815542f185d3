// The simulator's configuration file, overrides and command line.

#include "sim/config.hpp"

#include <gtest/gtest.h>

#include "sim/options.hpp"
#include "source_folder.hpp"

namespace roverd::sim {
namespace {

std::string sim_config() {
  return tests::in_source("config/sim/bunker.toml");
}

std::string problem(const base::Result<void>& result) {
  return result ? "none" : result.error().detail;
}

Parsed parse(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "roverd-sim");
  return parse_options(static_cast<int>(arguments.size()), arguments.data());
}

TEST(SimConfig, TheFileThatIsShippedHoldsTheDefaults) {
  Config config;
  ASSERT_EQ(problem(read_config_file(config, sim_config())), "none");
  EXPECT_EQ(parameter_list(config), parameter_list(Config{}));
}

TEST(SimConfig, ValuesOfAFileAreTaken) {
  Config config;
  ASSERT_TRUE(read_config(config, "[start]\nlat = -33.5\n[drive]\nslip = 0\n", "a.toml"));
  EXPECT_EQ(config.start.at.lat, -33.5);
  EXPECT_EQ(config.params.drive.slip, 0.0);
}

TEST(SimConfig, BadFilesAreRefusedByFileLineAndKey) {
  Config config;
  const auto read = [&](const char* text) { return problem(read_config(config, text, "a.toml")); };
  EXPECT_EQ(read("[drive]\nslip = 0.2\nslipp = 0.1\n"), "a.toml:3: unknown key drive.slipp");
  EXPECT_EQ(read("[driv]\nslip = 0.2\n"), "a.toml:2: unknown key driv.slip");
  EXPECT_EQ(read("slip = 0.2\n"), "a.toml:1: unknown key slip");
  EXPECT_EQ(read("[drive]\n\nslip = 2.0\n"), "a.toml:3: drive.slip must lie in 0.0 .. 0.9");
  EXPECT_EQ(read("[drive]\nslip = nan\n"), "a.toml:2: drive.slip must lie in 0.0 .. 0.9");
  EXPECT_EQ(read("[gnss]\nprofile = 3\n"), "a.toml:2: gnss.profile must be text");
  EXPECT_EQ(read("[start]\nlat = [1]\n"),
            "a.toml:2: start.lat must be a number, a text or true/false");
  EXPECT_EQ(read("[start]\nlat = 95\n"), "a.toml:2: start.lat must lie in -89.0 .. 89.0");
  EXPECT_EQ(read("[drive\n").substr(0, 10), "a.toml:1: ");
  EXPECT_EQ(parameter_list(config), parameter_list(Config{}));  // not even the good keys
  EXPECT_EQ(problem(read_config_file(config, "/nonexistent/a.toml")),
            "cannot read the configuration file /nonexistent/a.toml");
}

TEST(SimConfig, OverridesNameThemselvesWhenBad) {
  Config config;
  ASSERT_TRUE(apply_override(config, "gnss.profile=consumer"));
  ASSERT_TRUE(apply_override(config, "compass.fitted=false"));
  ASSERT_TRUE(apply_override(config, "start.heading_deg=-10"));
  EXPECT_EQ(config.params.gnss.profile, "consumer");
  EXPECT_FALSE(config.params.compass.fitted);
  EXPECT_EQ(config.start.heading_deg, -10.0);
  EXPECT_EQ(problem(apply_override(config, "drive.slip")), "--set drive.slip: must be key=value");
  EXPECT_EQ(problem(apply_override(config, "drive.slip=much")),
            "--set drive.slip=much: drive.slip must be a number");
  EXPECT_EQ(problem(apply_override(config, "drive.slip=0x1")),
            "--set drive.slip=0x1: drive.slip must be a number");
}

TEST(SimOptions, OneOfTheTwoBusesIsNeeded) {
  EXPECT_EQ(parse({}).exit_code, 2);
  EXPECT_EQ(parse({}).text, "roverd-sim: one of --can IFACE and --cansock PATH is needed");
  EXPECT_EQ(parse({"--can", "vcan0", "--cansock", "x"}).exit_code, 2);
  ASSERT_TRUE(parse({"--can", "vcan0"}).options);
}

TEST(SimOptions, EverythingIsTakenAndTheCommandLineWinsOverTheFile) {
  const std::string file = sim_config();
  const Parsed p =
      parse({"--cansock", "/run/x", "--gnss", "pty:/run/tty", "--control", "7001", "--seed", "42",
             "--config", file.c_str(), "--set", "drive.slip=0.2", "--set", "gnss.rate_hz=10",
             "--start", "-33.5,151.25,270.5", "--die-with-parent"});
  ASSERT_TRUE(p.options) << p.text;
  const Options& o = *p.options;
  EXPECT_EQ(o.cansock, "/run/x");
  EXPECT_EQ(o.gnss_pty, "/run/tty");
  EXPECT_FALSE(o.gnss_port);
  EXPECT_EQ(o.control_port, 7001);
  EXPECT_EQ(o.seed, 42u);
  EXPECT_EQ(o.config.params.drive.slip, 0.2);
  EXPECT_EQ(o.config.params.gnss.rate_hz, 10.0);
  EXPECT_EQ(o.config.start.at, (base::LatLon{-33.5, 151.25}));
  EXPECT_EQ(o.config.start.heading_deg, 270.5);
  EXPECT_TRUE(o.die_with_parent);
}

TEST(SimOptions, BadArgumentsAreOneLineAndExitCodeTwo) {
  for (const auto& [option, value] :
       std::vector<std::pair<const char*, const char*>>{{"--gnss", "serial:x"},
                                                        {"--gnss", "tcp:"},
                                                        {"--gnss", "tcp:70000"},
                                                        {"--gnss", "pty:"},
                                                        {"--control", "70000"},
                                                        {"--seed", "-1"},
                                                        {"--seed", "x"},
                                                        {"--start", "58"},
                                                        {"--start", "58,"},
                                                        {"--start", "58,26,1,2"},
                                                        {"--start", "99,26"},
                                                        {"--start", "nan,26"},
                                                        {"--set", "drive.slipp=1"},
                                                        {"--config", "/nonexistent"},
                                                        {"--bogus", "1"}}) {
    const Parsed p = parse({"--cansock", "x", option, value});
    EXPECT_FALSE(p.options) << option << " " << value;
    EXPECT_EQ(p.exit_code, 2);
    EXPECT_EQ(p.text.find('\n'), std::string::npos);
    EXPECT_EQ(p.text.substr(0, 12), "roverd-sim: ");
  }
}

TEST(SimOptions, HelpAndTheListOfParametersAreNoErrors) {
  EXPECT_EQ(parse({"--help"}).exit_code, 0);
  const Parsed p = parse({"--parameters"});
  EXPECT_EQ(p.exit_code, 0);
  EXPECT_NE(p.text.find("drive.slip = 0.08 (0 .. 0.9): "), std::string::npos);
}

}  // namespace
}  // namespace roverd::sim
