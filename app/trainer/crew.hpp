// Who and what leads an attempt in the window: a person's hands with one device or several, a source in their place, a
// haptic device for one hand, and the others of a team.
//
//   Crew crew(stage, lesson, plan.input);
//   attempt::Live live(session, crew.source(), limit);
//   crew.put(crew.pilot()->lead(sample, state), dt, state);      // by hand
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <trocar/attempt/hand_pilot.hpp>
#include <trocar/attempt/haptics/haptic_source.hpp>
#include <trocar/attempt/inputs/device_parts.hpp>
#include <trocar/attempt/sources.hpp>
#include <trocar/attempt/team/host.hpp>
#include <trocar/attempt/tracker/tracked_source.hpp>

#include "trainer/trainer_window.hpp"

namespace trocar::app {

class Crew {
 public:
  /// @param input "mouse" or "gamepad": hands; else a source, see make_source().  @throws core::BadInput and what
  /// opening a device throws
  /// @param first  what the person controls first: a hand, or devices::kScope
  Crew(TrainerWindow& stage, const attempt::Lesson& lesson, const std::string& input, int first);
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  attempt::InputSource& source() const;
  /// The person at this window; null: a source leads in their place.
  attempt::HandPilot* pilot() const { return m_pilot.get(); }
  /// Null: no device leads a hand and gives force back.
  attempt::HapticHand* haptic() const { return m_haptic.get(); }
  attempt::TeamHost* team() const { return m_team.get(); }

  /// As the settings say, from now on: what is held down now does not act.
  void take_up(const devices::HandSample& sample);
  /// Where the person's hands command everything to be, at `state`; `dt` since the last call [s].
  void put(const sim::Input& command, float dt, const sim::State& state);
  /// A device that has a part and is not there, in words.
  std::string missing() const;

  /// Who takes part, and how old what comes from them is.
  std::vector<std::string> in_words() const;
  /// What those who are away have to type.
  std::vector<std::string> how_to_join(bool with_token = true) const;

 private:
  void give_parts();
  void take_device();
  void join_in();

  TrainerWindow& m_stage;
  const attempt::Lesson& m_lesson;
  const int m_first;
  std::unique_ptr<attempt::HandPilot> m_pilot;
  std::unique_ptr<attempt::DeviceParts> m_parts;      ///< null: all devices lead the same
  std::unique_ptr<attempt::HandsSource> m_hands;      ///< null: something else leads
  std::unique_ptr<attempt::TeamHost> m_team;          ///< null: nobody else takes part
  std::unique_ptr<attempt::InputSource> m_source;     ///< not the hands themselves
  std::unique_ptr<attempt::HapticHand> m_haptic;      ///< null: no device leads a hand
  std::unique_ptr<attempt::HapticSource> m_felt;      ///< with its hand
  std::unique_ptr<attempt::TrackedSource> m_tracked;  ///< with what tracked tools lead
  std::unique_ptr<attempt::HostedSource> m_hosted;    ///< with the team's
};

}  // namespace trocar::app
