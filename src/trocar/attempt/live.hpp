// The simulation on a thread of its own, paced by the clock: 1000 ticks a second. It is never waited for, and a machine
// that is too slow gets slow motion, never skipped ticks.
//
//   Live live(session, source);           // hands: a HandsSource
//   if (live.refresh()) draw(live.snapshot().state);      // copied when asked for, and as it ends
//   live.stop();                          // joins; then the Session may be used again
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

#include <trocar/attempt/session.hpp>
#include <trocar/core/triple_buffer.hpp>
#include <trocar/training/exercise/step_nearness.hpp>

namespace trocar::attempt {

/// What the drawing thread sees of the attempt.
struct Snapshot {
  sim::State state;
  std::array<bool, training::kMaxSteps> step_done{}, step_missed{};  ///< an exercise has no more
  int current_step = 0;
  std::vector<training::Nearness> nearness = {};  ///< of the current step
  double seconds = 0;                             ///< on the exercise's clock
  double speed = 1;                               ///< simulated per real time in the last quarter of a second
  bool finished = false;  ///< the exercise is done, the source is dry, or the physics has failed
  std::vector<Vec3f> beside_skin = {}, beside_outline = {};  ///< of Session::beside(); empty: none runs
};

class Live {
 public:
  /// Starts at once. `source` and `session` must outlive it. @param limit ticks, 0: none
  Live(Session& session, InputSource& source, std::uint64_t limit);
  ~Live() { stop(); }
  Live(const Live&) = delete;
  Live& operator=(const Live&) = delete;

  void pause(bool on) { m_paused.store(on, std::memory_order_relaxed); }

  /// Asks for the State as it is now and has it a tick later. False, and snapshot() as it was, when nothing newer
  /// has come: a pause, or a tick takes longer than a few milliseconds (drawing thread only).
  bool refresh();
  const Snapshot& snapshot() const { return m_published.latest(); }
  /// What has happened since the last call.
  std::vector<Moment> take_moments();

  /// Ends the thread; afterwards slow_share() is final.
  void stop();
  /// Share of the ticks that ran below 0.97 of real time.
  double slow_share() const;

 private:
  void loop();
  void publish_if_wanted();
  void publish();
  void pass_moments();
  void measure_speed();

  using Clock = std::chrono::steady_clock;
  Session& m_session;
  InputSource& m_source;
  std::uint64_t m_limit;
  core::TripleBuffer<Snapshot> m_published;
  std::atomic<bool> m_stop{false}, m_paused{false}, m_wanted{false};

  // The simulation thread's own.
  static constexpr std::uint64_t kNever = ~std::uint64_t(0);
  bool m_finished = false;
  std::uint64_t m_end = kNever;  ///< the tick after which it is over
  double m_speed = 1;
  Clock::time_point m_window_start;
  std::uint64_t m_window_ticks = 0, m_slow_ticks = 0, m_ticks = 0;
  std::vector<Moment> m_pending;

  std::mutex m_moments_lock;
  std::vector<Moment> m_moments;
  std::thread m_thread;  // last: starts when all else is there
};

}  // namespace trocar::attempt
