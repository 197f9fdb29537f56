// Several people at one attempt, over a network: the host's program runs it, the others' programs get every tick's
// inputs and make the same ticks themselves, to the bit, so that each has the whole picture; what they control goes
// back to the host. The simulation pauses while a participant is disconnected; on coming back, the participant receives
// all missed ticks. Only with the token.
//
//   TeamHost team(lesson, {.roles = {"camera", "assistant"}});
//   tell(team.port(), team.token());
//   while (!team.ready()) sleep();                  // team.waits_for()
//   team.lead(input); session.advance(input); team.made(session.state(), input);
//   team.end("finished");
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <thread>

#include <trocar/attempt/hand_pilot.hpp>
#include <trocar/attempt/lesson.hpp>
#include <trocar/attempt/team/duty.hpp>

namespace trocar::attempt {

struct TeamPlan {
  std::string address = "127.0.0.1";  ///< of this machine's that is listened at; "0.0.0.0": all
  int port = 0;                       ///< 0: one that is free
  std::string token;                  ///< empty: one is drawn
  std::vector<std::string> roles;     ///< who is expected, see duty_of()
};

/// How somebody of the team is doing.
struct TeamSeat {
  std::string role;
  Duty duty;
  bool here = false;
  std::uint64_t ticks = 0;  ///< made there
  double latency = 0;       ///< [s] from a hand's motion there to the tick there that has it, last known; 0: none yet
};

class TeamHost {
 public:
  /// @throws core::BadInput for a role that the scene has not, or two that lead the same; core::EnvironmentLacks where
  /// that address and port cannot be listened at
  TeamHost(const Lesson& lesson, const TeamPlan& plan);
  ~TeamHost();
  TeamHost(const TeamHost&) = delete;
  TeamHost& operator=(const TeamHost&) = delete;

  int port() const;
  const std::string& token() const;

  // The simulation's thread.
  /// Everybody is here and not far behind.
  bool ready() const;
  /// What the others lead replaces what `input` has there, smoothed to ticks.
  void lead(sim::Input& input);
  /// That tick was made; `state` is what it came to.
  void made(const sim::State& state, const sim::Input& input);

  // Any thread.
  std::string waits_for() const;  ///< "the camera is not here yet"; empty: ready
  std::vector<TeamSeat> seats() const;
  /// Informs all of them and waits for their answers, for a second at most.
  void end(const std::string& why);

 private:
  struct Desk;
  std::unique_ptr<Desk> m_desk;
};

/// A team's attempt: `own` leads what nobody else does.
class HostedSource : public InputSource {
 public:
  HostedSource(TeamHost& team, InputSource& own) : m_team(team), m_own(own) {}
  bool ready() override { return m_team.ready() && m_own.ready(); }
  std::string waits_for() const override;
  bool next(const sim::State& state, sim::Input& input) override;
  void after(const sim::State& state, const sim::StepReport& report) override;
  std::optional<DeviceNews> device() const override { return m_own.device(); }
  Json describe() const override;

 private:
  TeamHost& m_team;
  InputSource& m_own;
  sim::Input m_input;
};

}  // namespace trocar::attempt
