#pragma once
// Finds recordings of real devices. They are too large and not ours to keep beside the tests:
// they lie in the folder that the environment variable ROVERD_REAL_DATA names, or else in
// shared/data beside the source tree. Without them a test is skipped by name; where the
// environment says CI=true it fails.
//
//   ROVERD_REAL_DATA(path, "gnss-nmea-rtk.log");   // in a test's body; path is a filesystem path

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "source_folder.hpp"

namespace roverd::tests {

/// Where the file should be. Whether it is there is another question.
inline std::filesystem::path real_data_path(std::string_view name) {
  if (const char* folder = std::getenv("ROVERD_REAL_DATA"); folder != nullptr && *folder != '\0') {
    return std::filesystem::path(folder) / name;
  }
  return source_folder().parent_path() / "shared" / "data" / name;
}

inline bool must_have_real_data() {
  const char* ci = std::getenv("CI");
  return ci != nullptr && std::string_view(ci) == "true";
}

inline std::vector<std::uint8_t> read_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace roverd::tests

#define ROVERD_REAL_DATA(variable, name)                                                   \
  const std::filesystem::path variable = ::roverd::tests::real_data_path(name);            \
  do {                                                                                     \
    if (!std::filesystem::is_regular_file(variable)) {                                     \
      if (::roverd::tests::must_have_real_data()) FAIL() << "missing real data: " << name; \
      GTEST_SKIP() << "missing real data: " << name;                                       \
    }                                                                                      \
  } while (false)
