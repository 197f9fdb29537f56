#include "trainer/crew.hpp"

#include <fmt/format.h>

#include <trocar/attempt/box/box_source.hpp>
#include <trocar/core/log.hpp>
#include <trocar/core/text.hpp>
#include <trocar/devices/haptics/choose_device.hpp>

namespace trocar::app {

Crew::Crew(TrainerWindow& stage, const attempt::Lesson& lesson, const std::string& input, int first)
    : m_stage(stage), m_lesson(lesson), m_first(first) {
  if (input == "mouse" || input == "gamepad") {
    m_pilot = std::make_unique<attempt::HandPilot>(lesson.model);
    m_pilot->set(hand_settings(stage.settings, 0));
    m_pilot->choose(m_first);
    m_pilot->lead_both(stage.settings.both_hands);
    m_pilot->choose(m_first);  // of both, too: the mode by itself leaves the endoscope
    m_hands = std::make_unique<attempt::HandsSource>(lesson.model);
    give_parts();
  } else if (!stage.options.member) {
    m_source = attempt::make_input(lesson, input, attempt::BoxPace::live);
  }
  take_device();
  if (const auto& tracker = stage.options.tracker)
    m_tracked = std::make_unique<attempt::TrackedSource>(source(), lesson.model, *tracker);
  join_in();
}

Crew::~Crew() { m_stage.window.gamepads().leave_out({}); }

/// Several devices, each with what it leads.
void Crew::give_parts() {
  if (!m_stage.options.map) return;
  m_parts = std::make_unique<attempt::DeviceParts>(*m_stage.options.map, m_lesson.model);
  m_stage.window.gamepads().leave_out([this](const devices::DeviceReading& reading) {
    return m_parts->claims(reading, m_stage.window.gamepads().all());
  });
}

/// The device leads its hand from now on, whatever leads the others.
void Crew::take_device() {
  const std::string& name = m_stage.options.haptics;
  if (name.empty()) return;
  const bool there = m_lesson.model.hand_index(m_stage.options.haptics_hand) >= 0;
  std::unique_ptr<devices::HapticDevice> device = devices::choose_haptic_device(name, "--haptics");
  device->open();
  const int hand =
      attempt::haptic_hand_of(m_lesson.model, there ? m_stage.options.haptics_hand : std::string(), "--haptics-hand");
  m_haptic = std::make_unique<attempt::HapticHand>(m_lesson.model, hand, std::move(device),
                                                   attempt::HapticHand::Pace::own_loop, attempt::HapticHand::Feel{});
  m_felt = std::make_unique<attempt::HapticSource>(source(), *m_haptic);
}

/// Others take part, or this is a part of somebody else's attempt.
void Crew::join_in() {
  if (const auto& member = m_stage.options.member; member && m_pilot) m_pilot->choose(first_of(member->duty()));
  if (!m_stage.options.team || m_stage.options.member) return;
  m_team = std::make_unique<attempt::TeamHost>(m_lesson, *m_stage.options.team);
  m_hosted = std::make_unique<attempt::HostedSource>(*m_team, source());
  const bool chosen = !m_stage.options.team->token.empty();  // then it is known, and stays out of logs
  for (const std::string& line : how_to_join(!chosen)) core::log::info("{}", line);
}

attempt::InputSource& Crew::source() const {
  if (m_hosted) return *m_hosted;
  if (m_tracked) return *m_tracked;
  if (m_felt) return *m_felt;
  if (m_stage.options.member) return *m_stage.options.member;
  return m_hands ? static_cast<attempt::InputSource&>(*m_hands) : *m_source;
}

void Crew::take_up(const devices::HandSample& sample) {
  m_pilot->set(hand_settings(m_stage.settings, 0));
  m_pilot->lead_both(m_stage.settings.both_hands);
  m_pilot->take_up(sample);
  if (m_parts) m_parts->take_up(m_stage.window.gamepads().all());
}

void Crew::put(const sim::Input& command, float dt, const sim::State& state) {
  const sim::Input& all = m_parts ? m_parts->lead(command, m_stage.window.gamepads().all(), dt, state) : command;
  if (const auto& member = m_stage.options.member)
    member->put(all);
  else
    m_hands->put(all);
}

std::string Crew::missing() const {
  return m_parts ? m_parts->missing(m_stage.window.gamepads().all()) : std::string();
}

std::vector<std::string> Crew::in_words() const {
  std::vector<std::string> lines = m_parts ? m_parts->in_words() : std::vector<std::string>();
  if (const auto& member = m_stage.options.member)
    lines.push_back(tr("your part is the {}: {:.0f} ms", member->role(), 1000 * member->latency()));
  if (!m_team) return lines;
  for (const attempt::TeamSeat& seat : m_team->seats())
    lines.push_back(seat.here ? tr("{}: {:.0f} ms", seat.role, 1000 * seat.latency)
                              : tr("{}: disconnected", seat.role));
  return lines;
}

std::vector<std::string> Crew::how_to_join(bool with_token) const {
  std::vector<std::string> lines;
  if (!m_team) return lines;
  for (const attempt::TeamSeat& seat : m_team->seats())
    if (!seat.here)
      lines.push_back(tr("trocar join {}:{} --role {} --token {}", m_stage.options.team->address, m_team->port(),
                         seat.role, with_token ? m_team->token() : tr("YOUR_TOKEN")));
  return lines;
}

}  // namespace trocar::app
