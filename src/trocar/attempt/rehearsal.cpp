#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <new>
#include <utility>

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <trocar/attempt/interrupt.hpp>
#include <trocar/attempt/rehearsal.hpp>
#include <trocar/core/error.hpp>
#include <trocar/training/expert/performer.hpp>

namespace trocar::attempt {
namespace {

constexpr size_t kMostParts = 512;
constexpr int kCameOff = 0, kFailed = 1;  // how a process ends

/// What all processes see. Only one of them runs at a time: the others wait for it.
struct Blackboard {
  double seconds = 0, score = 0, lasted = 0;
  int tries = 0;
  bool came_off = false;
  size_t parts = 0;
  std::array<int, kMostParts> ways{};
  double farthest = -1;  ///< [s] of the attempt that came farthest
  std::array<char, 400> why{};
};

class SharedBlackboard {
 public:
  SharedBlackboard() {
    void* place = mmap(nullptr, sizeof(Blackboard), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (place == MAP_FAILED) throw core::EnvironmentLacks("no memory that processes share: close other programs");
    m_board = new (place) Blackboard;
  }
  ~SharedBlackboard() { munmap(m_board, sizeof(Blackboard)); }
  SharedBlackboard(const SharedBlackboard&) = delete;
  SharedBlackboard& operator=(const SharedBlackboard&) = delete;
  Blackboard* operator->() const { return m_board; }

 private:
  Blackboard* m_board;
};

/// One process' attempt. Where a part begins it becomes as many as there are ways.
class Attempt {
 public:
  Attempt(const Lesson& lesson, const Patience& patience, const SharedBlackboard& board)
      : m_lesson(lesson),
        m_patience(patience),
        m_board(board),
        m_state(sim::initial_state(lesson.model)),
        m_work(sim::make_work(lesson.model)),
        m_monitor(lesson.monitor()),
        m_performer(lesson.model, training::read_demonstration(*lesson.exercise, lesson.model, lesson.seed),
                    {.tremor = {}, .way = [this](size_t part) { return branch(part); }}) {}

  [[noreturn]] void run() {
    while (!m_performer.done()) {
      const sim::StepReport& report =
          sim::step(m_lesson.model, m_performer.next(m_lesson.model, m_state), m_state, m_work);
      m_performer.after(m_lesson.model, m_state, report);
      m_monitor->update(m_lesson.model, m_state, report);
      m_board->seconds += sim::kTick;
      if (!report.fine()) end_badly("the physics failed");
      if (m_state.tick % kLookEvery == 0) look();
      if (m_monitor->finished()) break;
    }
    look();
    if (!m_monitor->score().passed) end_badly(fmt::format("{:.0f} points are no pass", m_monitor->score().total));
    m_board->came_off = true;
    m_board->score = m_monitor->score().total;
    m_board->lasted = now();
    m_board->parts = m_ways.size();
    std::copy(m_ways.begin(), m_ways.end(), m_board->ways.begin());
    _exit(kCameOff);
  }

 private:
  static constexpr std::uint64_t kLookEvery = 100;  // ticks

  double now() const { return double(m_state.tick) * sim::kTick; }
  double points() const {
    double all = 0;
    for (const training::ErrorMade& e : m_monitor->errors()) all += e.points;
    return all;
  }
  bool failed() const {
    const auto fails = [](const training::ErrorMade& e) { return e.fail; };
    return std::any_of(m_monitor->errors().begin(), m_monitor->errors().end(), fails);
  }
  bool spent() const { return m_board->seconds >= m_patience.seconds || interrupted(); }

  /// In the process that returns, the part is done in that way; the one that called never comes back.
  int branch(size_t part) {
    if (part >= kMostParts) end_badly("more parts than can be rehearsed");
    const int ways = m_performer.has_ways(part) ? m_patience.ways : 1;
    for (int way = 0; way < ways && !spent(); ++way) {
      ++m_board->tries;
      fmt::print(stderr, "rehearsal: {:.0f} s: part {} (\"{}\") in way {}\n", now(), part + 1, name_of(part), way);
      std::fflush(nullptr);
      const pid_t copy = fork();
      if (copy < 0) end_badly("no more processes");
      if (copy == 0) {
        m_ways.resize(part + 1);
        m_ways[part] = way;
        m_points = points();
        m_part = part;
        return way;
      }
      int status = 0;
      waitpid(copy, &status, 0);
      if (WIFEXITED(status) && WEXITSTATUS(status) == kCameOff) _exit(kCameOff);
    }
    _exit(kFailed);
  }

  void look() {
    if (spent()) end_badly("the time for it is spent");
    if (m_patience.demonstration > 0 && now() > m_patience.demonstration) end_badly("it took too long");
    if (failed() || points() - m_points > m_patience.points)
      end_badly(m_monitor->errors().back().code + " " + m_monitor->errors().back().name);
    if (m_performer.gave_up() || m_performer.failures() > m_patience.failures)
      end_badly(m_performer.difficulties().empty() ? "given up" : m_performer.difficulties().back());
  }

  [[noreturn]] void end_badly(const std::string& why) {
    fmt::print(stderr, "rehearsal: {:.0f} s: {}\n", now(), why);
    std::fflush(nullptr);
    if (now() > m_board->farthest) {
      m_board->farthest = now();
      const std::string all = fmt::format("part {} (\"{}\"), {:.0f} s: {}", m_part + 1, name_of(m_part), now(), why);
      std::snprintf(m_board->why.data(), m_board->why.size(), "%s", all.c_str());
    }
    _exit(kFailed);
  }

  std::string name_of(size_t part) const { return m_performer.name_of(part); }

  const Lesson& m_lesson;
  const Patience& m_patience;
  const SharedBlackboard& m_board;
  sim::State m_state;
  sim::Work m_work;
  std::unique_ptr<training::Monitor> m_monitor;
  training::Performer m_performer;
  training::Ways m_ways;
  size_t m_part = 0;
  double m_points = 0;  ///< that errors had cost when this part began
};

}  // namespace

Rehearsal rehearse(const Lesson& lesson, const Patience& patience) {
  if (!lesson.exercise)
    throw core::BadInput({{{lesson.scene.string(), 0, 0}, "expected an exercise to be rehearsed, got a bare scene"}});
  static_cast<void>(training::read_demonstration(*lesson.exercise, lesson.model, lesson.seed));  // faults are told here
  const SharedBlackboard board;
  std::fflush(nullptr);
  const pid_t first = fork();
  if (first < 0) throw core::EnvironmentLacks("no process for the rehearsal: close other programs");
  if (first == 0) {
    Attempt attempt(lesson, patience, board);
    attempt.run();
  }
  int status = 0;
  waitpid(first, &status, 0);
  Rehearsal r;
  r.passed = board->came_off;
  r.ways.assign(board->ways.begin(), board->ways.begin() + std::ptrdiff_t(board->parts));
  r.score = board->score;
  r.lasted = board->lasted;
  r.seconds = board->seconds;
  r.tries = board->tries;
  r.farthest = board->why.data();
  return r;
}

}  // namespace trocar::attempt
