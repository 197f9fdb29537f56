#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <mutex>
#include <thread>

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <trocar/attempt/team/member.hpp>
#include <trocar/attempt/team/sealed_link.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/devices/tcp_client.hpp>
#include <trocar/sim/recording/recording.hpp>

namespace trocar::attempt {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr milliseconds kLookEvery{4};
constexpr milliseconds kSayEvery{8};                           // where its part is wanted
constexpr milliseconds kSilence{2000};                         // of the host: gone
constexpr milliseconds kAgain{500};                            // between attempts to come back
constexpr seconds kFirstPatience{10};                          // with a host that does not listen yet
constexpr seconds kPatience{60};                               // with a host that is gone
constexpr double kNewest = 0.05;                               // what the newest latency counts in the mean
constexpr std::size_t kMostWaiting = 8 * message::kMostTicks;  // ticks not made yet

std::uint64_t microseconds() {
  return std::uint64_t(std::chrono::duration_cast<std::chrono::microseconds>(Clock::now().time_since_epoch()).count());
}

}  // namespace

struct TeamMember::Desk {
  explicit Desk(const MemberPlan& p) : plan(p), thread([this] { loop(); }) {}
  ~Desk() {
    stop = true;
    thread.join();
  }

  // --- the network's thread ---

  void loop() {
    while (!stop && !over()) {
      if (!link && !connect_again()) {
        std::this_thread::sleep_for(kAgain);
        continue;
      }
      pollfd who{link->socket(), short(POLLIN | (link->wants_to_write() ? POLLOUT : 0)), 0};
      poll(&who, 1, int(kLookEvery.count()));
      const std::lock_guard hold(lock);
      say();
      link->exchange();
      hear();
      if (!link->open() || Clock::now() - heard > kSilence) lose(link->why());
    }
    changed.notify_all();
  }

  bool over() {
    const std::lock_guard hold(lock);
    return !ended.empty();
  }

  /// One try; a while later when it fails.
  bool connect_again() {
    std::string why;
    const int socket = devices::connect_tcp(plan.address, plan.port, why);
    const std::lock_guard hold(lock);
    if (socket >= 0) {
      link = std::make_unique<SealedLink>(socket, SealedLink::Side::member, plan.token);
      waiting.clear();
      link->send(message::coded(message::Hello{plan.role, TROCAR_VERSION, first}));
      link->exchange();
      heard = Clock::now();
      return true;
    }
    if (Clock::now() - lost_at > (introduced ? kPatience : kFirstPatience))
      finish(tr("no host answers at {}:{} ({})", plan.address, plan.port, why));
    return false;
  }

  void lose(const std::string& why) {
    if (!introduced && !link->trusted()) finish(why.empty() ? "the host does not respond" : "the host refuses: " + why);
    link.reset();
    lost_at = Clock::now();
    host_waits = "the host does not answer";
  }

  void finish(const std::string& why) {
    if (ended.empty()) ended = why;
    changed.notify_all();
  }

  void hear() {
    for (core::ByteString bytes; link->take(bytes);) {
      heard = Clock::now();
      std::optional<message::Message> m = message::decoded(bytes);
      if (!m) return link->close("the host sent an invalid message");
      if (auto* ticks = std::get_if<message::Ticks>(&*m)) {
        keep(*ticks);
      } else if (const auto* waits = std::get_if<message::Waits>(&*m)) {
        host_waits = waits->why;
      } else if (const auto* end = std::get_if<message::End>(&*m)) {
        finish(end->why);
      } else if (const auto* a = std::get_if<message::Attempt>(&*m)) {
        if (introduced && (a->model_hash != attempt.model_hash || a->seed != attempt.seed))
          finish("the host has started another attempt");
        attempt = *a;
        introduced = true;
        host_waits.clear();
        changed.notify_all();
      }
    }
  }

  void keep(message::Ticks& ticks) {
    if (ticks.first != first + waiting.size() || waiting.size() > kMostWaiting) return link->close("ticks are missing");
    waiting.insert(waiting.end(), ticks.inputs.begin(), ticks.inputs.end());
    if (ticks.sent_us != 0 && ticks.number > echoed) {
      echoed = ticks.number;
      echo_tick = first + waiting.size();
      echo_sent = ticks.sent_us;
    }
  }

  /// Where its part is wanted, and how far it is.
  void say() {
    if (Clock::now() - said < kSayEvery || !introduced) return;
    said = Clock::now();
    link->send(message::coded(message::Done{done, hashed, std::exchange(hash, 0), std::uint64_t(1e6 * latency)}));
    if (has_share) link->send(message::coded(message::Share{++number, put_us, share}));
  }

  const MemberPlan plan;
  std::atomic<bool> stop{false};

  mutable std::mutex lock;  // for what follows
  std::condition_variable changed;
  message::Attempt attempt;
  bool introduced = false;
  std::string ended, host_waits;
  std::deque<sim::Input> waiting;  ///< ticks not made yet
  std::uint64_t first = 0;         ///< of them
  std::uint64_t done = 0, hashed = 0, hash = 0;
  bool has_share = false;
  sim::Input share;
  std::uint64_t put_us = 0;
  std::uint64_t number = 0, echoed = 0, echo_tick = 0, echo_sent = 0;
  double latency = 0;

  // The network thread's own.
  std::unique_ptr<SealedLink> link;
  Clock::time_point heard, said, lost_at = Clock::now();

  // The simulation thread's own.
  std::unique_ptr<InputSource> robot;
  sim::Input wish;
  Duty duty;
  std::thread thread;  // last: begins when all else is there
};

TeamMember::TeamMember(const MemberPlan& plan) : m_desk(std::make_unique<Desk>(plan)) {
  std::unique_lock hold(m_desk->lock);
  m_desk->changed.wait(hold, [this] { return m_desk->introduced || !m_desk->ended.empty(); });
  if (!m_desk->introduced)
    throw core::EnvironmentLacks(tr(
        "{}: ask the host of the exercise for address, port and token (`trocar train EXERCISE --team {}` shows them)",
        m_desk->ended, plan.role));
}
TeamMember::~TeamMember() = default;

const message::Attempt& TeamMember::attempt() const { return m_desk->attempt; }
const Duty& TeamMember::duty() const { return m_desk->duty; }
const std::string& TeamMember::role() const { return m_desk->plan.role; }

void TeamMember::begin(const Lesson& lesson) {
  if (lesson.model.hash != m_desk->attempt.model_hash)
    throw core::EnvironmentLacks(
        tr("{} differs from the host's (another hash of the compiled scene): both need the same files", lesson.name));
  m_desk->duty = duty_of(m_desk->plan.role, lesson.model, "--role");
  m_desk->wish = lesson.model.start;
}

void TeamMember::put(const sim::Input& input) {
  const std::lock_guard hold(m_desk->lock);
  m_desk->share = input;
  m_desk->put_us = microseconds();
  m_desk->has_share = true;
}

void TeamMember::follow(std::unique_ptr<InputSource> robot) { m_desk->robot = std::move(robot); }

bool TeamMember::ready() {
  const std::lock_guard hold(m_desk->lock);
  return !m_desk->waiting.empty() || !m_desk->ended.empty();
}

std::string TeamMember::waits_for() const {
  const std::lock_guard hold(m_desk->lock);
  return m_desk->waiting.empty() && m_desk->ended.empty() ? m_desk->host_waits : "";
}

std::uint64_t TeamMember::behind() const {
  const std::lock_guard hold(m_desk->lock);
  return m_desk->waiting.size();
}

bool TeamMember::next(const sim::State& state, sim::Input& input) {
  if (m_desk->robot) {
    if (m_desk->robot->next(state, m_desk->wish)) put(m_desk->wish);
  }
  const std::lock_guard hold(m_desk->lock);
  if (m_desk->waiting.empty()) return false;
  input = m_desk->waiting.front();
  m_desk->waiting.pop_front();
  ++m_desk->first;
  return true;
}

void TeamMember::after(const sim::State& state, const sim::StepReport& report) {
  if (m_desk->robot) m_desk->robot->after(state, report);
  const std::uint64_t hash = state.tick % sim::kHashEvery == 0 ? sim::hash_of(state) : 0;
  const std::lock_guard hold(m_desk->lock);
  m_desk->done = state.tick;
  if (hash != 0) m_desk->hashed = state.tick, m_desk->hash = hash;
  if (m_desk->echo_sent != 0 && state.tick >= m_desk->echo_tick) {
    const double took = 1e-6 * double(microseconds() - m_desk->echo_sent);
    m_desk->latency = m_desk->latency > 0 ? m_desk->latency + kNewest * (took - m_desk->latency) : took;
    m_desk->echo_sent = 0;
  }
}

Json TeamMember::describe() const {
  return {{"role", m_desk->plan.role}, {"latency_ms", 1000 * latency()}, {"ended", ended()}};
}

double TeamMember::latency() const {
  const std::lock_guard hold(m_desk->lock);
  return m_desk->latency;
}

std::string TeamMember::ended() const {
  const std::lock_guard hold(m_desk->lock);
  return m_desk->ended;
}

}  // namespace trocar::attempt
