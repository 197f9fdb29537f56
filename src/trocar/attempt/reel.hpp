// What the player knows of a recording beyond its keyframes, found out on a thread of its own: the recording's inputs
// are done again from the start, with the judge watching, and on the way the marks, the step guide's states and full
// States are kept. From those the exact State of any moment is a short way: the thread goes it whenever the player
// looks somewhere else.
//
//   Reel reel(lesson, recording, Reel::Options{});
//   reel.look_at(tick, playing);                       // each picture
//   reel.refresh();
//   if (reel.exact().tick == tick) draw(reel.exact()); else draw(footage.at(tick));
//
// A recording of another version of the physics is not done again; its keyframes and its result give marks and guide.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>

#include <trocar/attempt/kept_states.hpp>
#include <trocar/attempt/session.hpp>
#include <trocar/attempt/timeline.hpp>
#include <trocar/core/triple_buffer.hpp>
#include <trocar/sim/recording/recording.hpp>

namespace trocar::attempt {

/// The step guide from a tick on.
struct GuideState {
  std::uint64_t tick = 0;
  int current = 0;
  enum Status : char { kOpen, kDone, kMissed };
  std::vector<char> done;  ///< Status of each step
};

/// Everything found out so far, in order of time.
struct Findings {
  std::vector<TimelineMark> marks;
  std::vector<training::StepStatus> steps;  ///< names and hints
  std::vector<GuideState> guide;
  std::string difference;  ///< empty, or where doing it again came out differently than recorded

  /// The guide at a moment; null where it is not known.
  const GuideState* guide_at(std::uint64_t tick) const;
};

/// Marks and guide as the recording's own result reports them; nothing where it has none.
Findings findings_of_result(const std::string& result_json);

class Reel {
 public:
  struct Options {
    std::size_t budget = std::size_t(512) << 20;  ///< memory for full States [bytes]
    std::uint64_t spacing = 500;                  ///< between them at first [ticks]
    int threads = 0;                              ///< of the simulation; 0: all cores but one
  };

  /// Starts at once. Both references must outlive it.
  Reel(const Lesson& lesson, const sim::Recording& recording, const Options& options);
  ~Reel();
  Reel(const Reel&) = delete;
  Reel& operator=(const Reel&) = delete;

  /// Is the recording done again at all? Otherwise there are only keyframes.
  bool replays() const { return m_replays; }
  /// Ticks of the recording that can be shown.
  std::uint64_t last() const { return m_last; }

  /// The moment that is wanted now. While `playing` the next one is wanted soon, so what is far away is not chased.
  void look_at(std::uint64_t tick, bool playing);
  bool refresh() { return m_published.refresh(); }
  /// The newest exact State, of its own tick; before the first refresh() the start.
  const sim::State& exact() const { return m_published.latest(); }
  /// From here on doing it again differs from the recording: show keyframes. kNowhere: it does not, so far.
  std::uint64_t differs_from() const { return m_differs_from.load(std::memory_order_acquire); }

  /// How far it has been read [ticks].
  std::uint64_t known_until() const { return m_known.load(std::memory_order_acquire); }
  bool complete() const { return m_complete.load(std::memory_order_acquire); }
  /// Ticks between where the thread is and what look_at() asked for; 0: there.
  std::uint64_t way_to_go() const { return m_way.load(std::memory_order_relaxed); }
  std::size_t kept_bytes() const { return m_kept_bytes.load(std::memory_order_relaxed); }
  std::uint64_t spacing() const { return m_spacing.load(std::memory_order_relaxed); }

  /// Copies the findings where they are newer than `version`, which it then sets.
  bool findings(std::uint64_t& version, Findings& to) const;

  static constexpr std::uint64_t kNowhere = ~std::uint64_t(0);

 private:
  struct Explorer;  ///< the thread's own things
  void loop();
  void loop_keyframes();
  bool explore(Explorer& e);
  bool approach(Explorer& e, std::uint64_t target, bool playing);
  void note(Explorer& e);
  void publish(const sim::State& state);
  bool stopping() const { return m_stop.load(std::memory_order_relaxed); }

  const Lesson& m_lesson;
  const sim::Recording& m_recording;
  const Options m_options;
  const bool m_replays;
  const std::uint64_t m_last;
  core::TripleBuffer<sim::State> m_published;
  std::atomic<std::uint64_t> m_target{0}, m_known{0}, m_way{0}, m_differs_from{kNowhere};
  std::atomic<std::uint64_t> m_spacing{0};
  std::atomic<std::size_t> m_kept_bytes{0};
  std::atomic<bool> m_playing{false}, m_complete{false}, m_stop{false};

  mutable std::mutex m_lock;  ///< of the findings, and for the thread's sleep
  std::condition_variable m_wake;
  const Findings m_told;  ///< what the recording's result says: holds where the thread has not been yet
  Findings m_findings;
  std::uint64_t m_version = 1;
  std::thread m_thread;  // last: starts when all else is there
};

}  // namespace trocar::attempt
