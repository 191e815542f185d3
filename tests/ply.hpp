#pragma once
// Reads the points of a binary little-endian PLY whose vertices begin with float x, y, z: as much
// of the format as the recordings need.

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace roverd::tests {

/// @param floats of a vertex. Empty where the file is none such.
inline std::vector<Eigen::Vector3f> ply_points(const std::filesystem::path& path,
                                               std::size_t floats) {
  std::ifstream in(path, std::ios::binary);
  std::vector<Eigen::Vector3f> out;
  constexpr const char* kCount = "element vertex ";
  for (std::string line; std::getline(in, line) && line.rfind("end_header", 0) != 0;) {
    if (line.rfind(kCount, 0) == 0) out.resize(std::stoul(line.substr(std::strlen(kCount))));
  }
  std::vector<float> row(floats);
  for (auto& p : out) {
    in.read(reinterpret_cast<char*>(row.data()),
            static_cast<std::streamsize>(floats * sizeof(float)));
    p = {row[0], row[1], row[2]};
  }
  return in ? out : std::vector<Eigen::Vector3f>{};
}

}  // namespace roverd::tests
