#pragma once
// A value that its owner replaces as a whole, and that others read where it is.
//
//   owner: adopt(next) ──▶ ┌─────────────┐ ◀── part A reads *setting
//                          │ immutable T │ ◀── part B reads *setting
//                          └─────────────┘      (copies of one Setting read the same value)
//
// No reader keeps a copy, so that none can be forgotten: what is adopted holds everywhere at once.
// One thread: owner and readers belong to the same one. Whoever makes a part by itself gives it a
// plain value, and the part reads that for ever.

#include <memory>
#include <utility>

namespace roverd::base {

template <class T>
class Setting {
 public:
  Setting() : Setting(T{}) {}
  /// Not explicit: a part that takes a Setting takes a plain value as well.
  Setting(T value) : held_(std::make_shared<Held>(std::make_shared<const T>(std::move(value)))) {}

  const T& operator*() const noexcept { return **held_; }
  const T* operator->() const noexcept { return held_->get(); }

  /// @param next not null; read from now on by all that share this setting.
  void adopt(std::shared_ptr<const T> next) noexcept { *held_ = std::move(next); }

 private:
  using Held = std::shared_ptr<const T>;
  std::shared_ptr<Held> held_;
};

}  // namespace roverd::base
