// One attempt: Model, State and everybody who watches each tick (recorder, judge, path lengths). The window and the
// headless loop drive the same Session, so that drawing changes nothing.
//
//   Session session(lesson, threads);
//   AttemptLog log(&store, session, plan);          // recording and row in the session store
//   while (...) session.advance(input);
//   Json result = session.result(aborted);
//   log.end(result, how);
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <optional>

#include <trocar/attempt/lesson.hpp>
#include <trocar/attempt/solver_beside.hpp>
#include <trocar/core/parallel.hpp>
#include <trocar/sim/recording/recording.hpp>
#include <trocar/sim/stages/step.hpp>
#include <trocar/training/metrics/metrics.hpp>
#include <trocar/training/store/attempt.hpp>

namespace trocar::attempt {

/// Something worth a picture or a line in the log.
struct Moment {
  std::uint64_t tick = 0;
  std::string what;  ///< "grasped", "released", "slipped", "clipped", "clip-dropped", "cut", "step-done"
  int tool = -1;     ///< -1: none
  std::string text;  ///< for people: "grasper grasped left tube"
  std::string code = {}, hint = {};  ///< of an error: "A1.8", what to do instead
};

class Session {
 public:
  Session(const Lesson& lesson, int threads = core::default_thread_count());

  /// From now on every tick goes to this file, too; its header says whose attempt it is. AttemptLog calls this.
  /// @throws core::EnvironmentLacks
  void record(const std::filesystem::path& path, const training::Attempt& attempt);
  /// False: getting to know the exercise, without score and verdict. Before the first tick.
  void set_scored(bool scored);
  /// From now on that simulation gets the same inputs. Null: none. It must outlive the session's ticks.
  void run_beside(SolverBeside* beside) { m_beside = beside; }
  SolverBeside* beside() { return m_beside; }

  /// One tick. Does nothing more once the physics has failed (see broken()).
  const sim::StepReport& advance(const sim::Input& input);

  const Lesson& lesson() const { return m_lesson; }
  const sim::State& state() const { return m_state; }
  const training::Monitor* monitor() const { return m_monitor.get(); }  ///< null: free practice
  /// What happened in the last tick; usually empty.
  const std::vector<Moment>& moments() const { return m_moments; }
  /// Empty, or how the physics failed: the State is not to be trusted any more, and the result has no assessment.
  const std::string& broken() const { return m_broken; }
  bool finished() const { return !m_broken.empty() || (m_monitor && m_monitor->finished()); }
  /// Flags of all ticks so far; cells that are pushed open count when that has lasted for a second.
  std::uint32_t flags() const { return m_flags; }
  /// What of these flags limits the simulation, in words and with the remedy: each once, as standard error has it. May
  /// be read while another thread advances.
  std::vector<std::string> warnings() const;
  /// What a recording compares: the State's hash and all inputs so far (an input may leave no trace in the State).
  std::uint64_t mark() const;
  double path_length(int tool) const { return m_path[size_t(tool)]; }  ///< of its tip [m]

  /// What the result lacks because a list was full, in sentences; usually empty.
  Json not_recorded() const;
  /// The whole result as it stands; `interrupted` attempts have not passed.
  Json result(bool interrupted) const;
  /// Ends the recording with the result, on the disk when this returns. Empty, or why that is not so.
  std::string finish(const Json& result);
  /// Empty, or why nothing more is recorded (the disk is full). May be read while another thread advances.
  std::string recording_failure() const;
  /// The motion so far, as training::to_bytes() writes it.
  std::vector<std::uint8_t> trace_bytes() const;
  const training::Trace& trace() const { return m_trace.trace(); }

  /// What happened, for report and pictures: at most kMaxKept of the moments with how things looked then.
  struct KeptMoment {
    Moment moment;
    std::vector<std::uint8_t> display;  ///< sim::display_bytes; empty beyond the first kMaxLooks
  };
  const std::vector<KeptMoment>& kept_moments() const { return m_kept; }
  static constexpr std::size_t kMaxKept = 2000, kMaxLooks = 200;

 private:
  std::uint32_t lasting(std::uint32_t flags);
  void watch_tick();
  void fail();
  void warn_of(std::uint32_t flags);
  void collect_moments();
  void keep_moments();
  void note_failure();
  training::MetricsOptions metrics_options() const;
  void add_moment(const char* what, int tool, std::string text);

  const Lesson& m_lesson;
  core::ThreadPool m_pool;
  sim::State m_state;
  sim::Work m_work;
  sim::StepReport m_report;
  std::unique_ptr<training::Monitor> m_monitor;
  std::vector<char> m_steps_done;
  std::size_t m_errors_told = 0;
  std::array<bool, sim::kMaxTools> m_closed_empty{};
  std::unique_ptr<sim::RecordingWriter> m_writer;
  std::filesystem::path m_recording;
  mutable std::mutex m_failure_lock;
  std::string m_recording_failure;
  std::vector<std::string> m_warnings;
  bool m_scored = true;
  SolverBeside* m_beside = nullptr;
  training::TraceRecorder m_trace;
  double m_exercise_from = -1;  ///< simulated time at which the exercise's clock began; below 0: not yet [s]
  std::vector<KeptMoment> m_kept;
  std::vector<Moment> m_moments;
  std::array<Vec3d, sim::kMaxTools> m_tip;
  std::array<double, sim::kMaxTools> m_path{};
  std::array<int, std::size(sim::kEventWords) + 1> m_counts{};  ///< by sim::Event::Kind
  std::uint32_t m_flags = 0;
  bool m_moments_lost = false;       ///< more than kMaxKept
  std::uint64_t m_inverted_for = 0;  ///< ticks in a row in which cells have been pushed open
  std::uint64_t m_inputs_hash = 0;
  std::string m_broken;
};

/// Nobody's recording is lost: one that is there keeps its content under another name, which is returned.
/// @throws core::EnvironmentLacks where that is not possible
std::filesystem::path keep_older(const std::filesystem::path& path);

/// Names of the flags that are set: "inverted_cells", "too_many_loads", ...
std::vector<std::string> flag_names(std::uint32_t flags);

}  // namespace trocar::attempt
