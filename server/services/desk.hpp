#pragma once
// A desk: work that must not keep the web or the robot waiting is put on it and done in order, on a
// thread of its own; a beat comes between. Immutable values and callables are all that cross it.

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "base/time.hpp"

namespace roverd::services {

class Desk {
 public:
  using Work = std::function<void()>;
  using Poster = std::function<void(Work)>;

  Desk();
  /// Ends as stop() does.
  ~Desk();
  Desk(const Desk&) = delete;
  Desk& operator=(const Desk&) = delete;

  /// Begins the thread. `beat` is called every `period`, late rather than twice at once.
  void start(base::Duration period, Work beat);
  /// What lies here is dropped, what is at work ends. Nothing is taken after that. Once.
  void stop();

  /// Any thread. Work that throws is told in the log, and the next one goes on.
  void post(Work work) { put(*pile_, std::move(work)); }
  /// As post, also when the desk has gone: then nothing happens.
  Poster poster() const;

 private:
  /// Everything is guarded by mutex, a leaf.
  struct Pile {
    std::mutex mutex;
    std::condition_variable news;
    std::deque<Work> works;
    bool closed = false;
  };
  static void put(Pile& pile, Work work);
  void run(base::Duration period, const Work& beat);

  std::shared_ptr<Pile> pile_;
  std::thread thread_;
};

}  // namespace roverd::services
