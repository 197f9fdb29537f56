// Holds the result at a recording's end against what its exercise makes of the same inputs now: score, verdict, steps,
// errors, details, metrics. A block's checksum needs no key, so that anybody can write another result into a file.
#pragma once

#include <string>

#include <trocar/attempt/lesson.hpp>
#include <trocar/core/json.hpp>
#include <trocar/sim/recording/recording.hpp>

namespace trocar::attempt {

struct ResultCheck {
  std::string difference;    ///< empty: there is none, as far as it was compared
  std::string not_compared;  ///< why; empty: it was compared
};

/// Of a replay that met all hashes. @param judged  Session::result() of it, as `was_aborted` has it
ResultCheck check_result(const sim::Recording& recording, const Lesson& lesson, const Json& judged);

/// Does the recording's result say that somebody ended the attempt before its end?
bool was_aborted(const sim::Recording& recording);

/// Where two results differ first: "assessment/score/total: 100 and 0". Texts for people do not count; numbers are
/// equal up to the rounding of functions that differ between machines.
std::string first_difference(const Json& a, const Json& b);

}  // namespace trocar::attempt
