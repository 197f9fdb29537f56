// Pause menu, and what is shown after an attempt.
#pragma once

#include <string>

#include "trainer/choice.hpp"
#include "trainer/result_summary.hpp"

namespace trocar::app {

/// Pause menu. `why` is said where it was not asked for; `recording` is said, so that people find it.
/// @param display  how things are shown may be chosen: not while it counts
Choice draw_pause(const std::string& why, const std::string& recording, bool scored, bool display);
/// After an attempt.
struct ResultScreen {
  const ResultSummary& summary;
  std::string mode;        ///< "demonstration"; empty: an attempt that counts
  std::string trainee;     ///< whose name can stand on the report
  bool report = false;     ///< there is a page to open
  bool recording = false;  ///< there is a recording to watch
  std::string say;         ///< how far the report is, or what failed; empty: nothing
};
/// @param name_on_report  the trainee's choice
Choice draw_result(const ResultScreen& screen, bool& name_on_report);

}  // namespace trocar::app
