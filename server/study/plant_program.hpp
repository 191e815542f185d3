#pragma once
// Somebody else's plant as a program: a line to its standard input, a line from its standard
// output, in turn, a hundred for each second of simulated time.

#include <memory>
#include <string>

#include <sys/types.h>

#include "base/result.hpp"
#include "base/time.hpp"
#include "sim/foreign.hpp"
#include "study/plant_line.hpp"

namespace roverd::study {

class PlantProgram final : public sim::Foreign {
 public:
  /// @param command for the shell. @param patience for each answer. The caller ignores SIGPIPE.
  static base::Result<std::unique_ptr<PlantProgram>> start(
      const std::string& command, const PlantHello& hello,
      base::Duration patience = std::chrono::seconds(5));
  /// It and what it started are ended.
  ~PlantProgram() override;

  const sim::ForeignState& step(const sim::ForeignOrder& order) override;
  const sim::ForeignState& state() const noexcept override { return said_.state; }
  bool has_gnss() const noexcept override { return said_.own_gnss; }
  /// Why it stands still from now on; empty: all is well.
  const std::string& problem() const noexcept { return problem_; }

 private:
  PlantProgram(const PlantHello& hello, base::Duration patience)
      : hello_(hello), patience_(patience) {}
  base::Result<void> spawn(const std::string& command);
  base::Result<std::string> ask(std::string line);
  base::Result<std::string> hear();
  std::string how_it_ended();

  PlantHello hello_;
  base::Duration patience_;
  PlantSaid said_;
  std::string problem_;
  std::string heard_;  ///< beyond the last line end
  pid_t child_ = -1;
  int to_ = -1;
  int from_ = -1;
};

}  // namespace roverd::study
