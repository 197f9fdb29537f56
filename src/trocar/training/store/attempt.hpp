// An attempt as it is kept: who did what, when, how it went. One row of the session store, and one small JSON file
// where the store cannot be written.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace trocar::training {

enum class AttemptMode {
  assessed,
  familiarisation,  ///< getting to know scene and instruments: no score
  demonstration,    ///< nobody's hands: the demonstration, or a recording done again
  free_practice,    ///< a bare scene: there is no task, so no score
};

enum class AttemptState {
  running,
  finished,      ///< the exercise, or what led the instruments, came to its end
  aborted,       ///< somebody ended it before
  interrupted,   ///< the program ended without saying so: killed, or the power went
  not_assessed,  ///< the simulation failed: neither score nor verdict
};

const char* name_of(AttemptMode mode);
const char* name_of(AttemptState state);
std::optional<AttemptMode> mode_named(const std::string& name);
std::optional<AttemptState> state_named(const std::string& name);

struct Attempt {
  std::int64_t number =
      0;  ///< the order in which attempts began, whatever clocks said; given by the store, 0: none yet
  std::string uuid;
  std::string trainee, exercise, title;
  AttemptMode mode = AttemptMode::assessed;
  std::uint64_t seed = 0;      ///< of the anatomy; 0: the standard patient
  std::string input;           ///< what led the instruments: "mouse", "gamepad", "demo", ...
  std::string started, ended;  ///< UTC, "2026-03-01T14:05:09Z"; for people, never compared
  AttemptState state = AttemptState::running;
  std::optional<double> score;  ///< 0..100; nothing without a goal
  std::optional<bool> passed;
  double seconds = 0;  ///< simulated, first tick to last
  std::uint64_t ticks = 0;
  std::string recording;  ///< path; empty: none
  std::string result;     ///< JSON
  std::string program_version;
  std::uint64_t model_hash = 0;
  std::string store;                ///< the folder of the store that it belongs to; empty: any
  bool has_trace = false;           ///< the store knows its motion
  std::vector<std::uint8_t> trace;  ///< only where it was asked for
};

inline constexpr std::size_t kLongestName = 100;  ///< of a trainee [bytes]

/// What a name may be: valid UTF-8 without control characters, without blanks around it, at most 100 bytes.
std::string clean_name(const std::string& text);

/// 32 hex digits and four dashes, random.
std::string new_uuid();
/// Digits, small letters and dashes, 16 to 64: it names files, so nothing else may come from a file, and it cannot be
/// taken for a number.
bool is_uuid(const std::string& text);

/// What a recording's header says of its attempt's mode; one that says nothing was assessed.
AttemptMode mode_in_header(const std::string& metadata_json);

/// The hash of the exercise that a recording was judged by (judgement_hash(), hexadecimal), as its header says it;
/// empty: it does not.
std::string exercise_hash_in(const std::string& metadata_json);
inline constexpr const char* kExerciseHash = "exercise_hash";  ///< its key there

/// Score, verdict and length from the result that an attempt ended with; a familiarisation has neither of the first
/// two.
void fill_from_result(const std::string& result, Attempt& attempt);
/// How an attempt with that result ended: finished, aborted or not assessed.
AttemptState state_in_result(const std::string& result);

/// Notes in the result that it is as a recording has it, which nobody has verified: anybody may have written it.
void mark_unverified(Attempt& attempt);
bool is_unverified(const Attempt& attempt);

/// The attempt without its trace as a JSON object, and back; nothing for a text that is not one.
std::string to_json(const Attempt& attempt);
std::optional<Attempt> attempt_from_json(const std::string& text);

}  // namespace trocar::training
