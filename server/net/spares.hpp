#pragma once
// File descriptors that are held back: when the process has no other left, one is closed, and a
// connection that wants to say what is urgent can be accepted in its place.
//
// Web thread only.

#include <vector>

namespace roverd::net {

class Spares {
 public:
  static constexpr int kSpares = 6;

  Spares() { refill(); }
  ~Spares();
  Spares(const Spares&) = delete;
  Spares& operator=(const Spares&) = delete;

  /// One descriptor is free now. @return false: there are none any more
  bool give() noexcept;
  /// Holds back again what it gave, as far as the system allows.
  void refill() noexcept;

  /// Asks the system for as many descriptors as it grants without rights, and tells how many
  /// connections they suffice for beside what else this process does. At least 4.
  /// @param reserve connections beyond that
  static int descriptors_left(int reserve) noexcept;

 private:
  std::vector<int> held_;
};

}  // namespace roverd::net
