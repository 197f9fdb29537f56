#include <algorithm>
#include <chrono>
#include <cstring>
#include <list>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <trocar/attempt/team/host.hpp>
#include <trocar/attempt/team/message.hpp>
#include <trocar/attempt/team/sealed_link.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/sim/recording/recording.hpp>

namespace trocar::attempt {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kRound{4};                         // the network is looked at so often
constexpr milliseconds kSilent{1500};                     // who says nothing for so long is away
constexpr milliseconds kGreetingTime{3000};               // to show that one has the token
constexpr std::size_t kStrangers = 8;                     // at a time
constexpr std::uint64_t kMostLag = 400, kCaughtUp = 100;  // ticks that somebody may be behind; and then again
constexpr std::size_t kHashesKept = 64;

/// Listens there. @throws core::EnvironmentLacks
int listening_at(const std::string& address, int port) {
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(std::uint16_t(port));
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const int on = 1;
  if (socket >= 0) setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (socket < 0 || inet_pton(AF_INET, address.c_str(), &at.sin_addr) != 1 ||
      bind(socket, reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0 || listen(socket, 8) != 0) {
    const std::string why = std::strerror(errno);
    if (socket >= 0) close(socket);
    throw core::EnvironmentLacks(
        tr("cannot listen at {}:{} ({}): give this machine's address and a port that is "
           "free, port 0 finds one",
           address, port, why));
  }
  return socket;
}

int port_of(int socket) {
  sockaddr_in at{};
  socklen_t size = sizeof at;
  getsockname(socket, reinterpret_cast<sockaddr*>(&at), &size);
  return ntohs(at.sin_port);
}

}  // namespace

struct TeamHost::Desk {
  struct Seat {
    TeamSeat shown;
    sim::Input share;
    std::uint64_t number = 0, sent_us = 0;  ///< of the newest share
    bool catching_up = false;
    std::unique_ptr<SealedLink> link;
    Clock::time_point heard;
    std::uint64_t told = 0;  ///< ticks
    bool told_waits = false;
  };
  struct Stranger {
    std::unique_ptr<SealedLink> link;
    Clock::time_point since;
  };
  struct Hash {
    std::uint64_t tick = 0, hash = 0;
  };

  Desk(const Lesson& l, const TeamPlan& plan)
      : lesson(l), token(plan.token), smooth(l.model.start), target(l.model.start) {
    if (token.empty()) token = random_token();
    for (const std::string& role : plan.roles) {
      Seat& seat = seats.emplace_back();
      seat.shown.role = role;
      seat.shown.duty = duty_of(role, l.model, "--team");
      seat.share = l.model.start;
      for (const Seat& other : seats)
        if (&other != &seat && other.shown.duty.overlaps(seat.shown.duty))
          throw core::BadInput(
              {{{"--team", 0, 0},
                tr("expected participants with different roles, got {} and {}", other.shown.role, role)}});
    }
    listener = listening_at(plan.address, plan.port);
    update_ready();
    thread = std::thread([this] { loop(); });
  }
  ~Desk() {
    stop = true;
    thread.join();
    ::close(listener);
  }

  // --- the network's thread ---

  void loop() {
    while (!stop || (clean && flushing())) {
      wait_for_something();
      welcome_strangers();
      const std::lock_guard hold(lock);
      hear_strangers();
      for (Seat& seat : seats) attend(seat);
      keep_pending();
      for (Seat& seat : seats) tell(seat);
      update_ready();
    }
  }

  /// Is there something that they have not received yet?
  bool flushing() {
    const std::lock_guard hold(lock);
    return Clock::now() < flush_until &&
           std::any_of(seats.begin(), seats.end(), [](const Seat& s) { return s.link && s.link->wants_to_write(); });
  }

  void wait_for_something() {
    std::vector<pollfd> who{{listener, POLLIN, 0}};
    const auto add = [&](const SealedLink* link) {
      if (link && link->open())
        who.push_back({link->socket(), short(POLLIN | (link->wants_to_write() ? POLLOUT : 0)), 0});
    };
    for (const Seat& seat : seats) add(seat.link.get());
    for (const Stranger& s : strangers) add(s.link.get());
    poll(who.data(), who.size(), int(kRound.count()));
  }

  void welcome_strangers() {
    for (int socket; (socket = accept(listener, nullptr, nullptr)) >= 0;) {
      if (strangers.size() >= kStrangers) strangers.pop_front();  // who came first had the most time
      strangers.push_back({std::make_unique<SealedLink>(socket, SealedLink::Side::host, token), Clock::now()});
    }
  }

  /// Who says with the token which role it has gets that seat.
  void hear_strangers() {
    for (auto s = strangers.begin(); s != strangers.end();) {
      s->link->exchange();
      core::ByteString bytes;
      const bool spoke = s->link->take(bytes);
      if (spoke) seat(std::move(s->link), bytes);
      const bool gone = spoke || !s->link->open() || Clock::now() - s->since > kGreetingTime;
      s = gone ? strangers.erase(s) : std::next(s);
    }
  }

  void seat(std::unique_ptr<SealedLink> link, core::ByteView bytes) {
    const std::optional<message::Message> first = message::decoded(bytes);
    const auto* hello = first ? std::get_if<message::Hello>(&*first) : nullptr;
    if (!hello) return;
    const auto refuse = [&](const std::string& why) {
      link->send(message::coded(message::End{why}));
      link->exchange();
    };
    const auto at =
        std::find_if(seats.begin(), seats.end(), [&](const Seat& s) { return s.shown.role == hello->role; });
    if (hello->version != TROCAR_VERSION)
      return refuse(
          tr("the host runs Trocar {}, this is {}: both versions must be equal", TROCAR_VERSION, hello->version));
    if (at == seats.end()) return refuse(tr("this exercise has no role {}", hello->role));
    if (at->shown.here) return refuse(tr("the role {} is already taken", hello->role));
    if (hello->ticks > made) return refuse("it is ahead of the host: restart it");
    at->link = std::move(link);
    at->heard = Clock::now();
    at->shown.here = true;
    at->shown.ticks = at->told = hello->ticks;
    at->catching_up = true;
    at->told_waits = false;
    at->number = 0;
    at->link->send(message::coded(message::Attempt{lesson.name, TROCAR_VERSION, lesson.seed, lesson.model.hash}));
  }

  void attend(Seat& seat) {
    if (!seat.link) return;
    seat.link->exchange();
    for (core::ByteString bytes; seat.link->take(bytes);) {
      seat.heard = Clock::now();
      const std::optional<message::Message> m = message::decoded(bytes);
      if (!m) {
        seat.link->close("it sent an invalid message");
      } else if (const auto* share = std::get_if<message::Share>(&*m)) {
        copy(seat.shown.duty, share->input, seat.share);
        seat.number = share->number, seat.sent_us = share->sent_us;
      } else if (const auto* done = std::get_if<message::Done>(&*m)) {
        note(seat, *done);
      }
    }
    if (!seat.link->open() || Clock::now() - seat.heard > kSilent) {
      seat.link.reset();
      seat.shown.here = false;
    }
  }

  /// How far it is, and whether it came to the same.
  void note(Seat& seat, const message::Done& done) {
    if (done.ticks > made) return seat.link->close("it counts ticks that do not exist");
    seat.shown.ticks = std::max(seat.shown.ticks, done.ticks);
    if (done.latency_us > 0) seat.shown.latency = 1e-6 * double(done.latency_us);  // the result needs it afterwards
    const auto known = std::find_if(hashes.begin(), hashes.end(), [&](const Hash& h) { return h.tick == done.hashed; });
    if (done.hash == 0 || known == hashes.end() || known->hash == done.hash) return;
    seat.link->send(message::coded(message::End{"its simulation differs from the host's"}));
    seat.link->exchange();
    seat.link->close("its simulation differs from the host's");
  }

  /// What the simulation has made since goes to the log, in blocks of what one message carries.
  void keep_pending() {
    for (const sim::Input& input : pending) {
      if (blocks.empty() || blocks.back().count() == message::kMostTicks) blocks.emplace_back();
      blocks.back().add(input);
      recent.push_back(input);
      if (recent.size() > 2 * message::kMostTicks)
        recent.erase(recent.begin(), recent.begin() + std::ptrdiff_t(message::kMostTicks));
    }
    made += pending.size();
    pending.clear();
  }

  void tell(Seat& seat) {
    if (!seat.link) return;
    while (seat.told < made && seat.link->open() && seat.told < seat.shown.ticks + 4 * message::kMostTicks)
      tell_ticks(seat);
    const bool waits = !waiting.empty();
    if (waits != seat.told_waits) seat.link->send(message::coded(message::Waits{waiting}));
    seat.told_waits = waits;
    seat.link->exchange();
  }

  /// The next ticks it does not know, up to a block's end.
  void tell_ticks(Seat& seat) {
    message::Ticks ticks{.first = seat.told, .inputs = {}, .number = seat.number, .sent_us = seat.sent_us};
    const std::uint64_t kept_from = made - recent.size();
    if (seat.told >= kept_from) {
      const std::uint64_t count = std::min(made - seat.told, message::kMostTicks);
      const auto from = recent.begin() + std::ptrdiff_t(seat.told - kept_from);
      ticks.inputs.assign(from, from + std::ptrdiff_t(count));
    } else {
      const std::uint64_t block = seat.told / message::kMostTicks, within = seat.told % message::kMostTicks;
      sim::InputCode& code = blocks[block];
      static_cast<void>(sim::append_inputs(code.bytes(), code.count(), ticks.inputs));
      ticks.inputs.erase(ticks.inputs.begin(), ticks.inputs.begin() + std::ptrdiff_t(within));
    }
    seat.told += ticks.inputs.size();
    seat.link->send(message::coded(ticks));
  }

  void update_ready() {
    std::string why;
    for (Seat& seat : seats) {
      const std::uint64_t lag = made - std::min(made, seat.shown.ticks);
      seat.catching_up = seat.catching_up ? lag > kCaughtUp : lag > kMostLag;
      if (!seat.shown.here)
        why = fmt::format(fmt::runtime(made == 0 ? "the {} has not connected yet" : "the {} is disconnected"),
                          seat.shown.role);
      else if (seat.catching_up && why.empty())
        why = tr("the {} is {:.1f} s behind", seat.shown.role, double(lag) * sim::kTick);
    }
    waiting = why;
    is_ready.store(why.empty(), std::memory_order_release);
  }

  const Lesson& lesson;
  std::string token;
  int listener = -1;
  std::atomic<bool> stop{false}, clean{false}, is_ready{false};
  Clock::time_point flush_until;

  mutable std::mutex lock;  // for all that follows; held for microseconds
  std::list<Seat> seats;
  std::vector<sim::Input> pending;  ///< ticks made and not yet kept
  std::vector<Hash> hashes;         ///< the last ones
  std::string waiting;

  std::vector<sim::InputCode> blocks;  ///< of everything so far, kMostTicks each
  std::vector<sim::Input> recent;      ///< the newest of it
  std::uint64_t made = 0;
  SmoothInput smooth;
  sim::Input target;

  std::list<Stranger> strangers;  ///< the network thread's own
  std::thread thread;             // last: begins when all else is there
};

TeamHost::TeamHost(const Lesson& lesson, const TeamPlan& plan) : m_desk(std::make_unique<Desk>(lesson, plan)) {}
TeamHost::~TeamHost() = default;

int TeamHost::port() const { return port_of(m_desk->listener); }
const std::string& TeamHost::token() const { return m_desk->token; }
bool TeamHost::ready() const { return m_desk->is_ready.load(std::memory_order_acquire); }

std::string TeamHost::waits_for() const {
  const std::lock_guard hold(m_desk->lock);
  return m_desk->waiting;
}

std::vector<TeamSeat> TeamHost::seats() const {
  const std::lock_guard hold(m_desk->lock);
  std::vector<TeamSeat> all;
  for (const Desk::Seat& seat : m_desk->seats) all.push_back(seat.shown);
  return all;
}

void TeamHost::lead(sim::Input& input) {
  Desk& desk = *m_desk;
  const std::lock_guard hold(desk.lock);
  for (const Desk::Seat& seat : desk.seats) copy(seat.shown.duty, seat.share, desk.target);
  const sim::Input smooth = desk.smooth.step(desk.target);
  for (const Desk::Seat& seat : desk.seats) copy(seat.shown.duty, smooth, input);
}

void TeamHost::made(const sim::State& state, const sim::Input& input) {
  const bool marked = state.tick % sim::kHashEvery == 0;
  const std::uint64_t hash = marked ? sim::hash_of(state) : 0;
  const std::lock_guard hold(m_desk->lock);
  m_desk->pending.push_back(input);
  if (!marked) return;
  if (m_desk->hashes.size() == kHashesKept) m_desk->hashes.erase(m_desk->hashes.begin());
  m_desk->hashes.push_back({state.tick, hash});
}

void TeamHost::end(const std::string& why) {
  {
    const std::lock_guard hold(m_desk->lock);
    m_desk->flush_until = Clock::now() + std::chrono::seconds(1);
    m_desk->keep_pending();
    for (Desk::Seat& seat : m_desk->seats) {
      if (!seat.link) continue;
      while (seat.told < m_desk->made && seat.link->open()) m_desk->tell_ticks(seat);
      seat.link->send(message::coded(message::End{why}));
    }
  }
  m_desk->clean = true;
  m_desk->stop = true;
}

std::string HostedSource::waits_for() const {
  const std::string team = m_team.waits_for();
  return team.empty() ? m_own.waits_for() : team;
}

bool HostedSource::next(const sim::State& state, sim::Input& input) {
  if (!m_own.next(state, input)) return false;
  m_team.lead(input);
  m_input = input;
  return true;
}

void HostedSource::after(const sim::State& state, const sim::StepReport& report) {
  m_own.after(state, report);
  m_team.made(state, m_input);
}

Json HostedSource::describe() const {
  Json told = m_own.describe();
  Json team = Json::array();
  for (const TeamSeat& seat : m_team.seats())
    team.push_back({{"role", seat.role}, {"latency_ms", 1000 * seat.latency}, {"ticks", seat.ticks}});
  told["team"] = std::move(team);
  return told;
}

}  // namespace trocar::attempt
