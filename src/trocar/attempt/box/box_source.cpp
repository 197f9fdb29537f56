#include <algorithm>
#include <cmath>
#include <thread>

#include <fmt/format.h>

#include <trocar/attempt/box/box_file.hpp>
#include <trocar/attempt/box/box_source.hpp>
#include <trocar/attempt/catch_up.hpp>
#include <trocar/attempt/hand_names.hpp>
#include <trocar/attempt/sources.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/core/tick.hpp>

namespace trocar::attempt {
namespace {

using devices::BoxActor;
using devices::BoxFreshness;
using devices::BoxTime;

constexpr BoxTime kTickTime = 1'000'000'000 / BoxTime(core::kTicksPerSecond);
constexpr BoxTime kFirstAnswer = 3'000'000'000;  // that long a box is asked before it is given up
constexpr BoxTime kLostAnswer = 150'000'000;     // stepped: that long an answer is waited for
constexpr double kNearPost = 0.01;               // [rad] caught up
constexpr float kNearGrip = 0.05f;
constexpr double kInTrocar = 0.010;  // [m] an exchanged instrument waits this deep

}  // namespace

// --- the leader ---

BoxLeader::BoxLeader(const sim::Model& model, const devices::BoxWiring& wiring)
    : m_model(model),
      m_hands(model, wiring),
      m_bridge(devices::box_time(1 / wiring.rate)),
      m_command(model.start),
      m_smooth(model.start) {
  catch_up();
}

void BoxLeader::catch_up() {
  m_catches.fill(true);
  m_keeps_grip.fill(true);
  m_scope_catches = true;
}

/// The next instrument of the rack for every press. It comes out of the trocar when the hand is there.
void BoxLeader::exchange(const devices::BoxPose& pose, const sim::State& state, sim::Input& wanted) {
  for (std::size_t actor = 0; actor < devices::kBoxHands; ++actor) {
    const int hand = m_hands.hand_of(BoxActor(actor));
    if (hand < 0) continue;
    const auto h = std::size_t(hand);
    const auto count = std::uint32_t(m_model.hands[h].rack.size());
    const std::uint32_t presses = pose.changes[actor] - m_changes[actor];
    m_changes[actor] = pose.changes[actor];
    if (presses % count != 0) {
      m_instrument[h] = int((std::uint32_t(m_instrument[h]) + presses) % count);
      m_waits[h] = true;
    }
    wanted.tools[hand].instrument = m_instrument[h];
    if (!m_waits[h]) continue;
    const bool drawn_back = double(wanted.tools[hand].depth) < kDrawnBack;
    if (state.tools[h].instrument == m_instrument[h] && drawn_back) {
      m_waits[h] = false;
      m_catches[h] = m_keeps_grip[h] = true;
      m_command.tools[hand].depth = float(kInTrocar);
      m_command.tools[hand].handle = 0;
    }
  }
}

/// A handle counts again when it has come to where the jaws are.
float BoxLeader::grip(int hand, float handle) {
  const auto h = std::size_t(hand);
  const float kept = m_command.tools[hand].handle;
  if (m_keeps_grip[h] && std::abs(handle - kept) < kNearGrip) m_keeps_grip[h] = false;
  return m_keeps_grip[h] ? kept : handle;
}

void BoxLeader::go_towards(const sim::Input& wanted) {
  for (int hand = 0; hand < int(m_model.hands.size()); ++hand) {
    const auto h = std::size_t(hand);
    sim::ToolInput& command = m_command.tools[hand];
    const sim::ToolInput& to = wanted.tools[hand];
    command.instrument = to.instrument;
    if (m_waits[h]) {
      command.depth = float(kInTrocar);
      command.handle = 0;
      continue;
    }
    const float handle = grip(hand, to.handle);
    if (m_catches[h])
      m_catches[h] = !approach(command, to);
    else
      command = to;
    command.handle = handle;
  }
  if (m_scope_catches) {
    const double post = approach(m_command.scope.post, wanted.scope.post, kCatchTurn * core::kTick);
    m_scope_catches = !approach(m_command.scope, wanted.scope) || post > kNearPost;
  } else {
    m_command.scope = wanted.scope;
  }
  m_command.pedals = wanted.pedals;
}

sim::Input BoxLeader::next(const sim::State& state, BoxTime now) {
  const devices::BoxPose& pose = m_bridge.at(now);
  const bool frozen = m_bridge.freshness() == BoxFreshness::frozen;
  if (m_was_frozen && !frozen && m_began) catch_up();
  if (!m_began && m_bridge.any()) {
    m_changes = pose.changes;
    m_began = true;
  }
  m_was_frozen = frozen;
  if (frozen) {  // everything stays where it is, no pedal is down
    m_command.pedals = 0;
  } else {
    sim::Input wanted = m_command;
    m_hands.lead(pose, wanted);
    exchange(pose, state, wanted);
    go_towards(wanted);
  }
  const bool reset = (pose.pedals & devices::kBoxReset) != 0;
  m_reset_was_up = m_reset_was_up || (!reset && !frozen);
  m_reset_ticks = reset && m_reset_was_up ? m_reset_ticks + 1 : 0;
  return m_smooth.step(m_command);
}

// --- the source ---

BoxSource::BoxSource(const sim::Model& model, const std::string& port, const devices::BoxWiring& wiring, BoxPace pace)
    : m_model(model), m_port(port), m_pace(pace), m_leader(model, wiring), m_reader(wiring) {
  if (pace == BoxPace::live) {
    m_thread = std::make_unique<devices::BoxThread>(port, wiring);
  } else {
    m_link =
        std::make_unique<devices::BoxLink>(port, devices::dialogue_settings(wiring), [this] { return m_tick_time; });
    m_link->open();
  }
  wait_for_first();
}

void BoxSource::wait_for_first() {
  const BoxTime until = devices::box_now() + kFirstAnswer;
  while (!m_leader.bridge().any()) {
    if (devices::box_now() > until)
      throw core::EnvironmentLacks(
          tr("no box answers at {}: is it switched on, and are baud rate and protocol those of its file? "
             "`trocar box monitor {}` shows the received data",
             m_port, m_port));
    if (m_thread) {
      take_live();
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    } else {
      m_tick_time += m_link->settings().period();
      m_next_ask = 0;
      step_line(0);
    }
  }
  m_next_ask = 0;
}

void BoxSource::take_live() {
  if (m_thread->take(m_pose)) m_leader.take(m_pose);
}

/// Takes the answer to the last request, then asks again: a request goes out while its predecessor's answer is used.
void BoxSource::step_line(std::uint64_t tick) {
  if (tick < m_next_ask) return;
  m_next_ask = tick + std::max<std::uint64_t>(1, std::uint64_t(m_link->settings().period() / kTickTime));
  if (!m_link->is_open()) m_link->try_to_open();
  const std::uint64_t before = m_answered;
  const auto take = [this](const devices::BoxPacket& packet) {
    m_leader.take(m_reader.read(packet));
    ++m_answered;
  };
  if (m_link->counts().asked > 0)
    m_link->listen(devices::box_now() + kLostAnswer, take, [&] { return m_answered > before; });
  m_link->ask();
}

/// Not faster than hands are.
void BoxSource::keep_pace(std::uint64_t tick) {
  const BoxTime now = devices::box_now();
  if (tick == 0 || m_began == 0) m_began = now - BoxTime(tick) * kTickTime;
  const BoxTime ahead = m_began + BoxTime(tick) * kTickTime - now;
  if (ahead > 0) std::this_thread::sleep_for(std::chrono::nanoseconds(ahead));
  if (ahead < 0) m_began -= ahead;  // slow motion is not caught up with
}

bool BoxSource::next(const sim::State& state, sim::Input& input) {
  BoxTime now;
  if (m_pace == BoxPace::live) {
    take_live();
    now = devices::box_now();
    if (m_last_next != 0 && now - m_last_next > kStoodStill) m_leader.catch_up();
    m_last_next = now;
  } else {
    if (m_ticks == 0) m_first_tick_time = m_tick_time;
    m_tick_time = m_first_tick_time + BoxTime(m_ticks) * kTickTime;
    keep_pace(m_ticks);
    step_line(m_ticks);
    now = m_tick_time;
  }
  input = m_leader.next(state, now);
  ++m_ticks;
  note_age(now);
  note_news(state);
  return m_pace == BoxPace::live || !m_leader.wants_reset();
}

/// How old what leads is when it is first used.
void BoxSource::note_age(BoxTime now) {
  const devices::BoxPose& pose = m_leader.bridge().newest();
  if (m_leader.bridge().freshness() == BoxFreshness::frozen) ++m_frozen_ticks;
  if (pose.number == m_used) return;
  m_used = pose.number;
  const double age = devices::box_seconds(now - pose.acquired);
  m_ages.sum += age;
  m_ages.most = std::max(m_ages.most, age);
  ++m_ages.count;
}

devices::BoxCounts BoxSource::counts() const { return m_thread ? m_thread->status().counts : m_link->counts(); }

void BoxSource::note_news(const sim::State& state) {
  constexpr std::uint64_t kEvery = 50;  // ticks
  if (m_pace == BoxPace::live) m_acquired.store(m_leader.bridge().newest().acquired, std::memory_order_relaxed);
  if (m_leader.wants_reset()) m_wants_restart.store(true, std::memory_order_relaxed);
  if (m_ticks % kEvery != 1) return;
  DeviceNews news;
  const bool open = m_thread ? m_thread->status().open : m_link->is_open();
  const devices::BoxCounts c = counts();
  const double rate = m_thread ? m_thread->status().rate : m_link->settings().rate;
  if (m_leader.bridge().freshness() == BoxFreshness::frozen) {
    news.warning = open ? tr("The box at {} does not answer: the instruments do not move.", m_port)
                        : tr("The box at {} is disconnected: plug it in again. The instruments do not move.", m_port);
  } else {
    for (int h = 0; h < int(m_model.hands.size()); ++h)
      if (m_leader.waits_in_trocar(h) && state.tools[std::size_t(h)].instrument == m_leader.instrument(h))
        news.hint = tr("{}: withdraw the instrument to insert the new one", hand_name(m_model, h));
  }
  news.text = tr("box: {:.0f} blocks a second, {:.1f} % lost", rate, 100 * c.missed_share());
  const std::lock_guard lock(m_lock);
  m_news = std::move(news);
}

std::optional<DeviceNews> BoxSource::device() const {
  const std::lock_guard lock(m_lock);
  DeviceNews news = m_news;
  news.acquired = m_acquired.load(std::memory_order_relaxed);
  news.wants_restart = m_wants_restart.load(std::memory_order_relaxed);
  return news;
}

Json BoxSource::describe() const {
  const devices::BoxCounts c = counts();
  return {{"box",
           {{"port", m_port},
            {"blocks", c.blocks},
            {"missed", c.missed},
            {"bad", c.bad},
            {"opened", m_thread ? m_thread->status().opened : m_link->opened()},
            {"frozen_share", m_ticks > 0 ? double(m_frozen_ticks) / double(m_ticks) : 0.0},
            {"age_when_used_ms",
             {{"mean", m_ages.count > 0 ? 1000 * m_ages.sum / double(m_ages.count) : 0.0},
              {"most", 1000 * m_ages.most}}}}}};
}

std::unique_ptr<InputSource> make_input(const Lesson& lesson, const std::string& input, BoxPace pace) {
  constexpr std::string_view kBox = "box:";
  if (input.rfind(kBox, 0) != 0 || input.size() == kBox.size()) return make_source(lesson, input);
  const std::string rest = input.substr(kBox.size());
  const std::size_t mark = rest.find('#');
  const devices::BoxWiring wiring = load_wiring(mark == std::string::npos ? "" : rest.substr(mark + 1));
  return std::make_unique<BoxSource>(lesson.model, rest.substr(0, mark), wiring, pace);
}

}  // namespace trocar::attempt
