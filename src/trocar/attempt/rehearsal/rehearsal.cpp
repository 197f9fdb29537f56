#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <new>

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <trocar/attempt/interrupt.hpp>
#include <trocar/attempt/rehearsal/rehearsal.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/training/expert/performer.hpp>

namespace trocar::attempt {
namespace {

constexpr size_t kMostKept = 2000;           // choices that are not as written, and failures that are remembered
constexpr int kSucceeded = 0, kFailed = 1;   // how a process ends
constexpr double kBack = 5, kFarther = 1.4;  // [s] before a failure it is taken up again; as much further each time
constexpr double kSamePoint = 10;            // [s]: failures that have the same reason, as far as one can tell

/// What all processes see. Only one of them runs at a time: the others wait for it.
struct Blackboard {
  bool succeeded = false;
  double seconds = 0, score = 0;  ///< [s] simulated in all
  double lasted = -1;             ///< the attempt that came farthest [s]
  double back_to = 0;             ///< where it is taken up again [s]
  int attempts = 1;
  size_t failures = 0, choices = 0;
  std::array<double, kMostKept> failed_at{};  ///< [s]
  std::array<training::Choice, kMostKept> choice{};
  std::array<char, 400> obstacle{};
};

class SharedBlackboard {
 public:
  SharedBlackboard() {
    void* place = mmap(nullptr, sizeof(Blackboard), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (place == MAP_FAILED) throw core::EnvironmentLacks("no shared memory available: close other programs");
    m_board = new (place) Blackboard;
  }
  ~SharedBlackboard() { munmap(m_board, sizeof(Blackboard)); }
  SharedBlackboard(const SharedBlackboard&) = delete;
  SharedBlackboard& operator=(const SharedBlackboard&) = delete;
  Blackboard* operator->() const { return m_board; }

 private:
  Blackboard* m_board;
};

/// An attempt. At each decision point it becomes two: one that continues, and one that waits for what becomes of it.
class Attempt {
 public:
  Attempt(const Lesson& lesson, const Patience& patience, const SharedBlackboard& board)
      : m_lesson(lesson),
        m_patience(patience),
        m_board(board),
        m_state(sim::initial_state(lesson.model)),
        m_work(sim::make_work(lesson.model)),
        m_monitor(lesson.monitor()),
        m_known(choices_of(lesson)),
        m_performer(lesson.model, training::read_demonstration(*lesson.exercise, lesson.model, lesson.seed),
                    {.tremor = {}, .perturbation = [this](int choice) { return perturbation(choice); }}) {
    for (const training::Choice& c : m_known) m_first = std::max(m_first, c.perturbation);
  }

  [[noreturn]] void run() {
    while (!m_performer.done() && !m_monitor->finished()) {
      const sim::StepReport report =
          sim::step(m_lesson.model, m_performer.next(m_lesson.model, m_state), m_state, m_work);
      m_performer.after(m_lesson.model, m_state, report);
      m_monitor->update(m_lesson.model, m_state, report);
      m_board->seconds += sim::kTick;
      if (!report.fine()) fail("the physics failed");
      if (m_state.tick % kLookEvery == 0) look();
      if (m_state.tick % kTellEvery == 0)
        fmt::print(
            stderr, "{}",
            tr("rehearsal: {:.0f} s, \"{}\" ({:.0f} s simulated)\n", now(), m_performer.goal(), m_board->seconds));
    }
    look();
    if (!m_monitor->score().passed) fail(tr("{:.0f} points are below the pass mark", m_monitor->score().total));
    m_board->succeeded = true;
    m_board->score = m_monitor->score().total;
    keep("");
    _exit(kSucceeded);
  }

 private:
  static constexpr std::uint64_t kLookEvery = 100, kTellEvery = 20'000;  // ticks

  double now() const { return double(m_state.tick) * sim::kTick; }
  bool spent() const {
    return m_board->seconds >= m_patience.seconds || m_board->failures >= kMostKept || interrupted();
  }

  /// The process in which this returns continues with that perturbation; the process that called ends here.
  int perturbation(int choice) {
    for (int chosen = known_at(choice); !spent(); chosen = m_first + m_board->attempts++) {
      std::fflush(nullptr);
      const pid_t copy = fork();
      if (copy < 0) fail("no more processes");
      if (copy == 0) {
        if (chosen != 0) m_choices.push_back({choice, chosen});
        return chosen;
      }
      int status = 0;
      waitpid(copy, &status, 0);
      if (WIFEXITED(status) && WEXITSTATUS(status) == kSucceeded) _exit(kSucceeded);
      if (now() > m_board->back_to && choice > 0) break;
      fmt::print(stderr, "{}", tr("rehearsal: {:.0f} s: again, from \"{}\"\n", now(), m_performer.goal()));
    }
    _exit(kFailed);
  }

  static training::Choices choices_of(const Lesson& lesson) {
    const training::RecordedChoices* before = lesson.exercise->recorded_choices_for(lesson.seed);
    return before ? before->choices : training::Choices{};
  }
  int known_at(int choice) const {
    for (const training::Choice& c : m_known)
      if (c.at == choice) return c.perturbation;
    return 0;
  }

  void look() {
    if (spent()) fail("the time limit is reached");
    const std::vector<training::ErrorMade>& errors = m_monitor->errors();
    double points = 0;
    for (const training::ErrorMade& e : errors) points += e.points;
    const bool failed = std::any_of(errors.begin(), errors.end(), [](const training::ErrorMade& e) { return e.fail; });
    if (failed || points > m_patience.points) fail(what_went_wrong(errors));
    const bool in_vain = m_patience.at_first && !m_performer.difficulties().empty();
    if (in_vain || m_performer.gave_up())
      fail(m_performer.difficulties().empty() ? "given up" : m_performer.difficulties().back());
  }

  /// The errors of the last moments: the last one alone is often what another one led to.
  std::string what_went_wrong(const std::vector<training::ErrorMade>& errors) const {
    constexpr double kLately = 3;  // [s]
    std::string all;
    for (const training::ErrorMade& e : errors)
      if (e.at > now() - kLately) all += (all.empty() ? "" : ", ") + e.code + " " + e.name;
    return all;
  }

  [[noreturn]] void fail(const std::string& why) {
    fmt::print(stderr, "{}",
               tr("rehearsal: {:.0f} s, \"{}\": {} (of {:.0f} s)\n", now(), m_performer.goal(), why, m_board->seconds));
    std::fflush(nullptr);
    const double* const failed = m_board->failed_at.data();
    const auto before = std::count_if(failed, failed + m_board->failures,
                                      [this](double t) { return std::fabs(t - now()) < kSamePoint; });
    if (m_board->failures < kMostKept) m_board->failed_at[m_board->failures++] = now();
    m_board->back_to = now() - kBack * std::pow(kFarther, double(before));
    if (now() > m_board->lasted) keep(why);
    _exit(kFailed);
  }

  void keep(const std::string& obstacle) {
    m_board->lasted = now();
    m_board->choices = std::min(m_choices.size(), kMostKept);
    std::copy_n(m_choices.begin(), m_board->choices, m_board->choice.begin());
    std::snprintf(m_board->obstacle.data(), m_board->obstacle.size(), "%s", obstacle.c_str());
  }

  const Lesson& m_lesson;
  const Patience& m_patience;
  const SharedBlackboard& m_board;
  sim::State m_state;
  sim::Work m_work;
  std::unique_ptr<training::Monitor> m_monitor;
  training::Choices m_known;  ///< what was rehearsed before is tried first
  int m_first = 0;            ///< ways up to here have been tried then
  training::Performer m_performer;
  training::Choices m_choices;
};

}  // namespace

Rehearsal rehearse(const Lesson& lesson, const Patience& patience) {
  if (!lesson.exercise)
    throw core::BadInput({{{lesson.scene.string(), 0, 0}, "expected an exercise, got a scene without an exercise"}});
  static_cast<void>(
      training::read_demonstration(*lesson.exercise, lesson.model, lesson.seed));  // faults are reported here
  const SharedBlackboard board;
  std::fflush(nullptr);
  const pid_t first = fork();
  if (first < 0) throw core::EnvironmentLacks("cannot start a process for the rehearsal: close other programs");
  if (first == 0) {
    Attempt attempt(lesson, patience, board);
    attempt.run();
  }
  int status = 0;
  waitpid(first, &status, 0);
  return {board->succeeded,      {board->choice.begin(), board->choice.begin() + std::ptrdiff_t(board->choices)},
          board->score,          board->lasted,
          board->seconds,        board->attempts,
          board->obstacle.data()};
}

}  // namespace trocar::attempt
