// What is shown after an attempt.
#pragma once

#include <string>

#include "trainer/choice.hpp"
#include "trainer/result_summary.hpp"

namespace trocar::app {

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
