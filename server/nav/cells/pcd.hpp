#pragma once
// Point clouds as files of the Point Cloud Library (PCD 0.7; 0.5 and 0.6 read alike): ascii, binary
// and binary_compressed. Foreign bytes: nothing is allocated that the file cannot fill.
// Source: pointclouds.org, "The PCD (Point Cloud Data) file format".

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/bytes.hpp"
#include "base/result.hpp"
#include "nav/cells/cell_map.hpp"

namespace roverd::nav::cells {

/// More points in one file are refused.
inline constexpr std::size_t kMostPcdPoints = 20'000'000;

/// Some columns of a file. A value that is no float in the file is rounded to one: integers beyond
/// 2^24 and coordinates of a country's grid lose their last digits.
struct PcdTable {
  std::uint32_t width = 0;   ///< points of a row
  std::uint32_t height = 1;  ///< rows; more than 1: organised like an image
  /// Where the sensor stood: x y z, metres; turn as a quaternion w x y z.
  std::array<double, 7> viewpoint = {0, 0, 0, 1, 0, 0, 0};
  std::vector<std::string> names;
  std::vector<std::vector<float>> columns;  ///< width * height values each
};

inline constexpr std::array<std::string_view, 3> kPcdXyz = {"x", "y", "z"};

/// A file's points one after the other: none is held.
class PcdReader {
 public:
  /// @param values of the wanted fields, while the call lasts. @return false: it is enough
  using Take = std::function<bool(std::span<const float> values)>;

  /// Reads the header, and whether the file can hold what that says; the packing is checked to its
  /// end. @param file outlives it. @param wanted as for read_pcd
  static base::Result<PcdReader> open(base::Bytes file, std::span<const std::string_view> wanted);
  PcdReader(PcdReader&&) noexcept;
  PcdReader& operator=(PcdReader&&) noexcept;
  ~PcdReader();

  std::uint32_t width() const noexcept;
  std::uint32_t height() const noexcept;
  std::size_t points() const noexcept { return std::size_t{width()} * height(); }
  /// As in PcdTable.
  const std::array<double, 7>& viewpoint() const noexcept;
  /// Gives each point to `take`, in the file's order. @return Malformed: ascii that ends or is no
  /// number, after the points before it were given
  base::Result<void> read(const Take& take) const;

 private:
  struct Inside;
  explicit PcdReader(std::unique_ptr<Inside> inside);
  std::unique_ptr<Inside> inside_;
};

/// @param wanted names of the fields that are read; the order of the answer's columns. One that the
/// file has not, or has as an array, is named in the error.
/// @return Malformed with "line n" of the header or of ascii data, or "byte n"; TooLarge;
/// Unsupported
base::Result<PcdTable> read_pcd(base::Bytes file, std::span<const std::string_view> wanted);

/// Its x, y and z. Points that are no numbers stay in their places.
base::Result<Cloud> read_pcd_cloud(base::Bytes file);

enum class PcdData { Ascii, Binary, Compressed };

/// binary_compressed, a column at a time, so that one is held beside what is packed.
/// @param names without blanks, 1 to 64. @param points at most kMostPcdPoints
/// @param value of a column's point
std::vector<std::uint8_t> write_packed_pcd(
    std::span<const std::string_view> names, std::uint32_t points,
    const std::function<float(std::size_t column, std::size_t point)>& value);

/// @param table names without blanks, columns of width * height values; else Invalid
/// @return the file. ascii: the shortest text that reads back as the same float
base::Result<std::vector<std::uint8_t>> write_pcd(const PcdTable& table, PcdData data);

/// A cloud as such a table.
PcdTable pcd_table(std::span<const Eigen::Vector3f> cloud);

}  // namespace roverd::nav::cells
