// Holds a replay against what its recording says of the States: a hash and a keyframe every hundred ticks, and a hash
// at its end. Marks that are missing, or stand where none belongs, are found as well.
//
//   StateCheck states(lesson.model, recording);
//   bool good = states.check(session);
//   while (good && ...) { session.advance(...); good = states.check(session); }
//   say(states.fault());
#pragma once

#include <string>

#include <trocar/attempt/session.hpp>
#include <trocar/core/json.hpp>

namespace trocar::attempt {

class StateCheck {
 public:
  /// Both must outlive it.
  StateCheck(const sim::Model& model, const sim::Recording& recording);

  /// Before the first tick, and after every one. False: the State differs, so that no later one says anything.
  bool check(const Session& session);

  /// Empty, or what is wrong: a hash that is missing or too many, the State, a keyframe.
  std::string fault() const;
  std::size_t hashes() const { return m_agreed; }  ///< that agreed
  std::size_t keyframes() const { return m_keyframes; }
  std::uint64_t last_good() const { return m_last_good; }  ///< tick of the last hash that agreed
  /// Adds counts and ticks: "hashes_compared", "keyframes_compared", "verified_until_tick", "differs_between_ticks".
  void describe(Json& out) const;

 private:
  bool check_hash(const Session& session);
  void check_keyframe(const sim::State& state);
  std::string state_fault() const;

  static constexpr std::uint64_t kNever = ~std::uint64_t(0);
  const sim::Model& m_model;
  const sim::Recording& m_recording;
  std::string m_hashes_fault, m_keyframe_fault, m_shown;
  std::size_t m_next_hash = 0, m_next_keyframe = 0, m_agreed = 0, m_keyframes = 0;
  std::uint64_t m_last_good = 0, m_differs_at = kNever;
};

/// Empty, or which is missing or should not be there. A recording that was interrupted may end before its last ones.
std::string fault_of_hashes(const sim::Recording& recording);
std::string fault_of_keyframes(const sim::Recording& recording);

}  // namespace trocar::attempt
