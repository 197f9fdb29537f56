#include <fmt/format.h>

#include <trocar/attempt/verification/state_check.hpp>
#include <trocar/core/text.hpp>
#include <trocar/sim/recording/shown_difference.hpp>

namespace trocar::attempt {
namespace {

/// Marks stand at 0, every, 2 every ... and, with `at_end`, at the last tick.
/// @param words  what they are called
template <class Mark>
std::string fault_of(const std::vector<Mark>& marks, std::uint64_t every, const sim::Recording& recording, bool at_end,
                     const char* words) {
  const std::uint64_t last = recording.inputs.size();
  std::size_t next = 0;
  for (std::uint64_t tick = 0; tick <= last; tick += every) {
    const bool missing = next == marks.size() || marks[next].tick > tick;
    if (missing && next == marks.size() && !recording.complete) return {};
    if (missing) return tr("the {} of tick {} is missing", words, tick);
    if (marks[next].tick < tick) return tr("expected no {} of tick {}, got one", words, marks[next].tick);
    ++next;
  }
  if (at_end && last % every != 0) {
    if (next < marks.size() && marks[next].tick == last)
      ++next;
    else if (recording.complete)
      return tr("the {} of tick {} is missing", words, last);
  }
  return next == marks.size() ? "" : tr("expected no {} of tick {}, got one", words, marks[next].tick);
}

}  // namespace

std::string fault_of_hashes(const sim::Recording& recording) {
  return fault_of(recording.hashes, sim::kHashEvery, recording, true, tr("state hash"));
}
std::string fault_of_keyframes(const sim::Recording& recording) {
  return fault_of(recording.keyframes, sim::kKeyframeEvery, recording, false, tr("keyframe"));
}

StateCheck::StateCheck(const sim::Model& model, const sim::Recording& recording)
    : m_model(model),
      m_recording(recording),
      m_hashes_fault(fault_of_hashes(recording)),
      m_keyframe_fault(fault_of_keyframes(recording)) {}

bool StateCheck::check(const Session& session) {
  if (!check_hash(session)) return false;
  check_keyframe(session.state());
  return true;
}

bool StateCheck::check_hash(const Session& session) {
  const std::vector<sim::HashMark>& marks = m_recording.hashes;
  const std::uint64_t tick = session.state().tick;
  while (m_next_hash < marks.size() && marks[m_next_hash].tick < tick) ++m_next_hash;
  if (m_next_hash == marks.size() || marks[m_next_hash].tick != tick) return true;
  if (session.mark() != marks[m_next_hash].hash) {
    m_differs_at = tick;
    m_shown = sim::told_difference(m_model, m_recording, session.state());
    return false;
  }
  ++m_agreed;
  m_last_good = tick;
  return true;
}

void StateCheck::check_keyframe(const sim::State& state) {
  const std::vector<sim::Keyframe>& keys = m_recording.keyframes;
  while (m_next_keyframe < keys.size() && keys[m_next_keyframe].tick < state.tick) ++m_next_keyframe;
  if (m_next_keyframe == keys.size() || keys[m_next_keyframe].tick != state.tick) return;
  const std::string differs = sim::shown_difference(m_model, keys[m_next_keyframe].bytes, state);
  if (differs.empty())
    ++m_keyframes;
  else if (m_keyframe_fault.empty())
    m_keyframe_fault = tr("the keyframe of tick {} does not show the state: {}", state.tick, differs);
}

std::string StateCheck::state_fault() const {
  const std::string shown = m_shown.empty() ? "" : "; " + m_shown;
  if (m_differs_at == 0) return tr("the first state differs before any tick{}", shown);
  return tr("the state differs after tick {}; it agreed until tick {}{}", m_differs_at, m_last_good, shown);
}

std::string StateCheck::fault() const {
  if (m_recording.hashes.empty()) return tr("the recording holds no state hash to compare");
  if (!m_hashes_fault.empty())
    return tr("verified until tick {} of {}: {}", m_last_good, m_recording.inputs.size(), m_hashes_fault);
  return m_differs_at != kNever ? state_fault() : m_keyframe_fault;
}

void StateCheck::describe(Json& out) const {
  const bool differs = m_differs_at != kNever;
  out["hashes_compared"] = m_agreed + (differs ? 1 : 0);
  out["keyframes_compared"] = m_keyframes;
  if (m_agreed > 0) out["verified_until_tick"] = m_last_good;
  if (differs) out["differs_between_ticks"] = {m_last_good, m_differs_at};
}

}  // namespace trocar::attempt
