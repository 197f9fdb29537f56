// Who plays along: gets from the host every tick's inputs, makes the same ticks, and says where what it leads is
// wanted. The connection may break; it is made again for a minute, and what was missed is caught up with.
//
//   TeamMember member({.address = "10.0.0.5", .port = 4711, .token = token, .role = "camera"});
//   const auto lesson = load_lesson(member.attempt().exercise, member.attempt().seed);
//   member.begin(*lesson);
//   Session session(*lesson);  Live live(session, &member, 0);
//   member.put(pilot.lead(sample, state));            // or member.follow(robot)
#pragma once

#include <atomic>
#include <memory>

#include <trocar/attempt/lesson.hpp>
#include <trocar/attempt/team/duty.hpp>
#include <trocar/attempt/team/message.hpp>

namespace trocar::attempt {

struct MemberPlan {
  std::string address = "127.0.0.1";
  int port = 0;
  std::string token, role;
};

class TeamMember : public InputSource {
 public:
  /// Waits until the host says what is done.
  /// @throws core::EnvironmentLacks when nobody answers there, or refuses
  explicit TeamMember(const MemberPlan& plan);
  ~TeamMember() override;

  const message::Attempt& attempt() const;
  /// @throws core::EnvironmentLacks when this is not the same scene as the host's; core::BadInput for a role it has not
  void begin(const Lesson& lesson);
  const Duty& duty() const;
  const std::string& role() const;

  /// Where its part is wanted; the rest of `input` is ignored. Any thread.
  void put(const sim::Input& input);
  /// This one leads its part from now on, by what it sees of the simulation.
  void follow(std::unique_ptr<InputSource> robot);

  bool ready() override;
  std::string waits_for() const override;
  std::uint64_t behind() const override;
  bool next(const sim::State& state, sim::Input& input) override;
  void after(const sim::State& state, const sim::StepReport& report) override;
  Json describe() const override;

  double latency() const;     ///< [s] from put() to the tick that has it, on average; 0: not known yet
  std::string ended() const;  ///< empty, or why there is no more

 private:
  struct Desk;
  std::unique_ptr<Desk> m_desk;
};

}  // namespace trocar::attempt
