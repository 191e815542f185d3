#pragma once
// What we tell a scanner when the connection stands, and whether it agreed.
//
//   configure: scans off ─▶ names ─▶ log in ─▶ scan ─▶ range ─▶ content ─▶ start measuring
//                  ─▶ state (every 200 ms, for 20 s, until 7) ─▶ run ─▶ scans on
//   otherwise: scans on
//
// Answers may come between scans and in any order: each is told by its words. What is refused or
// left unanswered is named, and the next step follows. Who says nothing at all is deaf in this
// dialect; who speaks the other one is asked anew in that. Pure state, no clock.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/time.hpp"
#include "sick/commands.hpp"
#include "sick/params.hpp"

namespace roverd::sick {

/// What params ask for, in the scanner's angles, within what its model sees.
ScanConfig wanted_scan(const Params& params);
OutputRange wanted_range(const Params& params);
DataConfig wanted_data(const Params& params);

class Setup {
 public:
  /// @param params valid.
  explicit Setup(const Params& params) : params_(params) { begin(Dialect::A); }

  /// The connection stands.
  void begin(Dialect dialect);
  /// What is to be sent now; empty: nothing.
  Request due(base::Time now);
  /// What due() gave could not be sent: it is due again.
  void unsent() noexcept;
  void add(const Telegram& telegram, const Words& words);

  /// Nothing at all came back in this dialect.
  bool deaf() const noexcept { return deaf_; }
  bool done() const noexcept { return at_ == steps_.size(); }
  Dialect dialect() const noexcept { return dialect_; }
  /// "configuration", "state", "device", "firmware", "serial_number".
  const std::map<std::string, std::string>& facts() const noexcept { return facts_; }

 private:
  struct Step {
    std::string what;
    std::string kind;  ///< of the answer
    std::string name;
    Request request;
    std::string fact{};  ///< that the answer's letters become
    base::Duration patience = std::chrono::seconds(1);
    int tries = 2;
    bool until_measuring = false;
  };
  void list_configuration();
  void step(const char* what, const char* kind, const char* name, Request request);
  void next(const std::string& problem);
  void on_answer(const Telegram& telegram, const Words& words);

  const Params params_;
  Dialect dialect_ = Dialect::A;
  std::vector<Step> steps_;
  std::size_t at_ = 0;
  int tries_ = 0;
  std::optional<base::Time> asked_;
  bool working_ = false;  ///< sMA came: the answer will follow
  bool heard_ = false;
  bool deaf_ = false;
  std::string problems_;
  std::map<std::string, std::string> facts_;
};

}  // namespace roverd::sick
