#include <iterator>

#include <trocar/attempt/live.hpp>
#include <trocar/core/tick.hpp>

namespace trocar::attempt {
namespace {

constexpr auto kTickTime = std::chrono::microseconds(1'000'000 / core::kTicksPerSecond);
constexpr auto kDebt = std::chrono::milliseconds(30);  // that much is caught up with; more becomes slow motion
constexpr std::uint64_t kAftermath = 1500;             // ticks shown after the last step is done
constexpr std::uint64_t kHurry = 30;                   // ticks that wait to be made: no pace is kept
constexpr double kSpeedWindow = 0.25;                  // [s]
constexpr double kSlow = 0.97;
constexpr auto kIdle = std::chrono::milliseconds(2);  // while paused
// A copy takes nearly half a tick and throws the simulation's data out of the cache: none is made that nobody draws.
constexpr auto kAskerPatience = std::chrono::milliseconds(4);  // of who asked for one
constexpr auto kAskEvery = std::chrono::microseconds(50);

}  // namespace

Live::Live(Session& session, InputSource& source, std::uint64_t limit)
    : m_session(session),
      m_source(source),
      m_limit(limit),
      m_published(Snapshot{.state = session.state()}),
      m_window_start(Clock::now()),
      m_thread([this] { loop(); }) {}

void Live::stop() {
  m_stop.store(true);
  if (m_thread.joinable()) m_thread.join();
}

bool Live::refresh() {
  const bool runs =
      !m_paused.load(std::memory_order_relaxed) && !m_stop.load(std::memory_order_relaxed) && !snapshot().finished;
  m_wanted.store(true, std::memory_order_release);
  const Clock::time_point until = Clock::now() + (runs ? kAskerPatience : Clock::duration(0));
  while (!m_published.refresh()) {
    if (Clock::now() >= until) return false;
    std::this_thread::sleep_for(kAskEvery);
  }
  return true;
}

double Live::slow_share() const { return m_ticks > 0 ? double(m_slow_ticks) / double(m_ticks) : 0.0; }

std::vector<Moment> Live::take_moments() {
  const std::lock_guard lock(m_moments_lock);
  return std::exchange(m_moments, {});
}

void Live::loop() {
  Clock::time_point due = Clock::now();
  while (!m_stop.load(std::memory_order_relaxed)) {
    if (m_paused.load(std::memory_order_relaxed) || m_finished || !m_source.ready()) {
      pass_moments();
      publish_if_wanted();
      std::this_thread::sleep_for(kIdle);
      due = m_window_start = Clock::now();
      m_window_ticks = 0;
      continue;
    }
    sim::Input input;
    m_finished = !m_source.next(m_session.state(), input);
    if (!m_finished) {
      const sim::StepReport& report = m_session.advance(input);
      m_pending.insert(m_pending.end(), m_session.moments().begin(), m_session.moments().end());
      m_source.after(m_session.state(), report);
      const std::uint64_t ticks = m_session.state().tick;
      if (m_session.finished() && m_end == kNever) m_end = m_session.broken().empty() ? ticks + kAftermath : ticks;
      m_finished = ticks >= m_end || (m_limit > 0 && ticks >= m_limit);
    }
    pass_moments();
    measure_speed();
    if (m_finished) publish();
    publish_if_wanted();
    due += kTickTime;
    const Clock::time_point now = Clock::now();
    if (m_source.behind() > kHurry)
      due = now;
    else if (due > now)
      std::this_thread::sleep_until(due);
    else if (now - due > kDebt)
      due = now;
  }
  publish();
  const std::lock_guard last(m_moments_lock);
  std::move(m_pending.begin(), m_pending.end(), std::back_inserter(m_moments));
  m_pending.clear();
}

void Live::measure_speed() {
  ++m_ticks;
  ++m_window_ticks;
  const double took = std::chrono::duration<double>(Clock::now() - m_window_start).count();
  if (took < kSpeedWindow) return;
  m_speed = double(m_window_ticks) * sim::kTick / took;
  if (m_speed < kSlow) m_slow_ticks += m_window_ticks;
  m_window_ticks = 0;
  m_window_start = Clock::now();
}

void Live::publish_if_wanted() {
  if (m_wanted.exchange(false, std::memory_order_acq_rel)) publish();
}

void Live::publish() {
  Snapshot& s = m_published.next();
  s.state = m_session.state();
  if (const training::Monitor* monitor = m_session.monitor()) {
    for (std::size_t i = 0; i < monitor->steps().size() && i < s.step_done.size(); ++i) {
      s.step_done[i] = monitor->steps()[i].done;
      s.step_missed[i] = monitor->steps()[i].missed;
    }
    s.current_step = monitor->current();
    s.nearness = training::nearness_of(monitor->rules(), s.current_step, {m_session.lesson().model, s.state});
    s.seconds = monitor->seconds();
  } else {
    s.seconds = double(s.state.tick) * sim::kTick;
  }
  if (SolverBeside* beside = m_session.beside()) {
    s.beside_skin = beside->skin();
    s.beside_outline = beside->outline();
  }
  s.speed = m_speed;
  s.finished = m_finished;
  m_published.publish();
}

/// Moments are rare. The drawing thread holds the lock only to swap a vector; if it does just now, next tick will do.
void Live::pass_moments() {
  if (m_pending.empty() || !m_moments_lock.try_lock()) return;
  std::move(m_pending.begin(), m_pending.end(), std::back_inserter(m_moments));
  m_pending.clear();
  m_moments_lock.unlock();
}

}  // namespace trocar::attempt
