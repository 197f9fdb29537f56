// Several programs at one attempt: what they lead, what travels, who gets in, and what happens when somebody leaves.
#include <chrono>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <trocar/attempt/hand_names.hpp>
#include <trocar/attempt/session.hpp>
#include <trocar/attempt/sources.hpp>
#include <trocar/attempt/team/host.hpp>
#include <trocar/attempt/team/member.hpp>
#include <trocar/attempt/team/sealed_link.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/random.hpp>

namespace trocar::attempt {
namespace {

using namespace std::chrono_literals;
using SteadyClock = std::chrono::steady_clock;

const Lesson& lesson() {
  static const std::unique_ptr<Lesson> one = load_lesson("gynaecology");
  return *one;
}

/// Until it holds, for ten seconds at most.
template <class Condition>
bool soon(Condition&& condition) {
  for (const auto end = SteadyClock::now() + 10s; SteadyClock::now() < end; std::this_thread::sleep_for(2ms))
    if (condition()) return true;
  return condition();
}

// --- who leads what ---

TEST(TeamDuty, TheCameraLeadsTheScopeAndNothingElse) {
  const Duty camera = duty_of("camera", lesson().model, "--role");
  sim::Input theirs = lesson().model.start, all = lesson().model.start;
  theirs.scope.yaw = 0.3f, theirs.tools[0].yaw = 0.2f, theirs.pedals = sim::kWipe | sim::kBlue;
  copy(camera, theirs, all);
  EXPECT_EQ(all.scope.yaw, 0.3f);
  EXPECT_EQ(all.tools[0].yaw, lesson().model.start.tools[0].yaw);
  EXPECT_EQ(all.pedals, std::uint32_t(sim::kWipe));
}

TEST(TeamDuty, AHandTakesTheValvesOfItsHandleAndNoOthers) {
  const Duty assistant = duty_of("assistant", lesson().model, "--role");
  EXPECT_EQ(assistant.hands, 4u);
  sim::Input theirs = lesson().model.start, all = lesson().model.start;
  theirs.pedals = sim::sucks(0) | sim::sucks(2) | sim::kBlue;
  all.pedals = sim::irrigates(2) | sim::irrigates(1);
  copy(assistant, theirs, all);
  EXPECT_EQ(all.pedals, sim::sucks(2) | sim::irrigates(1));
}

TEST(TeamDuty, LeftAndRightAreAsSeenFromTheEndoscope) {
  const std::array<int, 2> sides = sides_of(lesson().model);
  EXPECT_EQ(duty_of("left", lesson().model, "--role").hands, 1u << sides[0]);
  EXPECT_EQ(duty_of("right", lesson().model, "--role").hands, 1u << sides[1]);
  EXPECT_EQ(duty_of(lesson().model.hands[1].name, lesson().model, "--role").hands, 2u);
}

TEST(TeamDuty, WhatTheSceneHasNotIsRefusedWithWhatItHas) {
  try {
    static_cast<void>(duty_of("anaesthetist", lesson().model, "--role"));
    FAIL();
  } catch (const core::BadInput& bad) {
    EXPECT_NE(std::string(bad.what()).find(lesson().model.hands[0].name), std::string::npos);
    EXPECT_NE(std::string(bad.what()).find("camera"), std::string::npos);
  }
}

// --- what travels ---

message::Message through(const message::Message& m) {
  const std::optional<message::Message> back = message::decoded(message::coded(m));
  EXPECT_TRUE(back.has_value());
  return back.value_or(message::End{"lost"});
}

TEST(TeamMessage, EveryKindComesThroughAsItWas) {
  EXPECT_EQ(std::get<message::Hello>(through(message::Hello{"camera", "0.1", 77})).ticks, 77u);
  const auto done = std::get<message::Done>(through(message::Done{5, 4, 0xdeadbeefcafeull, 1234}));
  EXPECT_EQ(done.hash, 0xdeadbeefcafeull);
  EXPECT_EQ(done.latency_us, 1234u);
  const auto attempt = std::get<message::Attempt>(through(message::Attempt{"a/b", "0.1", 7, 8}));
  EXPECT_EQ(attempt.model_hash, 8u);
  EXPECT_EQ(std::get<message::Waits>(through(message::Waits{"why"})).why, "why");
  EXPECT_EQ(std::get<message::End>(through(message::End{"over"})).why, "over");
  message::Ticks ticks{10, {}, 3, 99};
  for (int i = 0; i < 700; ++i) {
    sim::Input input = lesson().model.start;
    input.scope.depth = float(i / 3) * 1e-3f;
    ticks.inputs.push_back(input);
  }
  const auto back = std::get<message::Ticks>(through(ticks));
  ASSERT_EQ(back.inputs.size(), ticks.inputs.size());
  EXPECT_EQ(std::memcmp(back.inputs.data(), ticks.inputs.data(), ticks.inputs.size() * sizeof(sim::Input)), 0);
}

TEST(TeamMessage, WhatIsCutOffTooLongOrNoNumberIsNone) {
  message::Share share{1, 2, lesson().model.start};
  const core::ByteString whole = message::coded(share);
  for (std::size_t n = 0; n < whole.size(); ++n) EXPECT_FALSE(message::decoded(core::ByteView(whole).first(n))) << n;
  core::ByteString more = whole;
  more.push_back(7);
  EXPECT_FALSE(message::decoded(more));
  share.input.scope.yaw = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(message::decoded(message::coded(share)));
  message::Ticks ticks;
  ticks.inputs.assign(message::kMostTicks + 1, lesson().model.start);
  EXPECT_FALSE(message::decoded(message::coded(ticks))) << "ticks without end take no memory";
}

// --- the sealed link ---

struct Pair {
  explicit Pair(const std::string& token_of_host, const std::string& token_of_member) {
    int sockets[2];
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, sockets), 0);
    host = std::make_unique<SealedLink>(sockets[0], SealedLink::Side::host, token_of_host);
    member = std::make_unique<SealedLink>(sockets[1], SealedLink::Side::member, token_of_member);
  }
  void exchange() {
    for (int i = 0; i < 4; ++i) host->exchange(), member->exchange();
  }
  std::unique_ptr<SealedLink> host, member;
};

TEST(SealedLink, CarriesMessagesBothWaysInTheirOrder) {
  Pair pair("token", "token");
  const core::ByteString large(300000, 42);
  pair.member->send(core::ByteString{1, 2, 3});
  pair.member->send(large);
  pair.host->send(core::ByteString{9});
  for (int i = 0; i < 20; ++i) pair.exchange();
  core::ByteString got;
  ASSERT_TRUE(pair.host->take(got));
  EXPECT_EQ(got, (core::ByteString{1, 2, 3}));
  ASSERT_TRUE(pair.host->take(got));
  EXPECT_EQ(got, large);
  ASSERT_TRUE(pair.member->take(got));
  EXPECT_EQ(got, core::ByteString{9});
  EXPECT_TRUE(pair.host->trusted());
}

TEST(SealedLink, WhoHasAnotherTokenIsCutOffAtTheFirstMessage) {
  Pair pair("token", "tokem");
  pair.member->send(core::ByteString{1});
  pair.exchange();
  core::ByteString got;
  EXPECT_FALSE(pair.host->take(got));
  EXPECT_FALSE(pair.host->open());
  EXPECT_FALSE(pair.host->trusted());
}

TEST(SealedLink, ChangedBytesAndMessagesPlayedTwiceAreCutOff) {
  for (const bool twice : {false, true}) {
    int ends[2], others[2];
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, others), 0);
    SealedLink member(ends[0], SealedLink::Side::member, "token"), host(others[0], SealedLink::Side::host, "token");
    std::array<std::uint8_t, 4096> bytes;
    const auto carry = [&](int from, int to) {
      const ssize_t n = recv(from, bytes.data(), bytes.size(), MSG_DONTWAIT);
      if (n > 0) static_cast<void>(::send(to, bytes.data(), std::size_t(n), MSG_NOSIGNAL));
    };
    member.exchange(), host.exchange();
    carry(ends[1], others[1]), carry(others[1], ends[1]);
    member.exchange(), host.exchange();
    member.send(core::ByteString{5, 6});
    member.exchange();
    const ssize_t n = recv(ends[1], bytes.data(), bytes.size(), MSG_DONTWAIT);
    ASSERT_GT(n, 0);
    if (!twice) bytes[std::size_t(n) - 1] ^= 1;
    for (int i = 0; i < 2; ++i) static_cast<void>(::send(others[1], bytes.data(), std::size_t(n), MSG_NOSIGNAL));
    host.exchange();
    core::ByteString got;
    EXPECT_EQ(host.take(got), twice);
    EXPECT_FALSE(host.take(got));
    EXPECT_FALSE(host.open());
    close(ends[1]), close(others[1]);
  }
}

TEST(SealedLink, SurvivesRandomBytes) {
  core::Random random(7);
  for (int round = 0; round < 200; ++round) {
    int ends[2];
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
    SealedLink host(ends[0], SealedLink::Side::host, "token");
    core::ByteString noise{'T', 'R', 'O', 'C', 'A', 'R', '-', '1'};
    if (round % 2 == 0) noise.clear();
    for (int i = 0; i < 500; ++i) noise.push_back(std::uint8_t(random.next()));
    static_cast<void>(::send(ends[1], noise.data(), noise.size(), MSG_NOSIGNAL));
    host.exchange();
    EXPECT_FALSE(host.trusted());
    core::ByteString got;
    EXPECT_FALSE(host.take(got));
    close(ends[1]);
  }
}

// --- host and members ---

/// A program that plays along: makes ticks as they come, on a thread.
class Mate {
 public:
  Mate(const TeamHost& host, const std::string& role, const std::string& token)
      : m_member({"127.0.0.1", host.port(), token, role}), m_session(lesson(), 1) {
    m_member.begin(lesson());
    m_thread = std::thread([this] { play(); });
  }
  ~Mate() { leave(); }
  void leave() {
    m_stop = true;
    if (m_thread.joinable()) m_thread.join();
  }
  TeamMember& member() { return m_member; }
  std::uint64_t ticks() const { return m_ticks; }
  std::uint64_t hash() {
    leave();
    return sim::hash_of(m_session.state());
  }

 private:
  void play() {
    sim::Input input;
    while (!m_stop) {
      if (!m_member.ready()) {
        std::this_thread::sleep_for(1ms);
        continue;
      }
      if (!m_member.next(m_session.state(), input)) return;
      m_member.after(m_session.state(), m_session.advance(input));
      m_ticks = m_session.state().tick;
    }
  }
  TeamMember m_member;
  Session m_session;
  std::atomic<bool> m_stop{false};
  std::atomic<std::uint64_t> m_ticks{0};
  std::thread m_thread;
};

/// The host's ticks, as many as can be made within ten seconds.
std::uint64_t make(Session& session, HostedSource& source, std::uint64_t ticks) {
  sim::Input input;
  for (const std::uint64_t end = session.state().tick + ticks; session.state().tick < end;) {
    if (!soon([&] { return source.ready(); })) break;
    static_cast<void>(source.next(session.state(), input));
    source.after(session.state(), session.advance(input));
  }
  return session.state().tick;
}

struct Hosting {
  explicit Hosting(const std::vector<std::string>& roles)
      : team(lesson(), {"127.0.0.1", 0, "token", roles}),
        resting(lesson().model),
        source(team, resting),
        session(lesson(), 1) {}
  TeamHost team;
  RestingSource resting;
  HostedSource source;
  Session session;
};

TEST(Team, AMemberLeadsItsPartAndComesToTheSameBitsAsTheHost) {
  Hosting host({"camera"});
  EXPECT_FALSE(host.source.ready());
  EXPECT_NE(host.source.waits_for().find("camera"), std::string::npos);
  Mate camera(host.team, "camera", "token");
  sim::Input wish = lesson().model.start;
  wish.scope.yaw += 0.1f;
  wish.tools[0].yaw += 0.3f;  // not its part
  camera.member().put(wish);
  ASSERT_EQ(make(host.session, host.source, 600), 600u);
  EXPECT_NEAR(host.session.state().scope.yaw, wish.scope.yaw, 0.02);
  EXPECT_NEAR(host.session.state().tools[0].yaw, double(lesson().model.start.tools[0].yaw), 1e-6);
  EXPECT_TRUE(soon([&] { return camera.ticks() == 600; }));
  EXPECT_GT(camera.member().latency(), 0);
  EXPECT_EQ(camera.hash(), sim::hash_of(host.session.state()));
}

TEST(Team, TheHostKnowsTheLatencyOfAMemberThatHasLeft) {
  Hosting host({"camera"});
  auto camera = std::make_unique<Mate>(host.team, "camera", "token");
  camera->member().put(lesson().model.start);
  ASSERT_EQ(make(host.session, host.source, 600), 600u);
  EXPECT_TRUE(soon([&] { return host.team.seats().front().latency > 0; }));
  camera.reset();
  EXPECT_TRUE(soon([&] { return !host.team.seats().front().here; }));
  EXPECT_GT(host.team.seats().front().latency, 0) << "it stands in the result";
}

TEST(Team, PausesWhileAParticipantIsDisconnectedAndSendsWhatWasMissed) {
  Hosting host({"camera"});
  auto camera = std::make_unique<Mate>(host.team, "camera", "token");
  ASSERT_EQ(make(host.session, host.source, 300), 300u);
  camera.reset();
  EXPECT_TRUE(soon([&] { return !host.source.ready(); }));
  EXPECT_NE(host.source.waits_for().find("the camera is disconnected"), std::string::npos);
  camera = std::make_unique<Mate>(host.team, "camera", "token");
  EXPECT_TRUE(soon([&] { return host.source.ready(); }));
  ASSERT_EQ(make(host.session, host.source, 800), 1100u);  // more than one block
  EXPECT_TRUE(soon([&] { return camera->ticks() == 1100; }));
  EXPECT_EQ(camera->hash(), sim::hash_of(host.session.state()));
}

TEST(Team, WhoHasNotTheTokenOrNoSeatIsRefusedAndTimeGoesOnForTheOthers) {
  Hosting host({"camera"});
  EXPECT_THROW(Mate(host.team, "camera", "guessed"), core::EnvironmentLacks);
  EXPECT_THROW(Mate(host.team, "assistant", "token"), core::EnvironmentLacks);
  Mate camera(host.team, "camera", "token");
  EXPECT_THROW(Mate(host.team, "camera", "token"), core::EnvironmentLacks) << "the seat is taken";
  EXPECT_EQ(make(host.session, host.source, 50), 50u);
}

TEST(Team, TwoMayNotLeadTheSame) { EXPECT_THROW(Hosting({"assistant", lesson().model.hands[2].name}), core::BadInput); }

TEST(Team, TheEndIsTold) {
  Hosting host({"camera"});
  Mate camera(host.team, "camera", "token");
  ASSERT_EQ(make(host.session, host.source, 20), 20u);
  host.team.end(message::kFinished);
  EXPECT_TRUE(soon([&] { return camera.member().ended() == message::kFinished; }));
  EXPECT_TRUE(soon([&] { return camera.ticks() == 20; })) << "all ticks came before it";
}

}  // namespace
}  // namespace trocar::attempt
