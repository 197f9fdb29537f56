// From begin to end, an attempt leaves a trace: its recording, its row in the session store, its result. The window's
// loop and the headless one use this alike, one object an attempt; a restart is an end and a new one.
//
//   training::Store store(data_folder());            // once; repairs and says so in store.notices()
//   Session session(lesson);
//   AttemptLog log(store, session, plan);             // recording open, row "running"
//   ... session.advance(input) ...; show(log.warning())
//   Json result = session.result(aborted);
//   log.end(result, aborted ? State::aborted : State::finished);   // recording closed, row complete; adds to `result`
//
// Nothing here throws but the constructor, and that only when a recording was asked for by name and cannot be made.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <trocar/attempt/session.hpp>
#include <trocar/training/store/store.hpp>

namespace trocar::attempt {

struct AttemptPlan {
  std::string trainee;  ///< empty: "guest"; for demonstrations what demonstrates
  training::AttemptMode mode = training::AttemptMode::assessed;
  std::string input = "mouse";
  /// Where the recording goes. Must be writable (exit 3), and what is there already is kept under another name.
  std::filesystem::path recording;
  /// Without a path: a recording of its own in the store's folder, or where that cannot be written, in the user's
  /// own temporary one. False: none.
  bool record = true;
};

class AttemptLog {
 public:
  /// `store` may be null: then there is only the recording, and that only if the plan names one.
  /// @throws core::EnvironmentLacks when plan.recording cannot be written
  AttemptLog(training::Store* store, Session& session, const AttemptPlan& plan);
  /// An attempt that nobody ended was aborted.
  ~AttemptLog();
  AttemptLog(const AttemptLog&) = delete;
  AttemptLog& operator=(const AttemptLog&) = delete;

  /// Closes the recording with the result and completes the row. The result gets "attempt" (number, uuid, mode, state,
  /// times) and, if there is something to tell, "notices". Where the simulation failed the state is not_assessed,
  /// whatever `how` says. May be called once; later calls do nothing.
  void end(Json& result, training::AttemptState how);

  /// What the trainee should know at once: the disk is full, the store cannot be written, the simulation is limited.
  /// Empty: all is well. Cheap.
  std::string warning() const;
  /// Everything that was said about keeping this attempt.
  const std::vector<std::string>& notices() const { return m_notices; }
  const training::Attempt& attempt() const { return m_attempt; }

 private:
  void place_recording(const AttemptPlan& plan);
  bool try_to_record(const std::filesystem::path& path);
  void notice(const std::string& text);
  void take_notices();

  training::Store* m_store;
  Session& m_session;
  training::Attempt m_attempt;
  training::AttemptLock m_lock;
  std::vector<std::string> m_notices;
  std::size_t m_notices_taken = 0;
  bool m_ended = false;
};

/// What `--input` means for the attempt: a demonstration or a replay is no attempt of the trainee, everything else is.
/// A familiarisation that is done again stays one.
training::AttemptMode mode_of_input(const std::string& input);

/// "2026-03-01T14:05:09Z"
std::string utc_now();

}  // namespace trocar::attempt
